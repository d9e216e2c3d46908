//! The values of params at which clauses are sampled.

use sdfc_graph::eval::FrameValues;
use sdfc_graph::{Dim, Param};

/// Where the params stand in their ranges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParamValues {
    /// As in the scene.
    Default,
    /// All at the low end.
    Low,
    /// All at the high end.
    High,
}

/// The frames at which a scene's clauses are tried.
pub(super) fn frames(params: &[Param]) -> Vec<(ParamValues, FrameValues)> {
    let at = |end: usize| {
        let mut frame = FrameValues::defaults(params);
        for (value, param) in frame.params.iter_mut().zip(params) {
            if let Some(range) = param.range.filter(|range| range[end].is_finite()) {
                value[0] = range[end];
            }
        }
        frame
    };
    let mut frames = vec![(ParamValues::Default, FrameValues::defaults(params))];
    if params.iter().any(|param| param.range.is_some()) {
        frames.extend([(ParamValues::Low, at(0)), (ParamValues::High, at(1))]);
    }
    frames
}

/// How many coordinates a point of the dimension has.
pub(super) fn axes(dim: Dim) -> usize {
    dim.point_type().width()
}
