//! Rules for vectors: composing, swizzling, products, lengths.

use super::{is_componentwise, is_lanewise, lanes};
use crate::graph::Graph;
use crate::node::{Binary, Node, NodeId, Type, Unary};

impl Graph {
    pub(super) fn simplified_compose(&mut self, parts: &[NodeId]) -> Option<NodeId> {
        self.gathered(parts).or_else(|| self.vectorised(parts))
    }

    /// The parts as one vector without any computation: components of one vector, constants, or one
    /// scalar.
    fn gathered(&mut self, parts: &[NodeId]) -> Option<NodeId> {
        let ty = Type::of_width(parts.len())?;
        if parts.iter().all(|&part| part == parts[0]) {
            return Some(self.splat(ty, parts[0]));
        }
        let constants: Option<Vec<f64>> = parts.iter().map(|&part| self.as_number(part)).collect();
        if let Some(constants) = constants {
            return Some(self.constant(ty, &constants));
        }
        let (source, _) = self.as_component(parts[0])?;
        let component = |&part: &NodeId| {
            self.as_component(part).filter(|&(from, _)| from == source).map(|(_, lane)| lane)
        };
        let selected: Option<Vec<u8>> = parts.iter().map(component).collect();
        Some(self.swizzle(source, &selected?))
    }

    fn as_component(&self, id: NodeId) -> Option<(NodeId, u8)> {
        if let Node::Swizzle(Type::Scalar, v, lanes) = self.node(id) {
            Some((v, lanes[0]))
        } else {
            None
        }
    }

    /// The same operation on each part becomes one vector operation, if gathering its arguments is
    /// free.
    fn vectorised(&mut self, parts: &[NodeId]) -> Option<NodeId> {
        if let Node::Unary(op, _) = self.node(parts[0]) {
            let inner: Option<Vec<NodeId>> =
                parts.iter().map(|&part| self.as_unary(op, part)).collect();
            let inner = self.gathered(&inner?).filter(|_| is_componentwise(op))?;
            return Some(self.unary(op, inner));
        }
        let Node::Binary(op, ..) = self.node(parts[0]) else { return None };
        let pairs: Option<Vec<(NodeId, NodeId)>> =
            parts.iter().map(|&part| self.as_binary(op, part)).collect();
        let (left, right): (Vec<NodeId>, Vec<NodeId>) = pairs?.into_iter().unzip();
        if !is_lanewise(op) {
            return None;
        }
        let (left, right) = (self.gathered(&left)?, self.gathered(&right)?);
        Some(self.binary(op, left, right))
    }

    pub(super) fn simplified_swizzle(&mut self, a: NodeId, selected: &[u8]) -> Option<NodeId> {
        let identity = selected.len() == self.ty(a).width()
            && (0..).zip(selected).all(|(index, &lane): (u8, _)| index == lane);
        if identity {
            return Some(a);
        }
        match self.node(a) {
            Node::Splat(_, scalar) => {
                let ty = Type::of_width(selected.len())?;
                Some(self.splat(ty, scalar))
            }
            Node::Compose(_, parts) => {
                let parts: Vec<NodeId> =
                    selected.iter().map(|&lane| parts[usize::from(lane)]).collect();
                Some(self.compose(&parts))
            }
            Node::Swizzle(_, v, inner) => {
                let selected: Vec<u8> =
                    selected.iter().map(|&lane| inner[usize::from(lane)]).collect();
                Some(self.swizzle(v, &selected))
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => None,
        }
    }

    pub(super) fn simplified_length(&mut self, a: NodeId) -> Option<NodeId> {
        if self.ty(a).width() == 1 {
            return Some(self.abs(a));
        }
        match self.node(a) {
            Node::Unary(Unary::Neg | Unary::Abs, inner) => Some(self.length(inner)),
            Node::Splat(ty, scalar) => {
                let size = self.abs(scalar);
                let factor = self.number((ty.width() as f64).sqrt());
                Some(self.mul(size, factor))
            }
            Node::Binary(Binary::Mul, v, f) if self.is_low(f) => {
                let factor = self.as_equal_lanes(f)?;
                let (length, size) = (self.length(v), self.abs(factor));
                Some(self.mul(length, size))
            }
            Node::Compose(ty, parts) => {
                let parts = &parts[..ty.width()];
                let kept: Vec<NodeId> =
                    parts.iter().copied().filter(|&part| !self.is_uniform(part, 0.0)).collect();
                if kept.len() == parts.len() {
                    return None;
                }
                let shorter = self.compose(&kept);
                Some(self.length(shorter))
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => None,
        }
    }

    pub(super) fn simplified_dot(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        let (a, b) = self.ordered(a, b);
        if self.ty(a).width() == 1 {
            return Some(self.mul(a, b));
        }
        if let Some(weights) = self.as_const(b)
            && let Some(sum) = self.dot_constant(a, &lanes(&weights))
        {
            return Some(sum);
        }
        self.dot_scaled(a, b)
            .or_else(|| self.dot_scaled(b, a))
            .or_else(|| self.dot_of_ones(a, b))
            .or_else(|| self.in_order(Binary::Dot, a, b))
    }

    /// Components with weight 0 are dropped. One component, or two of weight 1 or -1, need no
    /// scalar product.
    fn dot_constant(&mut self, v: NodeId, weights: &[f64]) -> Option<NodeId> {
        let kept: Vec<u8> =
            (0..).zip(weights).filter(|(_, weight)| **weight != 0.0).map(|(i, _)| i).collect();
        let weight = |i: u8| weights[usize::from(i)];
        match kept[..] {
            [] => Some(self.number(0.0)),
            [only] => {
                let (component, factor) = (self.component(v, only), self.number(weight(only)));
                Some(self.mul(component, factor))
            }
            [i, j] if weight(i).abs() == 1.0 && weight(j).abs() == 1.0 => {
                let (x, y) = (self.component(v, i), self.component(v, j));
                let (f, g) = (self.number(weight(i)), self.number(weight(j)));
                let (x, y) = (self.mul(x, f), self.mul(y, g));
                Some(self.add(x, y))
            }
            _ if kept.len() < weights.len() => {
                let ty = Type::of_width(kept.len())?;
                let remaining: Vec<f64> = kept.iter().map(|&i| weight(i)).collect();
                let (shorter, remaining) = (self.swizzle(v, &kept), self.constant(ty, &remaining));
                Some(self.dot(shorter, remaining))
            }
            _ => None,
        }
    }

    /// `dot(v * splat(s), w)` is `dot(v, w) * s`.
    fn dot_scaled(&mut self, a: NodeId, w: NodeId) -> Option<NodeId> {
        let (x, y) = self.as_binary(Binary::Mul, a)?;
        let (v, filled) = if self.as_splat(x).is_some() { (y, x) } else { (x, y) };
        let factor = self.as_equal_lanes(filled)?;
        let product = self.dot(v, w);
        Some(self.mul(product, factor))
    }

    /// The sum of a vector's components, where these are known.
    fn dot_of_ones(&mut self, v: NodeId, ones: NodeId) -> Option<NodeId> {
        if !self.is_uniform(ones, 1.0) {
            return None;
        }
        match self.node(v) {
            Node::Binary(Binary::Mul, x, y) => Some(self.dot(x, y)),
            Node::Splat(ty, scalar) => {
                let width = self.number(ty.width() as f64);
                Some(self.mul(scalar, width))
            }
            Node::Compose(ty, parts) => {
                let parts = &parts[..ty.width()];
                parts.iter().copied().reduce(|sum, part| self.add(sum, part))
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => None,
        }
    }

    /// A vector product with a constant along one axis.
    pub(super) fn simplified_cross(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        if let Some(value) = self.as_const(b) {
            return self.cross_axis(a, &lanes(&value));
        }
        let value = self.as_const(a)?;
        let turned = self.cross_axis(b, &lanes(&value))?;
        Some(self.neg(turned))
    }

    fn cross_axis(&mut self, v: NodeId, axis: &[f64]) -> Option<NodeId> {
        let along = axis.iter().position(|&lane| lane != 0.0)?;
        if axis.iter().filter(|&&lane| lane != 0.0).count() > 1 {
            return None;
        }
        // v × e_x = [0, v.z, -v.y], and so on around.
        let (next, last) = ((along + 1) % 3, (along + 2) % 3);
        let mut parts = [self.number(0.0); 3];
        let size = self.number(axis[along]);
        let (forth, back) = (self.component(v, last as u8), self.component(v, next as u8));
        parts[next] = self.mul(forth, size);
        let back = self.mul(back, size);
        parts[last] = self.neg(back);
        Some(self.compose(&parts))
    }

    pub(super) fn simplified_transform(
        &mut self,
        columns: [NodeId; 3],
        v: NodeId,
    ) -> Option<NodeId> {
        let identity = (0..3).all(|i| {
            self.as_const(columns[i]).is_some_and(|column| {
                (0..3).all(|j| column.lanes()[j] == if i == j { 1.0 } else { 0.0 })
            })
        });
        identity.then_some(v)
    }
}
