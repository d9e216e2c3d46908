//! Lipschitz constants and the reasons why there are none.

use sdfc_graph::NodeId;

/// The reason why no Lipschitz constant could be derived.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The value jumps: `floor`, `round`, `%`, `sign`, `step`, or an `if` on the point.
    Jump(&'static str),
    /// An operation whose slope depends on the point and has no upper bound.
    Unbounded(&'static str),
    /// An operation whose largest slope within the bounds is many times the typical one.
    SteepInPlaces(&'static str),
    /// A shape whose arguments depend on the point.
    Varying(String),
    /// A child without a constant.
    Child(String),
    /// A stated constant that is infinite, for instance because it depends on infinite bounds.
    Infinite,
    /// A stated constant that depends on bounds, for a shape that states no bounds.
    NoBounds,
    /// A child's constant that holds only within its bounds, while the point may lie outside them.
    Within(String),
}

impl std::fmt::Display for Reason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Jump(what) => write!(f, "`{what}` of a value that depends on the point jumps"),
            Self::Unbounded(what) => {
                write!(f, "the slope of `{what}` depends on the point, and no limit of it is known")
            }
            Self::SteepInPlaces(what) => {
                write!(
                    f,
                    "the largest slope of `{what}` is many times its typical slope, so dividing by it \
                     would cost more than it saves"
                )
            }
            Self::Varying(name) => write!(f, "`{name}` is another shape at each point"),
            Self::Child(name) => write!(f, "`{name}` has no constant"),
            Self::Infinite => f.write_str("its constant is infinite because its bounds are"),
            Self::NoBounds => {
                f.write_str("its constant depends on bounds, so it must state `bounds` itself")
            }
            Self::Within(name) => {
                write!(
                    f,
                    "the constant of `{name}` holds only within its bounds, but it is sampled outside \
                     them too"
                )
            }
        }
    }
}

/// A Lipschitz constant as a node, or the reason why there is none.
pub type Constant = Result<NodeId, Reason>;
