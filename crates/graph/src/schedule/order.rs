//! Depth-first orders.

use super::dag::Dag;

/// What is left to do for a node.
#[derive(Clone, Copy)]
enum Task {
    /// Compute what is heavy below it.
    Prepare(usize),
    /// Compute it.
    Compute(usize),
    /// Compute it; its arguments are done.
    Emit(usize),
}

/// Depth first; of several arguments the one first that most lanes are computed for alone. A sum
/// over a chain so follows the chain from its beginning, and a derivative comes before conditions
/// on the values that it shares.
///
/// An argument is heavy if at least `heavy` lanes are computed for it alone. Heavy arguments come
/// before light ones across several levels: a sum of weighted derivatives needs all derivatives
/// before the weights, each of which depends on all values that the derivatives share.
pub(super) fn depth_first(dag: &Dag, heavy: usize) -> Vec<usize> {
    let sizes = dag.exclusive().lanes;
    let moved = moved_sizes(dag, &sizes);
    let count = dag.nodes.len();
    let (mut order, mut done) = (Vec::with_capacity(count), vec![false; count]);
    // The last task is taken first, so larger arguments are sorted to the end.
    let sorted = |positions: &[usize], sizes: &[usize], done: &[bool]| {
        let mut open: Vec<usize> = positions.iter().copied().filter(|&p| !done[p]).collect();
        open.sort_by_key(|&position| (sizes[position], position));
        open
    };
    let is_heavy = |position: &usize| sizes[*position] >= heavy;
    // Nodes that no root needs come last.
    let mut tasks: Vec<Task> = (0..count).rev().map(Task::Compute).collect();
    let roots = sorted(&dag.roots, &sizes, &done);
    tasks.extend(roots.iter().copied().map(Task::Compute));
    tasks.extend(roots.into_iter().filter(is_heavy).map(Task::Prepare));
    while let Some(task) = tasks.pop() {
        let (Task::Prepare(position) | Task::Compute(position) | Task::Emit(position)) = task;
        if done[position] {
            continue;
        }
        let only_moves = dag.own_lanes(position) == 0;
        let sizes = if only_moves { &moved } else { &sizes };
        let open = || sorted(&dag.arguments[position], sizes, &done);
        match task {
            Task::Prepare(_) => {
                let open: Vec<usize> = open().into_iter().filter(is_heavy).collect();
                // What has one heavy argument waits for the others of the sum that it is in.
                if open.len() != 1 {
                    tasks.push(Task::Compute(position));
                }
                tasks.extend(open.into_iter().map(Task::Prepare));
            }
            Task::Compute(_) => {
                let open = open();
                tasks.push(Task::Emit(position));
                tasks.extend(open.iter().copied().map(Task::Compute));
                tasks.extend(open.into_iter().filter(is_heavy).map(Task::Prepare));
            }
            Task::Emit(_) => {
                done[position] = true;
                order.push(position);
            }
        }
    }
    order
}

/// For each node that only moves lanes, the largest of the numbers of its arguments; for other
/// nodes, the number of lanes that are computed for it alone. A vector of a distance and of three
/// components of the gradient needs none of these for one component alone. The gradient still comes
/// first, because it computes the values of the distance on its way.
fn moved_sizes(dag: &Dag, sizes: &[usize]) -> Vec<usize> {
    let mut moved = sizes.to_vec();
    for position in 0..dag.nodes.len() {
        if dag.own_lanes(position) == 0 {
            let largest = dag.arguments[position].iter().map(|&argument| moved[argument]).max();
            moved[position] = moved[position].max(largest.unwrap_or(0));
        }
    }
    moved
}
