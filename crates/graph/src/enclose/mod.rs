//! Interval bounds of a field along a segment of a ray (its *enclosure*), as nodes.
//!
//! For each node of a field there are nodes for its least and its greatest value on a straight
//! segment between two points, and for its slope there. They are ordinary math: they fold, merge
//! and are lowered and evaluated like any other node.
//!
//! A value that depends on the point by an affine map is affine along the segment. It is stored as
//! its values at the ends ([`values::Affine`]), which no rotation widens. Lengths of such vectors
//! are bounded exactly. Everything else is bounded by intervals ([`values::Interval`]).
//!
//! *Rounding.* The bounds, computed in f32, contain the field as computed in f32 and in real
//! arithmetic. Every operation that rounds widens its result: by 2^-22 of it after sums and
//! products, by twice that after roots and quotients, by 2^-20 of the terms' magnitudes after
//! affine maps, and by 2^-16 after trigonometric functions and powers, for which devices promise
//! less. Numbers of 1e15 and more count as infinite, and so do values computed from them.

mod arithmetic;
mod encloser;
mod functions;
mod intervals;
mod loops;
mod nodes;
mod overflow;
mod slope;
mod values;
mod vectors;

use self::encloser::Encloser;
use self::values::ROUNDING;
use crate::dump::operation_count;
use crate::graph::Graph;
use crate::node::NodeId;

/// Largest number of operations of a formula with tight bounds.
const MAX_TIGHT: usize = 200;

/// The least and the greatest value of a scalar on the segment from one point to another, as two
/// nodes.
///
/// `point` is the node that stands for a point of the segment, `ends` are nodes of its type. `None`
/// if the root samples a shape or is not a scalar.
///
/// ```
/// use sdfc_graph::eval::{FrameValues, evaluate_frame};
/// use sdfc_graph::{Dim, FrameInput, Graph, Type, enclosure};
///
/// let mut graph = Graph::new();
/// let p = graph.point(0, Dim::Three);
/// let (length, radius) = (graph.length(p), graph.number(1.0));
/// let ball = graph.sub(length, radius);
/// let ends = [0, 1].map(|i| graph.frame_input(FrameInput::Param(i), Type::Vec3));
/// let range = enclosure(&mut graph, ball, p, ends).expect("flat math");
///
/// // From one side of the ball to the other.
/// let params = vec![[-3.0, 0.5, 0.0, 0.0], [2.0, 0.5, 0.0, 0.0]];
/// let values = evaluate_frame(&graph, &range, &FrameValues { params, ..FrameValues::default() });
/// assert!((values[0][0] + 0.5).abs() < 1e-5);
/// assert!((values[1][0] - (9.25_f64.sqrt() - 1.0)).abs() < 1e-5);
/// ```
pub fn enclosure(
    graph: &mut Graph,
    root: NodeId,
    point: NodeId,
    ends: [NodeId; 2],
) -> Option<[NodeId; 2]> {
    let mut encloser = Encloser::new(graph, None);
    let known = encloser.bound_root(root, point, ends)?;
    let interval = encloser.interval(known.value);
    Some([interval.lo, interval.hi])
}

/// The same as [`enclosure`] with a lower bound that may be greater: the value at the first end,
/// and as far below it as the slope allows. Its excess shrinks with the square of the segment,
/// where that of plain interval arithmetic shrinks with its length. Formulas of more than
/// 200 operations keep the plain bounds, since these cost several times as much.
pub fn tight_enclosure(
    graph: &mut Graph,
    root: NodeId,
    point: NodeId,
    ends: [NodeId; 2],
) -> Option<[NodeId; 2]> {
    let [lo, hi] = enclosure(graph, root, point, ends)?;
    if operation_count(graph, &[root]) > MAX_TIGHT {
        return Some([lo, hi]);
    }
    let across = graph.sub(ends[1], ends[0]);
    let [fall, _] = slope_enclosure(graph, root, point, ends, across)?;
    let [start, _] = enclosure(graph, root, point, [ends[0]; 2])?;
    let zero = graph.number(0.0);
    let fall = graph.min(fall, zero);
    let least = graph.add(start, fall);
    let sizes = [start, fall].map(|node| graph.abs(node));
    let (size, rounding) = (graph.add(sizes[0], sizes[1]), graph.number(2.0 * ROUNDING));
    let margin = graph.mul(size, rounding);
    let least = graph.sub(least, margin);
    Some([graph.max(lo, least), hi])
}

/// The least and the greatest slope of a scalar on a segment: its derivative with respect to s at
/// `p + s * direction`, where the segment runs along `direction`. Where the value may jump, the
/// bounds are -1e15 and 1e15.
///
/// Two values on the segment differ by no more than the slope bounds allow.
pub fn slope_enclosure(
    graph: &mut Graph,
    root: NodeId,
    point: NodeId,
    ends: [NodeId; 2],
    direction: NodeId,
) -> Option<[NodeId; 2]> {
    let mut encloser = Encloser::new(graph, Some(direction));
    let known = encloser.bound_root(root, point, ends)?;
    let slope = encloser.slope(known);
    let interval = encloser.interval(slope);
    Some([interval.lo, interval.hi])
}
