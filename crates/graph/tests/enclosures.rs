//! Enclosures: bounds of values and slopes along segments, computed in f32, contain every sample.

#![allow(clippy::expect_used, reason = "a test that cannot be set up fails")]

mod common;

use common::{cases, each_node_in_shader, graph, steps};
use proptest::prelude::*;
use sdfc_graph::eval::{FrameValues, Tape};
use sdfc_graph::{
    Dim, FrameInput, Graph, NodeId, Stage, Ternary, Type, Unary, dump, reachable, slope_enclosure,
    tight_enclosure,
};

/// Number of sampled points of a segment, including its ends.
const POINTS: usize = 33;
/// Values are compared if they are 0 or their magnitude lies between these; beyond, f32 differs.
const SIZES: std::ops::Range<f64> = 1e-9..1e9;
/// Numbers from here on count as infinite in a program: the largest bound computed in f32.
const LARGE: f32 = 1e15;

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -4.0..4.0,
        2 => (-8_i32..8).prop_map(|i| f64::from(i) / 2.0),
        1 => -1000.0..1000.0,
    ]
}

/// One end of a segment, and its offset to the other: of any length.
fn segment() -> impl Strategy<Value = [[f64; 3]; 2]> {
    let length = (-3.0..1.0).prop_map(|power: f64| 10.0_f64.powf(power));
    let offset = prop::array::uniform3(-1.0..1.0);
    (prop::array::uniform3(coordinate()), offset, length).prop_map(|(a, offset, length)| {
        // The ends and the offset between them are representable in f32.
        let a = a.map(rounded);
        [a, std::array::from_fn(|i| a[i] + rounded(offset[i] * length))]
    })
}

fn rounded(x: f64) -> f64 {
    (x * 4096.0).round() / 4096.0
}

fn lerp([a, b]: [[f64; 3]; 2], t: f64) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + t * (b[i] - a[i]))
}

/// The sampled points of a segment.
fn points(segment: [[f64; 3]; 2]) -> impl Iterator<Item = [f64; 3]> {
    (0..POINTS).map(move |i| lerp(segment, i as f64 / (POINTS - 1) as f64))
}

/// Bounds of a root's value and of its slope, computed in f32.
struct Bounds {
    value: [f64; 2],
    slope: [f64; 2],
}

fn bounds(graph: &mut Graph, root: NodeId, segment: [[f64; 3]; 2], param: f64) -> Option<Bounds> {
    // The first end is the point, so that everything but per-frame values is computed in f32.
    let point = graph.point(0, Dim::Three);
    let offset = graph.frame_input(FrameInput::Param(1), Type::Vec3);
    let end = graph.add(point, offset);
    let mut roots = tight_enclosure(graph, root, point, [point, end])?.to_vec();
    roots.extend(slope_enclosure(graph, root, point, [point, end], offset)?);
    let tape = Tape::new(graph, &roots).expect("flat math");
    let [from, to] = segment;
    let offset: [f64; 3] = std::array::from_fn(|i| to[i] - from[i]);
    let params = vec![[param; 4], [offset[0], offset[1], offset[2], 0.0]];
    let frame = FrameValues { params, time: 0.0, frame: 0.0 };
    let found = tape.prepare::<f32>(&frame).eval(from.map(|x| x as f32)).to_vec();
    let end = |i: usize| or_infinity(found[i][0]);
    Some(Bounds { value: [end(0), end(1)], slope: [end(2), end(3)] })
}

fn or_infinity(bound: f32) -> f64 {
    if bound.abs() >= LARGE { f64::INFINITY.copysign(f64::from(bound)) } else { f64::from(bound) }
}

/// A root's value at a point, and a bound on its rounding error in f64.
#[derive(Clone, Copy)]
struct Sample {
    value: f64,
    rounding: f64,
}

/// A root's values at the sampled points in f64; `None` where one of them depends on a number that
/// differs in f32.
fn values(graph: &Graph, root: NodeId, segment: [[f64; 3]; 2], param: f64) -> Option<Vec<Sample>> {
    let used = reachable(graph, &[root]);
    let is_comparable = |lane: &f64| *lane == 0.0 || SIZES.contains(&lane.abs());
    let value = |point| {
        let all = each_node_in_shader(graph, point, param);
        // The difference of large terms is as imprecise as they are.
        let mut largest = 1.0_f64;
        for id in &used {
            for lane in all[id.index()]?.lanes() {
                if !is_comparable(&lane) {
                    return None;
                }
                largest = largest.max(lane.abs());
            }
        }
        let value = all[root.index()]?.lanes()[0];
        let rounding = 1e-12 * value.abs().max(1.0) + 16.0 * f64::EPSILON * largest;
        Some(Sample { value, rounding })
    };
    points(segment).map(value).collect()
}

/// A root's values at the sampled points in f32, as a shader computes them.
fn values_in_f32(graph: &Graph, root: NodeId, segment: [[f64; 3]; 2], param: f64) -> Vec<f32> {
    let tape = Tape::new(graph, &[root]).expect("flat math");
    let frame = FrameValues { params: vec![[param; 4]], time: 0.0, frame: 0.0 };
    let mut field = tape.prepare::<f32>(&frame);
    points(segment).map(|point| field.scalar(point.map(|x| x as f32))).collect()
}

fn varies(graph: &Graph, id: NodeId) -> bool {
    graph.ty(id) == Type::Scalar && graph.stage(id) == Stage::Point
}

proptest! {
    #![proptest_config(cases(600))]

    #[test]
    fn bounds_contain_every_sample(
        steps in steps(24),
        segment in segment(),
        param in -3.0..3.0_f32,
    ) {
        prop_assume!(segment[0] != segment[1]);
        let param = f64::from(param);
        let mut graph = graph(&steps);
        let roots: Vec<NodeId> =
            graph.ids().filter(|&id| varies(&graph, id)).collect();
        for &root in roots.iter().rev().take(6) {
            check_samples(&mut graph, root, segment, param)?;
        }
    }
}

/// Tests that the bounds of a root's value and slope along a segment contain every sample.
fn check_samples(
    graph: &mut Graph,
    root: NodeId,
    segment: [[f64; 3]; 2],
    param: f64,
) -> Result<(), TestCaseError> {
    let Some(values) = values(graph, root, segment, param) else { return Ok(()) };
    let Some(bounds) = bounds(graph, root, segment, param) else { return Ok(()) };
    let Bounds { value: [lo, hi], slope } = bounds;
    for value in values_in_f32(graph, root, segment, param) {
        let value = f64::from(value);
        prop_assert!(
            value.is_nan() || (lo <= value && value <= hi),
            "{value} is not in {lo}..{hi}, the bounds of:\n{}",
            dump(graph, &[("it", root)])
        );
    }
    let step = 1.0 / (POINTS - 1) as f64;
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

/// The field reads per-frame values as f32: bounds must not use more precise ones.
#[test]
fn bounds_cover_the_rounding_of_per_frame_values() {
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
        let segment = [[0.0; 3], [0.0, 0.0, -0.255_615_234_375]];
        check_samples(&mut graph, root, segment, 2.993_918).expect("valid bounds");
    }
}

/// The inverse sine is infinitely steep at 1, where its argument may be constant.
#[test]
fn a_constant_argument_has_slope_zero_where_the_function_is_infinitely_steep() {
    let mut graph = Graph::new();
    let point = graph.point(0, Dim::Three);
    let x = graph.component(point, 0);
    let param = graph.frame_input(FrameInput::Param(0), Type::Scalar);
    let lower = graph.unary(Unary::Trunc, param);
    let upper = graph.mul(x, param);
    let step = graph.ternary(Ternary::Smoothstep, lower, upper, upper);
    let sign = graph.unary(Unary::Sign, step);
    let segment = [[1.0, 0.0, 0.0], [1.0, 0.0, -0.494_873_046_875]];
    for steep in [Unary::Asin, Unary::Acos] {
        let root = graph.unary(steep, sign);
        check_samples(&mut graph, root, segment, 1.551_904).expect("valid bounds");
    }
}
