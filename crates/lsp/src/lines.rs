//! Converts between byte offsets and the lines and columns of the protocol.

use std::ops::Range;

use serde_json::{Value, json};

/// The unit in which columns are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// UTF-16 code units.
    Utf16,
}

/// The lines of a text.
pub struct Lines<'t> {
    text: &'t str,
    starts: Vec<usize>,
    encoding: Encoding,
}

impl<'t> Lines<'t> {
    /// Splits a text into lines.
    pub fn new(text: &'t str, encoding: Encoding) -> Self {
        let mut starts = vec![0];
        starts.extend(text.match_indices('\n').map(|(at, _)| at + 1));
        Self { text, starts, encoding }
    }

    /// The byte offset of a position. A column past the end of its line means that end, a line
    /// past the last one means the end of the text.
    pub fn offset(&self, position: &Value) -> usize {
        let number = |key: &str| position[key].as_u64().unwrap_or(0) as usize;
        let (line, column) = (number("line"), number("character"));
        let Some(&start) = self.starts.get(line) else { return self.text.len() };
        let end = self.starts.get(line + 1).map_or(self.text.len(), |next| next - 1);
        let written = self.text[start..end].trim_end_matches('\r');
        let mut units = 0;
        for (at, c) in written.char_indices() {
            let next = units + self.units(c);
            if next > column {
                return start + at;
            }
            units = next;
        }
        start + written.len()
    }

    fn units(&self, c: char) -> usize {
        match self.encoding {
            Encoding::Utf8 => c.len_utf8(),
            Encoding::Utf16 => c.len_utf16(),
        }
    }

    /// The line and the column of a byte offset.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let line = self.starts.partition_point(|start| *start <= offset) - 1;
        let start = self.starts[line];
        let before = self.text.get(start..offset).unwrap_or(&self.text[start..]);
        (line, self.length(before))
    }

    /// The length of a text in the unit of columns.
    pub fn length(&self, text: &str) -> usize {
        text.chars().map(|c| self.units(c)).sum()
    }

    /// The position of a byte offset.
    pub fn position(&self, offset: usize) -> Value {
        let (line, character) = self.line_column(offset);
        json!({ "line": line, "character": character })
    }

    /// The range of a byte range.
    pub fn range(&self, range: Range<usize>) -> Value {
        json!({ "start": self.position(range.start), "end": self.position(range.end) })
    }

    /// The byte range of a range.
    pub fn bytes(&self, range: &Value) -> Range<usize> {
        let (start, end) = (self.offset(&range["start"]), self.offset(&range["end"]));
        start..end.max(start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_counted_in_the_unit_of_the_editor() {
        let text = "a😀b\r\né";
        let utf16 = Lines::new(text, Encoding::Utf16);
        assert_eq!(utf16.offset(&json!({ "line": 0, "character": 3 })), 5);
        assert_eq!(utf16.offset(&json!({ "line": 0, "character": 99 })), 6);
        assert_eq!(utf16.offset(&json!({ "line": 1, "character": 1 })), 10);
        assert_eq!(utf16.offset(&json!({ "line": 9, "character": 0 })), 10);
        assert_eq!(utf16.line_column(5), (0, 3));
        let utf8 = Lines::new(text, Encoding::Utf8);
        assert_eq!(utf8.offset(&json!({ "line": 0, "character": 5 })), 5);
        assert_eq!(utf8.line_column(10), (1, 2));
    }
}
