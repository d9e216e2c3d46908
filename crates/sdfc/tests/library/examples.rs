//! Scenes that are no entry's example: false contracts, and the entry that the documentation adds.

use libtest_mimic::Trial;

use crate::contract::check_scene;

/// Contracts that are false, each in its own way.
const FALSE: [(&str, &str); 6] = [
    ("too steep to be exact", "solid wrong() exact bounds -1..1 = 1.1 * (length(p) - 1)\nwrong()"),
    ("outside its bounds", "solid wrong() exact bounds -0.9..0.9 = length(p) - 1\nwrong()"),
    ("steeper than stated", "solid wrong() lipschitz 0.9 bounds -1..1 = length(p) - 1\nwrong()"),
    (
        "farther than the surface",
        "solid wrong() bound outside bounds -1..1 = if length(p) < 1 { -1 } else { 1.01 * (length(p) - 1) }\nwrong()",
    ),
    // The constant that is often given for a twist.
    (
        "the usual twist",
        "solid wrong() lipschitz sqrt(2) bounds -1..1 = rect([1.2, 0.1])([p.x * cos(p.y) - p.z * sin(p.y), p.x * sin(p.y) + p.z * cos(p.y)])\nwrong()",
    ),
    // Zero all over a disc within the body, where no surface is.
    (
        "a membrane",
        "solid wrong() exact bounds -1..1 = if abs(p.y) < 0.5 { -abs(p.y) } else { length(p) - 1 }\nwrong()",
    ),
];

/// Arguments where formulas degenerate, and fields of several operators, where contracts meet.
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
    // A bound whose gradient has no part towards the axis, which an exact distance has far out.
    "solid plate() lipschitz 1 bounds [-1, -1, -0.05] .. [1, 1, 0.05] = max(abs(p.x) - 1, abs(p.y) - 1, abs(p.z) - 0.05)\nplate().twist(90deg)",
    "ellipsoid([0.9, 0.4, 0.2]).twist(90deg).scale(0.7)",
    "union(sphere(0.5), box(0.8).translate(x: 0.5), blend: smooth(0))",
    "intersection(sphere(0.7), box(1.1), blend: smooth(0.2))",
    "intersection(sphere(0.7), box(1.1), blend: smooth(0.2)) - torus(major: 0.3, minor: 0.5).translate(y: 1)",
    "difference(box(1), sphere(0.6), cylinder(r: 0.2, h: 2), blend: chamfer(0.1))",
    "rect([1, 0.3]).rotate(30deg).round(0.1).extrude(0.2).rotate(x: 50deg, y: -20deg)",
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
    for text in AWKWARD {
        let name = text.lines().last().unwrap_or(text);
        trials.push(Trial::test(format!("awkward/{name}"), move || Ok(check_scene(text)?)));
    }
    trials
}

/// The page on adding a shape shows one whose contract holds.
fn documented() -> Result<(), libtest_mimic::Failed> {
    let page = include_str!("../../../../docs/adding-a-shape.md");
    let entry = page
        .split("```sdf")
        .nth(1)
        .and_then(|rest| rest.split("```").next())
        .ok_or("the page shows an entry")?
        .trim();
    let example = entry.lines().find_map(|line| line.strip_prefix("/// example:"));
    Ok(check_scene(&format!("{entry}\n{}", example.ok_or("the entry has an example")?))?)
}
