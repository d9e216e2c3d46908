//! The colours of the scene's text.

use std::collections::BTreeMap;
use std::ops::Range;

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{Color32, FontId, Stroke};
use sdfc_ide::TokenRole;
use sdfc_syntax::{Class, classes};

use crate::app::theme::Palette;
use crate::compile::diagnostics::ShownDiagnostic;
use crate::compile::text_diff::TextDiff;
use crate::language::worker::LanguageAnswer;

/// The role of each word by its first byte.
pub type Roles = BTreeMap<usize, TokenRole>;

/// The roles of the words of a text, as far as the answer about an earlier text tells.
pub fn roles(answer: Option<&LanguageAnswer>, text: &str) -> Roles {
    let Some(answer) = answer else { return Roles::new() };
    let diff = TextDiff::new(&answer.request.text, text);
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
    let tokens = answer.tokens.iter();
    tokens.filter_map(|token| Some((moved(&token.range)?, token.role))).collect()
}

/// An underlined range.
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

/// What is shown of a text beside its tokens.
pub struct Decorations<'a> {
    /// The roles of its words.
    pub roles: &'a Roles,
    /// Underlined ranges.
    pub marks: &'a [Mark],
    /// The code of a shape that was clicked.
    pub lit: Option<&'a Range<usize>>,
    /// What a search has found, in order.
    pub found: &'a [Range<usize>],
    /// The chosen one of them.
    pub current: Option<&'a Range<usize>>,
}

/// The text with its colours. Lines are not wrapped.
pub fn highlighted(
    text: &str,
    Decorations { roles, marks, lit, found, current }: &Decorations<'_>,
    palette: &Palette,
    font: &FontId,
) -> LayoutJob {
    let mut job = LayoutJob::default();
    job.wrap.max_width = f32::INFINITY;
    let mut ends: Vec<usize> = Vec::new();
    let tokens = classes(text);
    ends.extend(tokens.iter().flat_map(|(_, range)| [range.start, range.end]));
    ends.extend(marks.iter().flat_map(|mark| [mark.range.start, mark.range.end]));
    ends.extend(lit.iter().copied().chain(*found).flat_map(|range| [range.start, range.end]));
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
        if lit.is_some_and(|lit| lit.contains(&start)) {
            format.background = palette.chosen;
        }
        let next = found.partition_point(|range| range.end <= start);
        if let Some(range) = found.get(next).filter(|range| range.contains(&start)) {
            let is_current = *current == Some(range);
            format.background = if is_current { palette.found } else { palette.line };
        }
        job.append(&text[start..end], 0.0, format);
    }
    job
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
        let roles = roles(Some(&answer), edited);
        for word in ["sphere", "box"] {
            assert_eq!(roles.get(&edited.find(word).unwrap()), Some(&TokenRole::Shape), "{word}");
        }
    }
}
