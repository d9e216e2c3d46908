//! Polynomials in sines, cosines, lanes of normalized vectors and other per-frame atoms, reduced by
//! sin² = 1 - cos² and z² = 1 - x² - y². They show that a matrix built from rotations by params is
//! a rotation for every value of the params.

use std::collections::BTreeMap;

use crate::graph::Graph;
use crate::node::{Binary, Node, NodeId, Unary};

/// Maximum number of terms: more than any product of three rotations needs. With more, the analysis
/// gives up.
const MAX_TERMS: usize = 256;
/// Maximum depth of a coefficient: more than three rotations in a row make. Deeper nodes are taken
/// as atoms.
const MAX_DEPTH: u32 = 32;

/// Maximum number of visited nodes. Coefficients of three rotations have some dozens; shared ones
/// count each time they are met.
const MAX_VISITS: u32 = 1024;

/// An indeterminate of a polynomial: a lane of a node, or a function of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Atom {
    Cos(NodeId, u8),
    Sin(NodeId, u8),
    /// A lane of a normalized vector.
    Unit(NodeId, u8),
    /// The last lane of a normalized vector. Its number is the count of the others.
    LastUnit(NodeId, u8),
    Other(NodeId, u8),
}

/// A product of atoms with their powers.
type Monomial = BTreeMap<Atom, u32>;

/// Rounding error left where numbers cancel, relative to their magnitudes.
const ROUNDING: f64 = 1e-12;

/// A coefficient, and the sum of the magnitudes of its terms.
#[derive(Clone, Copy, Debug)]
struct Coefficient {
    value: f64,
    size: f64,
}

impl Coefficient {
    fn new(value: f64) -> Self {
        Self { value, size: value.abs() }
    }

    fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, size: self.size + other.size }
    }

    fn times(self, other: Self) -> Self {
        Self { value: self.value * other.value, size: self.size * other.size }
    }

    /// True if the coefficient is 0 up to rounding. Params can be arbitrarily large, so no
    /// coefficient is small by itself.
    fn is_zero(self) -> bool {
        self.value.abs() <= ROUNDING * self.size
    }
}

/// A sum of monomials with coefficients, in normal form, so that equal polynomials compare equal.
#[derive(Clone, Debug, Default)]
pub struct Polynomial {
    terms: BTreeMap<Monomial, Coefficient>,
}

impl PartialEq for Polynomial {
    /// Equal up to rounding of the coefficients.
    fn eq(&self, other: &Self) -> bool {
        self.plus(&other.times_number(-1.0)).terms.values().all(|c| c.is_zero())
    }
}

impl Polynomial {
    /// The polynomial without terms.
    pub fn zero() -> Self {
        Self::default()
    }

    /// The polynomial that is a number.
    pub fn number(value: f64) -> Self {
        Self { terms: BTreeMap::from([(Monomial::new(), Coefficient::new(value))]) }
    }

    fn atom(atom: Atom) -> Self {
        let one = Coefficient::new(1.0);
        Self { terms: BTreeMap::from([(Monomial::from([(atom, 1)]), one)]) }
    }

    /// The polynomial that a scalar node computes; `None` if it grows too large.
    pub fn of(graph: &Graph, node: NodeId) -> Option<Self> {
        Self::of_lane(graph, (node, 0), MAX_DEPTH, &mut { MAX_VISITS })
    }

    fn of_lane(
        graph: &Graph,
        (node, lane): (NodeId, u8),
        depth: u32,
        visits: &mut u32,
    ) -> Option<Self> {
        *visits = visits.checked_sub(1)?;
        if depth == 0 {
            return Some(Self::atom(Atom::Other(node, lane)));
        }
        let mut of = |id, lane| Self::of_lane(graph, (id, lane), depth - 1, visits);
        match graph.node(node) {
            Node::Const(value) => Some(Self::number(value.lanes()[usize::from(lane)])),
            Node::Unary(Unary::Neg, a) => Some(of(a, lane)?.times_number(-1.0)),
            Node::Unary(Unary::Cos, a) => Some(Self::atom(Atom::Cos(a, lane))),
            Node::Unary(Unary::Sin, a) => Some(Self::atom(Atom::Sin(a, lane))),
            Node::Unary(Unary::Normalize, _) => {
                let is_last = usize::from(lane) + 1 == graph.ty(node).width();
                let atom = if is_last { Atom::LastUnit } else { Atom::Unit };
                Some(Self::atom(atom(node, lane)))
            }
            Node::Binary(Binary::Add, a, b) => Some(of(a, lane)?.plus(&of(b, lane)?)),
            Node::Binary(Binary::Sub, a, b) => {
                Some(of(a, lane)?.plus(&of(b, lane)?.times_number(-1.0)))
            }
            Node::Binary(Binary::Mul, a, b) => of(a, lane)?.times(&of(b, lane)?),
            Node::Splat(_, a) => of(a, 0),
            Node::Compose(_, parts) => of(parts[usize::from(lane)], 0),
            Node::Swizzle(_, a, lanes) => of(a, lanes[usize::from(lane)]),
            Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => Some(Self::atom(Atom::Other(node, lane))),
        }
    }

    /// The number, if the polynomial has no atoms.
    pub fn constant(&self) -> Option<f64> {
        let mut value = 0.0;
        for (monomial, coefficient) in &self.terms {
            if monomial.is_empty() {
                value = coefficient.value;
            } else if !coefficient.is_zero() {
                return None;
            }
        }
        Some(value)
    }

    /// The sum.
    pub fn plus(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        for (monomial, coefficient) in &other.terms {
            let entry = sum.terms.entry(monomial.clone()).or_insert(Coefficient::new(0.0));
            *entry = entry.plus(*coefficient);
        }
        sum.terms.retain(|_, coefficient| coefficient.value != 0.0);
        sum
    }

    fn times_number(&self, factor: f64) -> Self {
        let factor = Coefficient::new(factor);
        let terms = self.terms.iter().map(|(m, c)| (m.clone(), c.times(factor))).collect();
        Self { terms }
    }

    /// The product, or `None` beyond 256 terms.
    pub fn times(&self, other: &Self) -> Option<Self> {
        let mut product = Self::zero();
        for (a, x) in &self.terms {
            for (b, y) in &other.terms {
                let mut monomial = a.clone();
                for (atom, power) in b {
                    *monomial.entry(*atom).or_insert(0) += power;
                }
                product = product.plus(&reduced(monomial, x.times(*y))?);
                if product.terms.len() > MAX_TERMS {
                    return None;
                }
            }
        }
        Some(product)
    }
}

/// The square of the scale factor of a similarity: the squared length of the matrix's rows, if all
/// rows have the same length and any two are orthogonal for all values of the atoms. `None` for
/// other matrices.
pub fn similarity_scale_squared(rows: &[[Polynomial; 3]]) -> Option<Polynomial> {
    let mut squares = squared_lengths_of_orthogonal(rows)?;
    let square = squares.pop()?;
    squares.iter().all(|other| *other == square).then_some(square)
}

/// The squared lengths of a matrix's rows, if any two rows are orthogonal for all values of the
/// atoms. `None` for other matrices.
pub fn squared_lengths_of_orthogonal(rows: &[[Polynomial; 3]]) -> Option<Vec<Polynomial>> {
    let product = |a: &[Polynomial; 3], b: &[Polynomial; 3]| -> Option<Polynomial> {
        (0..3).try_fold(Polynomial::zero(), |sum, i| Some(sum.plus(&a[i].times(&b[i])?)))
    };
    let mut squares = Vec::with_capacity(rows.len());
    for (i, row) in rows.iter().enumerate() {
        squares.push(product(row, row)?);
        for other in &rows[i + 1..] {
            if product(row, other)? != Polynomial::zero() {
                return None;
            }
        }
    }
    Some(squares)
}

/// The monomial with every sin² replaced by 1 - cos², and the square of the last lane of every
/// normalized vector by 1 minus the squares of the others.
fn reduced(monomial: Monomial, coefficient: Coefficient) -> Option<Polynomial> {
    let square = monomial.iter().find(|(atom, power)| **power >= 2 && !others(**atom).is_empty());
    let Some((&atom, &power)) = square else {
        return Some(Polynomial { terms: BTreeMap::from([(monomial, coefficient)]) });
    };
    let mut rest = monomial;
    rest.remove(&atom);
    if power > 2 {
        rest.insert(atom, power - 2);
    }
    let mut sum = reduced(rest.clone(), coefficient)?;
    for other in others(atom) {
        let mut with_other = rest.clone();
        *with_other.entry(other).or_insert(0) += 2;
        sum = sum.plus(&reduced(with_other, coefficient.times(Coefficient::new(-1.0)))?);
    }
    Some(sum)
}

/// The atoms whose squares add up to 1 with that of `atom`; none if its square is not replaced.
fn others(atom: Atom) -> Vec<Atom> {
    match atom {
        Atom::Sin(angle, lane) => vec![Atom::Cos(angle, lane)],
        Atom::LastUnit(vector, last) => (0..last).map(|lane| Atom::Unit(vector, lane)).collect(),
        Atom::Cos(..) | Atom::Unit(..) | Atom::Other(..) => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::node::{FrameInput, Type};

    #[test]
    fn coefficients_with_too_many_shared_nodes_are_rejected() {
        let mut graph = Graph::new();
        let input = |graph: &mut Graph, i| graph.frame_input(FrameInput::Param(i), Type::Scalar);
        let (mut a, mut b) = (input(&mut graph, 0), input(&mut graph, 1));
        for _ in 0..64 {
            (a, b) = (graph.add(a, b), graph.sub(a, b));
        }
        assert!(Polynomial::of(&graph, a).is_none());
    }

    #[test]
    fn a_small_coefficient_is_not_zero() {
        let mut graph = Graph::new();
        let k = graph.frame_input(FrameInput::Param(0), Type::Scalar);
        let small = graph.number(1e-10);
        let shear = graph.mul(small, k);
        let shear = Polynomial::of(&graph, shear).unwrap();
        assert!(shear != Polynomial::zero());
        let one = Polynomial::number(1.0);
        let rows = [[one.clone(), shear], [Polynomial::zero(), one]]
            .map(|[x, y]| [x, y, Polynomial::zero()]);
        assert!(similarity_scale_squared(&rows).is_none());
    }

    #[test]
    fn a_normalized_vector_has_length_one() {
        let mut graph = Graph::new();
        let k = graph.frame_input(FrameInput::Param(0), Type::Scalar);
        let two = graph.number(2.0);
        let vector = graph.compose(&[k, two, k]);
        let unit = graph.unary(Unary::Normalize, vector);
        let lanes = [0, 1, 2].map(|lane| graph.component(unit, lane));
        let [x, y, z] = lanes.map(|lane| Polynomial::of(&graph, lane).unwrap());
        let square = |lane: &Polynomial| lane.times(lane).unwrap();
        let sum = square(&x).plus(&square(&y)).plus(&square(&z));
        assert_eq!(sum.constant(), Some(1.0));
        assert_eq!(square(&sum).constant(), Some(1.0));
        assert_eq!(square(&x).plus(&square(&y)).constant(), None);
    }

    #[test]
    fn a_rotation_by_a_param_has_rows_of_length_one() {
        let mut graph = Graph::new();
        let angle = graph.frame_input(FrameInput::Param(0), Type::Scalar);
        let (c, s) = (graph.unary(Unary::Cos, angle), graph.unary(Unary::Sin, angle));
        let (c, s) = (Polynomial::of(&graph, c).unwrap(), Polynomial::of(&graph, s).unwrap());
        let norm = c.times(&c).unwrap().plus(&s.times(&s).unwrap());
        assert_eq!(norm.constant(), Some(1.0));
        let wrong = c.times(&c).unwrap().plus(&s);
        assert_eq!(wrong.constant(), None);
    }
}
