//! What each shape's field promises: outside and inside apart, and its Lipschitz constant.
//!
//! Two independent facts: `|f| <= distance` lets a ray step by `f`; "L-Lipschitz" bounds how fast `f`
//! changes. `exact` implies both, a constant of at most 1 implies `bound` on both sides.

use rustc_hash::FxHashMap;
use sdfc_graph::eval::{FrameValues, Interval};
use sdfc_graph::{
    Binary, Contract, Graph, Node, NodeId, Param, ShapeId, SidePromise, Stage, Ternary, Unary,
};

use crate::certify::lipschitz::{Constant, Reason, Slopes};
use crate::certify::local_slope::steepest_within;
use crate::certify::maps::Maps;

/// What |f| is on one side of the surface, from weak to strong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Promise {
    /// Nothing is known.
    None,
    /// Never more than the distance.
    Bound,
    /// The distance.
    Exact,
}

impl std::fmt::Display for Promise {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::None => "none",
            Self::Bound => "bound",
            Self::Exact => "exact",
        })
    }
}

/// The promises on both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sides {
    /// Where the field is positive.
    pub outside: Promise,
    /// Where it is negative.
    pub inside: Promise,
}

impl Sides {
    const EXACT: Self = Self { outside: Promise::Exact, inside: Promise::Exact };
    const NONE: Self = Self { outside: Promise::None, inside: Promise::None };

    fn both(promise: Promise) -> Self {
        Self { outside: promise, inside: promise }
    }

    fn swapped(self) -> Self {
        Self { outside: self.inside, inside: self.outside }
    }

    fn weaker(self, other: Self) -> Self {
        Self { outside: self.outside.min(other.outside), inside: self.inside.min(other.inside) }
    }

    fn stronger(self, other: Self) -> Self {
        Self { outside: self.outside.max(other.outside), inside: self.inside.max(other.inside) }
    }

    pub(crate) fn is_exact(self) -> bool {
        self == Self::EXACT
    }

    /// Whether |f| exceeds the distance on neither side: enough to step by it.
    pub fn is_bound(self) -> bool {
        self.outside >= Promise::Bound && self.inside >= Promise::Bound
    }
}

/// What is known of one shape.
#[derive(Clone, Debug)]
pub struct Quality {
    /// Its promises.
    pub sides: Sides,
    /// Its Lipschitz constant: a node known before the point is.
    pub lipschitz: Constant,
    /// Whether the constant holds at every point, or only within the shape's bounds.
    pub everywhere: bool,
    /// The bounds within which it was found, where no rule and no clause gives one.
    pub within: Option<[NodeId; 2]>,
}

/// What a shape's own clauses say, its children's shortcomings counted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stated {
    /// Where all children keep the same promise.
    pub sides: Sides,
    /// Times the largest of the children's, if these hold everywhere.
    pub lipschitz: Option<NodeId>,
    /// Whether it states bounds.
    pub bounds: bool,
}

impl Stated {
    pub(crate) fn says_nothing(&self) -> bool {
        self.sides == Sides::NONE && self.lipschitz.is_none() && !self.bounds
    }
}

/// Qualities of all shapes that were asked for and their children.
#[derive(Clone, Debug)]
pub struct Qualities {
    of: FxHashMap<ShapeId, Quality>,
    params: Vec<Param>,
    ranges: FrameValues<Interval>,
}

impl Qualities {
    /// The qualities of `root` and of every shape below it, for all values of the params.
    pub fn of_scene(graph: &mut Graph, root: ShapeId, params: &[Param]) -> Self {
        let ranges = FrameValues::ranges(params);
        let mut qualities = Self { of: FxHashMap::default(), params: params.to_vec(), ranges };
        for shape in shapes_below(graph, root) {
            let quality = qualities.derive(graph, shape);
            qualities.of.insert(shape, quality);
        }
        qualities
    }

    /// All values that a number can have which is known before the point is.
    pub(crate) fn range(&self, graph: &Graph, node: NodeId) -> Interval {
        graph
            .as_number(node)
            .map_or_else(|| self.ranges.range(graph, node), |number| Interval::new(number, number))
    }

    /// The quality of a shape of the scene.
    pub fn get(&self, shape: ShapeId) -> Option<&Quality> {
        self.of.get(&shape)
    }

    /// Its constant; a shape that was not asked for has none.
    pub(crate) fn constant(&self, graph: &Graph, shape: ShapeId) -> Constant {
        let missing = || Err(Reason::Child(graph.shape(shape).definition.clone()));
        self.get(shape).map_or_else(missing, |quality| quality.lipschitz.clone())
    }

    /// The constants of everything in a shape's formula.
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

    /// A child's constant, its failure told by the child's name.
    fn child_constant(&self, graph: &Graph, child: ShapeId) -> Constant {
        self.constant(graph, child)
            .map_err(|_| Reason::Child(graph.shape(child).definition.clone()))
    }

    /// What the clauses of a shape of the scene say.
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

    /// What the clauses say of the two sides, given what the children are.
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

    fn derive(&self, graph: &mut Graph, shape: ShapeId) -> Quality {
        let contract = graph.shape(shape).contract;
        let children = graph.shape(shape).children.clone();
        let stated = self.stated_sides(graph, &contract, &children);
        if stated.is_exact() {
            return Quality {
                sides: stated,
                lipschitz: Ok(graph.number(1.0)),
                everywhere: true,
                within: None,
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
                // Beyond the bounds lies only the outside, and a distance has the constant 1.
                let one =
                    stated.as_ref().is_ok_and(|&l| graph.as_number(l).is_some_and(|l| l >= 1.0));
                let exact_beyond = outside == Promise::Exact && one;
                let said = contract.everywhere || contract.is_extended || contract.bounds.is_none();
                (stated, children_everywhere && (confirmed || exact_beyond || said))
            }
            None => (derived, children_everywhere),
        };
        let lipschitz = known_early(graph, shape, lipschitz);
        let (lipschitz, everywhere, within) = match lipschitz {
            Err(Reason::Unbounded(what)) if contract.lipschitz.is_none() => {
                self.found_within(graph, shape, what)
            }
            known => (known, everywhere, None),
        };
        let mut sides = stated.stronger(self.structural(graph, &mut slopes, shape));
        if lipschitz.as_ref().is_ok_and(|&l| graph.as_number(l).is_some_and(|l| l <= 1.0)) {
            sides = sides.stronger(Sides::both(Promise::Bound));
        }
        Quality { sides, lipschitz, everywhere, within }
    }

    /// A constant by interval derivatives, that it does not hold everywhere, and the bounds within which it does.
    fn found_within(
        &self,
        graph: &mut Graph,
        shape: ShapeId,
        what: &'static str,
    ) -> (Constant, bool, Option<[NodeId; 2]>) {
        let bounds = match graph.shape(shape).contract.bounds {
            Some(bounds) => bounds,
            None => sdfc_graph::bounds(graph, shape, &self.params),
        };
        match steepest_within(graph, shape, bounds, &self.params) {
            Some(slope) if slope.is_even() => (Ok(graph.number(slope.most)), false, Some(bounds)),
            Some(_) => (Err(Reason::SteepInPlaces(what)), false, None),
            None => (Err(Reason::Unbounded(what)), false, None),
        }
    }

    /// A stated constant holds for 1-Lipschitz children: times max(1, the largest child's).
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

    /// Promises that follow from the form of a formula alone.
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
            // Sampled through an isometry, a field keeps its promises.
            Node::Sample(child, q)
                if is_one(graph, child, maps.level()) && maps.is_isometry(graph, q) =>
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
            // A parallel surface: beyond it the distance is that to the first one, less what lies between.
            Node::Binary(Binary::Sub | Binary::Add, a, r)
                if graph.ty(node).width() == 1 && graph.stage(r) < Stage::Point =>
            {
                let outwards = matches!(graph.node(node), Node::Binary(Binary::Sub, ..));
                offset(of(a), self.range(graph, r), outwards)
            }
            // A scaled copy: s * a(p / s); a negative factor turns it inside out.
            Node::Binary(Binary::Mul, a, b) => scaled_sample(graph, a, b)
                .filter(|(factor, child, q)| {
                    is_one(graph, *child, maps.level()) && maps.is_similarity(graph, *q, *factor)
                })
                .and_then(|(factor, child, _)| Some((factor, self.get(child)?.sides)))
                .map_or(Sides::NONE, |(factor, sides)| match graph.as_number(factor) {
                    Some(factor) if factor >= 0.0 => sides,
                    Some(_) => sides.swapped(),
                    None => sides.weaker(sides.swapped()),
                }),
            Node::Ternary(Ternary::Select, [condition, a, b])
                if graph.stage(condition) < Stage::Point =>
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

/// Whether a shape is the same wherever a formula of that level samples it.
pub(crate) fn is_one(graph: &Graph, shape: ShapeId, level: u16) -> bool {
    graph.shape(shape).level <= level
}

/// A shape that is built anew at each point may have a constant that depends on the point: of no use.
fn known_early(graph: &Graph, shape: ShapeId, constant: Constant) -> Constant {
    match constant {
        Ok(node) if graph.stage(node) == Stage::Point => {
            Err(Reason::Varying(graph.shape(shape).definition.clone()))
        }
        known => known,
    }
}

/// What is left of exactness where a field is lowered (`outwards`) or raised by a number in the range.
fn offset(sides: Sides, by: Interval, outwards: bool) -> Sides {
    let (grows, shrinks) = match outwards {
        true => (by.lo() >= 0.0, by.hi() <= 0.0),
        false => (by.hi() <= 0.0, by.lo() >= 0.0),
    };
    let kept = |promise: Promise, holds: bool| match promise {
        Promise::Exact if holds => Promise::Exact,
        Promise::Exact | Promise::Bound | Promise::None => Promise::None,
    };
    Sides { outside: kept(sides.outside, grows), inside: kept(sides.inside, shrinks) }
}

/// Whether the derived constant bears the stated one out, up to rounding.
fn at_most(graph: &Graph, derived: &Constant, stated: &Constant) -> bool {
    let (Ok(derived), Ok(stated)) = (derived, stated) else { return false };
    if derived == stated {
        return true;
    }
    let (derived, stated) = (graph.as_number(*derived), graph.as_number(*stated));
    derived.zip(stated).is_some_and(|(d, s)| d <= s * (1.0 + 1e-12))
}

/// `factor * sample` in either order.
pub(crate) fn scaled_sample(
    graph: &Graph,
    a: NodeId,
    b: NodeId,
) -> Option<(NodeId, ShapeId, NodeId)> {
    let of = |factor, sample| graph.as_sample(sample).map(|(child, q)| (factor, child, q));
    of(a, b).or_else(|| of(b, a))
}

/// What the clauses say, their conditions decided; an undecided condition counts as false.
fn stated_sides(graph: &Graph, contract: &Contract, exact: bool, bound: bool) -> Sides {
    let holds = |condition: Option<NodeId>| {
        condition.is_some_and(
            |node| matches!(graph.node(node), Node::Const(value) if value.lanes()[0] != 0.0),
        )
    };
    let side = |promise: SidePromise| {
        if exact && holds(promise.exact) {
            Promise::Exact
        } else if bound && (holds(promise.bound) || holds(promise.exact)) {
            Promise::Bound
        } else {
            Promise::None
        }
    };
    Sides { outside: side(contract.outside), inside: side(contract.inside) }
}

/// `root` and everything that its formulas and materials sample, children before parents.
pub(crate) fn shapes_below(graph: &Graph, root: ShapeId) -> Vec<ShapeId> {
    let mut seen = rustc_hash::FxHashSet::default();
    let mut pending = vec![root];
    while let Some(shape) = pending.pop() {
        if seen.insert(shape) {
            pending.extend(graph.shape(shape).children.iter().copied());
        }
    }
    let mut order: Vec<ShapeId> = seen.into_iter().collect();
    order.sort_unstable();
    order
}
