//! An interpreter of optimised SPIR-V modules without branches, so that the code that is counted is
//! also the code that is evaluated.

use std::collections::HashMap;

use crate::spirv::{Instruction, instructions};

/// A vector; a number is a vector of one component.
type Value = Vec<f32>;

#[derive(Default)]
struct Interpreter {
    values: HashMap<u32, Value>,
    /// The number of components of each type.
    widths: HashMap<u32, usize>,
    /// The component of the variable that a pointer points at; `None` means all of it.
    pointers: HashMap<u32, Option<usize>>,
    /// The value of the only variable, `sample`.
    memory: [f32; 4],
}

/// Returns the distance at `point`.
///
/// # Errors
///
/// The module has an instruction that the interpreter does not know.
pub fn field(words: &[u32], point: [f32; 3]) -> Result<f32, String> {
    let memory = [point[0], point[1], point[2], 0.0];
    let mut interpreter = Interpreter { memory, ..Interpreter::default() };
    for instruction in instructions(words) {
        interpreter.step(&instruction)?;
    }
    Ok(interpreter.memory[3])
}

impl Interpreter {
    fn step(&mut self, instruction: &Instruction) -> Result<(), String> {
        let o = instruction.operands;
        match instruction.opcode {
            21 | 22 => drop(self.widths.insert(o[0], 1)),
            23 => drop(self.widths.insert(o[0], o[2] as usize)),
            43 => drop(self.values.insert(o[1], vec![f32::from_bits(o[2])])),
            44 | 80 => self.set(o[1], self.all(&o[2..])?.concat()),
            46 => self.set(o[1], vec![0.0; self.widths.get(&o[0]).copied().unwrap_or(1)]),
            59 => drop(self.pointers.insert(o[1], None)),
            61 => {
                let loaded = match self.pointers.get(&o[2]).ok_or("a pointer to nothing")? {
                    Some(at) => vec![self.memory[*at]],
                    None => self.memory.to_vec(),
                };
                self.set(o[1], loaded);
            }
            62 => {
                let stored = self.get(o[1])?.clone();
                match self.pointers.get(&o[0]).ok_or("a pointer to nothing")? {
                    Some(at) => self.memory[*at] = stored[0],
                    None => self.memory.copy_from_slice(&stored),
                }
            }
            // The variable is wrapped in a struct: index 0 is the variable, the next a component.
            65 | 66 => {
                let component = o.get(4).map(|index| self.get(*index)).transpose()?;
                let at = component.map(|index| index[0].to_bits() as usize);
                self.pointers.insert(o[1], at);
            }
            79 => {
                let joined = [self.get(o[2])?.clone(), self.get(o[3])?.clone()].concat();
                self.set(o[1], o[4..].iter().map(|i| joined[*i as usize]).collect());
            }
            81 => self.set(o[1], vec![self.get(o[2])?[o[3] as usize]]),
            127 => self.map(o, |x| -x[0])?,
            129 => self.map(o, |x| x[0] + x[1])?,
            131 => self.map(o, |x| x[0] - x[1])?,
            133 | 142 => self.map(o, |x| x[0] * x[1])?,
            136 => self.map(o, |x| x[0] / x[1])?,
            148 => {
                let (a, b) = (self.get(o[2])?, self.get(o[3])?);
                self.set(o[1], vec![a.iter().zip(b).map(|(a, b)| a * b).sum()]);
            }
            12 => self.extended(o)?,
            // Names, decorations, types, functions, labels and returns have no effect here.
            0..=20 | 24..=39 | 54..=58 | 71 | 72 | 248 | 253 => {}
            other => return Err(format!("unknown opcode {other}")),
        }
        Ok(())
    }

    /// Runs an instruction of `GLSL.std.450`.
    fn extended(&mut self, o: &[u32]) -> Result<(), String> {
        let shifted: Vec<u32> = [&o[..2], &o[4..]].concat();
        match o[3] {
            4 => self.map(&shifted, |x| x[0].abs()),
            31 => self.map(&shifted, |x| x[0].sqrt()),
            37 => self.map(&shifted, |x| x[0].min(x[1])),
            40 => self.map(&shifted, |x| x[0].max(x[1])),
            43 => self.map(&shifted, |x| x[0].max(x[1]).min(x[2])),
            46 => self.map(&shifted, |x| x[0] * (1.0 - x[2]) + x[1] * x[2]),
            50 => self.map(&shifted, |x| x[0] * x[1] + x[2]),
            66 => {
                let squares: f32 = self.get(o[4])?.iter().map(|x| x * x).sum();
                self.set(o[1], vec![squares.sqrt()]);
                Ok(())
            }
            other => Err(format!("unknown instruction {other} of GLSL.std.450")),
        }
    }

    /// Sets the result of `f`, applied to each component. A number is used with every component.
    fn map(&mut self, o: &[u32], f: impl Fn(&[f32]) -> f32) -> Result<(), String> {
        let arguments = self.all(&o[2..])?;
        let width = arguments.iter().map(Vec::len).max().unwrap_or(1);
        let at = |argument: &Value, i: usize| {
            if argument.len() == 1 { argument[0] } else { argument[i] }
        };
        let column = |i| arguments.iter().map(|a| at(a, i)).collect::<Vec<f32>>();
        self.set(o[1], (0..width).map(|i| f(&column(i))).collect());
        Ok(())
    }

    fn get(&self, id: u32) -> Result<&Value, String> {
        self.values.get(&id).ok_or_else(|| format!("%{id} has no value"))
    }

    fn all(&self, ids: &[u32]) -> Result<Vec<Value>, String> {
        ids.iter().map(|id| self.get(*id).cloned()).collect()
    }

    fn set(&mut self, id: u32, value: Value) {
        self.values.insert(id, value);
    }
}
