//! Lipschitz constants of vectors whose lanes are linear combinations of the same few values.
//!
//! Such vectors occur where a folded point is rotated, as in kaleidoscopic fractals. Combining the
//! constants of the single lanes loses that they share values, and the result grows with each
//! rotation. Taken together, the lanes are a matrix over the shared values, and its operator norm
//! is the constant.

use sdfc_graph::{Binary, Graph, Node, NodeId, Unary};

use crate::certify::affine::{is_fixed, largest_singular_value};

/// Largest number of nested folds that are followed.
const MAX_FOLDS: usize = 64;
/// Largest number of terms in one lane.
const MAX_TERMS: usize = 256;

/// One lane of a node.
type Lane = (NodeId, usize);

/// The Lipschitz constant of the vector of `parts` in the point of `level`.
///
/// Every lane must be a linear combination of at most three values, the values must be folded lanes
/// of such a vector again, and so on down to the point; otherwise returns `None`.
pub(crate) fn constant(graph: &Graph, parts: &[NodeId], level: u16) -> Option<f64> {
    let mut lanes: Vec<Lane> = parts.iter().map(|&part| (part, 0)).collect();
    let mut factor = 1.0;
    for _ in 0..MAX_FOLDS {
        let mut values = Vec::new();
        let rows: Option<Vec<[f64; 3]>> =
            lanes.iter().map(|&lane| row(graph, lane, level, &mut values)).collect();
        factor *= largest_singular_value(&rows?);
        if values.iter().all(|&(node, _)| is_point(graph, node, level)) {
            return Some(factor);
        }
        lanes =
            values.into_iter().map(|value| unfolded(graph, value, level)).collect::<Option<_>>()?;
    }
    None
}

fn is_point(graph: &Graph, node: NodeId, level: u16) -> bool {
    matches!(graph.node(node), Node::Point(at, _) if at == level)
}

/// The lane `x` of which a value is a function u with |u(x) - u(y)| <= |x - y|.
fn unfolded(graph: &Graph, (node, lane): Lane, level: u16) -> Option<Lane> {
    match graph.node(node) {
        Node::Unary(Unary::Abs | Unary::Sin | Unary::Cos | Unary::Saturate, a) => Some((a, lane)),
        Node::Binary(Binary::Min | Binary::Max, a, b) if is_fixed(graph, b, level) => {
            Some((a, lane))
        }
        Node::Binary(Binary::Min | Binary::Max, a, b) if is_fixed(graph, a, level) => {
            Some((b, lane))
        }
        Node::Point(at, _) if at == level => Some((node, lane)),
        Node::Const(_)
        | Node::Point(..)
        | Node::Frame(..)
        | Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Splat(..)
        | Node::Compose(..)
        | Node::Swizzle(..)
        | Node::Transform(..)
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => None,
    }
}

/// The coefficients of a lane in `values`. Appends values that are not in the list yet.
fn row(graph: &Graph, lane: Lane, level: u16, values: &mut Vec<Lane>) -> Option<[f64; 3]> {
    let mut row = [0.0; 3];
    let mut terms = vec![(lane, 1.0)];
    for _ in 0..MAX_TERMS {
        let Some(((node, lane), factor)) = terms.pop() else { return Some(row) };
        if is_fixed(graph, node, level) {
            continue;
        }
        let lane = if graph.ty(node).width() == 1 { 0 } else { lane };
        let number = |id: NodeId, lane: usize| {
            let lanes = graph.as_const(id)?;
            lanes.lanes().get(lane).or(lanes.lanes().last()).copied()
        };
        match graph.node(node) {
            Node::Unary(Unary::Neg, a) => terms.push(((a, lane), -factor)),
            Node::Binary(Binary::Add, a, b) => {
                terms.extend([((a, lane), factor), ((b, lane), factor)]);
            }
            Node::Binary(Binary::Sub, a, b) => {
                terms.extend([((a, lane), factor), ((b, lane), -factor)]);
            }
            Node::Binary(Binary::Mul, a, b) => {
                let (other, by) = match (number(a, lane), number(b, lane)) {
                    (Some(by), _) => (b, by),
                    (None, by) => (a, by?),
                };
                terms.push(((other, lane), factor * by));
            }
            Node::Binary(Binary::Div, a, b) => terms.push(((a, lane), factor / number(b, lane)?)),
            Node::Splat(_, a) => terms.push(((a, 0), factor)),
            Node::Compose(_, parts) => terms.push(((parts[lane], 0), factor)),
            Node::Swizzle(_, a, lanes) => terms.push(((a, usize::from(lanes[lane])), factor)),
            Node::Transform(columns, v) => {
                for (i, column) in columns.into_iter().enumerate() {
                    terms.push(((v, i), factor * number(column, lane)?));
                }
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => {
                let known = values.iter().position(|value| *value == (node, lane));
                let index = known.unwrap_or(values.len());
                if known.is_none() {
                    values.push((node, lane));
                }
                *row.get_mut(index)? += factor;
            }
        }
    }
    None
}
