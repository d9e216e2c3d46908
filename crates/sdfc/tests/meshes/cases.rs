//! Scenes that are hard for meshes.

use proptest::prelude::*;
use sdfc::Scene;

use crate::{check, mesh, scene};

/// Scenes, the relative error, and whether everything is proven.
const CASES: &[(&str, &str, f64, bool)] = &[
    ("thin wall", "box([1, 1, 0.03])", 0.02, true),
    ("nested shells", "(sphere(1) - sphere(0.9)) | (sphere(0.8) - sphere(0.7))", 0.02, true),
    ("coplanar faces", "box([1, 1, 1]) | box([1, 1, 1]).translate(x: 0.7)", 0.02, true),
    ("faces that touch", "box([1, 1, 1]) | box([2, 0.2, 2]).translate(y: -0.6)", 0.02, true),
    ("a cut that ends in a face", "box([1, 1, 1]) - box([0.4, 1, 0.4])", 0.02, true),
    ("a ball in its hollow", "(box([2, 2, 2]) - sphere(0.7)) | sphere(0.7)", 0.02, true),
    ("steps", "box([1, 1, 1]) | box([0.5, 0.5, 0.5]).translate([0.5, 0.5, 0.25])", 0.02, true),
    (
        "barely closed gap",
        "union(sphere(1), sphere(1).translate(x: 2.05), blend: smooth(0.3))",
        0.02,
        true,
    ),
    ("cut corner", "box([1, 1, 1]) - sphere(0.6).translate([0.5, 0.5, 0.5])", 0.02, true),
    ("acute edge", WEDGE, 0.005, true),
    ("twisted bar", "box([0.4, 0.4, 1.6]).twist(rate: 60deg)", 0.02, false),
    ("cone", "cone(0.5, 1)", 0.02, false),
    ("tangent spheres", "sphere(1) | sphere(1).translate(x: 2)", 0.02, false),
];

/// Two boxes whose sides meet at 25 degrees.
const WEDGE: &str = "box(2) & box([4, 1, 4]).rotate(y: 30deg).rotate(x: 25deg).translate(y: -0.9)";

#[test]
fn hard_scenes_give_valid_meshes() {
    for (name, source, relative, is_proven) in CASES {
        let mesh = mesh(&scene(source), *relative);
        check(&mesh, name);
        let certificate = &mesh.certificate;
        let undecided = (certificate.undecided, certificate.undecided_boxes.first());
        assert!(certificate.is_proven || !is_proven, "{name}: {undecided:?}");
    }
}

/// The distance is 0 in the whole face that both parts share, so nothing is known of its boxes.
#[test]
fn parts_that_share_a_face_are_meshed_without_a_proof() {
    let source = "capped_cone(h: 5, r1: 5, r2: 4).translate(y: 2.5)\n\
                  cylinder(h: 5, r: 5).translate(y: 7.5)";
    let mesh = mesh(&scene(source), 0.002);
    check(&mesh, source);
    let undecided = mesh.certificate.undecided;
    assert!((1..200_000).contains(&undecided), "{undecided} undecided boxes");
}

/// The plate with holes of the cookbook.
const PLATE: &str = "let bolts = cylinder(r: 0.12, h: 1).translate(x: 0.7).polar_repeat(8)\n\
    cylinder(r: 1, h: 0.2) - bolts - cylinder(r: 0.35, h: 1)";

#[test]
fn scenes_with_edges_are_proven_with_few_triangles() {
    for (source, relative, most) in [(PLATE, 0.005, 4100), ("box([1, 0.7, 0.5])", 0.001, 600)] {
        let mesh = mesh(&scene(source), relative);
        assert!(mesh.certificate.is_proven, "{source}: {}", mesh.certificate);
        assert!(mesh.triangles.len() <= most, "{source}: {} triangles", mesh.triangles.len());
    }
}

#[test]
fn parts_cavities_and_holes_are_counted() {
    let source = "torus(1, 0.3)\n(sphere(1) - sphere(0.9)).translate(x: 4)\n\
        (box(1) - cylinder(r: 0.2, h: 2) - cylinder(r: 0.2, h: 2).rotate(x: 90deg)).translate(y: 4)";
    let mesh = mesh(&scene(source), 0.003);
    let shells = mesh.shells();
    let found: Vec<_> = shells.iter().map(|shell| (shell.holes, shell.is_cavity)).collect();
    // Two holes that cross, so that one solid is between their four ends.
    let expected = [(0, false), (0, true), (1, false), (3, false)];
    assert_eq!(found, expected.map(|(holes, is_cavity)| (Some(holes), is_cavity)));
}

/// True if no point of a grid is inside.
fn is_empty(scene: &Scene) -> bool {
    let mut field = scene.field(&scene.defaults()).unwrap();
    let at = |index: usize| -1.5 + 0.1 * index as f64;
    let mut points = (0..31 * 31 * 31).map(|i| [at(i % 31), at(i / 31 % 31), at(i / 961)]);
    points.all(|point| field.distance(point) > 0.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn random_blends_give_valid_meshes(
        at in prop::array::uniform3(-0.6..0.6),
        angle in 0.0..90.0,
        width in 0.05..0.5,
        operator in 0..3usize,
    ) {
        let operator = ["union", "intersection", "difference"][operator];
        let [x, y, z] = at;
        let source = format!(
            "{operator}(box([1, 0.8, 0.9]), torus(0.5, 0.3).rotate(x: {angle}deg)\
             .translate([{x}, {y}, {z}]), blend: smooth({width}))"
        );
        let scene = scene(&source);
        prop_assume!(!is_empty(&scene));
        check(&mesh(&scene, 0.03), &source);
    }
}
