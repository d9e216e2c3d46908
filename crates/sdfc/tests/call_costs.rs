//! An explanation says which calls the operations of a field are spent on.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use sdfc::Compiler;

/// Returns the names and lines of the calls that are reported.
fn reported(text: &str) -> Vec<(String, u32)> {
    let scene = Compiler::new().compile("costs.sdf", text).expect("no errors");
    let costs = scene.explain().expect("something is drawn").costs;
    assert!(costs.iter().all(|call| call.share >= 0.05 && call.operations > 0));
    costs.into_iter().map(|call| (call.name, call.line)).collect()
}

#[test]
fn the_innermost_call_that_costs_most_comes_first() {
    let clock = "let words = [\"10\", \"11\", \"12\"]\n\
                 union(for i in 0..3: text(words[i]).extrude(0.1).translate(x: i)).color(#202020)\n";
    assert_eq!(reported(clock), [("text".to_owned(), 2)]);
}

#[test]
fn calls_of_equal_cost_come_in_the_order_of_their_lines() {
    let words = "text(\"ab\").extrude(0.1)\ntext(\"ab\").extrude(0.1).translate(y: 2)\nbox(0.5)\n";
    assert_eq!(reported(words), [("text".to_owned(), 1), ("text".to_owned(), 2)]);
}

#[test]
fn small_scenes_report_no_costs() {
    assert_eq!(reported("sphere(1) | box(0.5)"), []);
}
