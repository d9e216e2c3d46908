//! The values of params at which clauses are sampled.

use sdfc_graph::Param;
use sdfc_graph::eval::FrameValues;

/// The values of the params within their ranges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParamValues {
    /// The defaults of the scene.
    Default,
    /// All params are at the low end of their ranges.
    Low,
    /// All params are at the high end of their ranges.
    High,
}

/// The frames at which the clauses of a scene are tested.
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
