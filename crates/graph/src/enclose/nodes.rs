//! Bounds of nodes: one exhaustive match over all nodes.

use super::encloser::Encloser;
use super::values::{Affine, BoundedValue, Values};
use crate::node::{Binary, Node, NodeId, Type};
use crate::walk::computed_where;

impl Encloser<'_> {
    pub(super) fn bound_root(
        &mut self,
        root: NodeId,
        point: NodeId,
        ends: [NodeId; 2],
    ) -> Option<BoundedValue> {
        if self.graph.ty(root) != Type::Scalar {
            return None;
        }
        let sizes = ends.map(|end| self.graph.abs(end));
        let size = self.graph.max(sizes[0], sizes[1]);
        let value = Values::Affine(Affine { ends, magnitude: size });
        let slope = self.direction.map(|direction| {
            let size = self.graph.abs(direction);
            Values::Affine(Affine { ends: [direction; 2], magnitude: size })
        });
        for id in computed_where(self.graph, &[root, point], |id| id != point) {
            if id == point {
                self.known.insert(id, BoundedValue { value, slope });
            } else {
                self.bound_node(id)?;
            }
        }
        self.known.get(root)
    }

    /// Bounds a node whose arguments are bounded already.
    pub(super) fn bound_node(&mut self, id: NodeId) -> Option<()> {
        if self.known.get(id).is_none() {
            let known = self.bound_new_node(id)?;
            self.known.insert(id, known);
        }
        Some(())
    }

    fn bound_new_node(&mut self, id: NodeId) -> Option<BoundedValue> {
        let node = self.graph.node(id);
        let of = |s: &Self, id| s.known.get(id);
        Some(match node {
            Node::Const(_) | Node::Frame(..) | Node::Variable(..) => {
                BoundedValue::fixed(Values::Constant(id))
            }
            Node::Unary(op, a) => {
                let x = of(self, a)?;
                let value = self.unary(op, x.value);
                let slope = self.unary_slope(op, x, value);
                BoundedValue { value, slope }
            }
            Node::Binary(op, a, b) => {
                let (x, y) = (of(self, a)?, of(self, b)?);
                let soft = self.soft_extreme(id);
                // The same argument twice does not vary independently.
                let value = if let Some(soft) = soft {
                    soft
                } else if a == b && op == Binary::Mul {
                    self.square(x.value)
                } else if a == b && op == Binary::Dot {
                    self.square_of_length(x.value)
                } else {
                    self.binary(op, x.value, y.value)
                };
                let slope = self.binary_slope(op, x, y, value);
                BoundedValue { value, slope }
            }
            Node::Ternary(op, arguments) => {
                let [x, y, z] = arguments.map(|id| of(self, id));
                let all = [x?, y?, z?];
                let value = self.ternary(op, all.map(|known| known.value));
                let moves = all.iter().any(|known| known.slope.is_some())
                    || !matches!(all[0].value, Values::Constant(_));
                let slope = if moves && self.direction.is_some() {
                    self.ternary_slope(op, all)
                } else {
                    None
                };
                BoundedValue { value, slope }
            }
            Node::Splat(ty, a) => {
                let x = of(self, a)?;
                let value = self.splat(ty, x.value);
                BoundedValue { value, slope: x.slope.map(|slope| self.splat(ty, slope)) }
            }
            Node::Swizzle(ty, a, lanes) => {
                let x = of(self, a)?;
                let lanes = &lanes[..ty.width()];
                let mut moved = |x| self.map_nodes(x, |graph, node| graph.swizzle(node, lanes));
                BoundedValue { value: moved(x.value), slope: x.slope.map(moved) }
            }
            Node::Compose(ty, parts) => {
                let mut all = Vec::with_capacity(ty.width());
                for &part in &parts[..ty.width()] {
                    all.push(of(self, part)?);
                }
                let values: Vec<Values> = all.iter().map(|known| known.value).collect();
                let value = self.compose(&values);
                let slope = if all.iter().any(|known| known.slope.is_some()) {
                    let slopes: Vec<Values> =
                        all.into_iter().map(|known| self.slope(known)).collect();
                    Some(self.compose(&slopes))
                } else {
                    None
                };
                BoundedValue { value, slope }
            }
            Node::Transform(columns, v) => {
                let [a, b, c] = columns.map(|id| of(self, id));
                let (columns, v) = ([a?, b?, c?], of(self, v)?);
                self.transformed(columns, v)
            }
            Node::Loop(loop_, position, _) => {
                if !self.loops.contains_key(&loop_) {
                    let results = self.bound_loop(loop_)?;
                    self.loops.insert(loop_, results);
                }
                *self.loops[&loop_].get(usize::from(position))?
            }
            Node::Element(table, at, _) => {
                let at = of(self, at)?;
                let table = self.graph.table(table).clone();
                self.element(&table, at)
            }
            Node::Point(..) | Node::Sample(..) | Node::MaterialAt(..) => return None,
        })
    }

    fn transformed(&mut self, columns: [BoundedValue; 3], v: BoundedValue) -> BoundedValue {
        let value = self.transform(columns.map(|column| column.value), v.value);
        let mut slope =
            v.slope.map(|slope| self.transform(columns.map(|column| column.value), slope));
        if columns.iter().any(|column| column.slope.is_some()) {
            let turned = columns.map(|column| self.slope(column));
            let turned = self.transform(turned, v.value);
            slope = Some(match slope {
                Some(slope) => self.binary(Binary::Add, slope, turned),
                None => turned,
            });
        }
        BoundedValue { value, slope }
    }
}
