//! From a recording to a tape: dropping unused operations and allocating registers.

use super::record::{RecordedLoop, Recorder};
use super::scalarise::Lanes;
use super::tape::{Code, Definition, Instruction, LoopCode, POINT_LANES, StateCode, Tape};

/// The last time that the body reads a value.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum LastRead {
    Never,
    By(u32),
    /// The value is an output.
    AfterEnd,
}

/// Which values the outputs need, and until when.
struct Liveness {
    needed: Vec<bool>,
    last_read: Vec<LastRead>,
}

impl Recorder {
    /// The tape that computes these values.
    pub(super) fn finish(&mut self, outputs: Vec<Lanes<u32>>) -> Tape {
        let liveness = self.liveness(&outputs);
        let mut locations = vec![0; self.definitions.len()];
        let prelude = self.prelude(&liveness, &mut locations);
        let kept = self.keep(&liveness, &mut locations);
        let (body, registers) = self.body(&liveness, kept.len(), &mut locations);
        let outputs = outputs
            .iter()
            .map(|lanes| Lanes::new(lanes.as_slice().len(), |i| locations[lanes.get(i) as usize]))
            .collect();
        let (operations, lists) = (operations(&body), std::mem::take(&mut self.lists));
        let is_constant =
            prelude.iter().all(|definition| matches!(definition, Definition::Constant(_)));
        Tape { prelude, is_constant, kept, body, operations, lists, registers, outputs }
    }

    fn liveness(&self, outputs: &[Lanes<u32>]) -> Liveness {
        let count = self.definitions.len();
        let (needed, last_read) = (vec![false; count], vec![LastRead::Never; count]);
        let mut liveness = Liveness { needed, last_read };
        for &value in outputs.iter().flat_map(Lanes::as_slice) {
            liveness.needed[value as usize] = true;
            liveness.last_read[value as usize] = LastRead::AfterEnd;
        }
        for position in (0..count).rev() {
            let needed = match self.definitions[position] {
                // A loop runs if any of its results is read, and then all its registers are in use.
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
                | Definition::Register => liveness.needed[position],
            };
            liveness.needed[position] = needed;
            if needed {
                self.read_by(position, |value| {
                    liveness.needed[value as usize] = true;
                    if self.varying[position] {
                        let last = LastRead::By(self.read_until(value, position));
                        let before = &mut liveness.last_read[value as usize];
                        *before = last.max(*before);
                    }
                });
            }
        }
        liveness
    }

    /// Calls a function with the values that are read at an index, or must keep their registers
    /// until then.
    fn read_by(&self, position: usize, mut read: impl FnMut(u32)) {
        match self.definitions[position] {
            Definition::Apply(op, arguments) => {
                arguments[..op.arity()].iter().copied().for_each(read);
            }
            Definition::Lookup(_, at) => read(at),
            Definition::Enter(id) => self.loops[id].init.iter().copied().for_each(read),
            Definition::Test(id) => self.loops[id].condition.into_iter().for_each(read),
            Definition::Leave(id) => {
                let RecordedLoop { count, index, variables, copies, results, step, .. } =
                    &self.loops[id];
                let lists = [variables, copies, results, step].into_iter().flatten();
                lists.chain(count).chain([index]).copied().for_each(read);
            }
            Definition::Constant(_)
            | Definition::Input(..)
            | Definition::Point(_)
            | Definition::Register => {}
        }
    }

    /// The definitions that do not depend on the point, in order. Afterwards `locations` holds
    /// their indices in the result.
    fn prelude(&self, liveness: &Liveness, locations: &mut [u32]) -> Vec<Definition> {
        let mut prelude = Vec::new();
        for (value, &definition) in self.definitions.iter().enumerate() {
            if self.varying[value] || !liveness.needed[value] {
                continue;
            }
            locations[value] = prelude.len() as u32;
            prelude.push(match definition {
                Definition::Apply(op, arguments) => {
                    Definition::Apply(op, arguments.map(|a| locations[a as usize]))
                }
                Definition::Lookup(list, at) => Definition::Lookup(list, locations[at as usize]),
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

    /// The per-frame values that the body or an output reads. Afterwards `locations` holds their
    /// registers.
    fn keep(&self, liveness: &Liveness, locations: &mut [u32]) -> Vec<u32> {
        let mut kept = Vec::new();
        for (value, &last_read) in liveness.last_read.iter().enumerate() {
            if !self.varying[value] && last_read != LastRead::Never {
                let register = kept.len() as u32;
                kept.push(std::mem::replace(&mut locations[value], register));
            }
        }
        kept
    }

    /// The code that runs at a point, and the number of registers it takes. A result may take the
    /// register of an argument that dies there, since arguments are read before the result is
    /// written.
    fn body(&self, liveness: &Liveness, kept: usize, locations: &mut [u32]) -> (Vec<Code>, usize) {
        // The registers that the current definition frees.
        let mut released = Vec::new();
        // The innermost open loop is the last entry.
        let mut bodies: Vec<Vec<Code>> = vec![Vec::new()];
        let points = usize::from(self.levels.max(1)) * POINT_LANES;
        let mut registers = Registers { free: Vec::new(), count: kept + points };
        for (value, &definition) in self.definitions.iter().enumerate() {
            if !self.varying[value] || !liveness.needed[value] {
                continue;
            }
            released.clear();
            self.release(value, liveness, locations, &mut released);
            match definition {
                Definition::Point(lane) => locations[value] = (kept + lane) as u32,
                Definition::Apply(op, arguments) => {
                    let arguments = arguments.map(|a| locations[a as usize]);
                    registers.free.append(&mut released);
                    let result = registers.take();
                    locations[value] = result;
                    append(&mut bodies, Instruction { op, result, arguments });
                }
                Definition::Lookup(list, at) => {
                    let at = locations[at as usize];
                    registers.free.append(&mut released);
                    locations[value] = registers.take();
                    let lookup = Code::Lookup { list, at, result: locations[value] };
                    push(&mut bodies, lookup);
                }
                Definition::Register => locations[value] = registers.take(),
                Definition::Enter(_) => bodies.push(Vec::new()),
                Definition::Test(id) => {
                    let condition = self.loops[id].condition.unwrap_or_default();
                    let test = Code::Test(locations[condition as usize]);
                    push(&mut bodies, test);
                    registers.free.append(&mut released);
                }
                Definition::Leave(id) => {
                    let body = bodies.pop().unwrap_or_default();
                    let code = Code::Loop(self.loops[id].code(body, locations));
                    push(&mut bodies, code);
                    registers.free.append(&mut released);
                }
                Definition::Constant(_) | Definition::Input(..) => {}
            }
        }
        (bodies.pop().unwrap_or_default(), registers.count)
    }

    /// Adds the registers of values that are needed here for the last time, each once.
    fn release(
        &self,
        position: usize,
        liveness: &Liveness,
        locations: &[u32],
        released: &mut Vec<u32>,
    ) {
        let dies = |value: usize| {
            let is_register = matches!(
                self.definitions[value],
                Definition::Apply(..) | Definition::Lookup(..) | Definition::Register
            );
            is_register
                && self.varying[value]
                && liveness.last_read[value] == LastRead::By(position as u32)
        };
        if let Definition::Leave(_) = self.definitions[position] {
            // Values that the body reads from outside die here too.
            let dying = (0..position).filter(|&value| dies(value));
            released.extend(dying.map(|value| locations[value]));
            return;
        }
        self.read_by(position, |value| {
            // In the order of values, so that registers do not depend on the order of arguments.
            if dies(value as usize) && !released.contains(&value) {
                released.push(value);
            }
        });
        released.sort_unstable();
        for value in released {
            *value = locations[*value as usize];
        }
    }
}

/// Free registers, and the total number of registers.
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

/// Number of operations, if all loops run for as many iterations as they may.
fn operations(body: &[Code]) -> usize {
    let of = |code: &Code| match code {
        Code::Straight(instructions) => instructions.len(),
        Code::Lookup { .. } | Code::Test(_) => 1,
        Code::Loop(code) => {
            (code.max_iterations as usize).saturating_mul(operations(&code.body) + 1)
        }
    };
    body.iter().map(of).fold(0, usize::saturating_add)
}

impl RecordedLoop {
    /// The loop in terms of registers.
    fn code(&self, body: Vec<Code>, locations: &[u32]) -> LoopCode {
        let location = |value: u32| locations[value as usize];
        let state = (0..self.variables.len()).map(|i| StateCode {
            init: location(self.init[i]),
            variable: location(self.variables[i]),
            step: location(self.step[i]),
            copy: location(self.copies[i]),
            result: location(self.results[i]),
        });
        LoopCode {
            max_iterations: self.max_iterations,
            count: self.count.map(location),
            index: location(self.index),
            state: state.collect(),
            body,
        }
    }
}
