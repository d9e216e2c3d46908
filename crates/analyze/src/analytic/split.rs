//! The split of a scene into analytic and marched operands.
//!
//! The pass descends from the root through hard minima and maxima, sign changes and rigid or scaled
//! samples, and transforms the ray by the same maps as the point. A shape with the clause
//! `intersect` states the intervals in which the ray is inside it. The operands of a union are
//! split into those with known intervals, which are analytic, and the others, which are marched.
//! Intersections and complements are analytic if all of their operands are, and if they have few
//! intervals.
//!
//! A blend with a floor is split in `blends.rs`.
//!
//! A point samples only few of infinitely many copies. Their intervals are known only up to the
//! distance of the copies that are not sampled (`repetition.rs`). So operands that contain them are
//! marched, but use those intervals near the ray's origin.

use rustc_hash::FxHashMap;
use sdfc_graph::{
    Blends, Bounds, Contract, Dim, ExpandError, Expander, Graph, NodeId, Shape, ShapeId,
    SidePromise,
};

use crate::analytic::intervals::{RayIntervals, scaled};
use crate::analytic::operands::{AnalyticOperand, MarchedOperand, Operands};
use crate::certify::conservative::conservative_field;
use crate::certify::descent::{Form, form};
use crate::certify::maps::Maps;
use crate::certify::quality::Qualities;

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
    let (blends, plain_unions) = (Blends::default(), FxHashMap::default());
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
pub(super) enum Split {
    /// The operands of a union.
    Operands(Operands),
    /// The intervals of another formula.
    Intervals(RayIntervals),
}

/// A formula in its own point, and the ray in its coordinates.
pub(super) struct Formula {
    pub(super) maps: Maps,
    pub(super) ray: LocalRay,
    /// The intervals of a node, or of its complement if the flag is set; `None` if they are
    /// unknown.
    pub(super) intervals: FxHashMap<(NodeId, bool), Option<RayIntervals>>,
}

impl Formula {
    pub(super) fn new(level: u16, ray: LocalRay) -> Self {
        Self { maps: Maps::new(level), ray, intervals: FxHashMap::default() }
    }
}

/// The pass and what it builds on.
pub(super) struct Splitter<'a> {
    pub(super) graph: &'a mut Graph,
    pub(super) expander: &'a mut Expander,
    qualities: &'a Qualities,
    pub(super) bounds: &'a mut Bounds,
    pub(super) blends: Blends,
    /// Shapes whose formulas are minima of samples and nothing else.
    pub(super) plain_unions: FxHashMap<ShapeId, bool>,
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
                let marched = vec![MarchedOperand {
                    shape,
                    value,
                    limit: None,
                    local: None,
                    bounding,
                    point,
                    scale,
                }];
                Ok(Operands { analytic, marched })
            }
        }
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
    pub(super) fn is_splittable(&self, shape: ShapeId) -> bool {
        let Contract { outside, inside, lipschitz, .. } = self.graph.shape(shape).contract;
        [outside, inside] == [SidePromise::default(); 2] && lipschitz.is_none()
    }

    /// The operands of a node that samples a child at a rigid map of the point, or of a scaled
    /// sample; `None` for any other node.
    pub(super) fn split_sample(
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
    pub(super) fn sample(
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
