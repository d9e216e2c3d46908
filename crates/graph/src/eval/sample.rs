//! Evaluating nodes and scenes in f64.

use super::dual::Dual;
use super::frame::FrameValues;
use super::interval::Interval;
use super::tape::{Tape, TapeError};
use crate::graph::Graph;
use crate::node::NodeId;
use crate::program::Program;

/// The values of nodes of stage `Const` or `Frame`, in their order. Lanes beyond a node's width are
/// 0. A node that needs more than a frame's values gives NaN.
pub fn evaluate_frame(graph: &Graph, nodes: &[NodeId], frame: &FrameValues) -> Vec<[f64; 4]> {
    let nowhere = [f64::NAN; 3];
    match Tape::new(graph, nodes) {
        Ok(tape) => tape.prepare(frame).eval(nowhere).to_vec(),
        Err(_) => vec![[f64::NAN; 4]; nodes.len()],
    }
}

/// Distance and gradient of a field at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldSample {
    /// Signed distance.
    pub distance: f64,
    /// Its gradient, by forward-mode differentiation.
    pub gradient: [f64; 3],
}

/// Distance and gradient of a scene at points, in f64. The gradient comes from differentiating the
/// distance itself, independent of [`Program::gradient`], which it can be checked against. Empty if
/// the scene draws nothing.
///
/// Fails if the program is not flat.
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

impl Tape {
    /// Bounds of the partial derivatives of the first lane of the first root in a box, for one
    /// frame. They contain the derivatives of both sides of a kink. `None` if a derivative has no
    /// bounds, or if the value may jump.
    ///
    /// ```
    /// use sdfc_graph::eval::{FrameValues, Interval, Tape};
    /// use sdfc_graph::{Dim, Graph};
    ///
    /// let mut graph = Graph::new();
    /// let point = graph.point(0, Dim::Three);
    /// let (x, y) = (graph.component(point, 0), graph.component(point, 1));
    /// let (square, height) = (graph.mul(x, x), graph.abs(y));
    /// let root = graph.add(square, height);
    /// let tape = Tape::new(&graph, &[root])?;
    ///
    /// let [x, y] = [Interval::new(1.0, 3.0), Interval::new(-1.0, 1.0)];
    /// let bounds = tape.gradient_over(&FrameValues::default(), [x, y, y]);
    /// let [by_x, by_y, by_z] = bounds.expect("it is smooth, but for a kink");
    /// assert!(by_x.lo() > 1.99 && by_x.hi() < 6.01);
    /// assert!(by_y.lo() < -0.99 && by_y.hi() > 0.99 && by_y.hi() < 1.01);
    /// assert!(by_z.contains(0.0) && by_z.hi() < 0.01);
    /// # Ok::<(), sdfc_graph::eval::TapeError>(())
    /// ```
    pub fn gradient_over(
        &self,
        frame: &FrameValues,
        region: [Interval; 3],
    ) -> Option<[Interval; 3]> {
        let Dual { partials, .. } = self.prepare(frame).scalar(Dual::point(region));
        let is_bounded = |partial: &Interval| partial.lo().is_finite() && partial.hi().is_finite();
        partials.iter().all(is_bounded).then_some(partials)
    }
}

impl FrameValues<Interval> {
    /// The values that the first lane of a node can have at any point.
    pub fn range(&self, graph: &Graph, node: NodeId) -> Interval {
        let tape = Tape::new(graph, &[node]);
        tape.map_or(Interval::ENTIRE, |tape| tape.prepare_in(self).scalar([Interval::ENTIRE; 3]))
    }
}
