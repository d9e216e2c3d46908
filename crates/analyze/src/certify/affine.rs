//! Affine maps of a formula's point, and their operator norms.
//!
//! A node is affine if each of its lanes is `c0 x + c1 y + c2 z + t` with coefficients that do not
//! depend on the point (constants or per-frame values). Its Lipschitz constant is the operator norm
//! of the matrix, which is the largest singular value. The norm of a constant matrix is computed. A
//! per-frame matrix is recognised as a multiple of a rotation at every angle by a polynomial
//! identity (see [`sdfc_graph::Polynomial`]).

use rustc_hash::FxHashMap;
use sdfc_graph::{
    Binary, Coefficient, Graph, Node, NodeId, Polynomial, Stage, Type, Unary, reachable,
    similarity_scale_squared,
};

const ZERO: Coefficient = Coefficient::ZERO;

/// The coefficients of x, y and z in one lane.
type Row = [Coefficient; 3];

/// The linear part of an affine node, one row for each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Linear {
    rows: [Row; 4],
    lanes: usize,
}

impl Linear {
    /// Makes `lanes` rows by calling `row` for each of them.
    fn new(lanes: usize, mut row: impl FnMut(usize) -> Row) -> Self {
        let mut rows = [[ZERO; 3]; 4];
        for (lane, target) in rows.iter_mut().enumerate().take(lanes) {
            *target = row(lane);
        }
        Self { rows, lanes }
    }

    fn rows(&self) -> &[Row] {
        &self.rows[..self.lanes]
    }

    fn is_identity(&self) -> bool {
        let unit = |lane: usize, i: usize| if lane == i { 1.0 } else { 0.0 };
        let mut rows = self.rows().iter().enumerate();
        self.lanes == 3
            && rows.all(|(lane, row)| {
                row.iter().enumerate().all(|(i, coefficient)| coefficient.is(unit(lane, i)))
            })
    }

    fn is_zero(&self) -> bool {
        self.rows().iter().flatten().all(|coefficient| coefficient.is(0.0))
    }

    /// Replaces each coefficient by the result of `change` for its lane.
    fn map(&self, mut change: impl FnMut(usize, Coefficient) -> Coefficient) -> Self {
        Self::new(self.lanes, |lane| self.rows[lane].map(|coefficient| change(lane, coefficient)))
    }
}

/// The linear part of a node as a map of the point of `level`, between the jumps of `floor`, `sign`
/// and the like, which count as constant. Returns `None` if the node is not affine there.
pub(crate) fn linear_between_jumps(graph: &mut Graph, root: NodeId, level: u16) -> Option<Linear> {
    let mut known: FxHashMap<NodeId, Option<Box<Linear>>> = FxHashMap::default();
    for node in reachable(graph, &[root]) {
        if is_fixed(graph, node, level) {
            continue;
        }
        let is_constant = |id: NodeId| {
            let linear = known.get(&id).and_then(Option::as_deref);
            is_fixed(graph, id, level) || linear.is_some_and(Linear::is_zero)
        };
        let mut arguments = graph.arguments(node).peekable();
        let has_constant_arguments = arguments.peek().is_some() && arguments.all(is_constant);
        let linear = if has_constant_arguments || is_piecewise_constant(graph.node(node)) {
            Some(Linear::new(graph.ty(node).width(), |_| [ZERO; 3]))
        } else {
            linear_part(graph, node, level, &known)
        };
        known.insert(node, linear.map(Box::new));
    }
    known.get(&root)?.as_deref().copied()
}

/// True if the operation is constant between its jumps.
fn is_piecewise_constant(node: Node) -> bool {
    matches!(
        node,
        Node::Unary(Unary::Sign | Unary::Floor | Unary::Ceil | Unary::Round | Unary::Trunc, _)
            | Node::Binary(Binary::Step, ..)
    )
}

/// The linear part of a node that depends on the point of `level`. `known` holds the linear parts
/// of those of its arguments that do. Returns `None` if the node is not affine.
pub(crate) fn linear_part(
    graph: &mut Graph,
    node: NodeId,
    level: u16,
    known: &FxHashMap<NodeId, Option<Box<Linear>>>,
) -> Option<Linear> {
    let width = graph.ty(node).width();
    if graph.ty(node) == Type::Bool {
        return None;
    }
    let of = |graph: &Graph, id: NodeId| match is_fixed(graph, id, level) {
        true => Some(Linear::new(graph.ty(id).width(), |_| [ZERO; 3])),
        false => known.get(&id)?.as_deref().copied(),
    };
    match graph.node(node) {
        Node::Point(at, _) if at == level => Some(Linear::new(width, |lane| {
            std::array::from_fn(|i| if i == lane { Coefficient::ONE } else { ZERO })
        })),
        Node::Unary(Unary::Neg, a) => {
            let minus = Coefficient::Number(-1.0);
            Some(of(graph, a)?.map(|_, coefficient| coefficient.times(graph, minus)))
        }
        Node::Binary(Binary::Add, a, b) => {
            let (a, b) = (of(graph, a)?, of(graph, b)?);
            let sum = |lane: usize, i: usize| a.rows[lane][i].plus(graph, b.rows[lane][i]);
            Some(from_coefficients(a.lanes, sum))
        }
        Node::Binary(Binary::Sub, a, b) => {
            let (a, b) = (of(graph, a)?, of(graph, b)?);
            let difference = |lane: usize, i: usize| a.rows[lane][i].minus(graph, b.rows[lane][i]);
            Some(from_coefficients(a.lanes, difference))
        }
        Node::Binary(Binary::Mul, a, b) => {
            let (fixed, varying) = if is_fixed(graph, a, level) { (a, b) } else { (b, a) };
            if !is_fixed(graph, fixed, level) {
                return None;
            }
            let factors = lanes_of(graph, fixed);
            Some(
                of(graph, varying)?
                    .map(|lane, coefficient| coefficient.times(graph, factors[lane])),
            )
        }
        Node::Binary(Binary::Div, a, b) if is_fixed(graph, b, level) => {
            let factors = lanes_of(graph, b).map(|divisor| Coefficient::ONE.over(graph, divisor));
            Some(of(graph, a)?.map(|lane, coefficient| coefficient.times(graph, factors[lane])))
        }
        Node::Binary(Binary::Dot, a, b) => {
            let (fixed, varying) = if is_fixed(graph, a, level) { (a, b) } else { (b, a) };
            if !is_fixed(graph, fixed, level) {
                return None;
            }
            let weights = lanes_of(graph, fixed);
            let linear = of(graph, varying)?;
            Some(Linear::new(1, |_| weighted_sum(graph, linear.rows(), &weights)))
        }
        Node::Splat(_, a) => {
            let row = of(graph, a)?.rows[0];
            Some(Linear::new(width, |_| row))
        }
        Node::Compose(_, lanes) => {
            let mut rows = [[ZERO; 3]; 4];
            for (row, &lane) in rows.iter_mut().zip(&lanes[..width]) {
                *row = of(graph, lane)?.rows[0];
            }
            Some(Linear { rows, lanes: width })
        }
        Node::Swizzle(_, a, lanes) => {
            let from = of(graph, a)?;
            Some(Linear::new(width, |lane| from.rows[usize::from(lanes[lane])]))
        }
        Node::Transform(columns, v) => {
            if !columns.iter().all(|&column| is_fixed(graph, column, level)) {
                return None;
            }
            let linear = of(graph, v)?;
            let columns = columns.map(|column| lanes_of(graph, column));
            Some(Linear::new(width, |lane| {
                weighted_sum(graph, linear.rows(), &columns.map(|column| column[lane]))
            }))
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

/// True if the node does not depend on the point of `level`: it has a lower evaluation rate, or
/// depends only on the points of enclosing formulas.
pub(crate) fn is_fixed(graph: &Graph, node: NodeId, level: u16) -> bool {
    graph.stage(node) < Stage::Point
        || (graph.levels(node) <= level && graph.loops_around(node) == 0)
}

/// The lanes of a fixed node. The last lane is repeated up to four.
fn lanes_of(graph: &mut Graph, node: NodeId) -> [Coefficient; 4] {
    let last = graph.ty(node).width() - 1;
    if let Some(value) = graph.as_const(node) {
        return std::array::from_fn(|lane| Coefficient::Number(value.lanes()[lane.min(last)]));
    }
    std::array::from_fn(|lane| {
        let component = graph.component(node, lane.min(last) as u8);
        Coefficient::of(graph, component)
    })
}

fn from_coefficients(
    lanes: usize,
    mut coefficient: impl FnMut(usize, usize) -> Coefficient,
) -> Linear {
    Linear::new(lanes, |lane| std::array::from_fn(|i| coefficient(lane, i)))
}

fn weighted_sum(graph: &mut Graph, rows: &[Row], weights: &[Coefficient]) -> Row {
    std::array::from_fn(|i| {
        rows.iter().zip(weights).fold(ZERO, |sum, (row, weight)| {
            let term = row[i].times(graph, *weight);
            sum.plus(graph, term)
        })
    })
}

/// Applies the linear part of a map to a vector.
pub(crate) fn applied(graph: &mut Graph, linear: &Linear, vector: NodeId) -> NodeId {
    if linear.is_identity() {
        return vector;
    }
    let columns = [0, 1, 2].map(|i| {
        let lanes: Vec<NodeId> = linear.rows().iter().map(|row| row[i].node(graph)).collect();
        graph.compose(&lanes)
    });
    graph.transform(columns, vector)
}

/// The operator norm of the map; `None` if it is not known.
pub(crate) fn operator_norm(graph: &mut Graph, linear: &Linear) -> Option<NodeId> {
    match constant_rows(linear) {
        Some(rows) => Some(graph.number(largest_singular_value(&rows))),
        None => similarity(graph, linear),
    }
}

/// The operator norm of a matrix that does not depend on the point; `None` if it is not known.
pub(crate) fn matrix_norm(graph: &mut Graph, columns: [NodeId; 3]) -> Option<NodeId> {
    let lanes = graph.ty(columns[0]).width();
    let columns = columns.map(|column| lanes_of(graph, column));
    let linear = Linear::new(lanes, |lane| columns.map(|column| column[lane]));
    operator_norm(graph, &linear)
}

fn constant_rows(linear: &Linear) -> Option<Vec<[f64; 3]>> {
    let row_of = |&[x, y, z]: &Row| Some([x.number()?, y.number()?, z.number()?]);
    linear.rows().iter().map(row_of).collect()
}

/// The factor by which the map scales all distances; `None` if its rows are not orthogonal and of
/// equal length, so that it is no similarity.
pub(crate) fn similarity(graph: &mut Graph, linear: &Linear) -> Option<NodeId> {
    if let Some(rows) = constant_rows(linear) {
        return constant_similarity(&rows).map(|factor| graph.number(factor));
    }
    let rows: Option<Vec<[Polynomial; 3]>> = linear
        .rows()
        .iter()
        .map(|row| {
            let [x, y, z] = row.map(|c| {
                let node = c.node(graph);
                Polynomial::of(graph, node)
            });
            Some([x?, y?, z?])
        })
        .collect();
    let square = similarity_scale_squared(&rows?)?;
    if let Some(value) = square.constant() {
        return Some(graph.number(value.sqrt()));
    }
    let first = linear.rows()[0].map(|coefficient| coefficient.node(graph));
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

/// The largest singular value of a matrix with rows of three: the square root of the largest
/// eigenvalue of AᵀA, by cyclic Jacobi rotations (Golub and Van Loan, section 8.5).
pub(crate) fn largest_singular_value(rows: &[[f64; 3]]) -> f64 {
    let mut m = [[0.0; 3]; 3];
    for row in rows {
        for i in 0..3 {
            for j in 0..3 {
                m[i][j] += row[i] * row[j];
            }
        }
    }
    // Smaller elements off the diagonal change no eigenvalue by more than rounding does.
    let negligible = f64::EPSILON * 0.01 * (m[0][0] + m[1][1] + m[2][2]);
    for _ in 0..12 {
        if [m[0][1], m[0][2], m[1][2]].iter().all(|off| off.abs() <= negligible) {
            break;
        }
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            rotate_away(&mut m, i, j);
        }
    }
    let largest = m[0][0].max(m[1][1]).max(m[2][2]).max(0.0).sqrt();
    // The norm of a rotation is 1 without rounding errors: later comparisons test `<= 1`.
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
