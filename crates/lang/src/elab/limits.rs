//! The limits of elaboration.

/// The largest number of bytes of a string that `str` joins.
pub const MAX_TEXT_BYTES: usize = 16_384;
/// The largest number of graph nodes of a scene.
pub const MAX_NODES: usize = 1_000_000;
/// The largest number of expressions that are evaluated, counting repetitions.
pub const MAX_STEPS: u64 = 40_000_000;
/// The largest number of active calls of one function.
pub const MAX_RECURSION: u32 = 64;
/// The largest nesting depth of shapes.
pub const MAX_DEPTH: u32 = 1024;
/// The largest number of iterations of an `iterate` over a count or a range. Over a list there is
/// one iteration per element.
pub const MAX_ITERATIONS: usize = 4096;
/// The largest number of iterations of nested loops, multiplied.
pub const MAX_NESTED_ITERATIONS: usize = 65_536;
