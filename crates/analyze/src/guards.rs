//! Guards: cheap lower bounds of operands that cost much.
//!
//! A box that contains a solid is nowhere farther away than the solid. So a field that is the exact
//! distance outside is at least the signed distance to the box. Within the solid it is, too: no
//! point of the solid is deeper in it than in the box, and the field never exceeds the depth.

use sdfc_graph::{
    Bounds, Dim, ExpandError, Expander, FAR, Graph, Guard, Node, NodeId, ShapeId, reachable,
};

use crate::analytic::boxes::MARGIN;
use crate::analytic::operands::{MarchedOperand, whole_shape};
use crate::certify::promise::Promise;
use crate::certify::quality::Qualities;
use crate::cost::cost;

/// The least number of operations of a guarded operand, loops in full. The distance to a box takes
/// 15, and some software drivers run both sides of a branch.
const LEAST_OPERATIONS: usize = 200;
/// Largest number of guards. Each is a branch.
const MAX_GUARDS: usize = 16;
/// The fraction by which a box is enlarged that limits a field. At the surface, the distance to the
/// box must be clearly below 0: where it is the greater one, it decides the normal.
const LIMIT_MARGIN: f64 = 0.02;

/// Limits costly operands whose field is only a lower bound of the distance: the value becomes the
/// maximum of the field and of the signed distance to a box around the operand. Both are lower
/// bounds, so their maximum is one, and it is at least the distance to the box: the operand can be
/// guarded. The surface stays where it is, because all of it lies within the box.
///
/// Returns the pairs of old and new values.
pub(crate) fn limit_operands(
    graph: &mut Graph,
    expander: &mut Expander,
    (bounds, qualities): (&mut Bounds, &Qualities),
    operands: &mut [MarchedOperand],
) -> Result<Vec<(NodeId, NodeId)>, ExpandError> {
    let mut replaced = Vec::new();
    for operand in operands {
        let is_wanted = !is_above_box(qualities, operand.shape)
            && cost(graph, &[operand.value]).operations >= LEAST_OPERATIONS;
        if !is_wanted || replaced.len() == MAX_GUARDS {
            continue;
        }
        let limit = distance_to_box(graph, expander, bounds, operand, LIMIT_MARGIN)?;
        if let Some(limit) = limit {
            let value = graph.max(operand.value, limit);
            replaced.push((operand.value, value));
            (operand.value, operand.limit) = (value, Some(limit));
        }
    }
    Ok(replaced)
}

/// A lower and an upper bound of operands whose formula has loops: the distance to a box around the
/// solid, or the limit, and the greatest distance to a point of the box.
pub(crate) fn bounds_of_loops(
    graph: &mut Graph,
    expander: &mut Expander,
    (bounds, qualities): (&mut Bounds, &Qualities),
    operands: &[MarchedOperand],
) -> Result<Vec<(NodeId, [NodeId; 2])>, ExpandError> {
    let mut found = Vec::new();
    for operand in operands {
        if !has_loop(graph, operand.value) {
            continue;
        }
        if let Some(limit) = operand.limit {
            found.push((operand.value, [limit, graph.number(FAR)]));
        } else if is_above_box(qualities, operand.shape)
            && let Some(corners) = box_around(graph, expander, bounds, operand)?
        {
            let point = graph.point(0, Dim::Three);
            let lower = signed_distance_to_box(graph, point, corners, MARGIN);
            let upper = greatest_distance(graph, point, corners);
            found.push((operand.value, [lower, upper]));
        }
    }
    Ok(found)
}

/// True if the value of a node is computed by a loop.
pub(crate) fn has_loop(graph: &Graph, node: NodeId) -> bool {
    reachable(graph, &[node]).into_iter().any(|id| matches!(graph.node(id), Node::Loop(..)))
}

/// The guards of the operands that are limited, or exact outside and bounded, with their shapes.
/// `fields` are the roots that the guards are for. `values` are the fields of the operands in the
/// same graph, each with its limit, or again the field.
pub(crate) fn guards(
    graph: &mut Graph,
    expander: &mut Expander,
    (bounds, qualities): (&mut Bounds, &Qualities),
    operands: &[MarchedOperand],
    values: &[[NodeId; 2]],
    fields: &[NodeId],
) -> Result<Vec<(ShapeId, Guard)>, ExpandError> {
    let mut guards = Vec::new();
    let kept = reachable(graph, fields);
    for (operand, &[value, limit]) in operands.iter().zip(values) {
        let is_wanted = (operand.limit.is_some() || is_above_box(qualities, operand.shape))
            && kept.binary_search(&value).is_ok()
            && cost(graph, &[value]).operations >= LEAST_OPERATIONS;
        if !is_wanted || guards.len() == MAX_GUARDS {
            continue;
        }
        let bound = match operand.limit {
            Some(_) => Some(limit),
            None => distance_to_box(graph, expander, bounds, operand, MARGIN)?,
        };
        guards.extend(bound.map(|bound| (operand.shape, Guard { operand: value, bound })));
    }
    Ok(guards)
}

/// The guard of a region's field at a point, with the same conditions.
pub(crate) fn guard_of_region(
    graph: &mut Graph,
    (expander, bounds): (&mut Expander, &mut Bounds),
    qualities: &Qualities,
    (shape, value): (ShapeId, NodeId),
    point: NodeId,
) -> Result<Option<Guard>, ExpandError> {
    if !is_above_box(qualities, shape) || cost(graph, &[value]).operations < LEAST_OPERATIONS {
        return Ok(None);
    }
    let mut ends = bounds.of(graph, shape);
    for end in &mut ends {
        *end = expander.node(graph, *end, &[point])?;
        *end = graph.swizzle(*end, &[0, 1]);
    }
    let has_ends = ends.iter().all(|&end| graph.is_finite(end));
    Ok(has_ends.then(|| Guard {
        operand: value,
        bound: signed_distance_to_box(graph, point, ends, MARGIN),
    }))
}

fn is_above_box(qualities: &Qualities, shape: ShapeId) -> bool {
    qualities
        .get(shape)
        .is_some_and(|quality| quality.sides.outside == Promise::Exact && quality.sides.is_bound())
}

/// The signed distance to a box around an operand; `None` if the box has no end.
fn distance_to_box(
    graph: &mut Graph,
    expander: &mut Expander,
    bounds: &mut Bounds,
    operand: &MarchedOperand,
    margin: f64,
) -> Result<Option<NodeId>, ExpandError> {
    let corners = box_around(graph, expander, bounds, operand)?;
    let point = graph.point(0, Dim::Three);
    Ok(corners.map(|corners| signed_distance_to_box(graph, point, corners, margin)))
}

/// The corners of a box around an operand; `None` if the box has no end.
fn box_around(
    graph: &mut Graph,
    expander: &mut Expander,
    bounds: &mut Bounds,
    operand: &MarchedOperand,
) -> Result<Option<[NodeId; 2]>, ExpandError> {
    let shape = whole_shape(graph, operand);
    let point = graph.point(0, Dim::Three);
    let [lo, hi] = bounds.of(graph, shape);
    let corners = [expander.node(graph, lo, &[point])?, expander.node(graph, hi, &[point])?];
    Ok(corners.iter().all(|&corner| graph.is_finite(corner)).then_some(corners))
}

/// An upper bound of the distance from a point to those of a box: that to its middle plus half of
/// its diagonal. A solid in the box is no farther away.
fn greatest_distance(graph: &mut Graph, point: NodeId, [lo, hi]: [NodeId; 2]) -> NodeId {
    let half = graph.number(0.5);
    let [sum, size] = [graph.add(hi, lo), graph.sub(hi, lo)];
    let [center, half] = [graph.mul(sum, half), graph.mul(size, half)];
    let from_center = graph.sub(point, center);
    let [away, radius] = [graph.length(from_center), graph.length(half)];
    graph.add(away, radius)
}

/// The signed distance from a point to a box or a rectangle that is larger than one with these
/// corners by a fraction of its size and of its distance from the origin.
fn signed_distance_to_box(
    graph: &mut Graph,
    point: NodeId,
    [lo, hi]: [NodeId; 2],
    margin: f64,
) -> NodeId {
    let [half, margin] = [0.5, margin].map(|factor| graph.number(factor));
    let [sum, size] = [graph.add(hi, lo), graph.sub(hi, lo)];
    let [center, half] = [graph.mul(sum, half), graph.mul(size, half)];
    let far = graph.abs(center);
    let far = graph.add(far, half);
    let margin = graph.mul(far, margin);
    let half = graph.add(half, margin);
    let from_center = graph.sub(point, center);
    let away = graph.abs(from_center);
    let past = graph.sub(away, half);
    let zero = graph.number(0.0);
    let outside = graph.max(past, zero);
    let outside = graph.length(outside);
    let lanes = (0..graph.ty(past).width() as u8).rev();
    let lanes: Vec<NodeId> = lanes.map(|lane| graph.component(past, lane)).collect();
    let deepest = lanes.into_iter().reduce(|deepest, lane| graph.max(lane, deepest));
    let inside = graph.min(deepest.unwrap_or(zero), zero);
    graph.add(outside, inside)
}
