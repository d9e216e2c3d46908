//! Copies of shapes, of which few are sampled at a place.
//!
//! A shape that says `copies` is the least of samples and of a value than which nothing that is not sampled is nearer. So within a ball
//! of that radius about a ray's origin it is what is sampled there: where a cell's index jumps, other copies are sampled, but those
//! in the ball are the same. A copy is moved rigidly while the index keeps its value.

use rustc_hash::FxHashSet;
use sdfc_graph::{Binary, Dim, ExpandError, Node, NodeId, Shape, ShapeId, reachable};

use super::{Parts, Pass, Place, least};
use crate::affine::{applied, linear_between_jumps, similarity};
use crate::fault::Rule;
use crate::spans::{Known, joined};

impl Pass<'_> {
    /// Where a ray is inside of the copies that a shape samples at the ray's origin, and how far that is all there is.
    pub(super) fn copies(
        &mut self,
        shape: ShapeId,
        place: &Place,
    ) -> Result<Option<Known>, ExpandError> {
        let Shape { formula, dim, level, contract, .. } = *self.graph.shape(shape);
        if !contract.copies || dim != Dim::Three || !place.is_of(level) {
            return Ok(None);
        }
        let (mut known, mut rest) = (Vec::new(), Vec::new());
        let (mut seen, mut pending) = (FxHashSet::default(), vec![formula]);
        while let Some(node) = pending.pop() {
            if !seen.insert(node) {
                continue;
            }
            if let Node::Binary(Binary::Min, a, b) = self.graph.node(node) {
                pending.extend([b, a]);
            } else if self.samples(node) == 0 {
                rest.push(self.expander.node(self.graph, node, &place.points())?);
            } else if let Some(copy) = self.copy(node, place, level)? {
                known.extend(copy.closed.into_iter().map(|part| part.known));
            } else {
                return Ok(None);
            }
        }
        let Some(rest) = least(self.graph, rest) else { return Ok(None) };
        let far = self.graph.number(if Rule::Copies.is_broken() { 8.0 } else { 1.0 });
        let rest = self.graph.mul(far, rest);
        let reach = Some(self.graph.mul(place.scale, rest));
        known.push(Known { spans: Vec::new(), reach });
        Ok(Some(joined(self.graph, known)).filter(Known::is_short))
    }

    /// The parts of a sample by itself, or of one that is cut by its own bounds; `None` where one is not known.
    fn copy(
        &mut self,
        node: NodeId,
        place: &Place,
        level: u16,
    ) -> Result<Option<Parts>, ExpandError> {
        let mut node = node;
        while let Node::Binary(Binary::Max, a, b) = self.graph.node(node) {
            node = match [a, b].map(|operand| self.samples(operand)) {
                [_, 0] => a,
                [0, _] => b,
                _ => return Ok(None),
            };
        }
        let Some((child, q)) = self.graph.as_sample(node) else { return Ok(None) };
        let Some(linear) = linear_between_jumps(self.graph, q, level) else { return Ok(None) };
        let stretch = similarity(self.graph, &linear);
        if stretch.and_then(|stretch| self.graph.as_number(stretch)) != Some(1.0) {
            return Ok(None);
        }
        let (points, inside) = (place.points(), usize::from(self.graph.shape(child).level));
        let own_direction = self.graph.point(level + 1, Dim::Three);
        let direction = applied(self.graph, &linear, own_direction);
        let inner = Place {
            outer: points[..inside].to_vec(),
            point: self.expander.node(self.graph, q, &points)?,
            direction: self.expander.node(self.graph, direction, &points)?,
            scale: place.scale,
        };
        let parts = self.shape(child, &inner)?;
        Ok(parts.open.is_empty().then_some(parts))
    }

    /// How many samples a node depends on.
    fn samples(&self, node: NodeId) -> usize {
        let below = reachable(self.graph, &[node]);
        below.into_iter().filter(|&node| self.graph.as_sample(node).is_some()).count()
    }
}
