//! Helpers that several tests of this folder share.

pub mod agree;
mod examples;
mod markdown;
mod pictures;
pub mod validators;

pub use examples::{compile_examples, compiled_example, compiled_examples};
pub use markdown::wrapped;
pub use pictures::is_same_picture;
pub use sdfc_test_support::{example_sources, examples_folder, repository};
