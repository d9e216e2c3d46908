//! Shape instances and typed math in one hash-consed arena, with its evaluators.
//!
//! # What
//!
//! A [`Graph`] holds nodes of typed math ([`Node`]) and, above them, shape instances ([`Shape`]), each a formula in
//! its own point that may sample other shapes. Equal nodes are one node. The operations are a closed set: the
//! derivative, every evaluator and the lowering match it exhaustively.
//!
//! # How
//!
//! 1. Nodes are made by typed builders ([`Graph::add`], [`Graph::unary`], …), which fold constants and simplify.
//! 2. An [`Expander`] turns a shape at a point into flat math, its distance and its material.
//! 3. [`fold_transforms`] turns chains of affine maps into one map.
//! 4. [`gradient`] derives the field in one reverse sweep; [`adjoints`] gives the shares of a shape's parts.
//! 5. [`uniforms`] lists what is computed once per frame, [`dump`] shows what there is.
//!
//! The result, a [`Program`], is evaluated by [`eval`] or lowered to a shader.
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
//! Simplification is exact over the reals, not bit by bit: `x / 3` becomes `x * (1 / 3)`. Expansion stops at
//! [`NODE_LIMIT`] nodes. Passes over nodes do not recurse; those over shapes recurse as deep as shapes are nested, on a stack
//! that grows.

mod blend;
mod bounds;
mod build;
mod coefficient;
mod continuation;
mod derive;
mod dump;
mod enclose;
pub mod eval;
mod expand;
mod graph;
mod hoist;
mod ids;
mod node;
mod polynomial;
mod program;
mod range;
mod repeat;
mod scene;
mod shape;
mod simplify;
mod transforms;
mod walk;

pub use blend::{Blend, Blends, blend_at, rebuilt};
pub use bounds::{Bounds, bounds};
pub use coefficient::Coefficient;
pub use derive::{adjoints, gradient};
pub use dump::{dump, operation_count};
pub use enclose::{enclosure, slope_enclosure};
pub use expand::{ExpandError, Expander, NODE_LIMIT};
pub use graph::{Arguments, Claim, Graph};
pub use hoist::uniforms;
pub use ids::{IdMap, IdSet};
pub use node::{
    Binary, Const, Dim, FrameInput, LoopId, MaterialField, Node, NodeId, Place, ShapeId, Stage,
    TableId, Ternary, Type, Unary,
};
pub use polynomial::{Polynomial, common_square};
pub use program::{Program, Rays, Visit};
pub use range::Range;
pub use repeat::{Inert, Loop, LoopBody, MAX_LOOP_DEPTH, Table};
pub use scene::{
    Camera, Fog, Lens, Light, LightSource, March, Occlusion, Param, ParamKind, Reflections, Scene,
    Settings, Shadow, Sky,
};
pub use shape::{Arg, Contract, FAR, MaterialRule, Shape, SidePromise};
pub use transforms::{Rewritten, fold_transforms};
pub use walk::{reachable, reachable_where};
