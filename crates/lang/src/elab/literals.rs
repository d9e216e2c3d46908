//! Records how formulas use params that stand for literals, see [`LiteralUses`].
//!
//! [`LiteralUses`]: super::literal_uses::LiteralUses

use sdfc_graph::{Node, NodeId};

use super::elaborator::Elaborator;

impl Elaborator<'_> {
    /// Records that a value decides what is built: the literals in it must stay constant.
    pub(super) fn must_stay_constant(&mut self, node: NodeId) {
        let literals = self.literals_in(node);
        self.literals.fixed.extend(literals);
    }

    /// Records that a requirement or a promise constrains a value.
    pub(super) fn constrains(&mut self, node: NodeId) {
        let literals = self.literals_in(node);
        self.literals.constrained.extend(literals);
    }

    fn literals_in(&self, node: NodeId) -> Vec<usize> {
        if self.params.len() <= self.literals.first {
            return Vec::new();
        }
        self.inputs(node).into_iter().filter_map(|input| self.literals.literal(input)).collect()
    }

    /// Records that a value must lie within a range. A literal that is the whole value gets the
    /// range. A literal inside a formula would need the inverse of the formula: it stays constant.
    pub(super) fn lies_within(&mut self, value: NodeId, [lo, hi]: [NodeId; 2]) {
        if self.params.len() <= self.literals.first {
            return;
        }
        for lane in 0..self.graph.ty(value).width() as u8 {
            let [value, lo, hi] = [value, lo, hi].map(|node| self.graph.component(node, lane));
            let ends = self.graph.as_number(lo).zip(self.graph.as_number(hi));
            let literal = if let Node::Frame(input, _) = self.graph.node(value) {
                self.literals.literal(input)
            } else {
                None
            };
            match (literal, ends) {
                (Some(literal), Some((lo, hi))) => {
                    let unlimited = [f64::NEG_INFINITY, f64::INFINITY];
                    let [low, high] = self.literals.ranges.entry(literal).or_insert(unlimited);
                    (*low, *high) = (low.max(lo), high.min(hi));
                }
                _ => [value, lo, hi].into_iter().for_each(|node| self.constrains(node)),
            }
        }
    }
}
