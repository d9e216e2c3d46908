//! Keys, search and completions of the editor.

use eframe::egui::{self, Event, Id, Key, Modifiers, Ui};
use sdfc_ide::Completion;

use super::CodeEditor;
use crate::app::code::find_bar::FindRequest;
use crate::app::code::text_state::{Step, record_change, select, step};
use crate::language::completions::{inserted, matching};
use crate::session::Session;

/// What the Tab key inserts.
const INDENT: &str = "  ";

impl CodeEditor {
    /// F12 goes to a definition, Alt + Left back. These work in the whole panel.
    pub(super) fn handle_jump_keys(&mut self, ui: &Ui, session: &mut Session) {
        let is_elsewhere = ui.ctx().text_edit_focused() && self.cursor.is_none();
        if is_elsewhere {
            return;
        }
        let pressed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
        if pressed(Modifiers::NONE, Key::F12) {
            self.go_to_definition(session);
        }
        if pressed(Modifiers::ALT, Key::ArrowLeft) {
            self.go_back(session);
        }
    }

    /// Handles the keys that the editor would use for something else. Returns true if it has the
    /// keyboard.
    pub(super) fn handle_keys(&mut self, ui: &Ui, id: Id, session: &mut Session) -> bool {
        for (key, replaces) in [(Key::F, false), (Key::H, true)] {
            if ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, key)) {
                self.search(replaces, session);
            }
        }
        // egui takes the keyboard away before this sees the key.
        if self.cursor.is_some() && self.list.close_by_key(ui) {
            ui.memory_mut(|memory| memory.request_focus(id));
        }
        if !ui.memory(|memory| memory.has_focus(id)) {
            return false;
        }
        let accepted = {
            let items = self.items(session);
            self.list.accept_by_key(ui, &items).cloned()
        };
        if let Some(completion) = accepted {
            self.insert(ui, id, &completion, session);
        }
        let redo = [(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z), (Modifiers::COMMAND, Key::Y)];
        let undo = [(Modifiers::COMMAND, Key::Z)];
        // With Shift the key means the other one, so that one is looked for first.
        for (keys, direction) in [(&redo[..], Step::Redo), (&undo[..], Step::Undo)] {
            for (modifiers, key) in keys {
                while ui.input_mut(|input| input.consume_key(*modifiers, *key)) {
                    self.step(ui, id, direction, session);
                }
            }
        }
        // Tab would move the focus.
        ui.input_mut(|input| {
            if input.consume_key(Modifiers::NONE, Key::Tab) {
                input.events.push(Event::Text(INDENT.to_owned()));
            }
        });
        true
    }

    /// Takes a step in the history of the shown text, unless it cannot be edited.
    fn step(&mut self, ui: &Ui, id: Id, direction: Step, session: &mut Session) {
        if session.shown_draft().is_some()
            && let Some(text) = step(ui.ctx(), id, session.shown_text(), direction)
        {
            session.edit_shown(|draft| draft.set_text(&text));
            self.list.typing = false;
        }
    }

    /// Shows the bar of the search, and does what it asks for.
    pub(super) fn find_and_replace(&mut self, ui: &mut Ui, id: Id, session: &mut Session) {
        let is_editable = session.shown_draft().is_some();
        match self.find.show(ui, session.shown_text(), self.selected.start, is_editable) {
            None => {}
            Some(FindRequest::Show(range)) => self.scroll = Some(range),
            Some(FindRequest::Replace(text, range)) => {
                record_change(ui.ctx(), id, [session.shown_text(), &text], range.clone());
                session.edit_shown(|draft| draft.set_text(&text));
                self.scroll = Some(range);
            }
            Some(FindRequest::Leave(range)) => {
                let range = range.unwrap_or_else(|| self.selected.clone());
                select(ui.ctx(), id, session.shown_text(), range);
            }
        }
    }

    /// The completions at the cursor.
    fn items<'s>(&self, session: &'s Session) -> Vec<&'s Completion> {
        let answer = session.answer_about_text().zip(self.cursor);
        answer.map(|(it, cursor)| matching(it, session.shown_text(), cursor)).unwrap_or_default()
    }

    pub(super) fn show_list(&mut self, ui: &Ui, id: Id, at: egui::Pos2, session: &mut Session) {
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
        let mut text = session.shown_text().to_string();
        let start = completion.replace.start;
        if text.get(completion.replace.clone()).is_none() {
            return;
        }
        text.replace_range(completion.replace.clone(), &insert);
        let selected = start + gap.start..start + gap.end;
        record_change(ui.ctx(), id, [session.shown_text(), &text], selected);
        session.edit_shown(|draft| draft.set_text(&text));
        self.list.typing = false;
        ui.memory_mut(|memory| memory.request_focus(id));
    }
}
