//! The reference: all names that a scene can use without declaring them.
//!
//! These are the names of the library, the kernel, the settings and the types, and the words of the
//! syntax. The descriptions of library entries come from the doc comments in `std`, the others from
//! tables.

use crate::check::kernel::ROWS;
use crate::check::types::{WORDS, show};
use crate::library::{self, Entry};
use crate::settings::{self, SettingRow};
use crate::spelling;
use crate::syntax_words;

/// All entries, sorted by topic.
pub fn entries() -> Vec<Entry> {
    let mut entries = library::entries();
    entries.extend(ROWS.iter().map(|row| Entry {
        name: row.name.to_owned(),
        kind: "kernel",
        topic: row.topic,
        signature: row.signature.to_owned(),
        summary: row.summary.to_owned(),
        example: row.example.to_owned(),
        ..Entry::default()
    }));
    entries.extend(settings::table().iter().map(setting));
    entries.extend(WORDS.iter().map(|word| Entry {
        name: word.name.to_owned(),
        kind: "type",
        topic: "types",
        signature: word.name.to_owned(),
        summary: word.summary.to_owned(),
        example: word.example.to_owned(),
        ..Entry::default()
    }));
    entries.extend(syntax_words::WORDS.iter().map(|word| Entry {
        name: word.name.to_owned(),
        kind: "syntax",
        topic: "syntax",
        signature: word.signature.to_owned(),
        summary: word.summary.to_owned(),
        example: word.example.to_owned(),
        ..Entry::default()
    }));
    entries
}

fn setting(row: &SettingRow) -> Entry {
    let written = row.parameters.iter().map(|parameter| {
        let optional = if parameter.optional { "?" } else { "" };
        format!("{}{optional}: {}", parameter.name, show(&parameter.ty))
    });
    let written: Vec<String> = written.collect();
    let about = row.parameters.iter().map(|it| (it.name.to_owned(), it.about.to_owned()));
    Entry {
        name: row.name.to_owned(),
        kind: "setting",
        topic: "settings",
        signature: format!("{}({})", row.name, written.join(", ")),
        summary: row.summary.to_owned(),
        details: if row.once { "May appear only once." } else { "May appear any number of times." }
            .to_owned(),
        parameters: about.collect(),
        example: row.example.to_owned(),
        ..Entry::default()
    }
}

/// A suggestion for an unknown name: "did you mean `sphere`?"
pub fn meant(entries: &[Entry], name: &str) -> Option<String> {
    let meant = spelling::meant(name, entries.iter().map(|entry| entry.name.as_str()));
    meant.map(|meant| meant.message)
}
