//! A button with the colour at the cursor, which changes it in the text.

use std::ops::Range;
use std::sync::Arc;

use eframe::egui::{Color32, Ui};
use sdfc_ide::{color_presentations, colors};

use crate::session::Session;

/// The colour that the cursor was in last.
#[derive(Debug, Default)]
pub struct ColorButton(Option<ColorAt>);

/// A colour of a text.
#[derive(Clone, Debug, PartialEq)]
struct ColorAt {
    text: Arc<str>,
    range: Range<usize>,
    /// sRGB red, green, blue, and alpha, from 0 to 1.
    rgba: [f64; 4],
}

impl ColorButton {
    /// Shows the button if the cursor is, or was last, in a colour of the shown text.
    pub fn show(&mut self, ui: &mut Ui, session: &mut Session, cursor: Option<usize>) {
        match cursor {
            // Keep the last colour until the colours of the new text are known.
            Some(cursor) if session.answer_about_text().is_some() => {
                self.0 = color_at(session, cursor);
            }
            Some(_) | None => {}
        }
        let Some(at) = self.0.clone().filter(|at| at.text == *session.shown_text()) else { return };
        if session.shown_draft().is_none() {
            return;
        }
        let [r, g, b, a] = at.rgba.map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8);
        let mut color = Color32::from_rgba_unmultiplied(r, g, b, a);
        let button = ui.color_edit_button_srgba(&mut color);
        if !button.on_hover_text("Change the colour at the cursor.").changed() {
            return;
        }
        let rgba = color.to_srgba_unmultiplied().map(|part| f64::from(part) / 255.0);
        // Keep the notation: a literal, or a call of `rgb`.
        let is_call = at.text.get(at.range.clone()).is_some_and(|it| !it.starts_with('#'));
        let written = color_presentations(rgba).into_iter().nth(usize::from(is_call));
        let Some(written) = written else { return };
        let mut text = at.text.to_string();
        let range = at.range.start..at.range.start + written.len();
        text.replace_range(at.range, &written);
        session.edit_shown(|draft| draft.set_text(&text));
        let text = Arc::clone(session.shown_text());
        self.0 = Some(ColorAt { text, range, rgba });
    }
}

/// The colour that an offset is in or beside.
fn color_at(session: &Session, offset: usize) -> Option<ColorAt> {
    let found = colors(&session.answer_about_text()?.analysis).into_iter();
    let mut around = found.filter(|it| (it.range.start..=it.range.end).contains(&offset));
    let color = around.next()?;
    let text = Arc::clone(session.shown_text());
    Some(ColorAt { text, range: color.range, rgba: color.rgba })
}
