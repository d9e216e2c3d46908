//! The legend of a view, over the picture.

use eframe::egui::{self, Color32, Rect, RichText, Sense, Ui, pos2, vec2};

use super::theme::{self, card};
use crate::scene::number_text::display_text;
use crate::views::legend::Legend;

/// The picture width in points from which the legend and the pixel info fit side by side.
const ROOM_FOR_BOTH: f32 = 620.0;

/// Shows the legend in the lower right corner; above the pixel info if there is no room for both.
pub fn show(ui: &mut Ui, rect: Rect, legend: &Legend) {
    if *legend == Legend::None {
        return;
    }
    let area = egui::Area::new(ui.scope_id().with("legend"))
        .order(egui::Order::Middle)
        .interactable(false);
    let lift = if rect.width() < ROOM_FOR_BOTH { 94.0 } else { 10.0 };
    let area =
        area.pivot(egui::Align2::RIGHT_BOTTOM).fixed_pos(rect.right_bottom() - vec2(10.0, lift));
    area.show(ui.ctx(), |ui| {
        card(ui).show(ui, |ui| match legend {
            Legend::None => {}
            Legend::Scale { label, ends, ramp } => {
                ui.label(RichText::new(*label).small().color(theme::of(ui).weak));
                let (bar, _) = ui.allocate_exact_size(vec2(220.0, 10.0), Sense::hover());
                const STEPS: usize = 44;
                for step in 0..STEPS {
                    let [red, green, blue] = ramp.color((step as f64 + 0.5) / STEPS as f64);
                    let width = bar.width() / STEPS as f32;
                    let left = bar.left() + width * step as f32;
                    let cell = Rect::from_min_size(pos2(left, bar.top()), vec2(width + 0.5, 10.0));
                    ui.painter().rect_filled(cell, 0.0, Color32::from_rgb(red, green, blue));
                }
                let [low, high] = ends.map(display_text);
                let middle = display_text((ends[0] + ends[1]) / 2.0);
                let font = egui::TextStyle::Small.resolve(ui.style());
                let (row, _) = ui.allocate_exact_size(vec2(220.0, 12.0), Sense::hover());
                let labels = [
                    (row.left_top(), egui::Align2::LEFT_TOP, low),
                    (row.center_top(), egui::Align2::CENTER_TOP, middle),
                    (row.right_top(), egui::Align2::RIGHT_TOP, high),
                ];
                for (at, align, text) in labels {
                    ui.painter().text(at, align, text, font.clone(), theme::of(ui).text);
                }
            }
            Legend::Keys(keys) => {
                for ([red, green, blue], text) in keys {
                    ui.horizontal(|ui| {
                        let (dot, _) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
                        let (fill, line) =
                            (Color32::from_rgb(*red, *green, *blue), theme::of(ui).line);
                        let line = egui::Stroke::new(1.0, line);
                        ui.painter().rect(dot, 2.0, fill, line, egui::StrokeKind::Outside);
                        ui.label(RichText::new(text).small());
                    });
                }
            }
        });
    });
}
