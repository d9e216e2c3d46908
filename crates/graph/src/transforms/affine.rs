//! Affine forms: a matrix over up to three numbers, and an offset.

use crate::Coefficient::{self, Number};
use crate::{Binary, Graph, Node, NodeId, Stage, Type, Unary};

/// `matrix · base + offset` of one component.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) factors: [Coefficient; 3],
    pub(super) offset: Coefficient,
}

impl Row {
    const ZERO: Self = Self { factors: [Coefficient::ZERO; 3], offset: Coefficient::ZERO };

    fn low(offset: Coefficient) -> Self {
        Self { offset, ..Self::ZERO }
    }

    fn add(self, graph: &mut Graph, other: Self) -> Self {
        let mut factors = self.factors;
        for (factor, other) in factors.iter_mut().zip(other.factors) {
            *factor = factor.plus(graph, other);
        }
        Self { factors, offset: self.offset.plus(graph, other.offset) }
    }

    fn scaled(self, graph: &mut Graph, by: Coefficient) -> Self {
        let factors = self.factors.map(|factor| factor.times(graph, by));
        Self { factors, offset: self.offset.times(graph, by) }
    }
}

/// A number or vector of up to three components as a map of up to three numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Affine {
    /// What it starts from: components of vectors, and numbers. None at all if it is known before the points.
    pub(super) atoms: [Option<NodeId>; 3],
    pub(super) width: usize,
    /// Those beyond the width are unused.
    pub(super) rows: [Row; 3],
}

/// A node in terms of itself, or of nothing if it is known before the points.
pub(super) fn base(graph: &mut Graph, id: NodeId) -> Option<Affine> {
    let width = graph.ty(id).width();
    if width > 3 || graph.ty(id) == Type::Bool {
        return None;
    }
    let mut rows = [Row::ZERO; 3];
    if graph.stage(id) < Stage::Point {
        for (lane, row) in (0..width).zip(&mut rows) {
            let part = graph.component(id, lane as u8);
            *row = Row::low(Coefficient::of(graph, part));
        }
        return Some(Affine { atoms: [None; 3], width, rows });
    }
    let mut atoms = [None; 3];
    for (lane, row) in (0..width).zip(&mut rows) {
        // Two components of a vector may be one number.
        let atom = Some(graph.component(id, lane as u8));
        let place = atoms.iter().position(|&known| known == atom || known.is_none())?;
        atoms[place] = atom;
        row.factors[place] = Coefficient::ONE;
    }
    Some(Affine { atoms, width, rows })
}

/// A node in terms of the forms of its arguments; `None` if they start from more than three numbers.
pub(super) fn form(
    graph: &mut Graph,
    id: NodeId,
    mut of: impl FnMut(&mut Graph, NodeId) -> Option<Affine>,
) -> Option<Affine> {
    match graph.node(id) {
        Node::Unary(Unary::Neg, a) => {
            let a = of(graph, a)?;
            Some(a.scaled(graph, Number(-1.0)))
        }
        Node::Binary(Binary::Add, a, b) => {
            let (a, b) = (of(graph, a)?, of(graph, b)?);
            a.add(graph, b)
        }
        Node::Binary(Binary::Sub, a, b) => {
            let (a, b) = (of(graph, a)?, of(graph, b)?);
            let negative = b.scaled(graph, Number(-1.0));
            a.add(graph, negative)
        }
        Node::Binary(Binary::Mul, a, b) => {
            let (a, b) = (of(graph, a)?, of(graph, b)?);
            a.multiplied(graph, b)
        }
        Node::Binary(Binary::Dot, a, b) => {
            let (a, b) = (of(graph, a)?, of(graph, b)?);
            let products = a.multiplied(graph, b)?;
            let mut sum = products.rows[0];
            for row in &products.rows[1..products.width] {
                sum = sum.add(graph, *row);
            }
            Some(Affine { width: 1, rows: [sum; 3], ..products })
        }
        Node::Transform(columns, v) => {
            let v = of(graph, v)?;
            let mut sum: Option<Affine> = None;
            for (lane, column) in columns.into_iter().enumerate() {
                let column = of(graph, column).filter(|column| column.is_low())?;
                let filled = Affine { rows: [v.rows[lane]; 3], ..v };
                let product = filled.multiplied(graph, column)?;
                sum = match sum {
                    None => Some(product),
                    Some(sum) => sum.add(graph, product),
                };
            }
            sum
        }
        Node::Splat(ty, a) => {
            let a = of(graph, a)?;
            Some(Affine { width: ty.width(), rows: [a.rows[0]; 3], ..a })
        }
        Node::Compose(ty, parts) => {
            let mut joined = Affine { atoms: [None; 3], width: ty.width(), rows: [Row::ZERO; 3] };
            for (lane, &part) in parts.iter().enumerate().take(ty.width()) {
                let part = of(graph, part)?.over(&mut joined.atoms)?;
                joined.rows[lane] = part.rows[0];
            }
            Some(joined)
        }
        Node::Swizzle(ty, a, lanes) => {
            let a = of(graph, a)?;
            let rows = [0, 1, 2].map(|i| a.rows[usize::from(lanes[i])]);
            Affine { width: ty.width(), rows, ..a }.trimmed()
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

impl Affine {
    /// Without the atoms that no row needs.
    fn trimmed(mut self) -> Option<Self> {
        for (i, atom) in self.atoms.iter_mut().enumerate() {
            *atom =
                atom.filter(|_| self.rows[..self.width].iter().any(|row| !row.factors[i].is(0.0)));
        }
        self.over(&mut [None; 3])
    }

    fn is_low(&self) -> bool {
        self.atoms == [None; 3]
    }

    /// Written in terms of these atoms, to which its own are added; `None` if there is no room.
    fn over(self, atoms: &mut [Option<NodeId>; 3]) -> Option<Self> {
        let mut rows = self.rows.map(|row| Row::low(row.offset));
        for (own, atom) in self.atoms.into_iter().enumerate() {
            let Some(atom) = atom else { continue };
            let place = atoms.iter().position(|&known| known == Some(atom) || known.is_none())?;
            atoms[place] = Some(atom);
            for (row, before) in rows.iter_mut().zip(&self.rows) {
                row.factors[place] = before.factors[own];
            }
        }
        Some(Self { atoms: *atoms, rows, ..self })
    }

    fn add(self, graph: &mut Graph, other: Self) -> Option<Self> {
        let mut atoms = self.atoms;
        let other = other.over(&mut atoms)?;
        let mut sum = Self { atoms, ..self };
        for (row, other) in sum.rows.iter_mut().zip(other.rows) {
            *row = row.add(graph, other);
        }
        Some(sum)
    }

    fn scaled(self, graph: &mut Graph, by: Coefficient) -> Self {
        Self { rows: self.rows.map(|row| row.scaled(graph, by)), ..self }
    }

    /// Componentwise, one side known before the points.
    fn multiplied(self, graph: &mut Graph, other: Self) -> Option<Self> {
        let (mut varying, low) = match (self.is_low(), other.is_low()) {
            (_, true) => (self, other),
            (true, false) => (other, self),
            (false, false) => return None,
        };
        for (row, low) in varying.rows.iter_mut().zip(low.rows) {
            *row = row.scaled(graph, low.offset);
        }
        Some(varying)
    }

    /// With the components of one vector in its order, so that they are that vector.
    pub(super) fn sorted(self, graph: &Graph) -> Option<Self> {
        let mut order: Vec<NodeId> = self.atoms.into_iter().flatten().collect();
        order.sort_unstable_by_key(|&atom| {
            if let Node::Swizzle(_, v, lanes) = graph.node(atom) {
                (v, lanes[0])
            } else {
                (atom, 0)
            }
        });
        let mut atoms = [None; 3];
        for (place, atom) in atoms.iter_mut().zip(order) {
            *place = Some(atom);
        }
        self.over(&mut atoms)
    }

    /// With factors that rounding alone keeps from 0, 1 or -1 put there, as the cosine of a right angle.
    pub(super) fn snapped(mut self) -> Self {
        const ROUNDING: f64 = 1e-12;
        let factors = || self.rows[..self.width].iter().flat_map(|row| row.factors);
        let size = |factor: Coefficient| factor.number().map_or(1.0, f64::abs);
        let largest = factors().map(size).fold(0.0, f64::max);
        for factor in self.rows.iter_mut().flat_map(|row| &mut row.factors) {
            if let Number(value) = factor {
                if value.abs() <= largest * ROUNDING {
                    *value = 0.0;
                } else if (value.abs() - 1.0).abs() <= ROUNDING {
                    *value = value.signum();
                }
            }
        }
        self
    }
}
