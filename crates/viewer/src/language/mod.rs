//! Answers about the text while someone types: roles of words, descriptions, completions.

pub mod completions;
pub mod worker;
