//! The Language Server Protocol for sdfc scenes: it translates between the protocol and
//! `sdfc-ide`.
//!
//! [`serve`] answers the messages of a connection until the editor says that it ends. Open files
//! are kept in memory; other files come from a [`Disk`]. Positions are counted in UTF-16 code
//! units, or in bytes if the editor prefers UTF-8.
//!
//! Pictures and params ([`Ask`]) are asked of the program, through [`Draw`]. It answers on a thread
//! of its own, so that no other request waits for a picture.

mod answers;
mod client;
mod convert;
mod documents;
mod lines;
mod preview;
mod questions;
mod server;
mod uri;

pub use documents::{Compile, Compiled, Disk};
pub use lsp_server::Connection;
pub use preview::{
    Answer, Ask, MAX_SIDE, ParamInfo, ParamValue, Preview, PreviewCamera, PreviewLens,
    PreviewOptions,
};
pub use questions::{Draw, Question, Questions};
pub use sdfc_ide::{Resolver, ShapeFacts};
pub use server::serve;
