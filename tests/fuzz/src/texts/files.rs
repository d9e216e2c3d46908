//! The scenes of the repository, and the snippets of its pages.

use std::io;
use std::path::Path;

use sdfc_test_support::repository;

/// Returns the name and the text of every scene below `examples`, `crates`, `tests` and `docs`, and
/// of every snippet of the pages.
///
/// # Errors
///
/// A file or a folder cannot be read.
pub fn files() -> io::Result<Vec<(String, String)>> {
    let mut found = Vec::new();
    for folder in ["examples", "crates", "tests", "docs", "playground"] {
        find(&repository().join(folder), &mut found)?;
    }
    found.sort();
    Ok(found)
}

fn find(folder: &Path, found: &mut Vec<(String, String)>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let extension = path.extension().and_then(|it| it.to_str()).unwrap_or_default();
        if path.is_dir() && !path.ends_with("node_modules") {
            find(&path, found)?;
        } else if matches!(extension, "sdf" | "md") {
            let text = std::fs::read_to_string(&path)?.replace("\r\n", "\n");
            let name = path.display().to_string();
            if extension == "sdf" {
                found.push((name, text));
            } else {
                let snippets = snippets(&text).into_iter().enumerate();
                found.extend(snippets.map(|(i, text)| (format!("{name}, snippet {i}"), text)));
            }
        }
    }
    Ok(())
}

/// The blocks of a page that are fenced as `sdf`, also those with an error.
fn snippets(page: &str) -> Vec<String> {
    let mut snippets = Vec::new();
    let mut open: Option<String> = None;
    for line in page.lines() {
        let fence = line.trim_start().strip_prefix("```");
        match (&mut open, fence) {
            (Some(text), None) => *text += &format!("{line}\n"),
            (Some(_), Some(_)) => snippets.extend(open.take()),
            (None, Some(language)) if language.split(' ').next() == Some("sdf") => {
                open = Some(String::new());
            }
            // A block in another language ends at the next fence.
            (None, _) => {}
        }
    }
    snippets
}
