//! All evaluators, compared with each other on random graphs.

mod common;

use common::{cases, each_node, graph, steps};
use proptest::prelude::*;
use sdfc_graph::eval::{Affine, BranchPath, Dual, FrameValues, Interval, Number, Packet, Tape};
use sdfc_graph::{Binary, Dim, FrameInput, Graph, NodeId, Ternary, Type, Unary};

/// Coordinates of all sizes, whole and half numbers among them.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -4.0..4.0,
        2 => (-8_i32..8).prop_map(|i| f64::from(i) / 2.0),
        1 => (-14.0..14.0).prop_map(|power: f64| 10.0_f64.powf(power)),
        1 => (-14.0..14.0).prop_map(|power: f64| -10.0_f64.powf(power)),
    ]
}

/// A range: a low end, and a width of any size.
fn range() -> impl Strategy<Value = [f64; 2]> {
    let width = prop_oneof![
        1 => Just(0.0),
        2 => 0.0..8.0,
        2 => (-12.0..3.0).prop_map(|power: f64| 10.0_f64.powf(power)),
    ];
    (coordinate(), width).prop_map(|(lo, width)| [lo, lo + width])
}

/// A number in a range by a fraction; extreme fractions give the ends.
fn within([lo, hi]: [f64; 2], fraction: f64) -> f64 {
    (lo + (hi - lo) * ((fraction - 0.1) / 0.8).clamp(0.0, 1.0)).clamp(lo, hi)
}

fn frame<N: Number>(param: N) -> FrameValues<N> {
    let zero = N::constant(0.0);
    FrameValues { params: vec![[param; 4]], time: zero, frame: zero }
}

/// The coordinates of the points of a box.
fn coordinates(ranges: [[f64; 2]; 3]) -> [Affine; 3] {
    [0, 1, 2].map(|i| {
        let [lo, hi] = ranges[i];
        let mut half = [0.0; 3];
        half[i] = (0.5 * (hi - lo)).next_up();
        Affine::coordinate(0.5 * lo + 0.5 * hi, half)
    })
}

/// The ranges of a field over a box, on each path through its jumps.
fn on_paths(mut range_along: impl FnMut(&mut BranchPath) -> Interval) -> Vec<Interval> {
    let (mut path, mut found) = (BranchPath::default(), Vec::new());
    loop {
        let range = range_along(&mut path);
        if path.fork(4) {
            continue;
        }
        found.push(range);
        if !path.advance() {
            return found;
        }
    }
}

/// Between 0 and 1 the step has no slope as long as its edges lie apart, but it jumps where they
/// meet.
#[test]
fn a_smoothstep_has_no_gradient_bounds_where_its_edges_meet() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let [x, y] = [0, 1].map(|axis| graph.component(p, axis));
    let [lo, apart] = [-2.0, -3.0].map(|value| graph.number(value));
    let is_above = graph.lt(x, y);
    let hi = graph.select(is_above, lo, apart);
    let step = graph.ternary(Ternary::Smoothstep, lo, hi, x);
    let tape = Tape::new(&graph, &[step]).unwrap();
    let frame = frame(0.0);
    let mut field = tape.prepare::<f64>(&frame);
    assert_eq!([0.0, 1.0].map(|y| field.scalar([0.5, y, 0.0])), [0.0, 1.0]);
    let region = [[0.5, 0.5], [0.0, 1.0], [0.0, 0.0]].map(|[lo, hi]| Interval::new(lo, hi));
    assert_eq!(tape.gradient_over(&frame, region), None);
}

/// `0^y` is 1 where y is 0, and 0 where y is more.
#[test]
fn a_power_of_zero_has_no_gradient_bounds_where_its_exponent_leaves_zero() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let y = graph.component(p, 1);
    let base = graph.frame_input(FrameInput::Param(0), Type::Scalar);
    let power = graph.binary(Binary::Pow, base, y);
    let tape = Tape::new(&graph, &[power]).unwrap();
    let frame = frame(0.0);
    let mut field = tape.prepare::<f64>(&frame);
    assert_eq!([0.0, 0.5].map(|y| field.scalar([0.0, y, 0.0])), [1.0, 0.0]);
    let region = [[0.0, 0.0], [0.0, 0.5], [0.0, 0.0]].map(|[lo, hi]| Interval::new(lo, hi));
    assert_eq!(tape.gradient_over(&frame, region), None);
}

/// The derivative of `1 / sqrt(x)` at `exp(660)` is less than the least number of f64.
#[test]
fn affine_forms_cover_slopes_that_underflow() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let z = graph.component(p, 2);
    let power = graph.unary(Unary::Exp, z);
    let root = graph.unary(Unary::InverseSqrt, power);
    let tape = Tape::new(&graph, &[root]).unwrap();
    let frame = frame(0.0);
    let region = coordinates([[0.0, 0.0], [0.0, 0.0], [658.0, 661.0]]);
    let bounds = tape.prepare::<Affine>(&frame).scalar(region).range();
    let mut field = tape.prepare::<f64>(&frame);
    for z in [658.0, 659.0, 660.0, 661.0] {
        let value = field.scalar([0.0, 0.0, z]);
        assert!(bounds.contains(value), "{value} at {z} is not in {bounds:?}");
    }
}

/// `x (1 - t) + x t` is x, but for rounding of the size of `x t`, and `1 / z` has no limit.
#[test]
fn affine_forms_cover_the_rounding_of_mixtures() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let [y, z] = [1, 2].map(|axis| graph.component(p, axis));
    let x = graph.frame_input(FrameInput::Param(0), Type::Scalar);
    let one = graph.number(1.0);
    let t = graph.div(one, z);
    // The graph would fold a mixture of a node with itself.
    let is_below = graph.lt(one, y);
    let also_x = graph.select(is_below, z, x);
    let mixed = graph.ternary(Ternary::Mix, also_x, x, t);
    let tape = Tape::new(&graph, &[mixed]).unwrap();
    let frame = frame(2.541_496_140_880_951_3);
    let region = coordinates([[0.0, 0.0], [0.0, 0.0], [-1e-3, 1e-3]]);
    let bounds = tape.prepare::<Affine>(&frame).scalar(region).range();
    let mut field = tape.prepare::<f64>(&frame);
    for z in [-9.3e-4, -7.1e-5, -3.3e-6, 1.7e-6, 4.9e-5, 8.3e-4] {
        let value = field.scalar([0.0, 0.0, z]);
        assert!(bounds.contains(value), "{value} at {z} is not in {bounds:?}");
    }
}

/// The nodes up to one of them, for messages.
fn nodes_to(graph: &Graph, last: NodeId) -> String {
    let nodes = graph.ids().take(last.index() + 1);
    nodes.map(|id| format!("\n  {}: {:?}", id.index(), graph.node(id))).collect()
}

/// True if two results are the same number, or both are NaN.
fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// True if two slopes differ by rounding. `y / abs(y)`, the slope of the length of a vector whose
/// other lanes are 0, is an example.
fn is_close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 4.0 * f64::EPSILON * a.abs().max(b.abs())
}

/// True if the specialised tape knows that the value does not depend on a coordinate, and the
/// derivative of the whole tape is 0 but for the rounding of its terms. `z / abs(z)` for positive z
/// is an example: its derivative is a difference of two terms of the size of `1 / z`.
fn is_constant(whole: Dual, special: Dual, (axis, coordinate): (usize, f64)) -> bool {
    let change = whole.partials[axis] * coordinate.abs().min(1.0);
    coordinate != 0.0 && special.partials[axis] == 0.0 && change.abs() <= 1e-15 * whole.value.abs()
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn a_tape_computes_the_same_as_its_nodes(
        steps in steps(40),
        point in prop::array::uniform3(coordinate()),
        param in coordinate(),
    ) {
        let graph = graph(&steps);
        let expected = each_node(&graph, point, param);
        let all: Vec<NodeId> = graph.ids().collect();
        // Few roots make registers be reused; many show where a difference starts.
        for roots in [&all[..], &all[all.len() - 1..]] {
            let tape = Tape::new(&graph, roots).unwrap();
            let mut evaluator = tape.prepare::<f64>(&frame(param));
            let mut packet = tape.prepare::<Packet<f64, 2>>(&frame(param));
            let values = evaluator.eval(point).to_vec();
            let second = packet.eval(point.map(|x| Packet([0.5, x])));
            for (id, (value, pair)) in roots.iter().zip(values.iter().zip(second)) {
                prop_assert!(value[0].to_bits() == pair[0].0[1].to_bits() || value[0].is_nan());
                if let Some(constant) = expected[id.index()] {
                    let lanes = constant.lanes();
                    prop_assert_eq!(*value, lanes, "node {} is {:?}", id.index(), graph.node(*id));
                }
            }
        }
    }

    #[test]
    fn points_evaluated_together_have_the_same_values(
        steps in steps(40),
        points in prop::collection::vec(prop::array::uniform3(coordinate()), 1..12),
        param in coordinate(),
    ) {
        let graph = graph(&steps);
        let root = graph.ids().last().unwrap();
        let tape = Tape::new(&graph, &[root]).unwrap();
        let mut one = tape.prepare::<f64>(&frame(param));
        let mut wide = tape.prepare_wide::<Packet<f64, 2>>(&frame(param), 3);
        let packets: Vec<_> =
            points.iter().map(|point| point.map(|x| Packet([x, x + 1.0]))).collect();
        let mut values = vec![Packet([0.0; 2]); packets.len()];
        wide.scalars(&packets, &mut values);
        for (point, Packet(pair)) in points.iter().zip(values) {
            let expected = [*point, point.map(|x| x + 1.0)].map(|point| one.scalar(point));
            let is_same = same(pair[0], expected[0]) && same(pair[1], expected[1]);
            prop_assert!(is_same, "{pair:?} is not {expected:?}");
        }
    }

    /// A field changes between two points of a box by no more than bounds of its gradient allow.
    #[test]
    fn gradient_bounds_contain_every_difference(
        steps in steps(24),
        ranges in prop::array::uniform3(range()),
        param in coordinate(),
        fractions in prop::collection::vec(prop::array::uniform3(0.0..1.0), 12),
    ) {
        let graph = graph(&steps);
        let frame = frame(param);
        let points: Vec<[f64; 3]> = fractions
            .iter()
            .map(|fraction| [0, 1, 2].map(|i| within(ranges[i], fraction[i])))
            .collect();
        let defined: Vec<_> = points.iter().map(|&p| each_node(&graph, p, param)).collect();
        for root in graph.ids() {
            let tape = Tape::new(&graph, &[root]).unwrap();
            let region = coordinates(ranges).map(|side| side.range());
            let Some(bounds) = tape.gradient_over(&frame, region) else { continue };
            let range = tape.prepare::<Affine>(&frame).scalar(coordinates(ranges)).range();
            let mut field = tape.prepare::<f64>(&frame);
            for (pair, nodes) in points.windows(2).zip(defined.windows(2)) {
                // Nothing is known of a field that is undefined somewhere in the box.
                let is_defined = |nodes: &Vec<Option<_>>| {
                    nodes[..=root.index()].iter().all(Option::is_some)
                };
                if !nodes.iter().all(is_defined) || !(range.hi() - range.lo()).is_finite() {
                    continue;
                }
                let change = field.scalar(pair[1]) - field.scalar(pair[0]);
                let allowed = (0..3).fold(Interval::constant(0.0), |sum, axis| {
                    let step = Interval::constant(pair[1][axis] - pair[0][axis]);
                    sum.add(bounds[axis].mul(step))
                });
                let lanes = nodes.iter().flat_map(|nodes| &nodes[..=root.index()]).flatten();
                let sizes = lanes.flat_map(|value| value.lanes()).map(|lane| lane.abs());
                // A node may subtract products of its operands.
                let size = sizes.fold(0.0, |most: f64, size| most.max(size).max(size * size));
                let rounding = Interval::new(-1e-9 * size, 1e-9 * size);
                prop_assert!(
                    allowed.add(rounding).contains(change),
                    "node {} of {}: {change} from {:?} to {:?} is not in {allowed:?}: {bounds:?}",
                    root.index(), nodes_to(&graph, root), pair[0], pair[1],
                );
            }
        }
    }

    #[test]
    fn intervals_contain_every_sample(
        steps in steps(24),
        ranges in prop::array::uniform3(range()),
        param_range in range(),
        fractions in prop::collection::vec(prop::array::uniform4(0.0..1.0), 12),
    ) {
        let graph = graph(&steps);
        let roots: Vec<NodeId> = graph.ids().collect();
        let tape = Tape::new(&graph, &roots).unwrap();
        let interval = |[lo, hi]: [f64; 2]| Interval::new(lo, hi);
        let mut evaluator = tape.prepare_in(&frame(interval(param_range)));
        let enclosures = evaluator.eval(ranges.map(interval)).to_vec();
        for fraction in fractions {
            let point = [0, 1, 2].map(|i| within(ranges[i], fraction[i]));
            let param = within(param_range, fraction[3]);
            for (id, value) in graph.ids().zip(each_node(&graph, point, param)) {
                let Some(value) = value else { continue };
                let lanes = value.lanes();
                for (value, enclosure) in
                    lanes[..value.ty().width()].iter().zip(&enclosures[id.index()])
                {
                    prop_assert!(
                        enclosure.contains(*value),
                        "node {} = {:?}: {value} at {point:?}, {param} is not in {enclosure:?}",
                        id.index(), graph.node(id),
                    );
                }
            }
        }
    }

    /// At each point of a box, some path takes the same results at jumps as the field does there.
    #[test]
    fn paths_contain_every_sample(
        steps in steps(24),
        ranges in prop::array::uniform3(range()),
        param in range(),
        fractions in prop::collection::vec(prop::array::uniform3(0.0..1.0), 12),
    ) {
        let graph = graph(&steps);
        let param = param[0];
        let roots: Vec<NodeId> = graph.ids().collect();
        for root in roots {
            let tape = Tape::new(&graph, &[root]).unwrap();
            let region = ranges.map(|[lo, hi]| Interval::new(lo, hi));
            let mut intervals = tape.prepare::<Interval>(&frame(param));
            let along = on_paths(|path| intervals.scalar_along(region, path));
            let mut forms = tape.prepare::<Affine>(&frame(param));
            let region = coordinates(ranges);
            let of_forms = on_paths(|path| forms.scalar_along(region, path).range());
            for fraction in &fractions {
                let point = [0, 1, 2].map(|i| within(ranges[i], fraction[i]));
                let values = each_node(&graph, point, param);
                let Some(Some(value)) = values.get(root.index()) else { continue };
                let value = value.lanes()[0];
                for found in [&along, &of_forms] {
                    prop_assert!(
                        found.iter().any(|range| range.contains(value)),
                        "node {} of {}: {value} at {point:?}, {param} is on none of {found:?}",
                        root.index(), nodes_to(&graph, root),
                    );
                }
            }
        }
    }

    #[test]
    fn a_packet_of_gradients_has_those_of_its_points(
        steps in steps(40),
        point in prop::array::uniform3(coordinate()),
        param in coordinate(),
    ) {
        let graph = graph(&steps);
        let all: Vec<NodeId> = graph.ids().collect();
        let tape = Tape::new(&graph, &all).unwrap();
        let mut one = tape.prepare::<Dual>(&frame(param));
        let mut many = tape.prepare::<Dual<Packet<f64, 2>>>(&frame(param));
        let expected = one.eval(Dual::point(point)).to_vec();
        let found = many.eval(Dual::point(point.map(|x| Packet([0.5, x]))));
        for (id, (one, two)) in all.iter().zip(expected.iter().zip(found)) {
            prop_assert!(same(one[0].value, two[0].value.0[1]), "{:?}", graph.node(*id));
            for (partial, pair) in one[0].partials.iter().zip(two[0].partials) {
                prop_assert!(same(*partial, pair.0[1]), "{:?}", graph.node(*id));
            }
        }
    }

    #[test]
    fn a_tape_that_is_specialized_to_a_box_gives_the_same_there(
        steps in steps(24),
        ranges in prop::array::uniform3(range()),
        param in coordinate(),
        fractions in prop::collection::vec(prop::array::uniform3(0.0..1.0), 12),
    ) {
        let graph = graph(&steps);
        let frame = frame(param);
        let region = coordinates(ranges);
        for root in graph.ids() {
            let tape = Tape::new(&graph, &[root]).unwrap();
            let Some(special) = tape.specialized(&frame, region) else { continue };
            prop_assert!(special.operations() <= tape.operations());
            let bounds = tape.prepare::<Affine>(&frame).scalar(region).range();
            let (mut values, mut slopes) = (tape.prepare::<f64>(&frame), tape.prepare(&frame));
            let mut same_values = special.prepare::<f64>(&frame);
            let mut same_slopes = special.prepare::<Dual>(&frame);
            let middle = ranges.map(|[lo, hi]| 0.5 * lo + 0.5 * hi);
            for fraction in &fractions {
                let point = [0, 1, 2].map(|i| within(ranges[i], fraction[i]));
                let nodes = each_node(&graph, point, param);
                // An undefined argument of a minimum may be left out.
                if nodes[..=root.index()].iter().any(Option::is_none) {
                    continue;
                }
                let value = values.scalar(point);
                prop_assert!(
                    bounds.contains(value),
                    "node {} of {}: {value} at {point:?}, {param} is not in {bounds:?}",
                    root.index(), nodes_to(&graph, root),
                );
                let found = same_values.scalar(point);
                prop_assert!(found == value, "{root:?}: {value} and {found} at {point:?}");
                // At a kink each side has a slope of its own, so a place beside it counts as well.
                let beside = std::array::from_fn(|i| 0.999 * point[i] + 0.001 * middle[i]);
                let [a, b] = [&mut slopes, &mut same_slopes]
                    .map(|it| [point, beside].map(|place| it.scalar(Dual::point(place))));
                let is_defined = a.iter().flat_map(|it| it.partials).all(f64::is_finite);
                // In a box without width, a number that changes may round to a constant.
                let is_wide = ranges.iter().all(|[lo, hi]| hi - lo > 1e-6);
                let is_same = [point, beside].iter().zip(a.iter().zip(&b)).any(|(place, (a, b))| {
                    (0..3).all(|i| {
                        is_close(a.partials[i], b.partials[i]) || is_constant(*a, *b, (i, place[i]))
                    })
                });
                prop_assert!(
                    is_same || !is_defined || !is_wide,
                    "node {} of {}: {a:?} {b:?} at {point:?} of {ranges:?}, {param}",
                    root.index(), nodes_to(&graph, root),
                );
            }
        }
    }
}

#[test]
fn a_long_chain_needs_few_registers_and_no_deep_stack() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let [x, y] = [graph.component(p, 0), graph.component(p, 1)];
    let mut sum = x;
    for _ in 0..20_000 {
        let next = graph.mul(sum, y);
        sum = graph.add(next, x);
    }
    let tape = Tape::new(&graph, &[sum]).unwrap();
    assert_eq!(tape.operations(), 40_000);
    assert!(tape.registers() <= 5, "{} registers", tape.registers());
    assert_eq!(tape.prepare::<f64>(&FrameValues::default()).scalar([1.0, 1.0, 0.0]), 20_001.0);
}

/// The distance of a point from a box is exactly 0 within it, so a condition on it is decided.
#[test]
fn clamp_residuals_within_the_range_are_exactly_zero() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let [lo, hi] = [-1.0, 1.0].map(|end| graph.constant(Type::Vec3, &[end; 3]));
    let clamped = graph.ternary(Ternary::Clamp, p, lo, hi);
    let residual = graph.sub(p, clamped);
    let [least, greatest] = [graph.max(p, lo), graph.min(p, hi)];
    let (below, above) = (graph.sub(p, least), graph.sub(p, greatest));
    let tape = Tape::new(&graph, &[residual, below, above]).expect("flat");
    let mut ranges = tape.prepare::<Interval>(&FrameValues::default());
    let inside = Interval::new(-0.9, 0.3);
    let across = Interval::new(0.5, 1.5);
    let zero = Interval::new(0.0, 0.0);
    assert_eq!(ranges.eval([inside; 3]), [[zero, zero, zero, zero]; 3]);
    let [residual, below, above] = *ranges.eval([across; 3]) else { panic!("three roots") };
    assert!(residual[0].contains(0.0) && residual[0].contains(0.5) && residual[0].hi() < 0.51);
    assert_eq!((below[0], above[0]), (zero, residual[0]));
}
