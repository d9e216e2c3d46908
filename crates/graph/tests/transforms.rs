//! The form that a chain of affine maps takes after folding.

use sdfc_graph::{Dim, FrameInput, Graph, NodeId, Type, Unary, dump, fold_transforms, uniforms};

/// A rotation about one axis, as a formula would write it.
fn turned(graph: &mut Graph, v: NodeId, axis: u8, angle: NodeId) -> NodeId {
    let (i, j) = (usize::from((axis + 1) % 3), usize::from((axis + 2) % 3));
    let (c, s) = (graph.unary(Unary::Cos, angle), graph.unary(Unary::Sin, angle));
    let mut parts = [0, 1, 2].map(|lane| graph.component(v, lane));
    let (x, y) = (parts[i], parts[j]);
    let [xc, xs, yc, ys] = [(x, c), (x, s), (y, c), (y, s)].map(|(a, b)| graph.mul(a, b));
    (parts[i], parts[j]) = (graph.sub(xc, ys), graph.add(xs, yc));
    graph.compose(&parts)
}

fn degrees(graph: &mut Graph, angle: f64) -> NodeId {
    graph.number(angle.to_radians())
}

fn moved(graph: &mut Graph, v: NodeId, by: [f64; 3]) -> NodeId {
    let by = graph.constant(Type::Vec3, &by);
    graph.sub(v, by)
}

fn folded(graph: &mut Graph, q: NodeId) -> String {
    // An operation that is not affine uses the chain.
    let field = graph.length(q);
    let roots = fold_transforms(graph, &[field]).roots;
    dump(graph, &[("field", roots[0])])
}

#[test]
fn a_rotation_by_a_right_angle_is_a_swizzle() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let quarter = degrees(&mut graph, 90.0);
    let q = turned(&mut graph, p, 2, quarter);
    assert_eq!(
        folded(&mut graph, q),
        "%0 = point 0 : vec3
%1 = %0.y : number
%2 = neg %1 : number
%3 = %0.x : number
%4 = %0.z : number
%5 = compose %2 %3 %4 : vec3
%6 = length %5 : number
field = %6
"
    );
}

#[test]
fn a_cycle_of_axes_is_one_swizzle() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let quarter = degrees(&mut graph, 90.0);
    let q = turned(&mut graph, p, 2, quarter);
    let q = turned(&mut graph, q, 0, quarter);
    let q = moved(&mut graph, q, [1.0, 2.0, 3.0]);
    let text = folded(&mut graph, q);
    assert!(!text.contains("mul") && !text.contains("transform"), "{text}");
}

#[test]
fn three_rotations_and_translations_are_one_transform_and_one_addition() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let mut q = moved(&mut graph, p, [1.0, 0.0, 0.0]);
    for axis in 0..3 {
        let angle = degrees(&mut graph, 20.0 + 10.0 * f64::from(axis));
        q = turned(&mut graph, q, axis, angle);
        q = moved(&mut graph, q, [0.0, 0.0, 2.0]);
    }
    let text = folded(&mut graph, q);
    let operations: Vec<&str> = text.lines().filter_map(|line| line.split(' ').nth(2)).collect();
    assert_eq!(operations[..4], ["point", "transform", "sub", "length"]);
}

#[test]
fn one_rotation_is_not_replaced() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let angle = degrees(&mut graph, 30.0);
    let q = turned(&mut graph, p, 1, angle);
    let text = folded(&mut graph, q);
    assert!(!text.contains("transform"), "{text}");
    assert_eq!(text.matches("mul").count(), 4, "{text}");
}

#[test]
fn a_node_shared_by_several_maps_is_computed_once() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let mut q = p;
    for axis in 0..3 {
        let angle = degrees(&mut graph, 20.0 + f64::from(axis));
        q = turned(&mut graph, q, axis, angle);
    }
    let ends = [1.0, 2.0, 3.0].map(|x| {
        let moved = moved(&mut graph, q, [x, 0.0, 0.0]);
        graph.length(moved)
    });
    let roots = fold_transforms(&mut graph, &ends).roots;
    let named: Vec<(&str, NodeId)> = roots.into_iter().map(|root| ("field", root)).collect();
    assert_eq!(dump(&graph, &named).matches("transform").count(), 1);
}

#[test]
fn a_map_after_a_bend_folds_over_the_result_of_the_bend() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let rate = graph.number(0.5);
    let mut q = graph.abs(p);
    let angle = graph.component(p, 1);
    let angle = graph.mul(angle, rate);
    q = turned(&mut graph, q, 1, angle);
    for axis in 0..3 {
        let angle = degrees(&mut graph, 20.0 + f64::from(axis));
        q = turned(&mut graph, q, axis, angle);
    }
    let text = folded(&mut graph, q);
    assert_eq!(text.matches("transform").count(), 1, "{text}");
}

#[test]
fn per_frame_coefficients_take_uniform_slots_as_vectors() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let time = graph.frame_input(FrameInput::Time, Type::Scalar);
    let mut q = p;
    for axis in 0..3 {
        q = turned(&mut graph, q, axis, time);
    }
    let by = graph.splat(Type::Vec3, time);
    let q = graph.sub(q, by);
    let field = graph.length(q);
    let root = fold_transforms(&mut graph, &[field]).roots[0];
    let types: Vec<Type> =
        uniforms(&graph, &[root]).into_iter().map(|slot| graph.ty(slot)).collect();
    assert_eq!(types.iter().filter(|&&ty| ty == Type::Vec3).count(), 3, "{types:?}");
    assert!(types.len() <= 4, "{types:?}");
}
