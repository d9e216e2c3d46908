//! Analyses of scenes, and the passes from a scene to a flat program.
//!
//! # What
//!
//! [`Qualities`] derives what every shape's field promises outside and inside, and its Lipschitz
//! constant. [`prepare`] divides the field by these constants, splits the scene into analytic and
//! marched operands, expands both to flat math over one point, folds transforms, turns many similar
//! operands into loops if that is faster, derives gradient and materials, and lists the uniform
//! slots. [`refute`] tests the clauses of shapes with samples.
//!
//! # How
//!
//! Everything is a free function over [`sdfc_graph::Graph`]. Results are tables beside the graph,
//! and nothing is stored in the nodes. A question that needs new nodes asks it on an extract of the
//! graph ([`sdfc_graph::Graph::extract`]).
//!
//! The modules are named after the stages: `certify` derives promises, constants and the
//! conservative field; `analytic` intersects rays without marching; `reroll` makes loops; `refute`
//! tests clauses and finds films; `planar` makes the pixels of scenes of regions, which have no
//! rays; `prepare` runs the passes in order.
//!
//! # Limits
//!
//! Constants are derived by rules that hold everywhere. A product of two values that both depend on
//! the point has no such constant. Interval derivatives may then find one that holds within the
//! shape's bounds. A shape without a constant is uncertified unless it states one.

mod analytic;
mod certify;
mod colored;
mod cost;
mod guards;
mod leaves;
mod planar;
mod prepare;
mod refute;
mod report;
mod reroll;
mod sampled_bounds;
mod shapes;
mod unit_slope;

pub use analytic::copies::{CopiesObstacle, copies_obstacle};
pub use certify::conservative::Uncertified;
pub use certify::inexact::InexactOperator;
pub use certify::promise::{Promise, Sides};
pub use certify::quality::{Qualities, Quality};
pub use certify::reason::{Constant, Reason};
pub use cost::{Cost, certain_operations, cost, cost_of_shapes};
pub use prepare::{Prepared, prepare, prepare_with};
pub use refute::claims::{LipschitzViolation, refute_lipschitz};
pub use refute::clauses::{Clause, Violation, refute};
pub use refute::copies::{CopiesViolation, refute_copies};
pub use refute::films::{Film, films};
pub use refute::rays::{RayViolation, refute_intersect};
pub use refute::suggest::{SampledSlope, SuggestedClauses, rounded_up, suggested_clauses};
pub use report::{Lipschitz, Report, ShapeReport};
pub use reroll::rewrite::RerolledLoop;
pub use reroll::strategy::LoopStrategy;
pub use sampled_bounds::sampled_bounds;
