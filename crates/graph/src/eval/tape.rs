//! Flat programs of scalar instructions over a small register file.

use rustc_hash::FxHashMap;

use super::op::Op;
use super::record::Recorder;
use super::scalarise::{Lanes, scalarise};
use super::watch::{Unwatched, Watch};
use super::{FrameValues, Interval, Number, Path};
use crate::ids::IdSet;
use crate::{FrameInput, Graph, LoopId, Node, NodeId, Place, reachable, reachable_where};

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
    pub(super) body: Vec<Code>,
    pub(super) lists: Vec<Vec<f64>>,
    pub(super) registers: usize,
    pub(super) outputs: Vec<Lanes<u32>>,
}

/// What runs at a point.
#[derive(Clone, Debug)]
pub(super) enum Code {
    /// One instruction after the other.
    Straight(Vec<Instruction>),
    /// One that jumps.
    Jump(Instruction),
    /// Looks up an element of a list.
    Lookup {
        list: usize,
        at: u32,
        result: u32,
    },
    /// Ends the rounds of the loop that it stands in where the register holds false.
    Test(u32),
    Loop(LoopCode),
}

/// A loop, in registers.
#[derive(Clone, Debug)]
pub(super) struct LoopCode {
    pub(super) cap: u32,
    pub(super) count: Option<u32>,
    pub(super) round: u32,
    pub(super) state: Vec<StateCode>,
    pub(super) body: Vec<Code>,
}

/// One scalar of a loop's state, in registers.
#[derive(Clone, Copy, Debug)]
pub(super) struct StateCode {
    pub(super) start: u32,
    /// What the body reads.
    pub(super) variable: u32,
    /// What the body yields.
    pub(super) next: u32,
    /// Where `next` waits until all variables may change.
    pub(super) copy: u32,
    /// The variable as it was when the loop ended.
    pub(super) result: u32,
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
    /// An element of a list, by the list's position in the recorder.
    Lookup(usize, u32),
    /// The begin of a loop, its condition, its end; by the position of the loop in the recorder.
    Enter(usize),
    Test(usize),
    Leave(usize),
    /// A register that a loop writes.
    Register,
}

/// Registers that hold a point, after those that hold the prelude's values.
pub(super) const POINT_LANES: usize = 3;

impl Tape {
    /// The tape that computes the roots, in their order.
    ///
    /// # Errors
    /// Where a root depends on anything but operations, per-frame inputs and the outermost point.
    pub fn new(graph: &Graph, roots: &[NodeId]) -> Result<Self, TapeError> {
        Self::record(graph, Recorder::default(), &reachable(graph, roots), roots)
    }

    /// The tape that computes functions of a ray: the outermost point is its origin, that of level 1 its direction.
    ///
    /// # Errors
    /// Where a root depends on anything but operations, per-frame inputs and these.
    pub fn of_rays(graph: &Graph, roots: &[NodeId]) -> Result<Self, TapeError> {
        Self::record(graph, Recorder::of_levels(2), &reachable(graph, roots), roots)
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
        let inputs: IdSet = samples.iter().copied().collect();
        let order = reachable_where(graph, &[root], |id| !inputs.contains(id));
        Self::record(graph, recorder, &order, &[root])
    }

    fn record(
        graph: &Graph,
        mut recorder: Recorder,
        order: &[NodeId],
        roots: &[NodeId],
    ) -> Result<Self, TapeError> {
        let outside = order.iter().copied().filter(|&id| graph.loops(id) == 0);
        let mut recording = Recording::new(graph, &mut recorder);
        recording.nodes(outside)?;
        let outputs = roots.iter().map(|root| recording.lanes[root]).collect();
        Ok(recorder.finish(outputs))
    }

    /// How many scalar operations run at each point, if all loops run as often as they may.
    pub fn operations(&self) -> usize {
        operations(&self.body)
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
                Definition::Lookup(list, at) => values[at as usize].element(&self.lists[list]),
                // Loops run at points.
                Definition::Enter(_)
                | Definition::Test(_)
                | Definition::Leave(_)
                | Definition::Register => F::constant(f64::NAN),
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
        self.run(&[point], &mut Unwatched);
        self.read()
    }

    /// As [`Self::eval`], of a tape of [`Tape::of_rays`].
    pub fn eval_ray(&mut self, origin: [N; 3], direction: [N; 3]) -> &[[N; 4]] {
        self.run(&[origin, direction], &mut Unwatched);
        self.read()
    }

    fn read(&mut self) -> &[[N; 4]] {
        for (output, lanes) in self.outputs.iter_mut().zip(&self.tape.outputs) {
            for (place, &register) in output.iter_mut().zip(lanes.as_slice()) {
                *place = self.registers[register as usize];
            }
        }
        &self.outputs
    }

    /// The first lane of the first root at a point; 0 without roots.
    pub fn scalar(&mut self, point: [N; 3]) -> N {
        self.run(&[point], &mut Unwatched);
        self.first()
    }

    fn first(&self) -> N {
        let first = self.tape.outputs.first();
        first.map_or(N::constant(0.0), |lanes| self.registers[lanes.get(0) as usize])
    }

    fn run(&mut self, points: &[[N; POINT_LANES]], watch: &mut impl Watch<N>) {
        let registers = self.registers.as_mut_slice();
        let lanes = registers[self.tape.kept.len()..].iter_mut();
        for (register, &lane) in lanes.zip(points.as_flattened()) {
            *register = lane;
        }
        for code in &self.tape.body {
            code.run(registers, &self.tape.lists, watch);
        }
    }
}

impl Evaluator<'_, Interval> {
    /// The first lane of the first root over a box, on a path through its jumps. The path learns what it leaves open.
    pub fn scalar_along(&mut self, point: [Interval; 3], path: &mut Path) -> Interval {
        path.begin();
        self.run(&[point], &mut { path });
        self.first()
    }
}

impl Code {
    /// The condition, of a test.
    fn run<N: Number>(
        &self,
        registers: &mut [N],
        lists: &[Vec<f64>],
        watch: &mut impl Watch<N>,
    ) -> Option<N> {
        match self {
            Self::Straight(instructions) => {
                for instruction in instructions {
                    let result =
                        instruction.op.apply(|i| registers[instruction.arguments[i] as usize]);
                    registers[instruction.result as usize] = result;
                }
            }
            Self::Jump(Instruction { op, result, arguments }) => {
                let arguments = arguments.map(|argument| registers[argument as usize]);
                let value = op.apply(|i| arguments[i]);
                registers[*result as usize] = watch.jumped(*op, arguments, value);
            }
            Self::Lookup { list, at, result } => {
                registers[*result as usize] = registers[*at as usize].element(&lists[*list]);
            }
            Self::Test(condition) => return Some(registers[*condition as usize]),
            Self::Loop(code) => code.run(registers, lists, watch),
        }
        None
    }
}

impl LoopCode {
    /// Runs rounds until none can follow. Where a domain cannot tell whether one does, the variables go on and the
    /// result is both what they were and what they become.
    fn run<N: Number>(&self, registers: &mut [N], lists: &[Vec<f64>], watch: &mut impl Watch<N>) {
        for state in &self.state {
            let start = registers[state.start as usize];
            registers[state.variable as usize] = start;
            registers[state.result as usize] = start;
        }
        let mut running = N::constant(1.0);
        for round in 0..self.cap {
            let round = N::constant(f64::from(round));
            registers[self.round as usize] = round;
            if let Some(count) = self.count {
                running = running.and(round.lt(registers[count as usize]));
                if running.is_never() {
                    return;
                }
            }
            for code in &self.body {
                if let Some(condition) = code.run(registers, lists, watch) {
                    running = running.and(condition);
                    if running.is_never() {
                        return;
                    }
                }
            }
            for state in &self.state {
                registers[state.copy as usize] = registers[state.next as usize];
            }
            for state in &self.state {
                let next = registers[state.copy as usize];
                registers[state.variable as usize] = next;
                let before = registers[state.result as usize];
                registers[state.result as usize] = running.select(next, before);
            }
        }
    }
}

fn operations(body: &[Code]) -> usize {
    let of = |code: &Code| match code {
        Code::Straight(instructions) => instructions.len(),
        Code::Jump(_) | Code::Lookup { .. } | Code::Test(_) => 1,
        Code::Loop(code) => (code.cap as usize).saturating_mul(operations(&code.body) + 1),
    };
    body.iter().map(of).fold(0, usize::saturating_add)
}

/// Nodes on their way into a recorder.
struct Recording<'a> {
    graph: &'a Graph,
    recorder: &'a mut Recorder,
    lanes: FxHashMap<NodeId, Lanes<u32>>,
    /// The states after the loops met so far.
    loops: FxHashMap<LoopId, Vec<Lanes<u32>>>,
}

impl<'a> Recording<'a> {
    fn new(graph: &'a Graph, recorder: &'a mut Recorder) -> Self {
        Self { graph, recorder, lanes: FxHashMap::default(), loops: FxHashMap::default() }
    }

    fn nodes(&mut self, order: impl Iterator<Item = NodeId>) -> Result<(), TapeError> {
        for id in order {
            let node = self.graph.node(id);
            let value = match node {
                Node::Loop(repeated, position, _) => {
                    self.repeat(repeated)?;
                    self.loops[&repeated][usize::from(position)]
                }
                Node::Element(table, at, ty) => {
                    let (at, table) = (self.lanes[&at].get(0), self.graph.table(table));
                    Lanes::new(ty.width(), |lane| self.recorder.lookup(table.lane(lane), at))
                }
                Node::Variable(..) => continue, // known since its loop began
                Node::Const(_)
                | Node::Point(..)
                | Node::Frame(..)
                | Node::Unary(..)
                | Node::Binary(..)
                | Node::Ternary(..)
                | Node::Splat(..)
                | Node::Compose(..)
                | Node::Swizzle(..)
                | Node::Transform(..)
                | Node::Sample(..)
                | Node::MaterialAt(..) => {
                    let lanes = &self.lanes;
                    scalarise(self.recorder, &node, |argument| lanes[&argument])
                        .ok_or_else(|| unavailable(id, &node))?
                }
            };
            self.lanes.insert(id, value);
        }
        Ok(())
    }

    /// Records a loop, unless that was done. Loops nest as deep as [`crate::MAX_LOOP_DEPTH`].
    fn repeat(&mut self, id: LoopId) -> Result<(), TapeError> {
        if self.loops.contains_key(&id) {
            return Ok(());
        }
        let (repeated, body) = (self.graph.repeated(id), self.graph.body(id));
        let starts: Vec<Lanes<u32>> = repeated.start.iter().map(|id| self.lanes[id]).collect();
        let count = repeated.count.map(|count| self.lanes[&count].get(0));
        let entered = self.recorder.enter(repeated.cap, count, &starts);
        for &id in body.condition.iter().chain(&body.round) {
            if let Node::Variable(_, place, _) = self.graph.node(id) {
                self.lanes.insert(
                    id,
                    match place {
                        Place::Round => Lanes::scalar(entered.round),
                        Place::State(position) => entered.state[usize::from(position)],
                    },
                );
            }
        }
        self.nodes(body.condition.iter().copied())?;
        if let Some(go_on) = repeated.go_on {
            self.recorder.test(entered.id, self.lanes[&go_on].get(0));
        }
        self.nodes(body.round.iter().copied())?;
        let next: Vec<Lanes<u32>> = repeated.next.iter().map(|id| self.lanes[id]).collect();
        self.recorder.leave(entered.id, &next);
        // Another loop of this depth may share the body's nodes, not their values.
        let inside = body.condition.iter().chain(&body.round);
        for id in inside {
            self.lanes.remove(id);
            if let Node::Loop(within, ..) = self.graph.node(*id) {
                self.loops.remove(&within);
            }
        }
        self.loops.insert(id, entered.results);
        Ok(())
    }
}

fn unavailable(id: NodeId, node: &Node) -> TapeError {
    if matches!(node, Node::Point(..)) {
        TapeError::InnerPoint(id)
    } else {
        TapeError::Unexpanded(id)
    }
}
