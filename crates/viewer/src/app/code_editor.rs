//! An editor of the scene's text: colours, line numbers, underlined errors, descriptions,
//! completions, undo and redo.

use std::ops::Range;
use std::sync::Arc;

use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::text_edit::TextEditState;
use eframe::egui::{self, Color32, Event, Galley, Id, Key, Modifiers, Response, TextBuffer, Ui};
use sdfc_ide::{Completion, hover};
use sdfc_syntax::{Class, classes};

use super::completion_list::CompletionList;
use super::highlighting::{Mark, highlighted, roles};
use super::theme;
use crate::compile::diagnostics::ShownDiagnostic;
use crate::language::completions::{inserted, matching};
use crate::session::Session;

/// The width of the line numbers in points.
const GUTTER: f32 = 40.0;
/// What the Tab key inserts.
const INDENT: &str = "  ";

/// The state of the editor beside its text.
#[derive(Debug, Default)]
pub struct CodeEditor {
    list: CompletionList,
    /// The cursor of the last frame as a byte offset, while the editor has the keyboard.
    cursor: Option<usize>,
    /// A range that is lit because its shape was clicked, and the text that it belongs to.
    lit: Option<(Range<usize>, Arc<str>)>,
    /// The colour that the cursor was in last.
    color: Option<Range<usize>>,
    /// True until the lit range has been scrolled to.
    scrolls: bool,
}

impl CodeEditor {
    /// Lights the code of a shape of a text, and scrolls to it.
    pub fn light(&mut self, range: Option<Range<usize>>, text: &Arc<str>) {
        self.scrolls = range.is_some();
        self.lit = range.map(|range| (range, Arc::clone(text)));
    }

    /// Shows a button with the colour at the cursor, which changes it in the text.
    pub fn color_button(&mut self, ui: &mut Ui, session: &mut Session) {
        let mut text = session.text().to_string();
        let is_color =
            |range: &Range<usize>| classes(&text).contains(&(Class::Color, range.clone()));
        match self.cursor {
            Some(cursor) => self.color = color_around(&text, cursor),
            None => self.color = self.color.take().filter(is_color),
        }
        let Some(range) = self.color.clone() else { return };
        let Ok(before) = Color32::from_hex(&text[range.clone()]) else { return };
        let mut srgb = [before.r(), before.g(), before.b()];
        let button = ui.color_edit_button_srgb(&mut srgb);
        if button.on_hover_text("Change the colour at the cursor.").changed() {
            let [red, green, blue] = srgb;
            let written = format!("#{red:02x}{green:02x}{blue:02x}");
            self.color = Some(range.start..range.start + written.len());
            text.replace_range(range, &written);
            session.edit(|draft| draft.set_text(&text));
        }
    }

    /// Shows the editor. What is typed becomes the text of the session.
    pub fn show(&mut self, ui: &mut Ui, session: &mut Session) {
        let id = Id::unique("code editor");
        let has_focus = ui.memory(|memory| memory.has_focus(id));
        session.ask_about_text(self.cursor.filter(|_| has_focus));
        self.handle_keys(ui, id, has_focus, session);
        let palette = theme::of(ui);
        let mut text = session.text().to_string();
        let found: Vec<ShownDiagnostic> = session.diagnostics_of_text().cloned().collect();
        let marks: Vec<Mark> = found.iter().map(|found| Mark::of(found, palette)).collect();
        let roles = roles(session.language.as_ref(), &text);
        let lit = self.lit.as_ref().filter(|(_, of)| *of == *session.text());
        let lit = lit.map(|(range, _)| range.clone());
        let font = egui::TextStyle::Monospace.resolve(ui.style());
        let row = ui.text_style_height(&egui::TextStyle::Monospace).max(1.0);
        let mut layouter = |ui: &Ui, text: &dyn TextBuffer, _: f32| -> Arc<Galley> {
            let job = highlighted(text.as_str(), (&roles, &marks, lit.as_ref()), palette, &font);
            ui.fonts_mut(|fonts| fonts.layout_job(job))
        };
        egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            let height = ui.available_height();
            ui.horizontal_top(|ui| {
                ui.add_space(GUTTER);
                let edit = egui::TextEdit::multiline(&mut text)
                    .id(id)
                    .frame(egui::Frame::NONE)
                    .code_editor()
                    .desired_width(f32::INFINITY)
                    // So that a click below the text is one behind its end.
                    .desired_rows((height / row - 1.0).max(8.0) as usize)
                    .layouter(&mut layouter);
                let output = edit.show(ui);
                ui.ctx().accesskit_node_builder(id, |node| node.set_label("the scene's text"));
                line_numbers(ui, &output.galley, output.galley_pos);
                if let Some(lit) = lit.as_ref().filter(|_| self.scrolls) {
                    let at = CCursor::new(text[..lit.start].chars().count());
                    let at =
                        output.galley.pos_from_cursor(at).translate(output.galley_pos.to_vec2());
                    ui.scroll_to_rect(at.expand2(egui::vec2(0.0, 60.0)), None);
                    self.scrolls = false;
                }
                let cursor = output.cursor_range.map(|range| range.primary);
                let before = self.cursor;
                self.cursor = cursor.map(|cursor| byte_of(&text, cursor.index.0));
                if output.response.changed() {
                    let text = with_line_endings_of(session.text(), text.clone());
                    session.edit(|draft| draft.set_text(&text));
                    self.list.typing = true;
                } else if self.cursor != before {
                    self.list.typing = false;
                }
                if let Some(cursor) = cursor.filter(|_| has_focus) {
                    let below = output.galley.pos_from_cursor(cursor).left_bottom();
                    self.show_list(ui, id, output.galley_pos + below.to_vec2(), session);
                }
                if let Some(pointer) = output.response.hover_pos() {
                    let at = output.galley.cursor_from_pos(pointer - output.galley_pos);
                    describe(
                        &output.response.response,
                        session,
                        &found,
                        byte_of(&text, at.index.0),
                    );
                }
            });
        });
    }

    /// Handles the keys that the editor would use for something else.
    fn handle_keys(&mut self, ui: &Ui, id: Id, has_focus: bool, session: &mut Session) {
        if !has_focus {
            return;
        }
        let accepted = {
            let items = self.items(session);
            self.list.accept_by_key(ui, &items).cloned()
        };
        if let Some(completion) = accepted {
            self.insert(ui, id, &completion, session);
        }
        // Tab would move the focus.
        ui.input_mut(|input| {
            if input.consume_key(Modifiers::NONE, Key::Tab) {
                input.events.push(Event::Text(INDENT.to_owned()));
            }
        });
    }

    /// The completions at the cursor.
    fn items<'s>(&self, session: &'s Session) -> Vec<&'s Completion> {
        let answer = session.language.as_ref().zip(self.cursor);
        answer.map(|(it, cursor)| matching(it, session.text(), cursor)).unwrap_or_default()
    }

    fn show_list(&mut self, ui: &Ui, id: Id, at: egui::Pos2, session: &mut Session) {
        let clicked = {
            let items = self.items(session);
            self.list.show(ui, at, &items).cloned()
        };
        if let Some(completion) = clicked {
            self.insert(ui, id, &completion, session);
        }
    }

    /// Inserts a completion and selects its first gap.
    fn insert(&mut self, ui: &Ui, id: Id, completion: &Completion, session: &mut Session) {
        let (insert, gap) = inserted(completion);
        let mut text = session.text().to_string();
        let start = completion.replace.start;
        if text.get(completion.replace.clone()).is_none() {
            return;
        }
        text.replace_range(completion.replace.clone(), &insert);
        let character = |at: usize| CCursor::new(text[..start + at].chars().count());
        let selected = CCursorRange::two(character(gap.start), character(gap.end));
        session.edit(|draft| draft.set_text(&text));
        self.list.typing = false;
        if let Some(mut state) = TextEditState::load(ui.ctx(), id) {
            state.cursor.set_char_range(Some(selected));
            state.store(ui.ctx(), id);
        }
        ui.memory_mut(|memory| memory.request_focus(id));
    }
}

/// Shows what is known of the text under the pointer: its errors, or the description of the name.
fn describe(response: &Response, session: &Session, found: &[ShownDiagnostic], at: usize) {
    if let Some(under) = found.iter().find(|found| found.range.contains(&at)) {
        let lines = std::iter::once(&under.message).chain(&under.help);
        let lines: Vec<&str> = lines.map(String::as_str).filter(|line| !line.is_empty()).collect();
        response.clone().on_hover_text_at_pointer(lines.join("\n"));
        return;
    }
    let answer = session.language.as_ref().filter(|it| it.request.text == *session.text());
    if let Some(shown) = answer.and_then(|it| hover(&it.analysis, at, &mut |_| None)) {
        let lines = shown.markdown.lines().filter(|line| !line.starts_with("```"));
        let text = lines.collect::<Vec<_>>().join("\n");
        response.clone().on_hover_text_at_pointer(text.trim());
    }
}

/// The colour `#rgb` or `#rrggbb` that an offset is in or beside.
fn color_around(text: &str, offset: usize) -> Option<Range<usize>> {
    let is_under = |(class, range): &(Class, Range<usize>)| {
        *class == Class::Color && (range.start..=range.end).contains(&offset)
    };
    let (_, range) = classes(text).into_iter().find(is_under)?;
    // A colour with alpha is not changed, because the button has no alpha.
    matches!(range.len(), 4 | 7).then_some(range)
}

/// An edited text with the line endings of the text before. The editor inserts `\n`, and lets the
/// cursor stand between `\r` and `\n`.
fn with_line_endings_of(before: &str, edited: String) -> String {
    if before.contains("\r\n") { edited.replace('\r', "").replace('\n', "\r\n") } else { edited }
}

/// The byte offset of a character.
fn byte_of(text: &str, character: usize) -> usize {
    text.char_indices().nth(character).map_or(text.len(), |(at, _)| at)
}

/// Paints a number in front of each visible line.
fn line_numbers(ui: &Ui, galley: &Galley, at: egui::Pos2) {
    let font = egui::TextStyle::Monospace.resolve(ui.style());
    let color = theme::of(ui).weak.gamma_multiply(0.6);
    let clip = ui.clip_rect();
    for (index, row) in galley.rows.iter().enumerate() {
        let row = row.rect().translate(at.to_vec2());
        if row.bottom() >= clip.top() && row.top() <= clip.bottom() {
            let position = egui::pos2(at.x - 12.0, row.center().y);
            let number = (index + 1).to_string();
            let align = egui::Align2::RIGHT_CENTER;
            ui.painter().text(position, align, number, font.clone(), color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edited_text_keeps_its_line_endings() {
        let of = |before, edited: &str| with_line_endings_of(before, edited.to_owned());
        assert_eq!(of("a\r\nb\r\n", "a\rc\n\nb\r\n"), "ac\r\n\r\nb\r\n");
        assert_eq!(of("a\nb\n", "a\nc\nb\n"), "a\nc\nb\n");
    }

    #[test]
    fn the_colour_at_the_cursor_is_found() {
        let text = "sphere(1).color(#d94f30)\nbackground(#fff) // #123456\n";
        let found = |at: &str| color_around(text, text.find(at).unwrap()).map(|it| &text[it]);
        assert_eq!([found("#d9"), found("f30"), found(")\nb")], [Some("#d94f30"); 3]);
        assert_eq!([found("fff"), found("sphere"), found("456")], [Some("#fff"), None, None]);
    }
}
