//! Random graphs, and their evaluation one node at a time.

use proptest::prelude::*;
use sdfc_graph::eval::fold;
use sdfc_graph::{
    Binary, Const, Dim, FrameInput, Graph, Node, NodeId, Stage, Ternary, Type, Unary,
};

/// The settings of a random test: `usual` cases, or with the variable `SDFC_CASES_TIMES` that many
/// times as many.
pub fn cases(usual: u32) -> ProptestConfig {
    let times = std::env::var("SDFC_CASES_TIMES").ok().and_then(|times| times.parse().ok());
    let cases = usual.saturating_mul(times.unwrap_or(1));
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

/// Operations on one argument. `Normalize`, which takes vectors only, is the last.
pub const UNARY: &[Unary] = &[
    Unary::Neg,
    Unary::Abs,
    Unary::Sign,
    Unary::Floor,
    Unary::Ceil,
    Unary::Round,
    Unary::Trunc,
    Unary::Fract,
    Unary::Sqrt,
    Unary::InverseSqrt,
    Unary::Exp,
    Unary::Exp2,
    Unary::Log,
    Unary::Log2,
    Unary::Sin,
    Unary::Cos,
    Unary::Tan,
    Unary::Asin,
    Unary::Acos,
    Unary::Atan,
    Unary::Sinh,
    Unary::Cosh,
    Unary::Tanh,
    Unary::Saturate,
    Unary::Normalize,
];

/// Number of operations in [`UNARY`] that take a number.
const COMPONENTWISE: usize = UNARY.len() - 1;

/// Operations on two numbers or two vectors.
pub const BINARY: &[Binary] = &[
    Binary::Add,
    Binary::Sub,
    Binary::Mul,
    Binary::Div,
    Binary::Rem,
    Binary::Min,
    Binary::Max,
    Binary::Pow,
    Binary::Atan2,
    Binary::Step,
    Binary::Hash,
];

const COMPARISONS: [Binary; 4] = [Binary::Lt, Binary::Le, Binary::Eq, Binary::Ne];

const CONSTANTS: &[f64] = &[
    0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    -2.5,
    3.7,
    1.0 / 3.0,
    1e-3,
    -1e-12,
    1e-160,
    1e3,
    1e9,
    -1e18,
    1.57,
    0.1,
];

/// The only param that random graphs read, by index.
const PARAM: FrameInput = FrameInput::Param(0);

/// The steps that make a random graph: small to print, and shrinking step by step.
pub type Steps = Vec<(u8, u8, [u8; 3])>;

/// Up to `size` steps.
pub fn steps(size: usize) -> impl Strategy<Value = Steps> {
    prop::collection::vec((0_u8..13, any::<u8>(), any::<[u8; 3]>()), 1..size)
}

/// A graph of operations on a point, a param and constants. Tests look at all its nodes.
pub fn graph(steps: &Steps) -> Graph {
    let mut build = Build::new();
    for &(kind, op, picks) in steps {
        build.step(kind, usize::from(op), picks);
    }
    build.graph
}

struct Build {
    graph: Graph,
    scalars: Vec<NodeId>,
    vectors: Vec<NodeId>,
    truths: Vec<NodeId>,
}

impl Build {
    fn new() -> Self {
        let mut graph = Graph::new();
        let p = graph.point(0, Dim::Three);
        let scalars = vec![
            graph.component(p, 0),
            graph.component(p, 1),
            graph.component(p, 2),
            graph.frame_input(PARAM, Type::Scalar),
        ];
        let truth = graph.lt(scalars[0], scalars[1]);
        Self { graph, scalars, vectors: vec![p], truths: vec![truth] }
    }

    fn step(&mut self, kind: u8, op: usize, picks: [u8; 3]) {
        let pick = |list: &[NodeId], i: usize| {
            // Mostly recent nodes, so that expressions grow deep.
            list[list.len() - 1 - usize::from(picks[i]) % list.len()]
        };
        let s = [0, 1, 2].map(|i| pick(&self.scalars, i));
        let v = [0, 1, 2].map(|i| pick(&self.vectors, i));
        let t = [0, 1].map(|i| pick(&self.truths, i));
        let graph = &mut self.graph;
        match kind {
            0 | 1 => self.scalars.push(graph.unary(UNARY[op % COMPONENTWISE], s[0])),
            2 | 3 => self.scalars.push(graph.binary(BINARY[op % BINARY.len()], s[0], s[1])),
            4 => self.scalars.push(graph.number(CONSTANTS[op % CONSTANTS.len()])),
            5 => self.vectors.push(graph.unary(UNARY[op % UNARY.len()], v[0])),
            6 => self.vectors.push(match op % 3 {
                0 => graph.binary(BINARY[op % BINARY.len()], v[0], s[1]),
                1 => graph.binary(BINARY[op % BINARY.len()], v[0], v[1]),
                _ => graph.binary(Binary::Cross, v[0], v[1]),
            }),
            7 => self.scalars.push(match op % 4 {
                0 => graph.length(v[0]),
                1 => graph.dot(v[0], v[1]),
                2 => graph.dot(v[0], v[0]),
                _ => graph.component(v[0], picks[1] % 3),
            }),
            8 => self.vectors.push(match op % 3 {
                0 => graph.compose(&s),
                1 => graph.swizzle(v[0], &picks.map(|pick| pick % 3)),
                _ => graph.transform(v, v[0]),
            }),
            9 => {
                let op = [Ternary::Mix, Ternary::Clamp, Ternary::Smoothstep][op % 3];
                self.scalars.push(graph.ternary(op, s[0], s[1], s[2]));
            }
            10 => self.truths.push(match op % 7 {
                0 => graph.binary(Binary::And, t[0], t[1]),
                1 => graph.binary(Binary::Or, t[0], t[1]),
                2 => graph.unary(Unary::Not, t[0]),
                _ => graph.binary(COMPARISONS[op % COMPARISONS.len()], s[0], s[1]),
            }),
            11 => {
                // A product for which intervals have a rule of their own: c x (1 - x).
                let one = graph.number(1.0);
                let (rest, scaled) = (graph.sub(one, s[0]), graph.mul(s[0], s[1]));
                self.scalars.push(graph.mul(scaled, rest));
            }
            _ => match op % 2 {
                0 => self.scalars.push(graph.select(t[0], s[0], s[1])),
                _ => self.vectors.push(graph.select(t[0], v[0], v[1])),
            },
        }
    }
}

/// The value of each node, computed one node at a time; `None` where it, or a value that it depends
/// on, is not finite.
#[allow(dead_code, reason = "not all tests that share this compare with tapes")]
pub fn each_node(graph: &Graph, point: [f64; 3], param: f64) -> Vec<Option<Const>> {
    each_node_reading(graph, point, param, |_, value| value)
}

/// Like [`each_node`], for a shader in real arithmetic: it reads per-frame values as f32.
#[allow(dead_code, reason = "not all tests that share this compare with shaders")]
pub fn each_node_in_shader(graph: &Graph, point: [f64; 3], param: f64) -> Vec<Option<Const>> {
    each_node_reading(graph, point, param, |[reader, read], value| {
        if graph.stage(reader) < Stage::Point || graph.stage(read) == Stage::Point {
            return value;
        }
        let lanes: Vec<f64> = value.lanes().iter().map(|&lane| f64::from(lane as f32)).collect();
        Const::new(value.ty(), &lanes)
    })
}

/// Like [`each_node`], where `as_read` gives the value of an argument as a node reads it.
fn each_node_reading(
    graph: &Graph,
    point: [f64; 3],
    param: f64,
    as_read: impl Fn([NodeId; 2], Const) -> Const,
) -> Vec<Option<Const>> {
    let mut values: Vec<Option<Const>> = Vec::new();
    for id in graph.ids() {
        let node = graph.node(id);
        let input = if matches!(node, Node::Point(..)) {
            Some(Const::new(Type::Vec3, &point))
        } else if let Node::Frame(_, ty) = node {
            Some(Const::new(ty, &[param]))
        } else {
            None
        };
        let read =
            |argument: NodeId| values[argument.index()].map(|value| as_read([id, argument], value));
        let arguments: Option<Vec<Const>> = graph.arguments(id).map(read).collect();
        let value = input.or_else(|| fold(&node, &arguments?));
        values.push(value);
    }
    values
}
