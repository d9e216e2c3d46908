//! A number that can be dragged and typed.

use eframe::egui;

use crate::scene::number_text::display_text;

/// A number that can be dragged and typed. It is displayed rounded, but typing the displayed text
/// again keeps the exact value.
pub fn number_drag(number: &mut f64) -> egui::DragValue<'_> {
    let before = *number;
    let parse = move |text: &str| match text.trim() {
        same if same == display_text(before) => Some(before),
        other => other.parse().ok(),
    };
    let drag = egui::DragValue::new(number).custom_formatter(|value, _| display_text(value));
    drag.custom_parser(parse)
}
