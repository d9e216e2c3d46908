//! Changes numbers of the text by dragging them while Alt is held.

use std::ops::Range;
use std::sync::Arc;

use eframe::egui::{self, CursorIcon, Galley, Id, Pos2, Rect, Sense, Ui};

use super::text_state::{cursor_at, record_change};
use crate::scene::number_text::number_text;
use crate::scene::source_numbers::{WrittenNumber, number_around};
use crate::session::Session;
use crate::session::tabs::TabFile;

/// Points to drag for a change by 1 of a number that must stay whole.
const POINTS_PER_WHOLE: f64 = 8.0;

/// The number that is being dragged.
#[derive(Debug, Default)]
pub struct NumberDrag(Option<Dragged>);

#[derive(Debug)]
struct Dragged {
    number: WrittenNumber,
    is_whole: bool,
    /// The text before.
    before: Arc<str>,
    /// The text that the drag has made.
    written: Arc<str>,
    /// The length of the drag to the right in points.
    points: f32,
    /// Where the number is now.
    range: Range<usize>,
}

impl NumberDrag {
    /// Lets the user drag the number at an offset of the shown text. Returns true if there is one,
    /// or one is being dragged.
    pub fn show(
        &mut self,
        ui: &Ui,
        id: Id,
        (galley, galley_pos): (&Galley, Pos2),
        session: &mut Session,
        at: Option<usize>,
    ) -> bool {
        if session.shown_draft().is_none() {
            return false;
        }
        let text = Arc::clone(session.shown_text());
        // Text that was typed or read meanwhile would be overwritten.
        self.0.take_if(|dragged| dragged.written != text);
        let under = at.filter(|_| ui.input(|input| input.modifiers.alt));
        let range = match &self.0 {
            Some(dragged) => dragged.range.clone(),
            None => match under.and_then(|at| number_around(&text, at)) {
                Some(number) => number.range,
                None => return false,
            },
        };
        let corner = |at: usize| galley.pos_from_cursor(cursor_at(&text, at));
        let rect = Rect::from_min_max(corner(range.start).min, corner(range.end).max);
        let rect = rect.translate(galley_pos.to_vec2());
        let response = ui.interact(rect, id.with("number"), Sense::drag());
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
        if response.drag_started() {
            self.start(&text, range.start, session);
        }
        if let Some(dragged) = &mut self.0 {
            dragged.points += response.drag_delta().x;
            dragged.write(session);
            if response.drag_stopped() || !response.dragged() {
                self.stop(ui.ctx(), id, session);
            }
        }
        true
    }

    fn start(&mut self, text: &Arc<str>, at: usize, session: &Session) {
        let Some(number) = number_around(text, at) else { return };
        // A whole number that is no live literal may decide what the scene consists of.
        let model = session.model.as_ref().filter(|model| model.source == **text);
        let literal = number.range.end - number.literal.len();
        let is_live = model.is_some_and(|model| model.number_at(literal).is_some());
        let is_scene = *session.shown_file() == TabFile::Scene;
        let is_whole = number.decimals == 0 && is_scene && !is_live;
        let range = number.range.clone();
        let [before, written] = [text, text].map(Arc::clone);
        self.0 = Some(Dragged { number, is_whole, before, written, points: 0.0, range });
    }

    /// Makes one step to undo of the drag.
    fn stop(&mut self, ctx: &egui::Context, id: Id, session: &Session) {
        let Some(dragged) = self.0.take() else { return };
        let after = session.shown_text();
        if *dragged.before != **after {
            record_change(ctx, id, [&dragged.before, after], dragged.range);
            // The editor needs the keyboard, or Ctrl + Z would not reach it.
            ctx.memory_mut(|memory| memory.request_focus(id));
        }
    }
}

impl Dragged {
    fn write(&mut self, session: &mut Session) {
        let value = dragged_value(&self.number, self.is_whole, f64::from(self.points));
        let written = self.number.with_value(&number_text(value));
        let mut text = self.before.to_string();
        text.replace_range(self.number.range.clone(), &written);
        self.range = self.number.range.start..self.number.range.start + written.len();
        if text != **session.shown_text() {
            session.edit_shown(|draft| draft.set_text(&text));
            self.written = Arc::clone(session.shown_text());
        }
    }
}

/// The value of a number after a drag. A point changes its third digit.
fn dragged_value(number: &WrittenNumber, is_whole: bool, points: f64) -> f64 {
    if is_whole {
        return number.value + (points / POINTS_PER_WHOLE).round();
    }
    let magnitude = number.value.abs().max(0.1).log10().floor() as i32;
    let decimals = (2 - magnitude).max(number.decimals as i32).clamp(0, 12);
    let unit = 10f64.powi(decimals);
    ((number.value + points * 10f64.powi(magnitude - 2)) * unit).round() / unit
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dragged(text: &str, is_whole: bool, points: f64) -> String {
        let number = number_around(text, text.find(|c: char| c.is_ascii_digit()).unwrap()).unwrap();
        let value = dragged_value(&number, is_whole, points);
        let mut text = text.to_owned();
        text.replace_range(number.range.clone(), &number.with_value(&number_text(value)));
        text
    }

    #[test]
    fn a_point_changes_the_third_digit() {
        assert_eq!(dragged("sphere(1)", false, 5.0), "sphere(1.05)");
        assert_eq!(dragged("sphere(0.25)", false, -5.0), "sphere(0.245)");
        assert_eq!(dragged("rotate(y: 30deg)", false, 10.0), "rotate(y: 31deg)");
        assert_eq!(dragged("rotate(y: 30.25deg)", false, 10.0), "rotate(y: 31.25deg)");
        assert_eq!(dragged("move(-0.5)", false, 100.0), "move(-0.4)");
        assert_eq!(dragged("move(-0.5)", false, 600.0), "move(0.1)");
        assert_eq!(dragged("1 - k", false, -300.0), "-2 - k");
        assert_eq!(dragged("a - 2", false, -300.0), "a - (-1)");
        assert_eq!(dragged("0..5", true, 9.0), "1..5");
    }
}
