//! Derived bounds: known shapes are compared with bounds found by hand, random trees with samples.

use proptest::prelude::*;
use sdfc_graph::eval::{FrameValues, Tape, evaluate_frame};
use sdfc_graph::{
    Binary, Bounds, Contract, Dim, Expander, FrameInput, Graph, MaterialRule, NodeId, Param,
    ParamKind, Shape, ShapeId, Stage, Ternary, Type, Unary,
};

/// Shapes as the standard library would make them.
#[derive(Default)]
struct Scene {
    graph: Graph,
    params: Vec<Param>,
}

impl Scene {
    fn p(&mut self) -> NodeId {
        self.graph.point(0, Dim::Three)
    }

    fn add(&mut self, formula: NodeId, children: &[ShapeId], contract: Contract) -> ShapeId {
        let deepest = children.iter().map(|&child| self.graph.shape(child).depth).max();
        self.graph.add_shape(Shape {
            definition: format!("{formula:?} {contract:?}"),
            dim: Dim::Three,
            level: 0,
            args: Vec::new(),
            formula,
            contract,
            intersect: Vec::new(),
            material: MaterialRule::Weighted(formula),
            children: children.to_vec(),
            depth: 1 + deepest.unwrap_or(0),
            name: None,
        })
    }

    fn plain(&mut self, formula: NodeId, children: &[ShapeId]) -> ShapeId {
        self.add(formula, children, Contract::default())
    }

    fn exact_within(&mut self, formula: NodeId, half: NodeId) -> ShapeId {
        let (lo, yes) = (self.graph.neg(half), self.graph.boolean(true));
        let mut contract = Contract { bounds: Some([lo, half]), ..Contract::default() };
        (contract.outside.exact, contract.inside.exact) = (Some(yes), Some(yes));
        self.add(formula, &[], contract)
    }

    fn ball_formula(&mut self, radius: NodeId) -> NodeId {
        let p = self.p();
        let length = self.graph.length(p);
        self.graph.sub(length, radius)
    }

    /// States its bounds.
    fn ball(&mut self, radius: f64) -> ShapeId {
        let radius = self.graph.number(radius);
        let formula = self.ball_formula(radius);
        let half = self.graph.splat(Type::Vec3, radius);
        self.exact_within(formula, half)
    }

    /// States its bounds.
    fn cuboid(&mut self, half: [f64; 3]) -> ShapeId {
        let (p, zero) = (self.p(), self.graph.number(0.0));
        let half = self.graph.constant(Type::Vec3, &half);
        let g = &mut self.graph;
        let folded = g.abs(p);
        let q = g.sub(folded, half);
        let outer = g.max(q, zero);
        let length = g.length(outer);
        let [x, y, z] = [0, 1, 2].map(|i| g.component(q, i));
        let yz = g.max(y, z);
        let inner = g.max(x, yz);
        let inner = g.min(inner, zero);
        let formula = g.add(length, inner);
        self.exact_within(formula, half)
    }

    fn at(&mut self, shape: ShapeId, q: NodeId) -> ShapeId {
        let sample = self.graph.sample(shape, q);
        self.plain(sample, &[shape])
    }

    fn moved(&mut self, shape: ShapeId, by: [f64; 3]) -> ShapeId {
        let (p, by) = (self.p(), self.graph.constant(Type::Vec3, &by));
        let q = self.graph.sub(p, by);
        self.at(shape, q)
    }

    /// Rotates about z.
    fn turned(&mut self, shape: ShapeId, angle: NodeId) -> ShapeId {
        let p = self.p();
        let g = &mut self.graph;
        let [x, y, z] = [0, 1, 2].map(|i| g.component(p, i));
        let (c, s) = (g.unary(Unary::Cos, angle), g.unary(Unary::Sin, angle));
        let (xc, ys, xs, yc) = (g.mul(x, c), g.mul(y, s), g.mul(x, s), g.mul(y, c));
        let (u, v) = (g.add(xc, ys), g.sub(yc, xs));
        let q = g.compose(&[u, v, z]);
        self.at(shape, q)
    }

    fn scaled(&mut self, shape: ShapeId, by: NodeId) -> ShapeId {
        let p = self.p();
        let q = self.graph.div(p, by);
        let sample = self.graph.sample(shape, q);
        let formula = self.graph.mul(sample, by);
        self.plain(formula, &[shape])
    }

    fn samples(&mut self, [a, b]: [ShapeId; 2]) -> [NodeId; 2] {
        let p = self.p();
        [self.graph.sample(a, p), self.graph.sample(b, p)]
    }

    fn hard(&mut self, op: Binary, shapes: [ShapeId; 2]) -> ShapeId {
        let [a, b] = self.samples(shapes);
        let formula = self.graph.binary(op, a, b);
        self.plain(formula, &shapes)
    }

    fn difference(&mut self, shapes: [ShapeId; 2]) -> ShapeId {
        let [a, b] = self.samples(shapes);
        let b = self.graph.neg(b);
        let formula = self.graph.max(a, b);
        self.plain(formula, &shapes)
    }

    fn offset(&mut self, shape: ShapeId, by: NodeId) -> ShapeId {
        let p = self.p();
        let sample = self.graph.sample(shape, p);
        let formula = self.graph.sub(sample, by);
        self.plain(formula, &[shape])
    }

    /// The quadratic smooth minimum, of width k.
    fn blend(&mut self, a: NodeId, b: NodeId, k: f64) -> NodeId {
        let g = &mut self.graph;
        let [k, half, one] = [k, 0.5, 1.0].map(|value| g.number(value));
        let apart = g.sub(b, a);
        let apart = g.mul(half, apart);
        let apart = g.div(apart, k);
        let h = g.add(half, apart);
        let h = g.unary(Unary::Saturate, h);
        let mixed = g.ternary(Ternary::Mix, b, a, h);
        let rest = g.sub(one, h);
        let kh = g.mul(k, h);
        let dip = g.mul(kh, rest);
        g.sub(mixed, dip)
    }

    fn smooth_union(&mut self, shapes: [ShapeId; 2], k: f64) -> ShapeId {
        let [a, b] = self.samples(shapes);
        let formula = self.blend(a, b, k);
        self.plain(formula, &shapes)
    }

    fn smooth_difference(&mut self, shapes: [ShapeId; 2], k: f64) -> ShapeId {
        let [a, b] = self.samples(shapes);
        let a = self.graph.neg(a);
        let joined = self.blend(a, b, k);
        let formula = self.graph.neg(joined);
        self.plain(formula, &shapes)
    }

    fn param(&mut self, default: f64, range: Option<[f64; 2]>) -> NodeId {
        let index = self.params.len() as u32;
        self.params.push(Param {
            name: format!("k{index}"),
            kind: ParamKind::Number,
            ty: Type::Scalar,
            default: [default; 4],
            fixed: None,
            range,
            choices: Vec::new(),
            summary: String::new(),
        });
        self.graph.frame_input(FrameInput::Param(index), Type::Scalar)
    }

    /// The bounds in numbers, for given values of the params.
    fn corners(&mut self, shape: ShapeId, params: &[f64]) -> [[f64; 3]; 2] {
        let corners = Bounds::new(&self.params).of(&mut self.graph, shape);
        assert!(corners.iter().all(|&corner| self.graph.stage(corner) <= Stage::Frame));
        let params = params.iter().map(|&param| [param; 4]).collect();
        let frame = FrameValues { params, ..FrameValues::default() };
        let values = evaluate_frame(&self.graph, &corners, &frame);
        [0, 1].map(|i| [values[i][0], values[i][1], values[i][2]])
    }

    #[track_caller]
    fn assert_bounds(&mut self, shape: ShapeId, expected: [[f64; 3]; 2], slack: f64) {
        let found = self.corners(shape, &[]);
        for axis in 0..3 {
            let (lo, hi) = (found[0][axis], found[1][axis]);
            let (low, high) = (expected[0][axis], expected[1][axis]);
            let fits = |outer: f64, inner: f64| {
                outer == inner || (outer - inner >= -1e-12 && outer - inner <= slack)
            };
            assert!(fits(-lo, -low) && fits(hi, high), "{found:?}, expected {expected:?}");
        }
    }
}

const INF: f64 = f64::INFINITY;

fn cube(half: f64) -> [[f64; 3]; 2] {
    [[-half; 3], [half; 3]]
}

#[test]
fn stated_bounds_are_used() {
    let mut scene = Scene::default();
    let ball = scene.ball(0.5);
    scene.assert_bounds(ball, cube(0.5), 0.0);
}

#[test]
fn a_leaf_without_stated_bounds_is_searched() {
    let mut scene = Scene::default();
    let radius = scene.graph.number(0.7);
    let formula = scene.ball_formula(radius);
    let ball = scene.plain(formula, &[]);
    scene.assert_bounds(ball, cube(0.7), 0.002);
}

#[test]
fn a_plane_is_bounded_on_one_side_only() {
    let mut scene = Scene::default();
    let p = scene.p();
    let y = scene.graph.component(p, 1);
    let plane = scene.plain(y, &[]);
    scene.assert_bounds(plane, [[-INF; 3], [INF, 0.0, INF]], 0.002);
}

#[test]
fn a_field_that_is_positive_everywhere_has_empty_bounds() {
    let mut scene = Scene::default();
    let (p, one) = (scene.p(), scene.graph.number(1.0));
    let length = scene.graph.length(p);
    let formula = scene.graph.add(length, one);
    let nothing = scene.plain(formula, &[]);
    let [lo, hi] = scene.corners(nothing, &[]);
    assert!(lo[0] > hi[0]);
}

#[test]
fn maps_of_the_point_map_the_bounds() {
    let mut scene = Scene::default();
    let brick = scene.cuboid([3.0, 1.0, 0.5]);
    let moved = scene.moved(brick, [1.0, 2.0, -3.0]);
    scene.assert_bounds(moved, [[-2.0, 1.0, -3.5], [4.0, 3.0, -2.5]], 0.0);

    let quarter = scene.graph.number(std::f64::consts::FRAC_PI_2);
    let turned = scene.turned(moved, quarter); // [x, y] to [-y, x]
    scene.assert_bounds(turned, [[-3.0, -2.0, -3.5], [-1.0, 4.0, -2.5]], 1e-12);

    let half = scene.graph.number(0.5);
    let small = scene.scaled(moved, half);
    scene.assert_bounds(small, [[-1.0, 0.5, -1.75], [2.0, 1.5, -1.25]], 1e-12);
}

#[test]
fn bounds_of_set_operations_follow_from_their_operands() {
    let mut scene = Scene::default();
    let (ball, brick) = (scene.ball(1.0), scene.cuboid([0.5, 2.0, 0.5]));
    let apart = scene.moved(ball, [3.0, 0.0, 0.0]);
    let union = scene.hard(Binary::Min, [brick, apart]);
    scene.assert_bounds(union, [[-0.5, -2.0, -1.0], [4.0, 2.0, 1.0]], 0.0);
    let both = scene.hard(Binary::Max, [brick, ball]);
    scene.assert_bounds(both, [[-0.5, -1.0, -0.5], [0.5, 1.0, 0.5]], 0.0);
    let cut = scene.difference([brick, ball]);
    scene.assert_bounds(cut, [[-0.5, -2.0, -0.5], [0.5, 2.0, 0.5]], 0.0);
}

#[test]
fn rounding_grows_the_bounds_of_the_leaves() {
    let mut scene = Scene::default();
    let brick = scene.cuboid([1.0, 2.0, 3.0]);
    let angle = scene.graph.number(0.3);
    let turned = scene.turned(brick, angle);
    let by = scene.graph.number(0.25);
    let round = scene.offset(turned, by);
    let (c, s) = (0.3_f64.cos(), 0.3_f64.sin());
    let high = [1.25 * c + 2.25 * s, 1.25 * s + 2.25 * c, 3.25];
    scene.assert_bounds(round, [high.map(|x| -x), high], 1e-12);
}

#[test]
fn a_smooth_union_grows_by_a_quarter_of_its_width() {
    let mut scene = Scene::default();
    let (ball, brick) = (scene.ball(1.0), scene.cuboid([0.5, 2.0, 0.5]));
    let apart = scene.moved(ball, [2.0, 0.0, 0.0]);
    let union = scene.smooth_union([brick, apart], 0.4);
    let (found, k) = (scene.corners(union, &[]), 0.4);
    let hull = [[-0.5, -2.0, -1.0], [3.0, 2.0, 1.0]];
    for axis in 0..3 {
        assert!(found[0][axis] <= hull[0][axis] && found[1][axis] >= hull[1][axis]);
        assert!(found[0][axis] >= hull[0][axis] - k / 4.0 - 0.02, "{found:?}");
        assert!(found[1][axis] <= hull[1][axis] + k / 4.0 + 0.02, "{found:?}");
    }
}

#[test]
fn a_moved_copy_has_exactly_the_moved_bounds() {
    let mut scene = Scene::default();
    let (ball, brick) = (scene.ball(1.0), scene.cuboid([0.5, 2.0, 0.5]));
    let blend = scene.smooth_union([brick, ball], 0.4);
    let found = scene.corners(blend, &[]);
    let copy = scene.moved(blend, [0.3, 0.0, -7.0]);
    // A separate search, at other numbers, would end elsewhere.
    let expected = found.map(|[x, y, z]| [x + 0.3, y, z - 7.0]);
    assert_eq!(scene.corners(copy, &[]), expected);
}

#[test]
fn a_smooth_difference_stays_near_its_first_operand() {
    let mut scene = Scene::default();
    let (ball, brick) = (scene.ball(1.0), scene.cuboid([0.5, 2.0, 0.5]));
    let cut = scene.smooth_difference([brick, ball], 0.2);
    // Intervals cannot show that the blend only removes material: a slack of its width remains.
    scene.assert_bounds(cut, [[-0.5, -2.0, -0.5], [0.5, 2.0, 0.5]], 0.2);
}

#[test]
fn an_operator_around_one_that_is_searched_keeps_bounds() {
    let mut scene = Scene::default();
    let brick = scene.cuboid([0.5, 1.0, 0.25]);
    // p - clamp(p, -h, h) puts a gap of 2 h into the brick's middle.
    let (p, half) = (scene.p(), scene.graph.constant(Type::Vec3, &[0.2, 0.0, 0.0]));
    let minus = scene.graph.neg(half);
    let above = scene.graph.max(p, minus);
    let middle = scene.graph.min(above, half);
    let q = scene.graph.sub(p, middle);
    let long = scene.at(brick, q);
    scene.assert_bounds(long, [[-0.7, -1.0, -0.25], [0.7, 1.0, 0.25]], 0.01);

    let quarter = scene.graph.number(std::f64::consts::FRAC_PI_2);
    let turned = scene.turned(long, quarter);
    scene.assert_bounds(turned, [[-1.0, -0.7, -0.25], [1.0, 0.7, 0.25]], 0.01);
}

#[test]
fn bounds_depend_on_params_where_rules_apply() {
    let mut scene = Scene::default();
    let radius = scene.param(1.0, None);
    let angle = scene.param(0.0, None);
    let size = scene.param(1.0, Some([0.5, 4.0]));
    let formula = scene.ball_formula(radius);
    let half = scene.graph.splat(Type::Vec3, radius);
    let ball = scene.exact_within(formula, half);
    let moved = scene.moved(ball, [2.0, 0.0, 0.0]);
    let turned = scene.turned(moved, angle);
    let scaled = scene.scaled(turned, size);
    let [lo, hi] = scene.corners(scaled, &[0.5, std::f64::consts::FRAC_PI_2, 2.0]);
    for (found, expected) in lo.into_iter().zip([-1.0, 3.0, -1.0]) {
        assert!((found - expected).abs() < 1e-12, "{lo:?} {hi:?}");
    }
    for (found, expected) in hi.into_iter().zip([1.0, 5.0, 1.0]) {
        assert!((found - expected).abs() < 1e-12, "{lo:?} {hi:?}");
    }
}

#[test]
fn an_unbounded_param_without_a_rule_leaves_bounds_infinite() {
    let mut scene = Scene::default();
    let radius = scene.param(1.0, None);
    let formula = scene.ball_formula(radius);
    let ball = scene.plain(formula, &[]);
    assert_eq!(scene.corners(ball, &[1.0]), [[-INF; 3], [INF; 3]]);
}

#[test]
fn a_shape_that_depends_on_outer_points_gets_a_box_for_all_of_them() {
    let mut scene = Scene::default();
    let outer = scene.p();
    let g = &mut scene.graph;
    let (p, x) = (g.point(1, Dim::Three), g.component(outer, 0));
    let radius = g.unary(Unary::Fract, x); // from 0 to 1
    let length = g.length(p);
    let formula = g.sub(length, radius);
    let half = g.splat(Type::Vec3, radius);
    let bounds = Some([g.neg(half), half]);
    let ball = scene.add(formula, &[], Contract { bounds, ..Contract::default() });
    let own = Shape { level: 1, ..scene.graph.shape(ball).clone() };
    let ball = scene.graph.add_shape(own);
    scene.assert_bounds(ball, cube(1.0), 0.0);
    let unstated = Shape {
        contract: Contract::default(),
        definition: "unstated".to_owned(),
        ..scene.graph.shape(ball).clone()
    };
    let ball = scene.graph.add_shape(unstated);
    scene.assert_bounds(ball, cube(1.0), 0.01);
}

#[test]
fn long_chains_are_cheap_and_do_not_overflow_the_stack() {
    let mut scene = Scene::default();
    let mut chain = scene.ball(1.0);
    for _ in 0..10_000 {
        chain = scene.moved(chain, [0.5, 0.0, 0.0]);
    }
    scene.assert_bounds(chain, [[4999.0, -1.0, -1.0], [5001.0, 1.0, 1.0]], 0.0);

    let mut union = scene.ball(1.0);
    for i in 1..1_000 {
        let ball = scene.ball(1.0);
        let ball = scene.moved(ball, [f64::from(i), 0.0, 0.0]);
        union = scene.smooth_union([union, ball], 0.1);
    }
    let [lo, hi] = scene.corners(union, &[]);
    assert!(lo[0] <= -1.0 && hi[0] >= 1000.0 && hi[0] < 2000.0, "{lo:?} {hi:?}");
}

#[test]
fn a_long_chain_of_blends_swells_by_its_width_at_most() {
    let (k, count) = (0.1, 60);
    let mut scene = Scene::default();
    let balls: Vec<ShapeId> = (0..count)
        .map(|i| {
            let ball = scene.ball(0.4);
            scene.moved(ball, [0.01 * f64::from(i), 0.0, 0.0])
        })
        .collect();
    let p = scene.p();
    let samples: Vec<NodeId> = balls.iter().map(|&ball| scene.graph.sample(ball, p)).collect();
    let g = &mut scene.graph;
    let [width, zero, factor] = [k, 0.0, 0.25 / k].map(|value| g.number(value));
    let blend = |a, b| {
        let apart = g.sub(b, a);
        let apart = g.abs(apart);
        let h = g.sub(width, apart);
        let h = g.max(h, zero);
        let (square, least) = (g.mul(h, h), g.min(a, b));
        let depth = g.mul(square, factor);
        g.sub(least, depth)
    };
    let formula = samples.into_iter().reduce(blend).unwrap();
    let union = scene.plain(formula, &balls);
    let [lo, hi] = scene.corners(union, &[]);

    // How far the surface is from the axis, by the same formula in numbers.
    let field = |q: [f64; 2]| {
        let ball = |i: i32| (q[0] - 0.01 * f64::from(i)).hypot(q[1]) - 0.4;
        (1..count).map(ball).fold(ball(0), |a, b| {
            let h = (k - (b - a).abs()).max(0.0);
            a.min(b) - h * h * 0.25 / k
        })
    };
    let middle = 0.005 * f64::from(count - 1);
    let swollen = (0..1000).map(|i| 0.4 + 1e-4 * f64::from(i));
    let radius = swollen.rev().find(|&y| field([middle, y]) <= 0.0).unwrap();
    // Several blends swell by more than one, which adds k / 4.
    assert!(radius > 0.4 + 0.5 * k, "{radius}");
    assert!(hi[1] >= radius && hi[1] <= 0.4 + k + 1e-9, "{hi:?}, {radius}");
    assert!(lo[0] >= -0.4 - k - 1e-9 && hi[0] <= 2.0 * middle + 0.4 + k + 1e-9, "{lo:?} {hi:?}");
}

/// A random tree; each step combines the latest shapes.
fn tree(scene: &mut Scene, steps: &[(u8, [f64; 3])]) -> ShapeId {
    let mut stack = vec![scene.ball(0.6)];
    for &(kind, [a, b, c]) in steps {
        let top = stack[stack.len() - 1];
        let below = stack[stack.len().saturating_sub(2)];
        let shape = match kind {
            0 => scene.ball(0.1 + a.abs()),
            1 => scene.cuboid([0.1 + a.abs(), 0.1 + b.abs(), 0.1 + c.abs()]),
            2 => scene.moved(top, [a, b, c]),
            3 => {
                let angle = scene.graph.number(3.0 * a);
                scene.turned(top, angle)
            }
            4 => {
                let by = scene.graph.number(0.3 + a.abs());
                scene.scaled(top, by)
            }
            5 => {
                let by = scene.graph.number(0.2 * a);
                scene.offset(top, by)
            }
            6 => scene.hard(Binary::Min, [top, below]),
            7 => scene.hard(Binary::Max, [top, below]),
            8 => scene.difference([below, top]),
            9 => scene.smooth_union([top, below], 0.05 + a.abs()),
            _ => scene.smooth_difference([below, top], 0.05 + a.abs()),
        };
        stack.push(shape);
    }
    stack[stack.len() - 1]
}

/// Many points around the origin, from a seed: too many to print.
fn sample_points(mut seed: u32) -> impl Iterator<Item = [f64; 3]> {
    let mut next = move || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 8) / f64::from(1 << 24) * 10.0 - 5.0
    };
    std::iter::repeat_with(move || [next(), next(), next()]).take(400)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) })]

    #[test]
    fn bounds_contain_every_inside_point(
        steps in prop::collection::vec((0_u8..11, prop::array::uniform3(-1.0..1.0)), 1..12),
        seed in any::<u32>(),
    ) {
        let mut scene = Scene::default();
        let shape = tree(&mut scene, &steps);
        let [lo, hi] = scene.corners(shape, &[]);
        let p = scene.p();
        let field = Expander::new().field(&mut scene.graph, shape, p).unwrap();
        let tape = Tape::new(&scene.graph, &[field]).unwrap();
        let mut field = tape.prepare::<f64>(&FrameValues::default());
        for point in sample_points(seed) {
            let inside = (0..3).all(|i| lo[i] - 1e-9 <= point[i] && point[i] <= hi[i] + 1e-9);
            prop_assert!(inside || field.scalar(point) > 0.0, "{point:?} not in {lo:?}..{hi:?}");
        }
        // All leaves of these trees are bounded, and so are the trees.
        prop_assert!(lo.iter().chain(&hi).all(|x| x.abs() < 100.0 || lo[0] > hi[0]), "{lo:?}..{hi:?}");
    }
}
