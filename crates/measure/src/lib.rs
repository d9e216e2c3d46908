//! Measures pictures and shaders of sdfc: accuracy, cost and speed.
//!
//! No program that only compiles or draws scenes needs this crate.
//!
//! # What
//!
//! The [`Oracle`] finds the first point at which a ray hits the surface, in f64, without marching:
//! it rejects ray segments on which the field, evaluated over intervals, has no zero, and proves
//! the root that is left. [`Truth`] is its verdict on every pixel of a picture, and [`Metrics`]
//! compare a picture with it. [`chart()`] does this for all ray methods, [`bench()`] compares the
//! speed of the shader with [`baseline`]s, and [`count_faults`] with a naive ray marcher.
//!
//! # How
//!
//! The oracle shares only the scene's formula with the shader, neither its steps nor its
//! arithmetic. An interval contains the field's value at every point of a box, so a segment whose
//! interval does not contain 0 is free. If the interval of the derivative does not contain 0,
//! different signs at the ends prove exactly one root.
//!
//! ```
//! use sdfc_measure::{Oracle, Ray, Verdict};
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
//! let Verdict::Hit(t) = prober.first_hit(&ray).verdict else { panic!("it hits the ball") };
//! assert!((t - 2.5).abs() < 1e-9);
//! # Ok::<(), sdfc_measure::OracleError>(())
//! ```
//!
//! # Limits
//!
//! A ray on which [`Prober::BUDGET`] evaluations prove nothing is [`Verdict::Undecided`], as is one
//! that touches a surface without crossing it, to within 1e-9 of the distance. Both are counted.
//! Segments with jumps are decided by rejection and signs alone, separately for each path
//! ([`BranchPath`](sdfc_graph::eval::BranchPath)); a jump through zero counts as surface.

pub mod baseline;
mod bench;
mod camera;
pub mod chart;
mod comparison;
mod edges;
mod error;
mod faults;
mod metrics;
mod normals;
mod oracle;
mod sampler;
mod scene;
mod store;
mod truth;

pub use bench::{BenchOptions, BenchReport, BenchRow, BenchVariant, bench, large_suite, suite};
pub use camera::Camera;
pub use chart::{ChartOptions, chart};
pub use comparison::Comparison;
pub use edges::Kind;
pub use error::MeasureError;
pub use faults::{FaultReport, FaultRow, FaultVariant, count_faults, fault_scenes};
pub use metrics::{Depth, Evaluations, Metrics, PixelSample, Quantiles, Status, compare};
pub use normals::Normal;
pub use oracle::{Oracle, OracleError, Probe, Prober, Ray, Verdict};
pub use sampler::Sampler;
pub use scene::{OracleOptions, operations, oracle, truth};
pub use store::TruthStore;
pub use truth::{Counts, Truth};
