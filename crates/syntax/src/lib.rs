//! Lexer, error-tolerant parser, AST and formatter of the sdfc language.
//!
//! # What
//!
//! [`parse`] turns the text of a file into an [`ast::File`] and everything that is wrong with
//! how it is written; [`format()`] rewrites a file in the one layout. The crate knows the grammar
//! and nothing else: no name, no type, no shape.
//!
//! # How
//!
//! Text, tokens, tree. Expressions are parsed by precedence in loops. After an error the parser
//! goes on at the next comma or closing bracket, or at the next line that begins an item; what
//! could not be read is [`ast::ExprKind::Error`] in the tree, so that later phases can stay
//! silent about it. One place has at most one error.
//!
//! ```
//! use sdfc_diagnostics::{Sources, render};
//!
//! let mut sources = Sources::new();
//! let file = sources.add("scene.sdf", "let ball = sphere(1) box(2)\nball\n");
//! let (tree, found) = sdfc_syntax::parse(&sources, file);
//! assert_eq!(tree.items.len(), 2);
//! assert!(render(&sources, &found, false).contains("join solids with `|`"));
//! ```
//!
//! # Limits
//!
//! A file has at most [`MAX_BYTES`]; brackets, blocks and types nest at most [`MAX_NESTING`]
//! deep; no expression is more than [`MAX_HEIGHT`] nodes high, however it is written (a chain
//! `a | b | c` adds one for each operator). So recursion over a tree is bounded, and a stack of
//! 2 MiB holds one that takes up to 512 bytes a node. Cloning, comparing and printing a tree
//! extend the stack where that is not enough. After [`MAX_ERRORS`] errors the rest are counted.

pub mod ast;
mod format;
mod lexer;
mod literal;
mod parser;
mod token;

pub use format::format;
pub use parser::{parse, parse_part};

/// The largest file in bytes: 4 MiB.
pub const MAX_BYTES: usize = 4 << 20;

/// How deep brackets, blocks, conditions and types may be nested.
pub const MAX_NESTING: u32 = 256;

/// How many nodes high an expression may be.
pub const MAX_HEIGHT: u32 = 4096;

/// How many errors of one file are reported one by one.
pub const MAX_ERRORS: usize = 100;
