//! The derivative of a loop: a loop that carries the derivatives of its state.
//!
//! Let s be the state, c what the loop reads from outside and `s' = f(s, c)` a round. The derivative of each lane of s with
//! respect to c starts as that of `start` and becomes `∂f/∂s · ds/dc + ∂f/∂c`, whose parts are one reverse sweep over the
//! body for each lane. A loop that carries s and ds/dc has at its end what the adjoint of s is multiplied
//! by. Nothing is stored per round, and the number of rounds counts as fixed. What is carried has as many numbers as the
//! state times those that c consists of: a point, as a rule, so that loops over one to four numbers cost two to four
//! times as much with their derivatives.

use super::{Sweep, adjoints, zero};
use crate::ids::{IdMap, IdSet};
use crate::repeat::Loop;
use crate::walk::{computed_where, reachable};
use crate::{Graph, LoopId, Node, NodeId, Place};

impl Sweep<'_> {
    /// Gives what a loop reads from outside its parts of the adjoint of one part of the loop's state.
    pub(super) fn repeat(&mut self, id: LoopId, position: u16, adjoint: NodeId) {
        let sources = self.sources(id);
        let slopes = slopes(self.graph, id, &sources);
        let before: usize = slopes.lanes[..usize::from(position)].iter().sum();
        let width = slopes.lanes[usize::from(position)];
        for (lane, row) in (0..).zip(&slopes.rows[before..before + width]) {
            let factor = self.graph.component(adjoint, lane);
            for (&source, &slope) in sources.iter().zip(row) {
                let part = self.graph.mul(slope, factor);
                self.give(source, part);
            }
        }
    }

    /// What moves with the inputs of the sweep and is read by the loop: the values that lanes are moved about of.
    fn sources(&self, id: LoopId) -> Vec<NodeId> {
        let mut sources = IdSet::default();
        let mut seen = IdSet::default();
        let mut pending = self.graph.inputs_of_loop(id);
        while let Some(id) = pending.pop() {
            if !self.live.contains(id) || !seen.insert(id) {
                continue;
            }
            if let Node::Compose(..) | Node::Swizzle(..) | Node::Splat(..) = self.graph.node(id) {
                pending.extend(self.graph.arguments(id));
            } else {
                sources.insert(id);
            }
        }
        sources.to_vec()
    }
}

/// Derivatives of the lanes of a loop's state after its last round.
struct Slopes {
    /// How many lanes each part of the state has.
    lanes: Vec<usize>,
    /// For each lane of the state, its derivative by each source.
    rows: Vec<Vec<NodeId>>,
}

fn slopes(graph: &mut Graph, id: LoopId, sources: &[NodeId]) -> Slopes {
    let repeated = graph.repeated(id).clone();
    let lanes: Vec<usize> = repeated.start.iter().map(|&part| graph.ty(part).width()).collect();
    let state: Vec<NodeId> = (0..)
        .zip(&repeated.start)
        .map(|(position, &part)| {
            graph.variable(repeated.depth, Place::State(position), graph.ty(part))
        })
        .collect();

    let mut starts = Vec::new();
    for lane in lanes_of(graph, &repeated.start) {
        starts.extend(adjoints(graph, lane, sources));
    }
    // One variable for each lane and source, after those of the state.
    let carried: Vec<NodeId> = starts
        .iter()
        .zip(repeated.start.len() as u16..)
        .map(|(&start, position)| {
            graph.variable(repeated.depth, Place::State(position), graph.ty(start))
        })
        .collect();

    let mut wrt = state;
    wrt.extend(sources);
    let next = lanes_of(graph, &repeated.next);
    let partials: Vec<Vec<NodeId>> =
        next.into_iter().map(|lane| adjoints(graph, lane, &wrt)).collect();

    let nothing = zeros(graph, &starts, &carried, |graph, carried| {
        advanced(graph, &partials, &lanes, sources, carried)
    });
    let parts = repeated.start.len();
    let mut kept = Vec::new();
    let carried: Vec<NodeId> = starts
        .iter()
        .zip(&nothing)
        .map(|(&start, &is_zero)| {
            if is_zero {
                return start;
            }
            kept.push(start);
            let position = (parts + kept.len() - 1) as u16;
            graph.variable(repeated.depth, Place::State(position), graph.ty(start))
        })
        .collect();
    let moved = advanced(graph, &partials, &lanes, sources, &carried);
    let moved = moved.into_iter().zip(&nothing).filter(|(_, is_zero)| !**is_zero);
    let mut next = repeated.next.clone();
    next.extend(moved.map(|(id, _)| id));
    let next = merged(graph, &next);
    let start: Vec<NodeId> = repeated.start.iter().copied().chain(kept).collect();
    let mut ends = graph.repeat(Loop { start, next, ..repeated }).into_iter().skip(parts);
    let all: Vec<NodeId> = starts
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

/// The derivatives after a round: for each lane of the state and each source in turn.
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

/// Which of the carried derivatives start as 0 and stay so.
fn zeros(
    graph: &mut Graph,
    starts: &[NodeId],
    carried: &[NodeId],
    advance: impl Fn(&mut Graph, &[NodeId]) -> Vec<NodeId>,
) -> Vec<bool> {
    let is_zero = |graph: &Graph, id: NodeId| graph.as_uniform(id) == Some(0.0);
    let mut zeros: Vec<bool> = starts.iter().map(|&start| is_zero(graph, start)).collect();
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

/// The roots, with the results of each loop taken from one that carries the same state and more, where the roots are
/// computed from both: the state is then computed once.
pub(super) fn merged(graph: &mut Graph, roots: &[NodeId]) -> Vec<NodeId> {
    let mut loops: Vec<LoopId> = computed_where(graph, roots, |_| true)
        .into_iter()
        .filter_map(|id| if let Node::Loop(id, ..) = graph.node(id) { Some(id) } else { None })
        .collect();
    loops.sort_unstable();
    loops.dedup();
    let longer = |id: LoopId| {
        let extends = |&other: &LoopId| graph.repeated(other).extends(graph.repeated(id));
        loops.iter().copied().filter(extends).max_by_key(|&id| graph.repeated(id).start.len())
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
