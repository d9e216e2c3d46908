//! Why a picture could not be drawn.

use std::fmt;

use crate::image::{MAX_PIXELS, MAX_SAMPLES, MAX_SIDE};

/// Why a picture could not be drawn. Nothing in this crate panics in its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RenderError {
    /// The machine has no adapter that fits; what the drivers said.
    NoAdapter(String),
    /// The adapter gave no device; what it said.
    NoDevice(String),
    /// The device was lost while drawing; what the driver said.
    DeviceLost(String),
    /// No answer for so many seconds.
    Stalled(u64),
    /// Memory ran out, on the device or on the host; for what.
    OutOfMemory(String),
    /// The device refused the shader or a call: a fault of the compiler, not of the scene.
    Validation(String),
    /// A side of the picture is 0 or beyond [`MAX_SIDE`], or it has more than [`MAX_PIXELS`].
    Size([u32; 2]),
    /// No rays for each pixel, or more than [`MAX_SAMPLES`].
    Samples(u32),
    /// The scene has more per-frame values than a uniform buffer of this adapter holds.
    Uniforms {
        /// How many the scene has.
        count: usize,
        /// How many fit.
        limit: usize,
    },
    /// The scene needs more of something than this adapter has.
    Limit {
        /// What it is needed for.
        what: &'static str,
        /// How much is needed: bytes of a buffer, or workgroups.
        needed: u64,
        /// The limit's name in WebGPU.
        name: &'static str,
        /// The limit.
        limit: u64,
    },
    /// Another number of per-frame values than the shader was compiled for.
    UniformCount {
        /// How many came.
        given: usize,
        /// How many the shader reads.
        expected: usize,
    },
    /// The scene draws nothing.
    NothingDrawn,
    /// The progress callback asked to stop.
    Cancelled,
    /// The method is none of [`CpuScene::METHODS`](crate::CpuScene::METHODS).
    MethodNotOnCpu(String),
    /// The CPU evaluator refused the scene; what it said.
    Evaluator(String),
}

impl RenderError {
    /// Whether the machine is at fault, not the scene and not the call.
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
            Self::Size(_)
            | Self::Samples(_)
            | Self::UniformCount { .. }
            | Self::NothingDrawn
            | Self::Cancelled
            | Self::MethodNotOnCpu(_)
            | Self::Evaluator(_) => false,
        }
    }
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAdapter(detail) => {
                write!(f, "this machine has no Vulkan, Metal or DX12 adapter ({detail})")
            }
            Self::NoDevice(detail) => write!(f, "the adapter gave no device: {detail}"),
            Self::DeviceLost(detail) => write!(f, "the device was lost while drawing: {detail}"),
            Self::Stalled(seconds) => {
                write!(f, "the device did not finish a tile within {seconds} s")
            }
            Self::OutOfMemory(what) => write!(f, "out of memory for {what}"),
            Self::Validation(detail) => write!(f, "the device refused the shader: {detail}"),
            Self::Size([width, height]) => write!(
                f,
                "a picture of {width}x{height}: each side must be 1 to {MAX_SIDE} pixels, \
                 both together at most {MAX_PIXELS} pixels"
            ),
            Self::Samples(count) => {
                write!(f, "{count} samples for each pixel: there must be 1 to {MAX_SAMPLES}")
            }
            Self::Uniforms { count, limit } => write!(
                f,
                "the scene has {count} per-frame values, this adapter's uniform buffers hold {limit}"
            ),
            Self::Limit { what, needed, name, limit } => write!(
                f,
                "{what} would take {needed}, and this adapter's `{name}` is {limit}; draw fewer parts in one scene, \
                 or draw on the processor (`--backend cpu`)"
            ),
            Self::UniformCount { given, expected } => {
                write!(f, "{given} per-frame values for a shader that reads {expected}")
            }
            Self::NothingDrawn => f.write_str("the scene draws nothing"),
            Self::Cancelled => f.write_str("cancelled"),
            Self::MethodNotOnCpu(name) => {
                let own = crate::CpuScene::METHODS.join("`, `");
                write!(f, "the CPU renderer has no method `{name}`; it has `{own}`")
            }
            Self::Evaluator(detail) => write!(f, "the CPU evaluator refused the scene: {detail}"),
        }
    }
}

impl std::error::Error for RenderError {}
