//! What a function states of its result, held against its values where the scene calls it.

use sdfc_graph::eval::{Evaluator, FrameValues, Tape, evaluate_frame};
use sdfc_graph::{
    Bounds, Dim, Expander, Graph, LipschitzClaim, Node, NodeId, Scene, ShapeId, reachable,
};

use crate::refute::frames::{ParamValues, axes, frames};
use crate::refute::probe::Random;

/// Pairs of points, in the bounds of each shape whose formula has the call.
const PAIRS: usize = 2000;
/// Most such shapes that are looked at.
const SHAPES: usize = 4;
/// How far an axis without bounds is looked at.
const REACH: f64 = 2.0;
/// A constant that is exceeded by less is not told, in parts of itself and of what rounding may make of the result.
const SLACK: f64 = 1e-6;
const ROUNDING: f64 = 1e-12;

/// Two points between which a function's result changes by more than it states.
#[derive(Clone, Debug, PartialEq)]
pub struct LipschitzViolation {
    /// As stated.
    pub constant: f64,
    /// The change of the result, divided by the largest of an argument.
    pub slope: f64,
    /// One point, in the dimension of the shape that calls it.
    pub from: Vec<f64>,
    /// The other.
    pub to: Vec<f64>,
    /// Where the params stand.
    pub params: ParamValues,
}

/// Looks for two points that refute what is stated of a function's result, a node. Calls within loops and within what is built anew at
/// each point are passed over.
pub fn refute_lipschitz(
    scene: &Scene,
    value: NodeId,
    claim: &LipschitzClaim,
) -> Option<LipschitzViolation> {
    let graph = &mut scene.graph.clone();
    if graph.levels(value) != 1 || graph.loops_around(value) > 0 {
        return None;
    }
    let shapes = callers(graph, scene.root, value);
    let dim = graph.shape(*shapes.first()?).dim;
    let tape = asked(graph, dim, value, &claim.arguments)?;
    let mut bounds = Bounds::new(&scene.params);
    let corners: Vec<[NodeId; 2]> = shapes.iter().map(|&shape| bounds.of(graph, shape)).collect();
    frames(&scene.params).into_iter().find_map(|(params, frame)| {
        let constant = evaluate_frame(graph, &[claim.lipschitz], &frame).first()?[0];
        corners.iter().find_map(|corners| {
            let ends = evaluate_frame(graph, corners, &frame);
            let window = [ends.first()?, ends.get(1)?].map(|end| [end[0], end[1], end[2]]);
            let mut pairs = Pairs::new(&tape, &frame, window, axes(dim));
            let (from, to, slope) = pairs.steeper(constant)?;
            Some(LipschitzViolation { constant, slope, from, to, params })
        })
    })
}

/// Shapes whose formulas compute the node; if simplification has left it in none, the scene.
fn callers(graph: &Graph, root: Option<ShapeId>, value: NodeId) -> Vec<ShapeId> {
    let calls = |&shape: &ShapeId| {
        let shape = graph.shape(shape);
        shape.level == 0 && reachable(graph, &[shape.formula]).contains(&value)
    };
    let mut callers: Vec<ShapeId> = graph.shape_ids().filter(calls).take(SHAPES).collect();
    if callers.is_empty() {
        let is_flat = |node| graph.node(node) == Node::Point(0, Dim::Two);
        callers.extend(root.filter(|_| !reachable(graph, &[value]).into_iter().any(is_flat)));
    }
    callers
}

/// The result and the arguments.
fn asked(graph: &mut Graph, dim: Dim, value: NodeId, arguments: &[NodeId]) -> Option<Tape> {
    let space = graph.point(0, Dim::Three);
    let point = match dim {
        Dim::Two => graph.swizzle(space, &[0, 1]),
        Dim::Three => space,
    };
    let mut expander = Expander::new();
    let mut roots = Vec::with_capacity(arguments.len() + 1);
    for &node in [value].iter().chain(arguments) {
        roots.push(expander.node(graph, node, &[point]).ok()?);
    }
    Tape::new(graph, &roots).ok()
}

struct Pairs<'t> {
    values: Evaluator<'t, f64>,
    random: Random,
    window: [[f64; 3]; 2],
    axes: usize,
}

impl<'t> Pairs<'t> {
    fn new(tape: &'t Tape, frame: &FrameValues, bounds: [[f64; 3]; 2], axes: usize) -> Self {
        let mut window = [[0.0; 3]; 2];
        for axis in 0..axes {
            let [lo, hi] = [bounds[0][axis], bounds[1][axis]];
            let lo = if lo.is_finite() { lo } else { hi.min(REACH) - 2.0 * REACH };
            let hi = if hi.is_finite() { hi } else { lo + 2.0 * REACH };
            (window[0][axis], window[1][axis]) = (lo, hi);
        }
        Self { values: tape.prepare(frame), random: Random(13), window, axes }
    }

    fn steeper(&mut self, constant: f64) -> Option<(Vec<f64>, Vec<f64>, f64)> {
        (0..PAIRS).find_map(|round| {
            let share = [1.0, 1e-2, 1e-4][round % 3];
            let (from, other) = (self.point(), self.point());
            let to = [0, 1, 2].map(|axis| from[axis] + share * (other[axis] - from[axis]));
            let [before, after] = [from, to].map(|point| self.values.eval(point).to_vec());
            let way = |a: &[f64; 4], b: &[f64; 4]| {
                a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
            };
            let mut changes = before.iter().zip(&after).map(|(a, b)| way(a, b));
            let rise = changes.next()?;
            let run = changes.fold(0.0, f64::max);
            let size = before.iter().flatten().fold(1.0, |most: f64, lane| most.max(lane.abs()));
            let is_steeper = rise > constant * run * (1.0 + SLACK) + ROUNDING * size;
            let lanes = |point: [f64; 3]| point[..self.axes].to_vec();
            (is_steeper && run > ROUNDING * size).then(|| (lanes(from), lanes(to), rise / run))
        })
    }

    /// A point of the window.
    fn point(&mut self) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let (lo, hi) = (self.window[0][axis], self.window[1][axis]);
            lo + (hi - lo) * self.random.next()
        })
    }
}
