//! Derivatives by one reverse sweep (reverse-mode differentiation).
//!
//! One walk from a scalar down to any number of nodes gives the scalar's derivatives with respect
//! to all of them. Each node sums up the derivative of the root with respect to it, its *adjoint*,
//! from the nodes that use it, and passes contributions on to its arguments. So the gradient costs
//! about three times the field's operations for all its components together; forward
//! differentiation costs that for each.
//!
//! At points without a derivative these rules hold:
//!
//! | operation | derivative |
//! |---|---|
//! | `length`, `normalize`, `sqrt` at 0 | 0 |
//! | `abs` at 0 | +1 |
//! | `min`, `max`, `clamp`, `saturate`, `select` | of the selected argument; the first on a tie |
//! | `floor`, `ceil`, `round`, `trunc`, `sign`, `step`, `hash`, comparisons | 0 |
//! | a loop's iteration count | 0 |
//! | `x % y` | 1 for x, `-floor(x / y)` for y |

mod cuts;
mod live;
mod loops;
mod parts;
mod rules;
mod sweep;
mod terms;

pub(crate) use self::sweep::TINY;
pub use self::sweep::adjoints;

use crate::graph::Graph;
use crate::node::NodeId;

/// The gradient of a scalar root with respect to a point (or any other node), a vector of its type.
pub fn gradient(graph: &mut Graph, root: NodeId, point: NodeId) -> NodeId {
    let found = sweep::adjoints(graph, root, &[point]);
    match loops::merged(graph, &found)[..] {
        [gradient] => gradient,
        _ => sweep::zero(graph, graph.ty(point)),
    }
}

/// The same gradient as [`gradient`], by one sweep for each part of the formula. A part ends at
/// every scalar that alone needs at least `least` lanes of other values. `None` if there is no such
/// scalar, or if the parts share so much that the sweeps would take quadratic time.
///
/// It takes more operations than one sweep, and keeps far fewer values alive.
pub fn gradient_in_parts(
    graph: &mut Graph,
    root: NodeId,
    point: NodeId,
    least: usize,
) -> Option<NodeId> {
    let found = parts::gradient(graph, root, point, least)?;
    loops::merged(graph, &[found]).pop()
}
