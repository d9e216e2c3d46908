//! Source lines as they are shown: long lines are shortened around the labelled spans.

use std::collections::BTreeMap;
use std::ops::Range;

use codespan_reporting::files::{Error, Files};

use crate::{FileId, Sources};

/// The most bytes of a line that are shown.
const WIDTH: usize = 240;
/// The number of bytes shown before a span in a line that is longer than [`WIDTH`].
const BEFORE: usize = 80;
/// The mark that shows where a line was cut.
const CUT: &str = "…";

/// [`Sources`] whose long lines are cut around given positions.
///
/// Offsets stay valid: a cut overwrites text of its own length with [`CUT`], and the text beyond it
/// is not shown.
pub(crate) struct Excerpts<'a> {
    sources: &'a Sources,
    /// The byte range that is shown of a long line, by file and line.
    windows: BTreeMap<(FileId, usize), Range<usize>>,
    /// The texts of files with such lines, with the cuts marked.
    marked: BTreeMap<FileId, String>,
}

impl<'a> Excerpts<'a> {
    /// Cuts long lines around `positions`: byte offsets, of which the first in each line counts.
    pub(crate) fn around(sources: &'a Sources, positions: &[(FileId, usize)]) -> Self {
        let mut excerpts = Self { sources, windows: BTreeMap::new(), marked: BTreeMap::new() };
        for &(file, position) in positions {
            let line = sources.line_column(file, position as u32).line as usize - 1;
            let Some(whole) = sources.line_bytes(file, line) else { continue };
            if whole.len() > WIDTH && !excerpts.windows.contains_key(&(file, line)) {
                excerpts.cut(file, line, whole, position);
            }
        }
        excerpts
    }

    fn cut(&mut self, file: FileId, line: usize, whole: Range<usize>, position: usize) {
        let text = self.marked.entry(file).or_insert_with(|| self.sources.text(file).to_owned());
        let from = position.saturating_sub(BEFORE).max(whole.start);
        let end = text.floor_char_boundary((from + WIDTH).min(whole.end));
        let start = text.floor_char_boundary(end.saturating_sub(WIDTH).max(whole.start));
        if start > whole.start {
            mark(text, start);
        }
        if end < whole.end {
            mark(text, text.floor_char_boundary(end - CUT.len()));
        }
        self.windows.insert((file, line), start..end);
    }

    /// Returns the part of the bytes that is shown, or `None` if their start is not shown.
    pub(crate) fn shown(&self, file: FileId, bytes: Range<usize>) -> Option<Range<usize>> {
        let text = self.marked.get(&file);
        let clamp = |at: usize| {
            let line = self.sources.line_column(file, at as u32).line as usize - 1;
            let (Some(w), Some(text)) = (self.windows.get(&(file, line)), text) else {
                return (at, true);
            };
            // No character begins inside of a mark.
            (text.floor_char_boundary(at.clamp(w.start, w.end)), (w.start..=w.end).contains(&at))
        };
        let (start, seen) = clamp(bytes.start);
        seen.then(|| start..clamp(bytes.end).0.max(start))
    }
}

/// Overwrites the characters from an offset on with [`CUT`], padded with blanks to their length.
fn mark(text: &mut String, at: usize) {
    let Some(end) = (at + CUT.len()..=text.len()).find(|&end| text.is_char_boundary(end)) else {
        return;
    };
    let blanks = " ".repeat(end - at - CUT.len());
    text.replace_range(at..end, &format!("{CUT}{blanks}"));
}

impl<'a> Files<'a> for Excerpts<'_> {
    type FileId = FileId;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, file: FileId) -> Result<&'a str, Error> {
        Ok(self.sources.name(file))
    }

    fn source(&'a self, file: FileId) -> Result<&'a str, Error> {
        Ok(self.marked.get(&file).map_or_else(|| self.sources.text(file), String::as_str))
    }

    fn line_index(&'a self, file: FileId, offset: usize) -> Result<usize, Error> {
        Ok(self.sources.line_column(file, offset as u32).line as usize - 1)
    }

    fn column_number(&'a self, file: FileId, _: usize, offset: usize) -> Result<usize, Error> {
        Ok(self.sources.line_column(file, offset as u32).column as usize)
    }

    fn line_range(&'a self, file: FileId, line: usize) -> Result<Range<usize>, Error> {
        if let Some(window) = self.windows.get(&(file, line)) {
            return Ok(window.clone());
        }
        self.sources.line_bytes(file, line).ok_or(Error::LineTooLarge { given: line, max: 0 })
    }
}
