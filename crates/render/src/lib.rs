//! Headless rendering of sdfc shaders: on the GPU with wgpu, or on the CPU if there is none.
//!
//! A [`View`] holds one frame's camera, lights and limits as numbers. A [`Pipeline`] draws it with
//! a program's shader on a [`Gpu`]; a [`CpuScene`] draws it with the program itself. Both cut the
//! picture into tiles, report progress after each, and return a [`Frame`]: an [`Image`] of linear
//! colours, depths and counts, and the time that it took. [`compare`] measures how far two images
//! differ; [`Stats`] is what `render --stats` prints. Nothing here opens files, prints, or panics
//! on its input.
//!
//! ```
//! use sdfc_graph::{Dim, Program, Unary, eval::FrameValues};
//! use sdfc_march::Method;
//! use sdfc_render::{CpuScene, HIT, RenderOptions, View, no_progress};
//!
//! // A unit sphere: |p| - 1, with the gradient p / |p|.
//! let mut program = Program::default();
//! let graph = &mut program.graph;
//! let p = graph.point(0, Dim::Three);
//! let (length, radius) = (graph.length(p), graph.number(1.0));
//! program.distance = Some(graph.sub(length, radius));
//! program.gradient = Some(graph.unary(Unary::Normalize, p));
//!
//! let frame = FrameValues::defaults(&program.params);
//! let view = View::new(&program, &frame, Some([[-1.0; 3], [1.0; 3]]), [32, 24])?;
//! let scene = CpuScene::new(&program)?;
//! let options = RenderOptions::default();
//! let drawn = scene.render(&view, &frame, Method::Auto, &options, &mut no_progress)?;
//! assert_eq!(drawn.image.pixel(16, 12).map(|pixel| pixel.status), Some(HIT));
//! let png: Vec<u8> = drawn.image.to_png()?;
//! # assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! All are on by default:
//!
//! - `gpu`: without it there is only the CPU renderer and no wgpu.
//! - `files`: PNG, GIF and EXR.
//! - `threads`: the CPU renderer uses all cores; without it, the calling thread.
//!
//! # Limits
//!
//! Pictures have at most 16,384 pixels on a side and 2^26 in all, scenes at most 8 lights. The CPU
//! renderer has some of the ray methods, [`CpuScene::METHODS`]. If a device is lost while it is
//! waited for, wgpu panics; the panic is caught and becomes [`RenderError::DeviceLost`], but the
//! panic hook runs.

mod blocks;
mod clock;
mod compare;
mod cpu;
mod error;
mod frame;
#[cfg(feature = "gpu")]
mod gpu;
mod image;
mod limits;
mod stats;
mod tiles;
mod view;

pub use blocks::{
    PIXEL_BYTES, UNIFORM_BYTES, VIEW_BYTES, pixel_from_bytes, uniform_bytes, view_bytes,
};
pub use clock::{Clock, FrameTimes, milliseconds_since};
pub use compare::{Difference, compare, edges};
pub use cpu::{CpuScene, Real};
pub use error::RenderError;
pub use frame::{Frame, OnProgress, Progress, RenderOptions, no_progress, uniform_values};
#[cfg(feature = "gpu")]
pub use gpu::{DeviceTexture, Display, Gpu, Pipeline, testing};
#[cfg(feature = "files")]
pub use image::{Animation, Raster, RasterKind};
pub use image::{
    CAPPED, HIT, Image, MISS, NOT_FINITE_COLOR, PixelCounts, is_finite, is_unproven, sample_offsets,
};
pub use limits::{MAX_PIXELS, MAX_SAMPLES, MAX_SIDE};
pub use sdfc_graph::linear_to_srgb8;
pub use stats::{AdapterInfo, CompileTimes, EvaluationCounts, LeafEvaluations, Stats, Why};
pub use tiles::{Tile, TileSize};
pub use view::footprint::Footprint;
pub use view::{
    Background, Bounds, Pose, View, ViewError, ViewExposure, ViewFog, ViewLight, ViewOcclusion,
    ViewShadow, ViewSource,
};
