//! Lipschitz constants of piecewise linear maps, such as folds and rotations of folded points.
//!
//! Combining the constants of single lanes loses that they share values: `vec3(min(p.x, p.y),
//! max(p.x, p.y), p.z)` would get sqrt(3), although its derivative is a permutation everywhere. So
//! the map is followed back through its operations as a set of matrices, one for each choice of
//! sides of the creases. Its constant is the largest operator norm of a matrix, times the constant
//! of the values at which it ends: the lanes of the point, or of any vector with a known constant.
//!
//! A rotation by a param has no matrix of numbers. It changes no norm, so the map goes on before it
//! with the norm of the matrices so far (see `per_frame`).

use sdfc_graph::{Graph, Node, NodeId};

use crate::certify::affine::{is_fixed, largest_singular_value};
use crate::certify::branches::{Lane, branches, counterpart};
use crate::certify::per_frame::scaled_rotation;

/// Largest number of operations that are followed.
const MAX_STEPS: usize = 512;
/// Largest number of matrices.
const MAX_MATRICES: usize = 64;
/// Largest number of values that the matrices are applied to.
const MAX_COLUMNS: usize = 12;

/// The derivatives by each value: one entry for each lane of the map.
type Matrix = Vec<[f64; 4]>;

/// The Lipschitz constant of a node in the point of `level`; `None` if it is not known to be
/// piecewise linear. `known` returns the constant of a node that is known already.
pub(crate) fn constant(
    graph: &mut Graph,
    node: NodeId,
    level: u16,
    known: &dyn Fn(NodeId) -> Option<NodeId>,
) -> Option<NodeId> {
    let width = graph.ty(node).width();
    let mut map = Map::identity((0..width).map(|lane| (node, lane)).collect());
    let mut factor = 1.0;
    // The maps with at most three columns since `factor` has changed.
    let mut narrow: Vec<Map> = Vec::new();
    for _ in 0..MAX_STEPS {
        map.drop_columns(graph, level);
        let end = map.end(graph);
        if let Some(end) = end.filter(|&end| is_point(graph, end, level)) {
            let constant = known(end).unwrap_or_else(|| graph.number(1.0));
            let factor = graph.number(factor * map.norm());
            return Some(graph.mul(factor, constant));
        }
        if map.columns.is_empty() {
            return Some(graph.number(0.0));
        }
        if map.columns.len() > MAX_COLUMNS {
            return None;
        }
        if map.columns.len() <= 3 {
            narrow.push(map.clone());
        }
        if !map.expand(graph, level) {
            let rotated = |before: &Map| {
                let rotation = scaled_rotation(graph, &before.columns, level)?;
                Some((before.scaled(&rotation.factors).norm(), rotation.values))
            };
            if let Some((norm, values)) = narrow.iter().rev().find_map(rotated) {
                factor *= norm;
                map = Map::identity(values);
                narrow.clear();
                continue;
            }
            // The map ends at a vector that is not piecewise linear itself.
            let constant = known(end.filter(|&end| end != node)?)?;
            let factor = graph.number(factor * map.norm());
            return Some(graph.mul(factor, constant));
        }
        if map.matrices.len() > MAX_MATRICES {
            // |AB| <= |A| |B|: go on with the norm of the matrices so far.
            let last = narrow.pop()?;
            factor *= last.norm();
            map = Map::identity(last.columns);
            narrow.clear();
        }
    }
    None
}

fn is_point(graph: &Graph, node: NodeId, level: u16) -> bool {
    matches!(graph.node(node), Node::Point(at, _) if at == level)
}

/// Matrices, each of which is the derivative of the map somewhere, by the same values.
#[derive(Clone)]
struct Map {
    columns: Vec<Lane>,
    matrices: Vec<Matrix>,
}

impl Map {
    /// The map that returns at most four values as they are.
    fn identity(columns: Vec<Lane>) -> Self {
        let unit = |i: usize| std::array::from_fn(|row| if row == i { 1.0 } else { 0.0 });
        let matrix = (0..columns.len()).map(unit).collect();
        Self { columns, matrices: vec![matrix] }
    }

    /// Removes values that do not depend on the point, or that no matrix uses.
    fn drop_columns(&mut self, graph: &Graph, level: u16) {
        for column in (0..self.columns.len()).rev() {
            let is_zero = |matrix: &Matrix| matrix[column] == [0.0; 4];
            if is_fixed(graph, self.columns[column].0, level) || self.matrices.iter().all(is_zero) {
                self.columns.swap_remove(column);
                for matrix in &mut self.matrices {
                    matrix.swap_remove(column);
                }
            }
        }
    }

    /// The node of which all values are lanes.
    fn end(&self, graph: &Graph) -> Option<NodeId> {
        let &(first, _) = self.columns.first()?;
        let is_one = self.columns.iter().all(|&(node, _)| node == first);
        (is_one && graph.ty(first).width() <= 3).then_some(first)
    }

    /// The map after each value has been multiplied by a factor.
    fn scaled(&self, factors: &[f64]) -> Self {
        let mut scaled = self.clone();
        for matrix in &mut scaled.matrices {
            for (column, factor) in matrix.iter_mut().zip(factors) {
                *column = column.map(|entry| factor * entry);
            }
        }
        scaled
    }

    /// The largest operator norm of a matrix with at most three columns.
    fn norm(&self) -> f64 {
        let norm = |matrix: &Matrix| {
            let row = |row: usize| {
                std::array::from_fn(|i| matrix.get(i).map_or(0.0, |column| column[row]))
            };
            largest_singular_value(&[0, 1, 2, 3].map(row))
        };
        self.matrices.iter().map(norm).fold(0.0, f64::max)
    }

    /// Replaces the value that was computed last by those it was computed from. Returns false if
    /// it is not piecewise linear in them.
    fn expand(&mut self, graph: &mut Graph, level: u16) -> bool {
        let last = (0..self.columns.len()).max_by_key(|&column| self.columns[column]);
        let Some(last) = last else { return false };
        let lane = self.columns[last];
        let Some(branches) = branches(graph, lane, level) else { return false };
        let own = self.take(last);
        let pair = counterpart(graph, lane, &self.columns);
        let other = pair.map(|pair| self.take(pair));
        let mut expanded = Vec::with_capacity(branches.len() * self.matrices.len());
        for (side, terms) in branches.iter().enumerate() {
            for (i, matrix) in self.matrices.iter().enumerate() {
                let mut matrix = matrix.clone();
                for &(value, factor) in terms {
                    add(&mut self.columns, &mut matrix, value, own[i].map(|x| factor * x));
                }
                if let Some(other) = &other {
                    // Where one of the two operands is the minimum, the other is the maximum.
                    for &(value, factor) in &branches[1 - side] {
                        add(&mut self.columns, &mut matrix, value, other[i].map(|x| factor * x));
                    }
                }
                expanded.push(matrix);
            }
        }
        for matrix in &mut expanded {
            matrix.resize(self.columns.len(), [0.0; 4]);
        }
        expanded.sort_by(compare);
        expanded.dedup();
        self.matrices = expanded;
        true
    }

    /// Removes a value and returns its column in each matrix.
    fn take(&mut self, column: usize) -> Vec<[f64; 4]> {
        self.columns.swap_remove(column);
        self.matrices.iter_mut().map(|matrix| matrix.swap_remove(column)).collect()
    }
}

/// Adds to the column of a value, which may be a new one.
fn add(columns: &mut Vec<Lane>, matrix: &mut Matrix, value: Lane, by: [f64; 4]) {
    let known = columns.iter().position(|&column| column == value);
    let at = known.unwrap_or(columns.len());
    if known.is_none() {
        columns.push(value);
    }
    if matrix.len() <= at {
        matrix.resize(at + 1, [0.0; 4]);
    }
    for (entry, by) in matrix[at].iter_mut().zip(by) {
        *entry += by;
    }
}

fn compare(a: &Matrix, b: &Matrix) -> std::cmp::Ordering {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    pairs
        .map(|(x, y)| x.total_cmp(y))
        .find(|order| order.is_ne())
        .unwrap_or(std::cmp::Ordering::Equal)
}
