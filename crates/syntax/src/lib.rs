//! Lexer, error-tolerant parser, AST and formatter of the sdfc language.
//!
//! # What
//!
//! [`parse`] turns the text of a file into an [`ast::File`] and its syntax errors. [`format()`]
//! formats a file. The crate knows only the grammar: no names, no types, no shapes.
//!
//! # How
//!
//! The lexer splits the text into tokens; the parser builds the tree. Expressions are parsed by
//! precedence in loops. After an error the parser continues at the next comma or closing bracket,
//! or at the next line that begins an item. Text that could not be parsed is
//! [`ast::ExprKind::Error`] in the tree, so that later phases can ignore it. One position has at
//! most one error.
//!
//! ```
//! use sdfc_diagnostics::{Sources, render};
//!
//! let mut sources = Sources::new();
//! let file = sources.add("scene.sdf", "let ball = sphere(1) box(2)\nball\n");
//! let (tree, diagnostics) = sdfc_syntax::parse(&sources, file);
//! assert_eq!(tree.items.len(), 2);
//! assert!(render(&sources, &diagnostics, false).contains("join solids with `|`"));
//! ```
//!
//! # Limits
//!
//! A file has at most [`MAX_BYTES`]. Brackets, blocks and types nest at most [`MAX_NESTING`] deep.
//! No expression is more than [`MAX_HEIGHT`] nodes high, however it is written (a chain
//! `a | b | c` adds one node for each operator). So recursion over a tree is bounded: a stack of
//! 2 MiB is enough for a recursion that takes up to 512 bytes per node. Cloning, comparing and
//! printing a tree extend the stack where that is not enough. After [`MAX_ERRORS`] errors the
//! rest are only counted.

pub mod ast;
mod classes;
mod format;
mod lexer;
mod literal;
mod parser;
mod token;

pub use classes::{Class, classes, is_reserved};
pub use format::format;
pub use parser::{parse, parse_part};

/// The largest file in bytes: 4 MiB.
pub const MAX_BYTES: usize = 4 << 20;

/// The maximum nesting of brackets, blocks, conditions and types.
pub const MAX_NESTING: u32 = 256;

/// The maximum height of an expression, in nodes.
pub const MAX_HEIGHT: u32 = 4096;

/// The number of errors of one file that are reported one by one.
pub const MAX_ERRORS: usize = 100;
