//! Literals that stand as params while a scene is elaborated, and what is found out about them.

use std::collections::{BTreeMap, BTreeSet};

use sdfc_graph::{FrameInput, Node, NodeId};

use super::Elaborator;

/// What elaboration finds out about params that stand for literals.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Offer {
    /// Params from this position on stand for literals.
    first: usize,
    /// Those that decide what is built: a branch, a length, a count, an index.
    pub decisive: BTreeSet<usize>,
    /// Those that a requirement, a promise or a range speaks of in a formula. What it speaks of may be
    /// another value once nothing above moves.
    pub bound: BTreeSet<usize>,
    /// What parameters' ranges leave of the values of others.
    pub ranges: BTreeMap<usize, [f64; 2]>,
}

impl Offer {
    /// Params from this position on stand for literals.
    pub(crate) fn new(first: usize) -> Self {
        Self { first, decisive: BTreeSet::new(), bound: BTreeSet::new(), ranges: BTreeMap::new() }
    }

    fn literal(&self, input: FrameInput) -> Option<usize> {
        match input {
            FrameInput::Param(index) => Some(index as usize).filter(|index| *index >= self.first),
            FrameInput::Time | FrameInput::Frame => None,
        }
    }
}

impl Elaborator<'_> {
    /// Notes that a value decides what is built, so that no literal in it may move.
    pub(super) fn decides(&mut self, node: NodeId) {
        let literals = self.literals(node);
        self.offer.decisive.extend(literals);
    }

    /// Notes that a requirement or a promise speaks of a value.
    pub(super) fn binds(&mut self, node: NodeId) {
        let literals = self.literals(node);
        self.offer.bound.extend(literals);
    }

    fn literals(&self, node: NodeId) -> Vec<usize> {
        if self.params.len() <= self.offer.first {
            return Vec::new();
        }
        self.inputs(node).into_iter().filter_map(|input| self.offer.literal(input)).collect()
    }

    /// Notes that a value must lie in a range. A literal that is the whole value gets the range; one in
    /// a formula would need the formula's inverse, and does not move.
    pub(super) fn lies_in(&mut self, value: NodeId, [lo, hi]: [NodeId; 2]) {
        if self.params.len() <= self.offer.first {
            return;
        }
        for lane in 0..self.graph.ty(value).width() as u8 {
            let [value, lo, hi] = [value, lo, hi].map(|node| self.graph.component(node, lane));
            let ends = self.graph.as_number(lo).zip(self.graph.as_number(hi));
            let literal = if let Node::Frame(input, _) = self.graph.node(value) {
                self.offer.literal(input)
            } else {
                None
            };
            match (literal, ends) {
                (Some(literal), Some((lo, hi))) => {
                    let unlimited = [f64::NEG_INFINITY, f64::INFINITY];
                    let [low, high] = self.offer.ranges.entry(literal).or_insert(unlimited);
                    (*low, *high) = (low.max(lo), high.min(hi));
                }
                _ => [value, lo, hi].into_iter().for_each(|node| self.binds(node)),
            }
        }
    }
}
