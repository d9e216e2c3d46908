//! The completions that fit what is typed.

use std::ops::Range;

use sdfc_ide::Completion;

use crate::language::worker::LanguageAnswer;

/// The most completions that are listed.
const MAX_LISTED: usize = 9;

/// The completions at the cursor that begin with the word in front of it, the best ones first.
/// Without a word, those behind a dot.
pub fn matching<'a>(answer: &'a LanguageAnswer, text: &str, cursor: usize) -> Vec<&'a Completion> {
    if answer.request.cursor != Some(cursor) || *answer.request.text != *text {
        return Vec::new();
    }
    let typed = |it: &Completion| text.get(it.replace.start..cursor).map(str::to_lowercase);
    let after_dot =
        |it: &Completion| text.get(..it.replace.start).is_some_and(|t| t.ends_with('.'));
    let fits = |it: &&Completion| {
        typed(it).is_some_and(|typed| {
            let wanted = !typed.is_empty() || after_dot(it);
            wanted && it.label.to_lowercase().starts_with(&typed) && it.label != typed
        })
    };
    let mut found: Vec<&Completion> = answer.completions.iter().filter(fits).collect();
    found.sort_by_key(|it| (it.rank, it.label.clone()));
    found.truncate(MAX_LISTED);
    found
}

/// The text that a completion inserts, and the first gap to fill in, which is selected. `$0` and
/// `${1:name}` are gaps.
pub fn inserted(completion: &Completion) -> (String, Range<usize>) {
    let (mut text, mut gap) = (String::new(), None);
    let mut rest = completion.insert.as_str();
    while let Some((before, after)) = rest.split_once('$') {
        text.push_str(before);
        let start = text.len();
        rest = match after.strip_prefix('{').and_then(|inner| inner.split_once('}')) {
            Some((inner, behind)) => {
                text.push_str(inner.split_once(':').map_or("", |(_, name)| name));
                behind
            }
            None => after.trim_start_matches(|c: char| c.is_ascii_digit()),
        };
        gap = gap.or(Some(start..text.len()));
    }
    text.push_str(rest);
    let end = text.len();
    (text, gap.unwrap_or(end..end))
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::mpsc::channel;

    use super::*;
    use crate::language::worker::{LanguageRequest, LanguageWorker};
    use crate::test_support::TIMEOUT;

    fn answer(text: &str) -> LanguageAnswer {
        let (sender, answers) = channel();
        let worker = LanguageWorker::new(sender, || {}).unwrap();
        let (path, cursor) = (Path::new("a.sdf"), Some(text.len()));
        worker.send(LanguageRequest { cursor, ..LanguageRequest::new(path, text) });
        answers.recv_timeout(TIMEOUT).unwrap()
    }

    #[test]
    fn completions_begin_with_what_is_typed() {
        let labels = |text: &str| -> Vec<String> {
            let answer = answer(text);
            matching(&answer, text, text.len()).iter().map(|it| it.label.clone()).collect()
        };
        assert!(labels("sph").contains(&"sphere".to_owned()));
        assert!(labels("sph").iter().all(|label| label.starts_with("sph")));
        assert!(labels("sphere(1).").len() > 3);
        assert_eq!(labels("let a = 1\n"), [""; 0]);
        // The answer is about another text.
        assert!(matching(&answer("sph"), "sphe", 4).is_empty());
    }

    #[test]
    fn the_first_gap_of_a_completion_is_selected() {
        let of = |insert: &str| {
            let mut completion = answer("sph").completions[0].clone();
            completion.insert = insert.to_owned();
            inserted(&completion)
        };
        assert_eq!(of("sphere"), ("sphere".to_owned(), 6..6));
        assert_eq!(of("box(${1:size}, ${2:r})$0"), ("box(size, r)".to_owned(), 4..8));
        assert_eq!(of("union($0)"), ("union()".to_owned(), 6..6));
    }
}
