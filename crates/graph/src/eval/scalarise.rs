//! Lowering of nodes to scalar operations: the only place that defines what each node means.
//!
//! A [`ScalarBackend`] receives the operations: folding computes numbers, a tape records
//! instructions. Vectors are split into lanes, so `Splat`, `Compose` and `Swizzle` are free.

use super::op::Op;
use crate::node::{Binary, Node, NodeId, Ternary, Type, Unary};

/// A receiver of scalar operations.
pub(crate) trait ScalarBackend {
    /// A scalar: a number or a register, for example.
    type Value: Copy;

    /// A constant.
    fn constant(&mut self, value: f64) -> Self::Value;

    /// The result of an operation; arguments beyond its arity repeat the first.
    fn apply(&mut self, op: Op, arguments: [Self::Value; 3]) -> Self::Value;

    /// The lanes of a node that is not an operation on scalars: a point, a per-frame input, a loop,
    /// a sample. `None` if the backend has no such input.
    fn input(&mut self, node: &Node) -> Option<Lanes<Self::Value>>;
}

/// The scalars of a vector; entries beyond the width repeat the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes<V> {
    values: [V; 4],
    width: usize,
}

impl<V: Copy> Lanes<V> {
    /// A single scalar.
    pub(crate) fn scalar(value: V) -> Self {
        Self { values: [value; 4], width: 1 }
    }

    /// A vector whose lane i is `lane(i)`.
    pub(crate) fn new(width: usize, mut lane: impl FnMut(usize) -> V) -> Self {
        let mut lanes = Self { values: [lane(0); 4], width };
        for i in 1..width {
            lanes.values[i] = lane(i);
        }
        lanes
    }

    /// One scalar.
    pub(crate) fn get(&self, lane: usize) -> V {
        self.values[lane]
    }

    /// The scalars.
    pub(crate) fn as_slice(&self) -> &[V] {
        &self.values[..self.width]
    }
}

/// The lanes of a node, given the lanes of its arguments; `None` where the backend lacks an input.
pub(crate) fn scalarise<M: ScalarBackend>(
    backend: &mut M,
    node: &Node,
    argument: impl Fn(NodeId) -> Lanes<M::Value>,
) -> Option<Lanes<M::Value>> {
    Some(match *node {
        Node::Const(value) => {
            let lanes = value.lanes();
            Lanes::new(value.ty().width(), |i| backend.constant(lanes[i]))
        }
        Node::Point(..)
        | Node::Frame(..)
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => {
            return backend.input(node);
        }
        Node::Unary(op, a) => unary(backend, op, argument(a)),
        Node::Binary(Binary::Mul, a, b) if a == b => {
            // Gives a tighter interval than the product of two factors.
            map1(backend, Op::Square, argument(a))
        }
        Node::Binary(Binary::Dot, a, b) if a == b => Lanes::scalar(norm(backend, argument(a))),
        Node::Binary(op, a, b) => binary(backend, op, argument(a), argument(b)),
        Node::Ternary(op, [a, b, c]) => {
            ternary(backend, op, [argument(a), argument(b), argument(c)])
        }
        Node::Splat(ty, a) => Lanes::new(ty.width(), |_| argument(a).get(0)),
        Node::Compose(ty, parts) => Lanes::new(ty.width(), |i| argument(parts[i]).get(0)),
        Node::Swizzle(ty, a, from) => {
            let a = argument(a);
            Lanes::new(ty.width(), |i| a.get(usize::from(from[i])))
        }
        Node::Transform(columns, v) => {
            let (columns, v) = (columns.map(&argument), argument(v));
            Lanes::new(Type::Vec3.width(), |row| {
                sum_of_products(backend, columns.map(|column| column.get(row)), v)
            })
        }
    })
}

fn unary<M: ScalarBackend>(backend: &mut M, op: Unary, a: Lanes<M::Value>) -> Lanes<M::Value> {
    let op = match op {
        Unary::Neg => Op::Neg,
        Unary::Abs => Op::Abs,
        Unary::Sign => Op::Sign,
        Unary::Floor => Op::Floor,
        Unary::Ceil => Op::Ceil,
        Unary::Round => Op::Round,
        Unary::Trunc => Op::Trunc,
        Unary::Fract => Op::Fract,
        Unary::Sqrt => Op::Sqrt,
        Unary::InverseSqrt => Op::InverseSqrt,
        Unary::Exp => Op::Exp,
        Unary::Exp2 => Op::Exp2,
        Unary::Log => Op::Log,
        Unary::Log2 => Op::Log2,
        Unary::Sin => Op::Sin,
        Unary::Cos => Op::Cos,
        Unary::Tan => Op::Tan,
        Unary::Asin => Op::Asin,
        Unary::Acos => Op::Acos,
        Unary::Atan => Op::Atan,
        Unary::Sinh => Op::Sinh,
        Unary::Cosh => Op::Cosh,
        Unary::Tanh => Op::Tanh,
        Unary::Saturate => Op::Saturate,
        Unary::Not => Op::Not,
        Unary::Length => return Lanes::scalar(length(backend, a)),
        Unary::Normalize => {
            let length = length(backend, a);
            return map2(
                backend,
                Op::NormalizeLane,
                a,
                Lanes { values: [length; 4], width: a.width },
            );
        }
    };
    map1(backend, op, a)
}

fn binary<M: ScalarBackend>(
    backend: &mut M,
    op: Binary,
    a: Lanes<M::Value>,
    b: Lanes<M::Value>,
) -> Lanes<M::Value> {
    let op = match op {
        Binary::Add => Op::Add,
        Binary::Sub => Op::Sub,
        Binary::Mul => Op::Mul,
        Binary::Div => Op::Div,
        Binary::Rem => Op::Rem,
        Binary::Min => Op::Min,
        Binary::Max => Op::Max,
        Binary::Pow => Op::Pow,
        Binary::Atan2 => Op::Atan2,
        Binary::Step => Op::Step,
        Binary::Hash => Op::Hash,
        Binary::Lt => Op::Lt,
        Binary::Le => Op::Le,
        Binary::Eq => Op::Eq,
        Binary::Ne => Op::Ne,
        Binary::And => Op::And,
        Binary::Or => Op::Or,
        Binary::Alternative => return b,
        Binary::Dot => return Lanes::scalar(sum_of_products(backend, a.values, b)),
        Binary::Cross => {
            return Lanes::new(Type::Vec3.width(), |i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let left = apply2(backend, Op::Mul, a.get(j), b.get(k));
                let right = apply2(backend, Op::Mul, a.get(k), b.get(j));
                apply2(backend, Op::Sub, left, right)
            });
        }
    };
    map2(backend, op, a, b)
}

fn ternary<M: ScalarBackend>(
    backend: &mut M,
    op: Ternary,
    [a, b, c]: [Lanes<M::Value>; 3],
) -> Lanes<M::Value> {
    let op = match op {
        Ternary::Mix => Op::Mix,
        Ternary::Clamp => Op::Clamp,
        Ternary::Smoothstep => Op::Smoothstep,
        Ternary::Select => {
            return Lanes::new(b.width, |i| {
                backend.apply(Op::Select, [a.get(0), b.get(i), c.get(i)])
            });
        }
    };
    Lanes::new(a.width, |i| backend.apply(op, [a.get(i), b.get(i), c.get(i)]))
}

fn map1<M: ScalarBackend>(backend: &mut M, op: Op, a: Lanes<M::Value>) -> Lanes<M::Value> {
    Lanes::new(a.width, |i| backend.apply(op, [a.get(i); 3]))
}

fn map2<M: ScalarBackend>(
    backend: &mut M,
    op: Op,
    a: Lanes<M::Value>,
    b: Lanes<M::Value>,
) -> Lanes<M::Value> {
    Lanes::new(a.width, |i| apply2(backend, op, a.get(i), b.get(i)))
}

fn apply2<M: ScalarBackend>(backend: &mut M, op: Op, a: M::Value, b: M::Value) -> M::Value {
    backend.apply(op, [a, b, a])
}

/// `left[0] * right.x + left[1] * right.y + …`, with as many terms as the right side has lanes.
fn sum_of_products<M: ScalarBackend, const N: usize>(
    backend: &mut M,
    left: [M::Value; N],
    right: Lanes<M::Value>,
) -> M::Value {
    let mut sum = apply2(backend, Op::Mul, left[0], right.get(0));
    for (&a, &b) in left.iter().zip(right.as_slice()).skip(1) {
        let product = apply2(backend, Op::Mul, a, b);
        sum = apply2(backend, Op::Add, sum, product);
    }
    sum
}

/// The squared length.
fn norm<M: ScalarBackend>(backend: &mut M, a: Lanes<M::Value>) -> M::Value {
    let mut sum = backend.apply(Op::Square, [a.get(0); 3]);
    for i in 1..a.width {
        let square = backend.apply(Op::Square, [a.get(i); 3]);
        sum = apply2(backend, Op::Add, sum, square);
    }
    sum
}

fn length<M: ScalarBackend>(backend: &mut M, a: Lanes<M::Value>) -> M::Value {
    let norm = norm(backend, a);
    backend.apply(Op::Sqrt, [norm; 3])
}
