//! Outlines the shapes that the code at the cursor makes, over the picture.

use std::sync::Arc;

use eframe::egui::{Color32, ColorImage, Rect, TextureHandle, TextureOptions, Ui, pos2};

use super::theme;
use crate::render::shape_mask::ShapeMask;
use crate::session::Session;

/// The opacity of the colour within the outline.
const TINT: f32 = 0.14;
/// The width of the outline in pixels.
const WIDTH: usize = 2;

/// The outline as a texture.
#[derive(Default)]
pub struct ShapeOutline {
    texture: Option<TextureHandle>,
    shown: Option<Arc<[bool]>>,
}

impl ShapeOutline {
    /// Paints the outline where the picture is shown.
    pub fn show(&mut self, ui: &Ui, [rect, shown]: [Rect; 2], session: &Session) {
        let Some(mask) = session.lit_mask() else { return };
        let is_same = self.shown.as_ref().is_some_and(|it| Arc::ptr_eq(it, &mask.inside));
        if !is_same {
            let image = image(mask, theme::of(ui).accent);
            match &mut self.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                none => {
                    *none = Some(ui.ctx().load_texture("outline", image, TextureOptions::LINEAR))
                }
            }
            self.shown = Some(Arc::clone(&mask.inside));
        }
        if let Some(texture) = &self.texture {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter_at(rect).image(texture.id(), shown, whole, Color32::WHITE);
        }
    }
}

fn image(mask: &ShapeMask, color: Color32) -> ColorImage {
    let [width, height] = mask.size.map(|side| side as usize);
    let inside = |x: usize, y: usize| mask.inside.get(y * width + x) == Some(&true);
    let tint = color.gamma_multiply(TINT);
    let pixel = |index: usize| {
        let (x, y) = (index % width, index / width);
        if !inside(x, y) {
            return Color32::TRANSPARENT;
        }
        // The border of the picture is no edge of the shape.
        let reach = 1..=WIDTH;
        let is_edge = reach.clone().any(|by| {
            (x >= by && !inside(x - by, y))
                || (x + by < width && !inside(x + by, y))
                || (y >= by && !inside(x, y - by))
                || (y + by < height && !inside(x, y + by))
        });
        if is_edge { color } else { tint }
    };
    let pixels = (0..width * height).map(pixel).collect();
    ColorImage::new([width, height], pixels)
}
