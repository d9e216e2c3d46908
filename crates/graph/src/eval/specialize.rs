//! Specialising a tape to a region: leaving out what cannot matter there.
//!
//! The tape is evaluated once over the region, in numbers that record the operations they come
//! from. An operation whose result is one of its arguments everywhere in the region, such as a
//! minimum of numbers in a known order, is not recorded. Loops become straight code of the
//! iterations that can run. What the result no longer needs is dropped.

use std::cell::{Cell, RefCell};

use super::affine::Affine;
use super::frame::FrameValues;
use super::number::Number;
use super::op::{Op, operations};
use super::record::Recorder;
use super::scalarise::{Lanes, ScalarBackend};
use super::tape::Tape;

/// A specialised tape records at most this many operations.
const MOST_OPERATIONS: usize = 1 << 17;

impl Tape {
    /// The tape that computes the first lane of the first root in a region, for one frame. `None`
    /// if it would be too long.
    ///
    /// At the points of the region, f64 and dual numbers give the same results as with the whole
    /// tape. Bounds of a box hold for the part of the box within the region. They may be tighter.
    ///
    /// ```
    /// use sdfc_graph::eval::{Affine, FrameValues, Tape};
    /// use sdfc_graph::{Dim, Graph};
    ///
    /// let mut graph = Graph::new();
    /// let p = graph.point(0, Dim::Three);
    /// let (x, y) = (graph.component(p, 0), graph.component(p, 1));
    /// let root = graph.min(x, y);
    /// let tape = Tape::new(&graph, &[root])?;
    /// let frame = FrameValues::default();
    ///
    /// // x is from 0 to 2 there, and y from 3 to 5.
    /// let x = Affine::coordinate(1.0, [1.0, 0.0, 0.0]);
    /// let y = Affine::coordinate(4.0, [0.0, 1.0, 0.0]);
    /// let only_x = tape.specialized(&frame, [x, y, y]).expect("a short tape");
    /// assert_eq!((tape.operations(), only_x.operations()), (1, 0));
    /// assert_eq!(only_x.prepare::<f64>(&frame).scalar([1.5, 3.5, 3.5]), 1.5);
    /// # Ok::<(), sdfc_graph::eval::TapeError>(())
    /// ```
    pub fn specialized(&self, frame: &FrameValues, region: [Affine; 3]) -> Option<Self> {
        self.over(frame, region).tape
    }

    /// The field in a region, for one frame: bounds of its value, and the tape of
    /// [`Self::specialized`].
    ///
    /// ```
    /// use sdfc_graph::eval::{Affine, FrameValues, Tape};
    /// use sdfc_graph::{Dim, Graph};
    ///
    /// let mut graph = Graph::new();
    /// let p = graph.point(0, Dim::Three);
    /// let (x, y) = (graph.component(p, 0), graph.component(p, 1));
    /// let root = graph.max(x, y);
    /// let tape = Tape::new(&graph, &[root])?;
    ///
    /// let x = Affine::coordinate(4.0, [1.0, 0.0, 0.0]);
    /// let y = Affine::coordinate(1.0, [0.0, 1.0, 0.0]);
    /// let over = tape.over(&FrameValues::default(), [x, y, y]);
    /// assert!(over.value.range().lo() > 2.99 && over.value.range().hi() < 5.01);
    /// assert_eq!((over.operations, over.tape.map(|tape| tape.operations())), (1, Some(0)));
    /// # Ok::<(), sdfc_graph::eval::TapeError>(())
    /// ```
    pub fn over(&self, frame: &FrameValues, region: [Affine; 3]) -> FieldOver {
        let first = self.outputs.first().map(|lanes| Lanes::scalar(lanes.get(0)));
        let over = self.roots_over(frame, &[region], &Vec::from_iter(first));
        let value = over.values.first().map_or(Affine::constant(0.0), |lanes| lanes[0]);
        FieldOver { value, tape: over.tape, operations: over.operations }
    }

    /// The functions of a ray over a region of origins and one of directions, for one frame, given
    /// a tape made by [`Tape::for_rays`]. The tape computes all lanes of all roots.
    ///
    /// ```
    /// use sdfc_graph::eval::{Affine, FrameValues, Tape};
    /// use sdfc_graph::{Dim, Graph};
    ///
    /// let mut graph = Graph::new();
    /// let (origin, direction) = (graph.point(0, Dim::Three), graph.point(1, Dim::Three));
    /// let (x, dx) = (graph.component(origin, 0), graph.component(direction, 0));
    /// let root = graph.max(x, dx);
    /// let tape = Tape::for_rays(&graph, &[root])?;
    ///
    /// let frame = FrameValues::default();
    /// let origin = Affine::coordinate(4.0, [1.0, 0.0, 0.0]);
    /// let direction = Affine::coordinate(1.0, [0.0; 3]);
    /// let over = tape.over_rays(&frame, [[origin; 3], [direction; 3]]);
    /// assert!(over.values[0][0].range().lo() > 2.99);
    /// let tape = over.tape.expect("a short tape");
    /// assert_eq!(tape.operations(), 0);
    /// assert_eq!(tape.prepare::<f64>(&frame).eval_ray([3.5; 3], [1.0; 3])[0][0], 3.5);
    /// # Ok::<(), sdfc_graph::eval::TapeError>(())
    /// ```
    pub fn over_rays(&self, frame: &FrameValues, region: [[Affine; 3]; 2]) -> RootsOver {
        self.roots_over(frame, &region, &self.outputs)
    }

    /// The values of registers over a region of points, and a tape that computes them.
    fn roots_over(
        &self,
        frame: &FrameValues,
        region: &[[Affine; 3]],
        outputs: &[Lanes<u32>],
    ) -> RootsOver {
        let trace = Trace { recorder: RefCell::new(RECORDER.take()), ..Trace::default() };
        let points: Vec<[Traced<'_>; 3]> = region
            .iter()
            .map(|forms| {
                let axes = trace.recorder.borrow_mut().point();
                std::array::from_fn(|axis| Traced {
                    form: forms[axis],
                    constant: None,
                    source: Some((&trace, axes[axis])),
                })
            })
            .collect();
        let kept = |value: f64| Traced {
            source: Some((&trace, trace.recorder.borrow_mut().kept(value))),
            ..Traced::constant(value)
        };
        let mut evaluator = self.evaluator(frame, kept);
        let roots = evaluator.registers_at(&points, outputs);
        let values = roots.iter().map(|lanes| lanes.map(|lane| lane.form)).collect();
        let ids: Option<Vec<Lanes<u32>>> = roots
            .iter()
            .zip(outputs)
            .map(|(root, lanes)| {
                let ids: Vec<u32> = root[..lanes.as_slice().len()]
                    .iter()
                    .map(|lane| lane.id(&trace))
                    .collect::<Option<_>>()?;
                Some(Lanes::new(ids.len(), |lane| ids[lane]))
            })
            .collect();
        let (mut recorder, operations) = (trace.recorder.take(), trace.operations.get());
        let is_whole = recorder.definitions.len() <= MOST_OPERATIONS;
        let tape = ids.filter(|_| is_whole).map(|ids| recorder.finish(ids));
        recorder.clear();
        RECORDER.set(recorder);
        RootsOver { values, tape, operations }
    }
}

/// A field in a region.
#[derive(Clone, Debug)]
pub struct FieldOver {
    /// The value, as a function of the region's coordinates.
    pub value: Affine,
    /// The specialised tape; `None` if it would be too long.
    pub tape: Option<Tape>,
    /// Number of operations that the whole tape ran in the region. Its loops run no iterations
    /// that can follow at no point of the region.
    pub operations: usize,
}

/// The roots of a tape over a region.
#[derive(Clone, Debug)]
pub struct RootsOver {
    /// The lanes of each root, as functions of the region's coordinates. Lanes beyond a root's
    /// width are 0.
    pub values: Vec<[Affine; 4]>,
    /// The specialised tape; `None` if it would be too long.
    pub tape: Option<Tape>,
    /// As in [`FieldOver`].
    pub operations: usize,
}

thread_local! {
    /// An empty recorder with the memory of the last one: regions are small and many.
    static RECORDER: RefCell<Recorder> = RefCell::default();
}

/// The evaluation so far.
#[derive(Default)]
struct Trace {
    /// The operations that are recorded.
    recorder: RefCell<Recorder>,
    /// Number of operations that were run.
    operations: Cell<usize>,
    /// What is recorded as the square of another operation.
    squares: RefCell<Origins>,
    /// What is equal to the greater of another operation and 0.
    positive_parts: RefCell<Origins>,
    /// What is the lesser of another operation and 0.
    negative_parts: RefCell<Origins>,
}

/// Recorded operations, ascending: the index of each, and another operation that it is made from.
#[derive(Default)]
struct Origins(Vec<(u32, Origin)>);

/// An operation: its index and its value.
type Origin = (u32, Affine);

impl Origins {
    fn of(&self, id: u32) -> Option<Origin> {
        let index = self.0.binary_search_by_key(&id, |(made, _)| *made).ok()?;
        Some(self.0[index].1)
    }
}

/// A number over the region, and where it comes from.
#[derive(Clone, Copy)]
struct Traced<'t> {
    form: Affine,
    /// The value, if it is the same everywhere.
    constant: Option<f64>,
    /// The recorded operation. `None` for constants that belong to no tape yet, and for what is
    /// computed from such constants alone with rounding, which cannot be recorded.
    source: Option<(&'t Trace, u32)>,
}

impl<'t> Traced<'t> {
    /// Returns the value's index in the recorder.
    fn id(self, trace: &Trace) -> Option<u32> {
        match (self.source, self.constant) {
            (Some((_, id)), _) => Some(id),
            (None, Some(constant)) => Some(trace.recorder.borrow_mut().constant(constant)),
            (None, None) => None,
        }
    }

    fn is(self, value: f64) -> bool {
        self.constant == Some(value)
    }

    /// Returns true if the number is less than another one everywhere.
    fn is_below(self, other: Self) -> bool {
        self.order(other)[0]
    }

    /// Returns whether the number is less than another one everywhere, and whether it is greater.
    fn order(self, other: Self) -> [bool; 2] {
        let difference = Number::sub(self.form, other.form).range();
        [difference.hi() < 0.0, difference.lo() > 0.0]
    }

    /// Returns an operation's result: one of its arguments if it is that everywhere.
    fn apply(op: Op, x: [Self; 3]) -> Self {
        if let Some((trace, _)) = x[..op.arity()].iter().find_map(|x| x.source) {
            trace.operations.set(trace.operations.get() + 1);
        }
        match Self::picked(op, x) {
            // Affine forms pick the same argument.
            Some(i) if matches!(op, Op::Min | Op::Max) => x[i],
            Some(i) => Self { form: op.apply(|i| x[i].form), ..x[i] },
            None if op == Op::Sqrt => x[0].root(),
            None => {
                let joined = if op == Op::Add { Self::joined(x[0], x[1]) } else { None };
                joined.unwrap_or_else(|| Self::recorded(op, x, op.apply(|i| x[i].form)))
            }
        }
    }

    /// Returns the square root. The root of x² is x or -x without any rounding, so the distance to
    /// a face of a box is linear in the position, and so are its bounds.
    fn root(self) -> Self {
        let recorded = || Self::recorded(Op::Sqrt, [self; 3], self.form.sqrt());
        let Some((trace, id)) = self.source else { return recorded() };
        let Some((root, form)) = trace.squares.borrow().of(id) else { return recorded() };
        let known = Self { form, constant: None, source: Some((trace, root)) };
        if form.range().lo() > 0.0 {
            return known;
        }
        if form.range().hi() < 0.0 {
            return Self::apply(Op::Neg, [known; 3]);
        }
        let result = recorded();
        let part = trace.positive_parts.borrow().of(root);
        if let (Some((_, id)), Some(origin)) = (result.source, part) {
            trace.positive_parts.borrow_mut().0.push((id, origin));
        }
        result
    }

    /// Returns x for the sum of the positive and the negative part of x, in any order. It has no
    /// rounding. The distance to a box, outside and inside, is such a sum at a face.
    fn joined(a: Self, b: Self) -> Option<Self> {
        let ((trace, a), (_, b)) = (a.source?, b.source?);
        let (positive, negative) = (trace.positive_parts.borrow(), trace.negative_parts.borrow());
        [(a, b), (b, a)].into_iter().find_map(|(above, below)| {
            let (origin, form) = positive.of(above)?;
            let (other, _) = negative.of(below)?;
            let joined = Self { form, constant: None, source: Some((trace, origin)) };
            (origin == other).then_some(joined)
        })
    }

    /// Returns the argument that an operation's result is equal to everywhere.
    fn picked(op: Op, [a, b, c]: [Self; 3]) -> Option<usize> {
        let first_of = |conditions: [bool; 3]| conditions.iter().position(|is_equal| *is_equal);
        let is_true = |x: Self| !x.form.range().contains(0.0);
        first_of(match op {
            Op::Min => {
                let [a_below, b_below] = a.order(b);
                [a_below, b_below, false]
            }
            Op::Max => {
                let [a_below, b_below] = a.order(b);
                [b_below, a_below, false]
            }
            Op::Abs => [a.form.range().lo() > 0.0, false, false],
            Op::Saturate => {
                let range = a.form.range();
                [range.lo() > 0.0 && range.hi() < 1.0, false, false]
            }
            Op::Clamp => [b.is_below(a) && a.is_below(c), false, false],
            Op::Select => [false, is_true(a), a.form.is_definitely_false()],
            Op::And => [b.is(1.0), a.is(1.0), false],
            Op::Or | Op::Add => [b.is(0.0), a.is(0.0), false],
            Op::Sub => [b.is(0.0), false, false],
            Op::Mul => [b.is(1.0), a.is(1.0), false],
            Op::Mix => [c.is(0.0), c.is(1.0), false],
            Op::Neg
            | Op::Sign
            | Op::Floor
            | Op::Ceil
            | Op::Round
            | Op::Trunc
            | Op::Fract
            | Op::Square
            | Op::Sqrt
            | Op::InverseSqrt
            | Op::Exp
            | Op::Exp2
            | Op::Log
            | Op::Log2
            | Op::Sin
            | Op::Cos
            | Op::Tan
            | Op::Asin
            | Op::Acos
            | Op::Atan
            | Op::Sinh
            | Op::Cosh
            | Op::Tanh
            | Op::Not
            | Op::Div
            | Op::Rem
            | Op::Pow
            | Op::Atan2
            | Op::Step
            | Op::Hash
            | Op::NormalizeLane
            | Op::FractWithFloor
            | Op::Lt
            | Op::Le
            | Op::Eq
            | Op::Ne
            | Op::Smoothstep
            | Op::XTimesOneMinusX
            | Op::ClampResidual
            | Op::RemWithQuotient => return None,
        })
    }

    /// Records an operation, unless its result is a constant.
    fn recorded(op: Op, x: [Self; 3], form: Affine) -> Self {
        let arguments = &x[..op.arity()];
        let range = form.range();
        let is_fixed = range.lo() == range.hi();
        let constant = is_fixed.then(|| match x.map(|x| x.constant) {
            // The sign of zero may differ from that of the range.
            [Some(a), Some(b), Some(c)] => op.apply(|i| [a, b, c][i]),
            _ => range.lo(),
        });
        let trace = arguments.iter().find_map(|x| x.source).map(|(trace, _)| trace);
        let source = trace.and_then(|trace| {
            if let Some(constant) = constant {
                return Some((trace, trace.recorder.borrow_mut().constant(constant)));
            }
            let [a, b, c] = x.map(|x| x.id(trace));
            let ids = [a?, b?, c?];
            let mut recorder = trace.recorder.borrow_mut();
            // A tape that is too long is given up at the end.
            if recorder.definitions.len() > MOST_OPERATIONS {
                return Some((trace, ids[0]));
            }
            let id = recorder.define_apply(op, ids);
            let other = usize::from(x[0].is(0.0));
            let has_zero = x[..op.arity()].iter().any(|x| x.is(0.0));
            let origins = if op == Op::Square {
                Some(&trace.squares)
            } else if op == Op::Max && has_zero {
                Some(&trace.positive_parts)
            } else if op == Op::Min && has_zero {
                Some(&trace.negative_parts)
            } else {
                None
            };
            if let Some(origins) = origins {
                origins.borrow_mut().0.push((id, (ids[other], x[other].form)));
            }
            Some((trace, id))
        });
        Self { form, constant, source }
    }
}

macro_rules! traced_number {
    (
        unary { $($unary:ident = $unary_method:ident,)* }
        binary { $($binary:ident = $binary_method:ident,)* }
        ternary { $($ternary:ident = $ternary_method:ident,)* }
    ) => {
        impl Number for Traced<'_> {
            fn constant(value: f64) -> Self {
                Self { form: Affine::constant(value), constant: Some(value), source: None }
            }
            fn is_definitely_false(self) -> bool {
                self.form.is_definitely_false()
            }
            fn element(self, list: &[f64]) -> Self {
                let form = self.form.element(list);
                let constant = self.constant.map(|at| at.element(list));
                let source = self.source.map(|(trace, at)| {
                    let mut recorder = trace.recorder.borrow_mut();
                    let id = match constant {
                        Some(constant) => recorder.constant(constant),
                        None => recorder.lookup(list.to_vec(), at),
                    };
                    (trace, id)
                });
                Self { form, constant, source }
            }
            $(fn $unary_method(self) -> Self {
                Self::apply(Op::$unary, [self; 3])
            })*
            $(fn $binary_method(self, y: Self) -> Self {
                Self::apply(Op::$binary, [self, y, self])
            })*
            $(fn $ternary_method(self, y: Self, z: Self) -> Self {
                Self::apply(Op::$ternary, [self, y, z])
            })*
        }
    };
}

operations!(traced_number);
