//! The call around a position, by its tokens, so that it is found in unfinished text too.

use std::ops::Range;

use sdfc_syntax::{Class, classes};

/// An unfinished or finished call around the cursor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpenCall {
    /// The name that is called.
    pub name: Range<usize>,
    /// True for `x.name(...)`.
    pub is_method: bool,
    /// The index of the argument at the cursor.
    pub argument: usize,
    /// The name of that argument, if it has one.
    pub argument_name: Option<String>,
}

/// Words that begin an item, which a call cannot reach beyond.
const STARTS_ITEM: [&str; 6] = ["let", "param", "solid", "region", "shape", "import"];

type Token = (Class, Range<usize>);

/// Returns the innermost call whose brackets hold the offset.
pub fn open_call(text: &str, offset: usize) -> Option<OpenCall> {
    let mut tokens = classes(text);
    tokens.retain(|(class, range)| {
        range.end <= offset && !matches!(class, Class::Comment | Class::Docs)
    });
    // The number of brackets that are closed before the offset, the argument at the offset, and
    // the index of its first token.
    let (mut depth, mut argument, mut first) = (0_usize, 0, None);
    for (at, (class, range)) in tokens.iter().enumerate().rev() {
        let word = &text[range.clone()];
        if *class == Class::Close {
            depth += 1;
        } else if *class == Class::Open && depth > 0 {
            depth -= 1;
        } else if *class == Class::Open {
            let before = tokens[..at].last();
            if let (Some((Class::Name, name)), "(") = (before, word) {
                let first = first.unwrap_or(at + 1);
                return call(text, &tokens, at - 1, name.clone(), (argument, first));
            }
            if word == "{" {
                return None;
            }
            // A list, a vector or parentheses inside of the call.
            (argument, first) = (0, None);
        } else if depth == 0 && word == "," {
            first.get_or_insert(at + 1);
            argument += 1;
        } else if depth == 0 && *class == Class::Keyword && STARTS_ITEM.contains(&word) {
            return None;
        }
    }
    None
}

/// The call of the name at an index, unless that is the head of a declaration.
fn call(
    text: &str,
    tokens: &[Token],
    at: usize,
    name: Range<usize>,
    (argument, first): (usize, usize),
) -> Option<OpenCall> {
    let before = tokens[..at].last().map(|(_, range)| &text[range.clone()]);
    if matches!(before, Some("solid" | "region" | "shape" | "fn")) {
        return None;
    }
    let argument_name = argument_name(text, tokens, first);
    Some(OpenCall { name, is_method: before == Some("."), argument, argument_name })
}

fn argument_name(text: &str, tokens: &[Token], at: usize) -> Option<String> {
    let ((class, name), (_, colon)) = (tokens.get(at)?, tokens.get(at + 1)?);
    let named = *class == Class::Name && &text[colon.clone()] == ":";
    named.then(|| text[name.clone()].to_owned())
}
