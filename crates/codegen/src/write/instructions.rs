//! Counts the instructions of functions in SPIR-V words.
//!
//! A module is five words of header, then instructions: the upper half of an instruction's first
//! word is its length in words, the lower half its opcode (SPIR-V specification, section 2.3).

use rustc_hash::FxHashMap;

use crate::reflection::Role;

const HEADER: usize = 5;
const OP_NAME: u32 = 5;
const OP_EXT_INST: u32 = 12;
const OP_FUNCTION: u32 = 54;
const OP_FUNCTION_PARAMETER: u32 = 55;
const OP_FUNCTION_END: u32 = 56;
const OP_LABEL: u32 = 248;
const OP_BRANCH: u32 = 249;

/// The cost of one function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FunctionCost {
    /// The function's role.
    pub role: Role,
    /// The number of instructions, without those that only frame the function (function,
    /// parameters, labels, branches, end).
    pub instructions: u32,
    /// The number of instructions that compute: conversion, arithmetic, comparison, logic,
    /// selection, and GLSL.std.450. Composing and taking apart vectors, loads and stores are not
    /// counted.
    pub arithmetic: u32,
}

/// Counts the instructions of the given functions. The words must contain names.
pub(crate) fn count(
    words: &[u32],
    functions: impl Iterator<Item = (Role, String)>,
) -> Vec<FunctionCost> {
    let mut ids = FxHashMap::default();
    let mut costs = FxHashMap::<u32, (u32, u32)>::default();
    let mut current = None;
    for (opcode, operands) in Instructions(words.get(HEADER..).unwrap_or_default()) {
        match (opcode, operands) {
            (OP_NAME, [id, name @ ..]) => {
                ids.entry(text(name)).or_insert(*id);
            }
            (OP_FUNCTION, [_, id, ..]) => current = Some(*id),
            (OP_FUNCTION_END, _) => current = None,
            (OP_FUNCTION_PARAMETER | OP_LABEL | OP_BRANCH, _) => {}
            _ => {
                if let Some(id) = current {
                    let (all, arithmetic) = costs.entry(id).or_default();
                    *all += 1;
                    *arithmetic += u32::from(computes(opcode));
                }
            }
        }
    }
    let cost = |(role, name): (Role, String)| {
        let found = ids.get(&name).and_then(|id| costs.get(id));
        let (instructions, arithmetic) = found.copied().unwrap_or_default();
        FunctionCost { role, instructions, arithmetic }
    };
    functions.map(cost).collect()
}

/// Returns true for `OpExtInst`; `OpConvertFToU` to `OpFConvert`; `OpSNegate` to `OpSMulExtended`
/// (arithmetic, products of matrices and vectors); `OpAny` to `OpFUnordGreaterThanEqual` (logic,
/// selection, comparison); `OpShiftRightLogical` to `OpBitCount`.
fn computes(opcode: u32) -> bool {
    matches!(opcode, OP_EXT_INST | 109..=115 | 126..=152 | 154..=191 | 194..=205)
}

/// Decodes a string literal: UTF-8, least significant byte first, ended by zero.
fn text(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|&byte| byte != 0);
    String::from_utf8_lossy(&bytes.collect::<Vec<_>>()).into_owned()
}

/// Iterates over the opcode and operands of each instruction. Ends at a length that is zero or
/// beyond the words.
struct Instructions<'a>(&'a [u32]);

impl<'a> Iterator for Instructions<'a> {
    type Item = (u32, &'a [u32]);

    fn next(&mut self) -> Option<Self::Item> {
        let head = *self.0.first()?;
        let (length, opcode) = ((head >> 16) as usize, head & 0xffff);
        let operands = self.0.get(1..length)?;
        self.0 = &self.0[length..];
        Some((opcode, operands))
    }
}
