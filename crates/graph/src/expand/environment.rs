//! Environments: interned lists of points by level. Equal lists have equal handles.

use rustc_hash::FxHashMap;

use crate::graph::Graph;
use crate::node::NodeId;

/// A handle to a list of points, outermost first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Env(u32);

#[derive(Clone, Copy, Debug)]
struct Entry {
    outer: Env,
    point: NodeId,
    depth: u16,
    loops: u8,
}

/// All lists in use. Each extends another list by one point.
#[derive(Clone, Debug, Default)]
pub(super) struct Environments {
    entries: Vec<Entry>,
    known: FxHashMap<(Env, NodeId), Env>,
}

/// The empty list; entry i has handle i + 1.
const EMPTY: Env = Env(0);

impl Environments {
    fn entry(&self, env: Env) -> Option<Entry> {
        self.entries.get((env.0 as usize).checked_sub(1)?).copied()
    }

    pub(super) fn depth(&self, env: Env) -> u16 {
        self.entry(env).map_or(0, |entry| entry.depth)
    }

    /// The number of loops around formulas that see these points: their loops are nested in those
    /// that the points depend on.
    pub(super) fn loops(&self, env: Env) -> u8 {
        self.entry(env).map_or(0, |entry| entry.loops)
    }

    pub(super) fn of(&mut self, graph: &Graph, points: &[NodeId]) -> Env {
        points.iter().fold(EMPTY, |outer, &point| self.push(graph, outer, point))
    }

    pub(super) fn push(&mut self, graph: &Graph, outer: Env, point: NodeId) -> Env {
        if let Some(&env) = self.known.get(&(outer, point)) {
            return env;
        }
        let depth = self.depth(outer).saturating_add(1);
        let loops = self.loops(outer).max(graph.next_loop_depth(point));
        self.entries.push(Entry { outer, point, depth, loops });
        let env = Env(self.entries.len() as u32);
        self.known.insert((outer, point), env);
        env
    }

    /// The list's first `depth` points, or all if it has fewer.
    pub(super) fn prefix(&self, mut env: Env, depth: u16) -> Env {
        while let Some(entry) = self.entry(env).filter(|entry| entry.depth > depth) {
            env = entry.outer;
        }
        env
    }

    /// The point of a level.
    pub(super) fn point(&self, env: Env, level: u16) -> Option<NodeId> {
        let entry = self.entry(self.prefix(env, level.saturating_add(1)))?;
        (entry.depth == level.saturating_add(1)).then_some(entry.point)
    }
}
