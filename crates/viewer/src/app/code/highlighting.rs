//! The colours of the scene's text.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use eframe::egui::text::{ByteIndex, LayoutJob, TextFormat};
use eframe::egui::{Color32, FontId, Stroke};
use sdfc_ide::{TokenRole, TokenSpan};
use sdfc_syntax::{Class, classes};

use crate::app::theme::Palette;
use crate::compile::diagnostics::ShownDiagnostic;
use crate::compile::text_diff::TextDiff;

/// The role of each word by its first byte.
type Roles = BTreeMap<usize, TokenRole>;

/// The roles of the words of a text, as far as the answer about an earlier text tells.
fn roles(answer: Option<&(Arc<str>, Arc<[TokenSpan]>)>, text: &str) -> Roles {
    let Some((earlier, tokens)) = answer else { return Roles::new() };
    let diff = TextDiff::new(earlier, text);
    let moved = |range: &Range<usize>| -> Option<usize> {
        let [start, old_end] = [diff.start as usize, diff.old_end as usize];
        match range {
            range if range.end <= start => Some(range.start),
            range if range.start >= old_end => {
                Some(diff.map_offset(u32::try_from(range.start).ok()?) as usize)
            }
            _ => None,
        }
    };
    tokens.iter().filter_map(|token| Some((moved(&token.range)?, token.role))).collect()
}

/// An underlined range.
#[derive(Clone, PartialEq)]
pub struct Mark {
    range: Range<usize>,
    color: Color32,
}

impl Mark {
    /// The range of an error or a warning.
    pub fn of(found: &ShownDiagnostic, palette: &Palette) -> Self {
        let color = if found.is_error { palette.error } else { palette.warning };
        let Range { start, end } = found.range;
        // An empty range, as at the end of a line, would not be seen.
        Self { range: start..end.max(start + 1), color }
    }
}

/// The layout of a text, kept while nothing that it shows changes.
#[derive(Default)]
pub struct LayoutCache(Option<(LayoutKey, LayoutJob)>);

/// Everything that the layout of a text depends on.
#[derive(Clone, PartialEq)]
pub struct LayoutKey {
    /// The text.
    pub text: String,
    /// The answer of the language service with the roles of its words.
    pub roles: Option<(Arc<str>, Arc<[TokenSpan]>)>,
    /// Underlined ranges.
    pub marks: Vec<Mark>,
    /// The code of a shape that was clicked.
    pub lit: Option<Range<usize>>,
    /// What a search has found, in order.
    pub found: Arc<[Range<usize>]>,
    /// The chosen one of them.
    pub current: Option<Range<usize>>,
    /// True for the dark theme.
    pub is_dark: bool,
    /// The font.
    pub font: FontId,
}

impl LayoutCache {
    /// The layout for a key, which is made if the last one was for another.
    pub fn layout(&mut self, key: &LayoutKey, palette: &Palette) -> LayoutJob {
        match &self.0 {
            Some((last, job)) if last == key => job.clone(),
            Some(_) | None => {
                let job = highlighted(key, palette);
                self.0 = Some((key.clone(), job.clone()));
                job
            }
        }
    }
}

impl std::fmt::Debug for LayoutCache {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("LayoutCache").field(&self.0.is_some()).finish()
    }
}

/// The text with its colours. Lines are not wrapped.
fn highlighted(key: &LayoutKey, palette: &Palette) -> LayoutJob {
    let LayoutKey { text, marks, lit, found, current, font, .. } = key;
    let roles = roles(key.roles.as_ref(), text);
    let mut job = LayoutJob::default();
    job.wrap.max_width = f32::INFINITY;
    let mut ends: Vec<usize> = Vec::new();
    let tokens = classes(text);
    ends.extend(tokens.iter().flat_map(|(_, range)| [range.start, range.end]));
    ends.extend(marks.iter().flat_map(|mark| [mark.range.start, mark.range.end]));
    ends.extend(lit.iter().chain(found.iter()).flat_map(|range| [range.start, range.end]));
    ends.extend([0, text.len()]);
    ends.retain(|end| text.is_char_boundary(*end));
    ends.sort_unstable();
    ends.dedup();
    for pair in ends.windows(2) {
        let [start, end] = [pair[0], pair[1]];
        let token = tokens.partition_point(|(_, range)| range.end <= start);
        let token = tokens.get(token).filter(|(_, range)| range.start <= start);
        let color = token.map_or(palette.text, |(class, range)| match roles.get(&range.start) {
            Some(role) if *class == Class::Name => color_of_role(*role, palette),
            Some(_) | None => color_of(*class, palette),
        });
        let mut format = TextFormat::simple(font.clone(), color);
        if let Some((Class::Color, range)) = token
            && let Ok(color) = Color32::from_hex(&text[range.clone()])
        {
            format.underline = Stroke::new(3.0, color);
        }
        if let Some(mark) = marks.iter().find(|mark| mark.range.contains(&start)) {
            format.underline = Stroke::new(1.5, mark.color);
        }
        if lit.as_ref().is_some_and(|lit| lit.contains(&start)) {
            format.background = palette.chosen;
        }
        let next = found.partition_point(|range| range.end <= start);
        if let Some(range) = found.get(next).filter(|range| range.contains(&start)) {
            let is_current = current.as_ref() == Some(range);
            format.background = if is_current { palette.found } else { palette.line };
        }
        append(&mut job, &text[start..end], format);
    }
    job
}

/// Appends a text; one in the same format as the last one becomes a part of it.
fn append(job: &mut LayoutJob, text: &str, format: TextFormat) {
    match job.sections.last_mut() {
        Some(last) if last.format == format => {
            job.text.push_str(text);
            last.byte_range.end = ByteIndex(job.text.len());
        }
        Some(_) | None => job.append(text, 0.0, format),
    }
}

fn color_of(class: Class, palette: &Palette) -> Color32 {
    match class {
        Class::Comment | Class::Docs => palette.weak,
        Class::Keyword => palette.link,
        Class::Number | Class::Color => palette.accent,
        Class::Text => palette.warning,
        Class::Name
        | Class::Operator
        | Class::Open
        | Class::Close
        | Class::Punctuation
        | Class::Unknown => palette.text,
    }
}

fn color_of_role(role: TokenRole, palette: &Palette) -> Color32 {
    match role {
        TokenRole::Function | TokenRole::Shape | TokenRole::Setting => palette.call,
        TokenRole::Keyword | TokenRole::Type => palette.link,
        TokenRole::Param => palette.accent,
        TokenRole::Comment | TokenRole::Docs | TokenRole::Parameter => palette.weak,
        TokenRole::Number | TokenRole::Text | TokenRole::Operator => palette.text,
        TokenRole::Variable | TokenRole::Property => palette.text,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::mpsc::channel;

    use super::*;
    use crate::language::worker::{LanguageRequest, LanguageWorker};
    use crate::test_support::TIMEOUT;

    #[test]
    fn roles_move_with_their_words_until_there_is_a_new_answer() {
        let (sender, answers) = channel();
        let worker = LanguageWorker::new(sender, || {}).unwrap();
        let (path, text) = (Path::new("a.sdf"), "let a = 1\nsphere(a) | box(2)\n");
        worker.send(LanguageRequest { cursor: None, ..LanguageRequest::new(path, text) });
        let answer = answers.recv_timeout(TIMEOUT).unwrap();
        let edited = "let a = 1\nsphere(a + a) | box(2)\n";
        let roles = roles(Some(&(answer.request.text, answer.tokens)), edited);
        for word in ["sphere", "box"] {
            assert_eq!(roles.get(&edited.find(word).unwrap()), Some(&TokenRole::Shape), "{word}");
        }
    }
}
