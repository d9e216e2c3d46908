//! Affine maps of a formula's point, and the factor by which they can stretch distances.
//!
//! A node is affine if each of its lanes is `c0 x + c1 y + c2 z + t` with coefficients known before
//! the point is (constants or per-frame). Its Lipschitz constant is the largest singular value of the
//! matrix. For constant matrices that is computed; for per-frame ones a multiple of a rotation is
//! recognised at every angle by an identity (see [`crate::polynomial`]).

use sdfc_graph::{Binary, Graph, Node, NodeId, Stage, Type, Unary};

use crate::polynomial::Polynomial;

/// One lane: the coefficients of x, y, z.
pub(crate) type Row = [NodeId; 3];

/// The linear part of an affine node: one row per lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Linear {
    rows: [Row; 4],
    lanes: usize,
}

impl Linear {
    fn new(rows: &[Row]) -> Self {
        let mut list = [rows[0]; 4];
        list[..rows.len()].copy_from_slice(rows);
        Self { rows: list, lanes: rows.len() }
    }

    fn rows(&self) -> &[Row] {
        &self.rows[..self.lanes]
    }
}

/// The linear part of `node` in the point of `level`, given those of its arguments; `None` if it is not affine.
pub(crate) fn linear_part(
    graph: &mut Graph,
    node: NodeId,
    level: u16,
    of: &dyn Fn(NodeId) -> Option<Linear>,
) -> Option<Linear> {
    let zero = graph.number(0.0);
    let one = graph.number(1.0);
    let width = graph.ty(node).width();
    if graph.ty(node) == Type::Bool {
        return None;
    }
    if graph.levels(node) <= level && graph.stage(node) < Stage::Point {
        return Some(Linear::new(&vec![[zero; 3]; width]));
    }
    match graph.node(node) {
        Node::Point(at, _) if at == level => {
            let unit = |lane| std::array::from_fn(|i| if i == lane { one } else { zero });
            Some(Linear::new(&(0..width).map(unit).collect::<Vec<Row>>()))
        }
        Node::Unary(Unary::Neg, a) => {
            let minus = graph.number(-1.0);
            Some(scaled(graph, &of(a)?, &[minus]))
        }
        Node::Binary(Binary::Add, a, b) => Some(combined(graph, &of(a)?, &of(b)?, Graph::add)),
        Node::Binary(Binary::Sub, a, b) => Some(combined(graph, &of(a)?, &of(b)?, Graph::sub)),
        Node::Binary(Binary::Mul, a, b) => {
            let (fixed, varying) = if is_fixed(graph, a) { (a, b) } else { (b, a) };
            if !is_fixed(graph, fixed) {
                return None;
            }
            let factors = lanes_of(graph, fixed);
            Some(scaled(graph, &of(varying)?, &factors))
        }
        Node::Binary(Binary::Div, a, b) if is_fixed(graph, b) => {
            let divisors = lanes_of(graph, b);
            let factors: Vec<NodeId> = divisors.into_iter().map(|d| graph.div(one, d)).collect();
            Some(scaled(graph, &of(a)?, &factors))
        }
        Node::Binary(Binary::Dot, a, b) => {
            let (fixed, varying) = if is_fixed(graph, a) { (a, b) } else { (b, a) };
            if !is_fixed(graph, fixed) {
                return None;
            }
            let weights = lanes_of(graph, fixed);
            let linear = of(varying)?;
            Some(Linear::new(&[weighted_sum(graph, linear.rows(), &weights)]))
        }
        Node::Splat(_, a) => Some(Linear::new(&vec![of(a)?.rows[0]; width])),
        Node::Compose(_, parts) => {
            let rows: Option<Vec<Row>> =
                parts[..width].iter().map(|&part| Some(of(part)?.rows[0])).collect();
            Some(Linear::new(&rows?))
        }
        Node::Swizzle(_, a, lanes) => {
            let from = of(a)?;
            let rows: Vec<Row> =
                lanes[..width].iter().map(|&lane| from.rows[usize::from(lane)]).collect();
            Some(Linear::new(&rows))
        }
        Node::Transform(columns, v) => {
            if !columns.iter().all(|&column| is_fixed(graph, column)) {
                return None;
            }
            let linear = of(v)?;
            let mut rows = Vec::with_capacity(3);
            for lane in 0..3 {
                let weights = columns.map(|column| graph.component(column, lane));
                rows.push(weighted_sum(graph, linear.rows(), &weights));
            }
            Some(Linear::new(&rows))
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
        | Node::MaterialAt(..) => None,
    }
}

/// Known before the point is.
fn is_fixed(graph: &Graph, node: NodeId) -> bool {
    graph.stage(node) < Stage::Point
}

fn lanes_of(graph: &mut Graph, node: NodeId) -> Vec<NodeId> {
    let width = graph.ty(node).width() as u8;
    (0..width).map(|lane| graph.component(node, lane)).collect()
}

fn scaled(graph: &mut Graph, linear: &Linear, factors: &[NodeId]) -> Linear {
    let mut rows = linear.rows().to_vec();
    for (lane, row) in rows.iter_mut().enumerate() {
        let factor = factors[lane.min(factors.len() - 1)];
        *row = row.map(|coefficient| graph.mul(coefficient, factor));
    }
    Linear::new(&rows)
}

fn combined(
    graph: &mut Graph,
    a: &Linear,
    b: &Linear,
    join: fn(&mut Graph, NodeId, NodeId) -> NodeId,
) -> Linear {
    let mut rows = a.rows().to_vec();
    for (row, other) in rows.iter_mut().zip(b.rows()) {
        *row = std::array::from_fn(|i| join(graph, row[i], other[i]));
    }
    Linear::new(&rows)
}

fn weighted_sum(graph: &mut Graph, rows: &[Row], weights: &[NodeId]) -> Row {
    std::array::from_fn(|i| {
        let mut sum = graph.number(0.0);
        for (row, &weight) in rows.iter().zip(weights) {
            let term = graph.mul(row[i], weight);
            sum = graph.add(sum, term);
        }
        sum
    })
}

/// The largest factor by which the map stretches distances; `None` where it cannot be told.
pub(crate) fn stretch(graph: &mut Graph, linear: &Linear) -> Option<NodeId> {
    match constant_rows(graph, linear) {
        Some(rows) => Some(graph.number(largest_singular_value(&rows))),
        None => similarity(graph, linear),
    }
}

fn constant_rows(graph: &Graph, linear: &Linear) -> Option<Vec<[f64; 3]>> {
    let row_of = |row: &Row| {
        let lanes = row.map(|c| graph.as_number(c));
        Some([lanes[0]?, lanes[1]?, lanes[2]?])
    };
    linear.rows().iter().map(row_of).collect()
}

/// The factor of a multiple of an isometry: rows orthogonal and of one squared length.
pub(crate) fn similarity(graph: &mut Graph, linear: &Linear) -> Option<NodeId> {
    if let Some(rows) = constant_rows(graph, linear) {
        return constant_similarity(&rows).map(|factor| graph.number(factor));
    }
    let rows: Option<Vec<[Polynomial; 3]>> = linear
        .rows()
        .iter()
        .map(|row| {
            let [x, y, z] = row.map(|c| Polynomial::of(graph, c));
            Some([x?, y?, z?])
        })
        .collect();
    let rows = rows?;
    let product = |a: &[Polynomial; 3], b: &[Polynomial; 3]| -> Option<Polynomial> {
        (0..3).try_fold(Polynomial::zero(), |sum, i| Some(sum.plus(&a[i].times(&b[i])?)))
    };
    let norm = product(&rows[0], &rows[0])?;
    for (i, row) in rows.iter().enumerate() {
        if product(row, row)? != norm {
            return None;
        }
        for other in &rows[i + 1..] {
            if product(row, other)? != Polynomial::zero() {
                return None;
            }
        }
    }
    if let Some(value) = norm.constant() {
        return Some(graph.number(value.sqrt()));
    }
    let first = linear.rows()[0];
    let row = graph.compose(&first);
    Some(graph.length(row))
}

fn constant_similarity(rows: &[[f64; 3]]) -> Option<f64> {
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let norm = dot(&rows[0], &rows[0]);
    let same = |value: f64, wanted: f64| (value - wanted).abs() <= 1e-12 * norm.max(1e-300);
    for (i, row) in rows.iter().enumerate() {
        if !same(dot(row, row), norm)
            || !rows[i + 1..].iter().all(|other| same(dot(row, other), 0.0))
        {
            return None;
        }
    }
    Some(if same(norm, 1.0) { 1.0 } else { norm.sqrt() })
}

/// Largest singular value of a matrix of rows of three: the root of the largest eigenvalue of AᵀA,
/// by cyclic Jacobi rotations (Golub and Van Loan, section 8.5).
fn largest_singular_value(rows: &[[f64; 3]]) -> f64 {
    let mut m = [[0.0; 3]; 3];
    for row in rows {
        for i in 0..3 {
            for j in 0..3 {
                m[i][j] += row[i] * row[j];
            }
        }
    }
    for _ in 0..12 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            rotate_away(&mut m, i, j);
        }
    }
    let largest = m[0][0].max(m[1][1]).max(m[2][2]).max(0.0).sqrt();
    // A rotation's constant is 1, not 1 plus rounding: later comparisons ask for `<= 1`.
    if (largest - 1.0).abs() < 1e-12 { 1.0 } else { largest }
}

fn rotate_away(m: &mut [[f64; 3]; 3], i: usize, j: usize) {
    if m[i][j] == 0.0 {
        return;
    }
    let theta = (m[j][j] - m[i][i]) / (2.0 * m[i][j]);
    let sign = if theta < 0.0 { -1.0 } else { 1.0 };
    let t = sign / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for row in m.iter_mut() {
        let (a, b) = (row[i], row[j]);
        row[i] = c * a - s * b;
        row[j] = s * a + c * b;
    }
    let (upper, lower) = (m[i], m[j]);
    m[i] = std::array::from_fn(|k| c * upper[k] - s * lower[k]);
    m[j] = std::array::from_fn(|k| s * upper[k] + c * lower[k]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_values_by_hand() {
        let close = |rows: &[[f64; 3]], value: f64| {
            assert!((largest_singular_value(rows) - value).abs() < 1e-9, "{rows:?}");
        };
        close(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], 1.0);
        close(&[[2.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 1.0]], 2.0);
        // A shear of 1: the golden ratio.
        close(&[[1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], (1.0 + 5f64.sqrt()) / 2.0);
        close(&[[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]], 1.0);
        close(&[[0.0, 3.0, 4.0]], 5.0);
    }
}
