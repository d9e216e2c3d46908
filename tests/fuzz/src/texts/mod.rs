//! Texts with mistakes in them, what must hold of each, and a campaign over them.
//!
//! A text is a scene of the repository or a snippet of its pages, changed as typing, deleting and
//! pasting change it, and sometimes as no person would.

mod campaign;
mod damage;
mod files;
mod mutations;
pub mod oracles;
mod shrink;

pub use campaign::run;
pub use damage::damaged;
pub use files::files;
pub use mutations::mutated;
pub use shrink::shrink;
