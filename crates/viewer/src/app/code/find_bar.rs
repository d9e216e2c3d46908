//! The bar above the editor that finds and replaces text.

use std::ops::Range;
use std::sync::Arc;

use eframe::egui::{self, Id, Key, Modifiers, Response, RichText, Ui};

use super::text_state::select;
use crate::app::shortcuts::egui_closes;
use crate::app::theme;
use crate::text_search::{MAX_MATCHES, Query, next_match, previous_match};

/// The longest selection that becomes the search text, in bytes.
const MAX_SELECTED: usize = 200;

/// The bar, and what it has found.
#[derive(Debug, Default)]
pub struct FindBar {
    is_open: bool,
    replaces: bool,
    query: Query,
    replacement: String,
    takes_focus: bool,
    /// The match that was chosen last.
    current: Option<Range<usize>>,
    /// What was found last, and where.
    found: Found,
}

/// The matches of a query in a text.
#[derive(Debug, Default)]
struct Found {
    text: Arc<str>,
    query: Query,
    ranges: Arc<[Range<usize>]>,
}

/// What the user asks the bar for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FindRequest {
    /// Shows this match.
    Show(Range<usize>),
    /// Replaces the text by this one, and shows the range of it.
    Replace(String, Range<usize>),
    /// Gives the keyboard back to the editor.
    Leave(Option<Range<usize>>),
}

impl FindBar {
    /// Opens the bar. A selection of one line becomes the search text.
    pub fn open(&mut self, replaces: bool, text: &str, selected: &Range<usize>) {
        (self.is_open, self.takes_focus) = (true, true);
        self.replaces |= replaces;
        let marked = text.get(selected.clone()).unwrap_or_default();
        if !marked.is_empty() && marked.len() <= MAX_SELECTED && !marked.contains('\n') {
            self.query.text = marked.to_owned();
            self.current = Some(selected.clone());
        }
    }

    /// The matches in a text, in order, and the chosen one. None while the bar is closed.
    pub fn marked(&self, text: &Arc<str>) -> (Arc<[Range<usize>]>, Option<Range<usize>>) {
        if self.is_open && self.found.text == *text {
            (Arc::clone(&self.found.ranges), self.current.clone())
        } else {
            (Arc::default(), None)
        }
    }

    /// Shows the bar while it is open. `cursor` is the offset from which the search goes on;
    /// `editable` is false if nothing can be replaced.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        text: &Arc<str>,
        cursor: usize,
        editable: bool,
    ) -> Option<FindRequest> {
        if !self.is_open {
            return None;
        }
        self.search(text);
        let is_left = !egui_closes(ui.ctx())
            && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
        let mut request = None;
        ui.horizontal_wrapped(|ui| {
            let has_changed = self.query_field(ui);
            self.search(text);
            let keys = step_by_keys(ui);
            let count = self.count();
            ui.label(RichText::new(count).small().color(theme::of(ui).weak));
            let none = "Nothing was found.";
            let any = !self.found.ranges.is_empty();
            let mut button = |name: &str, help: &str| {
                let button = ui.add_enabled(any, egui::Button::new(name).small());
                button.on_hover_text(help).on_disabled_hover_text(none).clicked()
            };
            let previous = button("<", "The previous match (Shift + Enter, Shift + F3).");
            let next = button(">", "The next match (Enter, F3).");
            let replace = editable.then_some("Replace…").filter(|_| !self.replaces);
            let help = "Replace what is found (Ctrl + H).";
            if replace.is_some_and(|name| ui.small_button(name).on_hover_text(help).clicked()) {
                self.replaces = true;
            }
            let close = ui.small_button("×").on_hover_text("Close the search (Esc).").clicked();
            let step = keys.or(previous.then_some(-1)).or(next.then_some(1));
            let step = step.or((has_changed && any).then_some(0));
            request = step.and_then(|step| self.step(step, cursor));
            if close || is_left {
                self.is_open = false;
                request = Some(FindRequest::Leave(self.current.clone()));
            }
        });
        if self.is_open && self.replaces && editable {
            request = self.replace_row(ui, text, cursor).or(request);
        }
        request
    }

    /// Returns true if the search was changed.
    fn query_field(&mut self, ui: &mut Ui) -> bool {
        let before = self.query.clone();
        let field = labelled_field(ui, query_id(), &mut self.query.text, "find");
        field.on_hover_text("The text to find. Enter shows the next match.");
        if std::mem::take(&mut self.takes_focus) {
            select(ui.ctx(), query_id(), &self.query.text, 0..self.query.text.len());
        }
        let case = ui.toggle_value(&mut self.query.match_case, "Aa");
        case.on_hover_text("Match case: A does not match a.");
        let word = ui.toggle_value(&mut self.query.whole_word, "word");
        word.on_hover_text("Whole words: `box` does not match in `boxes`.");
        before != self.query
    }

    /// Returns a request if something is replaced.
    fn replace_row(&mut self, ui: &mut Ui, text: &Arc<str>, cursor: usize) -> Option<FindRequest> {
        ui.horizontal_wrapped(|ui| {
            let id = replacement_id();
            let field = labelled_field(ui, id, &mut self.replacement, "replace with");
            let has_focus = field.has_focus();
            field.on_hover_text("The text that replaces what is found. Enter replaces one match.");
            let any = !self.found.ranges.is_empty();
            let mut button = |name: &str, help: &str| {
                let button = ui.add_enabled(any, egui::Button::new(name).small());
                button.on_hover_text(help).on_disabled_hover_text("Nothing was found.").clicked()
            };
            let one = button("Replace", "Replace this match and show the next one (Enter).");
            let all = button("Replace all", "Replace all matches. One Ctrl + Z undoes that.");
            let enter =
                has_focus && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
            if all {
                let replaced = self.query.replace_all(text, &self.replacement);
                let at = cursor.min(replaced.len());
                self.current = None;
                return Some(FindRequest::Replace(replaced, at..at));
            }
            if one || enter { self.replace_one(text, cursor) } else { None }
        })
        .inner
    }

    /// Replaces the chosen match. Without one, chooses the next.
    fn replace_one(&mut self, text: &Arc<str>, cursor: usize) -> Option<FindRequest> {
        let is_there = |range: &Range<usize>| self.found.ranges.contains(range);
        let Some(range) = self.current.clone().filter(is_there) else {
            return self.step(1, cursor);
        };
        let mut replaced = text.to_string();
        replaced.replace_range(range.clone(), &self.replacement);
        let behind = range.start + self.replacement.len();
        let found = self.query.find_all(&replaced);
        self.current = next_match(&found, behind).and_then(|index| found.get(index).cloned());
        let selected = self.current.clone().unwrap_or(behind..behind);
        Some(FindRequest::Replace(replaced, selected))
    }

    fn search(&mut self, text: &Arc<str>) {
        if self.found.text != *text || self.found.query != self.query {
            let ranges = self.query.find_all(text);
            self.current = self.current.take().filter(|range| ranges.contains(range));
            let (text, query) = (Arc::clone(text), self.query.clone());
            self.found = Found { text, query, ranges: ranges.into() };
        }
    }

    /// Goes to the next match (1), the previous one (-1), or the first one from the chosen match
    /// on (0).
    fn step(&mut self, by: i32, cursor: usize) -> Option<FindRequest> {
        let found = &self.found.ranges;
        let from = self.current.clone().unwrap_or(cursor..cursor);
        let index = match by {
            0 => next_match(found, from.start),
            by if by > 0 => next_match(found, from.end),
            _ => previous_match(found, from.start),
        };
        self.current = index.and_then(|index| found.get(index).cloned());
        self.current.clone().map(FindRequest::Show)
    }

    fn count(&self) -> String {
        let found = &self.found.ranges;
        let index = self
            .current
            .as_ref()
            .and_then(|it| found.binary_search_by_key(&it.start, |range| range.start).ok());
        match (index, found.len()) {
            (_, 0) if self.query.text.is_empty() => String::new(),
            (_, 0) => "no match".to_owned(),
            (Some(index), count) if count < MAX_MATCHES => format!("{} of {count}", index + 1),
            (None, 1) => "1 match".to_owned(),
            (None, count) if count < MAX_MATCHES => format!("{count} matches"),
            (_, count) => format!("{count} or more matches"),
        }
    }
}

/// A field for a text of one line, with a hint that is also its label.
fn labelled_field(ui: &mut Ui, id: Id, text: &mut String, hint: &str) -> Response {
    let width = (ui.available_width() - 110.0).clamp(60.0, 160.0);
    let field = egui::TextEdit::singleline(text).id(id).hint_text(hint);
    let field = ui.add(field.desired_width(width).return_key(None));
    ui.ctx().accesskit_node_builder(id, |node| node.set_label(hint));
    field
}

fn has_focus(ui: &Ui, id: Id) -> bool {
    ui.memory(|memory| memory.has_focus(id))
}

fn query_id() -> Id {
    Id::unique("find: query")
}

fn replacement_id() -> Id {
    Id::unique("find: replacement")
}

/// The step that the keys ask for: Enter in the bar, F3 anywhere.
fn step_by_keys(ui: &Ui) -> Option<i32> {
    let in_query = has_focus(ui, query_id());
    ui.input_mut(|input| {
        let mut pressed = |modifiers, key| input.consume_key(modifiers, key);
        if in_query && pressed(Modifiers::SHIFT, Key::Enter) || pressed(Modifiers::SHIFT, Key::F3) {
            return Some(-1);
        }
        let next =
            in_query && pressed(Modifiers::NONE, Key::Enter) || pressed(Modifiers::NONE, Key::F3);
        next.then_some(1)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_count_says_when_there_may_be_more_matches() {
        let mut bar = FindBar::default();
        bar.query.text = "a".to_owned();
        let mut count = |matches: usize| {
            bar.search(&"a".repeat(matches).into());
            bar.count()
        };
        assert_eq!(
            [0, 1, MAX_MATCHES - 1].map(&mut count),
            ["no match", "1 match", "9999 matches"]
        );
        assert_eq!(count(MAX_MATCHES), "10000 or more matches");
    }
}
