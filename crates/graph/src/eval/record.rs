//! Recording scalar operations, loops and lists.

use rustc_hash::FxHashMap;

use super::op::Op;
use super::scalarise::{Lanes, ScalarBackend};
use super::tape::{Definition, POINT_LANES};
use crate::graph::result_type;
use crate::node::{FrameInput, Node, Type};

/// Maximum depth of a sum that is searched for whole numbers.
const DEEPEST_SUM: usize = 3;

/// A backend that collects definitions in order; equal constants become one.
#[derive(Default)]
pub(super) struct Recorder {
    pub(super) definitions: Vec<Definition>,
    /// For each value: whether it depends on the point.
    pub(super) varying: Vec<bool>,
    constants: FxHashMap<u64, u32>,
    pub(super) lists: Vec<Vec<f64>>,
    pub(super) loops: Vec<RecordedLoop>,
    /// The loops that were entered and not left.
    open: Vec<usize>,
    /// For each value: the innermost loop around it.
    around: Vec<Option<usize>>,
    /// Number of levels whose points have a value; the outermost always has one.
    pub(super) levels: u16,
    /// If given, points are unknown and samples are params, by index.
    samples: Option<FxHashMap<Node, u32>>,
}

/// A loop, in terms of indices of values.
pub(super) struct RecordedLoop {
    pub(super) max_iterations: u32,
    pub(super) count: Option<u32>,
    /// The loop around this one.
    pub(super) outer: Option<usize>,
    pub(super) index: u32,
    pub(super) init: Vec<u32>,
    pub(super) variables: Vec<u32>,
    pub(super) copies: Vec<u32>,
    pub(super) results: Vec<u32>,
    pub(super) condition: Option<u32>,
    pub(super) step: Vec<u32>,
    pub(super) end: u32,
}

/// The values of a loop that its body may read.
pub(super) struct Entered {
    /// The loop's index in the recorder.
    pub(super) id: usize,
    pub(super) index: u32,
    pub(super) state: Vec<Lanes<u32>>,
    /// The state after the last iteration.
    pub(super) results: Vec<Lanes<u32>>,
}

/// Loops and lists.
impl Recorder {
    /// Records a lookup in a list.
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

    /// Enters a loop whose state starts as these values.
    pub(super) fn enter(
        &mut self,
        max_iterations: u32,
        count: Option<u32>,
        init: &[Lanes<u32>],
    ) -> Entered {
        let (id, outer) = (self.loops.len(), self.open.last().copied());
        // The registers that a loop writes belong to it and live as long as it.
        self.open.push(id);
        self.define(Definition::Enter(id), true);
        let index = self.define(Definition::Register, true);
        let mut registers = || {
            let lanes = init.iter().map(|lanes| {
                Lanes::new(lanes.as_slice().len(), |_| self.define(Definition::Register, true))
            });
            lanes.collect::<Vec<_>>()
        };
        let (state, results, copies) = (registers(), registers(), registers());
        for result in results.iter().flat_map(Lanes::as_slice) {
            self.around[*result as usize] = outer;
        }
        self.loops.push(RecordedLoop {
            max_iterations,
            count,
            outer,
            index,
            init: flat(init),
            variables: flat(&state),
            copies: flat(&copies),
            results: flat(&results),
            condition: None,
            step: Vec::new(),
            end: 0,
        });
        Entered { id, index, state, results }
    }

    /// Records that the loop ends where the value is false.
    pub(super) fn test(&mut self, id: usize, condition: u32) {
        self.loops[id].condition = Some(condition);
        self.define(Definition::Test(id), true);
    }

    /// Leaves the loop; these values are the state after an iteration.
    pub(super) fn leave(&mut self, id: usize, step: &[Lanes<u32>]) {
        self.loops[id].step = flat(step);
        self.loops[id].end = self.define(Definition::Leave(id), true);
        self.open.pop();
    }

    /// The index up to which a value that is read at index `at` must live. A value from outside a
    /// loop lives until the loop's end, since there may be another iteration.
    pub(super) fn read_until(&self, value: u32, at: usize) -> u32 {
        let home = self.around[value as usize];
        let (mut until, mut loop_) = (at as u32, self.around[at]);
        while loop_ != home {
            let Some(inner) = loop_ else { return until };
            until = self.loops[inner].end;
            loop_ = self.loops[inner].outer;
        }
        until
    }
}

fn flat(lanes: &[Lanes<u32>]) -> Vec<u32> {
    lanes.iter().flat_map(Lanes::as_slice).copied().collect()
}

impl Recorder {
    /// A recorder that reads samples as params and has no points.
    pub(super) fn for_operator(samples: FxHashMap<Node, u32>) -> Self {
        Self { samples: Some(samples), ..Self::default() }
    }

    /// A per-frame value of another tape. These differ from each other, so none is looked up.
    pub(super) fn kept(&mut self, value: f64) -> u32 {
        self.define(Definition::Constant(value), false)
    }

    /// Forgets everything that was recorded.
    pub(super) fn clear(&mut self) {
        let Self { definitions, varying, constants, lists, loops, open, around, levels, samples } =
            self;
        definitions.clear();
        varying.clear();
        constants.clear();
        lists.clear();
        loops.clear();
        open.clear();
        around.clear();
        (*levels, *samples) = (0, None);
    }

    /// A recorder with the points of this many levels.
    pub(super) fn of_levels(levels: u16) -> Self {
        Self { levels, ..Self::default() }
    }

    /// The coordinates of the point of the next level.
    pub(super) fn point(&mut self) -> [u32; POINT_LANES] {
        let first = usize::from(self.levels) * POINT_LANES;
        self.levels += 1;
        std::array::from_fn(|lane| self.define(Definition::Point(first + lane), true))
    }

    fn define(&mut self, definition: Definition, varying: bool) -> u32 {
        self.definitions.push(definition);
        self.varying.push(varying);
        self.around.push(self.open.last().copied());
        self.definitions.len() as u32 - 1
    }

    /// Recognises a product of x and `c * (1 - x)`, for which intervals have a tighter rule.
    fn as_x_times_one_minus_x(&mut self, [a, b, _]: [u32; 3]) -> Option<(Op, [u32; 3])> {
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
                return Some((Op::XTimesOneMinusX, [x, y, factor]));
            }
        }
        None
    }

    /// Recognises the difference of x and x clamped on one or both sides, for which intervals have
    /// a tighter rule.
    fn as_clamp_residual(&mut self, [x, clamped, _]: [u32; 3]) -> Option<(Op, [u32; 3])> {
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
        Some((Op::ClampResidual, [x, range[0], range[1]]))
    }

    /// Records an operation as it is.
    pub(super) fn define_apply(&mut self, op: Op, arguments: [u32; 3]) -> u32 {
        let varying = arguments.iter().take(op.arity()).any(|&a| self.varying[a as usize]);
        self.define(Definition::Apply(op, arguments), varying)
    }

    /// Splits off the whole number in an operation that jumps from one to the next, so that a
    /// tracer of intervals sees it as an operation of its own.
    fn split_whole(&mut self, op: Op, [a, b, c]: [u32; 3]) -> (Op, [u32; 3]) {
        if op == Op::Fract {
            let whole = self.define_apply(Op::Floor, [a; 3]);
            (Op::FractWithFloor, [a, whole, a])
        } else if op == Op::Rem {
            let quotient = self.define_apply(Op::Div, [a, b, a]);
            let whole = self.define_apply(Op::Floor, [quotient; 3]);
            (Op::RemWithQuotient, [a, b, whole])
        } else if op == Op::Hash && !self.is_whole(b, DEEPEST_SUM) {
            let whole = self.define_apply(Op::Floor, [b; 3]);
            (op, [a, whole, a])
        } else {
            (op, [a, b, c])
        }
    }

    /// True if a value is known to be a whole number.
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

    /// True if a is `1 - b`.
    fn is_complement(&self, a: u32, b: u32, one: u32) -> bool {
        matches!(self.definitions[a as usize], Definition::Apply(Op::Sub, [x, y, _]) if x == one && y == b)
    }
}

impl ScalarBackend for Recorder {
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
            self.as_x_times_one_minus_x(arguments).unwrap_or((op, arguments))
        } else if op == Op::Sub {
            self.as_clamp_residual(arguments).unwrap_or((op, arguments))
        } else {
            self.split_whole(op, arguments)
        };
        self.define_apply(op, arguments)
    }

    fn input(&mut self, node: &Node) -> Option<Lanes<u32>> {
        let param = self.samples.as_ref().map(|samples| samples.get(node).copied());
        match *node {
            Node::Sample(..) | Node::Point(..) | Node::MaterialAt(..) if param.is_some() => {
                // The type of an input does not depend on its argument.
                let width = result_type(node, |_| Type::Scalar).width();
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
