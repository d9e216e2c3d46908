//! The names and code that can be written at the cursor.
//!
//! - `context`: the kind of text at the cursor;
//! - `values`: names in scope;
//! - `members`: completions after a dot;
//! - `arguments`: names of parameters;
//! - `strings`: paths and choices between quotes;
//! - `words`: types, clauses, imported names and snippets.

mod arguments;
mod context;
mod item;
mod members;
mod strings;
mod values;
mod words;

use std::ops::Range;

use rustc_hash::FxHashSet;
use sdfc_lang::Resolver;
use sdfc_syntax::{Class, classes};

use crate::analysis::Analysis;
use context::Context;
use item::CURSOR;

pub use item::{Completion, CompletionKind};

/// Returns what can be written at a byte offset of a text. The editor filters by what is typed.
///
/// `files` are the paths that an import can name, relative to the folder of the scene.
pub fn complete(
    name: &str,
    text: &str,
    offset: usize,
    resolver: &dyn Resolver,
    files: &[String],
) -> Vec<Completion> {
    if !text.is_char_boundary(offset) {
        return Vec::new();
    }
    let touched =
        classes(text).into_iter().find(|(_, range)| range.start < offset && offset <= range.end);
    match touched {
        Some((Class::Comment | Class::Docs | Class::Number | Class::Color, _)) => {
            return Vec::new();
        }
        Some((Class::Text, range)) if offset < range.end || !is_closed(&text[range.clone()]) => {
            return strings::strings(name, text, (offset, range), resolver, files);
        }
        Some(_) | None => {}
    }
    let word = word_around(text, offset);
    if text[word.clone()].starts_with(|c: char| c.is_ascii_digit()) {
        return Vec::new();
    }
    let marked = format!("{}{CURSOR}{}", &text[..word.start], &text[word.end..]);
    let analysis = Analysis::at_cursor(name, &marked, resolver, CURSOR);
    let mut found = match context::context(&analysis, word.start) {
        Context::Nothing => Vec::new(),
        Context::Type => words::types(),
        Context::Clause => words::clauses(),
        Context::Imported(path) => words::imported(&analysis, &path),
        Context::Member(ty) => members::members(&analysis, &ty),
        Context::ArgumentName => arguments::arguments(&analysis, word.start),
        Context::Value { starts_item, in_call } => {
            let mut found = match in_call {
                true => arguments::arguments(&analysis, word.start),
                false => Vec::new(),
            };
            found.extend(values::values(&analysis, starts_item));
            found.extend(words::expressions());
            if starts_item {
                found.extend(words::items());
            }
            found
        }
    };
    // The library declares some names twice, and a name in scope hides those behind it.
    let mut seen = FxHashSet::default();
    found.retain(|it| seen.insert(it.label.clone()));
    let called = text[word.end..].starts_with('(');
    for it in &mut found {
        it.replace = word.clone();
        if called {
            it.insert = it.insert.split('(').next().unwrap_or_default().to_owned();
        }
    }
    found
}

fn is_closed(text: &str) -> bool {
    text.len() > 1 && text.ends_with('"')
}

/// The letters, digits and `_` around an offset.
fn word_around(text: &str, offset: usize) -> Range<usize> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let before = text[..offset].trim_end_matches(is_part).len();
    let behind = text[offset..].trim_start_matches(is_part).len();
    before..text.len() - behind
}
