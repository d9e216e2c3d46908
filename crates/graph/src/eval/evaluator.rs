//! Running a tape.

use super::affine::Affine;
use super::frame::FrameValues;
use super::interval::{BranchPath, Interval};
use super::number::Number;
use super::registers::Registers;
use super::scalarise::Lanes;
use super::tape::{Definition, POINT_LANES, Tape};
use super::tracer::{NoTrace, Tracer};

impl Tape {
    /// An evaluator for a frame. Per-frame values are computed in f64 and then rounded to the
    /// number type, as for the shader, whose uniforms hold the rounded values.
    pub fn prepare<N: Number>(&self, frame: &FrameValues) -> Evaluator<'_, N> {
        self.evaluator(frame, N::constant)
    }

    /// An evaluator for all frames whose values lie in the given ones. The per-frame part too is
    /// computed in the number type, for example in intervals over the ranges of params.
    pub fn prepare_in<N: Number>(&self, frame: &FrameValues<N>) -> Evaluator<'_, N> {
        self.evaluator(frame, |value| value)
    }

    /// An evaluator for a frame that computes up to `width` numbers with each instruction, see
    /// [`Evaluator::scalars`].
    pub fn prepare_wide<N: Number>(&self, frame: &FrameValues, width: usize) -> Evaluator<'_, N> {
        self.prepare_in_buffer(frame, width, Vec::new())
    }

    /// As [`Self::prepare_wide`], with the memory of another evaluator.
    pub fn prepare_in_buffer<N: Number>(
        &self,
        frame: &FrameValues,
        width: usize,
        buffer: Vec<N>,
    ) -> Evaluator<'_, N> {
        self.wide_evaluator(frame, N::constant, width.max(1), buffer)
    }

    /// An evaluator for a frame, whose values are computed in one number type and then converted.
    pub(super) fn evaluator<F: Number, N: Number>(
        &self,
        frame: &FrameValues<F>,
        convert: impl Fn(F) -> N,
    ) -> Evaluator<'_, N> {
        self.wide_evaluator(frame, convert, 1, Vec::new())
    }

    fn wide_evaluator<F: Number, N: Number>(
        &self,
        frame: &FrameValues<F>,
        convert: impl Fn(F) -> N,
        width: usize,
        mut numbers: Vec<N>,
    ) -> Evaluator<'_, N> {
        let zero = N::constant(0.0);
        numbers.resize(self.registers * width, zero);
        let registers = numbers.chunks_exact_mut(width);
        if self.is_constant {
            for (register, &value) in registers.zip(&self.kept) {
                let Definition::Constant(value) = self.prelude[value as usize] else { continue };
                register.fill(convert(F::constant(value)));
            }
        } else {
            for (register, value) in registers.zip(self.kept_values(frame)) {
                register.fill(convert(value));
            }
        }
        let registers = Registers { numbers, width, used: 1 };
        Evaluator { tape: self, registers, outputs: vec![[zero; 4]; self.outputs.len()] }
    }

    /// The per-frame values that points need: what the tape computes at a point depends on the
    /// frame by these alone.
    pub fn point_inputs(&self, frame: &FrameValues) -> Vec<f64> {
        self.kept_values(frame).collect()
    }

    fn kept_values<F: Number>(&self, frame: &FrameValues<F>) -> impl Iterator<Item = F> {
        let mut values: Vec<F> = Vec::with_capacity(self.prelude.len());
        for definition in &self.prelude {
            values.push(match *definition {
                Definition::Constant(value) => F::constant(value),
                Definition::Input(input, lane) => frame.lane(input, lane),
                Definition::Point(_) => F::constant(f64::NAN), // never in a prelude
                Definition::Apply(op, arguments) => op.apply(|i| values[arguments[i] as usize]),
                Definition::Lookup(list, at) => values[at as usize].element(&self.lists[list]),
                // Loops run at points only.
                Definition::Enter(_)
                | Definition::Test(_)
                | Definition::Leave(_)
                | Definition::Register => F::constant(f64::NAN),
            });
        }
        self.kept.iter().map(move |&value| values[value as usize])
    }
}

/// A tape with its registers, ready for the points of one frame. Evaluating allocates nothing, but
/// for loops. Each thread uses its own clone.
#[derive(Clone, Debug)]
pub struct Evaluator<'t, N> {
    tape: &'t Tape,
    registers: Registers<N>,
    outputs: Vec<[N; 4]>,
}

impl<N: Number> Evaluator<'_, N> {
    /// The roots' values at a point, in the roots' order. Lanes beyond a root's width are 0. For 2D
    /// shapes the last lane of the point is ignored.
    pub fn eval(&mut self, point: [N; 3]) -> &[[N; 4]] {
        self.run(&[point], &mut NoTrace);
        self.read()
    }

    /// Like [`Self::eval`], for a tape made by [`Tape::for_rays`].
    pub fn eval_ray(&mut self, origin: [N; 3], direction: [N; 3]) -> &[[N; 4]] {
        self.run(&[origin, direction], &mut NoTrace);
        self.read()
    }

    /// Like [`Self::eval`], for a tape made by [`Tape::for_surfaces`]. The normal and the direction
    /// to the eye are unit vectors.
    pub fn eval_surface(&mut self, point: [N; 3], normal: [N; 3], view: [N; 3]) -> &[[N; 4]] {
        self.run(&[point, normal, view], &mut NoTrace);
        self.read()
    }

    fn read(&mut self) -> &[[N; 4]] {
        for (output, lanes) in self.outputs.iter_mut().zip(&self.tape.outputs) {
            for (entry, &register) in output.iter_mut().zip(lanes.as_slice()) {
                *entry = self.registers.get(register);
            }
        }
        &self.outputs
    }

    /// The values of registers after evaluation at points. Lanes beyond those given are 0.
    pub(super) fn registers_at(
        &mut self,
        points: &[[N; POINT_LANES]],
        outputs: &[Lanes<u32>],
    ) -> Vec<[N; 4]> {
        self.run(points, &mut NoTrace);
        let of = |lanes: &Lanes<u32>| {
            let mut values = [N::constant(0.0); 4];
            for (value, &register) in values.iter_mut().zip(lanes.as_slice()) {
                *value = self.registers.get(register);
            }
            values
        };
        outputs.iter().map(of).collect()
    }

    /// The first lane of the first root at a point; 0 without roots.
    pub fn scalar(&mut self, point: [N; 3]) -> N {
        self.run(&[point], &mut NoTrace);
        self.first()
    }

    /// The first lane of the first root at points, in their order; 0 without roots. Each
    /// instruction is decoded once for as many points as the evaluator is wide.
    ///
    /// ```
    /// use sdfc_graph::eval::{FrameValues, Packet, Tape};
    /// use sdfc_graph::{Dim, Graph};
    ///
    /// let mut graph = Graph::new();
    /// let point = graph.point(0, Dim::Three);
    /// let root = graph.length(point);
    /// let tape = Tape::new(&graph, &[root])?;
    /// let points = [1.0, 2.0, 3.0].map(|x| [x, 0.0, 0.0].map(|x| Packet([x, -2.0 * x])));
    ///
    /// let mut lengths = [Packet([0.0f32; 2]); 3];
    /// let mut evaluator = tape.prepare_wide(&FrameValues::default(), 2);
    /// evaluator.scalars(&points, &mut lengths);
    /// assert_eq!(lengths, [Packet([1.0, 2.0]), Packet([2.0, 4.0]), Packet([3.0, 6.0])]);
    /// # Ok::<(), sdfc_graph::eval::TapeError>(())
    /// ```
    pub fn scalars(&mut self, points: &[[N; 3]], values: &mut [N]) {
        let width = self.registers.width;
        let kept = self.tape.kept.len() * width;
        for (points, values) in points.chunks(width).zip(values.chunks_mut(width)) {
            let lanes = &mut self.registers.numbers[kept..];
            for (axis, register) in lanes.chunks_exact_mut(width).take(POINT_LANES).enumerate() {
                for (number, point) in register.iter_mut().zip(points) {
                    *number = point[axis];
                }
            }
            self.registers.used = points.len();
            self.run_body(&mut NoTrace);
            let first = self.tape.outputs.first().map(|lanes| lanes.get(0) as usize * width);
            for (k, value) in values.iter_mut().enumerate() {
                *value = first.map_or(N::constant(0.0), |first| self.registers.numbers[first + k]);
            }
        }
    }

    /// The memory of the registers, for [`Tape::prepare_in_buffer`].
    pub fn into_buffer(self) -> Vec<N> {
        self.registers.numbers
    }

    fn first(&self) -> N {
        let first = self.tape.outputs.first();
        first.map_or(N::constant(0.0), |lanes| self.registers.get(lanes.get(0)))
    }

    fn run(&mut self, points: &[[N; POINT_LANES]], tracer: &mut impl Tracer<N>) {
        let width = self.registers.width;
        self.registers.used = 1;
        let registers = self.registers.numbers.chunks_exact_mut(width).skip(self.tape.kept.len());
        for (register, &lane) in registers.zip(points.as_flattened()) {
            register[0] = lane;
        }
        self.run_body(tracer);
    }

    fn run_body(&mut self, tracer: &mut impl Tracer<N>) {
        for code in &self.tape.body {
            code.run(&mut self.registers, &self.tape.lists, tracer);
        }
    }
}

impl Evaluator<'_, Interval> {
    /// The first lane of the first root over a box, on one path through its jumps. The path records
    /// which jumps it leaves open.
    pub fn scalar_along(&mut self, point: [Interval; 3], path: &mut BranchPath) -> Interval {
        path.begin();
        self.run(&[point], &mut { path });
        self.first()
    }
}

impl Evaluator<'_, Affine> {
    /// The first lane of the first root over a box that may be rotated, on one path through its
    /// jumps, without comparisons. The path records which jumps it leaves open.
    pub fn scalar_along(&mut self, point: [Affine; 3], path: &mut BranchPath) -> Affine {
        path.begin();
        self.run(&[point], &mut { path });
        self.first()
    }
}
