//! The registers of a tape, and the code that runs on them.

use super::number::Number;
use super::tape::{Code, Instruction, LoopCode};
use super::tracer::Tracer;
use super::vectors::vectorized;

/// Registers of `width` numbers, of which the first `used` ones are computed.
#[derive(Clone, Debug)]
pub(super) struct Registers<N> {
    pub(super) numbers: Vec<N>,
    pub(super) width: usize,
    pub(super) used: usize,
}

impl<N: Number> Registers<N> {
    /// The first number of a register.
    pub(super) fn get(&self, register: u32) -> N {
        self.numbers[register as usize * self.width]
    }

    /// The numbers of a register that are computed.
    fn all(&self, register: u32) -> &[N] {
        let first = register as usize * self.width;
        &self.numbers[first..first + self.used]
    }

    /// Sets the numbers of a register, by their position.
    fn set(&mut self, register: u32, value: impl Fn(&Self, usize) -> N) {
        let first = register as usize * self.width;
        for k in 0..self.used {
            self.numbers[first + k] = value(self, k);
        }
    }

    fn copy(&mut self, from: u32, to: u32) {
        let [from, to] = [from, to].map(|register| register as usize * self.width);
        self.numbers.copy_within(from..from + self.used, to);
    }

    /// Runs instructions in sequence.
    fn run(&mut self, instructions: &[Instruction], tracer: &mut impl Tracer<N>) {
        if N::HAS_VECTORS {
            vectorized(
                #[inline(always)]
                || self.run_in_order(instructions, tracer),
            );
        } else {
            self.run_in_order(instructions, tracer);
        }
    }

    #[inline(always)]
    fn run_in_order<T: Tracer<N>>(&mut self, instructions: &[Instruction], tracer: &mut T) {
        let Self { numbers, width, used, .. } = self;
        for &Instruction { op, result, arguments } in instructions {
            let result = result as usize * *width;
            let places = arguments.map(|register| register as usize * *width);
            if T::IS_ACTIVE && op.jumps() {
                let arguments = places.map(|place| numbers[place]);
                let value = op.apply(|i| arguments[i]);
                numbers[result] = tracer.jumped(op, arguments, value);
            } else {
                op.apply_all(numbers, result, places, *used);
            }
        }
    }
}

impl Code {
    /// Runs the code; returns the register of the condition if this is a test.
    pub(super) fn run<N: Number>(
        &self,
        registers: &mut Registers<N>,
        lists: &[Vec<f64>],
        tracer: &mut impl Tracer<N>,
    ) -> Option<u32> {
        match self {
            Self::Straight(instructions) => registers.run(instructions, tracer),
            Self::Lookup { list, at, result } => {
                let list = &lists[*list];
                registers.set(*result, |registers, k| registers.all(*at)[k].element(list));
            }
            Self::Test(condition) => return Some(*condition),
            Self::Loop(code) => code.run(registers, lists, tracer),
        }
        None
    }
}

/// For each number of a register, whether its iterations go on.
struct Running<N>(Vec<N>);

impl<N: Number> Running<N> {
    /// Stops where a condition is false; returns false if none goes on.
    fn stop(&mut self, condition: impl Fn(usize) -> N) -> bool {
        for (k, running) in self.0.iter_mut().enumerate() {
            *running = running.and(condition(k));
        }
        !self.0.iter().all(|running| running.is_definitely_false())
    }
}

impl LoopCode {
    /// Runs iterations until no more can follow. Where the number type cannot decide whether one
    /// follows, the variables go on, and the result covers both their old and their new value.
    fn run<N: Number>(
        &self,
        registers: &mut Registers<N>,
        lists: &[Vec<f64>],
        tracer: &mut impl Tracer<N>,
    ) {
        for state in &self.state {
            registers.copy(state.init, state.variable);
            registers.copy(state.init, state.result);
        }
        let mut running = Running(vec![N::constant(1.0); registers.used]);
        for index in 0..self.max_iterations {
            let index = N::constant(f64::from(index));
            registers.set(self.index, |_, _| index);
            if let Some(count) = self.count
                && !running.stop(|k| index.lt(registers.all(count)[k]))
            {
                return;
            }
            for code in &self.body {
                if let Some(condition) = code.run(registers, lists, tracer)
                    && !running.stop(|k| registers.all(condition)[k])
                {
                    return;
                }
            }
            for state in &self.state {
                registers.copy(state.step, state.copy);
            }
            for state in &self.state {
                registers.copy(state.copy, state.variable);
                registers.set(state.result, |registers, k| {
                    let [step, before] = [state.copy, state.result].map(|r| registers.all(r)[k]);
                    running.0[k].select(step, before)
                });
            }
        }
    }
}
