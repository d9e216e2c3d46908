//! The compiler for web pages.
