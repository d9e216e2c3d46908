//! Pictures and meshes of a scene that have to agree with each other.

use std::collections::HashMap;
use std::ops::ControlFlow;

use sdfc::{Backend, Error, Field, Mesh, MeshOptions, MeshSize, PictureOptions, Tile, no_progress};
use sdfc_render::{Image, testing};

use super::{Finding, Outcome, Subject, Verdict, finding, is_drawn};

/// Width and height of a picture that is cut into regions, and a region across its middle.
const SIZE: [u32; 2] = [48, 32];
const REGION: Tile = Tile { origin: [17, 9], size: [21, 15] };
/// The error of a mesh, as a part of the scene's size, and the most cells it may take.
const ERROR: f64 = 0.04;
const CELLS: u64 = 40_000;
/// Points on each axis of a grid at which mesh and field are compared.
const GRID: usize = 5;
/// Directions in which a point that mesh and field see differently looks for the surface.
const STEPS: [f64; 3] = [-1.0, 0.0, 1.0];

/// A region of a picture has the pixels of the picture.
pub(super) fn regions(subject: &Subject) -> Outcome {
    if !is_drawn(&subject.scene) {
        return Ok(Verdict::LeftOut);
    }
    let mut backends = vec![Backend::Cpu];
    backends.extend((!testing::without_gpu()).then_some(Backend::Gpu));
    for backend in backends {
        let draw = |region: Option<Tile>| -> Result<Image, Finding> {
            let options =
                PictureOptions::new().size(SIZE).backend(backend).samples(1).region(region);
            let picture = subject.scene.render(&options, &mut no_progress);
            Ok(picture.map_err(|error| finding("not drawn", error))?.image)
        };
        let (whole, part) = (draw(None)?, draw(Some(REGION))?);
        for (row, pixels) in part.pixels().chunks(REGION.size[0] as usize).enumerate() {
            let start = (REGION.origin[1] as usize + row) * SIZE[0] as usize;
            let start = start + REGION.origin[0] as usize;
            let same = &whole.pixels()[start..start + pixels.len()];
            if let Some(at) = same.iter().zip(pixels).position(|(a, b)| differ(&a.color, &b.color))
            {
                let (a, b) = (same[at].color, pixels[at].color);
                let message = format!("{backend:?}, row {row}, column {at}: {a:?} and {b:?}");
                return Err(finding("another pixel", message));
            }
        }
    }
    Ok(Verdict::Holds)
}

/// True if the colours have other bits, so that a colour that is no number equals itself.
fn differ(a: &[f32], b: &[f32]) -> bool {
    a.iter().zip(b).any(|(a, b)| a.to_bits() != b.to_bits())
}

/// A mesh is closed, its vertices lie on the surface, and points are inside of both or of none.
pub(super) fn mesh(subject: &Subject) -> Outcome {
    let scene = &subject.scene;
    // The mesh has none of the solids without a limit, but the field has.
    if scene.is_planar() || !is_drawn(scene) || !scene.left_out(&scene.defaults()).is_empty() {
        return Ok(Verdict::LeftOut);
    }
    let options = MeshOptions::new().error(MeshSize::Relative(ERROR)).max_cells(CELLS);
    let mesh = match scene.mesh(&options, &mut |_| ControlFlow::Continue(())) {
        Ok(mesh) => mesh,
        // The scene is empty, has no limit, or needs more cells.
        Err(Error::Mesh(_)) => return Ok(Verdict::LeftOut),
        Err(error) => return Err(finding("no mesh", error)),
    };
    is_closed(&mesh)?;
    if !mesh.certificate.is_proven {
        return Ok(Verdict::Holds);
    }
    let mut field = scene.field(&scene.defaults()).map_err(|error| finding("no field", error))?;
    if scene.is_certified() {
        let far = |vertex: &&[f64; 3]| field.distance(**vertex) > 1.001 * mesh.certificate.error;
        if let Some(vertex) = mesh.vertices.iter().find(far) {
            let message = format!("{} at vertex {vertex:?}", field.distance(*vertex));
            return Err(finding("off the surface", message));
        }
    }
    same_inside(&mesh, &mut field)
}

/// Each side of a triangle is the side of one other triangle, in the other direction.
fn is_closed(mesh: &Mesh) -> Result<(), Finding> {
    let mut sides: HashMap<[u32; 2], i32> = HashMap::new();
    for [a, b, c] in &mesh.triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *sides.entry([*from.min(to), *from.max(to)]).or_default() +=
                if from < to { 1 } else { -1 };
        }
    }
    match sides.iter().find(|(_, sum)| **sum != 0) {
        Some((side, _)) => Err(finding("open", format!("at the side {side:?}"))),
        None => Ok(()),
    }
}

fn same_inside(mesh: &Mesh, field: &mut Field<'_>) -> Outcome {
    let ends = [f64::INFINITY, f64::NEG_INFINITY];
    let mut extents = [ends; 3];
    for vertex in &mesh.vertices {
        for (extent, at) in extents.iter_mut().zip(vertex) {
            *extent = [extent[0].min(*at), extent[1].max(*at)];
        }
    }
    let coordinate = |axis: usize, step: usize| {
        let [lo, hi] = extents[axis];
        lo + (hi - lo) * (step as f64 + 0.37) / GRID as f64
    };
    for cell in 0..GRID.pow(3) {
        let steps = [cell % GRID, cell / GRID % GRID, cell / GRID / GRID];
        let point = [0, 1, 2].map(|axis| coordinate(axis, steps[axis]));
        let inside = winding(mesh, point) > 0.5;
        if inside != (field.distance(point) < 0.0) && !has_surface(field, point, mesh) {
            let message =
                format!("{point:?} is {} the mesh", if inside { "inside" } else { "outside" });
            return Err(finding("another side", message));
        }
    }
    Ok(Verdict::Holds)
}

/// True if the field changes its sign within the mesh's error of a point.
fn has_surface(field: &mut Field<'_>, point: [f64; 3], mesh: &Mesh) -> bool {
    let sign = field.distance(point) < 0.0;
    let reach = mesh.certificate.error;
    (1..=4).any(|ring| {
        let step = reach * f64::from(ring) / 4.0;
        STEPS.iter().any(|x| {
            STEPS.iter().any(|y| {
                STEPS.iter().any(|z| {
                    let moved = [point[0] + step * x, point[1] + step * y, point[2] + step * z];
                    (field.distance(moved) < 0.0) != sign
                })
            })
        })
    })
}

/// How often a mesh winds around a point: the solid angles of all triangles, as parts of a sphere.
/// Source: van Oosterom and Strackee, "The solid angle of a plane triangle", 1983.
fn winding(mesh: &Mesh, point: [f64; 3]) -> f64 {
    let to = |index: u32| {
        let vertex = mesh.vertices[index as usize];
        [0, 1, 2].map(|axis| vertex[axis] - point[axis])
    };
    let angles = mesh.triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(to);
        let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
        let volume = dot(a, cross(b, c));
        2.0 * volume.atan2(la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
    });
    angles.sum::<f64>() / (4.0 * std::f64::consts::PI)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
