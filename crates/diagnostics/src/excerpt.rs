//! Source lines as they are shown: of long ones a part, around what is marked.

use std::collections::BTreeMap;
use std::ops::Range;

use codespan_reporting::files::{Error, Files};

use crate::{FileId, Sources};

/// Bytes of a line that are shown at most.
const WIDTH: usize = 240;
/// Bytes that are shown before what is marked, where a line is longer.
const BEFORE: usize = 80;
/// Stands where a line was cut.
const CUT: &str = "…";

/// [`Sources`] whose long lines are cut around places.
///
/// A text keeps its length and its offsets: a cut writes its mark over what stood there, and what lies farther out is not shown.
pub(crate) struct Excerpts<'a> {
    sources: &'a Sources,
    /// What is shown of a long line, by file and line.
    windows: BTreeMap<(FileId, usize), Range<usize>>,
    /// Texts with marks, of files that have such lines.
    marked: BTreeMap<FileId, String>,
}

impl<'a> Excerpts<'a> {
    /// Cut around `places`: byte offsets, of which the first in a line counts.
    pub(crate) fn around(sources: &'a Sources, places: &[(FileId, usize)]) -> Self {
        let mut excerpts = Self { sources, windows: BTreeMap::new(), marked: BTreeMap::new() };
        for &(file, place) in places {
            let line = sources.line_column(file, place as u32).line as usize - 1;
            let Some(whole) = sources.line_bytes(file, line) else { continue };
            if whole.len() > WIDTH && !excerpts.windows.contains_key(&(file, line)) {
                excerpts.cut(file, line, whole, place);
            }
        }
        excerpts
    }

    fn cut(&mut self, file: FileId, line: usize, whole: Range<usize>, place: usize) {
        let text = self.marked.entry(file).or_insert_with(|| self.sources.text(file).to_owned());
        let from = place.saturating_sub(BEFORE).max(whole.start);
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

    /// The part of the bytes that is shown; `None` where nothing of what they begin with is.
    pub(crate) fn shown(&self, file: FileId, bytes: Range<usize>) -> Option<Range<usize>> {
        let text = self.marked.get(&file);
        let clamp = |at: usize| {
            let line = self.sources.line_column(file, at as u32).line as usize - 1;
            let (Some(w), Some(text)) = (self.windows.get(&(file, line)), text) else {
                return (at, true);
            };
            // Within a mark no character begins.
            (text.floor_char_boundary(at.clamp(w.start, w.end)), (w.start..=w.end).contains(&at))
        };
        let (start, seen) = clamp(bytes.start);
        seen.then(|| start..clamp(bytes.end).0.max(start))
    }
}

/// Writes [`CUT`] over the characters from an offset on, blanks behind it where they were longer.
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
