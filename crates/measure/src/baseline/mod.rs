//! Encodes scenes as tables for the interpreting baselines: shaders that read the scene from
//! buffers at every evaluation.
//!
//! [`units()`] recognises shapes by the names of the library, as the only code outside the library;
//! [`tape()`] encodes the flat math.

mod tape;
mod units;

pub use tape::tape;
pub use units::units;

/// A scene for an interpreter.
#[derive(Clone, Debug, PartialEq)]
pub struct Encoded {
    /// Contents of the storage buffers, from binding 3 on; none is empty.
    pub tables: Vec<Vec<u8>>,
    /// Iterations of the interpreter's loop per evaluation of the field.
    pub iterations: usize,
    /// Leaves evaluated per evaluation of the field.
    pub leaves: usize,
}

/// One sentence that says what an interpreter cannot express.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inexpressible(pub String);

/// The bytes of a storage buffer, in the byte order of the machine, which is that of its GPU.
#[derive(Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn floats(&mut self, values: &[f32]) -> &mut Self {
        self.0.extend(values.iter().flat_map(|value| value.to_ne_bytes()));
        self
    }

    fn words(&mut self, values: &[u32]) -> &mut Self {
        self.0.extend(values.iter().flat_map(|value| value.to_ne_bytes()));
        self
    }
}
