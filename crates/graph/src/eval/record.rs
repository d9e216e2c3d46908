//! From nodes to a tape: recording scalar operations, dropping the idle ones, giving out registers.

use rustc_hash::FxHashMap;

use super::op::Op;
use super::scalarise::{Lanes, Machine};
use super::tape::{Definition, Instruction, POINT_LANES, Tape};
use crate::graph::result_type;
use crate::{FrameInput, Node, Type};

/// Collects definitions in order; equal constants become one.
#[derive(Default)]
pub(super) struct Recorder {
    definitions: Vec<Definition>,
    /// Whether each value depends on the point.
    varying: Vec<bool>,
    constants: FxHashMap<u64, u32>,
    /// If given, points are unknown and samples are params, by position.
    samples: Option<FxHashMap<Node, u32>>,
}

impl Recorder {
    /// One that reads samples as params and knows no point.
    pub(super) fn of_operator(samples: FxHashMap<Node, u32>) -> Self {
        Self { samples: Some(samples), ..Self::default() }
    }

    fn define(&mut self, definition: Definition, varying: bool) -> u32 {
        self.definitions.push(definition);
        self.varying.push(varying);
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
        let told = if op == Op::Mul {
            self.parabola(arguments)
        } else if op == Op::Sub {
            self.excess(arguments)
        } else {
            None
        };
        let (op, arguments) = told.unwrap_or((op, arguments));
        let varying = arguments.iter().take(op.arity()).any(|&a| self.varying[a as usize]);
        self.define(Definition::Apply(op, arguments), varying)
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
            Node::Point(0, dim) => {
                let width = dim.point_type().width();
                Some(Lanes::new(width, |i| self.define(Definition::Point(i), true)))
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
            | Node::Sample(..)
            | Node::MaterialAt(..) => None,
        }
    }
}

/// When the body reads a value for the last time.
#[derive(Clone, Copy, PartialEq)]
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
        Tape { prelude, kept, body, registers, outputs }
    }

    fn liveness(&self, outputs: &[Lanes<u32>]) -> Liveness {
        let count = self.definitions.len();
        let (mut needed, mut last_read) = (vec![false; count], vec![LastRead::Never; count]);
        for &value in outputs.iter().flat_map(Lanes::as_slice) {
            needed[value as usize] = true;
            last_read[value as usize] = LastRead::AfterEnd;
        }
        for value in (0..count).rev() {
            let Definition::Apply(op, arguments) = self.definitions[value] else { continue };
            if !needed[value] {
                continue;
            }
            for &a in &arguments[..op.arity()] {
                needed[a as usize] = true;
                if self.varying[value] && last_read[a as usize] == LastRead::Never {
                    last_read[a as usize] = LastRead::By(value as u32);
                }
            }
        }
        Liveness { needed, last_read }
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
                Definition::Constant(_) | Definition::Input(..) | Definition::Point(_) => {
                    definition
                }
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

    /// The instructions and how many registers they take. A result may take the register of an
    /// argument that dies there, since arguments are read before the result is written.
    fn body(
        &self,
        liveness: &Liveness,
        kept: usize,
        places: &mut [u32],
    ) -> (Vec<Instruction>, usize) {
        let mut body = Vec::new();
        let mut free: Vec<u32> = Vec::new();
        let mut registers = kept + POINT_LANES;
        for (value, &definition) in self.definitions.iter().enumerate() {
            if !self.varying[value] || !liveness.needed[value] {
                continue;
            }
            match definition {
                Definition::Point(lane) => places[value] = (kept + lane) as u32,
                Definition::Apply(op, arguments) => {
                    let sources = arguments.map(|a| places[a as usize]);
                    free.extend(self.released(value, &arguments[..op.arity()], liveness, places));
                    let result = free.pop().unwrap_or_else(|| {
                        registers += 1;
                        registers as u32 - 1
                    });
                    places[value] = result;
                    body.push(Instruction { op, result, arguments: sources });
                }
                Definition::Constant(_) | Definition::Input(..) => {}
            }
        }
        (body, registers)
    }

    /// Registers of intermediate values that this value is the last to read, each once.
    fn released<'a>(
        &'a self,
        value: usize,
        arguments: &'a [u32],
        liveness: &'a Liveness,
        places: &'a [u32],
    ) -> impl Iterator<Item = u32> + 'a {
        arguments.iter().enumerate().filter_map(move |(position, &a)| {
            let intermediate = self.varying[a as usize]
                && matches!(self.definitions[a as usize], Definition::Apply(..));
            let dies = liveness.last_read[a as usize] == LastRead::By(value as u32);
            let repeated = arguments[..position].contains(&a);
            (intermediate && dies && !repeated).then(|| places[a as usize])
        })
    }
}
