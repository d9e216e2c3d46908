//! Scenes that are not the example of an entry: false contracts, edge cases, and the entry that the
//! documentation adds.

use libtest_mimic::Trial;

use crate::contract::check_scene;

/// Contracts that are false, each in a different way.
const FALSE: [(&str, &str); 8] = [
    ("too steep to be exact", "solid wrong() exact bounds -1..1 = 1.1 * (length(p) - 1)\nwrong()"),
    ("outside its bounds", "solid wrong() exact bounds -0.9..0.9 = length(p) - 1\nwrong()"),
    ("steeper than stated", "solid wrong() lipschitz 0.9 bounds -1..1 = length(p) - 1\nwrong()"),
    (
        "farther than the surface",
        "solid wrong() bound outside bounds -1..1 = if length(p) < 1 { -1 } else { 1.01 * (length(p) - 1) }\nwrong()",
    ),
    // The corners are farther away than the planes.
    (
        "planes of an octahedron",
        "solid wrong() exact bounds -1..1 = (abs(p.x) + abs(p.y) + abs(p.z) - 1) / sqrt(3)\nwrong()",
    ),
    (
        "a point within the body",
        "solid wrong() exact bounds -1..1 = max(length(p) - 1, -length(p))\nwrong()",
    ),
    // The constant that is often given for a twist.
    (
        "the usual twist",
        "solid wrong() lipschitz sqrt(2) bounds -1..1 = rect([1.2, 0.1])([p.x * cos(p.y) - p.z * sin(p.y), p.x * sin(p.y) + p.z * cos(p.y)])\nwrong()",
    ),
    // Zero on a whole disc inside the solid, where there is no surface.
    (
        "a membrane",
        "solid wrong() exact bounds -1..1 = if abs(p.y) < 0.5 { -abs(p.y) } else { length(p) - 1 }\nwrong()",
    ),
];

/// Arguments for which formulas degenerate, and fields of several operators, whose contracts
/// interact.
const AWKWARD: [&str; 18] = [
    "torus(major: 0.3, minor: 0.5)",
    "capsule([0.1, 0.2, 0.3], [0.1, 0.2, 0.3], r: 0.3)",
    "box([2, 0.5, 0.02])",
    "ellipsoid([2, 0.5, 0.1])",
    "ellipsoid_fast([2, 0.5, 0.1])",
    "plane(y: 0.3, normal: [1, 2, 3])",
    "cylinder(r: 0.05, h: 2)",
    "circle(0.3).revolve()",
    "circle(0.3).translate(x: -0.1, y: 0.4).revolve()",
    "rect([0.4, 1]).translate(x: 0.2).revolve()",
    "box([0.6, 2, 0.6]).twist(-150deg)",
    // The gradient of this bound has no component towards the axis; far away that of an exact
    // distance has one.
    "solid plate() lipschitz 1 bounds [-1, -1, -0.05] .. [1, 1, 0.05] = max(abs(p.x) - 1, abs(p.y) - 1, abs(p.z) - 0.05)\nplate().twist(90deg)",
    "ellipsoid([0.9, 0.4, 0.2]).twist(90deg).scale(0.7)",
    "union(sphere(0.5), box(0.8).translate(x: 0.5), blend: smooth(0))",
    "intersection(sphere(0.7), box(1.1), blend: smooth(0.2))",
    "intersection(sphere(0.7), box(1.1), blend: smooth(0.2)) - torus(major: 0.3, minor: 0.5).translate(y: 1)",
    "difference(box(1), sphere(0.6), cylinder(r: 0.2, h: 2), blend: chamfer(0.1))",
    "rect([1, 0.3]).rotate(30deg).round(0.1).extrude(0.2).rotate(x: 50deg, y: -20deg)",
];

/// The same for solids that are a single expression.
const AWKWARD_SOLIDS: [&str; 109] = [
    "sphere(0)",
    "box([1, 0, 0.5])",
    "rounded_box([1, 0.4, 0.7], r: 0.2)",
    "rounded_box(1, r: 0)",
    "mitred_box([1, 0.3, 0])",
    "box_frame([1, 0.6, 0.8], wall: 0.7)",
    "box_frame([1, 0.6, 0.8], wall: 0.01)",
    "box_frame([1, 0.6, 0.8], wall: 0)",
    "slab(h: 0.4, normal: [0.3, -1, 0.2])",
    "slab(h: 0)",
    "tube(r: 0.5, wall: 0.5, h: 0.6)",
    "tube(r: 0.5, wall: 0.01, h: 0.2)",
    "cylinder(r: 0.5, h: 0)",
    "cylinder(r: 0, h: 1)",
    "cone(r: 1, h: 0.1)",
    "cone(r: 0.05, h: 1.5)",
    "cone(r: 0.5, h: 0)",
    "capped_cone(h: 1, r1: 0.2, r2: 0.7)",
    "capped_cone(h: 1, r1: 0.5, r2: 0.5)",
    "capped_cone(h: 0.1, r1: 1, r2: 0.2)",
    "capped_cone(h: 0.1, r1: 0.2, r2: 1)",
    "capped_cone(h: 0.5, r1: 0, r2: 0.6)",
    "capped_cone(h: 0, r1: 0.5, r2: 0.5)",
    "capped_cone(h: 0, r1: 0.5, r2: 0.2)",
    "capped_cone(h: 1, r1: 0, r2: 0)",
    "ellipsoid_fast(0.7)",
    "ellipsoid_fast([0.05, 1, 0.5])",
    "capped_torus(arc: 0deg, major: 0.6, minor: 0.2)",
    "capped_torus(arc: 90deg, major: 0.6, minor: 0.6)",
    "capped_torus(arc: 180deg, major: 0.6, minor: 0.7)",
    "capped_torus(arc: 300deg, major: 0.6, minor: 0.2)",
    "capped_torus(arc: 340deg, major: 0.6, minor: 0.2)",
    "capped_torus(arc: 360deg, major: 0.6, minor: 0.2)",
    "capped_torus(arc: 120deg, major: 0, minor: 0.2)",
    "link(straight: 0, major: 0.5, minor: 0.2)",
    "link(straight: 0.8, major: 0.2, minor: 0.3)",
    "link(straight: 0.8, major: 0, minor: 0.2)",
    "capped_cylinder([0, 0, 0], [0.4, 0.5, -0.6], r: 0.4)",
    "capped_cylinder([0.1, 0.3, 0.2], [0.1, 0.31, 0.2], r: 0.6)",
    "capped_cylinder([0.1, 0.3, 0.2], [0.1, -0.3, 0.2], r: 0)",
    "rounded_cylinder(r: 0.3, h: 1, edge: 0.3)",
    "rounded_cylinder(r: 0.5, h: 0.4, edge: 0.2)",
    "rounded_cylinder(r: 0.5, h: 0.4, edge: 0)",
    "round_cone(r1: 0.2, r2: 0.5)",
    "round_cone(r1: 0.3, r2: 0.3)",
    "round_cone(r1: 0, r2: 0.4)",
    "round_cone([0, 0, 0], [0.1, 0.2, 0.1], r1: 0.6, r2: 0.2)",
    "round_cone([0, 0, 0], [0.1, 0.2, 0.1], r1: 0.2, r2: 0.6)",
    "round_cone([0, 0, 0], [0, 0.3, 0], r1: 0.5, r2: 0.2)",
    "round_cone([0.1, 0, 0], [0.1, 0, 0], r1: 0.2, r2: 0.6)",
    "round_cone([0.1, 0, 0], [0.1, 0, 0], r1: 0.4, r2: 0.4)",
    "solid_angle(r: 0.9, open: 0deg)",
    "solid_angle(r: 0.9, open: 10deg)",
    "solid_angle(r: 0.9, open: 180deg)",
    "solid_angle(r: 0.9, open: 300deg)",
    "solid_angle(r: 0.9, open: 350deg)",
    "solid_angle(r: 0.9, open: 359.9deg)",
    "solid_angle(r: 0)",
    "cut_sphere(r: 0.8, y: 0)",
    "cut_sphere(r: 0.8, y: -0.5)",
    "cut_sphere(r: 0.8, y: -0.79)",
    "cut_sphere(r: 0.8, y: 0.8)",
    "cut_sphere(r: 0.8, y: -0.8)",
    "cut_sphere(r: 0)",
    "cut_hollow_sphere(r: 0.8, y: -0.4, wall: 0.3)",
    "cut_hollow_sphere(r: 0.8, y: 0.75, wall: 0.3)",
    "cut_hollow_sphere(r: 0.8, y: 0.75, wall: 0.8)",
    "cut_hollow_sphere(r: 0.4, y: -0.1, wall: 1.2)",
    "cut_hollow_sphere(r: 0.8, y: 0.8, wall: 0.2)",
    "cut_hollow_sphere(r: 0.8, y: -0.8, wall: 0.2)",
    "death_star(r1: 0.7, r2: 0.3, d: 0.9)",
    "death_star(r1: 0.7, r2: 1.2, d: 0.9)",
    "death_star(r1: 0.7, r2: 0.3, d: 0.2)",
    "death_star(r1: 0.7, r2: 0.3, d: 1)",
    "death_star(r1: 0.7, r2: 0.3, d: 2)",
    "death_star(r1: 0.7, r2: 0.3, d: 0)",
    "death_star(r1: 0.7, r2: 0, d: 0.5)",
    "vesica_segment([-0.5, 0, 0.2], [0.5, 0.3, 0.2], r: 0.01)",
    "vesica_segment(r: 0.5)",
    "helix(major: 0.5, minor: 0.3, pitch: 0.2, h: 0.5)",
    "helix(major: 0.5, minor: 0.1, pitch: -0.3, h: 1)",
    "helix(major: 0.5, minor: 0.1, pitch: 3, h: 2)",
    "helix(major: 0.5, minor: 0, pitch: 0.3, h: 2)",
    "tri_prism(r: 0.5, h: 0)",
    "tri_prism(r: 0, h: 1)",
    "hex_prism(r: 0.5, h: 0.01)",
    "hex_prism(r: 0, h: 1)",
    "rhombic_prism([1, 0.05], h: 1)",
    "rhombic_prism([0, 1], h: 0.2)",
    "pyramid(base: 1, h: 0)",
    "pyramid(base: 0, h: 1)",
    "pyramid(base: 1.5, h: 0.1)",
    "pyramid(base: 0.1, h: 1.5)",
    "octahedron(0)",
    "dodecahedron(0)",
    "icosahedron(0)",
    "triangle_plate([0, 0, 0], [0.5, 0, 0], [1, 0, 0], r: 0.1)",
    "triangle_plate([0, 0, 0], [0.5, 0.2, 0], [0, 0, 0], r: 0.1)",
    "triangle_plate([0.1, 0, 0], [0.1, 0, 0], [0.1, 0, 0], r: 0.1)",
    "triangle_plate([0, 0, 0], [1, 0, 0], [0.5, 0.02, 0.01], r: 0.3)",
    "triangle_plate(r: 0)",
    "quad_plate([0, 0, 0], [1, 0, 0.5], [1, 1, 0], [0, 1, 0.7], r: 0.1)",
    "quad_plate([0, 0, 0], [1, 0, 0], [0.2, 0.2, 0], [0, 1, 0], r: 0.1)",
    "quad_plate([0, 0, 0], [0, 0, 0], [0.2, 0.2, 0], [0, 1, 0], r: 0.1)",
    "gyroid(cell: 0.3, wall: 0)",
    "gyroid(cell: 2, wall: 0.6)",
    "schwarz_p(cell: 0.7, wall: 0.5)",
    "diamond(cell: 1, wall: 0.02)",
    "neovius(cell: 2, wall: 0.5)",
];

pub fn trials() -> Vec<Trial> {
    let mut trials = vec![Trial::test("documented entry", documented)];
    for (name, text) in FALSE {
        trials.push(Trial::test(format!("false/{name}"), move || match check_scene(text) {
            Ok(()) => Err(format!("nothing was found in {text}").into()),
            Err(found) if found.contains("compile") => Err(found.into()),
            Err(_) => Ok(()),
        }));
    }
    for text in AWKWARD.into_iter().chain(AWKWARD_SOLIDS) {
        let name = text.lines().last().unwrap_or(text);
        trials.push(Trial::test(format!("awkward/{name}"), move || Ok(check_scene(text)?)));
    }
    trials
}

/// Checks that the contract holds of the shape that the page on adding a shape shows.
fn documented() -> Result<(), libtest_mimic::Failed> {
    let page = include_str!("../../../../docs/contributing/add-a-shape.md");
    let entry = page
        .split("```sdf")
        .nth(1)
        .and_then(|rest| rest.split("```").next())
        .ok_or("the page shows an entry")?
        .trim();
    let example = entry.lines().find_map(|line| line.strip_prefix("/// example:"));
    Ok(check_scene(&format!("{entry}\n{}", example.ok_or("the entry has an example")?))?)
}
