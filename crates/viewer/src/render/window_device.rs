//! The device of the window, if it draws the scene too.

use std::sync::atomic::{AtomicU64, Ordering};

use sdfc_render::{DeviceTexture, Display, Gpu, RenderError};

/// Pictures that may be in use at the same time: one is being drawn, one waits for the window, and
/// the GPU may still read the one before.
const TEXTURES: usize = 3;

/// The device of a window. Two are equal if they are the same.
#[derive(Clone, Debug)]
pub struct WindowDevice {
    gpu: Gpu,
    serial: u64,
}

impl WindowDevice {
    /// A device that is not equal to any other.
    pub fn new(gpu: Gpu) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self { gpu, serial: NEXT.fetch_add(1, Ordering::Relaxed) }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }
}

impl PartialEq for WindowDevice {
    fn eq(&self, other: &Self) -> bool {
        self.serial == other.serial
    }
}

/// What pictures on a device need.
#[derive(Debug)]
pub struct DevicePictures {
    display: Display,
    textures: Vec<DeviceTexture>,
    last: usize,
}

impl DevicePictures {
    /// Prepares a device.
    ///
    /// # Errors
    ///
    /// The device is lost.
    pub fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        Ok(Self { display: Display::new(gpu)?, textures: Vec::new(), last: 0 })
    }

    /// Returns true if it was made for this device.
    pub fn are_on(&self, gpu: &Gpu) -> bool {
        self.display.is_on(gpu)
    }

    /// The shader that writes pictures, and a texture of a size that no one looks at any more.
    ///
    /// # Errors
    ///
    /// The device is lost, or has no texture of that size.
    pub fn next(
        &mut self,
        gpu: &Gpu,
        size: [u32; 2],
    ) -> Result<(&Display, DeviceTexture), RenderError> {
        if self.textures.first().is_none_or(|texture| texture.size() != size) {
            let textures = (0..TEXTURES).map(|_| DeviceTexture::new(gpu, size));
            self.textures = textures.collect::<Result<_, _>>()?;
        }
        self.last = (self.last + 1) % TEXTURES;
        Ok((&self.display, self.textures[self.last].clone()))
    }
}
