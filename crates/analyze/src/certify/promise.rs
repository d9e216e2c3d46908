//! The promises of a field on both sides of its surface.

use sdfc_graph::eval::Interval;
use sdfc_graph::{Contract, Graph, Node, NodeId, SidePromise};

/// A promise about |f| on one side of the surface, from weak to strong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Promise {
    /// Nothing.
    None,
    /// |f| never exceeds the distance.
    Bound,
    /// |f| is the distance.
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

/// The promises on both sides of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sides {
    /// The promise where the field is positive.
    pub outside: Promise,
    /// The promise where the field is negative.
    pub inside: Promise,
}

impl Sides {
    pub(crate) const EXACT: Self = Self { outside: Promise::Exact, inside: Promise::Exact };
    pub(crate) const NONE: Self = Self { outside: Promise::None, inside: Promise::None };

    pub(crate) fn both(promise: Promise) -> Self {
        Self { outside: promise, inside: promise }
    }

    pub(crate) fn swapped(self) -> Self {
        Self { outside: self.inside, inside: self.outside }
    }

    pub(crate) fn weaker(self, other: Self) -> Self {
        Self { outside: self.outside.min(other.outside), inside: self.inside.min(other.inside) }
    }

    pub(crate) fn stronger(self, other: Self) -> Self {
        Self { outside: self.outside.max(other.outside), inside: self.inside.max(other.inside) }
    }

    pub(crate) fn is_exact(self) -> bool {
        self == Self::EXACT
    }

    /// True if |f| exceeds the distance on neither side, so that a ray may step by it.
    pub fn is_bound(self) -> bool {
        self.outside >= Promise::Bound && self.inside >= Promise::Bound
    }

    /// The promises that remain if a number in the interval is subtracted from the field
    /// (`outwards`) or added to it.
    pub(crate) fn offset(self, by: Interval, outwards: bool) -> Self {
        let (grows, shrinks) = match outwards {
            true => (by.lo() >= 0.0, by.hi() <= 0.0),
            false => (by.hi() <= 0.0, by.lo() >= 0.0),
        };
        let kept = |promise: Promise, holds: bool| match promise {
            Promise::Exact if holds => Promise::Exact,
            Promise::Exact | Promise::Bound | Promise::None => Promise::None,
        };
        Self { outside: kept(self.outside, grows), inside: kept(self.inside, shrinks) }
    }
}

/// The promises that the clauses state. A condition that is not known when the scene compiles
/// counts as false. `exact` and `bound` tell if all children keep that promise.
pub(crate) fn stated_sides(graph: &Graph, contract: &Contract, exact: bool, bound: bool) -> Sides {
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
