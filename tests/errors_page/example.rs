//! A scene that has a code, and the same scene mended.

use std::sync::OnceLock;

use sdfc::{Compiled, check, lang::NoFiles};
use sdfc_diagnostics::{ALL_CODES, CodeInfo, Note};
use sdfc_tests::repository;

/// What the scenes are called.
const SCENE: &str = "scene.sdf";

/// What a page shows of a line that is longer.
const WIDEST: usize = 160;

/// The two scenes of a code. `{{300 * (}}` stands for so many round brackets.
pub struct Example {
    pub code: &'static CodeInfo,
    pub wrong: String,
    pub mended: String,
    /// What is said of the wrong scene, on a page, less the library's lines, and its codes.
    pub said: String,
    pub codes: Vec<&'static str>,
    /// What is said of the mended scene.
    pub said_of_mended: String,
}

/// Those of all codes, each compiled once.
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
        let (wrong, mended) = text
            .split_once("\n----\n")
            .unwrap_or_else(|| panic!("{}: four dashes part wrong from mended", path.display()));
        let compiled = |text| check(SCENE, &expanded(text), &NoFiles);
        let mut found = compiled(wrong);
        leave_out_the_library(&mut found);
        let said = found.diagnostics_text(false);
        let lines: Vec<String> = said.trim_end().lines().map(shortened).collect();
        Self {
            code,
            wrong: wrong.to_owned(),
            mended: mended.trim_end().to_owned(),
            said: lines.join("\n"),
            codes: found.diagnostics.iter().map(|found| found.code.0).collect(),
            said_of_mended: compiled(mended).diagnostics_text(false),
        }
    }

    /// What the marks in the scene stand for, if there are any.
    pub fn key(&self) -> Option<String> {
        let mark = self.wrong.split_once("{{")?.1.split_once("}}")?.0;
        let (count, part) = mark.split_once(" * ")?;
        let line_end = if part.contains("\\n") { ", `\\n` being the end of a line" } else { "" };
        Some(format!("`{{{{{mark}}}}}` stands for `{part}`, {count} times{line_end}."))
    }
}

/// Places in the library move with every line that is written above them: a page would change with each.
fn leave_out_the_library(found: &mut Compiled) {
    let sources = &found.sources;
    let in_library = |note: &Note| note.span.is_some_and(|at| sources.name(at.file) != SCENE);
    for diagnostic in &mut found.diagnostics {
        diagnostic.notes.retain(|note| !in_library(note));
    }
}

fn shortened(line: &str) -> String {
    if line.chars().count() <= WIDEST {
        return line.trim_end().to_owned();
    }
    line.chars().take(WIDEST).chain(" ...".chars()).collect()
}

fn expanded(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, (mark, after))) =
        rest.split_once("{{").and_then(|(before, rest)| Some((before, rest.split_once("}}")?)))
    {
        let (count, part) = mark.split_once(" * ").unwrap();
        out.push_str(before);
        out.push_str(&part.replace("\\n", "\n").repeat(count.parse().unwrap()));
        rest = after;
    }
    out + rest
}
