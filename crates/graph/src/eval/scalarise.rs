//! Nodes as scalar operations: the one place that says what each node means.
//!
//! What an operation yields is left to a [`Machine`]: folding computes numbers, a tape records instructions.
//! Vectors fall apart into their lanes, so `Splat`, `Compose` and `Swizzle` cost nothing.

use super::op::Op;
use crate::{Binary, Node, NodeId, Ternary, Type, Unary};

/// Receives scalar operations.
pub(crate) trait Machine {
    /// What stands for a scalar.
    type Value: Copy;

    /// The scalar of a constant.
    fn constant(&mut self, value: f64) -> Self::Value;

    /// The scalar that an operation yields; arguments beyond its arity repeat the first.
    fn apply(&mut self, op: Op, arguments: [Self::Value; 3]) -> Self::Value;

    /// The lanes of a node that is no operation on scalars: a point, a per-frame input, a loop, a sample.
    /// `None` if the machine has no such thing.
    fn input(&mut self, node: &Node) -> Option<Lanes<Self::Value>>;
}

/// The scalars of a vector; places beyond the width repeat the first.
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

/// The lanes of a node, given those of its arguments; `None` where the machine lacks an input.
pub(crate) fn scalarise<M: Machine>(
    machine: &mut M,
    node: &Node,
    argument: impl Fn(NodeId) -> Lanes<M::Value>,
) -> Option<Lanes<M::Value>> {
    Some(match *node {
        Node::Const(value) => {
            let lanes = value.lanes();
            Lanes::new(value.ty().width(), |i| machine.constant(lanes[i]))
        }
        Node::Point(..)
        | Node::Frame(..)
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => {
            return machine.input(node);
        }
        Node::Unary(op, a) => unary(machine, op, argument(a)),
        Node::Binary(Binary::Mul, a, b) if a == b => {
            map1(machine, Op::Square, argument(a)) // a tighter interval than two factors
        }
        Node::Binary(Binary::Dot, a, b) if a == b => Lanes::scalar(norm(machine, argument(a))),
        Node::Binary(op, a, b) => binary(machine, op, argument(a), argument(b)),
        Node::Ternary(op, [a, b, c]) => {
            ternary(machine, op, [argument(a), argument(b), argument(c)])
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
                sum_of_products(machine, columns.map(|column| column.get(row)), v)
            })
        }
    })
}

fn unary<M: Machine>(machine: &mut M, op: Unary, a: Lanes<M::Value>) -> Lanes<M::Value> {
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
        Unary::Length => return Lanes::scalar(length(machine, a)),
        Unary::Normalize => {
            let length = length(machine, a);
            return map2(machine, Op::Direction, a, Lanes { values: [length; 4], width: a.width });
        }
    };
    map1(machine, op, a)
}

fn binary<M: Machine>(
    machine: &mut M,
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
        Binary::Dot => return Lanes::scalar(sum_of_products(machine, a.values, b)),
        Binary::Cross => {
            return Lanes::new(Type::Vec3.width(), |i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let left = apply2(machine, Op::Mul, a.get(j), b.get(k));
                let right = apply2(machine, Op::Mul, a.get(k), b.get(j));
                apply2(machine, Op::Sub, left, right)
            });
        }
    };
    map2(machine, op, a, b)
}

fn ternary<M: Machine>(
    machine: &mut M,
    op: Ternary,
    [a, b, c]: [Lanes<M::Value>; 3],
) -> Lanes<M::Value> {
    let op = match op {
        Ternary::Mix => Op::Mix,
        Ternary::Clamp => Op::Clamp,
        Ternary::Smoothstep => Op::Smoothstep,
        Ternary::Select => {
            return Lanes::new(b.width, |i| {
                machine.apply(Op::Select, [a.get(0), b.get(i), c.get(i)])
            });
        }
    };
    Lanes::new(a.width, |i| machine.apply(op, [a.get(i), b.get(i), c.get(i)]))
}

fn map1<M: Machine>(machine: &mut M, op: Op, a: Lanes<M::Value>) -> Lanes<M::Value> {
    Lanes::new(a.width, |i| machine.apply(op, [a.get(i); 3]))
}

fn map2<M: Machine>(
    machine: &mut M,
    op: Op,
    a: Lanes<M::Value>,
    b: Lanes<M::Value>,
) -> Lanes<M::Value> {
    Lanes::new(a.width, |i| apply2(machine, op, a.get(i), b.get(i)))
}

fn apply2<M: Machine>(machine: &mut M, op: Op, a: M::Value, b: M::Value) -> M::Value {
    machine.apply(op, [a, b, a])
}

/// `left[0] * right.x + left[1] * right.y + …`, as wide as the right side.
fn sum_of_products<M: Machine, const N: usize>(
    machine: &mut M,
    left: [M::Value; N],
    right: Lanes<M::Value>,
) -> M::Value {
    let mut sum = apply2(machine, Op::Mul, left[0], right.get(0));
    for (&a, &b) in left.iter().zip(right.as_slice()).skip(1) {
        let product = apply2(machine, Op::Mul, a, b);
        sum = apply2(machine, Op::Add, sum, product);
    }
    sum
}

/// The squared length.
fn norm<M: Machine>(machine: &mut M, a: Lanes<M::Value>) -> M::Value {
    let mut sum = machine.apply(Op::Square, [a.get(0); 3]);
    for i in 1..a.width {
        let square = machine.apply(Op::Square, [a.get(i); 3]);
        sum = apply2(machine, Op::Add, sum, square);
    }
    sum
}

fn length<M: Machine>(machine: &mut M, a: Lanes<M::Value>) -> M::Value {
    let norm = norm(machine, a);
    machine.apply(Op::Sqrt, [norm; 3])
}
