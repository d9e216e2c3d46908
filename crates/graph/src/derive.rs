//! Derivatives by one reverse sweep.
//!
//! A scalar's derivatives with respect to any number of nodes take one walk from the scalar down to them: each
//! node collects the derivative of the root with respect to it, its adjoint, from what uses it, and hands
//! parts of it on to its arguments. So the emitted gradient costs about three times the field's
//! operations for all its components together, where a forward derivative costs that for each.
//!
//! At points without a derivative the rules are definite:
//!
//! | operation | derivative |
//! |---|---|
//! | `length`, `normalize`, `sqrt` at 0 | 0 |
//! | `abs` at 0 | +1 |
//! | `min`, `max`, `clamp`, `saturate`, `select` | that of the argument selected; on a tie the first |
//! | `floor`, `ceil`, `round`, `trunc`, `sign`, `step`, `hash`, comparisons, the number of a loop's rounds | 0 |
//! | `x % y` | 1 for x, `-floor(x / y)` for y |

mod repeat;
mod rules;

pub(crate) use rules::TINY;

use crate::ids::{IdMap, IdSet};
use crate::walk::computed_where;
use crate::{Binary, Graph, NodeId, Type};

/// Derivatives of a scalar root with respect to nodes: for each of `wrt` a node of its type.
///
/// The nodes of `wrt` count as independent of each other: nothing is carried through one to the next. Samples
/// that are not in `wrt` count as constants.
///
/// ```
/// use sdfc_graph::eval::{FrameValues, evaluate_frame};
/// use sdfc_graph::{FrameInput, Graph, Type, adjoints};
///
/// let mut graph = Graph::new();
/// let a = graph.frame_input(FrameInput::Param(0), Type::Scalar);
/// let b = graph.frame_input(FrameInput::Param(1), Type::Scalar);
/// let product = graph.mul(a, b);
/// let slopes = adjoints(&mut graph, product, &[a, b]);
///
/// let params = vec![[2.0; 4], [3.0; 4]];
/// let values = evaluate_frame(&graph, &slopes, &FrameValues { params, ..FrameValues::default() });
/// assert_eq!([values[0][0], values[1][0]], [3.0, 2.0]);
/// ```
pub fn adjoints(graph: &mut Graph, root: NodeId, wrt: &[NodeId]) -> Vec<NodeId> {
    let inputs: IdSet = wrt.iter().copied().collect();
    let order = computed_where(graph, &[root], |id| !inputs.contains(id));
    let live = live_nodes(graph, &order, &inputs);
    let mut sweep = Sweep { graph, live, adjoints: IdMap::default() };
    let one = sweep.graph.number(1.0);
    sweep.give(root, one);
    for &id in order.iter().rev().filter(|&&id| !inputs.contains(id)) {
        if let Some(adjoint) = sweep.take(id) {
            sweep.hand_down(id, adjoint);
        }
    }
    wrt.iter().map(|&id| sweep.total(id)).collect()
}

/// The gradient of a scalar root with respect to a point (or any other node), a vector of its type.
pub fn gradient(graph: &mut Graph, root: NodeId, point: NodeId) -> NodeId {
    let found = adjoints(graph, root, &[point]);
    match repeat::merged(graph, &found)[..] {
        [gradient] => gradient,
        _ => zero(graph, graph.ty(point)),
    }
}

/// The nodes whose value moves with one of the inputs.
fn live_nodes(graph: &Graph, order: &[NodeId], inputs: &IdSet) -> IdSet {
    let mut live = IdSet::default();
    for &id in order {
        let moves = inputs.contains(id)
            || (rules::passes_derivatives(graph, id)
                && graph.inputs(id).into_iter().any(|input| live.contains(input)));
        if moves {
            live.insert(id);
        }
    }
    live
}

pub(crate) fn zero(graph: &mut Graph, ty: Type) -> NodeId {
    graph.constant(ty, &[0.0; 4])
}

/// What a node has been given so far. Parts given to single components are kept apart, so that a sum
/// over components needs no vectors of zeros.
#[derive(Clone, Copy, Default)]
struct Adjoint {
    whole: Option<NodeId>,
    lanes: [Option<NodeId>; 4],
}

struct Sweep<'a> {
    graph: &'a mut Graph,
    live: IdSet,
    adjoints: IdMap<Adjoint>,
}

impl Sweep<'_> {
    /// Adds to a node's adjoint; `part` has the node's type.
    fn give(&mut self, id: NodeId, part: NodeId) {
        if !self.live.contains(id) || self.is_zero(part) {
            return;
        }
        let whole = self.adjoints.get(id).and_then(|adjoint| adjoint.whole);
        let sum = whole.map_or(part, |whole| self.graph.add(whole, part));
        self.adjoints.slot(id).get_or_insert_default().whole = Some(sum);
    }

    /// Adds to the adjoint of one component.
    fn give_lane(&mut self, id: NodeId, lane: u8, part: NodeId) {
        if self.graph.ty(id).width() == 1 {
            return self.give(id, part);
        }
        if !self.live.contains(id) || self.is_zero(part) {
            return;
        }
        let lane = usize::from(lane);
        let before = self.adjoints.get(id).and_then(|adjoint| adjoint.lanes[lane]);
        let sum = before.map_or(part, |before| self.graph.add(before, part));
        self.adjoints.slot(id).get_or_insert_default().lanes[lane] = Some(sum);
    }

    fn is_zero(&self, id: NodeId) -> bool {
        self.graph.as_uniform(id) == Some(0.0)
    }

    /// All that a node was given, as one node; `None` for nothing.
    fn take(&mut self, id: NodeId) -> Option<NodeId> {
        let Adjoint { whole, lanes } = self.adjoints.slot(id).take()?;
        if lanes == [None; 4] {
            return whole;
        }
        let nothing = self.graph.number(0.0);
        let width = self.graph.ty(id).width();
        let parts = lanes.map(|lane| lane.unwrap_or(nothing));
        let composed = self.graph.compose(&parts[..width]);
        Some(whole.map_or(composed, |whole| self.graph.binary(Binary::Add, whole, composed)))
    }

    fn total(&mut self, id: NodeId) -> NodeId {
        let adjoint = self.adjoints.get(id);
        let total = self.take(id);
        if let Some(adjoint) = adjoint {
            self.adjoints.insert(id, adjoint);
        }
        total.unwrap_or_else(|| zero(self.graph, self.graph.ty(id)))
    }
}
