//! Shape instances and typed math in one hash-consed arena, with its evaluators.

mod bounds;
mod build;
mod derive;
mod dump;
pub mod eval;
mod expand;
mod graph;
mod hoist;
mod node;
mod program;
mod range;
mod scene;
mod shape;
mod simplify;
mod transforms;
mod walk;

pub use bounds::{Bounds, bounds};
pub use derive::{adjoints, gradient};
pub use dump::{dump, operation_count};
pub use expand::{ExpandError, Expander, NODE_LIMIT};
pub use graph::{Claim, Graph};
pub use hoist::uniforms;
pub use node::{
    Binary, Const, Dim, FrameInput, MaterialField, Node, NodeId, ShapeId, Stage, Ternary, Type,
    Unary,
};
pub use program::Program;
pub use range::Range;
pub use scene::{Camera, Light, March, Param, ParamKind, Scene, Settings, Shadow};
pub use shape::{Arg, Contract, MaterialRule, Shape, SidePromise};
pub use transforms::{Rewritten, fold_transforms};
pub use walk::{reachable, reachable_where};
