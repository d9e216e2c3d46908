//! Evaluation of flat math: in f32 (the shader's twin), f64, intervals and dual numbers.
//!
//! [`Number`] names the scalar operations of the closed set, each domain implements them. Nodes become
//! scalar operations in one place for all domains: a [`Tape`] records them once and then runs in any domain;
//! [`fold`] computes them at once.
//!
//! ```
//! use sdfc_graph::eval::{Dual, FrameValues, Interval, Packet, Tape};
//! use sdfc_graph::{Dim, Graph};
//!
//! let mut graph = Graph::new();
//! let p = graph.point(0, Dim::Three);
//! let (radius, length) = (graph.number(0.5), graph.length(p));
//! let sphere = graph.sub(length, radius);
//!
//! let tape = Tape::new(&graph, &[sphere])?;
//! let frame = FrameValues::default();
//!
//! assert_eq!(tape.prepare::<f64>(&frame).scalar([0.0, 3.0, 4.0]), 4.5);
//! assert_eq!(tape.prepare::<f32>(&frame).scalar([0.0, 0.0, 0.0]), -0.5);
//!
//! let slope = tape.prepare::<Dual>(&frame).scalar(Dual::point([0.0, 0.0, 2.0]));
//! assert_eq!(slope.partials, [0.0, 0.0, 1.0]);
//!
//! // Over a box, the distance is from that of its nearest point to that of its farthest.
//! let side = Interval::new(1.0, 3.0);
//! let region = [side, Interval::new(0.0, 4.0), Interval::new(0.0, 0.0)];
//! let over = tape.prepare::<Interval>(&frame).scalar(region);
//! assert!(over.contains(0.5) && over.contains(4.5) && over.lo() > 0.499 && over.hi() < 4.501);
//!
//! let mut pair = tape.prepare::<Packet<f32, 2>>(&frame);
//! let [x, y, z] = [Packet([0.0, 2.0]), Packet([1.0, 0.0]), Packet([0.0, 0.0])];
//! assert_eq!(pair.scalar([x, y, z]), Packet([0.5, 1.5]));
//! # Ok::<(), sdfc_graph::eval::TapeError>(())
//! ```

pub(crate) mod direct;
mod dual;
mod float;
mod fold;
mod hash;
mod interval;
mod number;
mod op;
mod packet;
mod record;
mod scalarise;
mod tape;
mod watch;

pub use dual::Dual;
pub use fold::fold;
pub(crate) use fold::fold_where;
pub use hash::{HASHES, hash};
pub use interval::{Interval, Path};
pub use number::Number;
pub use packet::Packet;
pub use tape::{Evaluator, Tape, TapeError};

use crate::{FrameInput, Graph, NodeId, Param, Program};

/// Values of the per-frame inputs, in any domain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameValues<N = f64> {
    /// Of the scene's params, in their order; lanes beyond a param's type are ignored.
    pub params: Vec<[N; 4]>,
    /// Seconds.
    pub time: N,
    /// Whole number of the frame.
    pub frame: N,
}

impl FrameValues {
    /// The params' defaults, at time 0 and frame 0.
    pub fn defaults(params: &[Param]) -> Self {
        let params = params.iter().map(|param| param.default).collect();
        Self { params, time: 0.0, frame: 0.0 }
    }
}

impl<N: Number> FrameValues<N> {
    /// One lane of an input; of a param that is not there, 0.
    pub(crate) fn lane(&self, input: FrameInput, lane: usize) -> N {
        let param = |index: u32| self.params.get(index as usize).map(|lanes| lanes[lane]);
        match input {
            FrameInput::Param(index) => param(index).unwrap_or(N::constant(0.0)),
            FrameInput::Time => self.time,
            FrameInput::Frame => self.frame,
        }
    }
}

/// The values of nodes of stage `Const` or `Frame`, in their order; lanes beyond a node's width are
/// 0. A node that needs more than a frame's values gives NaN.
pub fn evaluate_frame(graph: &Graph, nodes: &[NodeId], frame: &FrameValues) -> Vec<[f64; 4]> {
    let nowhere = [f64::NAN; 3];
    match Tape::new(graph, nodes) {
        Ok(tape) => tape.prepare(frame).eval(nowhere).to_vec(),
        Err(_) => vec![[f64::NAN; 4]; nodes.len()],
    }
}

/// A field at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldSample {
    /// Signed distance.
    pub distance: f64,
    /// Its gradient, by forward-mode derivative.
    pub gradient: [f64; 3],
}

/// Distance and gradient of a scene at points, in f64. The gradient is derived from the distance itself,
/// apart from [`Program::gradient`], which it can be checked against. Empty if the scene draws nothing.
///
/// # Errors
/// Where the program is not flat.
pub fn sample_field(
    program: &Program,
    frame: &FrameValues,
    points: &[[f64; 3]],
) -> Result<Vec<FieldSample>, TapeError> {
    let Some(distance) = program.distance else { return Ok(Vec::new()) };
    let tape = Tape::new(&program.graph, &[distance])?;
    let mut field = tape.prepare::<Dual>(frame);
    let sample = |&point: &[f64; 3]| {
        let Dual { value, partials } = field.scalar(Dual::point(point));
        FieldSample { distance: value, gradient: partials }
    };
    Ok(points.iter().map(sample).collect())
}
