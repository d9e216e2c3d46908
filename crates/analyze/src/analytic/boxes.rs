//! The intervals along a ray that lie inside boxes.

use sdfc_graph::{FAR, Graph, NodeId, Stage};

/// The fraction of its size by which a box is enlarged: more than the rounding errors of f32.
pub(crate) const MARGIN: f64 = 1e-5;
/// Smallest absolute value of a component of a direction; smaller ones are replaced by it.
const MIN_SLOPE: f64 = 1e-12;

/// The distances at which a ray, given by origin and direction, enters and leaves a box. Where the
/// ray misses the box, the first is above the second. Walls that are not known to be finite are
/// ignored; returns `None` if there are no others.
pub(crate) fn clip(
    graph: &mut Graph,
    [origin, direction]: [NodeId; 2],
    [lo, hi]: [NodeId; 2],
) -> Option<[NodeId; 2]> {
    let (mut enter, mut exit) = (graph.number(-FAR), graph.number(FAR));
    let (first, last) = (enter, exit);
    for lane in 0..3 {
        let [origin, direction] = [origin, direction].map(|v| graph.component(v, lane));
        let [lo, hi] = [lo, hi].map(|v| graph.component(v, lane));
        let walls = [lo, hi].map(|wall| is_finite(graph, wall));
        if walls == [false, false] {
            continue;
        }
        let zero = graph.number(0.0);
        let rises = graph.le(zero, direction);
        let inverse = inverse(graph, direction, rises);
        let margin = margin(graph, [lo, hi], walls);
        let crossing = |graph: &mut Graph, wall: NodeId| {
            let away = graph.sub(wall, origin);
            graph.mul(away, inverse)
        };
        let below = walls[0].then(|| {
            let wall = graph.sub(lo, margin);
            crossing(graph, wall)
        });
        let above = walls[1].then(|| {
            let wall = graph.add(hi, margin);
            crossing(graph, wall)
        });
        let [near, far] = match (below, above) {
            (Some(a), Some(b)) => [graph.min(a, b), graph.max(a, b)],
            (Some(a), None) => [graph.select(rises, a, first), graph.select(rises, last, a)],
            (None, Some(b)) => [graph.select(rises, first, b), graph.select(rises, b, last)],
            (None, None) => [first, last],
        };
        enter = graph.max(enter, near);
        exit = graph.min(exit, far);
    }
    ([enter, exit] != [first, last]).then_some([enter, exit])
}

/// Removes the boxes that are known to lie within another one.
pub(crate) fn outermost(graph: &Graph, boxes: &[[NodeId; 2]]) -> Vec<[NodeId; 2]> {
    let lies_in = |[lo, hi]: [NodeId; 2], [low, high]: [NodeId; 2]| {
        let at_most = |a: NodeId, b: NodeId| {
            let (Some(a), Some(b)) = (graph.as_const(a), graph.as_const(b)) else { return a == b };
            a.lanes().iter().zip(b.lanes()).all(|(a, b)| *a <= b)
        };
        at_most(low, lo) && at_most(hi, high)
    };
    let mut outermost: Vec<[NodeId; 2]> = Vec::with_capacity(boxes.len());
    for &one in boxes {
        if !outermost.iter().any(|&other| lies_in(one, other)) {
            outermost.retain(|&other| !lies_in(other, one));
            outermost.push(one);
        }
    }
    outermost
}

/// The interval from where a ray first enters one of some boxes to where it leaves the last one.
/// Boxes that the ray misses, or that lie behind its origin, do not count. Returns `None` if there
/// is no box.
pub(crate) fn hull(graph: &mut Graph, intervals: &[[NodeId; 2]]) -> Option<[NodeId; 2]> {
    if let [] | [_] = intervals {
        return intervals.first().copied();
    }
    let [zero, far, before] = [0.0, FAR, -FAR].map(|end| graph.number(end));
    let (mut first, mut last) = (far, before);
    for &[enter, exit] in intervals {
        let start = graph.max(enter, zero);
        let passes = graph.le(start, exit);
        let [start, end] = [graph.select(passes, start, far), graph.select(passes, exit, before)];
        first = graph.min(first, start);
        last = graph.max(last, end);
    }
    Some([first, last])
}

/// The inverse of a component of a direction. [`MIN_SLOPE`] keeps it finite.
fn inverse(graph: &mut Graph, component: NodeId, rises: NodeId) -> NodeId {
    let (smallest, one) = (graph.number(MIN_SLOPE), graph.number(1.0));
    let size = graph.abs(component);
    let size = graph.max(size, smallest);
    let negative = graph.neg(size);
    let slope = graph.select(rises, size, negative);
    graph.div(one, slope)
}

/// True if the coordinate of a wall is known to be finite.
fn is_finite(graph: &Graph, wall: NodeId) -> bool {
    match graph.as_number(wall) {
        Some(value) => value.is_finite(),
        None => graph.stage(wall) == Stage::Frame && graph.is_finite(wall),
    }
}

fn margin(graph: &mut Graph, ends: [NodeId; 2], walls: [bool; 2]) -> NodeId {
    let mut size = graph.number(0.0);
    for (end, _) in ends.into_iter().zip(walls).filter(|(_, wall)| *wall) {
        let end = graph.abs(end);
        size = graph.max(size, end);
    }
    let fraction = graph.number(MARGIN);
    graph.mul(size, fraction)
}
