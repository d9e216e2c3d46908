//! Flat programs of scalar instructions over a small register file.

use rustc_hash::FxHashMap;

use super::op::Op;
use super::record::Recorder;
use super::scalarise::{Lanes, scalarise};
use super::{FrameValues, Number};
use crate::{FrameInput, Graph, Node, NodeId, reachable, reachable_where};

/// Why nodes cannot be evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TapeError {
    /// The node samples a shape or its material: it must be expanded first.
    Unexpanded(NodeId),
    /// The node is the point of an inner formula, which nothing gives a value.
    InnerPoint(NodeId),
}

impl std::fmt::Display for TapeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unexpanded(id) => write!(f, "node {} is not expanded", id.index()),
            Self::InnerPoint(id) => {
                write!(f, "node {} is the point of an inner formula", id.index())
            }
        }
    }
}

impl std::error::Error for TapeError {}

/// Nodes as scalar instructions, to be run in any domain of [`Number`].
///
/// Values that no point changes come first and run once per frame ([`Tape::prepare`]); the rest runs
/// at each point ([`Evaluator::eval`]) in registers that are taken again after their last use.
/// Lanes and scalar operations that no root needs are dropped.
#[derive(Clone, Debug)]
pub struct Tape {
    /// One value each; an argument is the position of an earlier one.
    pub(super) prelude: Vec<Definition>,
    /// The prelude's values that points need: register i starts with prelude value `kept[i]`.
    pub(super) kept: Vec<u32>,
    pub(super) body: Vec<Instruction>,
    pub(super) registers: usize,
    pub(super) outputs: Vec<Lanes<u32>>,
}

/// An instruction, in registers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instruction {
    pub(super) op: Op,
    pub(super) result: u32,
    pub(super) arguments: [u32; 3],
}

/// A scalar; arguments are positions of earlier ones.
#[derive(Clone, Copy, Debug)]
pub(super) enum Definition {
    Constant(f64),
    Input(FrameInput, usize),
    Point(usize),
    Apply(Op, [u32; 3]),
}

/// Registers that hold the point, after those that hold the prelude's values.
pub(super) const POINT_LANES: usize = 3;

impl Tape {
    /// The tape that computes the roots, in their order.
    ///
    /// # Errors
    /// Where a root depends on anything but operations, per-frame inputs and the outermost point.
    pub fn new(graph: &Graph, roots: &[NodeId]) -> Result<Self, TapeError> {
        Self::record(graph, Recorder::default(), &reachable(graph, roots), roots)
    }

    /// The tape of an operator as a function of what it samples, whatever the point: its samples are read
    /// as params, the first of them at a position. Points are NaN, which intervals take for anything.
    ///
    /// # Errors
    /// Where an input has no meaning, which none is.
    pub fn of_operator(
        graph: &Graph,
        root: NodeId,
        samples: &[NodeId],
        first: u32,
    ) -> Result<Self, TapeError> {
        let params = samples.iter().zip(first..).map(|(&id, param)| (graph.node(id), param));
        let recorder = Recorder::of_operator(params.collect());
        let order = reachable_where(graph, &[root], |id| !samples.contains(&id));
        Self::record(graph, recorder, &order, &[root])
    }

    fn record(
        graph: &Graph,
        mut recorder: Recorder,
        order: &[NodeId],
        roots: &[NodeId],
    ) -> Result<Self, TapeError> {
        let mut lanes: FxHashMap<NodeId, Lanes<u32>> = FxHashMap::default();
        for &id in order {
            let node = graph.node(id);
            let value = scalarise(&mut recorder, &node, |argument| lanes[&argument])
                .ok_or_else(|| unavailable(id, &node))?;
            lanes.insert(id, value);
        }
        let outputs = roots.iter().map(|root| lanes[root]).collect();
        Ok(recorder.finish(outputs))
    }

    /// How many scalar operations run at each point.
    pub fn operations(&self) -> usize {
        self.body.len()
    }

    /// How many registers an evaluator has.
    pub fn registers(&self) -> usize {
        self.registers
    }

    /// An evaluator for a frame. What is known per frame is computed in f64 and then rounded to the
    /// domain, as it is for the shader, whose uniforms hold the rounded values.
    pub fn prepare<N: Number>(&self, frame: &FrameValues) -> Evaluator<'_, N> {
        self.evaluator(frame, N::constant)
    }

    /// An evaluator for all frames whose values lie in the given ones: the per-frame part too
    /// is computed in the domain, such as intervals over the ranges of params.
    pub fn prepare_in<N: Number>(&self, frame: &FrameValues<N>) -> Evaluator<'_, N> {
        self.evaluator(frame, |value| value)
    }

    fn evaluator<F: Number, N: Number>(
        &self,
        frame: &FrameValues<F>,
        convert: impl Fn(F) -> N,
    ) -> Evaluator<'_, N> {
        let mut values: Vec<F> = Vec::with_capacity(self.prelude.len());
        for definition in &self.prelude {
            values.push(match *definition {
                Definition::Constant(value) => F::constant(value),
                Definition::Input(input, lane) => frame.lane(input, lane),
                Definition::Point(_) => F::constant(f64::NAN), // never in a prelude
                Definition::Apply(op, arguments) => op.apply(|i| values[arguments[i] as usize]),
            });
        }
        let zero = N::constant(0.0);
        let mut registers = vec![zero; self.registers];
        for (register, &value) in registers.iter_mut().zip(&self.kept) {
            *register = convert(values[value as usize]);
        }
        Evaluator { tape: self, registers, outputs: vec![[zero; 4]; self.outputs.len()] }
    }
}

/// A tape with its registers, ready for the points of one frame. Evaluating allocates nothing;
/// threads each clone their own.
#[derive(Clone, Debug)]
pub struct Evaluator<'t, N> {
    tape: &'t Tape,
    registers: Vec<N>,
    outputs: Vec<[N; 4]>,
}

impl<N: Number> Evaluator<'_, N> {
    /// The roots' values at a point, in the roots' order; lanes beyond a root's width are 0. For
    /// regions the point's last lane is ignored.
    pub fn eval(&mut self, point: [N; 3]) -> &[[N; 4]] {
        self.run(point);
        for (output, lanes) in self.outputs.iter_mut().zip(&self.tape.outputs) {
            for (place, &register) in output.iter_mut().zip(lanes.as_slice()) {
                *place = self.registers[register as usize];
            }
        }
        &self.outputs
    }

    /// The first lane of the first root at a point; 0 without roots.
    pub fn scalar(&mut self, point: [N; 3]) -> N {
        self.run(point);
        let first = self.tape.outputs.first();
        first.map_or(N::constant(0.0), |lanes| self.registers[lanes.get(0) as usize])
    }

    fn run(&mut self, point: [N; 3]) {
        let registers = self.registers.as_mut_slice();
        let first = self.tape.kept.len();
        registers[first..first + POINT_LANES].copy_from_slice(&point);
        for instruction in &self.tape.body {
            let result = instruction.op.apply(|i| registers[instruction.arguments[i] as usize]);
            registers[instruction.result as usize] = result;
        }
    }
}

fn unavailable(id: NodeId, node: &Node) -> TapeError {
    if matches!(node, Node::Point(..)) {
        TapeError::InnerPoint(id)
    } else {
        TapeError::Unexpanded(id)
    }
}
