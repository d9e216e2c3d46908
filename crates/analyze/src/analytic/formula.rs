//! The split of a shape's formula: the operands of a union, or the intervals of another formula.

use rustc_hash::FxHashSet;
use sdfc_graph::{Dim, ExpandError, NodeId, Shape, ShapeId};

use crate::analytic::intervals::{RayIntervals, complement, intersection, union};
use crate::analytic::operands::Operands;
use crate::analytic::split::{Formula, LocalRay, Split, Splitter};
use crate::certify::descent::{Form, form};
use crate::certify::maps::Maps;

impl Splitter<'_> {
    /// Splits the formula of a shape; `None` if it is not analytic and not a union.
    pub(super) fn split_formula(
        &mut self,
        shape: ShapeId,
        ray: &LocalRay,
    ) -> Result<Option<Split>, ExpandError> {
        let Shape { formula: root, dim, level, .. } = *self.graph.shape(shape);
        if dim != Dim::Three || !ray.has_level(level) {
            return Ok(None);
        }
        let mut formulas = vec![Formula::new(level, ray.clone())];
        let (mut operands, mut others) = (Operands::default(), Vec::new());
        let (mut seen, mut pending) = (FxHashSet::default(), vec![(0, root)]);
        // A shape that is sampled twice at one point counts once. Where unions share operands,
        // there are far more ways to an operand than operands.
        let mut sampled = FxHashSet::default();
        while let Some((place, node)) = pending.pop() {
            if !seen.insert((place, node)) {
                continue;
            }
            let Some(formula) = formulas.get_mut(place) else { continue };
            if let Form::Min(a, b) = form(self.graph, node, &mut formula.maps) {
                pending.extend([(place, b), (place, a)]);
            } else if let Some((child, ray)) = self.sample(formula, node)? {
                if !sampled.insert((child, ray.clone())) {
                    continue;
                }
                let Shape { formula: root, level, .. } = *self.graph.shape(child);
                if ray.has_level(level) && self.is_plain_union(child) {
                    pending.push((formulas.len(), root));
                    formulas.push(Formula::new(level, ray));
                } else {
                    let sample = self.shape(child, &ray)?;
                    operands.analytic.extend(sample.analytic);
                    operands.marched.extend(sample.marched);
                }
            } else if let Some(intervals) = self.intervals(formula, node, false)? {
                others.push(intervals);
            } else {
                return Ok(None);
            }
        }
        if others.is_empty() {
            return Ok(Some(Split::Operands(operands)));
        }
        others.extend(operands.analytic.into_iter().map(|operand| operand.intervals));
        Ok(operands.marched.is_empty().then(|| Split::Intervals(union(self.graph, others))))
    }

    /// True if the formula of a shape is a minimum of samples, and no clause says anything else:
    /// then its operands are operands of any union that samples it.
    fn is_plain_union(&mut self, shape: ShapeId) -> bool {
        if let Some(&known) = self.plain_unions.get(&shape) {
            return known;
        }
        let Shape { formula, dim, level, ref intersect, contract, .. } = *self.graph.shape(shape);
        let is_silent = intersect.is_empty() && !contract.copies && self.is_splittable(shape);
        let is_plain = dim == Dim::Three && is_silent && self.has_samples_only(formula, level);
        self.plain_unions.insert(shape, is_plain);
        is_plain
    }

    /// True if a formula of a level is a minimum of samples.
    fn has_samples_only(&mut self, root: NodeId, level: u16) -> bool {
        let mut maps = Maps::new(level);
        let (mut seen, mut pending) = (FxHashSet::default(), vec![root]);
        while let Some(node) = pending.pop() {
            if !seen.insert(node) {
                continue;
            }
            match form(self.graph, node, &mut maps) {
                Form::Min(a, b) => pending.extend([a, b]),
                Form::Sample(child, _) if self.graph.shape(child).level <= level => {}
                Form::Sample(..)
                | Form::ScaledSample(..)
                | Form::Max(..)
                | Form::Neg(_)
                | Form::Select(..)
                | Form::Other => return false,
            }
        }
        true
    }

    /// The intervals of a node of a formula, or of its complement; `None` if they are unknown or
    /// too many.
    fn intervals(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
        negated: bool,
    ) -> Result<Option<RayIntervals>, ExpandError> {
        if let Some(known) = formula.intervals.get(&(node, negated)) {
            return Ok(known.clone());
        }
        let intervals = stacker::maybe_grow(64 * 1024, 1024 * 1024, || {
            self.intervals_here(formula, node, negated)
        })?;
        let intervals = intervals.filter(RayIntervals::is_short);
        formula.intervals.insert((node, negated), intervals.clone());
        Ok(intervals)
    }

    fn intervals_here(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
        negated: bool,
    ) -> Result<Option<RayIntervals>, ExpandError> {
        let (a, b, is_union) = match form(self.graph, node, &mut formula.maps) {
            Form::Min(a, b) => (a, b, !negated),
            Form::Max(a, b) => (a, b, negated),
            Form::Neg(a) => return self.intervals(formula, a, !negated),
            Form::Sample(..) | Form::ScaledSample(..) => {
                let operands = self.split_sample(formula, node)?;
                let operands = operands.filter(|operands| operands.marched.is_empty());
                let Some(operands) = operands else { return Ok(None) };
                let intervals =
                    operands.analytic.into_iter().map(|operand| operand.intervals).collect();
                let intervals = union(self.graph, intervals);
                return Ok(match negated {
                    true => complement(self.graph, &intervals),
                    false => Some(intervals),
                });
            }
            Form::Select(..) | Form::Other => return Ok(None),
        };
        let Some(a) = self.intervals(formula, a, negated)? else { return Ok(None) };
        let Some(b) = self.intervals(formula, b, negated)? else { return Ok(None) };
        if !is_union {
            return Ok(intersection(self.graph, &a, &b));
        }
        Ok(Some(union(self.graph, vec![a, b])))
    }
}
