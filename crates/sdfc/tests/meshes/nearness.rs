//! The certificate, checked by samples that share no code with the proof.

use sdfc::{Mesh, Scene};

use crate::{mesh, scene};

type Point = [f64; 3];

/// A source of pseudo-random numbers from 0 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The squared distance of a point from a triangle (Ericson, "Real-Time Collision Detection").
fn distance_squared(p: Point, [a, b, c]: [Point; 3]) -> f64 {
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    let at = |v: f64, w: f64| {
        let nearest = [0, 1, 2].map(|i| a[i] + v * ab[i] + w * ac[i]);
        dot(sub(p, nearest), sub(p, nearest))
    };
    if d1 <= 0.0 && d2 <= 0.0 {
        return at(0.0, 0.0);
    }
    let bp = sub(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return at(1.0, 0.0);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return at(d1 / (d1 - d3), 0.0);
    }
    let cp = sub(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return at(0.0, 1.0);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return at(0.0, d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(1.0 - w, w);
    }
    let sum = va + vb + vc;
    at(vb / sum, vc / sum)
}

/// Random points of the surface: where the field changes its sign between random points.
fn surface_points(scene: &Scene, count: usize) -> Vec<Point> {
    let mut field = scene.field(&scene.defaults()).unwrap();
    let [lo, hi] = scene.bounds_at(&scene.defaults()).unwrap();
    let mut random = Random(1);
    let mut points = Vec::new();
    let mut before = lo;
    while points.len() < count {
        let point: Point = [0, 1, 2].map(|i| lo[i] + random.next() * (hi[i] - lo[i]));
        let (mut a, mut b) = (before, point);
        before = point;
        let side = field.distance(a) < 0.0;
        if side == (field.distance(b) < 0.0) {
            continue;
        }
        for _ in 0..60 {
            let middle = [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]));
            if (field.distance(middle) < 0.0) == side { a = middle } else { b = middle }
        }
        points.push(a);
    }
    points
}

/// The greatest distance of points from a mesh.
fn farthest(points: &[Point], mesh: &Mesh) -> f64 {
    let nearest = |p: &Point| {
        let squared = mesh.triangles.iter().map(|t| distance_squared(*p, mesh.corners(*t)));
        squared.fold(f64::INFINITY, f64::min).sqrt()
    };
    points.iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn no_point_of_the_surface_is_farther_than_the_error() {
    for (source, relative) in [
        ("sphere(1)", 0.01),
        ("box([1, 0.7, 0.5]).rotate(x: 20deg, y: 30deg)", 0.01),
        ("torus(1, 0.3) - sphere(0.5).translate(x: 1)", 0.01),
    ] {
        let scene = scene(source);
        let mesh = mesh(&scene, relative);
        assert!(mesh.certificate.is_proven, "{source}: {:?}", mesh.certificate);
        let error = mesh.certificate.error;
        let found = farthest(&surface_points(&scene, 3000), &mesh);
        assert!(found <= error, "{source}: {found} > {error}");
        // The bound is not far from the truth, else this test could not fail.
        assert!(found > 0.02 * error, "{source}: {found} of {error}");
    }
}

#[test]
fn no_point_of_a_sphere_s_mesh_is_farther_than_the_error() {
    let scene = scene("sphere(1)");
    let mesh = mesh(&scene, 0.005);
    let mut random = Random(2);
    let mut farthest: f64 = 0.0;
    for triangle in &mesh.triangles {
        let [a, b, c] = mesh.corners(*triangle);
        for _ in 0..20 {
            let (u, v) = (random.next(), random.next());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let p = [0, 1, 2].map(|i| a[i] + u * (b[i] - a[i]) + v * (c[i] - a[i]));
            farthest = farthest.max((dot(p, p).sqrt() - 1.0).abs());
        }
    }
    assert!(mesh.certificate.is_proven);
    assert!(farthest <= mesh.certificate.error, "{farthest}");
}

#[test]
fn a_rotated_box_keeps_its_sharp_edges() {
    let mesh = mesh(&scene("box([1, 0.7, 0.5]).rotate(x: 20deg, y: 30deg)"), 0.01);
    // Edges cut off by the error would take away a few thousandths of the volume.
    let lost = 0.35 - mesh.volume();
    assert!(lost.abs() < 1e-4, "{lost}");
}
