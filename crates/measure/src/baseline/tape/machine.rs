//! The operations of the stack machine, and the translation of nodes to them.

use sdfc_graph::{Binary, Graph, Node, NodeId, Ternary, Unary};

use crate::baseline::Inexpressible;

/// The smallest length by which a vector is divided to normalise it.
const TINY: f64 = 1e-30;

/// The order is that of the shader's codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Operation {
    Point,
    Push,
    Lane,
    Abs,
    Floor,
    Sqrt,
    Sin,
    Cos,
    Length,
    Store,
    Test,
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
    Dot,
    Less,
    Insert,
    Choose,
}

impl Operation {
    /// Returns the number of values that it takes from the stack, and that it pushes.
    pub(super) fn stack_effect(self) -> (usize, usize) {
        match self {
            Self::Point | Self::Push => (0, 1),
            Self::Test => (1, 0),
            Self::Lane
            | Self::Abs
            | Self::Floor
            | Self::Sqrt
            | Self::Sin
            | Self::Cos
            | Self::Length
            | Self::Store => (1, 1),
            Self::Add
            | Self::Sub
            | Self::Mul
            | Self::Div
            | Self::Min
            | Self::Max
            | Self::Dot
            | Self::Less
            | Self::Insert
            | Self::Choose => (2, 1),
        }
    }
}

/// A step of the translation of a node.
#[derive(Clone, Copy)]
pub(super) enum Step {
    Value(NodeId),
    Number(f64),
    Do(Operation, usize),
    /// With its two operands swapped.
    DoReversed(Operation, usize),
    /// The topmost value is this node.
    Store(NodeId),
}

/// Returns the steps that compute a node.
pub(super) fn steps(graph: &Graph, id: NodeId) -> Result<Vec<Step>, Inexpressible> {
    use Step::{Do, Value};
    let node = graph.node(id);
    Ok(match node {
        Node::Point(..) => vec![Do(Operation::Point, 0)],
        Node::Unary(op, a) => unary(op, a, graph.ty(a).width())?,
        Node::Binary(op, a, b) => binary(op, a, b, graph.ty(a).width())?,
        Node::Ternary(op, arguments) => ternary(op, arguments)?,
        Node::Splat(_, a) => vec![Value(a)],
        Node::Compose(ty, parts) => {
            let mut steps = vec![Value(parts[0])];
            for (lane, &part) in parts.iter().enumerate().take(ty.width()).skip(1) {
                steps.extend([Value(part), Do(Operation::Insert, lane)]);
            }
            steps
        }
        Node::Swizzle(ty, a, from) => {
            let lane = |index: usize| [Value(a), Do(Operation::Lane, usize::from(from[index]))];
            let mut steps = lane(0).to_vec();
            for index in 1..ty.width() {
                steps.extend(lane(index));
                steps.push(Do(Operation::Insert, index));
            }
            steps
        }
        Node::Transform(columns, v) => {
            let mut steps = Vec::new();
            for (lane, column) in columns.into_iter().enumerate() {
                steps.extend([Value(v), Do(Operation::Lane, lane), Value(column)]);
                steps.push(Do(Operation::Mul, 0));
                if lane > 0 {
                    steps.push(Do(Operation::Add, 0));
                }
            }
            steps
        }
        Node::Const(_)
        | Node::Frame(..)
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => {
            return Err(lacks(&node));
        }
    })
}

fn unary(op: Unary, a: NodeId, width: usize) -> Result<Vec<Step>, Inexpressible> {
    use Step::{Do, Number, Value};
    let one = |operation| vec![Value(a), Do(operation, 0)];
    let of_number = |operation| if width == 1 { Ok(one(operation)) } else { Err(lacks(&op)) };
    Ok(match op {
        Unary::Neg => vec![Value(a), Number(-1.0), Do(Operation::Mul, 0)],
        Unary::Abs => one(Operation::Abs),
        Unary::Floor => one(Operation::Floor),
        Unary::Fract => {
            vec![Value(a), Value(a), Do(Operation::Floor, 0), Do(Operation::Sub, 0)]
        }
        Unary::Sqrt => of_number(Operation::Sqrt)?,
        Unary::InverseSqrt if width == 1 => {
            vec![Number(1.0), Value(a), Do(Operation::Sqrt, 0), Do(Operation::Div, 0)]
        }
        Unary::Sin => of_number(Operation::Sin)?,
        Unary::Cos => of_number(Operation::Cos)?,
        Unary::Saturate => {
            vec![Value(a), Number(0.0), Do(Operation::Max, 0), Number(1.0), Do(Operation::Min, 0)]
        }
        Unary::Length => vec![Value(a), Do(Operation::Length, width)],
        Unary::Normalize => vec![
            Value(a),
            Value(a),
            Do(Operation::Length, width),
            Number(TINY),
            Do(Operation::Max, 0),
            Do(Operation::Div, 0),
        ],
        Unary::Not => vec![Number(1.0), Value(a), Do(Operation::Sub, 0)],
        Unary::InverseSqrt
        | Unary::Sign
        | Unary::Ceil
        | Unary::Round
        | Unary::Trunc
        | Unary::Exp
        | Unary::Exp2
        | Unary::Log
        | Unary::Log2
        | Unary::Tan
        | Unary::Asin
        | Unary::Acos
        | Unary::Atan
        | Unary::Sinh
        | Unary::Cosh
        | Unary::Tanh => return Err(lacks(&op)),
    })
}

fn binary(op: Binary, a: NodeId, b: NodeId, width: usize) -> Result<Vec<Step>, Inexpressible> {
    use Step::{Do, Number, Value};
    let both = |operation, index| vec![Value(a), Value(b), Do(operation, index)];
    // 1 if a number is not below another, otherwise 0.
    let not_less = |a, b| {
        let (less, sub) = (Do(Operation::Less, 0), Do(Operation::Sub, 0));
        vec![Number(1.0), Value(a), Value(b), less, sub]
    };
    Ok(match op {
        Binary::Add => both(Operation::Add, 0),
        Binary::Sub => both(Operation::Sub, 0),
        Binary::Mul | Binary::And => both(Operation::Mul, 0),
        Binary::Div => both(Operation::Div, 0),
        Binary::Rem => vec![
            Value(a),
            Value(a),
            Value(b),
            Do(Operation::Div, 0),
            Do(Operation::Floor, 0),
            Value(b),
            Do(Operation::Mul, 0),
            Do(Operation::Sub, 0),
        ],
        Binary::Alternative => vec![Value(b)],
        Binary::Min => both(Operation::Min, 0),
        Binary::Max | Binary::Or => both(Operation::Max, 0),
        Binary::Step => not_less(b, a),
        Binary::Dot => both(Operation::Dot, width),
        Binary::Lt => both(Operation::Less, 0),
        Binary::Le => not_less(b, a),
        Binary::Pow | Binary::Atan2 | Binary::Hash | Binary::Cross | Binary::Eq | Binary::Ne => {
            return Err(lacks(&op));
        }
    })
}

fn ternary(op: Ternary, [a, b, c]: [NodeId; 3]) -> Result<Vec<Step>, Inexpressible> {
    use Step::{Do, Value};
    let (add, sub, mul) = (Do(Operation::Add, 0), Do(Operation::Sub, 0), Do(Operation::Mul, 0));
    Ok(match op {
        Ternary::Mix => vec![Value(b), Value(a), sub, Value(c), mul, Value(a), add],
        Ternary::Clamp => {
            let (max, min) = (Do(Operation::Max, 0), Do(Operation::Min, 0));
            vec![Value(a), Value(b), max, Value(c), min]
        }
        Ternary::Select => {
            let (test, choose) = (Do(Operation::Test, 0), Do(Operation::Choose, 0));
            vec![Value(b), Value(c), Value(a), test, choose]
        }
        Ternary::Smoothstep => return Err(lacks(&op)),
    })
}

fn lacks(operation: &dyn std::fmt::Debug) -> Inexpressible {
    let name = format!("{operation:?}").to_lowercase();
    Inexpressible(format!("the tape's machine has no `{name}`"))
}
