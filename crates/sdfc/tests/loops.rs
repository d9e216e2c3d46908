//! Loops over similar parts give the same field as the unrolled formula.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use std::collections::HashSet;
use std::fmt::Write;

use sdfc::{Compiler, LoopStrategy, Scene};
use sdfc_graph::eval::{FrameValues, Tape, sample_field};
use sdfc_graph::reachable;

/// Number of parts.
const PARTS: usize = 60;

/// Returns numbers that look irregular.
fn number(seed: usize) -> f64 {
    (seed as f64 * 0.618_033_988_75).fract() * 2.0 - 1.0
}

fn position(i: usize) -> [f64; 3] {
    [1, 2, 3].map(|axis| 2.0 * number(axis * 31 + 7 * i))
}

fn place(i: usize) -> String {
    let [x, y, z] = position(i);
    format!(".translate([{x:.4}, {y:.4}, {z:.4}])")
}

/// Returns balls, boxes and rotated pairs, joined by a hard minimum.
fn scattered() -> String {
    let mut text = "plane(y: -3)\n".to_owned();
    for i in 0..PARTS {
        let (size, at) = (0.3 + 0.1 * number(i), place(i));
        // Writing to a `String` cannot fail.
        let _ = match i % 3 {
            0 => writeln!(text, "sphere({size:.3}){at}"),
            1 => writeln!(text, "box([{size:.3}, 0.2, 0.4]).rotate(y: {i}deg){at}"),
            _ => writeln!(text, "difference(box({size:.3}), sphere(0.2)){at}"),
        };
    }
    text
}

/// Returns balls, then boxes, blended in that order.
fn chained(blend: &str) -> String {
    let mut text = "union(\n".to_owned();
    for i in 0..PARTS {
        let shape = if i < PARTS / 2 { "sphere(0.3)" } else { "box([0.3, 0.4, 0.2])" };
        let _ = writeln!(text, "  {shape}{},", place(i));
    }
    text + "  blend: " + blend + ")\n"
}

/// Returns balls, boxes and hollow balls by turns, as arguments of a call.
fn alternating() -> String {
    let shape = |i: usize| match i % 3 {
        0 => format!("sphere({:.3})", 0.3 + 0.1 * number(i)),
        1 => "box([0.3, 0.4, 0.2])".to_owned(),
        _ => "difference(sphere(0.3), sphere(0.2))".to_owned(),
    };
    (0..PARTS).map(|i| format!("\n  {}{},", shape(i), place(i))).collect()
}

fn compiled(text: &str, loops: LoopStrategy) -> Scene {
    let scene = Compiler::new().loops(loops).compile("rolled.sdf", text).expect("no errors");
    assert_eq!(scene.diagnostics().to_string(), "");
    scene
}

/// Returns the points at which fields are compared, on and off the parts.
fn points() -> Vec<[f64; 3]> {
    (0..400).map(|i| [1, 2, 3].map(|axis| 3.0 * number(axis * 17 + 13 * i))).collect()
}

fn compare(text: &str) -> Scene {
    let scenes = [LoopStrategy::Unrolled, LoopStrategy::Looped].map(|loops| compiled(text, loops));
    compare_fields(&scenes, &FrameValues::defaults(scenes[0].params()));
    assert!(scenes[0].report().loops.is_empty());
    let [_, rolled] = scenes;
    rolled
}

fn compare_fields(scenes: &[Scene; 2], frame: &FrameValues) {
    let samples = scenes
        .each_ref()
        .map(|scene| sample_field(scene.program(), frame, &points()).expect("something is drawn"));
    for (point, (inline, rolled)) in points().iter().zip(samples[0].iter().zip(&samples[1])) {
        let off = (inline.distance - rolled.distance).abs();
        assert!(off < 1e-12, "{point:?}: {} and {}", inline.distance, rolled.distance);
        for axis in 0..3 {
            let off = (inline.gradient[axis] - rolled.gradient[axis]).abs();
            assert!(off < 1e-9, "{point:?}: {:?} and {:?}", inline.gradient, rolled.gradient);
        }
    }
}

#[test]
fn each_kind_in_a_hard_union_becomes_a_loop() {
    let rolled = compare(&scattered());
    let mut loops = rolled.report().loops.clone();
    loops.sort_by_key(|found| found.operands);
    assert_eq!(loops.iter().map(|found| found.operands).collect::<Vec<_>>(), [20, 20, 20]);
    assert!(loops.iter().all(|found| !found.blended));
    // The floor is intersected analytically; the loops are marched.
    assert_eq!(rolled.report().analytic.len(), 1);
}

#[test]
fn each_run_in_a_blended_union_becomes_a_loop() {
    for blend in ["smooth(0.2)", "smooth_cubic(0.3)"] {
        let rolled = compare(&chained(blend));
        let loops = &rolled.report().loops;
        // The first loop starts from the first ball.
        let operands: Vec<usize> = loops.iter().map(|found| found.operands).collect();
        assert_eq!(operands, [PARTS / 2 - 1, PARTS / 2]);
        assert!(loops.iter().all(|found| found.blended));
    }
}

#[test]
fn kinds_that_alternate_in_a_blended_union_share_a_loop() {
    let rolled = compare(&format!("union({}\n  blend: smooth(0.2))\n", alternating()));
    let loops = &rolled.report().loops;
    assert_eq!(loops.iter().map(|found| found.operands).collect::<Vec<_>>(), [PARTS - 1]);
    assert!(loops[0].blended);
}

#[test]
fn params_stay_params() {
    let text = format!(
        "param r: length = 0.2 in 0..1\nparam k: length = 0.2 in 0.1..1\n{}",
        chained("smooth(k)").replace("sphere(0.3)", "sphere(r)")
    );
    let rolled = compare(&text);
    assert_eq!(rolled.report().loops.len(), 2);
}

/// Compares fields for the defaults of the params and for other values, and returns the numbers of
/// parts in loops.
fn parts_in_loops(text: &str) -> Vec<usize> {
    let rolled = compare(text);
    let scenes = [compiled(text, LoopStrategy::Unrolled), rolled];
    let mut frame = FrameValues::defaults(scenes[0].params());
    for round in 1..4 {
        frame.time = 0.3 * f64::from(round);
        for param in &mut frame.params {
            *param = param.map(|lane| lane * 1.3 + 0.01);
        }
        compare_fields(&scenes, &frame);
    }
    scenes[1].report().loops.iter().map(|found| found.operands).collect()
}

#[test]
fn parts_that_params_and_time_move_share_a_loop() {
    let text = "param gap = 0.2 in 0.1..1
param turn: angle = 10deg
param shade: color = #806040
let shift = shade.rgb / 4
let parts = 24
";
    // The graph has folded `0 * gap` and `1 * gap`.
    let placed = "union(for i in 0..parts:
      box([0.2, 0.1 + 0.01 * i, gap]).translate([i * gap, 0.1, (i % 3) * gap - 0.2]))\n";
    assert_eq!(parts_in_loops(&format!("{text}{placed}")), [24]);
    let driven = "union(for i in 0..parts:
      sphere(0.05 + 0.1 * gap * i / parts).translate(i * shift - [0, 0.1 + time, gap]))\n";
    assert_eq!(parts_in_loops(&format!("{text}{driven}")), [24]);
    let waving = "union(for i in 0..parts:
      sphere(0.1).translate([0.1 * i, 0.2 * sin(0.3 * i + time), 0.3 * sqrt(i + gap)]))\n";
    assert_eq!(parts_in_loops(&format!("{text}{waving}")), [24]);
    // The first part is not rotated, and the second one by exactly `turn`.
    let turned = "union(for i in 0..parts:
      box([0.3, 0.1, 0.2]).rotate(y: i * turn).translate(x: 0.5))\n";
    assert_eq!(parts_in_loops(&format!("{text}{turned}")), [23]);
    let blended =
        "union(for i in 0..parts: sphere(0.1).translate(x: i * gap), blend: smooth(0.1))\n";
    assert_eq!(parts_in_loops(&format!("{text}{blended}")), [23]);
}

#[test]
fn parts_with_a_param_each_do_not_keep_others_out_of_a_loop() {
    let mut text = String::new();
    for i in 0..20 {
        let _ = writeln!(text, "param p{i} = {} in 0..1", 0.02 * i as f64 + 0.1);
        let _ = writeln!(text, "sphere(0.1).translate([p{i}, 0, 1])");
    }
    for i in 0..30 {
        let _ = writeln!(text, "sphere(0.1){}", place(i));
    }
    assert_eq!(parts_in_loops(&text), [30]);
}

/// Their outlines have lists and loops of different lengths.
#[test]
fn similar_texts_and_polygons_share_a_loop() {
    let texts = "union(for i in 0..5: text(str(7 * i + 8), size: 0.6).extrude(0.1 + 0.02 * i)
      .rotate(z: 20deg + 9deg * i).translate([0.7 * i - 1, 0.3 * i, 0.2])\n      .color(hsl(30deg * i, 0.8, 0.5)))\n";
    let rolled = compare(texts);
    assert_eq!(rolled.report().loops.iter().map(|it| it.operands).sum::<usize>(), 5);
    // Rays pass by most of them: boxes around them tell which.
    assert_eq!(rolled.program().cullable_loops.len(), rolled.report().loops.len());
    let stars = "union(for n in 5..9: polygon([for i in 0..(6 * n):
      (0.3 + 0.2 * (i % 2)) * [cos(i * 60deg / n), sin(i * 60deg / n)]])
      .extrude(0.1).translate([n - 7, 0.1 * n, 0]))\n";
    assert_eq!(compare(stars).report().loops.iter().map(|it| it.operands).sum::<usize>(), 4);
}

#[test]
fn infinite_blends_and_few_similar_parts_stay_unrolled() {
    let rolled = compare(&chained("smooth_exp(0.1)"));
    assert!(rolled.report().loops.is_empty());
    assert!(compare("sphere(1) | box(1.5)").report().loops.is_empty());
}

#[test]
fn four_long_parts_become_a_loop() {
    let long = |parts: usize| -> String {
        let corner = |at: usize| format!("[{:.2}, {:.2}]", number(at) + 2.0, 0.3 * at as f64);
        let corners: Vec<_> = (0..8).map(corner).collect();
        let plate = format!("polygon([{}]).extrude(0.3)", corners.join(", "));
        let part = |at| format!("({plate} & {plate}.rotate(x: 90deg)){}\n", place(at));
        (0..parts).map(part).collect()
    };
    assert_eq!(compare(&long(4)).report().loops.len(), 1);
    assert!(compare(&long(3)).report().loops.is_empty());
    let short: String = (0..15).map(|at| format!("sphere(0.3){}\n", place(at))).collect();
    assert!(compare(&short).report().loops.is_empty());
}

/// Returns parts of several kinds with materials of several kinds. Some boxes have the place and
/// outside the distance of hollow boxes before them.
fn colored() -> String {
    let mut text = "let parts = [\n".to_owned();
    for i in 0..3 * PARTS {
        let (size, at) = (0.3 + 0.1 * number(i), place(i));
        let color = format!("oklch(0.7, 0.1, {i}deg)");
        let _ = match i % 5 {
            0 => writeln!(text, "  box(0.3){}.color({color}),", place(i.max(1) - 1)),
            1 => writeln!(text, "  sphere({size:.3}){at}.color({color}).roughness(0.{i:03}),"),
            2 => writeln!(text, "  sphere({size:.3}){at}.color(checker({color}, #000000)),"),
            3 => writeln!(text, "  torus({size:.3}, 0.1){at},"),
            _ => writeln!(text, "  difference(box(0.3), sphere(0.1)){at}.color({color}),"),
        };
    }
    text + "]\n"
}

/// Compares the materials of both ways of writing, also where parts are equally near.
fn compare_materials(text: &str) {
    let scenes = [LoopStrategy::Unrolled, LoopStrategy::Looped].map(|loops| compiled(text, loops));
    assert!(!scenes[1].report().loops.is_empty());
    let frame = FrameValues::defaults(scenes[0].params());
    let roots = |scene: &Scene| scene.program().material.expect("the scene has materials");
    let nodes = |scene: &Scene| reachable(&scene.program().graph, &roots(scene)).len();
    let nodes = scenes.each_ref().map(nodes);
    assert!(nodes[1] * 4 < nodes[0], "{nodes:?}");
    let tapes = scenes.each_ref().map(|scene| {
        Tape::new(&scene.program().graph, &roots(scene)).expect("the program is flat")
    });
    let [mut unrolled, mut looped] = tapes.each_ref().map(|tape| tape.prepare::<f64>(&frame));
    let mut shown = HashSet::new();
    let beside = |i| position(i).map(|coordinate| coordinate + 0.3 * number(i));
    for point in points().into_iter().chain((0..3 * PARTS).map(beside)) {
        let (expected, found) = (unrolled.eval(point), looped.eval(point));
        for (expected, found) in expected.iter().flatten().zip(found.iter().flatten()) {
            assert!((expected - found).abs() < 1e-12, "{point:?}: {expected} and {found}");
        }
        shown.insert(expected[0].map(f64::to_bits));
    }
    assert!(shown.len() > PARTS / 3, "only {} colours are compared", shown.len());
}

#[test]
fn the_nearest_part_of_a_looped_union_shows_its_material() {
    compare_materials(&(colored() + "union(parts)"));
}

#[test]
fn a_looped_union_below_other_operations_shows_its_materials() {
    let carved = "difference(union(parts), sphere(0.3).color(#ff0000)) | plane(y: -1)";
    compare_materials(&(colored() + carved));
}

#[test]
fn a_looped_chain_of_blends_mixes_the_materials_of_its_parts() {
    for blend in ["smooth(0.2)", "smooth_cubic(0.3)"] {
        compare_materials(&(colored() + "union(parts, blend: " + blend + ")"));
    }
    let around = "difference(union(parts, blend: smooth(0.2)), sphere(0.3).color(#ff0000))";
    compare_materials(&(colored() + around + ".rotate(y: 20deg) | plane(y: -1)"));
}

#[test]
fn a_looped_chain_goes_on_from_another_one() {
    let more = alternating().replace(",\n", ".color(#00ff00),\n");
    let text = format!("union(union(parts, blend: smooth(0.2)), {more}\n  blend: smooth(0.2))\n");
    compare_materials(&(colored() + &text));
}
