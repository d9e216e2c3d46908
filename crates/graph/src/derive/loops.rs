//! The derivative of a loop: a loop that carries the derivatives of its state.
//!
//! Let s be the state, c the inputs from outside and `s' = f(s, c)` an iteration. The derivative of
//! each lane of s with respect to c inits as the derivative of `init` and becomes
//! `∂f/∂s · ds/dc + ∂f/∂c` in each iteration; the partial derivatives come from one reverse sweep
//! over the body per lane. A loop that carries s and ds/dc ends with the factor of the adjoint of
//! s. Nothing is stored per iteration, and the number of iterations counts as constant. The loop
//! carries as many extra numbers as the state has lanes times c has lanes. As a rule c is one
//! point, so a loop over one to four numbers costs two to four times as much with its derivatives.

use super::sweep::{Sweep, adjoints, zero};
use crate::graph::Graph;
use crate::ids::{IdMap, IdSet};
use crate::loops::Loop;
use crate::node::{LoopId, LoopVar, Node, NodeId};
use crate::walk::{computed_where, reachable};

impl Sweep<'_> {
    /// Passes the adjoint of one part of a loop's state on to the inputs of the loop.
    pub(super) fn propagate_loop(&mut self, id: LoopId, position: u16, adjoint: NodeId) {
        let sources = self.sources(id);
        let slopes = slopes(self.graph, id, &sources);
        let before: usize = slopes.lanes[..usize::from(position)].iter().sum();
        let width = slopes.lanes[usize::from(position)];
        for (lane, row) in (0..).zip(&slopes.rows[before..before + width]) {
            let factor = self.graph.component(adjoint, lane);
            for (&source, &slope) in sources.iter().zip(row) {
                let part = self.graph.mul(slope, factor);
                self.accumulate(source, part);
            }
        }
    }

    /// The inputs of the loop that depend on the inputs of the sweep, looking through operations
    /// that only move lanes.
    fn sources(&self, id: LoopId) -> Vec<NodeId> {
        let mut sources = IdSet::default();
        let mut seen = IdSet::default();
        let mut pending = self.graph.loop_inputs(id);
        while let Some(id) = pending.pop() {
            if !self.live.contains(id) || !seen.insert(id) {
                continue;
            }
            let moves = matches!(
                self.graph.node(id),
                Node::Compose(..) | Node::Swizzle(..) | Node::Splat(..)
            );
            if moves && !self.inputs.contains(id) {
                pending.extend(self.graph.arguments(id));
            } else {
                sources.insert(id);
            }
        }
        sources.to_vec()
    }
}

/// Derivatives of the lanes of a loop's final state.
struct Slopes {
    /// Number of lanes of each part of the state.
    lanes: Vec<usize>,
    /// For each lane of the state, its derivatives with respect to the sources.
    rows: Vec<Vec<NodeId>>,
}

fn slopes(graph: &mut Graph, id: LoopId, sources: &[NodeId]) -> Slopes {
    let loop_ = graph.loop_at(id).clone();
    let lanes: Vec<usize> = loop_.init.iter().map(|&part| graph.ty(part).width()).collect();
    let state: Vec<NodeId> = (0..)
        .zip(&loop_.init)
        .map(|(position, &part)| {
            graph.variable(loop_.depth, LoopVar::State(position), graph.ty(part))
        })
        .collect();

    let mut inits = Vec::new();
    for lane in lanes_of(graph, &loop_.init) {
        inits.extend(adjoints(graph, lane, sources));
    }
    // One variable for each lane and source, following the variables of the state.
    let carried: Vec<NodeId> = inits
        .iter()
        .zip(loop_.init.len() as u16..)
        .map(|(&start, position)| {
            graph.variable(loop_.depth, LoopVar::State(position), graph.ty(start))
        })
        .collect();

    let mut wrt = state;
    wrt.extend(sources);
    let next = lanes_of(graph, &loop_.step);
    let partials: Vec<Vec<NodeId>> =
        next.into_iter().map(|lane| adjoints(graph, lane, &wrt)).collect();

    let nothing = zeros(graph, &inits, &carried, |graph, carried| {
        advanced(graph, &partials, &lanes, sources, carried)
    });
    let parts = loop_.init.len();
    let mut kept = Vec::new();
    let carried: Vec<NodeId> = inits
        .iter()
        .zip(&nothing)
        .map(|(&start, &is_zero)| {
            if is_zero {
                return start;
            }
            kept.push(start);
            let position = (parts + kept.len() - 1) as u16;
            graph.variable(loop_.depth, LoopVar::State(position), graph.ty(start))
        })
        .collect();
    let moved = advanced(graph, &partials, &lanes, sources, &carried);
    let moved = moved.into_iter().zip(&nothing).filter(|(_, is_zero)| !**is_zero);
    let mut next = loop_.step.clone();
    next.extend(moved.map(|(id, _)| id));
    let next = merged(graph, &next);
    let start: Vec<NodeId> = loop_.init.iter().copied().chain(kept).collect();
    let mut ends =
        graph.add_loop(Loop { init: start, step: next, ..loop_ }).into_iter().skip(parts);
    let all: Vec<NodeId> = inits
        .iter()
        .zip(nothing)
        .map(|(&start, is_zero)| if is_zero { start } else { ends.next().unwrap_or(start) })
        .collect();
    let rows = all.chunks(sources.len().max(1)).map(<[NodeId]>::to_vec).collect();
    Slopes { lanes, rows }
}

fn lanes_of(graph: &mut Graph, parts: &[NodeId]) -> Vec<NodeId> {
    let mut lanes = Vec::new();
    for &part in parts {
        for lane in 0..graph.ty(part).width() as u8 {
            lanes.push(graph.component(part, lane));
        }
    }
    lanes
}

/// The derivatives after an iteration, for each lane of the state and each source in turn.
fn advanced(
    graph: &mut Graph,
    partials: &[Vec<NodeId>],
    lanes: &[usize],
    sources: &[NodeId],
    carried: &[NodeId],
) -> Vec<NodeId> {
    let mut all = Vec::with_capacity(carried.len());
    for row in partials {
        for source in 0..sources.len() {
            let mut sum = row[lanes.len() + source];
            let mut from = 0;
            for (&partial, &width) in row.iter().zip(lanes) {
                for lane in 0..width {
                    let factor = graph.component(partial, lane as u8);
                    let term = graph.mul(carried[(from + lane) * sources.len() + source], factor);
                    sum = graph.add(sum, term);
                }
                from += width;
            }
            all.push(sum);
        }
    }
    all
}

/// Which of the carried derivatives start as 0 and stay 0.
fn zeros(
    graph: &mut Graph,
    inits: &[NodeId],
    carried: &[NodeId],
    advance: impl Fn(&mut Graph, &[NodeId]) -> Vec<NodeId>,
) -> Vec<bool> {
    let is_zero = |graph: &Graph, id: NodeId| graph.as_splat_number(id) == Some(0.0);
    let mut zeros: Vec<bool> = inits.iter().map(|&start| is_zero(graph, start)).collect();
    loop {
        let guess: Vec<NodeId> = carried
            .iter()
            .zip(&zeros)
            .map(|(&id, &is_zero)| if is_zero { zero(graph, graph.ty(id)) } else { id })
            .collect();
        let next = advance(graph, &guess);
        let mut stays = true;
        for (known, next) in zeros.iter_mut().zip(next) {
            if *known && !is_zero(graph, next) {
                (*known, stays) = (false, false);
            }
        }
        if stays {
            return zeros;
        }
    }
}

/// The roots, rewritten so that results of a loop are taken from another loop that carries the same
/// state and more, where the roots use both. The state is then computed once.
pub(super) fn merged(graph: &mut Graph, roots: &[NodeId]) -> Vec<NodeId> {
    let mut loops: Vec<LoopId> = computed_where(graph, roots, |_| true)
        .into_iter()
        .filter_map(|id| if let Node::Loop(id, ..) = graph.node(id) { Some(id) } else { None })
        .collect();
    loops.sort_unstable();
    loops.dedup();
    let longer = |id: LoopId| {
        let extends = |&other: &LoopId| graph.loop_at(other).extends(graph.loop_at(id));
        loops.iter().copied().filter(extends).max_by_key(|&id| graph.loop_at(id).init.len())
    };
    let known: Vec<(LoopId, LoopId)> =
        loops.iter().filter_map(|&id| Some((id, longer(id)?))).collect();
    if known.is_empty() {
        return roots.to_vec();
    }
    let mut new: IdMap<NodeId> = IdMap::default();
    for id in reachable(graph, roots) {
        let longer = if let Node::Loop(from, position, ty) = graph.node(id) {
            let to = known.iter().find(|(known, _)| *known == from);
            to.map(|&(_, to)| graph.intern(Node::Loop(to, position, ty)))
        } else {
            None
        };
        let changed = graph.arguments(id).any(|id| new.get(id).is_some_and(|new| new != id));
        let rebuilt = match longer {
            Some(longer) => longer,
            None if changed => graph.rebuild(id, |old| new.get(old).unwrap_or(old)),
            None => id,
        };
        new.insert(id, rebuilt);
    }
    roots.iter().map(|&root| new.get(root).unwrap_or(root)).collect()
}
