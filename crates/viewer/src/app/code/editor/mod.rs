//! An editor of the shown text: colours, line numbers, underlined errors, descriptions,
//! completions, search, undo and redo.

mod input;

use std::ops::Range;
use std::sync::Arc;

use eframe::egui::text_edit::TextEditOutput;
use eframe::egui::{self, Galley, Id, TextBuffer, Ui};

use crate::app::code::color_button::ColorButton;
use crate::app::code::completion_list::CompletionList;
use crate::app::code::find_bar::FindBar;
use crate::app::code::highlighting::{LayoutCache, LayoutKey, Mark};
use crate::app::code::hover_text::HoverText;
use crate::app::code::jumps::{self, Jumps};
use crate::app::code::number_drag::NumberDrag;
use crate::app::code::text_state::{
    byte_of, cursor_at, editor_id, move_cursor, record_change, select,
};
use crate::app::theme;
use crate::compile::diagnostics::ShownDiagnostic;
use crate::scene::line_endings::{formatted, with_line_endings_of};
use crate::session::Session;
use crate::session::tabs::TabFile;

/// The width of the line numbers in points.
const GUTTER: f32 = 40.0;

/// The state of the editor beside its texts.
#[derive(Debug, Default)]
pub struct CodeEditor {
    /// The file that was shown in the last frame.
    file: TabFile,
    list: CompletionList,
    find: FindBar,
    jumps: Jumps,
    color: ColorButton,
    drag: NumberDrag,
    hover: HoverText,
    layout: LayoutCache,
    /// The cursor of the last frame as a byte offset, while the editor has the keyboard.
    cursor: Option<usize>,
    /// The selection of the last frame in which the editor had the keyboard, in bytes.
    selected: Range<usize>,
    /// A range that is lit because its shape was clicked, and the text that it belongs to.
    lit: Option<(Range<usize>, Arc<str>)>,
    /// The range that is scrolled to.
    scroll: Option<Range<usize>>,
}

impl CodeEditor {
    /// Lights the code of a shape, and scrolls to it.
    pub fn light(&mut self, code: Option<(TabFile, Range<usize>)>, session: &mut Session) {
        self.lit = code.map(|(file, range)| {
            session.show_file(file);
            self.scroll = Some(range.clone());
            (range, Arc::clone(session.shown_text()))
        });
    }

    /// The position in the code whose shapes are lit in the picture: the cursor while the editor
    /// has the keyboard, else the code of the shape that was clicked.
    pub fn lit_position(&self, session: &Session) -> Option<(TabFile, usize)> {
        let is_lit = |(_, text): &&(Range<usize>, Arc<str>)| text == session.shown_text();
        let clicked = || self.lit.as_ref().filter(is_lit).map(|(range, _)| range.start);
        let offset = self.cursor.or_else(clicked)?;
        (self.file == *session.shown_file()).then(|| (self.file.clone(), offset))
    }

    /// Shows a button with the colour at the cursor, which changes it in the text.
    pub fn color_button(&mut self, ui: &mut Ui, session: &mut Session) {
        self.color.show(ui, session, self.cursor);
    }

    /// Opens the bar of the search.
    pub fn search(&mut self, replaces: bool, session: &Session) {
        self.find.open(replaces, session.shown_text(), &self.selected);
        self.list.typing = false;
    }

    /// Goes to the definition of the name at the cursor.
    pub fn go_to_definition(&mut self, session: &mut Session) {
        let from = self.selected.start;
        self.jumps.go_to_definition(session, from, from);
    }

    /// Goes back to where the last jump began.
    pub fn go_back(&mut self, session: &mut Session) {
        self.jumps.back(session);
    }

    /// True if there is a jump to go back from.
    pub fn can_go_back(&self) -> bool {
        self.jumps.can_go_back()
    }

    /// Forgets the cursor while the editor is not shown.
    pub fn forget_cursor(&mut self) {
        self.cursor = None;
    }

    /// Shows the editor. What is typed becomes the shown text of the session.
    pub fn show(&mut self, ui: &mut Ui, session: &mut Session) {
        self.handle_jump_keys(ui, session);
        self.follow_shown_file(ui, session);
        let id = editor_id(session.path(), &self.file);
        let has_focus = self.handle_keys(ui, id, session);
        self.find_and_replace(ui, id, session);
        session.ask_about_text(self.cursor.filter(|_| has_focus));
        let found: Vec<ShownDiagnostic> = session.diagnostics_of_text().cloned().collect();
        egui::ScrollArea::both().id_salt(id).auto_shrink(false).show(ui, |ui| {
            let height = ui.available_height();
            ui.horizontal_top(|ui| {
                ui.add_space(GUTTER);
                let mut text = session.shown_text().to_string();
                let output = self.text_edit(ui, (id, height), &mut text, session, &found);
                line_numbers(ui, &output.galley, output.galley_pos);
                if let Some(range) = self.scroll.take() {
                    let at = output.galley.pos_from_cursor(cursor_at(&text, range.start));
                    let at = at.translate(output.galley_pos.to_vec2());
                    ui.scroll_to_rect(at.expand2(egui::vec2(0.0, 60.0)), None);
                }
                self.take_edit(ui.ctx(), &output, &text, session);
                if has_focus && let Some(cursor) = output.cursor_range {
                    let below = output.galley.pos_from_cursor(cursor.primary).left_bottom();
                    self.show_list(ui, id, output.galley_pos + below.to_vec2(), session);
                }
                self.point_at(ui, &output, (&text, &found), session);
            });
        });
    }

    /// Shows the text, and lets the user edit it unless it is that of a library file.
    fn text_edit(
        &mut self,
        ui: &mut Ui,
        (id, height): (Id, f32),
        text: &mut String,
        session: &Session,
        found: &[ShownDiagnostic],
    ) -> TextEditOutput {
        let palette = theme::of(ui);
        let file = self.file.name(session.path());
        let answer = session.language.as_ref().filter(|it| it.request.file == file);
        let lit = self.lit.as_ref().filter(|(_, of)| of == session.shown_text());
        let (matches, current) = self.find.marked(session.shown_text());
        let mut key = LayoutKey {
            text: String::new(),
            roles: answer.map(|it| (Arc::clone(&it.request.text), Arc::clone(&it.tokens))),
            marks: found.iter().map(|found| Mark::of(found, palette)).collect(),
            lit: lit.map(|(range, _)| range.clone()),
            found: matches,
            current,
            is_dark: ui.visuals().dark_mode,
            font: egui::TextStyle::Monospace.resolve(ui.style()),
        };
        let cache = &mut self.layout;
        let row = ui.text_style_height(&egui::TextStyle::Monospace).max(1.0);
        let mut layouter = |ui: &Ui, text: &dyn TextBuffer, _: f32| -> Arc<Galley> {
            text.as_str().clone_into(&mut key.text);
            let job = cache.layout(&key, palette);
            ui.fonts_mut(|fonts| fonts.layout_job(job))
        };
        let is_library = matches!(self.file, TabFile::Library(_));
        let mut fixed = text.as_str();
        let edit = match is_library {
            true => egui::TextEdit::multiline(&mut fixed),
            false => egui::TextEdit::multiline(text),
        };
        let edit = edit
            .id(id)
            .frame(egui::Frame::NONE)
            .code_editor()
            .desired_width(f32::INFINITY)
            // The editor fills the panel, so a click below the text puts the cursor at its end.
            .desired_rows((height / row - 1.0).max(8.0) as usize)
            .layouter(&mut layouter);
        let output = edit.show(ui);
        ui.ctx().accesskit_node_builder(id, |node| node.set_label("the text of the shown file"));
        output
    }

    /// Records the cursor and what was typed.
    fn take_edit(
        &mut self,
        ctx: &egui::Context,
        output: &TextEditOutput,
        text: &str,
        session: &mut Session,
    ) {
        let before = self.cursor;
        self.cursor = output.cursor_range.map(|range| byte_of(text, range.primary.index.0));
        if let Some(range) = output.cursor_range {
            let [from, to] = range.sorted_cursors();
            self.selected = byte_of(text, from.index.0)..byte_of(text, to.index.0);
        }
        if output.response.changed() {
            let before = Arc::clone(session.shown_text());
            let edited = with_line_endings_of(&before, text.to_owned());
            if edited != text {
                // Each inserted or removed `\r` in front of the cursor moves it by a character.
                let moved = |at: usize| with_line_endings_of(&before, text[..at].to_owned()).len();
                self.cursor = self.cursor.map(moved);
                self.selected = moved(self.selected.start)..moved(self.selected.end);
                move_cursor(ctx, output.response.response.id, &edited, self.selected.clone());
            }
            session.edit_shown(|draft| draft.set_text(&edited));
            self.list.typing = true;
        } else if self.cursor != before {
            self.list.typing = false;
        }
    }

    /// Forgets what was lost with a window.
    pub fn move_to_window(&mut self) {
        self.hover = HoverText::default();
    }

    /// Formats the shown text.
    pub fn format(&mut self, ctx: &egui::Context, session: &mut Session) {
        let before = Arc::clone(session.shown_text());
        match formatted(&before) {
            Some(after) if session.shown_draft().is_some() => {
                let at = self.selected.start.min(after.len());
                record_change(
                    ctx,
                    editor_id(session.path(), &self.file),
                    [&before, &after],
                    at..at,
                );
                session.edit_shown(|draft| draft.set_text(&after));
            }
            Some(_) => {}
            None => session.messages.push("a text with syntax errors is not formatted".to_owned()),
        }
    }

    /// Describes what is under the pointer, and follows a click with Ctrl to its definition.
    fn point_at(
        &mut self,
        ui: &Ui,
        output: &TextEditOutput,
        (text, found): (&str, &[ShownDiagnostic]),
        session: &mut Session,
    ) {
        let response = &output.response.response;
        let offset = |at: egui::Pos2| {
            byte_of(text, output.galley.cursor_from_pos(at - output.galley_pos).index.0)
        };
        let pointer = ui.input(|input| input.pointer.hover_pos());
        let at = pointer.filter(|at| response.interact_rect.contains(*at)).map(offset);
        let galley = (&*output.galley, output.galley_pos);
        if *text == **session.shown_text()
            && self.drag.show(ui, editor_id(session.path(), &self.file), galley, session, at)
        {
            return;
        }
        let Some(at) = response.hover_pos().map(offset) else { return };
        if ui.input(|input| input.modifiers.command) && jumps::target(session, at).is_some() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
            if response.clicked() {
                self.jumps.go_to_definition(session, at, at);
            }
        } else {
            self.hover.describe(response, session, found, at);
        }
    }

    /// Shows the file that was chosen, and the range that a jump leads to.
    fn follow_shown_file(&mut self, ui: &Ui, session: &mut Session) {
        if self.file != *session.shown_file() {
            self.file = session.shown_file().clone();
            (self.list, self.cursor, self.selected) = (CompletionList::default(), None, 0..0);
            (self.color, self.drag) = (ColorButton::default(), NumberDrag::default());
        }
        if let Some(range) = self.jumps.take_target(&self.file) {
            let text = session.shown_text();
            let range = range.start.min(text.len())..range.end.min(text.len());
            select(ui.ctx(), editor_id(session.path(), &self.file), text, range.clone());
            self.selected = range.clone();
            self.scroll = Some(range);
        }
    }
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
