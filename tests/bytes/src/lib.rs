//! What must hold of any bytes: one function for each fuzz target, which panics if it does not
//! hold. The README beside this crate lists the targets and how to run them.
//!
//! Inputs of several parts are cut at the byte 0xFF, which no UTF-8 text contains. So a text by
//! itself is an input of one part, and scenes of the repository are a corpus for most targets.
#![deny(unsafe_code)]

mod boundary;
mod files;
mod protocol;
mod results;
mod scenes;
mod vocabulary;

pub use boundary::{capi, web};
pub use protocol::lsp;
pub use results::{mesh, picture};
pub use scenes::{font, imports, scene, text, tokens};

/// The name of the scene in every target.
const NAME: &str = "scene.sdf";

/// Returns the parts of an input; the first is always there.
fn parts(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes.split(|byte| *byte == 0xFF)
}
