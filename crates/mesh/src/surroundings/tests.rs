//! What is proven about a box agrees with walls that rays find from points of its surface.
//!
//! The limits are above the thickness of the walls, so that only the proof can stop the search.

use std::collections::BTreeMap;

use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use sdfc_graph::eval::{FrameValues, Tape};
use sdfc_graph::{Dim, Graph, NodeId, Unary};

use super::*;
use crate::vector::between;

/// Steps of the rays, and their number.
const STEP: f64 = 2e-3;
const STEPS: usize = 1500;
/// Error of the walls that rays find.
const ERROR: f64 = 1e-6;

/// A solid: its name, and how its field is built at a point.
type Solid = (&'static str, fn(&mut Graph, NodeId) -> NodeId);

const SOLIDS: [Solid; 6] = [
    ("a shell", |graph, p| {
        let (outer, inner) = (ball(graph, p, [0.0; 3], 1.0), ball(graph, p, [0.1, 0.0, 0.0], 0.8));
        cut(graph, outer, inner)
    }),
    ("a block with a cavity", |graph, p| {
        let (block, ball) =
            (block(graph, p, [0.5, 0.4, 0.6]), ball(graph, p, [0.1, 0.05, 0.0], 0.3));
        cut(graph, block, ball)
    }),
    ("a thin plate", |graph, p| block(graph, p, [0.8, 0.05, 0.7])),
    ("a wedge of 30 degrees", |graph, p| {
        let lower = half_space(graph, p, [0.0, -1.0, 0.0], 0.0);
        let (sin, cos) = 30_f64.to_radians().sin_cos();
        let upper = half_space(graph, p, [-sin, cos, 0.0], 0.0);
        let both = graph.max(lower, upper);
        let block = block(graph, p, [0.9; 3]);
        graph.max(both, block)
    }),
    ("a rotated bar", |graph, p| {
        let columns = [[0.8, 0.6, 0.0], [-0.48, 0.64, 0.6], [0.36, -0.48, 0.8]];
        let columns = columns.map(|column| graph.constant(sdfc_graph::Type::Vec3, &column));
        let rotated = graph.transform(columns, p);
        block(graph, rotated, [0.1, 0.9, 0.2])
    }),
    ("two balls in a smooth blend", |graph, p| {
        let (a, b) = (ball(graph, p, [-0.3, 0.0, 0.0], 0.4), ball(graph, p, [0.35, 0.1, 0.0], 0.3));
        // -ln(exp(-8 a) + exp(-8 b)) / 8
        let of = |graph: &mut Graph, a: NodeId| {
            let factor = graph.number(-8.0);
            let scaled = graph.mul(a, factor);
            graph.unary(Unary::Exp, scaled)
        };
        let (a, b) = (of(graph, a), of(graph, b));
        let sum = graph.add(a, b);
        let log = graph.unary(Unary::Log, sum);
        let factor = graph.number(-0.125);
        let blend = graph.mul(log, factor);
        let hole = ball(graph, p, [0.3, 0.1, 0.2], 0.15);
        cut(graph, blend, hole)
    }),
];

fn ball(graph: &mut Graph, p: NodeId, center: Vec3, radius: f64) -> NodeId {
    let center = graph.constant(sdfc_graph::Type::Vec3, &center);
    let offset = graph.sub(p, center);
    let (length, radius) = (graph.length(offset), graph.number(radius));
    graph.sub(length, radius)
}

fn half_space(graph: &mut Graph, p: NodeId, normal: Vec3, height: f64) -> NodeId {
    let normal = graph.constant(sdfc_graph::Type::Vec3, &normal);
    let (along, height) = (graph.dot(p, normal), graph.number(height));
    graph.sub(along, height)
}

fn block(graph: &mut Graph, p: NodeId, half: Vec3) -> NodeId {
    let faces = [0, 1, 2].map(|axis| {
        let x = graph.component(p, axis as u8);
        let (x, half) = (graph.abs(x), graph.number(half[axis]));
        graph.sub(x, half)
    });
    let two = graph.max(faces[0], faces[1]);
    graph.max(two, faces[2])
}

fn cut(graph: &mut Graph, a: NodeId, b: NodeId) -> NodeId {
    let outside = graph.neg(b);
    graph.max(a, outside)
}

/// Returns the point of the surface near another one.
fn surface(prober: &mut Prober<'_>, mut point: Vec3) -> Option<Vec3> {
    for _ in 0..30 {
        let (value, gradient) = prober.sample(point);
        point = add(point, scale(unit(gradient)?, -value / length(gradient)));
    }
    (prober.value(point).abs() < 1e-12).then_some(point)
}

/// Returns the thickness of the wall at a point of the surface, found by small steps.
fn wall(prober: &mut Prober<'_>, begin: Vec3) -> Option<f64> {
    let normal = unit(prober.sample(begin).1)?;
    let at = |t: f64| add(begin, scale(normal, -t));
    let end = (1..STEPS).map(|step| step as f64 * STEP).find(|&t| prober.value(at(t)) > 0.0)?;
    if end <= STEP {
        return None;
    }
    let [mut from, mut to] = [end - STEP, end];
    for _ in 0..50 {
        let middle = 0.5 * (from + to);
        if prober.value(at(middle)) > 0.0 { to = middle } else { from = middle }
    }
    let other = unit(prober.sample(at(to)).1)?;
    (angle_between(normal, other) > LEAST_TURN + 1e-6).then_some(to)
}

/// A box near the surface, and a limit.
#[derive(Clone, Debug)]
struct Case {
    point: Vec3,
    side: f64,
    limit: f64,
    shifts: Vec<Vec3>,
}

fn case() -> impl Strategy<Value = Case> {
    let coordinates = |most: f64| prop::array::uniform3(-most..most);
    let sizes = (-6.0..-1.5_f64, -3.0..1.0_f64);
    let shifts = prop::collection::vec(coordinates(0.5), 8);
    (coordinates(1.0), sizes, shifts).prop_map(|(point, (side, limit), shifts)| Case {
        point,
        side: side.exp(),
        limit: limit.exp(),
        shifts,
    })
}

#[test]
fn no_wall_from_a_box_is_thinner_than_what_is_proven() {
    for (name, solid) in SOLIDS {
        let mut graph = Graph::new();
        let p = graph.point(0, Dim::Three);
        let root = solid(&mut graph, p);
        let tape = Tape::new(&graph, &[root]).unwrap();
        let frame = FrameValues::default();
        let field = LocalField::new(&tape, &frame);
        let counts = std::cell::RefCell::new(BTreeMap::<&str, u32>::new());
        let count = |what| *counts.borrow_mut().entry(what).or_default() += 1;
        let check = |case: Case| {
            let mut prober = field.prober();
            let Some(center) = surface(&mut prober, case.point) else { return Ok(()) };
            // The surface is anywhere in the box.
            let corner = |shift: f64| {
                [0, 1, 2].map(|axis| center[axis] + case.side * (case.shifts[0][axis] + shift))
            };
            let bounds = [corner(-0.5), corner(0.5)];
            let found = Surroundings::new(&field, case.side).examine(bounds, case.limit);
            let Found::Thickness(proven) = found else {
                return Err(TestCaseError::fail(format!("{name}: {center:?} is in {bounds:?}")));
            };
            count(if proven >= case.limit {
                "whole"
            } else if proven > 0.0 {
                "part"
            } else {
                "none"
            });
            for shift in &case.shifts {
                let point = add(between(bounds[0], bounds[1], 0.5), scale(*shift, case.side));
                let Some(begin) = surface(&mut prober, point) else { continue };
                let is_in_box = (0..3)
                    .all(|axis| bounds[0][axis] <= begin[axis] && begin[axis] <= bounds[1][axis]);
                let Some(thickness) = wall(&mut prober, begin).filter(|_| is_in_box) else {
                    continue;
                };
                count("walls");
                prop_assert!(
                    proven <= thickness + ERROR,
                    "{name}: {proven} is proven in {bounds:?}, and {thickness} is found at {begin:?}"
                );
            }
            Ok(())
        };
        let config =
            ProptestConfig { cases: 1500, failure_persistence: None, ..Default::default() };
        let mut runner = TestRunner::new(config);
        runner.run(&case(), check).unwrap_or_else(|fault| panic!("{name}: {fault}"));
        let counts = counts.into_inner();
        let of = |what| counts.get(what).copied().unwrap_or(0);
        assert!(of("walls") > 200 && of("part") > 10 && of("whole") > 10, "{name}: {counts:?}");
    }
}
