//! Rules for powers and roots.

use crate::graph::Graph;
use crate::node::{Binary, NodeId, Unary};

impl Graph {
    pub(super) fn simplified_sqrt(&mut self, a: NodeId) -> Option<NodeId> {
        if let Some((x, y)) = self.as_binary(Binary::Mul, a)
            && x == y
        {
            return Some(self.abs(x));
        }
        let (x, y) = self.as_binary(Binary::Dot, a)?;
        (x == y).then(|| self.length(x))
    }

    /// Powers that take at most two multiplications, and roots.
    pub(super) fn simplified_pow(&mut self, x: NodeId, y: NodeId) -> Option<NodeId> {
        let exponent = self.as_splat_number(y)?;
        if exponent == 0.0 {
            return Some(self.one_like(x));
        }
        if exponent == 1.0 {
            return Some(x);
        }
        if exponent == 0.5 {
            return Some(self.unary(Unary::Sqrt, x));
        }
        if exponent == -1.0 {
            let one = self.one_like(x);
            return Some(self.div(one, x));
        }
        let square = [2.0, 3.0, 4.0].contains(&exponent).then(|| self.mul(x, x))?;
        if exponent == 2.0 {
            return Some(square);
        }
        let factor = if exponent == 3.0 { x } else { square };
        Some(self.mul(square, factor))
    }
}
