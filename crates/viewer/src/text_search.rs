//! Search in a text, and replacement of what is found.

use std::ops::Range;

use regex::{NoExpand, Regex, RegexBuilder};

/// The most matches that are found.
pub const MAX_MATCHES: usize = 10_000;

/// What is searched for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Query {
    /// The text to find, not a pattern. An empty one is found nowhere.
    pub text: String,
    /// True if `A` does not match `a`.
    pub match_case: bool,
    /// True if `box` does not match in `boxes`.
    pub whole_word: bool,
}

impl Query {
    /// The byte ranges that match, in order, at most [`MAX_MATCHES`]. They do not overlap.
    pub fn find_all(&self, text: &str) -> Vec<Range<usize>> {
        let Some(regex) = self.regex() else { return Vec::new() };
        regex.find_iter(text).take(MAX_MATCHES).map(|found| found.range()).collect()
    }

    /// The text with every match replaced.
    pub fn replace_all(&self, text: &str, replacement: &str) -> String {
        match self.regex() {
            Some(regex) => regex.replace_all(text, NoExpand(replacement)).into_owned(),
            None => text.to_owned(),
        }
    }

    /// `None` if nothing is searched for, or if the text is too long for the crate.
    fn regex(&self) -> Option<Regex> {
        if self.text.is_empty() {
            return None;
        }
        let text = regex::escape(&self.text);
        let pattern = match self.whole_word {
            true => format!(r"\b{{start-half}}{text}\b{{end-half}}"),
            false => text,
        };
        RegexBuilder::new(&pattern).case_insensitive(!self.match_case).build().ok()
    }
}

/// The index of the first match that starts at or behind an offset; else that of the first match.
pub fn next_match(found: &[Range<usize>], offset: usize) -> Option<usize> {
    let index = found.partition_point(|range| range.start < offset);
    let last = found.len().checked_sub(1)?;
    Some(if index > last { 0 } else { index })
}

/// The index of the last match that ends at or before an offset; else that of the last match.
pub fn previous_match(found: &[Range<usize>], offset: usize) -> Option<usize> {
    let before = found.partition_point(|range| range.end <= offset);
    let last = found.len().checked_sub(1)?;
    Some(before.checked_sub(1).unwrap_or(last))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "box(1) | Box(2)\nboxes(3) // (box), größe Größe\n";

    fn query(text: &str, match_case: bool, whole_word: bool) -> Query {
        Query { text: text.to_owned(), match_case, whole_word }
    }

    #[test]
    fn case_and_words_are_respected_if_asked_for() {
        let count = |text, case, word| query(text, case, word).find_all(TEXT).len();
        assert_eq!(count("box", false, false), 4);
        assert_eq!(count("box", true, false), 3);
        assert_eq!(count("box", false, true), 3);
        assert_eq!(count("box", true, true), 2);
        // The query is not a pattern, and case is ignored beyond ASCII too.
        assert_eq!([count("(", false, false), count(".", false, false)], [4, 0]);
        assert_eq!([count("GRÖSSE", false, false), count("GRÖßE", false, false)], [0, 2]);
        assert_eq!(count("", false, false), 0);
    }

    #[test]
    fn every_match_is_replaced_by_the_text_as_it_is() {
        let replaced = query("box", true, true).replace_all(TEXT, "$0");
        assert_eq!(replaced, "$0(1) | Box(2)\nboxes(3) // ($0), größe Größe\n");
        assert_eq!(query("", true, true).replace_all("a", "b"), "a");
    }

    #[test]
    fn next_and_previous_go_around_the_ends() {
        let found = [2..4, 6..8];
        assert_eq!([0, 2, 3, 6, 7].map(|at| next_match(&found, at)), [0, 0, 1, 1, 0].map(Some));
        assert_eq!([0, 3, 4, 8].map(|at| previous_match(&found, at)), [1, 1, 0, 1].map(Some));
        assert_eq!((next_match(&[], 0), previous_match(&[], 0)), (None, None));
    }
}
