//! Words that the repository no longer uses, because a standard term exists.

use crate::files::texts;
use crate::report;

/// Files that may name retired terms: this one, the changelog, which says what was renamed, and the
/// words of other programs that users may type.
const EXEMPT: [&str; 3] = ["tests/tidy/terms.rs", "CHANGELOG.md", "crates/lang/src/synonyms.rs"];

/// How a term is searched for.
#[derive(Clone, Copy)]
enum Kind {
    /// A word of prose, or a part of a name, such as `lamp` in `lamp_color` and `LampColor`. The
    /// plural counts too.
    Word,
    /// A whole name in code, in this case.
    Name,
    /// A sequence of words in one line, in any case.
    Phrase,
}

/// A term that is retired below a folder.
struct Term {
    term: &'static str,
    kind: Kind,
    folder: &'static str,
    instead: &'static str,
}

const fn word(term: &'static str, instead: &'static str) -> Term {
    Term { term, kind: Kind::Word, folder: "", instead }
}

const fn name(term: &'static str, instead: &'static str) -> Term {
    Term { term, kind: Kind::Name, folder: "", instead }
}

const fn phrase(term: &'static str, instead: &'static str) -> Term {
    Term { term, kind: Kind::Phrase, folder: "", instead }
}

const fn march(term: &'static str, instead: &'static str) -> Term {
    Term { term, kind: Kind::Word, folder: "crates/march/", instead }
}

const fn viewer(term: &'static str, instead: &'static str) -> Term {
    Term { term, kind: Kind::Word, folder: "crates/viewer/", instead }
}

const TERMS: &[Term] = &[
    word("lamp", "light"),
    word("mend", "fix, suggestion"),
    word("mended", "fixed"),
    word("painted", "has a material"),
    word("unpainted", "default material"),
    word("told", "reported"),
    word("unwatched", "no_progress, NoTrace"),
    word("yardstick", "hand-written baseline"),
    name("Excess", "ClampResidual"),
    name("Inert", "SkipCondition"),
    name("Parabola", "XTimesOneMinusX"),
    name("Unwatched", "NoTrace"),
    name("Visit", "CullableLoop"),
    name("asked_of_rays", "the analytic pre-intersection"),
    name("counted_module", "instrumented_module"),
    name("go_on", "condition"),
    name("is_broken", "is_violated"),
    name("is_never", "is_definitely_false"),
    name("leave_the_eye", "has_secondary_rays"),
    name("measured_module", "benchmark_module"),
    name("posed_module", "render_module_with_camera"),
    name("ways_to_mend", "suggestions"),
    phrase("the processor", "the CPU"),
    march("knob", "method parameter"),
    viewer("attendant", "worker thread"),
    viewer("clerk", "export worker"),
    viewer("court", "accuracy worker"),
    viewer("errand", "job"),
    viewer("judge", "accuracy worker"),
    viewer("knob", "slider"),
    viewer("letter", "message"),
    viewer("mailbox", "latest-value channel"),
    viewer("shop", "compile worker"),
];

/// The names of a line, and the words that they consist of.
struct Line<'a> {
    names: Vec<&'a str>,
    words: Vec<String>,
}

impl<'a> Line<'a> {
    fn new(line: &'a str) -> Self {
        let names = line.split(|c: char| !c.is_alphanumeric() && c != '_');
        let names: Vec<&str> = names.filter(|name| !name.is_empty()).collect();
        let words = names.iter().flat_map(|name| words(name)).collect();
        Self { names, words }
    }

    fn has(&self, term: &Term) -> bool {
        let is_word =
            |word: &String| word == term.term || word.strip_suffix('s') == Some(term.term);
        match term.kind {
            Kind::Name => self.names.contains(&term.term),
            Kind::Word => self.words.iter().any(is_word),
            Kind::Phrase => {
                let term: Vec<&str> = term.term.split(' ').collect();
                self.words.windows(term.len()).any(|words| words == term)
            }
        }
    }
}

/// Splits a name at underscores and before capitals, and returns the parts in lower case.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut is_lower = false;
    for letter in name.chars() {
        if letter == '_' || (letter.is_uppercase() && is_lower) {
            words.push(String::new());
        }
        if letter != '_' {
            words.last_mut().unwrap().extend(letter.to_lowercase());
        }
        is_lower = letter.is_lowercase();
    }
    words.retain(|word| !word.is_empty());
    words
}

#[test]
fn retired_terms_are_not_used() {
    let mut found = Vec::new();
    for (path, text) in texts(&["rs", "wgsl", "sdf", "md", "toml", "snap"]) {
        if EXEMPT.contains(&path.as_str()) {
            continue;
        }
        let terms: Vec<&Term> = TERMS.iter().filter(|t| path.starts_with(t.folder)).collect();
        for (index, line) in text.lines().enumerate() {
            let line = Line::new(line);
            for term in terms.iter().filter(|term| line.has(term)) {
                let (term, instead) = (term.term, term.instead);
                found.push((path.clone(), format!("line {}: {term}: {instead}", index + 1)));
            }
        }
    }
    report(&found);
}

#[test]
fn terms_are_found_in_prose_and_names() {
    let lamp = word("lamp", "light");
    for line in ["a lamp", "Lamps", "lamp_color", "SoftLamp(1)"] {
        assert!(Line::new(line).has(&lamp), "{line}");
    }
    for line in ["clamp", "lampoon", "oil"] {
        assert!(!Line::new(line).has(&lamp), "{line}");
    }
    assert!(Line::new("Visit::new").has(&name("Visit", "CullableLoop")));
    assert!(!Line::new("visit, Visitor").has(&name("Visit", "CullableLoop")));
    assert!(Line::new("on the processor.").has(&phrase("the processor", "the CPU")));
}
