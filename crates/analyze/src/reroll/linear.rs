//! Per-frame values as linear functions of a few inputs.
//!
//! Parts that a param moves differ in values such as `3 * gap` and `0.2 + 4 * gap`. The graph has
//! folded some of them: `0 * gap` is 0, and `1 * gap` is `gap`. As linear functions, all of them
//! have the same form, so that lists can hold their factors. The inputs are params and the time, or
//! also other per-frame values.

use rustc_hash::FxHashMap;
use sdfc_graph::{Binary, Const, Graph, Node, NodeId, Stage, Type, Unary};

/// Largest number of inputs of a linear function. Each of them takes a product in each iteration.
pub(super) const MAX_INPUTS: usize = 8;

/// An offset plus the sum of inputs times factors, in each lane of a value.
#[derive(Clone, Debug, Default)]
pub(super) struct Linear {
    pub(super) offset: [f64; 4],
    /// Each input, which is a number, with its factor in each lane.
    pub(super) terms: Vec<(NodeId, [f64; 4])>,
}

impl Linear {
    /// The factors of an input.
    pub(super) fn factors(&self, input: NodeId) -> [f64; 4] {
        let term = self.terms.iter().find(|term| term.0 == input);
        term.map_or([0.0; 4], |term| term.1)
    }

    fn of_constant(constant: Const) -> Self {
        Self { offset: constant.lanes(), terms: Vec::new() }
    }

    /// The sum with `factor` times another function.
    fn plus(mut self, factor: f64, other: &Self) -> Self {
        let add = |to: &mut [f64; 4], lanes: [f64; 4]| {
            to.iter_mut().zip(lanes).for_each(|(lane, other)| *lane += factor * other);
        };
        add(&mut self.offset, other.offset);
        for &(input, factors) in &other.terms {
            match self.terms.iter_mut().find(|term| term.0 == input) {
                Some((_, known)) => add(known, factors),
                None => {
                    let mut own = [0.0; 4];
                    add(&mut own, factors);
                    self.terms.push((input, own));
                }
            }
        }
        self
    }

    /// The function times a constant.
    fn scaled(self, factor: [f64; 4]) -> Self {
        // Lanes beyond the width of a type stay 0, also where the factor is the infinite 1 / 0.
        self.map(|lanes| {
            std::array::from_fn(|at| if lanes[at] == 0.0 { 0.0 } else { factor[at] * lanes[at] })
        })
    }

    /// The function with other lanes.
    fn map(mut self, lanes: impl Fn([f64; 4]) -> [f64; 4]) -> Self {
        self.offset = lanes(self.offset);
        self.terms.iter_mut().for_each(|term| term.1 = lanes(term.1));
        self
    }

    fn is_usable(&self) -> bool {
        let is_finite = |lanes: &[f64; 4]| lanes.iter().all(|lane| lane.is_finite());
        self.terms.len() <= MAX_INPUTS
            && is_finite(&self.offset)
            && self.terms.iter().all(|term| is_finite(&term.1))
    }
}

/// The linear functions of some nodes.
#[derive(Debug, Default)]
pub(super) struct Linears {
    known: FxHashMap<NodeId, Option<Linear>>,
    /// True if only params and the time are inputs.
    pub(super) of_raw_inputs: bool,
}

impl Linears {
    /// A node as a linear function of inputs; `None` if it is none, or depends on the point.
    pub(super) fn of(&mut self, graph: &mut Graph, id: NodeId) -> Option<Linear> {
        if graph.stage(id) >= Stage::Point || graph.ty(id) == Type::Bool {
            return None;
        }
        if let Some(known) = self.known.get(&id) {
            return known.clone();
        }
        let found = stacker::maybe_grow(64 * 1024, 1024 * 1024, || self.derive(graph, id));
        let found = found.or_else(|| self.opaque(graph, id)).filter(Linear::is_usable);
        self.known.insert(id, found.clone());
        found
    }

    /// A value as an input of its own. It must be finite, because the factor of other values is 0.
    fn opaque(&self, graph: &mut Graph, id: NodeId) -> Option<Linear> {
        let is_input = !self.of_raw_inputs && graph.range(id).magnitude().is_finite();
        is_input.then(|| input(graph, id))
    }

    fn derive(&mut self, graph: &mut Graph, id: NodeId) -> Option<Linear> {
        match graph.node(id) {
            Node::Const(constant) => Some(Linear::of_constant(constant)),
            Node::Frame(..) => Some(input(graph, id)),
            Node::Unary(Unary::Neg, a) => Some(Linear::default().plus(-1.0, &self.of(graph, a)?)),
            Node::Binary(Binary::Add, a, b) => {
                Some(self.of(graph, a)?.plus(1.0, &self.of(graph, b)?))
            }
            Node::Binary(Binary::Sub, a, b) => {
                Some(self.of(graph, a)?.plus(-1.0, &self.of(graph, b)?))
            }
            Node::Binary(Binary::Mul, a, b) => {
                let (factor, of) = match (graph.as_const(a), graph.as_const(b)) {
                    (Some(factor), _) => (factor, b),
                    (_, Some(factor)) => (factor, a),
                    (None, None) => return None,
                };
                Some(self.of(graph, of)?.scaled(factor.lanes()))
            }
            Node::Binary(Binary::Div, a, b) => {
                let divisor = graph.as_const(b)?.lanes();
                Some(self.of(graph, a)?.scaled(divisor.map(|lane| 1.0 / lane)))
            }
            Node::Splat(_, a) => Some(self.of(graph, a)?.map(|lanes| [lanes[0]; 4])),
            Node::Swizzle(ty, a, from) => {
                let pick = |lanes: [f64; 4]| {
                    let lane = |at: usize| lanes[usize::from(from[at])];
                    std::array::from_fn(|at| if at < ty.width() { lane(at) } else { 0.0 })
                };
                Some(self.of(graph, a)?.map(pick))
            }
            Node::Compose(..) => {
                let parts: Vec<NodeId> = graph.arguments(id).collect();
                let (mut sum, mut first) = (Linear::default(), 0);
                for part in parts {
                    let width = graph.ty(part).width();
                    let shifted = |lanes: [f64; 4]| {
                        let is_own = |at: &usize| (first..first + width).contains(at);
                        let lane = |at: usize| if is_own(&at) { lanes[at - first] } else { 0.0 };
                        std::array::from_fn(lane)
                    };
                    sum = sum.plus(1.0, &self.of(graph, part)?.map(shifted));
                    first += width;
                }
                Some(sum)
            }
            Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Transform(..)
            | Node::Point(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => None,
        }
    }
}

/// A per-frame value as a function of its own lanes.
fn input(graph: &mut Graph, id: NodeId) -> Linear {
    let width = graph.ty(id).width();
    let term = |lane: usize| {
        let mut factors = [0.0; 4];
        factors[lane] = 1.0;
        let number = if width == 1 { id } else { graph.component(id, lane as u8) };
        (number, factors)
    };
    Linear { offset: [0.0; 4], terms: (0..width).map(term).collect() }
}
