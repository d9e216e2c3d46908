//! A scene's field as a tape for the stack machine of `baseline/tape.wgsl`.
//!
//! Values that are used more than once are computed first, each on an empty stack, and wait in locals; what
//! lies deepest comes first, so that a long chain keeps few of them waiting. What is known per frame is a
//! constant of the tape.

use std::collections::{BTreeMap, BTreeSet};

use sdfc_graph::eval::{FrameValues, evaluate_frame};
use sdfc_graph::{
    Binary, Graph, Node, NodeId, Program, Stage, Ternary, Type, Unary, reachable_where,
};

use super::{Bytes, Encoded, Inexpressible};

/// Most values on the stack, and in locals, at a time: what the shader has room for.
const STACK_SIZE: usize = 16;
const LOCAL_COUNT: usize = 16;
/// A length below this is taken for it where a vector is divided by its own.
const TINY: f64 = 1e-30;

/// The table of a program's distance at a frame. `leaves` is how many leaves the scene has.
///
/// # Errors
///
/// [`Inexpressible`] names the first operation that the machine lacks, or says that it has too little room.
pub fn tape(
    program: &Program,
    leaves: usize,
    frame: &FrameValues,
) -> Result<Encoded, Inexpressible> {
    let nothing = || Inexpressible("the scene draws nothing".to_owned());
    let root = program.distance.ok_or_else(nothing)?;
    let graph = &program.graph;
    let mut encoder = Encoder::new(graph, root, frame)?;
    for id in encoder.schedule(root)? {
        encoder.compute(id)?;
        if id != root {
            encoder.store(id)?;
        }
    }
    let mut bytes = Bytes::default();
    for Instruction { operation, index, constant } in &encoder.code {
        let immediate = u32::from(constant.is_some() && *operation != Operation::Constant);
        bytes.words(&[*operation as u32, *index as u32, immediate, 0]);
        bytes.floats(&constant.unwrap_or_default());
    }
    Ok(Encoded { tables: vec![bytes.0], turns: encoder.code.len(), leaves })
}

/// In the order of the shader's codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Operation {
    Point,
    Constant,
    Load,
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
    /// Values that it takes from the stack, and puts there.
    fn traffic(self) -> (usize, usize) {
        match self {
            Self::Point | Self::Constant | Self::Load => (0, 1),
            Self::Store | Self::Test => (1, 0),
            Self::Lane
            | Self::Abs
            | Self::Floor
            | Self::Sqrt
            | Self::Sin
            | Self::Cos
            | Self::Length => (1, 1),
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

#[derive(Clone, Copy, Debug, PartialEq)]
struct Instruction {
    operation: Operation,
    index: usize,
    /// What `Constant` pushes; of a binary operation, its second operand; of `Store`, that the value stays.
    constant: Option<[f32; 4]>,
}

/// Part of what a node means to the machine.
#[derive(Clone, Copy)]
enum Step {
    Value(NodeId),
    Number(f64),
    Do(Operation, usize),
}

struct Encoder<'a> {
    graph: &'a Graph,
    /// What does not depend on the point.
    known: BTreeMap<NodeId, [f32; 4]>,
    /// How often each value that depends on the point is still to be used.
    uses: BTreeMap<NodeId, usize>,
    locals: BTreeMap<NodeId, usize>,
    taken: [bool; LOCAL_COUNT],
    depth: usize,
    code: Vec<Instruction>,
}

impl<'a> Encoder<'a> {
    fn new(graph: &'a Graph, root: NodeId, frame: &FrameValues) -> Result<Self, Inexpressible> {
        let varies = |id: NodeId| graph.stage(id) == Stage::Point;
        let reached = reachable_where(graph, &[root], varies);
        let known: Vec<NodeId> = reached.iter().copied().filter(|&id| !varies(id)).collect();
        let values = evaluate_frame(graph, &known, frame);
        let known = known.iter().zip(values).map(|(&id, lanes)| (id, packed(graph.ty(id), lanes)));
        let mut encoder = Self {
            graph,
            known: known.collect(),
            uses: BTreeMap::from([(root, 1)]),
            locals: BTreeMap::new(),
            taken: [false; LOCAL_COUNT],
            depth: 0,
            code: Vec::new(),
        };
        for id in reached {
            for argument in encoder.arguments(id)? {
                *encoder.uses.entry(argument).or_default() += 1;
            }
        }
        Ok(encoder)
    }

    /// The values that a node is computed from, as often as each is used; those known without a point left out.
    fn arguments(&self, id: NodeId) -> Result<Vec<NodeId>, Inexpressible> {
        if self.known.contains_key(&id) {
            return Ok(Vec::new());
        }
        let arguments = steps(self.graph, id)?.into_iter().filter_map(|step| match step {
            Step::Value(argument) => Some(argument),
            Step::Number(_) | Step::Do(..) => None,
        });
        Ok(arguments.filter(|argument| !self.known.contains_key(argument)).collect())
    }

    /// Whether a value waits in a local. The point does not: it has an instruction of its own.
    fn is_kept(&self, id: NodeId) -> bool {
        let used = self.uses.get(&id).copied().unwrap_or(0);
        used > 1 && !matches!(self.graph.node(id), Node::Point(..))
    }

    /// Kept values, each after those that it is computed from, then the root.
    fn schedule(&self, root: NodeId) -> Result<Vec<NodeId>, Inexpressible> {
        // Ids ascend from arguments to what uses them.
        let mut heights: BTreeMap<NodeId, usize> = BTreeMap::new();
        for &id in self.uses.keys() {
            let arguments = self.arguments(id)?;
            let below = arguments.iter().filter_map(|argument| heights.get(argument)).max();
            heights.insert(id, below.map_or(0, |height| height + 1));
        }
        let (mut entered, mut order) = (BTreeSet::new(), Vec::new());
        let mut finished = BTreeSet::new();
        let mut todo = vec![root];
        while let Some(&id) = todo.last() {
            if entered.insert(id) {
                let mut arguments = self.arguments(id)?;
                // The last one is taken first.
                arguments.sort_by_key(|argument| heights.get(argument));
                todo.extend(arguments.into_iter().filter(|id| !entered.contains(id)));
                continue;
            }
            todo.pop();
            if finished.insert(id) && (self.is_kept(id) || id == root) {
                order.push(id);
            }
        }
        Ok(order)
    }

    /// Leaves a value on the stack; those that it is computed from and that are kept wait in locals.
    fn compute(&mut self, id: NodeId) -> Result<(), Inexpressible> {
        let mut todo: Vec<Step> = self.expansion(id)?;
        todo.reverse();
        while let Some(step) = todo.pop() {
            match step {
                Step::Number(value) => {
                    self.emit(Operation::Constant, 0, Some([value as f32; 4]))?
                }
                Step::Do(operation, index) => self.emit(operation, index, None)?,
                Step::Value(id) => match (self.known.get(&id), self.locals.get(&id)) {
                    (Some(&value), _) => self.emit(Operation::Constant, 0, Some(value))?,
                    (None, Some(&local)) => self.load(id, local)?,
                    (None, None) => todo.extend(self.expansion(id)?.into_iter().rev()),
                },
            }
        }
        Ok(())
    }

    /// The steps of a node; of one that is known, its value.
    fn expansion(&self, id: NodeId) -> Result<Vec<Step>, Inexpressible> {
        if self.known.contains_key(&id) {
            return Ok(vec![Step::Value(id)]);
        }
        steps(self.graph, id)
    }

    fn store(&mut self, id: NodeId) -> Result<(), Inexpressible> {
        let free = self.taken.iter().position(|taken| !taken).ok_or_else(|| {
            Inexpressible(format!("more than {LOCAL_COUNT} values of the tape wait for their uses"))
        })?;
        self.taken[free] = true;
        self.locals.insert(id, free);
        self.emit(Operation::Store, free, None)
    }

    fn load(&mut self, id: NodeId, local: usize) -> Result<(), Inexpressible> {
        if let Some(uses) = self.uses.get_mut(&id) {
            *uses -= 1;
            self.taken[local] = *uses > 0;
        }
        self.emit(Operation::Load, local, None)
    }

    fn emit(
        &mut self,
        operation: Operation,
        index: usize,
        constant: Option<[f32; 4]>,
    ) -> Result<(), Inexpressible> {
        let (taken, put) = operation.traffic();
        self.depth = (self.depth + put).saturating_sub(taken);
        if self.depth > STACK_SIZE {
            let message = format!("the tape needs a stack of more than {STACK_SIZE} values");
            return Err(Inexpressible(message));
        }
        let mut constant = constant;
        if let Some(last) = self.code.last_mut() {
            let stored = Instruction { operation: Operation::Store, index, constant: None };
            if operation == Operation::Load && *last == stored {
                // What is stored stays on the stack.
                last.constant = Some([0.0; 4]);
                return Ok(());
            }
            if taken > 1 && last.operation == Operation::Constant {
                constant = last.constant;
                self.code.pop();
            }
        }
        self.code.push(Instruction { operation, index, constant });
        Ok(())
    }
}

/// As the machine holds it: a number in all lanes.
fn packed(ty: Type, lanes: [f64; 4]) -> [f32; 4] {
    match ty {
        Type::Bool | Type::Scalar => [lanes[0] as f32; 4],
        Type::Vec2 | Type::Vec3 | Type::Vec4 => lanes.map(|lane| lane as f32),
    }
}

/// A node in the machine's operations.
fn steps(graph: &Graph, id: NodeId) -> Result<Vec<Step>, Inexpressible> {
    use Step::{Do, Value};
    let node = graph.node(id);
    Ok(match node {
        Node::Point(..) => vec![Do(Operation::Point, 0)],
        Node::Unary(op, a) => unary(op, a, graph.ty(a).width())?,
        Node::Binary(op, a, b) => {
            // A constant is best the second operand, where it costs no instruction.
            let swap = graph.stage(a) != Stage::Point && is_symmetric(op);
            let (a, b) = if swap { (b, a) } else { (a, b) };
            binary(op, a, b, graph.ty(a).width())?
        }
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
        Node::Const(_) | Node::Frame(..) | Node::Sample(..) | Node::MaterialAt(..) => {
            return Err(lacks(&node));
        }
    })
}

fn is_symmetric(op: Binary) -> bool {
    matches!(op, Binary::Add | Binary::Mul | Binary::Min | Binary::Max | Binary::Dot)
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
    // 1 where a number is not below another.
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
        Binary::Min => both(Operation::Min, 0),
        Binary::Max | Binary::Or => both(Operation::Max, 0),
        Binary::Step => not_less(b, a),
        Binary::Dot => both(Operation::Dot, width),
        Binary::Lt => both(Operation::Less, 0),
        Binary::Le => not_less(b, a),
        Binary::Pow | Binary::Atan2 | Binary::Cross | Binary::Eq | Binary::Ne => {
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
