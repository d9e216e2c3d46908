//! Names, types, stages and elaboration of sdfc scenes; the library in `std`.
pub mod hir;
pub mod library;
pub mod settings;
