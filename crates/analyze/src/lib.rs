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

mod affine;
mod clip;
mod closed;
mod components;
mod copies;
mod cost;
mod fault;
mod folds;
mod form;
mod leaves;
mod lipschitz;
mod maps;
mod prepare;
mod quality;
mod rays;
mod refute;
mod roll;
mod sound;
mod spans;
mod uneven;
mod within;
mod writing;

pub use copies::{Idle, idle_copies};
pub use cost::{Cost, cost};
#[cfg(feature = "faults")]
pub use fault::Rule;
pub use lipschitz::{Constant, Reason};
pub use prepare::{Lipschitz, Prepared, Report, ShapeReport, prepare, prepare_about};
pub use quality::{Promise, Qualities, Quality, Sides};
pub use refute::{
    ClaimFault, Clause, CopiesFault, ParamEnd, RayFault, Refuted, refute, refute_claim,
    refute_copies, refute_hits,
};
pub use roll::Rolled;
pub use sound::Uncertified;
pub use uneven::Uneven;
pub use writing::Writing;
