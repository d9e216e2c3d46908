//! The code that the builders make of a field written as the standard library writes it.

use sdfc_graph::{Dim, Graph, NodeId, Type, dump, gradient, operation_count};

fn vec3(graph: &mut Graph, lanes: [f64; 3]) -> NodeId {
    graph.constant(Type::Vec3, &lanes)
}

fn ball(graph: &mut Graph, p: NodeId, centre: [f64; 3], radius: f64) -> NodeId {
    let (centre, radius) = (vec3(graph, centre), graph.number(radius));
    let q = graph.sub(p, centre);
    let length = graph.length(q);
    graph.sub(length, radius)
}

fn block(graph: &mut Graph, p: NodeId, size: [f64; 3]) -> NodeId {
    let (size, two, nought) = (vec3(graph, size), graph.number(2.0), graph.number(0.0));
    let half = graph.div(size, two);
    let folded = graph.abs(p);
    let q = graph.sub(folded, half);
    let above = graph.max(q, nought);
    let outside = graph.length(above);
    let [x, y, z] = [0, 1, 2].map(|lane| graph.component(q, lane));
    let xy = graph.max(x, y);
    let deepest = graph.max(xy, z);
    let inside = graph.min(deepest, nought);
    graph.add(outside, inside)
}

fn ground(graph: &mut Graph, p: NodeId, y: f64) -> NodeId {
    let (normal, y) = (vec3(graph, [0.0, 2.0, 0.0]), graph.number(y));
    let unit = graph.unary(sdfc_graph::Unary::Normalize, normal);
    let height = graph.dot(p, unit);
    graph.sub(height, y)
}

fn smooth(graph: &mut Graph, a: NodeId, b: NodeId, k: NodeId) -> NodeId {
    let (nought, tiny, quarter) = (graph.number(0.0), graph.number(1e-9), graph.number(0.25));
    let difference = graph.sub(b, a);
    let distance = graph.abs(difference);
    let reach = graph.sub(k, distance);
    let h = graph.max(reach, nought);
    let divisor = graph.max(k, tiny);
    let factor = graph.div(quarter, divisor);
    let square = graph.mul(h, h);
    let swell = graph.mul(square, factor);
    let least = graph.min(a, b);
    graph.sub(least, swell)
}

const FIELD: &str = "\
%0 = point 0 : vec3
%1 = sub %0 [0.4, 0.7, 0.4] : vec3
%2 = length %1 : number
%3 = sub %2 0.8 : number
%4 = abs %0 : vec3
%5 = sub %4 [0.8, 0.5, 0.8] : vec3
%6 = max %5 [0, 0, 0] : vec3
%7 = length %6 : number
%8 = %5.x : number
%9 = %5.y : number
%10 = max %8 %9 : number
%11 = %5.z : number
%12 = max %10 %11 : number
%13 = min %12 0 : number
%14 = add %7 %13 : number
%15 = min %3 %14 : number
%16 = sub %14 %3 : number
%17 = abs %16 : number
%18 = sub 0.4 %17 : number
%19 = max %18 0 : number
%20 = mul %19 %19 : number
%21 = mul %20 -0.625 : number
%22 = add %15 %21 : number
%23 = %0.y : number
%24 = add %23 0.5 : number
%25 = min %22 %24 : number
field = %25
";

#[test]
fn a_ball_joined_with_a_block_over_a_plane_has_few_operations() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let (a, b) = (ball(&mut graph, p, [0.4, 0.7, 0.4], 0.8), block(&mut graph, p, [1.6, 1.0, 1.6]));
    let k = graph.number(0.4);
    let joined = smooth(&mut graph, a, b, k);
    let plane = ground(&mut graph, p, -0.5);
    let field = graph.min(joined, plane);
    assert_eq!(dump(&graph, &[("field", field)]), FIELD);
    assert_eq!(operation_count(&graph, &[field]), 21);
    let gradient = gradient(&mut graph, field, p);
    // The field's operations are a subset of the gradient's.
    assert_eq!(operation_count(&graph, &[field, gradient]), 54);
}
