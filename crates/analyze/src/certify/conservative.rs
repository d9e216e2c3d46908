//! The conservative field that rays march: the scene's distance, divided by Lipschitz constants.
//!
//! The pass descends from the root through hard `min` and `max`, sign changes and rigid samples,
//! and divides each operand by its own Lipschitz constant. The operands of all other operations,
//! such as blends and offsets, are expanded undivided, and their constants contribute to the
//! constant of the whole. So no division moves a surface.
//!
//! A constant that is stated with bounds, and is not known to hold beyond them, is used only within
//! the bounds. Beyond them the field is continued ([`sdfc_graph::Graph::continued`]).

use rustc_hash::FxHashMap;
use sdfc_graph::{ExpandError, Expander, Graph, NodeId, ShapeId, Stage};

use crate::certify::descent::{Form, chain_below, form};
use crate::certify::lipschitz::Slopes;
use crate::certify::quality::Qualities;
use crate::certify::reason::{Constant, Reason};

/// A part of the scene without a known Lipschitz constant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Uncertified {
    /// The shape whose formula contains it.
    pub shape: ShapeId,
    /// The reason why there is no constant.
    pub reason: Reason,
}

/// The conservative field of a scene.
#[derive(Clone, Debug)]
pub(crate) struct ConservativeField {
    /// The distance that rays step by.
    pub distance: NodeId,
    /// The parts without a constant; empty for a certified scene.
    pub uncertified: Vec<Uncertified>,
    /// The shapes that were divided by a constant above 1.
    pub divided: Vec<ShapeId>,
}

/// Expands the conservative field of `root` at `point`.
pub(crate) fn conservative_field(
    graph: &mut Graph,
    expander: &mut Expander,
    qualities: &Qualities,
    root: ShapeId,
    point: NodeId,
) -> Result<ConservativeField, ExpandError> {
    let (uncertified, divided) = (Vec::new(), Vec::new());
    let mut pass = Pass { graph, expander, qualities, uncertified, divided };
    let distance = pass.shape(root, &[], point)?;
    Ok(ConservativeField { distance, uncertified: pass.uncertified, divided: pass.divided })
}

struct Pass<'a> {
    graph: &'a mut Graph,
    expander: &'a mut Expander,
    qualities: &'a Qualities,
    uncertified: Vec<Uncertified>,
    divided: Vec<ShapeId>,
}

impl Pass<'_> {
    fn shape(
        &mut self,
        shape: ShapeId,
        outer: &[NodeId],
        point: NodeId,
    ) -> Result<NodeId, ExpandError> {
        // Depth is the scene's nesting of shapes, which elaboration limits.
        stacker::maybe_grow(64 * 1024, 1024 * 1024, || self.shape_here(shape, outer, point))
    }

    fn shape_here(
        &mut self,
        shape: ShapeId,
        outer: &[NodeId],
        point: NodeId,
    ) -> Result<NodeId, ExpandError> {
        let Some(quality) = self.qualities.get(shape) else {
            return self.expander.field_under(self.graph, shape, outer, point);
        };
        let (everywhere, local_bounds) = (quality.everywhere, quality.local_bounds);
        let constant = quality.lipschitz.clone();
        // A field that never exceeds the distance needs no constant.
        let is_bound = constant.is_err() && quality.sides.is_bound();
        if is_bound || everywhere && self.is_at_most_one(&constant) {
            return self.expander.field_under(self.graph, shape, outer, point);
        }
        let level = usize::from(self.graph.shape(shape).level).min(outer.len());
        let mut points = outer[..level].to_vec();
        points.push(point);
        let contract = self.graph.shape(shape).contract;
        if constant.is_ok() && contract.lipschitz.is_some() && !everywhere {
            // A stated constant assumes that the constants of the children hold wherever the
            // formula samples them.
            self.check_children(shape, self.graph.shape(shape).formula);
        }
        let bounds = local_bounds.or(contract.lipschitz.and(contract.bounds));
        let value = match (constant, contract.lipschitz, bounds) {
            (Ok(constant), _, Some(bounds)) if !everywhere => {
                self.continued(shape, constant, bounds, &points)?
            }
            (constant, Some(_), _) => {
                let formula = self.graph.shape(shape).formula;
                self.divided_by(shape, formula, constant, &points)?
            }
            (_, None, _) => {
                let formula = self.graph.shape(shape).formula;
                let mut slopes = self.qualities.slopes(self.graph, shape);
                self.descend(shape, formula, &mut slopes, &points)?
            }
        };
        self.expander.name(self.graph, value, shape);
        Ok(value)
    }

    /// Expands a node of a shape's formula and divides it by a constant.
    fn divided_by(
        &mut self,
        shape: ShapeId,
        node: NodeId,
        constant: Constant,
        points: &[NodeId],
    ) -> Result<NodeId, ExpandError> {
        let value = self.expander.node(self.graph, node, points)?;
        match constant {
            Ok(constant) => {
                let constant = self.expander.node(self.graph, constant, points)?;
                Ok(self.quotient(shape, value, constant))
            }
            Err(reason) => {
                self.uncertified.push(Uncertified { shape, reason });
                Ok(value)
            }
        }
    }

    fn is_at_most_one(&self, constant: &Constant) -> bool {
        constant.as_ref().is_ok_and(|&l| self.graph.as_number(l).is_some_and(|l| l <= 1.0))
    }

    /// Expands a formula and divides its operands of hard minima and maxima one by one.
    fn descend(
        &mut self,
        shape: ShapeId,
        formula: NodeId,
        slopes: &mut Slopes,
        points: &[NodeId],
    ) -> Result<NodeId, ExpandError> {
        let mut built: FxHashMap<NodeId, NodeId> = FxHashMap::default();
        for node in chain_below(self.graph, formula, &mut slopes.maps) {
            let of = |id: NodeId| built.get(&id).copied().unwrap_or(id);
            let value = match form(self.graph, node, &mut slopes.maps) {
                Form::Other => self.divided_operand(shape, node, slopes, points)?,
                Form::Min(a, b) => self.graph.min(of(a), of(b)),
                Form::Max(a, b) => self.graph.max(of(a), of(b)),
                Form::Neg(a) => self.graph.neg(of(a)),
                Form::Select(condition, a, b) => {
                    let condition = self.expander.node(self.graph, condition, points)?;
                    self.graph.select(condition, of(a), of(b))
                }
                Form::Sample(child, q) => {
                    let q = self.expander.node(self.graph, q, points)?;
                    self.shape(child, points, q)?
                }
                Form::ScaledSample(factor, child, q) => {
                    let factor = self.expander.node(self.graph, factor, points)?;
                    let q = self.expander.node(self.graph, q, points)?;
                    let inner = self.shape(child, points, q)?;
                    self.graph.mul(factor, inner)
                }
            };
            built.insert(node, value);
        }
        match built.get(&formula) {
            Some(&value) => Ok(value),
            None => self.expander.node(self.graph, formula, points),
        }
    }

    /// Expands an operand of the descent and divides it by its own constant.
    fn divided_operand(
        &mut self,
        shape: ShapeId,
        node: NodeId,
        slopes: &Slopes,
        points: &[NodeId],
    ) -> Result<NodeId, ExpandError> {
        if self.graph.stage(node) < Stage::Point {
            return self.expander.node(self.graph, node, points);
        }
        self.check_children(shape, node);
        self.divided_by(shape, node, slopes.constant(node), points)
    }

    /// `value / max(constant, 1)`.
    fn quotient(&mut self, shape: ShapeId, value: NodeId, constant: NodeId) -> NodeId {
        let one = self.graph.number(1.0);
        let constant = self.graph.max(constant, one);
        if constant != one {
            self.divided.push(shape);
        }
        self.graph.div(value, constant)
    }

    /// Reports the shape if `node` samples a child whose constant holds only within bounds.
    fn check_children(&mut self, shape: ShapeId, node: NodeId) {
        if let Some(child) = self.child_within_bounds(node) {
            let name = self.graph.shape(child).definition.clone();
            self.uncertified.push(Uncertified { shape, reason: Reason::Within(name) });
        }
    }

    /// The first child below `node` whose constant holds only within its bounds.
    fn child_within_bounds(&self, node: NodeId) -> Option<ShapeId> {
        sdfc_graph::reachable(self.graph, &[node]).into_iter().find_map(|id| {
            let (child, _) = self.graph.as_sample(id)?;
            let quality = self.qualities.get(child)?;
            (!quality.everywhere && quality.lipschitz.is_ok()).then_some(child)
        })
    }

    /// Divides a formula by a constant that holds within bounds, and continues the field beyond
    /// them.
    fn continued(
        &mut self,
        shape: ShapeId,
        constant: NodeId,
        bounds: [NodeId; 2],
        points: &[NodeId],
    ) -> Result<NodeId, ExpandError> {
        let formula = self.graph.shape(shape).formula;
        let Some((&point, outer)) = points.split_last() else {
            return self.expander.node(self.graph, formula, points);
        };
        let constant = self.expander.node(self.graph, constant, points)?;
        let [lo, hi] = bounds;
        let lo = self.expander.node(self.graph, lo, points)?;
        let hi = self.expander.node(self.graph, hi, points)?;
        let nearest = self.graph.nearest_within(point, [lo, hi]);
        let mut inner_points = outer.to_vec();
        inner_points.push(nearest);
        let value = self.expander.node(self.graph, formula, &inner_points)?;
        let inside = self.quotient(shape, value, constant);
        let one = self.graph.number(1.0);
        Ok(self.graph.lipschitz_extension(point, nearest, inside, one))
    }
}
