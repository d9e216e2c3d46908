//! Searches for counterexamples to conditions that depend on params and time.
//!
//! A condition that is known at compile time is decided. A per-frame condition is tested at the
//! ends, the middle and the default of every param's range, in up to [`MAX_COMBINATIONS`]
//! combinations, and at some times. A counterexample is a proof and can be shown. Interval
//! arithmetic would reject correct scenes whenever its result is too wide.

use sdfc_graph::eval::{FrameValues, Tape, evaluate_frame};
use sdfc_graph::{FrameInput, Node, NodeId, Param, ParamKind};

use super::elaborator::Elaborator;
use super::report::show_number;

/// The largest number of combinations of values that are tested.
const MAX_COMBINATIONS: usize = 1024;
/// Values for a param without a range, or with an infinite end.
const UNBOUNDED: [f64; 5] = [-1000.0, -1.0, 0.0, 1.0, 1000.0];
/// Values for `time`, in seconds; rounded down for `frame`.
const TIMES: [f64; 8] = [0.0, 0.25, 0.7, 1.6, 3.1, 4.7, 10.3, 1234.5];

/// A counterexample to a condition.
#[derive(Clone, Debug)]
pub(super) struct Refutation {
    frame: FrameValues,
    /// Sentences about the inputs that the condition depends on.
    pub causes: Vec<String>,
}

impl Elaborator<'_> {
    /// A frame at which a condition is false; `None` if none is found.
    pub(super) fn probe(&self, holds: NodeId) -> Option<Refutation> {
        let start = FrameValues::defaults(&self.params);
        if let Some(holds) = self.as_bool(holds) {
            return (!holds).then_some(Refutation { frame: start, causes: Vec::new() });
        }
        let inputs = self.inputs(holds);
        let choices: Vec<Vec<f64>> = inputs.iter().map(|&input| self.candidates(input)).collect();
        let tape = Tape::new(&self.graph, &[holds]).ok()?;
        let combinations = choices.iter().map(Vec::len).fold(1, usize::saturating_mul);
        (0..combinations.min(MAX_COMBINATIONS)).find_map(|combination| {
            // If there are too many combinations, an odd stride still varies every input.
            let mut index = combination.wrapping_mul(combinations.div_ceil(MAX_COMBINATIONS) | 1);
            let mut frame = start.clone();
            for (&input, values) in inputs.iter().zip(&choices) {
                assign(&mut frame, input, values[index % values.len()]);
                index /= values.len();
            }
            let [truth] = tape.prepare(&frame).eval([f64::NAN; 3])[..] else { return None };
            (truth[0] == 0.0).then(|| self.refutation(frame, &inputs))
        })
    }

    fn refutation(&self, frame: FrameValues, inputs: &[FrameInput]) -> Refutation {
        let value = |input| match input {
            FrameInput::Param(index) => frame.params.get(index as usize).map_or(0.0, |v| v[0]),
            FrameInput::Time => frame.time,
            FrameInput::Frame => frame.frame,
        };
        let causes = inputs
            .iter()
            .flat_map(|&input| {
                let (name, value) = (self.input_name(input), value(input));
                let cause = format!("this happens if {name} is {}", show_number(value));
                std::iter::once(cause).chain(self.unstated_range(input, value))
            })
            .collect();
        Refutation { frame, causes }
    }

    /// A sentence about the range of a param that states none, if a value at one of its ends is at
    /// fault.
    fn unstated_range(&self, input: FrameInput, value: f64) -> Option<String> {
        let FrameInput::Param(index) = input else { return None };
        let stated = self.program.params.get(index as usize)?.range.is_some();
        let param = self.params.get(index as usize)?;
        let [lo, hi] = param.range.filter(|range| !stated && range.contains(&value))?;
        let default = param.default[0];
        let nearer = |end: f64| if end == 0.0 { 0.1 * default } else { default };
        let fit = [lo, hi].map(|end| if end == value { nearer(end) } else { end });
        let show = |number: f64| match param.kind {
            ParamKind::Angle => format!("{}deg", show_number(number.to_degrees())),
            _ => show_number(number),
        };
        let ([lo, hi], [low, high]) = ([lo, hi].map(show), fit.map(show));
        let (name, default) = (&param.name, show(default));
        Some(format!(
            "a param without a range goes from {lo} to {hi} here; to state one, write \
             `param {name} = {default} in {low}..{high}`"
        ))
    }

    /// The components of a node at the frame of a counterexample. The node must not depend on a
    /// point.
    pub(super) fn value_at(&self, node: NodeId, found: &Refutation) -> Option<Vec<f64>> {
        let lanes = evaluate_frame(&self.graph, &[node], &found.frame);
        Some(lanes.first()?[..self.graph.ty(node).width()].to_vec())
    }

    fn input_name(&self, input: FrameInput) -> String {
        match input {
            FrameInput::Param(index) => {
                let name = self.params.get(index as usize).map_or("", |param| &param.name);
                format!("`{name}`")
            }
            FrameInput::Time => "`time`".to_owned(),
            FrameInput::Frame => "`frame`".to_owned(),
        }
    }

    /// The per-frame inputs that a node depends on, in order.
    pub(super) fn inputs(&self, root: NodeId) -> Vec<FrameInput> {
        let mut seen = rustc_hash::FxHashSet::default();
        let mut found = Vec::new();
        let mut stack = vec![root];
        while let Some(node) = stack.pop() {
            if !seen.insert(node) {
                continue;
            }
            if let Node::Frame(input, _) = self.graph.node(node) {
                found.push(input);
            }
            stack.extend(self.graph.arguments(node));
        }
        found.sort_unstable();
        found
    }

    fn candidates(&self, input: FrameInput) -> Vec<f64> {
        match input {
            FrameInput::Time => TIMES.to_vec(),
            FrameInput::Frame => TIMES.map(f64::trunc).to_vec(),
            FrameInput::Param(index) => {
                self.params.get(index as usize).map_or(vec![0.0], param_candidates)
            }
        }
    }
}

fn param_candidates(param: &Param) -> Vec<f64> {
    let default = param.default[0];
    match param.kind {
        ParamKind::Bool => vec![0.0, 1.0],
        ParamKind::Choice => (0..param.choices.len().max(1)).map(|i| i as f64).collect(),
        ParamKind::Color => vec![default],
        ParamKind::Number | ParamKind::Int | ParamKind::Angle => {
            let [lo, hi] = param.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            let mut values = vec![default];
            values.extend([lo, hi].into_iter().filter(|end| end.is_finite()));
            if lo.is_finite() && hi.is_finite() {
                let middle = lo + (hi - lo) / 2.0;
                values.push(if param.kind == ParamKind::Int { middle.floor() } else { middle });
            } else {
                values.extend(UNBOUNDED.into_iter().filter(|&v| lo <= v && v <= hi));
            }
            values
        }
    }
}

fn assign(frame: &mut FrameValues, input: FrameInput, value: f64) {
    match input {
        FrameInput::Param(index) => {
            if let Some(lanes) = frame.params.get_mut(index as usize) {
                lanes[0] = value;
            }
        }
        FrameInput::Time => frame.time = value,
        FrameInput::Frame => frame.frame = value,
    }
}
