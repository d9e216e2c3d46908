//! Values of the per-frame inputs.

use super::interval::Interval;
use super::number::Number;
use crate::node::FrameInput;
use crate::scene::{Param, ParamKind};

/// Values of the per-frame inputs, in any number type.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameValues<N = f64> {
    /// Values of the scene's params, in their order. Lanes beyond a param's type are ignored.
    pub params: Vec<[N; 4]>,
    /// Seconds.
    pub time: N,
    /// Number of the frame, a whole number.
    pub frame: N,
}

impl FrameValues {
    /// The defaults of the params, time 0 and frame 0.
    pub fn defaults(params: &[Param]) -> Self {
        let params = params.iter().map(|param| param.fixed.unwrap_or(param.default)).collect();
        Self { params, time: 0.0, frame: 0.0 }
    }
}

impl<N: Number> FrameValues<N> {
    /// One lane of an input; 0 for a param that is missing.
    pub(crate) fn lane(&self, input: FrameInput, lane: usize) -> N {
        let param = |index: u32| self.params.get(index as usize).map(|lanes| lanes[lane]);
        match input {
            FrameInput::Param(index) => param(index).unwrap_or(N::constant(0.0)),
            FrameInput::Time => self.time,
            FrameInput::Frame => self.frame,
        }
    }
}

impl FrameValues<Interval> {
    /// All values that per-frame inputs can have: params lie in their ranges. A number without a
    /// range can be any.
    pub fn ranges(params: &[Param]) -> Self {
        Self {
            params: params.iter().map(|param| [range_of(param); 4]).collect(),
            time: Interval::ENTIRE,
            frame: Interval::ENTIRE,
        }
    }
}

/// The values that a param can take.
fn range_of(param: &Param) -> Interval {
    match (param.range, param.kind) {
        (Some([lo, hi]), _) => Interval::new(lo, hi),
        (None, ParamKind::Bool | ParamKind::Color) => Interval::new(0.0, 1.0),
        (None, ParamKind::Choice) => {
            Interval::new(0.0, param.choices.len().saturating_sub(1) as f64)
        }
        (None, ParamKind::Number | ParamKind::Int | ParamKind::Angle) => Interval::ENTIRE,
    }
}
