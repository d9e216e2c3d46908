//! The box where a formula does not exceed a limit, rule by rule.
//!
//! The limit travels down: `a - r` is below c where a is below `c + r`. So operators of known form
//! are exact, and only leaves and operators without a rule are searched.

use super::deriver::{Deriver, Query, RED_ZONE, STACK_STEP};
use super::zone::Zone;
use crate::blend::blend_at;
use crate::node::{Binary, Node, NodeId, ShapeId, Stage, Ternary, Unary};
use crate::shape::SidePromise;

impl Deriver<'_> {
    /// A box that contains the points where a shape's field is not above the limit.
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
        let zone = self.zone(Query { node: formula, limit, level, dim, above: false });
        let zone = self.closed(id, zone, limit);
        match contract.outer_bounds {
            Some(outer) if self.range(limit).hi() <= 0.0 => {
                let outer = Zone::between(self.graph, outer, dim.point_type().width());
                zone.overlap(self.graph, outer)
            }
            Some(_) | None => zone,
        }
    }

    /// True if a shape's field equals the distance for all values of the params. Shapes state that
    /// on condition that their children's fields do.
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

    /// A box that contains the points that a query asks for.
    pub(super) fn zone(&mut self, query: Query) -> Zone {
        if let Some(&zone) = self.memo.queries.get(&query) {
            return zone;
        }
        let zone = stacker::maybe_grow(RED_ZONE, STACK_STEP, || self.derive(query));
        self.memo.queries.insert(query, zone);
        zone
    }

    fn derive(&mut self, query: Query) -> Zone {
        let Query { node, above, .. } = query;
        if self.is_fixed(node, query) {
            return self.fixed(query);
        }
        match self.graph.node(node) {
            Node::Unary(Unary::Neg, a) => {
                let limit = self.graph.end_negated(query.limit);
                self.zone(Query { node: a, limit, above: !above, ..query })
            }
            Node::Unary(Unary::Abs, a) if !above => self.zone(Query { node: a, ..query }).loose(),
            Node::Unary(..) => self.opaque(query),
            Node::Binary(op, a, b) => self.binary(query, op, a, b),
            Node::Ternary(Ternary::Select, [condition, yes, no]) => {
                let yes = self.zone(Query { node: yes, ..query });
                let no = self.zone(Query { node: no, ..query });
                if self.graph.stage(condition) <= Stage::Frame {
                    yes.select(self.graph, condition, no)
                } else {
                    yes.hull(self.graph, no).loose()
                }
            }
            // A mixture reaches the limit only where one of its two values does.
            Node::Ternary(Ternary::Mix, [a, b, t]) if self.graph.range(t).is_fraction() => {
                let a = self.zone(Query { node: a, ..query });
                let b = self.zone(Query { node: b, ..query });
                a.hull(self.graph, b).loose()
            }
            Node::Sample(shape, at) if !above => {
                let zone = self.shape_zone(shape, query.limit);
                let rows = self.affine(at, query.level);
                let to = self.graph.shape(shape).dim;
                self.preimage(zone, &rows, query.dim, to)
            }
            Node::Sample(..) => Zone::everywhere(self.graph), // the outside of a shape is unbounded
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
            | Node::MaterialAt(..) => self.opaque(query),
        }
    }

    fn binary(&mut self, query: Query, op: Binary, a: NodeId, b: NodeId) -> Zone {
        let (fixed_a, fixed_b) = (self.is_fixed(a, query), self.is_fixed(b, query));
        let Query { limit, above, .. } = query;
        let on = |node, limit| Query { node, limit, ..query };
        if op == Binary::Min || op == Binary::Max {
            let (first, second) = (self.zone(on(a, limit)), self.zone(on(b, limit)));
            // A minimum is below the limit where either operand is, a maximum where both are.
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
            return self.zone(Query { above: !above, ..on(b, limit) });
        }
        if op == Binary::Mul && (fixed_a || fixed_b) {
            let (rest, factor) = if fixed_b { (a, b) } else { (b, a) };
            let range = self.range(factor);
            if range.lo() >= 0.0 || range.hi() <= 0.0 {
                let limit = self.graph.end_quotient(limit, factor);
                let above = above != (range.lo() < 0.0);
                return self.zone(Query { above, ..on(rest, limit) });
            }
        }
        if op == Binary::Div && fixed_b && self.range(b).lo() >= 0.0 {
            let limit = self.graph.end_product(limit, b);
            return self.zone(on(a, limit));
        }
        if !above && let Some(zone) = self.blended(query) {
            return zone;
        }
        self.opaque(query)
    }

    /// The box of a blend of finite width: where the blend is not above the limit, one of its
    /// operands exceeds the limit by at most the depth of the blend.
    ///
    /// In a chain f(f(f(a, b), c), d) these depths would add up. But where two values differ by
    /// less than the width k, a blend of depth D is at least the greater one minus max(D, k), as
    /// its correction falls at least linearly from D to 0; elsewhere it is the lesser one. So a
    /// chain of any length is at least the least operand minus max(D, k).
    fn blended(&mut self, query: Query) -> Option<Zone> {
        let blend = blend_at(self.graph, &mut self.memo.blends, query.node)?;
        let depth = blend.depth(self.graph, query.node)?;
        let chain = self.chain(query.node, blend.width, depth);
        let most = self.graph.max(depth, blend.width);
        let steps = chain.len() - 1;
        if steps as f64 * self.range(depth).hi() <= self.range(most).hi() {
            let limit = self.graph.end_sum(query.limit, depth);
            let [a, b] = blend.values.map(|node| self.zone(Query { node, limit, ..query }));
            return Some(a.hull(self.graph, b).loose());
        }
        let limit = self.graph.end_sum(query.limit, most);
        let mut hull = Zone::nowhere(self.graph);
        for node in chain {
            let zone = self.zone(Query { node, limit, ..query });
            hull = hull.hull(self.graph, zone);
        }
        Some(hull.loose())
    }

    /// The operands of a chain of blends of one width and depth, which ends with a blend: at least
    /// its two operands.
    fn chain(&mut self, end: NodeId, width: NodeId, depth: NodeId) -> Vec<NodeId> {
        let (mut operands, mut at) = (Vec::new(), end);
        while let Some(blend) = blend_at(self.graph, &mut self.memo.blends, at)
            && blend.width == width
            && blend.depth(self.graph, at) == Some(depth)
        {
            let [before, operand] = blend.ordered_values(self.graph, &mut self.memo.blends);
            operands.push(operand);
            at = before;
        }
        operands.push(at);
        operands
    }

    /// True if the node does not depend on the formula's point.
    fn is_fixed(&self, node: NodeId, query: Query) -> bool {
        self.graph.levels(node) <= query.level
    }

    fn fixed(&mut self, Query { node, limit, above, .. }: Query) -> Zone {
        let (value, limit) = (self.range(node), self.range(limit));
        let never = if above { value.hi() < limit.lo() } else { value.lo() > limit.hi() };
        if never { Zone::nowhere(self.graph) } else { Zone::everywhere(self.graph) }
    }
}
