//! Draws two sdfc scenes, each with its own params, in one shader of a program that has its own
//! camera and light.
//!
//! Run it with `cargo run -p embed-wgpu -- embed.png`. The test compares its picture with that of
//! `sdfc render`.

mod renderer;
mod target;

pub use renderer::{Camera, Renderer};

/// The scenes, each with the prefix of its functions.
pub const SCENES: [(&str, &str); 2] =
    [("bowl", include_str!("../../bowl.sdf")), ("ring", include_str!("../../ring.sdf"))];

/// Opens a GPU without a window.
///
/// # Errors
///
/// If there is no GPU, or it offers no device.
pub fn open() -> Result<(wgpu::Device, wgpu::Queue), Box<dyn std::error::Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    Ok(pollster::block_on(adapter.request_device(&Default::default()))?)
}
