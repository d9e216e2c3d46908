//! Operations, by the number of their arguments.

use naga::{BinaryOperator, Expression, MathFunction, UnaryOperator};
use sdfc_graph::{Binary, Node, NodeId, Ternary, Type, Unary};

use super::body::Value;
use super::lowering::Lowering;
use super::types;
use super::uses::{Product, Uniform, product};
use crate::error::Error;

/// The least squared length: `Normalize` does not bring shorter vectors to unit length.
const MIN_SQUARE: f32 = 1e-36;

impl Lowering<'_> {
    pub(super) fn unary(&mut self, id: NodeId, op: Unary, a: NodeId) -> Result<Value, Error> {
        let ty = self.program.graph.ty(a);
        if (op == Unary::Not) != (ty == Type::Bool) {
            return Err(Error::IllTyped(id));
        }
        let is_vector = types::vector_size(ty).is_some();
        let a = self.value(a)?;
        let fun = match op {
            Unary::Neg => return Ok(self.prefix(UnaryOperator::Negate, a)),
            Unary::Not => return Ok(self.prefix(UnaryOperator::LogicalNot, a)),
            Unary::Normalize if is_vector => return Ok(self.normalized(a)),
            Unary::Normalize | Unary::Sign => MathFunction::Sign,
            Unary::Length if is_vector => MathFunction::Length,
            Unary::Length | Unary::Abs => MathFunction::Abs,
            Unary::Floor => MathFunction::Floor,
            Unary::Ceil => MathFunction::Ceil,
            Unary::Round => MathFunction::Round,
            Unary::Trunc => MathFunction::Trunc,
            Unary::Fract => MathFunction::Fract,
            Unary::Sqrt => MathFunction::Sqrt,
            Unary::InverseSqrt => MathFunction::InverseSqrt,
            Unary::Exp => MathFunction::Exp,
            Unary::Exp2 => MathFunction::Exp2,
            Unary::Log => MathFunction::Log,
            Unary::Log2 => MathFunction::Log2,
            Unary::Sin => MathFunction::Sin,
            Unary::Cos => MathFunction::Cos,
            Unary::Tan => MathFunction::Tan,
            Unary::Asin => MathFunction::Asin,
            Unary::Acos => MathFunction::Acos,
            Unary::Atan => MathFunction::Atan,
            Unary::Sinh => MathFunction::Sinh,
            Unary::Cosh => MathFunction::Cosh,
            Unary::Tanh => MathFunction::Tanh,
            Unary::Saturate => MathFunction::Saturate,
        };
        Ok(self.body.call1(fun, a))
    }

    fn prefix(&mut self, op: UnaryOperator, expr: Value) -> Value {
        self.body.compute(Expression::Unary { op, expr }, &[expr])
    }

    /// `v * inverseSqrt(max(dot(v, v), least))`: WGSL's own `normalize` is undefined at 0.
    fn normalized(&mut self, v: Value) -> Value {
        let square = self.body.call2(MathFunction::Dot, v, v);
        let least = self.body.literal(MIN_SQUARE);
        let square = self.body.call2(MathFunction::Max, square, least);
        let factor = self.body.call1(MathFunction::InverseSqrt, square);
        self.body.binary(BinaryOperator::Multiply, v, factor)
    }

    pub(super) fn binary(
        &mut self,
        id: NodeId,
        op: Binary,
        a: NodeId,
        b: NodeId,
    ) -> Result<Value, Error> {
        let ty = self.program.graph.ty(a);
        if ty != self.program.graph.ty(b) || !takes(op, ty) {
            return Err(Error::IllTyped(id));
        }
        if op == Binary::Mul {
            return self.product(a, b);
        }
        let (a, b) = (self.value(a)?, self.value(b)?);
        let operator = match op {
            Binary::Add => BinaryOperator::Add,
            Binary::Sub => BinaryOperator::Subtract,
            Binary::Mul => BinaryOperator::Multiply,
            Binary::Div => BinaryOperator::Divide,
            Binary::Lt => BinaryOperator::Less,
            Binary::Le => BinaryOperator::LessEqual,
            Binary::Eq => BinaryOperator::Equal,
            Binary::Ne => BinaryOperator::NotEqual,
            // Both sides are computed anyway; the short-circuiting forms are control flow.
            Binary::And => BinaryOperator::And,
            Binary::Or => BinaryOperator::InclusiveOr,
            Binary::Rem => return Ok(self.floored_remainder(a, b)),
            Binary::Min => return Ok(self.body.call2(MathFunction::Min, a, b)),
            Binary::Max => return Ok(self.body.call2(MathFunction::Max, a, b)),
            Binary::Pow => return Ok(self.body.call2(MathFunction::Pow, a, b)),
            Binary::Atan2 => return Ok(self.body.call2(MathFunction::Atan2, a, b)),
            Binary::Step => return Ok(self.body.call2(MathFunction::Step, a, b)),
            // Lowered by itself, and replaced by one of its formulas.
            Binary::Hash | Binary::Alternative => return Err(Error::IllTyped(id)),
            Binary::Dot => return Ok(self.body.call2(MathFunction::Dot, a, b)),
            Binary::Cross => return Ok(self.body.call2(MathFunction::Cross, a, b)),
        };
        Ok(self.body.binary(operator, a, b))
    }

    /// A product; a vector with the same scalar in all lanes multiplies as that scalar.
    fn product(&mut self, a: NodeId, b: NodeId) -> Result<Value, Error> {
        let (left, right) = match product(&self.program.graph, a, b) {
            Product::Plain => (self.value(a)?, self.value(b)?),
            Product::LeftUniform(uniform) => (self.uniform(a, uniform)?, self.value(b)?),
            Product::RightUniform(uniform) => (self.value(a)?, self.uniform(b, uniform)?),
        };
        Ok(self.body.binary(BinaryOperator::Multiply, left, right))
    }

    fn uniform(&mut self, id: NodeId, uniform: Uniform) -> Result<Value, Error> {
        match uniform {
            Uniform::Node(scalar) => self.value(scalar),
            Uniform::Number(number) => self.number(id, number),
        }
    }

    /// `x - y * floor(x / y)`: WGSL's `%` truncates.
    fn floored_remainder(&mut self, x: Value, y: Value) -> Value {
        let quotient = self.body.binary(BinaryOperator::Divide, x, y);
        let whole = self.body.call1(MathFunction::Floor, quotient);
        let part = self.body.binary(BinaryOperator::Multiply, y, whole);
        self.body.binary(BinaryOperator::Subtract, x, part)
    }

    pub(super) fn ternary(
        &mut self,
        id: NodeId,
        op: Ternary,
        arguments: [NodeId; 3],
    ) -> Result<Value, Error> {
        let [a, b, c] = arguments;
        let [first, second, third] = arguments.map(|argument| self.program.graph.ty(argument));
        let well_typed = match op {
            Ternary::Select => first == Type::Bool && second == third,
            Ternary::Mix | Ternary::Clamp | Ternary::Smoothstep => {
                first != Type::Bool && first == second && second == third
            }
        };
        if !well_typed {
            return Err(Error::IllTyped(id));
        }
        match op {
            Ternary::Select => {
                let (condition, accept) = (self.value(a)?, self.value(b)?);
                let reject = self.value(c)?;
                let select = Expression::Select { condition, accept, reject };
                Ok(self.body.compute(select, &[condition, accept, reject]))
            }
            Ternary::Mix => self.call3(MathFunction::Mix, arguments),
            Ternary::Clamp => match self.limits(b, c) {
                Limits::Ascending => self.call3(MathFunction::Clamp, arguments),
                Limits::Equal | Limits::Descending | Limits::Unknown => {
                    let (x, low, high) = (self.value(a)?, self.value(b)?, self.value(c)?);
                    let raised = self.body.call2(MathFunction::Max, x, low);
                    Ok(self.body.call2(MathFunction::Min, raised, high))
                }
            },
            Ternary::Smoothstep => self.smoothstep(third, arguments),
        }
    }

    fn smoothstep(&mut self, ty: Type, [from, to, x]: [NodeId; 3]) -> Result<Value, Error> {
        match self.limits(from, to) {
            Limits::Ascending => self.call3(MathFunction::SmoothStep, [from, to, x]),
            Limits::Equal => {
                let (edge, x) = (self.value(from)?, self.value(x)?);
                Ok(self.body.call2(MathFunction::Step, edge, x))
            }
            Limits::Descending => {
                let rising = self.call3(MathFunction::SmoothStep, [to, from, x])?;
                let one = self.splat(ty, 1.0);
                Ok(self.body.binary(BinaryOperator::Subtract, one, rising))
            }
            Limits::Unknown => {
                let values = [self.value(from)?, self.value(to)?, self.value(x)?];
                Ok(self.smoothstep_of_any_limits(ty, values))
            }
        }
    }

    /// `t * t * (3 - 2 * t)` for `t = saturate((x - from) / (to - from))`; where both limits are
    /// equal, t is the step there.
    fn smoothstep_of_any_limits(&mut self, ty: Type, [from, to, x]: [Value; 3]) -> Value {
        let (two, three) = (self.splat(ty, 2.0), self.splat(ty, 3.0));
        let body = &mut self.body;
        let past = body.binary(BinaryOperator::Subtract, x, from);
        let width = body.binary(BinaryOperator::Subtract, to, from);
        let quotient = body.binary(BinaryOperator::Divide, past, width);
        let reject = body.call1(MathFunction::Saturate, quotient);
        let accept = body.call2(MathFunction::Step, from, x);
        let condition = body.binary(BinaryOperator::Equal, from, to);
        let select = Expression::Select { condition, accept, reject };
        let t = body.compute(select, &[condition, accept, reject]);
        let double = body.binary(BinaryOperator::Multiply, two, t);
        let rest = body.binary(BinaryOperator::Subtract, three, double);
        let square = body.binary(BinaryOperator::Multiply, t, t);
        body.binary(BinaryOperator::Multiply, square, rest)
    }

    fn call3(&mut self, fun: MathFunction, [a, b, c]: [NodeId; 3]) -> Result<Value, Error> {
        let values = [self.value(a)?, self.value(b)?, self.value(c)?];
        Ok(self.body.call3(fun, values))
    }

    /// A number in all lanes of a type.
    pub(super) fn splat(&mut self, ty: Type, number: f32) -> Value {
        let value = self.body.literal(number);
        match types::vector_size(ty) {
            None => value,
            Some(size) => self.body.compute(Expression::Splat { size, value }, &[]),
        }
    }

    /// The order of two limits, as f32.
    fn limits(&self, low: NodeId, high: NodeId) -> Limits {
        let graph = &self.program.graph;
        let (Node::Const(low), Node::Const(high)) = (graph.node(low), graph.node(high)) else {
            let (low, high) = (graph.range(low), graph.range(high));
            return match (low.hi as f32) < (high.lo as f32) {
                true => Limits::Ascending,
                false => Limits::Unknown,
            };
        };
        let pairs = low.lanes().into_iter().zip(high.lanes()).take(low.ty().width());
        let pairs: Vec<_> = pairs.map(|(low, high)| (low as f32, high as f32)).collect();
        if pairs.iter().all(|(low, high)| low < high) {
            Limits::Ascending
        } else if pairs.iter().all(|(low, high)| low > high) {
            Limits::Descending
        } else if pairs.iter().all(|(low, high)| low == high) {
            Limits::Equal
        } else {
            Limits::Unknown
        }
    }
}

/// The order of a lower and an upper limit. WGSL refuses constant limits of `clamp` and
/// `smoothstep` that are out of order, and does not define the result of others.
enum Limits {
    Ascending,
    Equal,
    Descending,
    /// The order depends on the lane, or on values of the frame or the point.
    Unknown,
}

/// Returns true if an operation takes arguments of a type.
fn takes(op: Binary, ty: Type) -> bool {
    match op {
        Binary::Add
        | Binary::Sub
        | Binary::Mul
        | Binary::Div
        | Binary::Rem
        | Binary::Min
        | Binary::Max
        | Binary::Pow
        | Binary::Atan2
        | Binary::Step
        | Binary::Hash
        | Binary::Alternative => ty != Type::Bool,
        Binary::Dot => types::vector_size(ty).is_some(),
        Binary::Cross => ty == Type::Vec3,
        Binary::Lt | Binary::Le => ty == Type::Scalar,
        Binary::Eq | Binary::Ne => matches!(ty, Type::Scalar | Type::Bool),
        Binary::And | Binary::Or => ty == Type::Bool,
    }
}
