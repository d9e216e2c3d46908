//! Why a picture could not be drawn.

use sdfc_march::Method;
use thiserror::Error;

use crate::cpu::method::CpuMethod;
use crate::limits::{MAX_PIXELS, MAX_SAMPLES, MAX_SIDE};
use crate::tiles::Tile;

/// What to install where there is no adapter.
const INSTALL: &str = if cfg!(target_os = "linux") {
    "; install a Vulkan driver, such as the package `mesa-vulkan-drivers` of Debian, Ubuntu and \
     Fedora"
} else {
    ""
};

/// Why a picture could not be drawn. Nothing in this crate panics in its place.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum RenderError {
    /// The machine has no suitable GPU; contains the drivers' message.
    #[error("this machine has no Vulkan, Metal or DX12 adapter{INSTALL}")]
    NoAdapter(String),
    /// The adapter gave no device; contains its message.
    #[error("the adapter gave no device: {0}")]
    NoDevice(String),
    /// The device was lost while drawing; contains the driver's message.
    #[error(
        "the device was lost while drawing: {0}; draw a smaller picture or fewer parts, update the \
         driver, or draw on the CPU"
    )]
    DeviceLost(String),
    /// The device did not answer for this many seconds.
    #[error("the device did not finish a tile within {0} s; draw fewer parts, or draw on the CPU")]
    Stalled(u64),
    /// Memory ran out, on the device or on the host; contains what it was for.
    #[error("out of memory for {0}; draw a smaller picture, or a region of it at a time")]
    OutOfMemory(String),
    /// The device refused the shader or a call: a bug of the compiler, not of the scene.
    #[error("the device refused the shader: {0}")]
    Validation(String),
    /// The program is planar: its shapes are regions, which no ray meets.
    #[error("the scene draws regions, which have no rays; .extrude(0.2) makes solids of them")]
    Planar,
    /// A side of the picture is 0 or greater than [`MAX_SIDE`], or it has more than
    /// [`MAX_PIXELS`].
    #[error(
        "a picture of {}x{}: each side must be 1 to {MAX_SIDE} pixels, both together at most \
         {MAX_PIXELS} pixels", .0[0], .0[1]
    )]
    Size([u32; 2]),
    /// The texture that is to show a picture has another size than the picture.
    #[error("the texture is {}x{}, but the picture is {}x{}", texture[0], texture[1], picture[0], picture[1])]
    TextureSize {
        /// The size of the texture.
        texture: [u32; 2],
        /// The size of the picture.
        picture: [u32; 2],
    },
    /// The region has no pixels, or reaches beyond the picture.
    #[error(
        "the region {},{},{}x{} is not within the picture of {}x{} pixels",
        region.origin[0], region.origin[1], region.size[0], region.size[1], picture[0], picture[1]
    )]
    Region {
        /// The region.
        region: Tile,
        /// The size of the picture.
        picture: [u32; 2],
    },
    /// There are no samples per pixel, or more than [`MAX_SAMPLES`].
    #[error("{0} samples for each pixel: there must be 1 to {MAX_SAMPLES}")]
    Samples(u32),
    /// The scene has more per-frame values than a uniform buffer of this adapter holds.
    #[error("the scene has {count} per-frame values, this adapter's uniform buffers hold {limit}")]
    Uniforms {
        /// The number that the scene has.
        count: usize,
        /// The number that fits.
        limit: usize,
    },
    /// The scene exceeds a limit of this adapter.
    #[error(
        "{what} would take {needed}, and this adapter's `{name}` is {limit}; draw fewer parts in \
         one scene, or draw on the CPU instead"
    )]
    Limit {
        /// The thing that needs it.
        what: &'static str,
        /// The amount needed: bytes of a buffer, or workgroups.
        needed: u64,
        /// The limit's name in WebGPU.
        name: &'static str,
        /// The limit.
        limit: u64,
    },
    /// The number of per-frame values is not that which the shader was compiled for.
    #[error("{given} per-frame values for a shader that reads {expected}")]
    UniformCount {
        /// The number that was passed.
        given: usize,
        /// The number that the shader reads.
        expected: usize,
    },
    /// The scene draws nothing.
    #[error("the scene draws nothing")]
    NothingDrawn,
    /// The progress callback cancelled the frame.
    #[error("cancelled")]
    Cancelled,
    /// The method is none of [`CpuScene::METHODS`](crate::CpuScene::METHODS).
    #[error(
        "the CPU renderer has no method `{0}`; it has `{known}`",
        known = CpuMethod::METHODS.map(Method::name).join("`, `")
    )]
    MethodNotOnCpu(Method),
    /// The CPU evaluator refused the scene; contains its message.
    #[error("the CPU evaluator refused the scene: {0}")]
    Evaluator(String),
}

impl RenderError {
    /// Returns true if the device failed in the middle of its work, as after a tile that took
    /// longer than the system allows. Another device may do the work in smaller tiles.
    pub fn is_device_failure(&self) -> bool {
        matches!(self, Self::DeviceLost(_) | Self::Stalled(_))
    }

    /// Returns true if the machine is the cause, not the scene and not the call.
    pub fn is_machine(&self) -> bool {
        match self {
            Self::NoAdapter(_)
            | Self::NoDevice(_)
            | Self::DeviceLost(_)
            | Self::Stalled(_)
            | Self::OutOfMemory(_)
            | Self::Validation(_)
            | Self::Uniforms { .. }
            | Self::Limit { .. } => true,
            Self::Planar
            | Self::Size(_)
            | Self::TextureSize { .. }
            | Self::Region { .. }
            | Self::Samples(_)
            | Self::UniformCount { .. }
            | Self::NothingDrawn
            | Self::Cancelled
            | Self::MethodNotOnCpu(_)
            | Self::Evaluator(_) => false,
        }
    }
}
