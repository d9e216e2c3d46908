//! Random programs over the whole language.
//!
//! # What
//!
//! [`generate()`] makes a program from a seed, and [`repair()`] one that the checker accepts.
//! [`shrink()`] makes a program as small as it can be while something holds of it. The list
//! [`oracles::ORACLES`] states what must hold of every program, and [`campaign::run`] asks for it.
//!
//! # How
//!
//! A program is a [`tree::Tree`] of typed parts. The generator calls what [`catalogue::Catalogue`]
//! reads from the reference, so a new shape of the library is generated without a change here.
//!
//! # Limits
//!
//! The generator writes what type checks. Texts with errors in them are left to tests of the
//! parser.

pub mod campaign;
pub mod catalogue;
mod generate;
mod kernel;
pub mod oracles;
mod repair;
mod shrink;
pub mod table;
pub mod texts;
pub mod tree;
pub mod types;
pub mod workers;

pub use generate::generate;
pub use kernel::LEFT_OUT;
pub use repair::{Accepted, NAME, repair};
pub use shrink::shrink;
