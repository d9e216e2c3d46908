//! Headless rendering of sdfc shaders on wgpu, and on the CPU where there is no adapter.

mod blocks;
mod compare;
mod device;
mod error;
mod frame;
mod gpu;
mod image;
mod stats;
mod tiles;
mod view;

pub use compare::{Difference, compare, edges};
pub use device::{AdapterInfo, Gpu};
pub use error::RenderError;
pub use frame::{Frame, OnProgress, Progress, RenderOptions, unwatched};
pub use gpu::Pipeline;
pub use image::{
    CAPPED, HIT, Image, MAX_PIXELS, MAX_SIDE, MISS, PixelCounts, linear_to_srgb, linear_to_srgb8,
};
pub use stats::{
    Clock, CompileTimes, EvaluationCounts, FrameTimes, LeafEvaluations, Stats, Why,
};
pub use tiles::{Tile, TileSize};
pub use view::{Bounds, View, ViewError, ViewLight};
