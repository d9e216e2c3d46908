//! The Language Server Protocol for sdfc scenes: it translates between the protocol and
//! `sdfc-ide`.
//!
//! [`serve`] answers the messages of a connection until the editor says that it ends. Open files
//! are kept in memory; other files come from a [`Disk`]. Positions are counted in UTF-16 code
//! units, or in bytes if the editor prefers UTF-8.

mod answers;
mod client;
mod convert;
mod documents;
mod lines;
mod server;
mod uri;

pub use documents::{Compile, Compiled, Disk};
pub use lsp_server::Connection;
pub use sdfc_ide::{Resolver, ShapeFacts};
pub use server::serve;
