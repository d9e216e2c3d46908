//! What the renderers have in common: options in, progress out, a frame as the result.

use std::ops::ControlFlow;

use sdfc_graph::{
    Program,
    eval::{FrameValues, evaluate_frame},
};

use crate::clock::Clock;
use crate::image::Image;
use crate::tiles::TileSize;

/// How a frame is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RenderOptions {
    /// How large tiles are.
    pub tile_size: TileSize,
}

/// How far a frame is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Pixels finished.
    pub done: u64,
    /// Pixels in all.
    pub total: u64,
}

/// Called after each tile; `ControlFlow::Break` cancels the frame.
pub type OnProgress<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

/// An [`OnProgress`] that never cancels.
pub fn no_progress(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// A finished frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The picture.
    pub image: Image,
    /// How long the tiles took, in milliseconds, added up.
    pub milliseconds: f64,
    /// What measured that.
    pub clock: Clock,
    /// How many tiles it was drawn in.
    pub tiles: u32,
    /// How many operands of loops were evaluated before the rays, by a shader that counts them
    /// ([`instrumented_module`](sdfc_codegen::instrumented_module)).
    pub culling_evaluations: u64,
}

/// The values of a program's per-frame nodes, as its shader reads them.
pub fn uniform_values(program: &Program, frame: &FrameValues) -> Vec<[f32; 4]> {
    let values = evaluate_frame(&program.graph, &program.uniforms, frame);
    values.into_iter().map(|lanes| lanes.map(|lane| lane as f32)).collect()
}
