//! How many lanes an order keeps alive.

use super::dag::Dag;
use crate::graph::Graph;
use crate::ids::IdMap;
use crate::node::Node;

/// How much an order keeps alive; less is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Pressure {
    /// The largest number of lanes alive at once.
    pub(super) most: usize,
    /// The sum of that number over all nodes.
    total: usize,
}

/// The pressure of an order. `inside` has the lanes that the body of a loop needs.
pub(super) fn pressure(
    graph: &Graph,
    dag: &Dag,
    order: &[usize],
    inside: &IdMap<usize>,
) -> Pressure {
    let last_reads = last_reads(dag, order);
    let mut alive = 0;
    let mut pressure = Pressure { most: 0, total: 0 };
    for (time, &position) in order.iter().enumerate() {
        // The arguments of a loop outlive its iterations.
        if let Node::Loop(..) = graph.node(dag.nodes[position]) {
            let body = inside.get(dag.nodes[position]).unwrap_or(0);
            pressure.most = pressure.most.max(alive + body);
        }
        alive -= last_reads.ending[time];
        for lane in dag.lanes[position].iter().flatten() {
            if lane.0 == position && last_reads.is_read[position][usize::from(lane.1)] {
                alive += 1;
            }
        }
        pressure.most = pressure.most.max(alive);
        pressure.total += alive;
    }
    pressure
}

struct LastReads {
    /// How many lanes are read for the last time at each step of the order.
    ending: Vec<usize>,
    /// Whether a lane of a node is read at all.
    is_read: Vec<[bool; 4]>,
}

fn last_reads(dag: &Dag, order: &[usize]) -> LastReads {
    let count = dag.nodes.len();
    let (mut ending, mut is_read) = (vec![0; order.len()], vec![[false; 4]; count]);
    let mut read = |position: usize, time: Option<usize>, ending: &mut Vec<usize>| {
        for &(source, lane) in dag.lanes[position].iter().flatten() {
            let known = &mut is_read[source][usize::from(lane)];
            if !*known {
                *known = true;
                if let Some(time) = time {
                    ending[time] += 1;
                }
            }
        }
    };
    for &root in &dag.roots {
        read(root, None, &mut ending);
    }
    for (time, &position) in order.iter().enumerate().rev() {
        for &argument in &dag.arguments[position] {
            read(argument, Some(time), &mut ending);
        }
    }
    LastReads { ending, is_read }
}
