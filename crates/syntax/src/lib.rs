//! Lexer, error-tolerant parser, AST and formatter of the sdfc language.
pub mod ast;
