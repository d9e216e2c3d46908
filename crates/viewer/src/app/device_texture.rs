//! The texture of a picture that stays on the device of the window.

use eframe::egui::TextureId;
use eframe::egui_wgpu::RenderState;
use eframe::wgpu::{FilterMode, TextureViewDescriptor};

use crate::render::picture::MovingPicture;

/// The name that egui has for the texture of the shown picture.
#[derive(Default)]
pub struct DeviceTextureSlot {
    state: Option<RenderState>,
    id: Option<TextureId>,
    shown: Option<MovingPicture>,
}

impl DeviceTextureSlot {
    /// A slot of a window.
    pub fn new(state: RenderState) -> Self {
        Self { state: Some(state), id: None, shown: None }
    }

    /// The name of a picture's texture; `None` if the window cannot show it.
    pub fn show(&mut self, picture: &MovingPicture) -> Option<TextureId> {
        let state = self.state.as_ref()?;
        let is_shown = |shown: &MovingPicture| {
            let textures = [shown, picture].map(|it| it.texture.texture());
            textures[0] == textures[1] && shown.divisor == picture.divisor
        };
        if self.shown.as_ref().is_some_and(is_shown) {
            return self.id;
        }
        let view = picture.texture.texture().create_view(&TextureViewDescriptor::default());
        let filter = match picture.divisor {
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
        self.shown = Some(picture.clone());
        self.id
    }
}
