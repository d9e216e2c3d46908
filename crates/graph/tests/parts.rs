//! The gradient part by part, and the order in which nodes are computed.

#![allow(clippy::expect_used, clippy::unwrap_used)]

mod twin;

use proptest::prelude::*;
use sdfc_graph::eval::{FrameValues, Tape};
use sdfc_graph::{
    Dim, Graph, NodeId, Type, gradient, gradient_in_parts, live_lanes, reachable, schedule,
};
use twin::{case, frame, maps, steps};

fn close(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-7 * (1.0 + a.abs().max(b.abs())) || (a.is_nan() && b.is_nan())
}

/// A sphere around a place.
fn ball(graph: &mut Graph, p: NodeId, centre: [f64; 3]) -> NodeId {
    let centre = graph.constant(Type::Vec3, &centre);
    let offset = graph.sub(p, centre);
    let length = graph.length(offset);
    let radius = graph.number(0.7);
    graph.sub(length, radius)
}

/// A quadratic smooth minimum.
fn smooth(graph: &mut Graph, a: NodeId, b: NodeId) -> NodeId {
    let (zero, width, factor) = (graph.number(0.0), graph.number(0.3), graph.number(0.8));
    let difference = graph.sub(b, a);
    let apart = graph.abs(difference);
    let overlap = graph.sub(width, apart);
    let overlap = graph.max(overlap, zero);
    let square = graph.mul(overlap, overlap);
    let dent = graph.mul(square, factor);
    let least = graph.min(a, b);
    graph.sub(least, dent)
}

/// A rotation about z by 0.4, then a translation.
fn moved(graph: &mut Graph, p: NodeId) -> NodeId {
    let (sin, cos) = 0.4_f64.sin_cos();
    let columns = [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
    let columns = columns.map(|column| graph.constant(Type::Vec3, &column));
    let turned = graph.transform(columns, p);
    let offset = graph.constant(Type::Vec3, &[0.3, -0.8, 0.1]);
    graph.sub(turned, offset)
}

/// Balls that are blended two by two; both halves of a blend are at moved points.
fn tree(graph: &mut Graph, p: NodeId, depth: u32) -> NodeId {
    if depth == 0 {
        return ball(graph, p, [0.1, 0.2, 0.3]);
    }
    let (left, right) = (moved(graph, p), p);
    let offset = graph.constant(Type::Vec3, &[1.3, 0.4, -0.2]);
    let right = graph.add(right, offset);
    let (a, b) = (tree(graph, left, depth - 1), tree(graph, right, depth - 1));
    smooth(graph, a, b)
}

/// Balls that are blended one after the other.
fn chain(graph: &mut Graph, p: NodeId, count: usize) -> NodeId {
    let mut field = ball(graph, p, [0.0; 3]);
    for i in 1..count {
        let x = i as f64;
        let next = ball(graph, p, [x * 0.4, (x * 0.7).sin(), (x * 1.3).cos()]);
        field = smooth(graph, field, next);
    }
    field
}

fn values(graph: &Graph, roots: &[NodeId], at: [f64; 3]) -> Vec<[f64; 4]> {
    let tape = Tape::new(graph, roots).expect("flat");
    tape.prepare::<f64>(&FrameValues::default()).eval(at).to_vec()
}

/// Checks that the parts keep at most `most` lanes alive, a sweep at least `least`, and that both
/// give the same.
fn check(graph: &mut Graph, field: NodeId, most: usize, least: usize) {
    let p = graph.point(0, Dim::Three);
    let sweep = gradient(graph, field, p);
    let parts = gradient_in_parts(graph, field, p, 8).expect("there are parts");
    let lanes = [parts, sweep].map(|root| live_lanes(graph, &[root]));
    assert!(lanes[0] <= most && lanes[1] >= least, "{lanes:?}");
    for at in [[0.2, 0.1, -0.4], [3.0, 1.0, 2.0], [-1.0, 0.6, 0.0]] {
        let found = values(graph, &[sweep, parts], at);
        assert!(found[0].iter().zip(found[1]).all(|(&a, b)| close(a, b)), "{at:?}: {found:?}");
    }
}

#[test]
fn parts_of_a_chain_keep_few_values_alive() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let field = chain(&mut graph, p, 40);
    check(&mut graph, field, 20, 150);
}

#[test]
fn parts_of_a_tree_keep_few_values_alive() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let field = tree(&mut graph, p, 5);
    check(&mut graph, field, 40, 100);
}

#[test]
fn a_long_chain_of_blends_is_cut_in_linear_time() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let field = chain(&mut graph, p, 4000);
    check(&mut graph, field, 20, 1000);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn parts_give_the_gradient_of_the_sweep(
        steps in prop_oneof![steps(60), maps(20)],
        at in prop::array::uniform3(-3.0..3.0),
        param in -2.0..2.0,
        least in 1_usize..12,
    ) {
        let mut case = case(&steps, at, param);
        if case.expected().is_none() {
            return Ok(());
        }
        let field = if steps.len() % 2 == 0 {
            case.scalar()
        } else {
            let vector = case.vector();
            case.graph.length(vector)
        };
        let sweep = gradient(&mut case.graph, field, case.point);
        let Some(parts) = gradient_in_parts(&mut case.graph, field, case.point, least) else {
            return Ok(());
        };
        let tape = Tape::new(&case.graph, &[sweep, parts]).unwrap();
        let found = tape.prepare::<f64>(&frame(param)).eval(at).to_vec();
        if found[0].iter().any(|lane| lane.abs() > 1e6) {
            return Ok(());
        }
        for (a, b) in found[0].into_iter().zip(found[1]) {
            prop_assert!(
                close(a, b),
                "{found:?}\n{}",
                sdfc_graph::dump(&case.graph, &[("f", field)])
            );
        }
    }

    #[test]
    fn a_schedule_computes_each_node_once_and_arguments_first(steps in steps(60)) {
        let case = case(&steps, [0.1, 0.2, 0.3], 0.5);
        let (graph, root) = (&case.graph, case.scalar());
        let members = reachable(graph, &[root]);
        let order = schedule(graph, &[root], &members, |id| graph.arguments(id).collect());
        let time = |id: NodeId| order.iter().position(|&other| other == id);
        prop_assert_eq!(order.len(), members.len());
        for &id in &members {
            for argument in graph.arguments(id) {
                prop_assert!(time(argument) < time(id));
            }
        }
    }
}
