//! Options, progress and the finished frame, which all renderers share.

use std::ops::ControlFlow;

use sdfc_graph::{
    Program,
    eval::{FrameValues, evaluate_frame},
};

use crate::clock::Clock;
use crate::error::RenderError;
use crate::image::{Image, check_size};
use crate::tiles::{Tile, TileSize};

/// Options for drawing a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RenderOptions {
    /// The size of tiles.
    pub tile_size: TileSize,
    /// The region of the picture that is drawn; `None` is all of it. Its pixels are those of the
    /// whole picture, bit for bit.
    pub region: Option<Tile>,
}

/// The progress of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The number of finished pixels.
    pub done: u64,
    /// The number of all pixels.
    pub total: u64,
}

/// A callback after each tile; `ControlFlow::Break` cancels the frame.
pub type OnProgress<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

/// An [`OnProgress`] that ignores progress and never cancels.
pub fn no_progress(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// A finished frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The picture.
    pub image: Image,
    /// The time that all tiles took together, in milliseconds.
    pub milliseconds: f64,
    /// The clock that measured it.
    pub clock: Clock,
    /// The number of tiles that it was drawn in.
    pub tiles: u32,
    /// The number of loop operands that were evaluated before the rays, if the shader counts them
    /// ([`instrumented_module`](sdfc_codegen::instrumented_module)).
    pub culling_evaluations: u64,
}

/// Returns the values of a program's per-frame nodes, as its shader reads them.
pub fn uniform_values(program: &Program, frame: &FrameValues) -> Vec<[f32; 4]> {
    let values = evaluate_frame(&program.graph, &program.uniforms, frame);
    values.into_iter().map(|lanes| lanes.map(|lane| lane as f32)).collect()
}

/// Returns the region that is drawn of a picture.
///
/// # Errors
///
/// [`RenderError::Size`], [`RenderError::Region`].
pub(crate) fn region_of(picture: [u32; 2], options: &RenderOptions) -> Result<Tile, RenderError> {
    check_size(picture)?;
    let region = options.region.unwrap_or(Tile::whole(picture));
    let is_within = region.is_within(picture);
    if is_within { Ok(region) } else { Err(RenderError::Region { region, picture }) }
}
