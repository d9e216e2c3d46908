//! Cursor and undo history of the editor, which egui keeps.

use std::ops::Range;
use std::path::Path;

use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::text_edit::TextEditState;
use eframe::egui::{Context, Id};

use crate::compile::text_diff::TextDiff;
use crate::session::tabs::TabFile;

/// The id of the editor of a file of a scene: each has its own cursor and undo history.
pub fn editor_id(scene: &Path, file: &TabFile) -> Id {
    Id::unique(("code editor", scene, file))
}

/// The byte offset of a character.
pub fn byte_of(text: &str, character: usize) -> usize {
    text.char_indices().nth(character).map_or(text.len(), |(at, _)| at)
}

/// The cursor in front of a byte.
pub fn cursor_at(text: &str, byte: usize) -> CCursor {
    CCursor::new(text.char_indices().take_while(|(at, _)| *at < byte).count())
}

/// Selects a byte range of the text.
pub fn move_cursor(ctx: &Context, id: Id, text: &str, range: Range<usize>) {
    let mut state = TextEditState::load(ctx, id).unwrap_or_default();
    state.cursor.set_char_range(Some(cursors(text, range)));
    state.store(ctx, id);
}

/// Selects a byte range of the text, and gives the editor the keyboard.
pub fn select(ctx: &Context, id: Id, text: &str, range: Range<usize>) {
    move_cursor(ctx, id, text, range);
    ctx.memory_mut(|memory| memory.request_focus(id));
}

/// Records a change that was not typed as one step to undo, and moves the cursor. `selected` is a
/// byte range of the text after the change.
pub fn record_change(ctx: &Context, id: Id, [before, after]: [&str; 2], selected: Range<usize>) {
    let mut state = TextEditState::load(ctx, id).unwrap_or_default();
    let mut undoer = state.undoer();
    let time = ctx.input(|input| input.time);
    undoer.add_undo(&(state.cursor.char_range().unwrap_or_default(), before.to_owned()));
    let changed = (cursors(after, selected), after.to_owned());
    // Feeding forgets what could be redone.
    undoer.feed_state(time, &changed);
    undoer.add_undo(&changed);
    state.cursor.set_char_range(Some(changed.0));
    state.set_undoer(undoer);
    state.store(ctx, id);
}

/// Records a change that was not typed as one step to undo, with the cursor behind what changed.
pub fn record_replaced(ctx: &Context, id: Id, [before, after]: [&str; 2]) {
    let end = TextDiff::new(before, after).new_end as usize;
    record_change(ctx, id, [before, after], end..end);
}

/// The direction of a step in the history of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Back.
    Undo,
    /// Forward again.
    Redo,
}

/// Takes a step in the history of a text, and moves the cursor to where it was. Returns the text
/// there; `None` if there is no other one in that direction. egui also records where the cursor
/// rested; a step leads to the next state with another text.
pub fn step(ctx: &Context, id: Id, text: &str, step: Step) -> Option<String> {
    let mut state = TextEditState::load(ctx, id)?;
    let mut undoer = state.undoer();
    let mut at = (state.cursor.char_range().unwrap_or_default(), text.to_owned());
    while at.1 == text {
        let next = match step {
            Step::Undo => undoer.undo(&at),
            Step::Redo => undoer.redo(&at),
        };
        at = next?.clone();
    }
    state.cursor.set_char_range(Some(at.0));
    state.set_undoer(undoer);
    state.store(ctx, id);
    Some(at.1)
}

/// Gives the editors in a new window the cursors and undo histories that they had in the old one.
pub fn move_editors(old: &Context, new: &Context, scene: &Path, files: &[TabFile]) {
    for id in files.iter().map(|file| editor_id(scene, file)) {
        if let Some(state) = TextEditState::load(old, id) {
            state.store(new, id);
        }
    }
}

fn cursors(text: &str, range: Range<usize>) -> CCursorRange {
    CCursorRange::two(cursor_at(text, range.start), cursor_at(text, range.end))
}
