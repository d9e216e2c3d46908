//! The pages: one for each topic of the library, one for the kernel, one each for settings and types.

use std::fmt::Write;

use sdfc::lang::library::Entry;

use super::{Files, pictures};

const NOTE: &str =
    "<!-- Written from the entries' own comments by the test `reference`; change those. -->\n";

/// The pages as files.
pub fn files(entries: &[Entry]) -> Files {
    let mut pages: Vec<(&str, Vec<&Entry>)> = Vec::new();
    for entry in entries {
        let page = page_of(entry);
        match pages.iter_mut().find(|(name, _)| *name == page) {
            Some((_, of_page)) => of_page.push(entry),
            None => pages.push((page, vec![entry])),
        }
    }
    let mut files: Files = pages
        .iter()
        .map(|(name, entries)| (format!("{name}.md"), page(name, entries).into_bytes()))
        .collect();
    files.push(("README.md".to_owned(), index(&pages).into_bytes()));
    files
}

/// The kernel's topics are short and share a page.
fn page_of(entry: &Entry) -> &'static str {
    if entry.kind == "kernel" { "kernel" } else { entry.topic }
}

fn index(pages: &[(&str, Vec<&Entry>)]) -> String {
    let mut text = format!(
        "{NOTE}# Reference\n\nEverything that a scene can name without declaring it. `sdfc doc NAME` says the same in a terminal.\n"
    );
    for (page, entries) in pages {
        let _ = write!(text, "\n## [{}]({page}.md)\n\n", title(page));
        let mut last = "";
        for entry in entries {
            if entry.name == last {
                continue;
            }
            last = &entry.name;
            let anchor = anchor(entry);
            let _ = writeln!(text, "[`{}`]({page}.md#{anchor})", entry.name);
        }
    }
    text
}

fn page(name: &str, entries: &[&Entry]) -> String {
    let mut text = format!("{NOTE}# {}\n", title(name));
    let mut topic = name;
    for entry in entries {
        if name == "kernel" && entry.topic != topic {
            topic = entry.topic;
            let _ = write!(text, "\n## {}\n", title(topic));
        }
        text.push_str(&section(entry, if name == "kernel" { "###" } else { "##" }));
    }
    text
}

fn section(entry: &Entry, level: &str) -> String {
    let (anchor, name) = (anchor(entry), &entry.name);
    let mut text = format!("\n<a id=\"{anchor}\"></a>\n{level} {name}\n\n");
    if let Some(picture) = pictures::name(entry) {
        let [width, height] = pictures::SIZE;
        let _ = write!(
            text,
            "<img align=\"right\" src=\"{picture}\" width=\"{width}\" height=\"{height}\" alt=\"\">\n\n"
        );
    }
    let _ = write!(text, "{}", entry.summary);
    if !entry.details.is_empty() {
        let _ = write!(text, " {}", entry.details);
    }
    let _ = write!(text, "\n\n```sdf\n{}\n```\n\n", written(entry));
    for (parameter, about) in &entry.parameters {
        let _ = writeln!(text, "- `{parameter}`: {about}");
    }
    if !entry.parameters.is_empty() {
        text.push('\n');
    }
    let _ = writeln!(text, "Example: `{}`", entry.example);
    if let Some((file, _)) = entry.place {
        let _ = write!(text, "\nSource: {}. ", entry.source);
        let _ = writeln!(text, "Declared in [{file}](../../crates/lang/{file}).");
    }
    text
}

/// The signature as a declaration begins, its clauses below.
fn written(entry: &Entry) -> String {
    let mut text = match entry.place {
        Some(_) => format!("{} {}", entry.kind, entry.signature),
        None => entry.signature.clone(),
    };
    for clause in &entry.clauses {
        let _ = write!(text, "\n  {clause}");
    }
    text
}

fn title(topic: &str) -> String {
    let mut letters = topic.chars();
    letters
        .next()
        .map_or_else(String::new, |first| format!("{}{}", first.to_uppercase(), letters.as_str()))
}

/// Two entries of one page with one name differ in what they take.
fn anchor(entry: &Entry) -> String {
    let name = entry.name.to_lowercase();
    if entry.kind == "region" { format!("{name}-region") } else { name }
}
