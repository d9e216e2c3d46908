//! Textures of small pictures.

use std::collections::BTreeMap;

use eframe::egui::{ColorImage, Context, TextureHandle, TextureOptions};

use crate::small_pictures::{PictureKey, SIZE, SmallPictures};

/// The textures of the pictures that were shown.
pub struct PictureTextures<K>(BTreeMap<K, TextureHandle>);

impl<K: PictureKey> PictureTextures<K> {
    /// The texture of a picture; `None` until it is drawn.
    pub fn get(
        &mut self,
        ctx: &Context,
        pictures: &mut SmallPictures<K>,
        key: &K,
    ) -> Option<&TextureHandle> {
        if !self.0.contains_key(key) {
            let rgb = pictures.get(key)?;
            let image = ColorImage::from_rgb(SIZE.map(|side| side as usize), rgb);
            let texture = ctx.load_texture("small picture", image, TextureOptions::LINEAR);
            self.0.insert(key.clone(), texture);
        }
        self.0.get(key)
    }
}

impl<K> Default for PictureTextures<K> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<K> std::fmt::Debug for PictureTextures<K> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("PictureTextures").field(&self.0.len()).finish()
    }
}
