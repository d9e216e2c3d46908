//! What must hold of every text: a list of free functions.

use std::collections::BTreeSet;

use sdfc::{Compiler, Diagnostics};
use sdfc_diagnostics::{FileId, Severity};
use sdfc_ide::{Analysis, NoFiles};

use crate::oracles::{Finding, Outcome, Verdict, finding};
use crate::repair::NAME;

/// A statement about texts.
#[derive(Clone, Copy, Debug)]
pub struct TextOracle {
    /// The name on the command line.
    pub name: &'static str,
    /// The statement.
    pub summary: &'static str,
    /// The function that decides it.
    pub holds: fn(&str) -> Outcome,
}

/// All oracles of texts.
pub const TEXT_ORACLES: [TextOracle; 3] = [
    TextOracle {
        name: "errors",
        summary: "a text compiles, or its errors have places in it and words",
        holds: errors,
    },
    TextOracle {
        name: "layout",
        summary: "what can be formatted stays so, with the same errors",
        holds: layout,
    },
    TextOracle {
        name: "service",
        summary: "the language service answers everywhere, with the errors of the compiler",
        holds: service,
    },
];

/// The places in a text at which the language service is asked.
const PLACES: usize = 12;

/// Code, start and end of each error.
type Errors = BTreeSet<(&'static str, usize, usize)>;

fn diagnostics(text: &str) -> Diagnostics {
    match Compiler::new().compile(NAME, text) {
        Ok(scene) => scene.diagnostics().clone(),
        Err(errors) => errors,
    }
}

fn errors(text: &str) -> Outcome {
    let found = diagnostics(text);
    for it in &found {
        let source = found.sources().text(it.span.file);
        if source.get(it.span.start as usize..it.span.end as usize).is_none() {
            return Err(finding("no place", format!("{:?}: {}", it.span, it.message)));
        }
        if it.message.trim().is_empty() || it.code.0.is_empty() {
            return Err(finding("no words", format!("{it:?}")));
        }
    }
    let shown = found.render(false);
    if found.is_empty() || shown.contains(found.iter().map(|it| it.code.0).next().unwrap_or("")) {
        return Ok(Verdict::Holds);
    }
    Err(finding("not shown", shown))
}

fn layout(text: &str) -> Outcome {
    let Ok(once) = sdfc::format(NAME, text) else { return Ok(Verdict::LeftOut) };
    let twice = sdfc::format(NAME, &once).map_err(|e| finding("refused again", e))?;
    if once != twice {
        return Err(finding("not idempotent", format!("{once}\nbecomes\n{twice}")));
    }
    // Formatting moves places, and may join two notes about one name, but no error goes.
    let codes = |text: &str| -> BTreeSet<&'static str> {
        diagnostics(text).iter().filter(|it| it.is_error()).map(|it| it.code.0).collect()
    };
    let (before, after) = (codes(text), codes(&once));
    if before != after {
        return Err(finding("other errors", format!("{before:?}, then {after:?}:\n{once}")));
    }
    Ok(Verdict::Holds)
}

pub(crate) fn service(text: &str) -> Outcome {
    let scene = Analysis::new(NAME, text, &NoFiles);
    let shown: Errors = sdfc_ide::diagnostics(&scene, false)
        .into_iter()
        .chain(sdfc_ide::late_diagnostics(&scene, &NoFiles))
        .filter(|it| it.severity == Severity::Error)
        .map(|it| (it.code, it.range.start, it.range.end))
        .collect();
    let compiled = compiler_errors(text);
    if let Some(missing) = compiled.symmetric_difference(&shown).next() {
        return Err(finding("other errors", format!("only one reports {missing:?}")));
    }
    for part in 0..=PLACES {
        let at = text.len() * part / PLACES;
        let at = (0..=at).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
        ask(&scene, at)?;
    }
    Ok(Verdict::Holds)
}

/// Code and place of each error that the compiler tells about the text itself.
fn compiler_errors(text: &str) -> Errors {
    let found = diagnostics(text);
    let own = (0..found.sources().len() as u32).map(FileId);
    let own: Vec<FileId> = own.filter(|file| found.sources().name(*file) == NAME).collect();
    let errors = found.iter().filter(|it| it.is_error() && own.contains(&it.span.file));
    errors.map(|it| (it.code.0, it.span.start as usize, it.span.end as usize)).collect()
}

/// Asks everything that an editor asks at a place. Every answer lies in the text.
fn ask(scene: &Analysis, at: usize) -> Result<(), Finding> {
    let text = scene.text();
    let mut ranges = Vec::new();
    ranges.extend(sdfc_ide::hover(scene, at, &mut |_| None).map(|it| it.range));
    ranges.extend(sdfc_ide::highlights(scene, at).into_iter().map(|it| it.0));
    ranges.extend(sdfc_ide::selection(scene, at));
    ranges.extend(sdfc_ide::prepare_rename(scene, at).ok());
    let completions = sdfc_ide::complete(NAME, text, at, &NoFiles, &[]);
    ranges.extend(completions.into_iter().map(|it| it.replace));
    sdfc_ide::signature_help(scene, at);
    sdfc_ide::references(scene, &[], at, true);
    sdfc_ide::definition(scene, at);
    sdfc_ide::actions(scene, at..at);
    match ranges.into_iter().find(|range| text.get(range.clone()).is_none()) {
        Some(range) => Err(finding("outside", format!("at {at}: {range:?}"))),
        None => Ok(()),
    }
}
