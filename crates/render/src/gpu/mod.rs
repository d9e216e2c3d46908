//! Drawing on a GPU.

mod culling;
mod culling_layout;
mod device;
mod display;
mod injection;
mod kernel;
mod pipeline;
mod resources;
mod run;
pub mod testing;

pub use device::Gpu;
pub use display::{DeviceTexture, Display};
pub use pipeline::Pipeline;
