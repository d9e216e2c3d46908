//! What the interpreting baselines read: scenes as rows of tables, for shaders that look up at every
//! evaluation what a specialised shader has been compiled from.
//!
//! [`units()`] knows a scene by the library's names, the only code outside the library that does; [`tape()`] knows
//! it by its flat math.

mod tape;
mod units;

pub use tape::tape;
pub use units::units;

/// A scene for an interpreter.
#[derive(Clone, Debug, PartialEq)]
pub struct Encoded {
    /// Contents of the storage buffers, from binding 3 on; none is empty.
    pub tables: Vec<Vec<u8>>,
    /// How many turns the interpreter's loop takes at each evaluation of the field.
    pub turns: usize,
    /// How many leaves it evaluates there.
    pub leaves: usize,
}

/// What of a scene an interpreter cannot express, in one sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inexpressible(pub String);

/// Numbers as a storage buffer holds them: in the order of bytes of the machine, which is its GPU's.
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
