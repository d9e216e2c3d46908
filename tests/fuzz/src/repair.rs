//! Makes a generated program one that the checker accepts.
//!
//! The generator knows types, not values. So an argument may be out of its range, or a `require` of
//! the library may not hold. The part that such an error points at is replaced. Any other error is
//! a fault, of the generator or of the checker.

use std::ops::Range;

use sdfc::{Compiler, Diagnostics};

use crate::tree::{Path, Printed, Program, Tree};
use crate::types::Ty;

/// The codes of errors that depend on values: a range, a `require`, a number that is not finite, an
/// index, a value that must be known when the scene compiles, a text that cannot be drawn.
const OF_VALUES: [&str; 6] = ["E0309", "E0310", "E0311", "E0312", "E0402", "E0413"];
/// The most parts that are replaced.
const ROUNDS: usize = 60;

/// A program that is accepted.
#[derive(Clone, Debug)]
pub struct Accepted {
    /// The program.
    pub program: Program,
    /// The number of parts that were replaced.
    pub replaced: usize,
}

/// Replaces parts with errors in values until the checker accepts the program.
///
/// # Errors
///
/// The program and the errors that no part can be replaced for.
pub fn repair(mut program: Program) -> Result<Accepted, (Program, String)> {
    for replaced in 0..ROUNDS {
        let printed = program.print();
        let errors = match Compiler::new().compile(NAME, &printed.text) {
            Ok(_) => return Ok(Accepted { program, replaced }),
            Err(errors) => errors,
        };
        match next(&program, &printed, &errors) {
            Some(better) => program = better,
            None => return Err((program, errors.without_warnings().to_string())),
        }
    }
    Err((program, format!("{ROUNDS} parts were replaced")))
}

/// The name of the program in messages.
pub const NAME: &str = "program.sdf";

/// Returns the program without the first error.
fn next(program: &Program, printed: &Printed, errors: &Diagnostics) -> Option<Program> {
    let sources = errors.sources();
    let error = errors.iter().find(|found| found.is_error())?;
    if !OF_VALUES.contains(&error.code.0) || sources.name(error.span.file) != NAME {
        return None;
    }
    let bytes = error.span.start as usize..error.span.end as usize;
    let path = innermost(printed, &bytes)?;
    // If the part is as simple as can be, the part around it is wrong.
    (1..=path.len()).rev().find_map(|length| {
        let path = &path[..length];
        let part = program.at(path)?;
        let simpler = replacement(part)?;
        (simpler != *part).then(|| program.with(path, simpler))
    })
}

/// Returns the path of the smallest part that holds the bytes.
fn innermost(printed: &Printed, bytes: &Range<usize>) -> Option<Path> {
    let holds = |range: &Range<usize>| range.start <= bytes.start && bytes.end <= range.end;
    let holding = printed.parts.iter().filter(|(_, range)| holds(range));
    holding.min_by_key(|(_, range)| range.len()).map(|(path, _)| path.clone())
}

/// Returns what stands for a part with an error: of a shape its first operand, else the simplest
/// value of its type.
fn replacement(part: &Tree) -> Option<Tree> {
    if part.ty == Ty::Statement {
        return None;
    }
    let operand = part.children().find(|child| child.ty == part.ty && part.ty.is_shape());
    let simplest = || Some(Tree::text(part.ty.clone(), part.ty.simplest()?));
    operand.cloned().or_else(simplest)
}
