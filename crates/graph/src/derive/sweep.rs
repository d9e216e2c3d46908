//! The reverse sweep: summing up the contributions to each node.

use super::live::live_nodes;
use crate::graph::Graph;
use crate::ids::{IdMap, IdSet};
use crate::node::{Binary, NodeId, Type};
use crate::walk::computed_where;

/// Lengths below this count as 0 where a derivative divides by them. Squares of shorter vectors
/// underflow in f32, so that they have no direction there.
pub(crate) const TINY: f64 = 1e-18;

/// Derivatives of a scalar root with respect to nodes: for each of `wrt`, a node of its type.
///
/// The nodes of `wrt` count as independent of each other: no derivative is passed through one to
/// the next. Samples that are not in `wrt` count as constants.
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
    let mut sweep = Sweep::new(graph, live, inputs.clone());
    sweep.run(root, order.into_iter().rev().filter(|&id| !inputs.contains(id)));
    wrt.iter().map(|&id| sweep.total(id)).collect()
}

/// Zero of a type.
pub(super) fn zero(graph: &mut Graph, ty: Type) -> NodeId {
    graph.constant(ty, &[0.0; 4])
}

/// The contributions that a node has received so far. Contributions to single components are stored
/// separately, so that their sum needs no vectors of zeros.
#[derive(Clone, Copy, Default)]
struct Adjoint {
    whole: Option<NodeId>,
    lanes: [Option<NodeId>; 4],
}

/// A reverse sweep in progress.
pub(super) struct Sweep<'a> {
    pub(super) graph: &'a mut Graph,
    pub(super) live: IdSet,
    /// The nodes at which the sweep ends.
    pub(super) inputs: IdSet,
    /// Scalars whose derivatives are known.
    pub(super) known: IdMap<Known>,
    adjoints: IdMap<Adjoint>,
}

/// A known derivative: of a scalar with respect to a node that it depends on the inputs through.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    /// The node that the scalar is differentiated by.
    pub(super) frame: NodeId,
    /// The derivative, of the frame's type.
    pub(super) derivative: NodeId,
}

impl<'a> Sweep<'a> {
    pub(super) fn new(graph: &'a mut Graph, live: IdSet, inputs: IdSet) -> Self {
        Self { graph, live, inputs, known: IdMap::default(), adjoints: IdMap::default() }
    }

    /// Starts at the root and passes adjoints on, in the given order.
    pub(super) fn run(&mut self, root: NodeId, order: impl Iterator<Item = NodeId>) {
        let one = self.graph.number(1.0);
        self.accumulate(root, one);
        for id in order {
            let Some(adjoint) = self.take(id) else { continue };
            match self.known.get(id) {
                Some(Known { frame, derivative }) => {
                    let part = self.graph.mul(derivative, adjoint);
                    self.accumulate(frame, part);
                }
                None => self.propagate(id, adjoint),
            }
        }
    }

    /// Adds to a node's adjoint. `contribution` has the node's type.
    pub(super) fn accumulate(&mut self, id: NodeId, contribution: NodeId) {
        if !self.live.contains(id) || self.is_zero(contribution) {
            return;
        }
        let whole = self.adjoints.get(id).and_then(|adjoint| adjoint.whole);
        let sum = whole.map_or(contribution, |whole| self.graph.add(whole, contribution));
        self.adjoints.entry(id).get_or_insert_default().whole = Some(sum);
    }

    /// Adds to the adjoint of one component.
    pub(super) fn accumulate_lane(&mut self, id: NodeId, lane: u8, contribution: NodeId) {
        if self.graph.ty(id).width() == 1 {
            return self.accumulate(id, contribution);
        }
        if !self.live.contains(id) || self.is_zero(contribution) {
            return;
        }
        let lane = usize::from(lane);
        let before = self.adjoints.get(id).and_then(|adjoint| adjoint.lanes[lane]);
        let sum = before.map_or(contribution, |before| self.graph.add(before, contribution));
        self.adjoints.entry(id).get_or_insert_default().lanes[lane] = Some(sum);
    }

    pub(super) fn is_zero(&self, id: NodeId) -> bool {
        self.graph.as_splat_number(id) == Some(0.0)
    }

    /// The sum of a node's contributions, which are taken out; `None` if there are none.
    pub(super) fn take(&mut self, id: NodeId) -> Option<NodeId> {
        let Adjoint { whole, lanes } = self.adjoints.entry(id).take()?;
        if lanes == [None; 4] {
            return whole;
        }
        let zero_lane = self.graph.number(0.0);
        let width = self.graph.ty(id).width();
        let parts = lanes.map(|lane| lane.unwrap_or(zero_lane));
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

    /// Passes on a contribution that is built only if the argument needs it.
    pub(super) fn accumulate_with(&mut self, id: NodeId, part: impl FnOnce(&mut Self) -> NodeId) {
        if self.live.contains(id) {
            let part = part(self);
            self.accumulate(id, part);
        }
    }
}
