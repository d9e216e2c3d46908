//! The texture of a picture that stays on the device of the window.

use eframe::egui::TextureId;
use eframe::egui_wgpu::RenderState;
use eframe::wgpu::{FilterMode, Texture, TextureViewDescriptor};

use crate::render::picture::MovingPicture;

/// The name that egui has for the texture of the shown picture.
#[derive(Default)]
pub struct DeviceTextureSlot {
    state: Option<RenderState>,
    id: Option<TextureId>,
    /// The shown picture's texture and divisor.
    shown: Option<(Texture, u32)>,
}

impl DeviceTextureSlot {
    /// A slot of a window.
    pub fn new(state: RenderState) -> Self {
        Self { state: Some(state), id: None, shown: None }
    }

    /// The name of a picture's texture; `None` if the window cannot show it.
    pub fn show(&mut self, picture: &MovingPicture) -> Option<TextureId> {
        let state = self.state.as_ref()?;
        let (texture, divisor) = (picture.texture.texture(), picture.divisor);
        if self.shown.as_ref().is_some_and(|shown| (&shown.0, shown.1) == (texture, divisor)) {
            return self.id;
        }
        let view = texture.create_view(&TextureViewDescriptor::default());
        let filter = match divisor {
            1 => FilterMode::Nearest,
            _ => FilterMode::Linear,
        };
        let (device, mut renderer) = (&state.device, state.renderer.write());
        match self.id {
            Some(id) => {
                renderer.update_egui_texture_from_wgpu_texture(device, &view, filter, id);
            }
            None => self.id = Some(renderer.register_native_texture(device, &view, filter)),
        }
        self.shown = Some((texture.clone(), divisor));
        self.id
    }
}
