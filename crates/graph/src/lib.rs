//! Shape instances and typed math in one hash-consed arena, with its evaluators.
//!
//! # What it holds
//!
//! A [`Graph`] holds nodes of typed math ([`Node`]) and, above them, shape instances ([`Shape`]). A
//! shape is a formula in its own point that may sample other shapes. Equal nodes are stored once.
//! The operations are a closed set: the derivative, every evaluator and the lowering match them
//! exhaustively.
//!
//! # How
//!
//! 1. Typed builders ([`Graph::add`], [`Graph::unary`], …) make nodes; they fold constants and
//!    simplify.
//! 2. An [`Expander`] turns a shape at a point into flat math: its distance and its material.
//! 3. [`fold_transforms`] turns chains of affine maps into one map.
//! 4. [`gradient`] differentiates the field in one reverse sweep; [`adjoints`] gives the weights by
//!    which materials mix.
//! 5. [`uniforms`] lists what is computed once per frame; [`dump`] prints nodes as text.
//!
//! [`eval`] evaluates the result, a [`Program`], and the crate `sdfc-codegen` lowers it to a
//! shader.
//!
//! ```
//! use sdfc_graph::eval::{FrameValues, Tape};
//! use sdfc_graph::{Dim, Graph, fold_transforms, gradient, operation_count};
//!
//! let mut graph = Graph::new();
//! let p = graph.point(0, Dim::Three);
//! let (length, radius) = (graph.length(p), graph.number(0.5));
//! let ball = graph.sub(length, radius);
//! let rounding = graph.number(0.1);
//! let grown = graph.sub(ball, rounding);
//! assert_eq!(operation_count(&graph, &[grown]), 2); // length(p) - 0.6
//!
//! let field = fold_transforms(&mut graph, &[grown]).roots[0];
//! let normal = gradient(&mut graph, field, p);
//! let tape = Tape::new(&graph, &[field, normal])?;
//! let values = tape.prepare::<f64>(&FrameValues::default()).eval([0.0, 2.0, 0.0]).to_vec();
//! assert_eq!((values[0][0], values[1]), (1.4, [0.0, 1.0, 0.0, 0.0]));
//! # Ok::<(), sdfc_graph::eval::TapeError>(())
//! ```
//!
//! # Limits
//!
//! Simplification is exact over the reals, not bit by bit: `x / 3` becomes `x * (1 / 3)`. Expansion
//! stops at [`NODE_LIMIT`] nodes. Passes over nodes do not recurse. Passes over shapes recurse as
//! deep as shapes are nested, on a stack that grows.

mod at_frame;
mod blend;
mod bounds;
mod builders;
mod coefficient;
mod derive;
mod dominators;
mod dump;
mod enclose;
pub mod eval;
mod expand;
mod extension;
mod extract;
mod formulas;
mod graph;
mod guard;
mod ids;
mod loop_body;
mod loops;
mod node;
mod polynomial;
mod program;
mod range;
mod scene;
mod schedule;
mod shape;
mod simplify;
mod srgb;
mod transforms;
mod uniforms;
mod walk;

pub use blend::{Blend, Blends, blend_at, substitute};
pub use bounds::{Bounds, bounds};
pub use coefficient::Coefficient;
pub use derive::{GradientReport, adjoints, best_gradient, gradient, gradient_in_parts};
pub use dump::{dump, operation_count};
pub use enclose::{enclosure, slope_enclosure, tight_enclosure};
pub use expand::{ExpandError, Expander, MaterialChain, MaterialStep, NODE_LIMIT};
pub use extract::Extract;
pub use formulas::{FormulaChoice, reachable_by};
pub use graph::{Arguments, Graph, LipschitzClaim};
pub use guard::{Guard, GuardedValue, guarded_distance, guarded_value};
pub use ids::{IdMap, IdSet};
pub use loop_body::LoopBody;
pub use loops::{Loop, MAX_LOOP_DEPTH, SkipCondition, Table};
pub use node::{
    Binary, Const, Dim, FrameInput, LoopId, LoopVar, MaterialField, Node, NodeId, ShapeId, Stage,
    SurfaceVector, TableId, Ternary, Type, Unary,
};
pub use polynomial::{Polynomial, similarity_scale_squared, squared_lengths_of_orthogonal};
pub use program::{CullableLoop, Program, Rays};
pub use range::Range;
pub use scene::{
    Camera, Environment, Exposure, Fog, Lens, Light, LightSource, March, Occlusion, Param,
    ParamKind, Reflections, Scene, Settings, Shadow, Sky, Tone,
};
pub use schedule::{live_lanes, schedule};
pub use shape::{Arg, Contract, FAR, MaterialRule, Shape, SidePromise};
pub use simplify::function::{SoftExtreme, SoftKind};
pub use srgb::linear_to_srgb8;
pub use transforms::{Rewritten, fold_transforms};
pub use uniforms::uniforms;
pub use walk::{operands, reachable, reachable_where};
