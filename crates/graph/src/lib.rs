//! Shape instances and typed math in one hash-consed arena, with its evaluators.

mod build;
pub mod eval;
mod graph;
mod node;
mod program;
mod scene;
mod shape;

pub use graph::Graph;
pub use node::{
    Binary, Const, Dim, FrameInput, MaterialField, Node, NodeId, ShapeId, Stage, Ternary, Type,
    Unary,
};
pub use program::Program;
pub use scene::{Camera, Light, March, Param, ParamKind, Scene, Settings, Shadow};
pub use shape::{Arg, Contract, MaterialRule, Shape, SidePromise};
