//! Analytic and marched operands of a scene.

use sdfc_graph::{Graph, NodeId, ShapeId};

use crate::analytic::intervals::RayIntervals;
use crate::shapes::{minimum, unnamed_shape};

/// The operands of the union that a scene is.
#[derive(Clone, Debug, Default)]
pub(crate) struct Operands {
    /// Operands that are intersected without marching.
    pub analytic: Vec<AnalyticOperand>,
    /// Operands that are marched.
    pub marched: Vec<MarchedOperand>,
}

/// An operand with known intervals.
#[derive(Clone, Debug)]
pub(crate) struct AnalyticOperand {
    /// The shape.
    pub shape: ShapeId,
    /// Its conservative field.
    pub value: NodeId,
    /// The intervals in which a ray is inside.
    pub intervals: RayIntervals,
    /// As in [`MarchedOperand`].
    pub(super) point: NodeId,
    pub(super) scale: NodeId,
}

impl AnalyticOperand {
    fn into_marched(self) -> MarchedOperand {
        let Self { shape, value, intervals, point, scale } = self;
        let local = intervals.reach.is_some().then_some(intervals);
        MarchedOperand { shape, value, limit: None, local, bounding: shape, point, scale }
    }
}

impl Operands {
    /// Makes the analytic operands at these positions marched ones.
    pub(crate) fn make_marched(&mut self, positions: &[usize]) {
        let (mut position, mut analytic) = (0, Vec::new());
        for operand in std::mem::take(&mut self.analytic) {
            if positions.binary_search(&position).is_ok() {
                self.marched.push(operand.into_marched());
            } else {
                analytic.push(operand);
            }
            position += 1;
        }
        self.analytic = analytic;
    }

    /// Makes operands marched whose intervals are known only within a distance.
    pub(super) fn with_local_marched(self) -> Self {
        let is_local = |operand: &AnalyticOperand| operand.intervals.reach.is_some();
        let (local, analytic): (Vec<_>, Vec<_>) = self.analytic.into_iter().partition(is_local);
        let marched = self
            .marched
            .into_iter()
            .chain(local.into_iter().map(AnalyticOperand::into_marched))
            .collect();
        Self { analytic, marched }
    }
}

/// An operand that is marched.
#[derive(Clone, Debug)]
pub(crate) struct MarchedOperand {
    /// The shape.
    pub shape: ShapeId,
    /// Its conservative field.
    pub value: NodeId,
    /// The signed distance to a box around it that its value is nowhere less than.
    pub limit: Option<NodeId>,
    /// The intervals in which a ray is inside, known up to some distance from the ray's origin.
    pub local: Option<RayIntervals>,
    /// A shape that bounds the part of the operand that is not analytic.
    pub(super) bounding: ShapeId,
    /// The point of the scene at which it is sampled.
    pub(super) point: NodeId,
    /// The factor of its distance.
    pub(super) scale: NodeId,
}

impl MarchedOperand {
    /// The field of the operand's shape, or of a part of it, where the operand is in the scene.
    fn placed(&self, graph: &mut Graph, shape: ShapeId) -> NodeId {
        let sample = graph.sample(shape, self.point);
        graph.mul(self.scale, sample)
    }
}

/// A shape that bounds the parts of some operands that must be marched.
pub(crate) fn bounding_shape(graph: &mut Graph, marched: &[MarchedOperand]) -> Option<ShapeId> {
    let mut values = Vec::with_capacity(marched.len());
    for operand in marched {
        values.push(operand.placed(graph, operand.bounding));
    }
    let formula = minimum(graph, values)?;
    let children = marched.iter().map(|operand| operand.bounding).collect();
    Some(unnamed_shape(graph, formula, children))
}

/// The shape of an operand where it is in the scene, with its analytic part.
pub(crate) fn whole_shape(graph: &mut Graph, operand: &MarchedOperand) -> ShapeId {
    let formula = operand.placed(graph, operand.shape);
    unnamed_shape(graph, formula, vec![operand.shape])
}
