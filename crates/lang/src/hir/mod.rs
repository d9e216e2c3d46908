//! The typed scene: names are resolved, types checked, coercions and defaults explicit.
//!
//! The checker guarantees to the elaborator that every expression has its type, that arguments are
//! in the order of the parameters, and that every coercion is explicit. `Type::Error` occurs only
//! if errors were reported; such a scene is not elaborated.

mod expr;
mod ids;
mod kernel;
mod program;
mod types;

pub use expr::{Comprehension, Element, Expr, ExprKind, Lambda, Require};
pub use ids::{FnId, GlobalId, LocalId, ParamId, ShapeDefId};
pub use kernel::{Kernel, MaterialField};
pub use program::{
    Function, Global, Intersect, Param, Parameter, Program, Promise, Setting, SettingKind, ShapeDef,
};
pub use types::Type;
