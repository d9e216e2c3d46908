//! The distance between a mesh and a surface, by samples, in f64.

use anyhow::{Result, anyhow};
use fastrand::Rng;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::TriMesh;
use sdfc::Field;

use crate::mesh::Meshed;
use crate::model::View;

/// Samples of the mesh, and lines through the cube.
const SAMPLES: usize = 50_000;
const LINES: usize = 20_000;
/// Steps along a line. Parts that are thinner than a step may be passed.
const STEPS: usize = 400;
/// The field has opposite signs at this distance from both sides of a surface, in halves of the
/// cube's side. Slits that are thinner do not count.
const APART: f64 = 1e-7;

/// The greatest distance from samples of the mesh to the surface and its mean, and the greatest
/// distance from samples of the surface to the mesh.
pub struct Errors {
    pub to_surface: f64,
    pub mean: f64,
    pub to_mesh: f64,
}

pub fn errors(mesh: &Meshed, field: &mut Field<'_>, view: View) -> Result<Errors> {
    let mut random = Rng::with_seed(1);
    let (to_surface, mean) = to_surface(mesh, field, view, &mut random);
    let to_mesh = to_mesh(mesh, field, view, &mut random)?;
    Ok(Errors { to_surface, mean, to_mesh })
}

fn along(point: [f64; 3], direction: [f64; 3], t: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| point[axis] + t * direction[axis])
}

fn unit(vector: [f64; 3]) -> Option<[f64; 3]> {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length > 0.0).then(|| vector.map(|x| x / length))
}

fn to_surface(mesh: &Meshed, field: &mut Field<'_>, view: View, random: &mut Rng) -> (f64, f64) {
    let mut areas = Vec::with_capacity(mesh.triangles.len());
    let mut area = 0.0;
    for &triangle in &mesh.triangles {
        let [a, b, c] = mesh.corners(triangle);
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
        let cross = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            u[j] * v[k] - u[k] * v[j]
        });
        area += cross.iter().map(|x| x * x).sum::<f64>().sqrt();
        areas.push(area);
    }
    let (mut worst, mut sum) = (0.0f64, 0.0);
    for _ in 0..SAMPLES {
        let at = random.f64() * area;
        let index = areas.partition_point(|&area| area < at).min(areas.len() - 1);
        let [a, b, c] = mesh.corners(mesh.triangles[index]);
        let (mut s, mut t) = (random.f64(), random.f64());
        if s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        let point = [0, 1, 2].map(|i| a[i] + s * (b[i] - a[i]) + t * (c[i] - a[i]));
        let slope = unit(field.gradient(point).gradient);
        let mut distance =
            slope.map_or(view.half, |slope| crossing(field, point, slope, view.half));
        // Near an edge another direction may be shorter. Only the worst samples need it.
        if distance > worst {
            for _ in 0..200 {
                let direction = unit([(); 3].map(|()| random.f64() * 2.0 - 1.0));
                let Some(direction) = direction else { continue };
                distance = crossing(field, point, direction, distance);
                if distance <= worst {
                    break;
                }
            }
        }
        worst = worst.max(distance);
        sum += distance;
    }
    (worst, sum / SAMPLES as f64)
}

/// The distance along a direction, forwards or backwards, to a change of sign; at most `limit`.
fn crossing(field: &mut Field<'_>, point: [f64; 3], direction: [f64; 3], limit: f64) -> f64 {
    let is_inside = field.distance(point) < 0.0;
    let mut least = limit;
    for sign in [1.0, -1.0] {
        let mut changed =
            |t: f64| (field.distance(along(point, direction, sign * t)) < 0.0) != is_inside;
        let (mut low, mut high) = (0.0, limit * 1e-7);
        while high < least && !changed(high) {
            (low, high) = (high, high * 1.5);
        }
        if high >= least && !changed(least) {
            continue;
        }
        high = high.min(least);
        for _ in 0..40 {
            let middle = (low + high) / 2.0;
            if changed(middle) { high = middle } else { low = middle }
        }
        least = high;
    }
    least
}

fn to_mesh(mesh: &Meshed, field: &mut Field<'_>, view: View, random: &mut Rng) -> Result<f64> {
    let points = mesh.points.iter().map(|&point| point.into()).collect();
    let shape = TriMesh::new(points, mesh.triangles.clone()).map_err(|e| anyhow!("{e}"))?;
    let mut worst = 0.0f64;
    for _ in 0..LINES {
        let start = view.center.map(|x| x + view.half * (random.f64() * 2.0 - 1.0));
        let Some(direction) = unit([(); 3].map(|()| random.f64() * 2.0 - 1.0)) else { continue };
        // From the one side of the cube to the other.
        let (mut enter, mut leave) = (f64::MIN, f64::MAX);
        for axis in 0..3 {
            let ends = [-1.0, 1.0]
                .map(|side| (view.center[axis] + side * view.half - start[axis]) / direction[axis]);
            enter = enter.max(ends[0].min(ends[1]));
            leave = leave.min(ends[0].max(ends[1]));
        }
        let step = (leave - enter) / STEPS as f64;
        let line: Vec<[f64; 3]> =
            (0..=STEPS).map(|i| along(start, direction, enter + step * i as f64)).collect();
        let values = field.distances(&line);
        for i in 0..STEPS {
            if (values[i] < 0.0) == (values[i + 1] < 0.0) {
                continue;
            }
            let (mut low, mut high) = (enter + step * i as f64, enter + step * (i + 1) as f64);
            let is_inside = values[i] < 0.0;
            for _ in 0..50 {
                let middle = (low + high) / 2.0;
                let inside = field.distance(along(start, direction, middle)) < 0.0;
                if inside == is_inside { low = middle } else { high = middle }
            }
            // Where faces touch within a solid, rounding makes the field 0 in a plane.
            let beside = [low - APART * view.half, high + APART * view.half]
                .map(|t| field.distance(along(start, direction, t)) < 0.0);
            if beside[0] == beside[1] {
                continue;
            }
            let point = along(start, direction, high).into();
            worst = worst.max(shape.distance_to_local_point(&point, false));
        }
    }
    Ok(worst)
}
