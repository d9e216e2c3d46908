//! Guarded operands, which are evaluated in a branch.

use rustc_hash::FxHashSet;
use sdfc_graph::{Graph, Node, NodeId, guarded_value};

use super::body::Value;
use super::inputs::Inputs;
use super::lowering::{Branches, Lowering};
use super::types;
use super::uses::reads;
use crate::error::Error;

impl Lowering<'_> {
    /// Splits ascending nodes into those that only the operand of a guarded value needs, and all
    /// others.
    pub(super) fn without_guarded(
        &self,
        roots: &[NodeId],
        nodes: &[NodeId],
    ) -> (Branches, Vec<NodeId>) {
        let graph = &self.program.graph;
        let mut branches = Branches::default();
        let mut inside: FxHashSet<NodeId> = FxHashSet::default();
        // A later value may have an earlier one in its branch.
        for &id in nodes.iter().rev() {
            let Some(value) = guarded_value(graph, id, &self.program.guards) else { continue };
            if inside.contains(&id) || self.inputs.is_slot(id) {
                continue;
            }
            let private = private_nodes(graph, roots, nodes, value.with_operand, self.inputs);
            // The first of the loops that run listed iterations finds the lists for all of them.
            if private.is_empty() || private.iter().any(|&id| self.is_listed(id)) {
                continue;
            }
            inside.extend(&private);
            branches.insert(id, private);
        }
        let outside = nodes.iter().copied().filter(|id| !inside.contains(id)).collect();
        (branches, outside)
    }

    fn is_listed(&self, id: NodeId) -> bool {
        let Node::Loop(looped, ..) = self.program.graph.node(id) else { return false };
        let skip = self.program.graph.loop_at(looped).skip;
        self.inputs.active_lists.as_ref().is_some_and(|lists| lists.index_of(skip).is_some())
    }

    /// Writes a guarded value: a variable that the branch changes.
    pub(super) fn guarded(&mut self, id: NodeId, within: &[NodeId]) -> Result<Value, Error> {
        let graph = &self.program.graph;
        let guarded = guarded_value(graph, id, &self.program.guards).ok_or(Error::NotFlat(id))?;
        let ty = types::value(self.types, graph.ty(id));
        let variable = self.body.variable("least", ty);
        let (condition, without) = (self.value(guarded.condition)?, self.value(guarded.without)?);
        self.body.store(variable, without);
        self.body.open_block();
        let matrices = self.matrices.clone();
        self.visit(&[guarded.with_operand], within)?;
        let with_operand = self.value(guarded.with_operand)?;
        self.body.store(variable, with_operand);
        self.body.close_branch(condition);
        self.matrices = matrices;
        self.forget(within.iter());
        Ok(self.body.load(variable, "s"))
    }
}

/// The nodes that are read for `root` alone, and `root` itself, if it is read once; all nodes are
/// ascending.
fn private_nodes(
    graph: &Graph,
    roots: &[NodeId],
    nodes: &[NodeId],
    root: NodeId,
    inputs: &Inputs,
) -> Vec<NodeId> {
    let mut shared: FxHashSet<NodeId> = roots.iter().copied().collect();
    let mut read: FxHashSet<NodeId> = FxHashSet::default();
    let (mut private, mut readers) = (Vec::new(), 0);
    // Readers have greater ids, so all readers of a node come before it here.
    for &id in nodes.iter().rev() {
        let is_private = id == root || (read.contains(&id) && !shared.contains(&id));
        if is_private {
            private.push(id);
        }
        for operand in reads(graph, id, inputs) {
            readers += usize::from(operand == root);
            if is_private { &mut read } else { &mut shared }.insert(operand);
        }
    }
    private.reverse();
    if readers == 1 { private } else { Vec::new() }
}
