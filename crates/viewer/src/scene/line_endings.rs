//! Texts with the line endings of their file.

/// An edited text with the line endings of the text before. The editor inserts `\n`, and lets the
/// cursor stand between `\r` and `\n`.
pub fn with_line_endings_of(before: &str, edited: String) -> String {
    if before.contains("\r\n") { edited.replace('\r', "").replace('\n', "\r\n") } else { edited }
}

/// The formatted text with its own line endings; `None` if it has syntax errors.
pub fn formatted(text: &str) -> Option<String> {
    sdfc_ide::format(text).map(|formatted| with_line_endings_of(text, formatted))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edited_text_keeps_its_line_endings() {
        let of = |before, edited: &str| with_line_endings_of(before, edited.to_owned());
        assert_eq!(of("a\r\nb\r\n", "a\rc\n\nb\r\n"), "ac\r\n\r\nb\r\n");
        assert_eq!(of("a\nb\n", "a\nc\nb\n"), "a\nc\nb\n");
        assert_eq!(formatted("sphere( 1 )\r\n").as_deref(), Some("sphere(1)\r\n"));
        assert_eq!(formatted("sphere( 1"), None);
    }
}
