//! Running a tape.

use super::affine::Affine;
use super::frame::FrameValues;
use super::interval::{BranchPath, Interval};
use super::number::Number;
use super::scalarise::Lanes;
use super::tape::{Code, Definition, Instruction, LoopCode, POINT_LANES, Tape};
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

    /// An evaluator for a frame, whose values are computed in one number type and then converted.
    pub(super) fn evaluator<F: Number, N: Number>(
        &self,
        frame: &FrameValues<F>,
        convert: impl Fn(F) -> N,
    ) -> Evaluator<'_, N> {
        let zero = N::constant(0.0);
        let mut registers = vec![zero; self.registers];
        for (register, value) in registers.iter_mut().zip(self.kept_values(frame)) {
            *register = convert(value);
        }
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

/// A tape with its registers, ready for the points of one frame. Evaluating allocates nothing. Each
/// thread uses its own clone.
#[derive(Clone, Debug)]
pub struct Evaluator<'t, N> {
    tape: &'t Tape,
    registers: Vec<N>,
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
                *entry = self.registers[register as usize];
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
                *value = self.registers[register as usize];
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

    fn first(&self) -> N {
        let first = self.tape.outputs.first();
        first.map_or(N::constant(0.0), |lanes| self.registers[lanes.get(0) as usize])
    }

    fn run(&mut self, points: &[[N; POINT_LANES]], tracer: &mut impl Tracer<N>) {
        let registers = self.registers.as_mut_slice();
        let lanes = registers[self.tape.kept.len()..].iter_mut();
        for (register, &lane) in lanes.zip(points.as_flattened()) {
            *register = lane;
        }
        for code in &self.tape.body {
            code.run(registers, &self.tape.lists, tracer);
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

impl Code {
    /// Runs the code; returns the condition if this is a test.
    fn run<N: Number>(
        &self,
        registers: &mut [N],
        lists: &[Vec<f64>],
        tracer: &mut impl Tracer<N>,
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
                registers[*result as usize] = tracer.jumped(*op, arguments, value);
            }
            Self::Lookup { list, at, result } => {
                registers[*result as usize] = registers[*at as usize].element(&lists[*list]);
            }
            Self::Test(condition) => return Some(registers[*condition as usize]),
            Self::Loop(code) => code.run(registers, lists, tracer),
        }
        None
    }
}

impl LoopCode {
    /// Runs iterations until no more can follow. Where the number type cannot decide whether one
    /// follows, the variables go on, and the result covers both their old and their new value.
    fn run<N: Number>(&self, registers: &mut [N], lists: &[Vec<f64>], tracer: &mut impl Tracer<N>) {
        for state in &self.state {
            let init = registers[state.init as usize];
            registers[state.variable as usize] = init;
            registers[state.result as usize] = init;
        }
        let mut running = N::constant(1.0);
        for index in 0..self.max_iterations {
            let index = N::constant(f64::from(index));
            registers[self.index as usize] = index;
            if let Some(count) = self.count {
                running = running.and(index.lt(registers[count as usize]));
                if running.is_definitely_false() {
                    return;
                }
            }
            for code in &self.body {
                if let Some(condition) = code.run(registers, lists, tracer) {
                    running = running.and(condition);
                    if running.is_definitely_false() {
                        return;
                    }
                }
            }
            for state in &self.state {
                registers[state.copy as usize] = registers[state.step as usize];
            }
            for state in &self.state {
                let step = registers[state.copy as usize];
                registers[state.variable as usize] = step;
                let before = registers[state.result as usize];
                registers[state.result as usize] = running.select(step, before);
            }
        }
    }
}
