//! The order in which a function computes its nodes, and how many values that order keeps alive.
//!
//! A GPU gives a shader the registers that it needs at its worst moment, for as long as it runs;
//! the more registers, the fewer threads run at once. So a value is computed near its first use.
//! No order is best for all graphs. [`schedule`] tries three and keeps the one with the fewest live
//! values: ascending ids, and two depth-first orders that visit large arguments first.

pub(crate) mod dag;
mod lanes;
mod order;

use rustc_hash::FxHashMap;

use self::dag::Dag;
use self::lanes::Pressure;
use crate::graph::Graph;
use crate::ids::IdMap;
use crate::node::{Node, NodeId, Stage};
use crate::walk::computed_where;

/// `members`, ascending, in an order in which few values are alive at once; each follows those of
/// its `operands` that are members. `roots` are read last.
pub fn schedule(
    graph: &Graph,
    roots: &[NodeId],
    members: &[NodeId],
    operands: impl Fn(NodeId) -> Vec<NodeId>,
) -> Vec<NodeId> {
    let dag = Dag::new(graph, roots, members, operands);
    best(graph, &dag).1.into_iter().map(|position| dag.nodes[position]).collect()
}

/// The largest number of 32-bit lanes that are alive at once while the roots are computed at a
/// point, in the order of [`schedule`]. Constants and per-frame values take none.
pub fn live_lanes(graph: &Graph, roots: &[NodeId]) -> usize {
    let per_point = |id: NodeId| graph.stage(id) == Stage::Point;
    let members = computed_where(graph, roots, per_point);
    peak(graph, roots, &members)
}

fn peak(graph: &Graph, roots: &[NodeId], members: &[NodeId]) -> usize {
    let per_point = |id: NodeId| graph.stage(id) == Stage::Point;
    let operands = |id| if per_point(id) { graph.inputs(id) } else { Vec::new() };
    best(graph, &Dag::new(graph, roots, members, operands)).0.most
}

/// Computing a value frees about as many lanes as are computed for it alone; from this number on,
/// the value comes before others.
const HEAVY: usize = 8;

/// The best order, as positions of nodes, and its pressure.
fn best(graph: &Graph, dag: &Dag) -> (Pressure, Vec<usize>) {
    let inside = loop_lanes(graph, dag);
    let measure = |order: Vec<usize>| (lanes::pressure(graph, dag, &order, &inside), order);
    let ascending = measure((0..dag.nodes.len()).collect());
    let others = [HEAVY, usize::MAX].map(|heavy| measure(order::depth_first(dag, heavy)));
    others.into_iter().fold(ascending, |best, other| if other.0 < best.0 { other } else { best })
}

/// The lanes that each loop among the nodes needs for one iteration.
fn loop_lanes(graph: &Graph, dag: &Dag) -> IdMap<usize> {
    let mut lanes = IdMap::default();
    let mut of_loops = FxHashMap::default();
    for &id in &dag.nodes {
        let Node::Loop(loop_, ..) = graph.node(id) else { continue };
        let most = *of_loops.entry(loop_).or_insert_with(|| {
            let body = graph.loop_body(loop_);
            let looped = graph.loop_at(loop_);
            let roots: Vec<NodeId> = looped.condition.iter().chain(&looped.step).copied().collect();
            let mut members: Vec<NodeId> = body.condition.into_iter().chain(body.step).collect();
            members.sort_unstable();
            peak(graph, &roots, &members)
        });
        lanes.insert(id, most);
    }
    lanes
}
