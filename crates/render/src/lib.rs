//! Headless rendering of sdfc shaders on wgpu, and on the CPU where there is no adapter.

mod blocks;
mod compare;
mod error;
mod image;
mod tiles;
mod view;

pub use compare::{Difference, compare, edges};
pub use error::RenderError;
pub use image::{
    CAPPED, HIT, Image, MAX_PIXELS, MAX_SIDE, MISS, PixelCounts, linear_to_srgb, linear_to_srgb8,
};
pub use tiles::{Tile, TileSize};
pub use view::{Bounds, View, ViewError, ViewLight};
