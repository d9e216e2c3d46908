//! The values of params and the times at which clauses are sampled.

use sdfc_graph::eval::FrameValues;
use sdfc_graph::{FrameInput, Graph, Node, Param, ParamKind};

/// Combinations of values within the ranges, beside the defaults, all low and all high ends.
const MIXED: usize = 8;
/// Times in seconds, beside 0. None is a simple fraction of a turn or of a second.
const TIMES: [f64; 3] = [0.73, 1.87, 4.31];
/// A step of a sequence that fills 0..1 evenly (the golden ratio).
const STEP: f64 = 0.618_033_988_749_895;

/// The frames at which the clauses of a scene are tested; the first one has the defaults.
pub(super) fn frames(graph: &Graph, params: &[Param]) -> Vec<FrameValues> {
    let at = |fraction: &dyn Fn(usize) -> f64| {
        let mut frame = FrameValues::defaults(params);
        for (index, (value, param)) in frame.params.iter_mut().zip(params).enumerate() {
            let finite = |[lo, hi]: &[f64; 2]| lo.is_finite() && hi.is_finite();
            if let Some([lo, hi]) = param.range.filter(finite) {
                let exact = lo + fraction(index) * (hi - lo);
                value[0] = if param.kind == ParamKind::Int { exact.round() } else { exact };
            }
        }
        frame
    };
    let mut frames = vec![FrameValues::defaults(params)];
    if params.iter().any(|param| param.range.is_some()) {
        frames.extend([at(&|_| 0.0), at(&|_| 1.0)]);
        let mixed = |nth: usize| move |index: usize| (STEP * (nth * 7 + index + 1) as f64).fract();
        frames.extend((0..MIXED).map(|nth| at(&mixed(nth))));
    }
    if depends_on_time(graph) {
        frames.extend(TIMES.map(|time| FrameValues { time, ..FrameValues::defaults(params) }));
    }
    frames
}

fn depends_on_time(graph: &Graph) -> bool {
    graph.ids().any(|id| matches!(graph.node(id), Node::Frame(FrameInput::Time, _)))
}
