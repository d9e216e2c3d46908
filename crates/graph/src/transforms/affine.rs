//! Affine forms: a matrix over up to three scalars, and an offset.

use crate::coefficient::Coefficient::{self, Number};
use crate::graph::Graph;
use crate::node::{Binary, Node, NodeId, Stage, Type, Unary};

/// One component of an affine form: `factors · atoms + offset`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) factors: [Coefficient; 3],
    pub(super) offset: Coefficient,
}

impl Row {
    const ZERO: Self = Self { factors: [Coefficient::ZERO; 3], offset: Coefficient::ZERO };

    fn constant(offset: Coefficient) -> Self {
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

/// A scalar or a vector of up to three components as an affine map of up to three scalars.
#[derive(Clone, Copy, Debug)]
pub(super) struct Affine {
    /// The inputs of the map: scalars and components of vectors. None if the value does not depend
    /// on the point.
    pub(super) atoms: [Option<NodeId>; 3],
    pub(super) width: usize,
    /// Rows beyond the width are unused.
    pub(super) rows: [Row; 3],
}

/// A node as a function of itself, or as a constant if it does not depend on the point.
pub(super) fn base(graph: &mut Graph, id: NodeId) -> Option<Affine> {
    let width = graph.ty(id).width();
    if width > 3 || graph.ty(id) == Type::Bool {
        return None;
    }
    let mut rows = [Row::ZERO; 3];
    if graph.stage(id) < Stage::Point {
        for (lane, row) in (0..width).zip(&mut rows) {
            let component = graph.component(id, lane as u8);
            *row = Row::constant(Coefficient::of(graph, component));
        }
        return Some(Affine { atoms: [None; 3], width, rows });
    }
    let mut atoms = [None; 3];
    for (lane, row) in (0..width).zip(&mut rows) {
        // Two components of a vector may be the same scalar.
        let atom = Some(graph.component(id, lane as u8));
        let index = atoms.iter().position(|&known| known == atom || known.is_none())?;
        atoms[index] = atom;
        row.factors[index] = Coefficient::ONE;
    }
    Some(Affine { atoms, width, rows })
}

/// A node as a function of the atoms of its arguments; `None` if these are more than three.
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
                let column = of(graph, column).filter(|column| column.is_constant())?;
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
    /// The form without the atoms that no row uses.
    fn trimmed(mut self) -> Option<Self> {
        for (i, atom) in self.atoms.iter_mut().enumerate() {
            *atom =
                atom.filter(|_| self.rows[..self.width].iter().any(|row| !row.factors[i].is(0.0)));
        }
        self.over(&mut [None; 3])
    }

    fn is_constant(&self) -> bool {
        self.atoms == [None; 3]
    }

    /// The form over the given atoms, to which its own are added; `None` if they do not fit.
    fn over(self, atoms: &mut [Option<NodeId>; 3]) -> Option<Self> {
        let mut rows = self.rows.map(|row| Row::constant(row.offset));
        for (own, atom) in self.atoms.into_iter().enumerate() {
            let Some(atom) = atom else { continue };
            let index = atoms.iter().position(|&known| known == Some(atom) || known.is_none())?;
            atoms[index] = Some(atom);
            for (row, before) in rows.iter_mut().zip(&self.rows) {
                row.factors[index] = before.factors[own];
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

    /// The componentwise product, if one side does not depend on the point.
    fn multiplied(self, graph: &mut Graph, other: Self) -> Option<Self> {
        let (mut varying, constant) = match (self.is_constant(), other.is_constant()) {
            (_, true) => (self, other),
            (true, false) => (other, self),
            (false, false) => return None,
        };
        for (row, constant) in varying.rows.iter_mut().zip(constant.rows) {
            *row = row.scaled(graph, constant.offset);
        }
        Some(varying)
    }

    /// The form with components of one vector in order, so that they are that vector.
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
        for (entry, atom) in atoms.iter_mut().zip(order) {
            *entry = Some(atom);
        }
        self.over(&mut atoms)
    }

    /// The form with factors set to 0, 1 or -1 where only rounding keeps them from that, such as
    /// the cosine of a right angle.
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
