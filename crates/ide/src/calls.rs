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

/// The innermost call whose brackets hold the offset.
pub fn open_call(text: &str, offset: usize) -> Option<OpenCall> {
    let mut tokens = classes(text);
    tokens.retain(|(class, range)| {
        range.start < offset && !matches!(class, Class::Comment | Class::Docs)
    });
    let (mut depth, mut argument) = (0_usize, 0);
    let mut start = tokens.len();
    let mut first = None;
    while let Some(at) = start.checked_sub(1) {
        start = at;
        let (class, range) = &tokens[at];
        let is_inside = range.end <= offset;
        match class {
            Class::Close if is_inside => depth += 1,
            Class::Open if depth > 0 => depth -= 1,
            Class::Open if is_inside => {
                first.get_or_insert(at + 1);
                let name = at.checked_sub(1).map(|before| &tokens[before]);
                if &text[range.clone()] != "(" {
                    if &text[range.clone()] == "{" {
                        return None;
                    }
                    // A list or a vector inside of the call.
                    (depth, argument, first) = (0, 0, None);
                    continue;
                }
                match name {
                    Some((Class::Name, name)) => {
                        let before = at.checked_sub(2).map(|it| &text[tokens[it].1.clone()]);
                        let before_that = at.checked_sub(3).map(|it| &tokens[it].0);
                        // A declaration is no call.
                        if let Some(("solid" | "region" | "shape" | "fn", _)) =
                            before.map(|before| (before, before_that))
                        {
                            return None;
                        }
                        let is_method = before == Some(".");
                        let label = first.and_then(|at| argument_name(text, &tokens, at));
                        let name = name.clone();
                        return Some(OpenCall { name, is_method, argument, argument_name: label });
                    }
                    Some(_) | None => (depth, argument, first) = (0, 0, None),
                }
            }
            Class::Punctuation if depth == 0 && &text[range.clone()] == "," && is_inside => {
                first.get_or_insert(at + 1);
                argument += 1;
            }
            Class::Keyword
                if depth == 0
                    && matches!(
                        &text[range.clone()],
                        "let" | "param" | "solid" | "region" | "import"
                    ) =>
            {
                return None;
            }
            Class::Comment
            | Class::Docs
            | Class::Keyword
            | Class::Name
            | Class::Number
            | Class::Color
            | Class::Text
            | Class::Operator
            | Class::Open
            | Class::Close
            | Class::Punctuation
            | Class::Unknown => {}
        }
    }
    None
}

fn argument_name(text: &str, tokens: &[(Class, Range<usize>)], at: usize) -> Option<String> {
    let ((class, name), (_, colon)) = (tokens.get(at)?, tokens.get(at + 1)?);
    let named = *class == Class::Name && &text[colon.clone()] == ":";
    named.then(|| text[name.clone()].to_owned())
}
