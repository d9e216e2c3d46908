//! The instruction tapes that evaluate a scene's field on the CPU.

use sdfc_graph::Program;
use sdfc_graph::eval::{Tape, TapeError};

/// Tapes of the distance and the material.
#[derive(Debug)]
pub(crate) struct Tapes {
    pub(crate) distance: Tape,
    /// The fields of `MaterialField::ALL`, if the scene has materials.
    pub(crate) material: Option<Tape>,
}

impl Tapes {
    /// Returns the tapes of a program, or `None` if it draws nothing.
    pub(crate) fn of(program: &Program) -> Result<Option<Self>, TapeError> {
        let Some(distance) = program.distance else { return Ok(None) };
        let tape = |roots: &[_]| Tape::new(&program.graph, roots);
        let material = program.material.map(|fields| tape(&fields)).transpose()?;
        Ok(Some(Self { distance: tape(&[distance])?, material }))
    }
}
