//! Where a formula does not exceed a level, rule by rule.
//!
//! The level travels down: what of `a - r` lies below c is what of a lies below `c + r`. So operators of
//! known form are exact, and only leaves and operators without a rule are searched.

use super::Deriver;
use super::zone::Zone;
use crate::{Binary, Dim, Node, NodeId, ShapeId, SidePromise, Stage, Ternary, Unary, blend_at};

/// What is asked of a formula. Equal questions have equal answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Question {
    /// A scalar.
    pub(super) node: NodeId,
    /// A scalar that no point of the formula changes.
    pub(super) limit: NodeId,
    /// Level of the formula's point.
    pub(super) level: u16,
    /// Dimension of the formula's point.
    pub(super) dim: Dim,
    /// Asks for the points where the node is not below the limit instead of not above.
    pub(super) above: bool,
}

/// Room for one step of the recursion, and what the stack grows by where there is less.
pub(super) const RED_ZONE: usize = 128 * 1024;
pub(super) const STACK_STEP: usize = 4 * 1024 * 1024;

impl Deriver<'_> {
    /// A box that holds the points where a shape's field is not above the limit.
    pub(super) fn shape_zone(&mut self, shape: ShapeId, limit: NodeId) -> Zone {
        if let Some(&zone) = self.memo.shapes.get(&(shape, limit)) {
            return zone;
        }
        let zone = stacker::maybe_grow(RED_ZONE, STACK_STEP, || self.derive_shape(shape, limit));
        self.memo.shapes.insert((shape, limit), zone);
        zone
    }

    fn derive_shape(&mut self, id: ShapeId, limit: NodeId) -> Zone {
        let shape = self.graph.shape(id);
        let (dim, level, formula) = (shape.dim, shape.level, shape.formula);
        let (contract, children) = (shape.contract, shape.children.clone());
        if let Some(stated) = contract.bounds {
            let zone = Zone::between(self.graph, stated, dim.point_type().width());
            if self.range(limit).hi() <= 0.0 {
                return zone;
            }
            let is_exact = contract.outside.exact.is_some_and(|holds| self.is_true(holds));
            if is_exact && children.into_iter().all(|child| self.is_exact(child)) {
                return zone.grown(self.graph, limit);
            }
        }
        self.zone(Question { node: formula, limit, level, dim, above: false })
    }

    /// Whether a shape's field is the distance for all values of the params, as it states given that its children's are.
    fn is_exact(&mut self, id: ShapeId) -> bool {
        if let Some(&known) = self.memo.exact.get(&id) {
            return known;
        }
        let shape = self.graph.shape(id);
        let (contract, children) = (shape.contract, shape.children.clone());
        let sides = [contract.outside, contract.inside];
        let states = |side: SidePromise| side.exact.is_some_and(|holds| self.is_true(holds));
        let is_exact = sides.into_iter().all(states)
            && stacker::maybe_grow(RED_ZONE, STACK_STEP, || {
                children.into_iter().all(|child| self.is_exact(child))
            });
        self.memo.exact.insert(id, is_exact);
        is_exact
    }

    /// A box that holds the points that a question asks for.
    pub(super) fn zone(&mut self, question: Question) -> Zone {
        if let Some(&zone) = self.memo.questions.get(&question) {
            return zone;
        }
        let zone = stacker::maybe_grow(RED_ZONE, STACK_STEP, || self.derive(question));
        self.memo.questions.insert(question, zone);
        zone
    }

    fn derive(&mut self, question: Question) -> Zone {
        let Question { node, above, .. } = question;
        if self.is_fixed(node, question) {
            return self.fixed(question);
        }
        match self.graph.node(node) {
            Node::Unary(Unary::Neg, a) => {
                let limit = self.graph.end_negated(question.limit);
                self.zone(Question { node: a, limit, above: !above, ..question })
            }
            Node::Unary(Unary::Abs, a) if !above => {
                self.zone(Question { node: a, ..question }).loose()
            }
            Node::Unary(..) => self.opaque(question),
            Node::Binary(op, a, b) => self.binary(question, op, a, b),
            Node::Ternary(Ternary::Select, [condition, yes, no]) => {
                let yes = self.zone(Question { node: yes, ..question });
                let no = self.zone(Question { node: no, ..question });
                if self.graph.stage(condition) <= Stage::Frame {
                    yes.select(self.graph, condition, no)
                } else {
                    yes.hull(self.graph, no).loose()
                }
            }
            Node::Sample(shape, at) if !above => {
                let zone = self.shape_zone(shape, question.limit);
                let rows = self.affine(at, question.level);
                let to = self.graph.shape(shape).dim;
                self.preimage(zone, &rows, question.dim, to)
            }
            Node::Sample(..) => Zone::everywhere(self.graph), // the outside of a shape has no bounds
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::MaterialAt(..) => self.opaque(question),
        }
    }

    fn binary(&mut self, question: Question, op: Binary, a: NodeId, b: NodeId) -> Zone {
        let (fixed_a, fixed_b) = (self.is_fixed(a, question), self.is_fixed(b, question));
        let Question { limit, above, .. } = question;
        let on = |node, limit| Question { node, limit, ..question };
        if op == Binary::Min || op == Binary::Max {
            let (first, second) = (self.zone(on(a, limit)), self.zone(on(b, limit)));
            // A minimum is below the limit where either is, a maximum where both are.
            return if (op == Binary::Min) == above {
                first.overlap(self.graph, second)
            } else {
                first.hull(self.graph, second)
            };
        }
        if op == Binary::Add && (fixed_a || fixed_b) {
            let (rest, constant) = if fixed_b { (a, b) } else { (b, a) };
            let limit = self.graph.end_difference(limit, constant);
            return self.zone(on(rest, limit));
        }
        if op == Binary::Sub && fixed_b {
            let limit = self.graph.end_sum(limit, b);
            return self.zone(on(a, limit));
        }
        if op == Binary::Sub && fixed_a {
            let limit = self.graph.end_difference(a, limit);
            return self.zone(Question { above: !above, ..on(b, limit) });
        }
        if op == Binary::Mul && (fixed_a || fixed_b) {
            let (rest, factor) = if fixed_b { (a, b) } else { (b, a) };
            let range = self.range(factor);
            if range.lo() >= 0.0 || range.hi() <= 0.0 {
                let limit = self.graph.end_quotient(limit, factor);
                let above = above != (range.lo() < 0.0);
                return self.zone(Question { above, ..on(rest, limit) });
            }
        }
        if op == Binary::Div && fixed_b && self.range(b).lo() >= 0.0 {
            let limit = self.graph.end_product(limit, b);
            return self.zone(on(a, limit));
        }
        if !above && let Some(zone) = self.blended(question) {
            return zone;
        }
        self.opaque(question)
    }

    /// Where a blend that ends is not above the limit, either of its values is not above it by more than the blend is deep.
    fn blended(&mut self, question: Question) -> Option<Zone> {
        let blend = blend_at(self.graph, &mut self.memo.blends, question.node)?;
        let depth = blend.depth(self.graph, question.node)?;
        let limit = self.graph.end_sum(question.limit, depth);
        let [a, b] = blend.values.map(|node| self.zone(Question { node, limit, ..question }));
        Some(a.hull(self.graph, b).loose())
    }

    /// Whether no point of the formula changes the node.
    fn is_fixed(&self, node: NodeId, question: Question) -> bool {
        self.graph.levels(node) <= question.level
    }

    fn fixed(&mut self, Question { node, limit, above, .. }: Question) -> Zone {
        let (value, limit) = (self.range(node), self.range(limit));
        let never = if above { value.hi() < limit.lo() } else { value.lo() > limit.hi() };
        if never { Zone::nowhere(self.graph) } else { Zone::everywhere(self.graph) }
    }
}
