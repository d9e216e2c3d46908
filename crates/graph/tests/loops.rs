//! A loop computes the same as its unrolled iterations: values, ranges and derivatives.

#![allow(clippy::expect_used, reason = "a test that cannot be set up fails")]

use proptest::prelude::*;
use sdfc_graph::eval::{Dual, FrameValues, Interval, Packet, Tape};
use sdfc_graph::{
    Binary, Dim, Expander, FrameInput, Graph, Loop, LoopVar, Node, NodeId, Table, Type, Unary,
    fold_transforms, gradient, uniforms,
};

/// The state after an iteration and the condition to run it, given the state before and the
/// iteration index.
type Step = fn(&mut Graph, &[NodeId], NodeId) -> (Vec<NodeId>, Option<NodeId>);

struct Case {
    name: &'static str,
    max_iterations: u32,
    /// True if the param gives the number of iterations.
    counted: bool,
    init: fn(&mut Graph) -> Vec<NodeId>,
    step: Step,
}

fn cases() -> Vec<Case> {
    vec![
        Case {
            name: "two values that are swapped",
            max_iterations: 5,
            counted: false,
            init: |graph| {
                let p = point(graph);
                vec![graph.component(p, 0), graph.component(p, 1)]
            },
            step: |graph, state, _| {
                let half = graph.number(0.5);
                let scaled = graph.mul(state[0], half);
                (vec![state[1], graph.add(scaled, state[1])], None)
            },
        },
        Case {
            name: "a power that escapes",
            max_iterations: 9,
            counted: false,
            init: |graph| {
                let (p, one) = (point(graph), graph.number(1.0));
                let lanes = [0, 1, 2].map(|lane| graph.component(p, lane));
                vec![graph.compose(&[lanes[0], lanes[1], lanes[2], one])]
            },
            step: |graph, state, _| {
                let p = point(graph);
                let z = graph.swizzle(state[0], &[0, 1, 2]);
                let slope = graph.component(state[0], 3);
                let r = graph.length(z);
                let turned = graph.swizzle(z, &[1, 2, 0]);
                let squared = graph.mul(turned, r);
                let next = graph.add(squared, p);
                let (two, limit) = (graph.number(2.0), graph.number(2.0));
                let steeper = graph.mul(slope, r);
                let steeper = graph.mul(steeper, two);
                let lanes = [0, 1, 2].map(|lane| graph.component(next, lane));
                let next = graph.compose(&[lanes[0], lanes[1], lanes[2], steeper]);
                (vec![next], Some(graph.lt(r, limit)))
            },
        },
        Case {
            name: "a sum with a param as its iteration count",
            max_iterations: 12,
            counted: true,
            init: |graph| vec![graph.number(0.0)],
            step: |graph, state, index| {
                let p = point(graph);
                let (x, one) = (graph.component(p, 0), graph.number(1.0));
                let frequency = graph.add(index, one);
                let phase = graph.mul(x, frequency);
                let wave = graph.unary(Unary::Sin, phase);
                let part = graph.div(wave, frequency);
                (vec![graph.add(state[0], part)], None)
            },
        },
        Case {
            name: "the nearest element of a table",
            max_iterations: 20,
            counted: false,
            init: |graph| vec![graph.number(100.0)],
            step: |graph, state, index| {
                let p = point(graph);
                let element = graph.element(table(), index);
                let offset = graph.sub(p, element);
                let distance = graph.length(offset);
                (vec![graph.min(state[0], distance)], None)
            },
        },
        Case {
            name: "a nested loop",
            max_iterations: 4,
            counted: false,
            init: |graph| {
                let p = point(graph);
                vec![graph.component(p, 2)]
            },
            step: |graph, state, index| {
                let p = point(graph);
                let inner = graph.variable(1, LoopVar::State(0), Type::Scalar);
                let step = graph.variable(1, LoopVar::Index, Type::Scalar);
                let y = graph.component(p, 1);
                let sine = graph.unary(Unary::Sin, inner);
                let mixed = graph.mul(sine, state[0]);
                let moved = graph.add(mixed, y);
                let moved = graph.add(moved, step);
                let next = graph.add(moved, index);
                let loop_ = Loop {
                    depth: 1,
                    max_iterations: 3,
                    count: None,
                    condition: None,
                    init: vec![state[0]],
                    step: vec![next],
                    skip: None,
                };
                let within = graph.add_loop(loop_);
                let tenth = graph.number(0.1);
                (vec![graph.mul(within[0], tenth)], None)
            },
        },
    ]
}

fn point(graph: &mut Graph) -> NodeId {
    graph.point(0, Dim::Three)
}

fn table() -> Table {
    let element = |i: usize| {
        let turn = i as f64;
        sdfc_graph::Const::new(Type::Vec3, &[turn.sin(), turn.cos(), 0.1 * turn])
    };
    Table { ty: Type::Vec3, elements: (0..20).map(element).collect() }
}

fn count(graph: &mut Graph) -> NodeId {
    graph.frame_input(FrameInput::Param(0), Type::Scalar)
}

fn looped(graph: &mut Graph, case: &Case) -> Vec<NodeId> {
    let start = (case.init)(graph);
    let state: Vec<NodeId> = (0..)
        .zip(&start)
        .map(|(i, &part)| graph.variable(0, LoopVar::State(i), graph.ty(part)))
        .collect();
    let index = graph.variable(0, LoopVar::Index, Type::Scalar);
    let (next, condition) = (case.step)(graph, &state, index);
    let count = case.counted.then(|| count(graph));
    graph.add_loop(Loop {
        depth: 0,
        max_iterations: case.max_iterations,
        count,
        condition,
        init: start,
        step: next,
        skip: None,
    })
}

fn unrolled(graph: &mut Graph, case: &Case) -> Vec<NodeId> {
    let mut state = (case.init)(graph);
    let mut running = graph.boolean(true);
    for i in 0..case.max_iterations {
        let index = graph.number(f64::from(i));
        let (next, condition) = (case.step)(graph, &state, index);
        if case.counted {
            let count = count(graph);
            let within = graph.lt(index, count);
            running = graph.binary(Binary::And, running, within);
        }
        if let Some(condition) = condition {
            running = graph.binary(Binary::And, running, condition);
        }
        let pairs = next.into_iter().zip(&state);
        state = pairs.map(|(next, &before)| graph.select(running, next, before)).collect();
    }
    state
}

/// The first lane of the last part of the state.
fn scalar(graph: &mut Graph, state: &[NodeId]) -> NodeId {
    let last = state[state.len() - 1];
    let width = graph.ty(last).width() as u8;
    (1..width).fold(graph.component(last, 0), |sum, lane| {
        let part = graph.component(last, lane);
        graph.add(sum, part)
    })
}

fn frame(param: f64) -> FrameValues {
    FrameValues { params: vec![[param; 4]], ..FrameValues::default() }
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    a == b
        || (a - b).abs() <= tolerance * (1.0 + a.abs().max(b.abs()))
        || (a.is_nan() && b.is_nan())
}

/// Compares the loop with its unrolled iterations at a point, in every number type.
fn check(case: &Case, at: [f64; 3], param: f64) {
    let mut graph = Graph::new();
    let state = looped(&mut graph, case);
    let one = scalar(&mut graph, &state);
    let state = unrolled(&mut graph, case);
    let other = scalar(&mut graph, &state);
    let p = point(&mut graph);
    let slopes = [one, other].map(|root| gradient(&mut graph, root, p));
    let folded = fold_transforms(&mut graph, &[one]).roots[0];
    let roots = [one, other, slopes[0], slopes[1], folded];
    let tape = Tape::new(&graph, &roots).expect("flat");
    let frame = frame(param);

    let values = tape.prepare::<f64>(&frame).eval(at).to_vec();
    let name = case.name;
    assert!(close(values[0][0], values[1][0], 1e-12), "{name} at {at:?}: {values:?}");
    assert!(close(values[0][0], values[4][0], 1e-9), "{name} folded at {at:?}: {values:?}");
    for (a, b) in values[2].into_iter().zip(values[3]) {
        assert!(close(a, b, 1e-9), "{name}, slope at {at:?}: {a} {b}");
    }

    let duals = tape.prepare::<Dual>(&frame).eval(Dual::point(at)).to_vec();
    for (a, b) in duals[0][0].partials.into_iter().zip(values[2]) {
        assert!(close(a, b, 1e-9), "{name}, dual at {at:?}: {a} {b}");
    }

    let narrow = at.map(|x| x as f32);
    let values = tape.prepare::<f32>(&frame).eval(narrow).to_vec();
    // In the unrolled form, divisions by constants have become products.
    let both = [f64::from(values[0][0]), f64::from(values[1][0])];
    assert!(close(both[0], both[1], 1e-5), "{name} at {at:?} in f32: {both:?}");
    let pair = narrow.map(|x| Packet([x, x * 0.5]));
    let packets = tape.prepare::<Packet<f32, 2>>(&frame).eval(pair).to_vec();
    let half = tape.prepare::<f32>(&frame).eval(narrow.map(|x| x * 0.5)).to_vec();
    let expected = [values[0][0], half[0][0]];
    assert_eq!(packets[0][0].0.map(f32::to_bits), expected.map(f32::to_bits), "{name} in packets");
    let mut wide = [Packet([0.0; 2]); 3];
    tape.prepare_wide(&frame, 2).scalars(&[pair, narrow.map(|x| Packet([x; 2])), pair], &mut wide);
    assert_eq!(wide[0], packets[0][0], "{name}, wide");
    assert_eq!(wide[1], Packet([values[0][0]; 2]), "{name}, wide");
}

/// Tests that values at points of a box lie in the range over the box.
fn check_range(case: &Case, at: [f64; 3], size: f64) {
    let mut graph = Graph::new();
    let state = looped(&mut graph, case);
    let root = scalar(&mut graph, &state);
    let tape = Tape::new(&graph, &[root]).expect("flat");
    let sides = at.map(|x| Interval::new(x, x + size));
    let counts = Interval::new(2.0, 7.0);
    let frames = FrameValues { params: vec![[counts; 4]], time: counts, frame: counts };
    let range = tape.prepare_in(&frames).scalar(sides);
    for i in 0..27 {
        let inside = |axis: u32| {
            let part = f64::from(i / 3_u32.pow(axis) % 3) / 2.0;
            at[axis as usize] + size * part
        };
        for param in [2.0, 4.0, 7.0] {
            let value = tape.prepare::<f64>(&frame(param)).scalar([0, 1, 2].map(inside));
            let name = case.name;
            assert!(value.is_nan() || range.contains(value), "{name}: {value} is not in {range:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_loop_equals_its_unrolled_iterations(at in prop::array::uniform3(-1.6..1.6), param in 0.0..14.0) {
        for case in cases() {
            check(&case, at, param);
        }
    }

    #[test]
    fn ranges_contain_the_results_of_all_iterations(at in prop::array::uniform3(-1.6..1.6), size in 0.0..0.5) {
        for case in cases() {
            check_range(&case, at, size);
        }
    }
}

#[test]
fn an_undecided_loop_ends_and_a_decided_one_has_tight_bounds() {
    let mut graph = Graph::new();
    let case = &cases()[1];
    let state = looped(&mut graph, case);
    let root = scalar(&mut graph, &state);
    let tape = Tape::new(&graph, &[root]).expect("flat");
    let mut over = tape.prepare::<Interval>(&FrameValues::default());
    assert!(!over.scalar([Interval::ENTIRE; 3]).lo().is_finite());
    // All of this box escapes before the first iteration: the state is the initial one.
    let out = over.scalar([Interval::new(3.0, 3.5); 3]);
    assert!(out.lo() > 9.9 && out.hi() < 11.6, "{out:?}");
}

#[test]
fn a_constant_interval_as_an_index_selects_one_element() {
    let mut graph = Graph::new();
    let case = Case {
        name: "every third element of a table",
        max_iterations: 6,
        counted: false,
        init: |graph| vec![graph.number(0.0)],
        step: |graph, state, index| {
            let three = graph.number(3.0);
            let at = graph.mul(index, three);
            let element = graph.element(table(), at);
            let y = graph.component(element, 1);
            (vec![graph.add(state[0], y)], None)
        },
    };
    let root = looped(&mut graph, &case)[0];
    let tape = Tape::new(&graph, &[root]).expect("flat");
    let sum = tape.prepare::<Interval>(&FrameValues::default()).scalar([Interval::ENTIRE; 3]);
    let expected: f64 = (0..6).map(|i| f64::from(3 * i).cos()).sum();
    assert!(sum.contains(expected) && sum.hi() - sum.lo() < 1e-12, "{sum:?}, not {expected}");
}

#[test]
fn equal_loops_share_one_node_and_the_gradient_computes_the_state_once() {
    let mut graph = Graph::new();
    let case = &cases()[1];
    let first = looped(&mut graph, case);
    assert_eq!(first, looped(&mut graph, case));
    let r = graph.swizzle(first[0], &[0, 1, 2]);
    let r = graph.length(r);
    let slope = graph.component(first[0], 3);
    let field = graph.div(r, slope);
    let p = point(&mut graph);
    let normal = gradient(&mut graph, field, p);
    let loops = |graph: &Graph, root: NodeId| {
        let mut found = Vec::new();
        for id in sdfc_graph::reachable(graph, &[root]) {
            if let Node::Loop(id, ..) = graph.node(id) {
                found.push(id);
            }
        }
        found.dedup();
        found.sort_unstable();
        found.dedup();
        found.len()
    };
    assert_eq!((loops(&graph, field), loops(&graph, normal)), (1, 1));
}

#[test]
fn expanding_a_loop_at_a_moved_point_moves_it() {
    let mut graph = Graph::new();
    let state = looped(&mut graph, &cases()[3]);
    let p = point(&mut graph);
    let by = graph.constant(Type::Vec3, &[0.5, -0.25, 1.0]);
    let q = graph.sub(p, by);
    let moved = Expander::new().node(&mut graph, state[0], &[q]).expect("small");
    let tape = Tape::new(&graph, &[state[0], moved]).expect("flat");
    let frame = FrameValues::default();
    let here = tape.prepare::<f64>(&frame).eval([0.1, 0.2, 0.3])[0][0];
    let there = tape.prepare::<f64>(&frame).eval([0.6, -0.05, 1.3])[1][0];
    assert!(close(here, there, 1e-12), "{here} {there}");
}

#[test]
fn per_frame_values_that_an_iteration_reads_are_uniforms() {
    let mut graph = Graph::new();
    let state = looped(&mut graph, &cases()[2]);
    let input = count(&mut graph);
    assert_eq!(uniforms(&graph, &state), [input]);
}

#[test]
fn a_loop_that_changes_nothing_is_its_initial_state() {
    let mut graph = Graph::new();
    let p = point(&mut graph);
    let variable = graph.variable(0, LoopVar::State(0), Type::Vec3);
    let still = Loop {
        depth: 0,
        max_iterations: 8,
        count: None,
        condition: None,
        init: vec![p],
        step: vec![variable],
        skip: None,
    };
    assert_eq!(graph.add_loop(still.clone()), [p]);
    let zero = graph.constant(Type::Vec3, &[0.0; 3]);
    assert_eq!(graph.add_loop(Loop { max_iterations: 0, step: vec![zero], ..still }), [p]);
}
