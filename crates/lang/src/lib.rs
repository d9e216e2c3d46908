//! Names, types, stages and elaboration of sdfc scenes; the library in `std`.
mod check;
pub mod hir;
pub mod library;
pub mod settings;

pub use check::{check, check_library};
