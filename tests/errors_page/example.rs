//! A scene that has a diagnostic code, and the same scene fixed.

use std::sync::OnceLock;

use sdfc::{Compiler, Diagnostics};
use sdfc_diagnostics::{ALL_CODES, CodeInfo, Diagnostic, Note, render};
use sdfc_tests::repository;

/// The name of the scenes in messages.
const SCENE: &str = "scene.sdf";

/// The most characters of a message's line that a page shows.
const MAX_COLUMNS: usize = 160;

/// The two scenes of a code. `{{300 * (}}` stands for 300 opening brackets.
pub struct Example {
    pub code: &'static CodeInfo,
    pub wrong: String,
    pub fixed: String,
    /// The messages about the wrong scene as a page shows them, without notes about the library.
    pub messages: String,
    /// The codes of those messages.
    pub codes: Vec<&'static str>,
    /// The messages about the fixed scene.
    pub messages_of_fixed: String,
}

/// Returns the examples of all codes, each compiled once.
pub fn all() -> &'static [Example] {
    static ALL: OnceLock<Vec<Example>> = OnceLock::new();
    ALL.get_or_init(|| ALL_CODES.iter().map(Example::of).collect())
}

impl Example {
    fn of(code: &'static CodeInfo) -> Self {
        let folder = repository().join("tests/errors_page/examples");
        let path = folder.join(format!("{}.txt", code.code));
        let text = std::fs::read_to_string(&path)
            .unwrap_or_else(|e| panic!("every code has an example; {}: {e}", path.display()))
            .replace("\r\n", "\n");
        let (wrong, fixed) = text
            .split_once("\n----\n")
            .unwrap_or_else(|| panic!("{}: no line of four dashes", path.display()));
        let check = |text| Compiler::new().verify(true).check(SCENE, &expanded(text));
        let result = check(wrong);
        let messages = render(result.sources(), &without_library_notes(&result), false);
        let lines: Vec<String> = messages.trim_end().lines().map(shortened).collect();
        Self {
            code,
            wrong: wrong.to_owned(),
            fixed: fixed.trim_end().to_owned(),
            messages: lines.join("\n"),
            codes: result.iter().map(|diagnostic| diagnostic.code.0).collect(),
            messages_of_fixed: check(fixed).render(false),
        }
    }

    /// Explains the placeholder in the wrong scene, if there is one.
    pub fn placeholder(&self) -> Option<String> {
        let placeholder = self.wrong.split_once("{{")?.1.split_once("}}")?.0;
        let (count, part) = placeholder.split_once(" * ")?;
        let line_end = if part.contains("\\n") { "; `\\n` is a line break" } else { "" };
        Some(format!("`{{{{{placeholder}}}}}` stands for `{part}`, {count} times{line_end}."))
    }
}

/// Removes the notes about lines of the library, since line numbers there change often.
fn without_library_notes(diagnostics: &Diagnostics) -> Vec<Diagnostic> {
    let sources = diagnostics.sources();
    let in_library = |note: &Note| note.span.is_some_and(|at| sources.name(at.file) != SCENE);
    let mut list: Vec<Diagnostic> = diagnostics.iter().cloned().collect();
    for diagnostic in &mut list {
        diagnostic.notes.retain(|note| !in_library(note));
    }
    list
}

fn shortened(line: &str) -> String {
    if line.chars().count() <= MAX_COLUMNS {
        return line.trim_end().to_owned();
    }
    line.chars().take(MAX_COLUMNS).chain(" ...".chars()).collect()
}

/// Replaces the placeholders in a scene by what they stand for.
fn expanded(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, (placeholder, after))) =
        rest.split_once("{{").and_then(|(before, rest)| Some((before, rest.split_once("}}")?)))
    {
        let (count, part) = placeholder.split_once(" * ").unwrap();
        out.push_str(before);
        out.push_str(&part.replace("\\n", "\n").repeat(count.parse().unwrap()));
        rest = after;
    }
    out + rest
}
