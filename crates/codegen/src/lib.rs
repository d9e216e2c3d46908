//! From sdfc graphs to naga modules: lowering, linking, validation, writers, reflection.

mod error;
mod field;
mod inputs;
mod instructions;
mod link;
mod lower;
mod picture;
mod reflect;
mod shader;
mod types;

pub use error::Error;
pub use field::{FieldOptions, field_module};
pub use instructions::FunctionCost;
pub use picture::render_module;
pub use reflect::{FunctionInfo, Member, Reflection, Role, Uniform};
pub use sdfc_march::Features;
pub use shader::Shader;
