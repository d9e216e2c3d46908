//! From nodes to a tape: recording scalar operations, dropping the idle ones, giving out registers.

use rustc_hash::FxHashMap;

use super::op::Op;
use super::scalarise::{Lanes, Machine};
use super::tape::{Code, Definition, Instruction, LoopCode, POINT_LANES, StateCode, Tape};
use crate::graph::result_type;
use crate::{FrameInput, Node, Type};

/// How deep a sum of whole numbers is looked into.
const DEEPEST_SUM: usize = 3;

/// Collects definitions in order; equal constants become one.
#[derive(Default)]
pub(super) struct Recorder {
    definitions: Vec<Definition>,
    /// Whether each value depends on the point.
    varying: Vec<bool>,
    constants: FxHashMap<u64, u32>,
    lists: Vec<Vec<f64>>,
    loops: Vec<Repeated>,
    /// The loops that have begun and not ended.
    open: Vec<usize>,
    /// Of each value the loops around it.
    around: Vec<Option<usize>>,
    /// Points with a value are those of levels below this, and of the outermost.
    levels: u16,
    /// If given, points are unknown and samples are params, by position.
    samples: Option<FxHashMap<Node, u32>>,
}

/// A loop by positions of values.
struct Repeated {
    cap: u32,
    count: Option<u32>,
    /// The loop around it.
    outer: Option<usize>,
    round: u32,
    start: Vec<u32>,
    variables: Vec<u32>,
    copies: Vec<u32>,
    results: Vec<u32>,
    condition: Option<u32>,
    next: Vec<u32>,
    end: u32,
}

/// What a body may read of the loop that has just begun.
pub(super) struct Entered {
    /// Names the loop to the recorder.
    pub(super) id: usize,
    pub(super) round: u32,
    pub(super) state: Vec<Lanes<u32>>,
    /// What remains of the state when the loop has ended.
    pub(super) results: Vec<Lanes<u32>>,
}

/// Loops and lists.
impl Recorder {
    /// An element of a list.
    pub(super) fn lookup(&mut self, list: Vec<f64>, at: u32) -> u32 {
        let known = self.lists.iter().position(|known| *known == list);
        let list = known.unwrap_or_else(|| {
            self.lists.push(list);
            self.lists.len() - 1
        });
        let whole = !self.varying[at as usize] || self.is_whole(at, DEEPEST_SUM);
        let at = if whole { at } else { self.define_apply(Op::Floor, [at; 3]) };
        self.define(Definition::Lookup(list, at), self.varying[at as usize])
    }

    /// Begins a loop whose state starts as these values.
    pub(super) fn enter(&mut self, cap: u32, count: Option<u32>, start: &[Lanes<u32>]) -> Entered {
        let (id, outer) = (self.loops.len(), self.open.last().copied());
        // What a loop writes is its own, and lives as long as it.
        self.open.push(id);
        self.define(Definition::Enter(id), true);
        let round = self.define(Definition::Register, true);
        let mut registers = || {
            let lanes = start.iter().map(|lanes| {
                Lanes::new(lanes.as_slice().len(), |_| self.define(Definition::Register, true))
            });
            lanes.collect::<Vec<_>>()
        };
        let (state, results, copies) = (registers(), registers(), registers());
        for result in results.iter().flat_map(Lanes::as_slice) {
            self.around[*result as usize] = outer;
        }
        self.loops.push(Repeated {
            cap,
            count,
            outer,
            round,
            start: flat(start),
            variables: flat(&state),
            copies: flat(&copies),
            results: flat(&results),
            condition: None,
            next: Vec::new(),
            end: 0,
        });
        Entered { id, round, state, results }
    }

    /// Ends the rounds of the loop where the value is false.
    pub(super) fn test(&mut self, id: usize, condition: u32) {
        self.loops[id].condition = Some(condition);
        self.define(Definition::Test(id), true);
    }

    /// Ends the loop's body, which makes these values of its state.
    pub(super) fn leave(&mut self, id: usize, next: &[Lanes<u32>]) {
        self.loops[id].next = flat(next);
        self.loops[id].end = self.define(Definition::Leave(id), true);
        self.open.pop();
    }

    /// Where a value read at a place is needed for the last time: one from outside a loop at the loop's end, since there
    /// may be another round.
    fn read_until(&self, value: u32, place: usize) -> u32 {
        let home = self.around[value as usize];
        let (mut until, mut at) = (place as u32, self.around[place]);
        while at != home {
            let Some(inner) = at else { return until };
            until = self.loops[inner].end;
            at = self.loops[inner].outer;
        }
        until
    }
}

fn flat(lanes: &[Lanes<u32>]) -> Vec<u32> {
    lanes.iter().flat_map(Lanes::as_slice).copied().collect()
}

impl Recorder {
    /// One that reads samples as params and knows no point.
    pub(super) fn of_operator(samples: FxHashMap<Node, u32>) -> Self {
        Self { samples: Some(samples), ..Self::default() }
    }

    /// One that knows the points of so many levels.
    pub(super) fn of_levels(levels: u16) -> Self {
        Self { levels, ..Self::default() }
    }

    fn define(&mut self, definition: Definition, varying: bool) -> u32 {
        self.definitions.push(definition);
        self.varying.push(varying);
        self.around.push(self.open.last().copied());
        self.definitions.len() as u32 - 1
    }

    /// A product of x and `c * (1 - x)`, either way round: intervals are tighter if told.
    fn parabola(&mut self, [a, b, _]: [u32; 3]) -> Option<(Op, [u32; 3])> {
        let one = self.constant(1.0);
        for (x, y) in [(a, b), (b, a)] {
            let mut splits = vec![(y, one)];
            if let Definition::Apply(Op::Mul, [p, q, _]) = self.definitions[y as usize] {
                splits.extend([(p, q), (q, p)]);
            }
            let fits = |&(rest, _): &(u32, u32)| {
                self.is_complement(x, rest, one) || self.is_complement(rest, x, one)
            };
            if let Some((_, factor)) = splits.into_iter().find(fits) {
                return Some((Op::Parabola, [x, y, factor]));
            }
        }
        None
    }

    /// A difference of x and x clamped, on one side or both: intervals are tighter if told.
    fn excess(&mut self, [x, clamped, _]: [u32; 3]) -> Option<(Op, [u32; 3])> {
        let Definition::Apply(op, [a, b, c]) = self.definitions[clamped as usize] else {
            return None;
        };
        let other = if a == x { Some(b) } else { (b == x).then_some(a) };
        let range = if op == Op::Clamp && a == x {
            [b, c]
        } else if op == Op::Max {
            [other?, self.constant(f64::INFINITY)]
        } else if op == Op::Min {
            [self.constant(f64::NEG_INFINITY), other?]
        } else {
            return None;
        };
        Some((Op::Excess, [x, range[0], range[1]]))
    }

    fn define_apply(&mut self, op: Op, arguments: [u32; 3]) -> u32 {
        let varying = arguments.iter().take(op.arity()).any(|&a| self.varying[a as usize]);
        self.define(Definition::Apply(op, arguments), varying)
    }

    /// An operation that jumps from one whole number to the next, with the whole number computed before it, where
    /// intervals see it.
    fn apart(&mut self, op: Op, [a, b, c]: [u32; 3]) -> (Op, [u32; 3]) {
        if op == Op::Fract {
            let whole = self.define_apply(Op::Floor, [a; 3]);
            (Op::Beyond, [a, whole, a])
        } else if op == Op::Rem {
            let quotient = self.define_apply(Op::Div, [a, b, a]);
            let whole = self.define_apply(Op::Floor, [quotient; 3]);
            (Op::Left, [a, b, whole])
        } else if op == Op::Hash && !self.is_whole(b, DEEPEST_SUM) {
            let whole = self.define_apply(Op::Floor, [b; 3]);
            (op, [a, whole, a])
        } else {
            (op, [a, b, c])
        }
    }

    /// Whether a value is seen to be a whole number.
    fn is_whole(&self, value: u32, depth: usize) -> bool {
        match self.definitions[value as usize] {
            Definition::Constant(value) => value.fract() == 0.0,
            Definition::Apply(Op::Floor | Op::Ceil | Op::Round | Op::Trunc, _) => true,
            Definition::Apply(Op::Add | Op::Sub, [a, b, _]) if depth > 0 => {
                self.is_whole(a, depth - 1) && self.is_whole(b, depth - 1)
            }
            Definition::Apply(..)
            | Definition::Input(..)
            | Definition::Point(_)
            | Definition::Lookup(..)
            | Definition::Enter(_)
            | Definition::Test(_)
            | Definition::Leave(_)
            | Definition::Register => false,
        }
    }

    /// Whether a is `1 - b`.
    fn is_complement(&self, a: u32, b: u32, one: u32) -> bool {
        matches!(self.definitions[a as usize], Definition::Apply(Op::Sub, [x, y, _]) if x == one && y == b)
    }
}

impl Machine for Recorder {
    type Value = u32;

    fn constant(&mut self, value: f64) -> u32 {
        if let Some(&known) = self.constants.get(&value.to_bits()) {
            return known;
        }
        let id = self.define(Definition::Constant(value), false);
        self.constants.insert(value.to_bits(), id);
        id
    }

    fn apply(&mut self, op: Op, arguments: [u32; 3]) -> u32 {
        let (op, arguments) = if op == Op::Mul {
            self.parabola(arguments).unwrap_or((op, arguments))
        } else if op == Op::Sub {
            self.excess(arguments).unwrap_or((op, arguments))
        } else {
            self.apart(op, arguments)
        };
        self.define_apply(op, arguments)
    }

    fn input(&mut self, node: &Node) -> Option<Lanes<u32>> {
        let param = self.samples.as_ref().map(|samples| samples.get(node).copied());
        match *node {
            Node::Sample(..) | Node::Point(..) | Node::MaterialAt(..) if param.is_some() => {
                let width = result_type(node, |_| Type::Scalar).width(); // whatever the argument
                let value = match param.flatten() {
                    Some(param) => {
                        self.define(Definition::Input(FrameInput::Param(param), 0), false)
                    }
                    None => self.constant(f64::NAN),
                };
                Some(Lanes::new(width, |_| value))
            }
            Node::Point(level, dim) if level < self.levels.max(1) => {
                let (width, first) = (dim.point_type().width(), usize::from(level) * POINT_LANES);
                Some(Lanes::new(width, |i| self.define(Definition::Point(first + i), true)))
            }
            Node::Frame(input, ty) => {
                Some(Lanes::new(ty.width(), |i| self.define(Definition::Input(input, i), false)))
            }
            Node::Point(..)
            | Node::Const(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => None,
        }
    }
}

/// When the body reads a value for the last time.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum LastRead {
    Never,
    By(u32),
    /// An output.
    AfterEnd,
}

/// What the outputs need of each value.
struct Liveness {
    needed: Vec<bool>,
    last_read: Vec<LastRead>,
}

impl Recorder {
    /// The tape that yields these values.
    pub(super) fn finish(self, outputs: Vec<Lanes<u32>>) -> Tape {
        let liveness = self.liveness(&outputs);
        let mut places = vec![0; self.definitions.len()];
        let prelude = self.prelude(&liveness, &mut places);
        let kept = self.keep(&liveness, &mut places);
        let (body, registers) = self.body(&liveness, kept.len(), &mut places);
        let outputs = outputs
            .iter()
            .map(|lanes| Lanes::new(lanes.as_slice().len(), |i| places[lanes.get(i) as usize]))
            .collect();
        Tape { prelude, kept, body, lists: self.lists, registers, outputs }
    }

    fn liveness(&self, outputs: &[Lanes<u32>]) -> Liveness {
        let count = self.definitions.len();
        let (needed, last_read) = (vec![false; count], vec![LastRead::Never; count]);
        let mut liveness = Liveness { needed, last_read };
        for &value in outputs.iter().flat_map(Lanes::as_slice) {
            liveness.needed[value as usize] = true;
            liveness.last_read[value as usize] = LastRead::AfterEnd;
        }
        for place in (0..count).rev() {
            let needed = match self.definitions[place] {
                // A loop runs if anything of its result is read, and then all its registers are in use.
                Definition::Leave(id) => {
                    self.loops[id].results.iter().any(|&id| liveness.needed[id as usize])
                }
                Definition::Test(id) | Definition::Enter(id) => {
                    liveness.needed[self.loops[id].end as usize]
                }
                Definition::Constant(_)
                | Definition::Input(..)
                | Definition::Point(_)
                | Definition::Apply(..)
                | Definition::Lookup(..)
                | Definition::Register => liveness.needed[place],
            };
            liveness.needed[place] = needed;
            if needed {
                for value in self.reads(place) {
                    liveness.needed[value as usize] = true;
                    if self.varying[place] {
                        let last = LastRead::By(self.read_until(value, place));
                        let before = &mut liveness.last_read[value as usize];
                        *before = last.max(*before);
                    }
                }
            }
        }
        liveness
    }

    /// What is read at a place, or must keep its register until then.
    fn reads(&self, place: usize) -> Vec<u32> {
        match self.definitions[place] {
            Definition::Apply(op, arguments) => arguments[..op.arity()].to_vec(),
            Definition::Lookup(_, at) => vec![at],
            Definition::Enter(id) => self.loops[id].start.clone(),
            Definition::Test(id) => self.loops[id].condition.into_iter().collect(),
            Definition::Leave(id) => {
                let Repeated { count, round, variables, copies, results, next, .. } =
                    &self.loops[id];
                let lists = [variables, copies, results, next].into_iter().flatten();
                lists.chain(count).chain([round]).copied().collect()
            }
            Definition::Constant(_)
            | Definition::Input(..)
            | Definition::Point(_)
            | Definition::Register => Vec::new(),
        }
    }

    /// What no point changes, in order; `places` then holds positions in it.
    fn prelude(&self, liveness: &Liveness, places: &mut [u32]) -> Vec<Definition> {
        let mut prelude = Vec::new();
        for (value, &definition) in self.definitions.iter().enumerate() {
            if self.varying[value] || !liveness.needed[value] {
                continue;
            }
            places[value] = prelude.len() as u32;
            prelude.push(match definition {
                Definition::Apply(op, arguments) => {
                    Definition::Apply(op, arguments.map(|a| places[a as usize]))
                }
                Definition::Lookup(list, at) => Definition::Lookup(list, places[at as usize]),
                Definition::Constant(_)
                | Definition::Input(..)
                | Definition::Point(_)
                | Definition::Enter(_)
                | Definition::Test(_)
                | Definition::Leave(_)
                | Definition::Register => definition,
            });
        }
        prelude
    }

    /// The prelude's values that the body or an output reads; `places` then holds their registers.
    fn keep(&self, liveness: &Liveness, places: &mut [u32]) -> Vec<u32> {
        let mut kept = Vec::new();
        for (value, &last_read) in liveness.last_read.iter().enumerate() {
            if !self.varying[value] && last_read != LastRead::Never {
                let register = kept.len() as u32;
                kept.push(std::mem::replace(&mut places[value], register));
            }
        }
        kept
    }

    /// What runs at a point and how many registers it takes. A result may take the register of an
    /// argument that dies there, since arguments are read before the result is written.
    fn body(&self, liveness: &Liveness, kept: usize, places: &mut [u32]) -> (Vec<Code>, usize) {
        // The innermost loop under way is the last.
        let mut bodies: Vec<Vec<Code>> = vec![Vec::new()];
        let points = usize::from(self.levels.max(1)) * POINT_LANES;
        let mut registers = Registers { free: Vec::new(), count: kept + points };
        for (value, &definition) in self.definitions.iter().enumerate() {
            if !self.varying[value] || !liveness.needed[value] {
                continue;
            }
            let released = self.released(value, liveness, places);
            match definition {
                Definition::Point(lane) => places[value] = (kept + lane) as u32,
                Definition::Apply(op, arguments) => {
                    let arguments = arguments.map(|a| places[a as usize]);
                    registers.free.extend(released);
                    let result = registers.take();
                    places[value] = result;
                    let instruction = Instruction { op, result, arguments };
                    if op.jumps() {
                        push(&mut bodies, Code::Jump(instruction));
                    } else {
                        append(&mut bodies, instruction);
                    }
                }
                Definition::Lookup(list, at) => {
                    let at = places[at as usize];
                    registers.free.extend(released);
                    places[value] = registers.take();
                    let lookup = Code::Lookup { list, at, result: places[value] };
                    push(&mut bodies, lookup);
                }
                Definition::Register => places[value] = registers.take(),
                Definition::Enter(_) => bodies.push(Vec::new()),
                Definition::Test(id) => {
                    let condition = self.loops[id].condition.unwrap_or_default();
                    let test = Code::Test(places[condition as usize]);
                    push(&mut bodies, test);
                    registers.free.extend(released);
                }
                Definition::Leave(id) => {
                    let body = bodies.pop().unwrap_or_default();
                    let code = Code::Loop(self.loops[id].code(body, places));
                    push(&mut bodies, code);
                    registers.free.extend(released);
                }
                Definition::Constant(_) | Definition::Input(..) => {}
            }
        }
        (bodies.pop().unwrap_or_default(), registers.count)
    }

    /// Registers of values that are needed here for the last time, each once.
    fn released(&self, place: usize, liveness: &Liveness, places: &[u32]) -> Vec<u32> {
        let dies = |value: usize| {
            let is_register = matches!(
                self.definitions[value],
                Definition::Apply(..) | Definition::Lookup(..) | Definition::Register
            );
            is_register
                && self.varying[value]
                && liveness.last_read[value] == LastRead::By(place as u32)
        };
        if let Definition::Leave(_) = self.definitions[place] {
            // What the body reads from outside dies here too.
            return (0..place).filter(|&value| dies(value)).map(|value| places[value]).collect();
        }
        let mut read = self.reads(place);
        read.sort_unstable();
        read.dedup();
        let dying = read.into_iter().filter(|&value| dies(value as usize));
        dying.map(|value| places[value as usize]).collect()
    }
}

/// Registers that are free and how many there are.
struct Registers {
    free: Vec<u32>,
    count: usize,
}

impl Registers {
    fn take(&mut self) -> u32 {
        self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count as u32 - 1
        })
    }
}

fn push(bodies: &mut [Vec<Code>], code: Code) {
    if let Some(body) = bodies.last_mut() {
        body.push(code);
    }
}

fn append(bodies: &mut [Vec<Code>], instruction: Instruction) {
    let Some(body) = bodies.last_mut() else { return };
    if let Some(Code::Straight(instructions)) = body.last_mut() {
        instructions.push(instruction);
    } else {
        body.push(Code::Straight(vec![instruction]));
    }
}

impl Repeated {
    /// In registers.
    fn code(&self, body: Vec<Code>, places: &[u32]) -> LoopCode {
        let place = |value: u32| places[value as usize];
        let state = (0..self.variables.len()).map(|i| StateCode {
            start: place(self.start[i]),
            variable: place(self.variables[i]),
            next: place(self.next[i]),
            copy: place(self.copies[i]),
            result: place(self.results[i]),
        });
        LoopCode {
            cap: self.cap,
            count: self.count.map(place),
            round: place(self.round),
            state: state.collect(),
            body,
        }
    }
}
