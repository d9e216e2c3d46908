//! Distance quality, Lipschitz constants, cost, and the passes from a scene to a flat program.
//!
//! # What
//!
//! [`Qualities`] tells of every shape what its field promises outside and inside, and how fast it can
//! change. [`prepare`] uses that to divide what must be divided, parts what rays meet in closed form from what they
//! march to, expands both to flat math over one point, folds its transforms, makes loops of many alike parts where that
//! costs less, derives gradient and materials, and lists the uniform slots. [`refute`] holds what shapes state against
//! samples.
//!
//! # How
//!
//! Everything is a free function over [`sdfc_graph::Graph`]; nothing is stored in the nodes.
//!
//! # Limits
//!
//! Constants are derived by rules that hold everywhere. A product of two values that both depend on
//! the point has no such constant; then interval derivatives find one that holds within the shape's bounds. A shape
//! of which neither tells one is uncertified unless it states one.

mod analytic;
mod certify;
mod cost;
mod leaves;
mod prepare;
mod refute;
mod reroll;

pub use analytic::copies::{CopiesObstacle, copies_obstacle};
pub use certify::conservative::Uncertified;
pub use certify::inexact::InexactOperator;
pub use certify::lipschitz::{Constant, Reason};
pub use certify::quality::{Promise, Qualities, Quality, Sides};
pub use cost::{Cost, cost};
pub use prepare::{Lipschitz, Prepared, Report, ShapeReport, prepare, prepare_with};
pub use refute::claims::{LipschitzViolation, refute_lipschitz};
pub use refute::clauses::{Clause, Violation, refute};
pub use refute::copies::{CopiesViolation, refute_copies};
pub use refute::frames::ParamValues;
pub use refute::rays::{RayViolation, refute_intersect};
pub use reroll::rewrite::RerolledLoop;
pub use reroll::strategy::LoopStrategy;
