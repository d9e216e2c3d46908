//! Support for tests that need an adapter.
//!
//! Such tests belong in a target without the standard harness, so that on a machine without an
//! adapter they are reported as ignored, never as passed:
//!
//! ```no_run
//! use libtest_mimic::{Arguments, Trial};
//! use sdfc_render::{Gpu, testing};
//!
//! let ignored = testing::without_gpu();
//! let draws = Trial::test("draws", || {
//!     let gpu = Gpu::new()?;
//!     assert!(!gpu.info().name.is_empty());
//!     Ok(())
//! });
//! libtest_mimic::run(&Arguments::from_args(), vec![draws.with_ignored_flag(ignored)]).exit();
//! ```
//!
//! With `SDFC_REQUIRE_GPU=1` in the environment they run everywhere, and fail if
//! [`Gpu::new`](crate::Gpu::new) does.
//!
//! A device can be lost on purpose: [`lose`] does it, and [`LOSE_DEVICE`] makes a program of a
//! debug build do it.

use std::sync::OnceLock;

pub use super::injection::LOSE_DEVICE;

use super::device::Gpu;
use super::display::DeviceTexture;
use super::resources::buffer;
use crate::error::RenderError;

/// The environment variable that makes tests fail instead of being ignored if there is no adapter.
pub const REQUIRE_GPU: &str = "SDFC_REQUIRE_GPU";

/// Returns true if tests that need an adapter are ignored: there is none, and none is required.
pub fn without_gpu() -> bool {
    static WITHOUT: OnceLock<bool> = OnceLock::new();
    *WITHOUT.get_or_init(|| {
        ignored(std::env::var_os(REQUIRE_GPU).is_some_and(|v| v == "1"), || Gpu::new().is_ok())
    })
}

/// Opens the adapter as if it could bind no larger storage buffers.
///
/// # Errors
///
/// As [`Gpu::new`].
pub fn with_storage(bytes: u64) -> Result<Gpu, RenderError> {
    Gpu::with_limits(|limits| wgpu::Limits { max_storage_buffer_binding_size: bytes, ..limits })
}

/// Copies a picture from the device: red, green, blue and alpha of each pixel.
///
/// # Errors
///
/// [`RenderError::DeviceLost`].
pub fn read_texture(gpu: &Gpu, texture: &DeviceTexture) -> Result<Vec<u8>, RenderError> {
    let [width, height] = texture.size();
    let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
    let staging = buffer(gpu, "picture", u64::from(row) * u64::from(height), usage);
    gpu.scoped("reading a picture", || {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row),
            rows_per_image: None,
        };
        let target = wgpu::TexelCopyBufferInfo { buffer: &staging, layout };
        let size = texture.texture().size();
        encoder.copy_texture_to_buffer(texture.texture().as_image_copy(), target, size);
        gpu.queue.submit([encoder.finish()]);
        staging.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    })?;
    gpu.wait(None)?;
    let refused = |error: wgpu::MapRangeError| RenderError::DeviceLost(error.to_string());
    let mapped = staging.slice(..).get_mapped_range().map_err(refused)?;
    let rows = mapped.chunks_exact(row as usize);
    Ok(rows.flat_map(|row| &row[..4 * width as usize]).copied().collect())
}

/// Loses the device.
pub fn lose(gpu: &Gpu) {
    gpu.device.destroy();
}

fn ignored(required: bool, present: impl FnOnce() -> bool) -> bool {
    !required && !present()
}

#[cfg(test)]
mod tests {
    use super::ignored;

    #[test]
    fn tests_are_ignored_only_without_an_adapter_that_nobody_requires() {
        assert!(ignored(false, || false));
        assert!(!ignored(false, || true));
        assert!(!ignored(true, || false));
        assert!(!ignored(true, || true));
    }
}
