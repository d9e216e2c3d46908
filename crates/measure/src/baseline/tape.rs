//! Encodes a scene's field as a tape for the stack machine of `baseline/tape.wgsl`.
//!
//! A value is computed where it is first used. A value that is used again is also stored in a local
//! until its last use. The operand that needs more of the stack is computed first, so that a long
//! chain needs no more stack than a short one. Per-frame values are constants of the tape.

mod machine;

use std::collections::BTreeMap;

use sdfc_graph::eval::{FrameValues, evaluate_frame};
use sdfc_graph::{Graph, Node, NodeId, Program, Stage, Type, reachable_where};

use self::machine::{Operation, Step, steps};
use super::{Bytes, Encoded, Inexpressible};

/// Size of the stack and number of locals, as in the shader.
const STACK_SIZE: usize = 16;
const LOCAL_COUNT: usize = 16;

/// Returns the table of a program's distance at a frame. `leaves` is the scene's number of leaves.
///
/// # Errors
///
/// [`Inexpressible`] names the first operation that the machine lacks, or says that the stack is
/// too small.
pub fn tape(
    program: &Program,
    leaves: usize,
    frame: &FrameValues,
) -> Result<Encoded, Inexpressible> {
    let nothing = || Inexpressible("the scene draws nothing".to_owned());
    let root = program.distance.ok_or_else(nothing)?;
    let mut encoder = Encoder::new(&program.graph, root, frame)?;
    encoder.compute(root)?;
    let mut bytes = Bytes::default();
    for Instruction { operation, index, operand, reversed } in &encoder.code {
        let (source, constant) = match *operand {
            Operand::Stack => (0, [0.0; 4]),
            Operand::Constant(value) => (1, value),
            Operand::Local(local) => (2 + local, [0.0; 4]),
        };
        bytes.words(&[*operation as u32, *index as u32, source as u32, u32::from(*reversed)]);
        bytes.floats(&constant);
    }
    Ok(Encoded { tables: vec![bytes.0], iterations: encoder.code.len(), leaves })
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Instruction {
    operation: Operation,
    /// A lane, or a number of lanes.
    index: usize,
    operand: Operand,
    /// True if the operands are swapped.
    reversed: bool,
}

/// The second operand of an instruction, or its only one if it takes none from the stack.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Operand {
    Stack,
    Constant([f32; 4]),
    Local(usize),
}

struct Encoder<'a> {
    graph: &'a Graph,
    /// The values that do not depend on the point.
    constants: BTreeMap<NodeId, [f32; 4]>,
    /// Remaining uses of each value that depends on the point.
    uses: BTreeMap<NodeId, usize>,
    /// Number of stack entries that each of these values needs while it is computed.
    stack_sizes: BTreeMap<NodeId, usize>,
    locals: BTreeMap<NodeId, usize>,
    taken: [bool; LOCAL_COUNT],
    depth: usize,
    code: Vec<Instruction>,
}

impl<'a> Encoder<'a> {
    fn new(graph: &'a Graph, root: NodeId, frame: &FrameValues) -> Result<Self, Inexpressible> {
        let varies = |id: NodeId| graph.stage(id) == Stage::Point;
        let reached = reachable_where(graph, &[root], varies);
        let (varying, constants): (Vec<NodeId>, Vec<NodeId>) =
            reached.into_iter().partition(|&id| varies(id));
        let values = evaluate_frame(graph, &constants, frame);
        let constants =
            constants.iter().zip(values).map(|(&id, lanes)| (id, packed(graph.ty(id), lanes)));
        let mut encoder = Self {
            graph,
            constants: constants.collect(),
            uses: BTreeMap::from([(root, 1)]),
            stack_sizes: BTreeMap::new(),
            locals: BTreeMap::new(),
            taken: [false; LOCAL_COUNT],
            depth: 0,
            code: Vec::new(),
        };
        // Ids ascend from arguments to the nodes that use them.
        for id in varying {
            let steps = encoder.expansion(id)?;
            encoder.stack_sizes.insert(id, encoder.stack_size_of_steps(&steps));
            for step in steps {
                if let Step::Value(argument) = step {
                    *encoder.uses.entry(argument).or_default() += 1;
                }
            }
        }
        Ok(encoder)
    }

    /// Returns the steps of a node that depends on the point.
    fn expansion(&self, id: NodeId) -> Result<Vec<Step>, Inexpressible> {
        let mut steps = steps(self.graph, id)?;
        if let [Step::Value(a), Step::Value(b), Step::Do(operation, index)] = steps[..]
            && self.stack_size(b) > self.stack_size(a)
        {
            let reversed = Step::DoReversed(operation, index);
            steps = vec![Step::Value(b), Step::Value(a), reversed];
        }
        Ok(steps)
    }

    /// Returns the number of stack entries that a value needs while it is computed. A constant or a
    /// local needs none as a second operand.
    fn stack_size(&self, id: NodeId) -> usize {
        let is_available = self.constants.contains_key(&id) || self.locals.contains_key(&id);
        if is_available { 0 } else { self.stack_sizes.get(&id).copied().unwrap_or(1) }
    }

    /// Returns the number of stack entries that steps need, including their arguments.
    fn stack_size_of_steps(&self, steps: &[Step]) -> usize {
        let (mut depth, mut most) = (0, 0);
        for step in steps {
            let (taken, put, within) = match *step {
                Step::Value(id) => (0, 1, self.stack_size(id).max(1)),
                Step::Number(_) => (0, 1, 1),
                Step::Do(operation, _) | Step::DoReversed(operation, _) => {
                    let (taken, put) = operation.stack_effect();
                    (taken, put, put)
                }
                Step::Store(_) => (0, 0, 0),
            };
            most = most.max(depth + within);
            depth = (depth + put).saturating_sub(taken);
        }
        most
    }

    /// Pushes a value on the stack.
    fn compute(&mut self, id: NodeId) -> Result<(), Inexpressible> {
        let mut todo = vec![Step::Value(id)];
        while let Some(step) = todo.pop() {
            match step {
                Step::Number(value) => self.push(Operand::Constant([value as f32; 4]))?,
                Step::Do(operation, index) => self.emit(operation, index, false)?,
                Step::DoReversed(operation, index) => self.emit(operation, index, true)?,
                Step::Store(id) => self.store(id)?,
                Step::Value(id) => match (self.constants.get(&id), self.locals.get(&id)) {
                    (Some(&value), _) => self.push(Operand::Constant(value))?,
                    (None, Some(&local)) => {
                        self.push(Operand::Local(local))?;
                        self.taken[local] = self.is_used_again(id);
                    }
                    (None, None) => {
                        todo.push(Step::Store(id));
                        todo.extend(self.expansion(id)?.into_iter().rev());
                    }
                },
            }
        }
        Ok(())
    }

    /// Counts one use of a value. Returns true if more uses follow.
    fn is_used_again(&mut self, id: NodeId) -> bool {
        let uses = self.uses.entry(id).or_default();
        *uses = uses.saturating_sub(1);
        *uses > 0
    }

    /// Copies the topmost value to a local if it is used again. The point is not copied: it has an
    /// instruction of its own.
    fn store(&mut self, id: NodeId) -> Result<(), Inexpressible> {
        if !self.is_used_again(id) || matches!(self.graph.node(id), Node::Point(..)) {
            return Ok(());
        }
        let free = self.taken.iter().position(|taken| !taken).ok_or_else(|| {
            Inexpressible(format!("more than {LOCAL_COUNT} values of the tape wait for their uses"))
        })?;
        self.taken[free] = true;
        self.locals.insert(id, free);
        self.write(Operation::Store, 0, Operand::Local(free), false);
        Ok(())
    }

    /// Pushes a constant or a local on the stack.
    fn push(&mut self, operand: Operand) -> Result<(), Inexpressible> {
        self.grow_stack(1)?;
        self.write(Operation::Push, 0, operand, false);
        Ok(())
    }

    fn emit(
        &mut self,
        operation: Operation,
        index: usize,
        reversed: bool,
    ) -> Result<(), Inexpressible> {
        let (taken, put) = operation.stack_effect();
        self.depth = self.depth.saturating_sub(taken);
        self.grow_stack(put)?;
        let mut operand = Operand::Stack;
        if let Some(last) = self.code.last()
            && taken > 1
            && last.operation == Operation::Push
        {
            operand = last.operand;
            self.code.pop();
        }
        self.write(operation, index, operand, reversed);
        Ok(())
    }

    fn write(&mut self, operation: Operation, index: usize, operand: Operand, reversed: bool) {
        self.code.push(Instruction { operation, index, operand, reversed });
    }

    fn grow_stack(&mut self, by: usize) -> Result<(), Inexpressible> {
        self.depth += by;
        if self.depth > STACK_SIZE {
            let message = format!("the tape needs a stack of more than {STACK_SIZE} values");
            return Err(Inexpressible(message));
        }
        Ok(())
    }
}

/// Returns a value in the layout of the machine, which repeats a number in all lanes.
fn packed(ty: Type, lanes: [f64; 4]) -> [f32; 4] {
    match ty {
        Type::Bool | Type::Scalar => [lanes[0] as f32; 4],
        Type::Vec2 | Type::Vec3 | Type::Vec4 => lanes.map(|lane| lane as f32),
    }
}
