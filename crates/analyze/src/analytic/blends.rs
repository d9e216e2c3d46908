//! The split of a smooth blend with a floor.
//!
//! A floor in a smooth blend is just a floor where all other operands are farther away than the
//! width of the blend. So an unbounded operand of a blend is intersected analytically there, and
//! the blend as a whole is marched around the other operands.

use sdfc_graph::{Dim, ExpandError, NodeId, Shape, ShapeId, blend_at};

use crate::analytic::operands::{AnalyticOperand, Operands};
use crate::analytic::split::{Formula, LocalRay, Splitter};
use crate::shapes::{is_bounded, minimum, unnamed_shape};

impl Splitter<'_> {
    /// Splits a chain of blends that has one unbounded analytic operand. Returns that operand, and
    /// a shape outside of which the blend equals the operand.
    pub(super) fn split_blend(
        &mut self,
        shape: ShapeId,
        ray: &LocalRay,
    ) -> Result<Option<(Vec<AnalyticOperand>, ShapeId)>, ExpandError> {
        let Shape { formula: root, dim, level, .. } = *self.graph.shape(shape);
        let is_own = level == 0 && ray.has_level(level);
        if dim != Dim::Three || !is_own || is_bounded(self.graph, self.bounds, shape) {
            return Ok(None);
        }
        let mut formula = Formula::new(level, ray.clone());
        let (mut node, mut chain) = (root, Vec::new());
        let analytic = loop {
            let Some(blend) = blend_at(self.graph, &mut self.blends, node) else { return Ok(None) };
            let [a, b] = blend.values;
            if let Some(analytic) = self.unbounded(&mut formula, a)? {
                chain.push((node, blend, b));
                break analytic;
            }
            if let Some(analytic) = self.unbounded(&mut formula, b)? {
                chain.push((node, blend, a));
                break analytic;
            }
            let [before, operand] = blend.ordered_values(self.graph, &mut self.blends);
            chain.push((node, blend, operand));
            node = before;
        };
        let mut others = Vec::with_capacity(chain.len());
        for (node, blend, operand) in chain {
            // Nearer than the sum of its width and depth, the blend may differ from the operand.
            let Some(depth) = blend.depth(self.graph, node) else { return Ok(None) };
            let reach = self.graph.add(blend.width, depth);
            others.push(self.graph.sub(operand, reach));
        }
        let children = self.graph.shape(shape).children.clone();
        let bounding =
            minimum(self.graph, others).map(|value| unnamed_shape(self.graph, value, children));
        Ok(bounding.map(|bounding| (analytic, bounding)))
    }

    /// The analytic operands of a sample if they are unbounded; `None` otherwise.
    fn unbounded(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
    ) -> Result<Option<Vec<AnalyticOperand>>, ExpandError> {
        let Some(Operands { analytic, marched }) = self.split_sample(formula, node)? else {
            return Ok(None);
        };
        let is_unbounded = marched.is_empty()
            && analytic.iter().all(|operand| operand.intervals.reach.is_none())
            && !analytic.iter().all(|operand| is_bounded(self.graph, self.bounds, operand.shape));
        Ok(is_unbounded.then_some(analytic))
    }
}
