//! The split of a scene into analytic and marched operands.
//!
//! The pass descends from the root through hard minima and maxima, sign changes and rigid or scaled
//! samples, and transforms the ray by the same maps as the point. A shape with the clause
//! `intersect` states the intervals in which the ray is inside it. The operands of a union are
//! split into those with known intervals, which are analytic, and the others, which are marched.
//! Intersections and complements are analytic if all of their operands are, and if they have few
//! intervals.
//!
//! A floor in a smooth blend is just a floor where all other operands are farther away than the
//! width of the blend. So an unbounded operand of a blend is intersected analytically there, and
//! the blend as a whole is marched around the other operands.
//!
//! A point samples only few of infinitely many copies. Their intervals are known only up to the
//! distance of the copies that are not sampled (`repetition.rs`). So operands that contain them are
//! marched, but use those intervals near the ray's origin.

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::{
    Blends, Bounds, Contract, Dim, ExpandError, Expander, Graph, NodeId, Shape, ShapeId,
    SidePromise, blend_at,
};

use crate::analytic::intervals::{RayIntervals, complement, intersection, scaled, union};
use crate::analytic::operands::{AnalyticOperand, MarchedOperand, Operands};
use crate::certify::conservative::conservative_field;
use crate::certify::descent::{Form, form};
use crate::certify::maps::Maps;
use crate::certify::quality::Qualities;
use crate::shapes::{is_bounded, minimum, unnamed_shape};

/// Splits the scene `root`, sampled at `point`, into analytic and marched operands. The point of
/// level 0 is the origin of rays, the point of level 1 is their direction.
pub(crate) fn split_analytic(
    graph: &mut Graph,
    expander: &mut Expander,
    qualities: &Qualities,
    bounds: &mut Bounds,
    root: ShapeId,
    point: NodeId,
) -> Result<Operands, ExpandError> {
    let direction = graph.point(1, Dim::Three);
    let scale = graph.number(1.0);
    let (blends, plain_unions) = Default::default();
    let mut splitter = Splitter { graph, expander, qualities, bounds, blends, plain_unions };
    let ray = LocalRay { outer: Vec::new(), point, direction, scale };
    splitter.shape(root, &ray).map(Operands::with_local_marched)
}

/// The ray in the coordinates of a shape. Lengths along it are multiplied by `scale` to get lengths
/// in the scene.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct LocalRay {
    /// The points of the enclosing formulas, all at the ray's origin. Only shapes whose arguments
    /// depend on them have any.
    pub(super) outer: Vec<NodeId>,
    pub(super) point: NodeId,
    pub(super) direction: NodeId,
    pub(super) scale: NodeId,
}

impl LocalRay {
    /// The values of the points of a formula: enclosing points, origin, direction.
    pub(super) fn points(&self) -> Vec<NodeId> {
        [&self.outer[..], &[self.point, self.direction]].concat()
    }

    /// True if a shape of that level has these enclosing points.
    pub(super) fn has_level(&self, level: u16) -> bool {
        usize::from(level) == self.outer.len()
    }
}

/// The result of splitting a formula.
enum Split {
    /// The operands of a union.
    Operands(Operands),
    /// The intervals of another formula.
    Intervals(RayIntervals),
}

/// A formula in its own point, and the ray in its coordinates.
struct Formula {
    maps: Maps,
    ray: LocalRay,
    /// The intervals of a node, or of its complement if the flag is set; `None` if they are
    /// unknown.
    intervals: FxHashMap<(NodeId, bool), Option<RayIntervals>>,
}

impl Formula {
    fn new(level: u16, ray: LocalRay) -> Self {
        Self { maps: Maps::new(level), ray, intervals: FxHashMap::default() }
    }
}

/// The pass and what it builds on.
pub(super) struct Splitter<'a> {
    pub(super) graph: &'a mut Graph,
    pub(super) expander: &'a mut Expander,
    qualities: &'a Qualities,
    bounds: &'a mut Bounds,
    blends: Blends,
    /// Shapes whose formulas are minima of samples and nothing else.
    plain_unions: FxHashMap<ShapeId, bool>,
}

impl Splitter<'_> {
    /// Splits a shape at a ray.
    pub(super) fn shape(
        &mut self,
        shape: ShapeId,
        ray: &LocalRay,
    ) -> Result<Operands, ExpandError> {
        // Depth is the scene's nesting of shapes, which elaboration limits.
        stacker::maybe_grow(64 * 1024, 1024 * 1024, || self.shape_here(shape, ray))
    }

    fn shape_here(&mut self, shape: ShapeId, ray: &LocalRay) -> Result<Operands, ExpandError> {
        if let Some(intervals) = self.stated_intervals(shape, ray)? {
            return self.analytic(shape, ray, intervals);
        }
        if let Some(intervals) = self.repetition(shape, ray)? {
            return self.analytic(shape, ray, intervals);
        }
        match self.split_formula(shape, ray)? {
            Some(Split::Intervals(intervals)) => self.analytic(shape, ray, intervals),
            Some(Split::Operands(operands))
                if operands.marched.is_empty() || self.is_splittable(shape) =>
            {
                Ok(operands)
            }
            Some(Split::Operands(_)) | None => {
                let value = self.field(shape, ray)?;
                let LocalRay { point, scale, .. } = *ray;
                let (analytic, bounding) =
                    self.split_blend(shape, ray)?.unwrap_or((Vec::new(), shape));
                let marched =
                    vec![MarchedOperand { shape, value, local: None, bounding, point, scale }];
                Ok(Operands { analytic, marched })
            }
        }
    }

    /// Splits a chain of blends that has one unbounded analytic operand. Returns that operand, and
    /// a shape outside of which the blend equals the operand.
    fn split_blend(
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

    /// A shape with known intervals as one analytic operand.
    fn analytic(
        &mut self,
        shape: ShapeId,
        ray: &LocalRay,
        intervals: RayIntervals,
    ) -> Result<Operands, ExpandError> {
        let value = self.field(shape, ray)?;
        let LocalRay { point, scale, .. } = *ray;
        let analytic = vec![AnalyticOperand { shape, value, intervals, point, scale }];
        Ok(Operands { analytic, marched: Vec::new() })
    }

    /// The conservative field at the sample point. It is never used for shapes whose arguments
    /// depend on enclosing points; a placeholder is returned for those.
    fn field(&mut self, shape: ShapeId, ray: &LocalRay) -> Result<NodeId, ExpandError> {
        if !ray.outer.is_empty() {
            return Ok(ray.scale);
        }
        let field =
            conservative_field(self.graph, self.expander, self.qualities, shape, ray.point)?;
        Ok(self.graph.mul(ray.scale, field.distance))
    }

    /// The intervals that the clause `intersect` of a shape states.
    fn stated_intervals(
        &mut self,
        shape: ShapeId,
        ray: &LocalRay,
    ) -> Result<Option<RayIntervals>, ExpandError> {
        let Shape { intersect: stated, level, .. } = self.graph.shape(shape);
        if stated.is_empty() || !ray.has_level(*level) {
            return Ok(None);
        }
        let (stated, points) = (stated.clone(), ray.points());
        let mut list = Vec::with_capacity(stated.len());
        for [enter, exit] in stated {
            let enter = self.expander.node(self.graph, enter, &points)?;
            let exit = self.expander.node(self.graph, exit, &points)?;
            list.push([enter, exit]);
        }
        let list = scaled(self.graph, &list, ray.scale);
        Ok(Some(RayIntervals { list, reach: None }))
    }

    /// True if the operands of a union may be treated separately: no clause makes a statement about
    /// the union as a whole.
    fn is_splittable(&self, shape: ShapeId) -> bool {
        let Contract { outside, inside, lipschitz, .. } = self.graph.shape(shape).contract;
        [outside, inside] == [SidePromise::default(); 2] && lipschitz.is_none()
    }

    /// Splits the formula of a shape; `None` if it is not analytic and not a union.
    fn split_formula(
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

    /// The operands of a node that samples a child at a rigid map of the point, or of a scaled
    /// sample; `None` for any other node.
    fn split_sample(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
    ) -> Result<Option<Operands>, ExpandError> {
        match self.sample(formula, node)? {
            Some((child, ray)) => self.shape(child, &ray).map(Some),
            None => Ok(None),
        }
    }

    /// The child that a node samples at a rigid map of the point, scaled or not, and the ray in the
    /// child's coordinates; `None` for any other node.
    fn sample(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
    ) -> Result<Option<(ShapeId, LocalRay)>, ExpandError> {
        let Formula { maps, ray, .. } = formula;
        let (child, q, factor) = match form(self.graph, node, maps) {
            Form::Sample(child, q) => (child, q, None),
            Form::ScaledSample(factor, child, q) if self.graph.range(factor).lo > 0.0 => {
                (child, q, Some(factor))
            }
            Form::ScaledSample(..)
            | Form::Min(..)
            | Form::Max(..)
            | Form::Neg(_)
            | Form::Select(..)
            | Form::Other => return Ok(None),
        };
        // The arguments of a child with a higher level depend on this formula's point.
        let level = usize::from(self.graph.shape(child).level);
        if level > ray.outer.len() {
            return Ok(None);
        }
        let own_direction = self.graph.point(maps.level() + 1, Dim::Three);
        let direction = maps.direction(self.graph, q, own_direction);
        let points = ray.points();
        let mut inner = LocalRay {
            outer: ray.outer[..level].to_vec(),
            point: self.expander.node(self.graph, q, &points)?,
            direction: self.expander.node(self.graph, direction, &points)?,
            scale: ray.scale,
        };
        if let Some(factor) = factor {
            let factor = self.expander.node(self.graph, factor, &points)?;
            inner.direction = self.graph.mul(inner.direction, factor);
            inner.scale = self.graph.mul(ray.scale, factor);
        }
        Ok(Some((child, inner)))
    }
}
