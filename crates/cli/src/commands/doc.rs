//! `sdfc doc`: prints the reference of the language.

mod page;

use sdfc_diagnostics::{ALL_CODES, CodeInfo};
use sdfc_lang::library::Entry;
use sdfc_lang::reference;
use serde::Serialize;

use crate::args::Doc;
use crate::console::Console;
use crate::failure::Failure;
use crate::output;

use page::Page;

/// An entry as JSON. Other tools rely on the keys: new ones may be added, none is renamed.
#[derive(Serialize)]
struct Row<'e> {
    name: &'e str,
    kind: &'e str,
    topic: &'e str,
    signature: &'e str,
    summary: &'e str,
    details: &'e str,
    parameters: Vec<Parameter<'e>>,
    contract: String,
    source: &'e str,
    example: &'e str,
    file: Option<&'e str>,
    line: Option<u32>,
}

/// The code of a diagnostic as JSON.
#[derive(Serialize)]
struct CodeRow<'e> {
    code: &'e str,
    title: &'e str,
    meaning: &'e str,
    help: &'e str,
}

#[derive(Serialize)]
struct Parameter<'e> {
    name: &'e str,
    about: &'e str,
}

/// Prints all entries, or those that match a name, a topic, a diagnostic's code or a word of their
/// descriptions.
///
/// # Errors
///
/// Nothing matches.
pub fn run(args: &Doc, console: &Console) -> Result<(), Failure> {
    if let Some(code) = args.name.as_deref().and_then(code) {
        return write_code(code, args.json, console);
    }
    let entries = reference::entries();
    let found = match &args.name {
        None => Found { full: Vec::new(), listed: entries.iter().collect() },
        Some(name) => find(&entries, name, console)?,
    };
    if args.json {
        let rows: Vec<Row> =
            found.full.iter().chain(&found.listed).map(|entry| row(entry)).collect();
        return output::to_stdout(&output::json(&rows)?);
    }
    let mut page = Page::new(console.output_color());
    page.full(&found.full);
    page.list(&found.listed);
    if args.name.is_none() {
        page.closing("`sdfc doc NAME` describes one of them in full.");
    }
    output::to_stdout(page.text().as_bytes())
}

/// Returns the diagnostic code with this name.
fn code(name: &str) -> Option<&'static CodeInfo> {
    ALL_CODES.iter().find(|row| row.code.0.eq_ignore_ascii_case(name))
}

fn write_code(row: &CodeInfo, as_json: bool, console: &Console) -> Result<(), Failure> {
    if as_json {
        let row =
            CodeRow { code: row.code.0, title: row.title, meaning: row.page, help: row.suggestion };
        return output::to_stdout(&output::json(&[row])?);
    }
    let mut page = Page::new(console.output_color());
    page.code(row);
    output::to_stdout(page.text().as_bytes())
}

/// The entries that are printed.
struct Found<'e> {
    /// Entries that are printed in full.
    full: Vec<&'e Entry>,
    /// Entries that are listed with one line each.
    listed: Vec<&'e Entry>,
}

fn find<'e>(entries: &'e [Entry], name: &str, console: &Console) -> Result<Found<'e>, Failure> {
    let matching = |wanted: &dyn Fn(&Entry) -> bool| -> Vec<&'e Entry> {
        entries.iter().filter(|entry| wanted(entry)).collect()
    };
    let full = matching(&|entry| entry.name == name);
    let listed = matching(&|entry| entry.topic == name);
    if !full.is_empty() || !listed.is_empty() {
        return Ok(Found { full, listed });
    }
    let meant = reference::meant(entries, name);
    let missing = match &meant {
        Some(meant) => format!("there is no entry `{name}`; {meant}"),
        None => format!("there is no entry `{name}`"),
    };
    let listed = matching(&|entry| mentions(entry, name));
    if listed.is_empty() {
        return Err(Failure::Call(missing));
    }
    console.note(&format!("{missing}; these mention it:"));
    Ok(Found { full, listed })
}

/// True if an entry's name or description contains a word.
fn mentions(entry: &Entry, word: &str) -> bool {
    let word = word.to_lowercase();
    let texts = [&entry.name, &entry.summary, &entry.details];
    texts.iter().any(|text| text.to_lowercase().contains(&word))
}

fn row(entry: &Entry) -> Row<'_> {
    let parameters =
        entry.parameters.iter().map(|(name, about)| Parameter { name, about }).collect();
    Row {
        name: &entry.name,
        kind: entry.kind,
        topic: entry.topic,
        signature: &entry.signature,
        summary: &entry.summary,
        details: &entry.details,
        parameters,
        contract: entry.contract(),
        source: &entry.source,
        example: &entry.example,
        file: entry.location.map(|(file, _)| file),
        line: entry.location.map(|(_, line)| line),
    }
}
