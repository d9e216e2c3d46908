//! Where rays really meet a scene, and how far a picture is from that.
//!
//! # What
//!
//! The [`Oracle`] finds the first point at which a ray meets the surface, in f64, without marching: it
//! rejects stretches of the ray on which the field, evaluated over intervals, has no zero, and proves
//! the root that is left. [`Truth`] is its verdict on every pixel of a picture; [`Metrics`] compares a
//! picture with it.
//!
//! # How
//!
//! It shares the scene's formula with the shader and nothing else: neither its steps nor its arithmetic.
//! An interval holds the field's value at every point of a box, so a stretch whose interval lacks 0 is
//! free; where the interval of the derivative lacks 0 too, different signs at the ends prove one root.
//!
//! ```
//! use sdfc_accuracy::{Oracle, Ray, Verdict};
//! use sdfc_graph::eval::FrameValues;
//! use sdfc_graph::{Dim, Graph, Program, gradient};
//!
//! let mut graph = Graph::new();
//! let p = graph.point(0, Dim::Three);
//! let (length, radius) = (graph.length(p), graph.number(0.5));
//! let ball = graph.sub(length, radius);
//! let slope = gradient(&mut graph, ball, p);
//! let program =
//!     Program { graph, distance: Some(ball), gradient: Some(slope), ..Program::default() };
//!
//! let oracle = Oracle::new(&program)?;
//! let mut prober = oracle.prober(&FrameValues::default());
//! let ray = Ray { origin: [0.0, 0.0, 3.0], direction: [0.0, 0.0, -1.0], t_max: 10.0 };
//! let Verdict::Hit(t) = prober.first_hit(&ray).verdict else { panic!("it meets the ball") };
//! assert!((t - 2.5).abs() < 1e-9);
//! # Ok::<(), sdfc_accuracy::OracleError>(())
//! ```
//!
//! # Limits
//!
//! A ray on which [`Prober::BUDGET`] evaluations prove nothing is [`Verdict::Undecided`], as is one that
//! touches a surface without crossing it, to within 1e-9 of the distance. Both are counted and shown.
//! Stretches with jumps are decided by rejection and signs alone, each way through the jumps apart
//! ([`BranchPath`](sdfc_graph::eval::BranchPath)); a jump through zero counts as surface.

pub mod chart;
mod edges;
mod kept;
mod metrics;
mod normals;
mod oracle;
mod truth;

pub use kept::TruthStore;
pub use metrics::{Depth, Evaluations, Metrics, Normal, PixelSample, Quantiles, Status, compare};
pub use oracle::{Oracle, OracleError, Probe, Prober, Ray, Verdict};
pub use truth::{Camera, Counts, Kind, Truth};
