//! Ranges of growing size around a position, for "expand selection".

use std::ops::Range;

use sdfc_syntax::{Class, classes};

use crate::analysis::Analysis;
use crate::edit::range;
use crate::tree::path;

/// Returns the ranges around a byte offset, smallest first: the word, the expressions around it,
/// the item, the file.
pub fn selection(analysis: &Analysis, offset: usize) -> Vec<Range<usize>> {
    let text = analysis.text();
    let mut ranges: Vec<Range<usize>> =
        path(&analysis.tree, offset).into_iter().rev().map(|node| range(node.span())).collect();
    let is_word = |class: &Class| {
        !matches!(class, Class::Open | Class::Close | Class::Punctuation | Class::Operator)
    };
    let word = classes(text)
        .into_iter()
        .find(|(class, range)| is_word(class) && range.start <= offset && offset <= range.end);
    if let Some((_, word)) = word {
        ranges.insert(0, word);
    }
    ranges.push(0..text.len());
    let mut growing: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        let grows = growing.last().is_none_or(|last| {
            range.start <= last.start && last.end <= range.end && range != *last
        });
        if grows {
            growing.push(range);
        }
    }
    growing
}
