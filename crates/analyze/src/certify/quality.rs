//! The promises of each shape's field outside and inside, and its Lipschitz constant.
//!
//! The two facts are independent: `|f| <= distance` lets a ray step by `f`, and "L-Lipschitz"
//! limits how fast `f` changes. `exact` implies both, and a constant of at most 1 implies `bound`
//! on both sides.

use rustc_hash::FxHashMap;
use sdfc_graph::eval::{FrameValues, Interval};
use sdfc_graph::{Binary, Contract, Graph, Node, NodeId, Param, ShapeId, Stage, Ternary, Unary};

use crate::certify::affine::is_fixed;
use crate::certify::lipschitz::Slopes;
use crate::certify::local_slope::{SCENE_OPERATIONS, steepest_within};
use crate::certify::maps::Maps;
use crate::certify::promise::{Promise, Sides, stated_sides};
use crate::certify::reason::{Constant, Reason};
use crate::shapes::shapes_below;

/// The promises and the Lipschitz constant of one shape.
#[derive(Clone, Debug)]
pub struct Quality {
    /// The promises on both sides of the surface.
    pub sides: Sides,
    /// The Lipschitz constant: a node that does not depend on the point.
    pub lipschitz: Constant,
    /// True if the constant holds at every point, false if only within the shape's bounds.
    pub everywhere: bool,
    /// The bounds for which interval derivatives gave the constant, if no rule and no clause gives
    /// one.
    pub local_bounds: Option<[NodeId; 2]>,
}

/// The statements of a shape's clauses, given the promises that its children keep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stated {
    /// The promises, if all children keep the same ones.
    pub sides: Sides,
    /// The constant times the largest constant of a child, if those hold everywhere.
    pub lipschitz: Option<NodeId>,
    /// True if it states bounds.
    pub bounds: bool,
}

impl Stated {
    pub(crate) fn is_empty(&self) -> bool {
        self.sides == Sides::NONE && self.lipschitz.is_none() && !self.bounds
    }
}

/// The qualities of the shapes of a scene.
#[derive(Clone, Debug)]
pub struct Qualities {
    of: FxHashMap<ShapeId, Quality>,
    params: Vec<Param>,
    ranges: FrameValues<Interval>,
    /// The operations that searches for constants may still take.
    budget: usize,
}

impl Qualities {
    /// Derives the qualities of `root` and of every shape below it, for all values of the params.
    pub fn of_scene(graph: &mut Graph, root: ShapeId, params: &[Param]) -> Self {
        let ranges = FrameValues::ranges(params);
        let (of, params) = (FxHashMap::default(), params.to_vec());
        let mut qualities = Self { of, params, ranges, budget: SCENE_OPERATIONS };
        for shape in shapes_below(graph, root) {
            let quality = qualities.derive(graph, shape);
            qualities.of.insert(shape, quality);
        }
        qualities
    }

    /// The interval of all values of a scalar that does not depend on the point.
    pub(crate) fn range(&self, graph: &Graph, node: NodeId) -> Interval {
        graph
            .as_number(node)
            .map_or_else(|| self.ranges.range(graph, node), |number| Interval::new(number, number))
    }

    /// The quality of a shape of the scene.
    pub fn get(&self, shape: ShapeId) -> Option<&Quality> {
        self.of.get(&shape)
    }

    /// The constant of a shape of the scene; an error for other shapes.
    pub(crate) fn constant(&self, graph: &Graph, shape: ShapeId) -> Constant {
        let missing = || Err(Reason::Child(graph.shape(shape).definition.clone()));
        self.get(shape).map_or_else(missing, |quality| quality.lipschitz.clone())
    }

    /// The constants of all nodes of a shape's formula.
    pub(crate) fn slopes(&self, graph: &mut Graph, shape: ShapeId) -> Slopes {
        let (formula, level) = (graph.shape(shape).formula, graph.shape(shape).level);
        let known: FxHashMap<ShapeId, Constant> = graph
            .shape(shape)
            .children
            .iter()
            .map(|&child| (child, self.child_constant(graph, child)))
            .collect();
        let lookup = |child: ShapeId| {
            known.get(&child).cloned().unwrap_or(Err(Reason::Child(String::new())))
        };
        Slopes::of(graph, &[formula], level, &lookup)
    }

    /// The constant of a child; its error carries the name of the child.
    fn child_constant(&self, graph: &Graph, child: ShapeId) -> Constant {
        self.constant(graph, child)
            .map_err(|_| Reason::Child(graph.shape(child).definition.clone()))
    }

    /// The statements of the clauses of a shape of the scene.
    pub(crate) fn stated(&self, graph: &mut Graph, shape: ShapeId) -> Stated {
        let contract = graph.shape(shape).contract;
        let children = graph.shape(shape).children.clone();
        let everywhere =
            children.iter().all(|child| self.get(*child).is_some_and(|q| q.everywhere));
        let lipschitz = contract
            .lipschitz
            .filter(|_| everywhere)
            .and_then(|constant| self.times_children(graph, constant, &children).ok());
        let sides = self.stated_sides(graph, &contract, &children);
        Stated { sides, lipschitz, bounds: contract.bounds.is_some() }
    }

    /// The promises of the clauses for the two sides, given the promises of the children.
    fn stated_sides(&self, graph: &Graph, contract: &Contract, children: &[ShapeId]) -> Sides {
        let all_at_least = |promise: Promise| {
            children.iter().all(|child| {
                self.get(*child)
                    .is_some_and(|q| q.sides.weaker(Sides::both(promise)) == Sides::both(promise))
            })
        };
        let (exact, bound) = (all_at_least(Promise::Exact), all_at_least(Promise::Bound));
        stated_sides(graph, contract, exact, bound)
    }

    fn derive(&mut self, graph: &mut Graph, shape: ShapeId) -> Quality {
        let contract = graph.shape(shape).contract;
        let children = graph.shape(shape).children.clone();
        let stated = self.stated_sides(graph, &contract, &children);
        if stated.is_exact() {
            return Quality {
                sides: stated,
                lipschitz: Ok(graph.number(1.0)),
                everywhere: true,
                local_bounds: None,
            };
        }
        let formula = graph.shape(shape).formula;
        let mut slopes = self.slopes(graph, shape);
        let derived = slopes.constant(formula);
        let children_everywhere =
            children.iter().all(|child| self.get(*child).is_some_and(|q| q.everywhere));
        let outside = stated.outside;
        let (lipschitz, everywhere) = match contract.lipschitz {
            Some(constant) => {
                let stated =
                    self.times_children(graph, constant, &children).and_then(|node| {
                        match (graph.is_finite(node), contract.is_local, contract.bounds) {
                            (false, ..) => Err(Reason::Infinite),
                            (true, true, None) => Err(Reason::NoBounds),
                            (true, ..) => Ok(node),
                        }
                    });
                let confirmed = at_most(graph, &derived, &stated);
                // Beyond the bounds lies only the outside, and an exact distance has the constant
                // 1.
                let one =
                    stated.as_ref().is_ok_and(|&l| graph.as_number(l).is_some_and(|l| l >= 1.0));
                let exact_beyond = outside == Promise::Exact && one;
                let is_stated =
                    contract.everywhere || contract.is_extended || contract.bounds.is_none();
                (stated, children_everywhere && (confirmed || exact_beyond || is_stated))
            }
            None => (derived, children_everywhere),
        };
        let lipschitz = independent_of_point(graph, shape, lipschitz);
        let (lipschitz, everywhere, local_bounds) = match lipschitz {
            Err(Reason::Unbounded(what)) if contract.lipschitz.is_none() => {
                self.within_bounds(graph, shape, what)
            }
            known => (known, everywhere, None),
        };
        let mut sides = stated.stronger(self.structural(graph, &mut slopes, shape));
        if lipschitz.as_ref().is_ok_and(|&l| graph.as_number(l).is_some_and(|l| l <= 1.0)) {
            sides = sides.stronger(Sides::both(Promise::Bound));
        }
        Quality { sides, lipschitz, everywhere, local_bounds }
    }

    /// A constant by interval derivatives. Returns the constant, `false` since it does not hold
    /// everywhere, and the bounds within which it holds.
    fn within_bounds(
        &mut self,
        graph: &mut Graph,
        shape: ShapeId,
        what: &'static str,
    ) -> (Constant, bool, Option<[NodeId; 2]>) {
        let bounds = match graph.shape(shape).contract.bounds {
            Some(bounds) => bounds,
            None => sdfc_graph::bounds(graph, shape, &self.params),
        };
        match steepest_within(graph, shape, bounds, &self.params, &mut self.budget) {
            Some(slope) if slope.is_uniform() => {
                (Ok(graph.number(slope.largest)), false, Some(bounds))
            }
            Some(_) => (Err(Reason::SteepInPlaces(what)), false, None),
            None => (Err(Reason::Unbounded(what)), false, None),
        }
    }

    /// A stated constant holds for 1-Lipschitz children. For others it is multiplied by the largest
    /// constant of a child, if that exceeds 1.
    fn times_children(
        &self,
        graph: &mut Graph,
        constant: NodeId,
        children: &[ShapeId],
    ) -> Constant {
        let mut largest = graph.number(1.0);
        for &child in children {
            let inner = self.child_constant(graph, child)?;
            largest = graph.max(largest, inner);
        }
        Ok(graph.mul(constant, largest))
    }

    /// The promises that follow from the form of a formula.
    fn structural(&self, graph: &mut Graph, slopes: &mut Slopes, shape: ShapeId) -> Sides {
        let formula = graph.shape(shape).formula;
        let mut sides: FxHashMap<NodeId, Sides> = FxHashMap::default();
        for &node in &slopes.nodes {
            let value = self.structural_node(graph, node, &mut slopes.maps, &sides);
            if value != Sides::NONE {
                sides.insert(node, value);
            }
        }
        sides.get(&formula).copied().unwrap_or(Sides::NONE)
    }

    fn structural_node(
        &self,
        graph: &mut Graph,
        node: NodeId,
        maps: &mut Maps,
        sides: &FxHashMap<NodeId, Sides>,
    ) -> Sides {
        let of = |id: NodeId| sides.get(&id).copied().unwrap_or(Sides::NONE);
        match graph.node(node) {
            // A field that is sampled through an isometry keeps its promises.
            Node::Sample(child, q)
                if is_fixed_shape(graph, child, maps.level()) && maps.is_isometry(graph, q) =>
            {
                self.get(child).map_or(Sides::NONE, |quality| quality.sides)
            }
            Node::Binary(Binary::Min, a, b) if graph.ty(node).width() == 1 => {
                let both = of(a).weaker(of(b));
                Sides { outside: both.outside, inside: both.inside.min(Promise::Bound) }
            }
            Node::Binary(Binary::Max, a, b) if graph.ty(node).width() == 1 => {
                let both = of(a).weaker(of(b));
                Sides { outside: both.outside.min(Promise::Bound), inside: both.inside }
            }
            Node::Unary(Unary::Neg, a) => of(a).swapped(),
            // An offset surface: beyond it the distance is the distance to the original surface
            // minus the offset.
            Node::Binary(Binary::Sub | Binary::Add, a, r)
                if graph.ty(node).width() == 1 && graph.stage(r) < Stage::Point =>
            {
                let outwards = matches!(graph.node(node), Node::Binary(Binary::Sub, ..));
                of(a).offset(self.range(graph, r), outwards)
            }
            // A scaled copy, s * a(p / s). A negative factor turns it inside out.
            Node::Binary(Binary::Mul, a, b) => scaled_sample(graph, a, b)
                .filter(|(factor, child, q)| {
                    is_fixed_shape(graph, *child, maps.level())
                        && maps.is_similarity(graph, *q, *factor)
                })
                .and_then(|(factor, child, _)| Some((factor, self.get(child)?.sides)))
                .map_or(Sides::NONE, |(factor, sides)| match graph.as_number(factor) {
                    Some(factor) if factor >= 0.0 => sides,
                    Some(_) => sides.swapped(),
                    None => sides.weaker(sides.swapped()),
                }),
            Node::Ternary(Ternary::Select, [condition, a, b])
                if is_fixed(graph, condition, maps.level()) =>
            {
                of(a).weaker(of(b))
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => Sides::NONE,
        }
    }
}

/// True if a shape is the same wherever a formula of that level samples it: its arguments do not
/// depend on the formula's point.
pub(crate) fn is_fixed_shape(graph: &Graph, shape: ShapeId, level: u16) -> bool {
    graph.shape(shape).level <= level
}

/// Replaces a constant that depends on the point, which is of no use, by an error. Shapes whose
/// arguments depend on the point can have one.
fn independent_of_point(graph: &Graph, shape: ShapeId, constant: Constant) -> Constant {
    match constant {
        Ok(node) if graph.stage(node) == Stage::Point => {
            Err(Reason::Varying(graph.shape(shape).definition.clone()))
        }
        known => known,
    }
}

/// True if the derived constant confirms the stated one, up to rounding.
fn at_most(graph: &Graph, derived: &Constant, stated: &Constant) -> bool {
    let (Ok(derived), Ok(stated)) = (derived, stated) else { return false };
    if derived == stated {
        return true;
    }
    let (derived, stated) = (graph.as_number(*derived), graph.as_number(*stated));
    derived.zip(stated).is_some_and(|(d, s)| d <= s * (1.0 + 1e-12))
}

/// Takes `factor * sample`, in either order, apart into the factor, the shape and its point.
pub(crate) fn scaled_sample(
    graph: &Graph,
    a: NodeId,
    b: NodeId,
) -> Option<(NodeId, ShapeId, NodeId)> {
    let of = |factor, sample| graph.as_sample(sample).map(|(child, q)| (factor, child, q));
    of(a, b).or_else(|| of(b, a))
}
