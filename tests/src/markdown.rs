//! Line breaks in the Markdown pages that tests write.

/// The most columns of a line of prose.
const WIDTH: usize = 100;

/// Breaks the prose of a Markdown page into lines of at most 100 columns.
///
/// Code blocks, tables, headings and comments stay as they are. A span in backticks and a link are
/// never broken, so a line with a longer one is longer.
pub fn wrapped(page: &str) -> String {
    let mut out = String::new();
    let mut is_code = false;
    for line in page.lines() {
        is_code ^= line.starts_with("```");
        let is_prose = !is_code && !line.starts_with(['|', '#', '<']) && !line.starts_with("```");
        if is_prose && line.chars().count() > WIDTH {
            wrap(line, &mut out);
        } else {
            out.push_str(line);
        }
        out.push('\n');
    }
    out
}

fn wrap(line: &str, out: &mut String) {
    let indent = if line.starts_with("- ") { "  " } else { "" };
    let mut column = 0;
    for word in words(line) {
        let length = word.chars().count();
        if column == 0 {
            column = length;
        } else if column + 1 + length > WIDTH {
            out.push('\n');
            out.push_str(indent);
            column = indent.len() + length;
        } else {
            out.push(' ');
            column += 1 + length;
        }
        out.push_str(word);
    }
}

/// Splits a line at the spaces where it may be broken.
fn words(line: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let (mut start, mut in_code, mut in_link) = (0, false, false);
    for (at, letter) in line.char_indices() {
        match letter {
            '`' => in_code = !in_code,
            '[' if !in_code => in_link = true,
            ']' if !in_code => in_link = false,
            ' ' if !in_code && !in_link => {
                words.push(&line[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    words.push(&line[start..]);
    words
}
