//! Passes preserve values: tested on random expressions against plain arithmetic.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

mod twin;

use proptest::prelude::*;
use sdfc_graph::eval::Tape;
use sdfc_graph::{Graph, NodeId, adjoints, fold_transforms, gradient, uniforms};
use twin::{case, frame, maps, steps};

fn point_and_param() -> impl Strategy<Value = ([f64; 3], f64)> {
    (prop::array::uniform3(-3.0..3.0), -2.0..2.0)
}

fn eval(graph: &Graph, roots: &[NodeId], point: [f64; 3], param: f64) -> Vec<[f64; 4]> {
    Tape::new(graph, roots).unwrap().prepare::<f64>(&frame(param)).eval(point).to_vec()
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * (1.0 + a.abs().max(b.abs()))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn builders_preserve_values(steps in steps(40), (point, param) in point_and_param()) {
        let case = case(&steps, point, param);
        let Some(expected) = case.expected() else { return Ok(()) };
        let ids: Vec<NodeId> = expected.iter().map(|(id, _)| *id).collect();
        for ((id, lanes), value) in expected.iter().zip(eval(&case.graph, &ids, point, param)) {
            for (lane, value) in lanes.iter().zip(value) {
                prop_assert!(
                    close(*lane, value, 1e-6),
                    "{} is {value}, not {lane}",
                    sdfc_graph::dump(&case.graph, &[("node", *id)])
                );
                let range = case.graph.range(*id);
                prop_assert!(
                    range.lo - 1e-9 <= value && value <= range.hi + 1e-9,
                    "{value} is not in {range:?}"
                );
            }
        }
    }

    #[test]
    fn equal_expressions_share_one_node(steps in steps(30), (point, param) in point_and_param()) {
        let mut case = case(&steps, point, param);
        let (size, scalar, vector) = (case.graph.len(), case.scalar(), case.vector());
        case.replay(&steps);
        prop_assert_eq!(case.graph.len(), size);
        prop_assert_eq!((case.scalar(), case.vector()), (scalar, vector));
    }

    #[test]
    fn folding_transforms_preserves_values(
        turns in maps(12), rest in steps(10), (point, param) in point_and_param(),
    ) {
        let steps: Vec<_> = turns.into_iter().chain(rest).collect();
        let mut case = case(&steps, point, param);
        let Some(expected) = case.expected() else { return Ok(()) };
        let ids: Vec<NodeId> = expected.iter().map(|(id, _)| *id).collect();
        for roots in [&ids[..], &[case.scalar(), case.vector()]] {
            let before = eval(&case.graph, roots, point, param);
            let folded = fold_transforms(&mut case.graph, roots);
            for (before, after) in
                before.iter().zip(eval(&case.graph, &folded.roots, point, param))
            {
                for (before, after) in before.iter().zip(after) {
                    prop_assert!(close(*before, after, 1e-8), "{before} became {after}");
                }
            }
        }
    }

    #[test]
    fn the_gradient_agrees_with_finite_differences(steps in steps(24), (point, param) in point_and_param()) {
        const STEP: f64 = 1e-5;
        let mut case = case(&steps, point, param);
        if case.expected().is_none() {
            return Ok(());
        }
        let field = case.scalar();
        let gradient = gradient(&mut case.graph, field, case.point);
        let exact = eval(&case.graph, &[gradient], point, param)[0];
        let at = |axis: usize, step: f64| {
            let mut point = point;
            point[axis] += step;
            eval(&case.graph, &[field], point, param)[0][0]
        };
        for (axis, exact) in exact.into_iter().take(3).enumerate() {
            let [back, middle, forth] = [-STEP, 0.0, STEP].map(|step| at(axis, step));
            let central = (forth - back) / (2.0 * STEP);
            // There is a kink or a pole within the step.
            if ((forth - middle) - (middle - back)).abs() > 1e-9 || central.abs() > 1e3 {
                continue;
            }
            prop_assert!(
                close(central, exact, 2e-3),
                "{central} against {exact} along {axis}\n{}",
                sdfc_graph::dump(&case.graph, &[("field", field)])
            );
        }
    }

    #[test]
    fn uniforms_are_sufficient_for_points(steps in steps(30), (point, param) in point_and_param()) {
        let case = case(&steps, point, param);
        let slots = uniforms(&case.graph, &[case.scalar()]);
        prop_assert!(slots.iter().all(|&id| case.graph.stage(id) == sdfc_graph::Stage::Frame));
        let loose = sdfc_graph::reachable_where(&case.graph, &[case.scalar()], |id| !slots.contains(&id));
        let input = |id: &&NodeId| matches!(case.graph.node(**id), sdfc_graph::Node::Frame(..));
        prop_assert!(loose.iter().filter(input).all(|id| slots.contains(id)));
    }

    #[test]
    fn derivatives_of_a_smooth_minimum_sum_to_one(a in -1.0..1.0, b in -1.0..1.0, k in 0.01..2.0) {
        let mut graph = Graph::new();
        let input = |graph: &mut Graph, i| {
            graph.frame_input(sdfc_graph::FrameInput::Param(i), sdfc_graph::Type::Scalar)
        };
        let [x, y] = [0, 1].map(|i| input(&mut graph, i));
        let (width, nought, factor) = (graph.number(k), graph.number(0.0), graph.number(0.25 / k));
        let difference = graph.sub(y, x);
        let distance = graph.abs(difference);
        let reach = graph.sub(width, distance);
        let h = graph.max(reach, nought);
        let square = graph.mul(h, h);
        let swell = graph.mul(square, factor);
        let least = graph.min(x, y);
        let joined = graph.sub(least, swell);
        let shares = adjoints(&mut graph, joined, &[x, y]);
        let params = vec![[a; 4], [b; 4]];
        let frame = sdfc_graph::eval::FrameValues { params, ..Default::default() };
        let values = sdfc_graph::eval::evaluate_frame(&graph, &shares, &frame);
        let h = (0.5 + 0.5 * (b - a) / k).clamp(0.0, 1.0);
        prop_assert!(close(values[0][0], h, 1e-9), "{values:?} {h}");
        prop_assert!(close(values[0][0] + values[1][0], 1.0, 1e-12));
    }
}
