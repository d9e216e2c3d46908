//! Expansion: levels, materials, names, limits, depth.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use proptest::prelude::*;
use sdfc_graph::eval::{FrameValues, Tape};
use sdfc_graph::{
    Arg, Contract, Dim, ExpandError, Expander, Graph, MaterialField, MaterialRule, NodeId, Shape,
    ShapeId, Type, Unary, dump, fold_transforms, gradient, operation_count, uniforms,
};

/// A shape of level 0 whose material is weighted by its formula's derivatives.
fn shape(graph: &mut Graph, definition: &str, formula: NodeId, children: &[ShapeId]) -> ShapeId {
    shape_at(graph, 0, definition, formula, children)
}

fn shape_at(
    graph: &mut Graph,
    level: u16,
    definition: &str,
    formula: NodeId,
    children: &[ShapeId],
) -> ShapeId {
    let depth = children.iter().map(|&child| graph.shape(child).depth).max().unwrap_or(0) + 1;
    graph.add_shape(Shape {
        definition: definition.to_owned(),
        dim: Dim::Three,
        level,
        args: vec![Arg::Node(formula)],
        formula,
        contract: Contract::default(),
        intersect: Vec::new(),
        material: MaterialRule::Weighted(formula),
        children: children.to_vec(),
        depth,
        name: None,
    })
}

fn ball(graph: &mut Graph, radius: f64) -> ShapeId {
    let p = graph.point(0, Dim::Three);
    let (length, radius) = (graph.length(p), graph.number(radius));
    let formula = graph.sub(length, radius);
    shape(graph, "ball", formula, &[])
}

fn moved(graph: &mut Graph, child: ShapeId, by: [f64; 3]) -> ShapeId {
    let p = graph.point(0, Dim::Three);
    let by = graph.constant(Type::Vec3, &by);
    let q = graph.sub(p, by);
    let formula = graph.sample(child, q);
    shape(graph, "moved", formula, &[child])
}

fn scaled(graph: &mut Graph, child: ShapeId, by: f64) -> ShapeId {
    let p = graph.point(0, Dim::Three);
    let by = graph.number(by);
    let q = graph.div(p, by);
    let sample = graph.sample(child, q);
    let formula = graph.mul(sample, by);
    shape(graph, "scaled", formula, &[child])
}

/// A shape with a grey material.
fn with_material(graph: &mut Graph, child: ShapeId, grey: f64) -> ShapeId {
    let p = graph.point(0, Dim::Three);
    let formula = graph.sample(child, p);
    let id = shape(graph, "colored", formula, &[child]);
    let mut stated = MaterialField::ALL.map(|field| graph.material_at(child, p, field));
    stated[0] = graph.constant(Type::Vec3, &[grey; 3]);
    stated[1] = graph.number(1.0);
    let shape = Shape {
        definition: format!("grey {grey}"),
        material: MaterialRule::Explicit(stated),
        ..graph.shape(id).clone()
    };
    graph.add_shape(shape)
}

fn samples(graph: &mut Graph, children: [ShapeId; 2]) -> [NodeId; 2] {
    let p = graph.point(0, Dim::Three);
    children.map(|child| graph.sample(child, p))
}

fn union(graph: &mut Graph, children: [ShapeId; 2]) -> ShapeId {
    let [a, b] = samples(graph, children);
    let formula = graph.min(a, b);
    shape(graph, "either", formula, &children)
}

fn difference(graph: &mut Graph, children: [ShapeId; 2]) -> ShapeId {
    let [a, b] = samples(graph, children);
    let negative = graph.neg(a);
    let least = graph.min(negative, b);
    let formula = graph.neg(least);
    shape(graph, "without", formula, &children)
}

fn smooth(graph: &mut Graph, children: [ShapeId; 2], k: f64) -> ShapeId {
    let [a, b] = samples(graph, children);
    let (width, nought, factor) = (graph.number(k), graph.number(0.0), graph.number(0.25 / k));
    let difference = graph.sub(b, a);
    let distance = graph.abs(difference);
    let reach = graph.sub(width, distance);
    let h = graph.max(reach, nought);
    let square = graph.mul(h, h);
    let swell = graph.mul(square, factor);
    let least = graph.min(a, b);
    let formula = graph.sub(least, swell);
    shape(graph, "blend", formula, &children)
}

fn eval(graph: &Graph, roots: &[NodeId], point: [f64; 3]) -> Vec<[f64; 4]> {
    Tape::new(graph, roots).unwrap().prepare::<f64>(&FrameValues::default()).eval(point).to_vec()
}

fn grey(graph: &mut Graph, shape: ShapeId, at: [f64; 3]) -> f64 {
    let p = graph.point(0, Dim::Three);
    let material = Expander::new().material(graph, shape, p).unwrap();
    eval(graph, &[material[0]], at)[0][0]
}

/// A tree of shapes, and its distance computed directly.
#[derive(Clone, Debug)]
enum Tree {
    Ball(f64),
    Moved(Box<Tree>, [f64; 3]),
    Scaled(Box<Tree>, f64),
    Either(Box<[Tree; 2]>),
    Without(Box<[Tree; 2]>),
    Blend(Box<[Tree; 2]>, f64),
}

impl Tree {
    fn build(&self, graph: &mut Graph) -> ShapeId {
        match self {
            Self::Ball(radius) => ball(graph, *radius),
            Self::Moved(child, by) => {
                let child = child.build(graph);
                moved(graph, child, *by)
            }
            Self::Scaled(child, by) => {
                let child = child.build(graph);
                scaled(graph, child, *by)
            }
            Self::Either(children) => {
                let children = [children[0].build(graph), children[1].build(graph)];
                union(graph, children)
            }
            Self::Without(children) => {
                let children = [children[0].build(graph), children[1].build(graph)];
                difference(graph, children)
            }
            Self::Blend(children, k) => {
                let children = [children[0].build(graph), children[1].build(graph)];
                smooth(graph, children, *k)
            }
        }
    }

    fn distance(&self, p: [f64; 3]) -> f64 {
        match self {
            Self::Ball(radius) => p.iter().map(|x| x * x).sum::<f64>().sqrt() - radius,
            Self::Moved(child, by) => child.distance([0, 1, 2].map(|i| p[i] - by[i])),
            Self::Scaled(child, by) => child.distance(p.map(|x| x / by)) * by,
            Self::Either(both) => both[0].distance(p).min(both[1].distance(p)),
            Self::Without(both) => both[0].distance(p).max(-both[1].distance(p)),
            Self::Blend(both, k) => {
                let (a, b) = (both[0].distance(p), both[1].distance(p));
                let h = (k - (a - b).abs()).max(0.0);
                a.min(b) - h * h * 0.25 / k
            }
        }
    }
}

fn trees() -> impl Strategy<Value = Tree> {
    let vector = || prop::array::uniform3((-4..4).prop_map(|i| f64::from(i) / 2.0));
    let leaf = (1..8).prop_map(|i| Tree::Ball(f64::from(i) / 8.0));
    leaf.prop_recursive(6, 40, 2, move |inner| {
        let pair = || [inner.clone(), inner.clone()].prop_map(Box::new);
        prop_oneof![
            2 => (inner.clone(), vector()).prop_map(|(child, by)| Tree::Moved(Box::new(child), by)),
            1 => (inner.clone(), 0.5..2.0).prop_map(|(child, by)| Tree::Scaled(Box::new(child), by)),
            1 => pair().prop_map(Tree::Either),
            1 => pair().prop_map(Tree::Without),
            2 => (pair(), 0.1..1.0).prop_map(|(children, k)| Tree::Blend(children, k)),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn expansion_keeps_distances(tree in trees(), point in prop::array::uniform3(-3.0..3.0)) {
        let mut graph = Graph::new();
        let root = tree.build(&mut graph);
        let p = graph.point(0, Dim::Three);
        let field = Expander::new().field(&mut graph, root, p).unwrap();
        let folded = fold_transforms(&mut graph, &[field]).roots[0];
        let values = eval(&graph, &[field, folded], point);
        let expected = tree.distance(point);
        prop_assert!((values[0][0] - expected).abs() < 1e-9, "{} {expected}", values[0][0]);
        prop_assert!((values[1][0] - expected).abs() < 1e-9, "{} {expected}", values[1][0]);
    }
}

#[test]
fn inner_formulas_see_the_points_around_them() {
    let mut graph = Graph::new();
    let outer = graph.point(0, Dim::Three);
    let middle = graph.point(1, Dim::Three);
    let inner = graph.point(2, Dim::Three);
    // Level 2 subtracts components of all three points.
    let [x, y, z] = [(outer, 0), (middle, 1), (inner, 2)].map(|(p, i)| graph.component(p, i));
    let xy = graph.sub(x, y);
    let formula = graph.sub(xy, z);
    let innermost = shape_at(&mut graph, 2, "innermost", formula, &[]);
    // Level 1 samples it at ten times its own point; level 0 samples that at a hundred times its
    // own.
    let (ten, hundred) = (graph.number(10.0), graph.number(100.0));
    let q = graph.mul(middle, ten);
    let formula = graph.sample(innermost, q);
    let between = shape_at(&mut graph, 1, "between", formula, &[innermost]);
    let q = graph.mul(outer, hundred);
    let formula = graph.sample(between, q);
    let outermost = shape(&mut graph, "outermost", formula, &[between]);

    let mut expander = Expander::new();
    let field = expander.field(&mut graph, outermost, outer).unwrap();
    // x - 100 y - 1000 z
    assert_eq!(eval(&graph, &[field], [1.0, 2.0, 3.0])[0][0], 1.0 - 200.0 - 3000.0);
    assert_eq!(
        expander.field(&mut graph, innermost, outer),
        Err(ExpandError::MissingPoint { level: 1 })
    );
    let under = expander.field_under(&mut graph, innermost, &[outer, outer], outer).unwrap();
    assert_eq!(eval(&graph, &[under], [1.0, 2.0, 3.0])[0][0], 1.0 - 2.0 - 3.0);
}

#[test]
fn operators_that_compare_select_a_material() {
    let mut graph = Graph::new();
    let left = ball(&mut graph, 1.0);
    let left = moved(&mut graph, left, [-2.0, 0.0, 0.0]);
    let left = with_material(&mut graph, left, 0.25);
    let right = ball(&mut graph, 1.5);
    let right = moved(&mut graph, right, [2.0, 0.0, 0.0]);
    let dark = with_material(&mut graph, right, 0.5);
    let either = union(&mut graph, [left, dark]);
    assert_eq!(grey(&mut graph, either, [-1.0, 0.0, 0.0]), 0.25);
    assert_eq!(grey(&mut graph, either, [1.0, 0.0, 0.0]), 0.5);
}

#[test]
fn a_hole_shows_the_body_unless_its_cutter_has_a_material() {
    let mut graph = Graph::new();
    let body = ball(&mut graph, 1.0);
    let body = with_material(&mut graph, body, 0.25);
    let plain = ball(&mut graph, 1.0);
    let plain = moved(&mut graph, plain, [1.0, 0.0, 0.0]);
    let dark = with_material(&mut graph, plain, 0.5);
    let (back, wall) = ([-1.0, 0.0, 0.0], [0.1, 0.0, 0.0]);
    let hole = difference(&mut graph, [body, plain]);
    assert_eq!([back, wall].map(|at| grey(&mut graph, hole, at)), [0.25, 0.25]);
    let hole = difference(&mut graph, [body, dark]);
    assert_eq!([back, wall].map(|at| grey(&mut graph, hole, at)), [0.25, 0.5]);
}

#[test]
fn blends_mix_materials_by_the_weights_of_their_operands() {
    let mut graph = Graph::new();
    let left = ball(&mut graph, 1.0);
    let left = moved(&mut graph, left, [-1.0, 0.0, 0.0]);
    let right = ball(&mut graph, 1.0);
    let right = moved(&mut graph, right, [1.0, 0.0, 0.0]);
    let (light, dark) =
        (with_material(&mut graph, left, 1.0), with_material(&mut graph, right, 0.0));
    let blend = smooth(&mut graph, [light, dark], 0.5);
    for (x, share) in [(-1.0, 1.0), (0.0, 0.5), (-0.05, 0.6), (1.0, 0.0)] {
        let shown = grey(&mut graph, blend, [x, 0.0, 0.0]);
        assert!((shown - share).abs() < 1e-9, "{shown} at {x}, not {share}");
    }
}

#[test]
fn shapes_without_materials_share_one_constant_material() {
    let mut graph = Graph::new();
    let (a, b) = (ball(&mut graph, 1.0), ball(&mut graph, 2.0));
    let blend = smooth(&mut graph, [a, b], 0.5);
    let p = graph.point(0, Dim::Three);
    let material = Expander::new().material(&mut graph, blend, p).unwrap();
    for (id, field) in material.into_iter().zip(MaterialField::ALL) {
        let lanes = graph.as_const(id).map(|value| value.lanes());
        assert_eq!(lanes, Some(field.default_value()), "{field:?}");
    }
}

#[test]
fn nodes_are_named_after_the_scene_before_the_library() {
    let mut graph = Graph::new();
    let inner = ball(&mut graph, 1.0);
    let outer = moved(&mut graph, inner, [1.0, 0.0, 0.0]);
    graph.name_shape(outer, "moon");
    let other = ball(&mut graph, 2.0);
    let root = union(&mut graph, [outer, other]);
    let p = graph.point(0, Dim::Three);
    let mut expander = Expander::new();
    let field = expander.field(&mut graph, root, p).unwrap();
    let mut names: Vec<String> = expander.names().into_values().collect();
    names.sort_unstable();
    assert_eq!(names, ["ball", "either", "moon"]);
    assert_eq!(expander.names()[&field], "either");
}

#[test]
fn expansion_stops_at_the_node_limit() {
    let mut graph = Graph::new();
    let mut bomb = ball(&mut graph, 1.0);
    for i in 0..40 {
        // Two copies of two copies of ...
        let by = f64::from(i) + 0.123;
        let (a, b) =
            (moved(&mut graph, bomb, [by, by, 0.0]), moved(&mut graph, bomb, [0.0, by * by, 0.3]));
        bomb = union(&mut graph, [a, b]);
    }
    let p = graph.point(0, Dim::Three);
    let error = Expander::with_limit(20_000).field(&mut graph, bomb, p).unwrap_err();
    assert_eq!(error, ExpandError::TooManyNodes { limit: 20_000 });
    assert_eq!(error.to_string(), "the expanded scene has more than 20000 nodes");
}

/// A chain of blended balls.
fn chain(graph: &mut Graph, length: u32) -> ShapeId {
    let mut chain = ball(graph, 1.0);
    for i in 0..length {
        let next = ball(graph, 1.0 + f64::from(i) / 1e6);
        let next = moved(graph, next, [f64::from(i % 100), 0.5, 0.0]);
        let next = if i % 50 == 0 { with_material(graph, next, 0.5) } else { next };
        chain = smooth(graph, [chain, next], 0.1);
    }
    chain
}

#[test]
fn a_chain_of_twenty_thousand_overflows_no_pass() {
    let mut graph = Graph::new();
    let chain = chain(&mut graph, 20_000);
    let p = graph.point(0, Dim::Three);
    let field = Expander::new().field(&mut graph, chain, p).unwrap();
    let folded = fold_transforms(&mut graph, &[field]);
    let slope = gradient(&mut graph, folded.roots[0], p);
    assert!(operation_count(&graph, &[slope]) > 100_000);
    assert!(uniforms(&graph, &[slope]).is_empty());
    assert!(dump(&graph, &[("slope", slope)]).len() > 1_000_000);
    assert!(eval(&graph, &[slope], [0.0; 3])[0][1].abs() <= 1.001);
}

#[test]
fn materials_of_a_long_chain_overflow_nothing() {
    let mut graph = Graph::new();
    let chain = chain(&mut graph, 10_000);
    let p = graph.point(0, Dim::Three);
    let material = Expander::new().material(&mut graph, chain, p).unwrap();
    assert!(eval(&graph, &material[..1], [0.0; 3])[0][0] > 0.0);
}

#[test]
fn a_long_chain_of_maps_folds_into_one() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let mut q = p;
    for i in 0..5_000 {
        let angle = graph.number(f64::from(i) * 0.1);
        let (c, s) = (graph.unary(Unary::Cos, angle), graph.unary(Unary::Sin, angle));
        let [x, y, z] = [0, 1, 2].map(|lane| graph.component(q, lane));
        let [xc, xs, yc, ys] = [(x, c), (x, s), (y, c), (y, s)].map(|(a, b)| graph.mul(a, b));
        let (turned, up) = (graph.sub(xc, ys), graph.add(xs, yc));
        q = graph.compose(&[z, turned, up]);
        let by = graph.constant(Type::Vec3, &[0.1, 0.0, -0.1]);
        q = graph.sub(q, by);
    }
    let field = graph.length(q);
    let folded = fold_transforms(&mut graph, &[field]).roots[0];
    assert_eq!(operation_count(&graph, &[folded]), 3);
    let point = [0.3, 0.2, 0.1];
    let values = eval(&graph, &[field, folded], point);
    assert!((values[0][0] - values[1][0]).abs() < 1e-9);
}
