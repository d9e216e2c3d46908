//! Outlines the shapes that the code at the cursor makes, over the picture.

use std::sync::Arc;

use eframe::egui::{Color32, ColorImage, Rect, TextureHandle, TextureOptions, Ui, pos2};

use super::theme;
use crate::render::shape_mask::{Lit, ShapeMask};
use crate::session::Session;

/// The opacity of the colour within the outline.
const TINT: f32 = 0.14;

/// The outline as a white texture.
#[derive(Default)]
pub struct ShapeOutline {
    texture: Option<TextureHandle>,
    shown: Option<Arc<[Lit]>>,
}

impl ShapeOutline {
    /// Paints the outline where the picture is shown.
    pub fn show(&mut self, ui: &Ui, [rect, shown]: [Rect; 2], session: &Session) {
        let Some(mask) = session.lit_mask() else { return };
        let is_same = self.shown.as_ref().is_some_and(|it| Arc::ptr_eq(it, &mask.pixels));
        if !is_same {
            let image = image(mask);
            match &mut self.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                none => {
                    *none = Some(ui.ctx().load_texture("outline", image, TextureOptions::LINEAR))
                }
            }
            self.shown = Some(Arc::clone(&mask.pixels));
        }
        if let Some(texture) = &self.texture {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter_at(rect).image(texture.id(), shown, whole, theme::of(ui).accent);
        }
    }
}

fn image(mask: &ShapeMask) -> ColorImage {
    let tint = Color32::WHITE.gamma_multiply(TINT);
    let color = |lit: &Lit| match lit {
        Lit::No => Color32::TRANSPARENT,
        Lit::Inside => tint,
        Lit::Edge => Color32::WHITE,
    };
    let size = mask.size.map(|side| side as usize);
    ColorImage::new(size, mask.pixels.iter().map(color).collect())
}
