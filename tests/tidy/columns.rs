//! No line of a comment or of a Markdown page has more than 100 columns.

use crate::files::texts;
use crate::report;

const MAX_COLUMNS: usize = 100;

/// A line of prose: its number from 1, and its text with and without the comment marker.
struct Line<'a> {
    number: usize,
    whole: &'a str,
    prose: &'a str,
}

/// Returns the lines of a Markdown page outside of code blocks.
fn page(text: &str) -> Vec<Line<'_>> {
    let mut is_code = false;
    let mut lines = Vec::new();
    for (index, whole) in text.lines().enumerate() {
        let prose = whole.trim_start();
        if prose.starts_with("```") {
            is_code = !is_code;
        } else if !is_code {
            lines.push(Line { number: index + 1, whole, prose });
        }
    }
    lines
}

/// Returns the comments of a source file, outside of code blocks in them.
fn comments(text: &str) -> Vec<Line<'_>> {
    let mut is_code = false;
    let mut lines = Vec::new();
    for (index, whole) in text.lines().enumerate() {
        let Some(prose) = comment(whole) else {
            is_code = false;
            continue;
        };
        if prose.starts_with("```") {
            is_code = !is_code;
        } else if !is_code {
            lines.push(Line { number: index + 1, whole, prose });
        }
    }
    lines
}

/// Returns the text of the comment that a line is or ends with.
fn comment(line: &str) -> Option<&str> {
    let behind = match line.trim_start().strip_prefix("//") {
        Some(behind) => behind,
        None => line.split_once(" // ")?.1,
    };
    Some(behind.trim_start_matches(['/', '!']).trim_start())
}

/// Returns true if a line could be broken: it is no row of a table, no HTML tag, no heading, no
/// code, and has a space outside of links and code.
fn is_breakable(prose: &str) -> bool {
    let content = prose.strip_prefix("- ").unwrap_or(prose);
    // The example in the doc comment of a library entry is code in one line.
    if content.starts_with(['|', '<', '#']) || content.starts_with("example: ") {
        return false;
    }
    let (mut in_code, mut in_link) = (false, false);
    content.chars().any(|letter| {
        match letter {
            '`' => in_code = !in_code,
            '[' => in_link = true,
            ']' => in_link = false,
            _ => {}
        }
        letter == ' ' && !in_code && !in_link
    })
}

fn problems(path: &str, lines: Vec<Line<'_>>) -> Vec<(String, String)> {
    let mut problems = Vec::new();
    for line in lines {
        let columns = line.whole.chars().count();
        if columns > MAX_COLUMNS && is_breakable(line.prose) {
            problems.push((path.to_owned(), format!("line {} has {columns} columns", line.number)));
        }
    }
    problems
}

#[test]
fn prose_has_at_most_100_columns() {
    let mut found = Vec::new();
    for (path, text) in texts(&["md"]) {
        found.extend(problems(&path, page(&text)));
    }
    for (path, text) in texts(&["rs", "wgsl", "sdf"]) {
        found.extend(problems(&path, comments(&text)));
    }
    report(&found);
}

#[test]
fn long_lines_are_found_unless_they_cannot_be_broken() {
    let words = "word ".repeat(30);
    let in_page = |text: &str| problems("", page(text)).len();
    assert_eq!(in_page(&words), 1);
    assert_eq!(in_page(&format!("```\n{words}\n```\n| {words} |")), 0);
    assert_eq!(in_page(&format!("- [{words}](link)")), 0);
    let in_source = |text: &str| problems("", comments(text)).len();
    assert_eq!(in_source(&format!("/// {words}\nlet s = \"{words}\";")), 1);
    assert_eq!(in_source(&format!("/// ```\n/// {words}\n/// ```")), 0);
    assert_eq!(in_source(&format!("let a = 1; // {words}")), 1);
}
