//! Bounds of values and slopes along stretches, computed in f32, hold what is sampled there.

#![allow(clippy::expect_used, reason = "a test that cannot be set up fails")]

mod common;

use common::{each_node_in_shader, graph, steps};
use proptest::prelude::*;
use sdfc_graph::eval::{FrameValues, Tape};
use sdfc_graph::{
    Dim, FrameInput, Graph, NodeId, Stage, Ternary, Type, Unary, dump, enclosure, reachable,
    slope_enclosure,
};

/// Places of a stretch that are looked at, its ends among them.
const PLACES: usize = 33;
/// Values are compared whose size lies between these, or which are 0: beyond, f32 has other ideas.
const SIZES: std::ops::Range<f64> = 1e-9..1e9;
/// Numbers of a program count as infinite from here: the largest that a bound computed in f32 is.
const LARGE: f32 = 1e15;

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -4.0..4.0,
        2 => (-8_i32..8).prop_map(|i| f64::from(i) / 2.0),
        1 => -1000.0..1000.0,
    ]
}

/// One end, and the way to the other: of any length.
fn stretch() -> impl Strategy<Value = [[f64; 3]; 2]> {
    let length = (-3.0..1.0).prop_map(|power: f64| 10.0_f64.powf(power));
    let way = prop::array::uniform3(-1.0..1.0);
    (prop::array::uniform3(coordinate()), way, length).prop_map(|(a, way, length)| {
        // The ends and the way between them are numbers of f32.
        let a = a.map(coarse);
        [a, std::array::from_fn(|i| a[i] + coarse(way[i] * length))]
    })
}

fn coarse(x: f64) -> f64 {
    (x * 4096.0).round() / 4096.0
}

fn lerp([a, b]: [[f64; 3]; 2], part: f64) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + part * (b[i] - a[i]))
}

/// The places of a stretch.
fn places(stretch: [[f64; 3]; 2]) -> impl Iterator<Item = [f64; 3]> {
    (0..PLACES).map(move |i| lerp(stretch, i as f64 / (PLACES - 1) as f64))
}

/// Bounds of a root's value and of its slope, computed in f32.
struct Bounds {
    value: [f64; 2],
    slope: [f64; 2],
}

fn bounds(graph: &mut Graph, root: NodeId, stretch: [[f64; 3]; 2], param: f64) -> Option<Bounds> {
    // The first end is the point, so that all is computed in f32 but what is known per frame.
    let point = graph.point(0, Dim::Three);
    let way = graph.frame_input(FrameInput::Param(1), Type::Vec3);
    let end = graph.add(point, way);
    let mut roots = enclosure(graph, root, point, [point, end])?.to_vec();
    roots.extend(slope_enclosure(graph, root, point, [point, end], way)?);
    let tape = Tape::new(graph, &roots).expect("flat math");
    let [from, to] = stretch;
    let way: [f64; 3] = std::array::from_fn(|i| to[i] - from[i]);
    let params = vec![[param; 4], [way[0], way[1], way[2], 0.0]];
    let frame = FrameValues { params, time: 0.0, frame: 0.0 };
    let found = tape.prepare::<f32>(&frame).eval(from.map(|x| x as f32)).to_vec();
    let end = |i: usize| unless_endless(found[i][0]);
    Some(Bounds { value: [end(0), end(1)], slope: [end(2), end(3)] })
}

fn unless_endless(bound: f32) -> f64 {
    if bound.abs() >= LARGE { f64::INFINITY.copysign(f64::from(bound)) } else { f64::from(bound) }
}

/// A root's value at a place, and what f64 may have rounded off on the way to it.
#[derive(Clone, Copy)]
struct Sample {
    value: f64,
    rounding: f64,
}

/// A root's values at the places in f64; `None` where one of them rests on a number that f32 has other ideas of.
fn values(graph: &Graph, root: NodeId, stretch: [[f64; 3]; 2], param: f64) -> Option<Vec<Sample>> {
    let used = reachable(graph, &[root]);
    let tame = |lane: &f64| *lane == 0.0 || SIZES.contains(&lane.abs());
    let value = |point| {
        let all = each_node_in_shader(graph, point, param);
        // What large terms leave when they cancel is as rough as they are.
        let mut largest = 1.0_f64;
        for id in &used {
            for lane in all[id.index()]?.lanes() {
                if !tame(&lane) {
                    return None;
                }
                largest = largest.max(lane.abs());
            }
        }
        let value = all[root.index()]?.lanes()[0];
        let rounding = 1e-12 * value.abs().max(1.0) + 16.0 * f64::EPSILON * largest;
        Some(Sample { value, rounding })
    };
    places(stretch).map(value).collect()
}

/// A root's values at the places in f32, as a shader computes them.
fn singles(graph: &Graph, root: NodeId, stretch: [[f64; 3]; 2], param: f64) -> Vec<f32> {
    let tape = Tape::new(graph, &[root]).expect("flat math");
    let frame = FrameValues { params: vec![[param; 4]], time: 0.0, frame: 0.0 };
    let mut field = tape.prepare::<f32>(&frame);
    places(stretch).map(|place| field.scalar(place.map(|x| x as f32))).collect()
}

fn varies(graph: &Graph, id: NodeId) -> bool {
    graph.ty(id) == Type::Scalar && graph.stage(id) == Stage::Point
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(600) })]

    #[test]
    fn bounds_hold_every_sample(
        steps in steps(24),
        stretch in stretch(),
        param in -3.0..3.0_f32,
    ) {
        prop_assume!(stretch[0] != stretch[1]);
        let param = f64::from(param);
        let mut graph = graph(&steps);
        let roots: Vec<NodeId> =
            graph.ids().filter(|&id| varies(&graph, id)).collect();
        for &root in roots.iter().rev().take(6) {
            holds(&mut graph, root, stretch, param)?;
        }
    }
}

/// Whether the bounds of a root's value and slope along a stretch hold what is sampled there.
fn holds(
    graph: &mut Graph,
    root: NodeId,
    stretch: [[f64; 3]; 2],
    param: f64,
) -> Result<(), TestCaseError> {
    let Some(values) = values(graph, root, stretch, param) else { return Ok(()) };
    let Some(bounds) = bounds(graph, root, stretch, param) else { return Ok(()) };
    let Bounds { value: [lo, hi], slope } = bounds;
    for value in singles(graph, root, stretch, param) {
        let value = f64::from(value);
        prop_assert!(
            value.is_nan() || (lo <= value && value <= hi),
            "{value} is not in {lo}..{hi}, the bounds of:\n{}",
            dump(graph, &[("it", root)])
        );
    }
    let step = 1.0 / (PLACES - 1) as f64;
    for pair in values.windows(2) {
        let rounding = pair[0].rounding.max(pair[1].rounding);
        let rise = pair[1].value - pair[0].value;
        let [least, most] = slope.map(|end| end * step);
        prop_assert!(
            least - rounding <= rise && rise <= most + rounding,
            "{rise} is not in {step} times {slope:?}, the bounds of the slope of:\n{}",
            dump(graph, &[("it", root)])
        );
    }
    Ok(())
}

/// What is known per frame is a number of f32 in the field: bounds must not know it better.
#[test]
fn bounds_know_numbers_of_a_frame_as_the_field_does() {
    let mut graph = Graph::new();
    let point = graph.point(0, Dim::Three);
    let z = graph.component(point, 2);
    let param = graph.frame_input(FrameInput::Param(0), Type::Scalar);
    let near_one = graph.unary(Unary::Tanh, param);
    let mixed = graph.ternary(Ternary::Mix, z, near_one, near_one);
    let [lower, upper] = [999.9, 1000.0].map(|edge| graph.number(edge));
    let far = graph.add(z, upper);
    let steep = graph.ternary(Ternary::Smoothstep, lower, upper, far);
    for root in [mixed, steep] {
        let stretch = [[0.0; 3], [0.0, 0.0, -0.255_615_234_375]];
        holds(&mut graph, root, stretch, 2.993_918).expect("bounds that hold");
    }
}

/// The arc sine is infinitely steep at 1, where its argument may stay.
#[test]
fn what_stays_where_a_function_is_endlessly_steep_has_no_slope() {
    let mut graph = Graph::new();
    let point = graph.point(0, Dim::Three);
    let x = graph.component(point, 0);
    let param = graph.frame_input(FrameInput::Param(0), Type::Scalar);
    let lower = graph.unary(Unary::Trunc, param);
    let upper = graph.mul(x, param);
    let step = graph.ternary(Ternary::Smoothstep, lower, upper, upper);
    let sign = graph.unary(Unary::Sign, step);
    let stretch = [[1.0, 0.0, 0.0], [1.0, 0.0, -0.494_873_046_875]];
    for steep in [Unary::Asin, Unary::Acos] {
        let root = graph.unary(steep, sign);
        holds(&mut graph, root, stretch, 1.551_904).expect("bounds that hold");
    }
}
