//! Tests of Lipschitz annotations of functions where the scene calls them.

use sdfc_graph::eval::{Evaluator, FrameValues, Tape, evaluate_frame};
use sdfc_graph::{
    Bounds, Dim, Expander, Graph, LipschitzClaim, Node, NodeId, Scene, ShapeId, Stage, reachable,
};

use crate::refute::frames::frames;
use crate::refute::sampling::{Effort, REACH, Random, corners_at, point_of, window};

/// Number of pairs of points, in the bounds of each shape whose formula has the call.
const PAIRS: usize = 2000;
/// Largest number of such shapes that are sampled.
const SHAPES: usize = 4;
/// Relative tolerance, and rounding tolerance, below which an exceeded constant is not reported.
const SLACK: f64 = 1e-6;
const ROUNDING: f64 = 1e-12;

/// Two points between which the result of a function changes by more than its annotation allows.
#[derive(Clone, Debug, PartialEq)]
pub struct LipschitzViolation {
    /// The stated constant.
    pub constant: f64,
    /// The change of the result, divided by the largest change of an argument.
    pub slope: f64,
    /// The first point, in the dimension of the shape whose formula has the call.
    pub from: Vec<f64>,
    /// The second point.
    pub to: Vec<f64>,
    /// The values of the params, and the time.
    pub frame: FrameValues,
}

/// Searches for two points that refute the annotation of a function, of which `value` is the
/// result. It takes about `operations` scalar operations at most. Calls in loops, and in shapes
/// whose arguments depend on a point, are skipped.
pub fn refute_lipschitz(
    scene: &Scene,
    value: NodeId,
    claim: &LipschitzClaim,
    operations: u64,
) -> Option<LipschitzViolation> {
    let graph = &scene.graph;
    if graph.levels(value) != 1 || graph.loops_around(value) > 0 {
        return None;
    }
    let shapes = callers(graph, scene.root, value);
    let dim = graph.shape(*shapes.first()?).dim;
    let nodes = [&[value, claim.lipschitz], &claim.arguments[..]].concat();
    let mut extract = graph.extract(&nodes, &shapes);
    let value = extract.node(value)?;
    let constant = extract.node(claim.lipschitz)?;
    let arguments: Vec<NodeId> =
        claim.arguments.iter().map(|&id| extract.node(id)).collect::<Option<_>>()?;
    let shapes: Vec<ShapeId> =
        shapes.into_iter().map(|id| extract.shape(id)).collect::<Option<_>>()?;
    let graph = &mut extract.graph;
    let tape = call_tape(graph, dim, value, &arguments)?;
    let mut bounds = Bounds::new(&scene.params);
    let corners: Vec<[NodeId; 2]> = shapes.iter().map(|&shape| bounds.of(graph, shape)).collect();
    let frames = frames(graph, &scene.params);
    let effort = Effort(operations / (frames.len() * corners.len()).max(1) as u64);
    frames.into_iter().find_map(|frame| {
        let constant = evaluate_frame(graph, &[constant], &frame).first()?[0];
        corners.iter().find_map(|corners| {
            let axes = dim.point_type().width();
            let window = window(corners_at(graph, *corners, &frame)?, axes, REACH)?;
            let values = tape.prepare(&frame);
            let mut pairs = Pairs { values, random: Random(13), window, axes };
            let count = effort.samples(PAIRS, 1, &tape);
            let (from, to, slope) = pairs.steeper(constant, count)?;
            Some(LipschitzViolation { constant, slope, from, to, frame: frame.clone() })
        })
    })
}

/// The shapes whose formulas contain the node, or what it is computed from: simplification may have
/// merged its last operation with others. If there are none, the root of the scene.
fn callers(graph: &Graph, root: Option<ShapeId>, value: NodeId) -> Vec<ShapeId> {
    let having = |nodes: &[NodeId]| -> Vec<ShapeId> {
        let calls = |&shape: &ShapeId| {
            let shape = graph.shape(shape);
            let formula = reachable(graph, &[shape.formula]);
            shape.level == 0 && nodes.iter().any(|node| formula.binary_search(node).is_ok())
        };
        graph.shape_ids().filter(calls).take(SHAPES).collect()
    };
    let mut callers = having(&[value]);
    if callers.is_empty() {
        let is_specific = |&id: &NodeId| {
            let is_place = matches!(graph.node(id), Node::Point(..) | Node::Swizzle(..));
            graph.stage(id) == Stage::Point && !is_place
        };
        callers = having(&graph.arguments(value).filter(is_specific).collect::<Vec<_>>());
    }
    if callers.is_empty() {
        let is_flat = |node| graph.node(node) == Node::Point(0, Dim::Two);
        callers.extend(root.filter(|_| !reachable(graph, &[value]).into_iter().any(is_flat)));
    }
    callers
}

/// The result and the arguments of the call as a tape.
fn call_tape(graph: &mut Graph, dim: Dim, value: NodeId, arguments: &[NodeId]) -> Option<Tape> {
    let point = point_of(graph, dim);
    let mut expander = Expander::new();
    let mut roots = Vec::with_capacity(arguments.len() + 1);
    for &node in [value].iter().chain(arguments) {
        roots.push(expander.node(graph, node, &[point]).ok()?);
    }
    Tape::new(graph, &roots).ok()
}

/// The function's values at random pairs of points.
struct Pairs<'t> {
    values: Evaluator<'t, f64>,
    random: Random,
    window: [[f64; 3]; 2],
    axes: usize,
}

impl Pairs<'_> {
    /// Two points between which the slope exceeds `constant`, and the slope.
    fn steeper(&mut self, constant: f64, count: usize) -> Option<(Vec<f64>, Vec<f64>, f64)> {
        (0..count).find_map(|pair| {
            let fraction = [1.0, 1e-2, 1e-4][pair % 3];
            let [from, other] = [(); 2].map(|()| self.random.point(self.window, self.axes));
            let to = [0, 1, 2].map(|axis| from[axis] + fraction * (other[axis] - from[axis]));
            let [before, after] = [from, to].map(|point| self.values.eval(point).to_vec());
            let distance = |a: &[f64; 4], b: &[f64; 4]| {
                a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
            };
            let mut changes = before.iter().zip(&after).map(|(a, b)| distance(a, b));
            let rise = changes.next()?;
            let run = changes.fold(0.0, f64::max);
            let size = before.iter().flatten().fold(1.0, |most: f64, lane| most.max(lane.abs()));
            let is_steeper = rise > constant * run * (1.0 + SLACK) + ROUNDING * size;
            let lanes = |point: [f64; 3]| point[..self.axes].to_vec();
            (is_steeper && run > ROUNDING * size).then(|| (lanes(from), lanes(to), rise / run))
        })
    }
}
