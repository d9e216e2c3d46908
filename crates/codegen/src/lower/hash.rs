//! Hashes, computed in 32-bit words.

use naga::{BinaryOperator, Expression, MathFunction, ScalarKind};
use sdfc_graph::{Node, NodeId, Type};

use super::body::Value;
use super::lowering::Lowering;
use super::types;
use crate::error::Error;

impl Lowering<'_> {
    /// Lowers a hash, mixed as in `sdfc_graph::eval::hash`. The word is kept for hashes that
    /// continue from it; the result is its value as a float, if that is read.
    pub(super) fn hash(&mut self, id: NodeId, state: NodeId, x: NodeId) -> Result<Value, Error> {
        use BinaryOperator::{Add, ExclusiveOr, Multiply, ShiftRight};
        let ty = self.program.graph.ty(id);
        let x = self.value(x)?;
        let x = self.signed_word(ty, x);
        let state = self.state_word(state)?;
        let word = self.body.binary(Add, state, x);
        let product = self.with_word(ty, Multiply, word, 747_796_405);
        let state = self.with_word(ty, Add, product, 2_891_336_453);
        let top = self.with_word(ty, ShiftRight, state, 28);
        let by = self.with_word(ty, Add, top, 4);
        let shifted = self.body.binary(ShiftRight, state, by);
        let mixed = self.body.binary(ExclusiveOr, shifted, state);
        let word = self.with_word(ty, Multiply, mixed, 277_803_737);
        let high = self.with_word(ty, ShiftRight, word, 22);
        let mixed = self.body.binary(ExclusiveOr, high, word);
        let word = self.with_word(ty, ShiftRight, mixed, 8);
        self.body.name(word, "h");
        self.words.insert(id, word);
        if self.uses.of(id) == 0 {
            return Ok(word); // read by none but hashes, as a word
        }
        Ok(self.body.cast(word, ScalarKind::Float, Some(4)))
    }

    /// The word that a hash continues from: another hash, or a constant.
    fn state_word(&mut self, state: NodeId) -> Result<Value, Error> {
        if let Some(&word) = self.words.get(&state) {
            return Ok(word);
        }
        let ty = self.program.graph.ty(state);
        let Node::Const(constant) = self.program.graph.node(state) else {
            let value = self.value(state)?;
            return Ok(self.body.cast(value, ScalarKind::Uint, Some(4)));
        };
        let lanes: Vec<Value> = constant.lanes()[..ty.width()]
            .iter()
            .map(|&lane| self.body.word(lane as u32))
            .collect();
        if let [word] = lanes[..] {
            return Ok(word);
        }
        let ty = types::words(self.types, ty);
        Ok(self.body.compute(Expression::Compose { ty, components: lanes }, &[]))
    }

    /// The integer part as a two's complement word, clamped to the range in which conversions are
    /// defined. Moving bits in floating point would be faster on some devices, and wrong on those
    /// that reorder sums.
    fn signed_word(&mut self, ty: Type, x: Value) -> Value {
        let [least, most] = [-2_147_483_648.0, 2_147_483_520.0].map(|end| self.splat(ty, end));
        let whole = self.body.call1(MathFunction::Floor, x);
        let raised = self.body.call2(MathFunction::Max, whole, least);
        let whole = self.body.call2(MathFunction::Min, raised, most);
        let whole = self.body.cast(whole, ScalarKind::Sint, Some(4));
        self.body.cast(whole, ScalarKind::Uint, None)
    }

    /// Applies an operator to a word, or to each of a vector of words, and a constant.
    fn with_word(&mut self, ty: Type, op: BinaryOperator, left: Value, right: u32) -> Value {
        let value = self.body.word(right);
        let right = match types::vector_size(ty) {
            None => value,
            Some(size) => self.body.compute(Expression::Splat { size, value }, &[]),
        };
        self.body.binary(op, left, right)
    }
}
