//! From sdfc graphs to naga modules: lowering, linking, validation, writers, reflection.
//!
//! The only crate of sdfc that names naga. It takes a [`Program`](sdfc_graph::Program), flat math
//! of one point, and makes of it
//!
//! - [`field_module`]: the distance, its gradient and the material as functions by themselves, for
//!   those who embed them; params are members of one uniform structure.
//! - [`render_module`]: the compute shader of a picture; the same functions fill the stubs of a ray
//!   method and of shading, which are the `.wgsl` files of `sdfc-march`.
//!
//! Both yield a [`Shader`]: a validated module, written in the language of a [`Target`], or handed over
//! as it is.
//!
//! ```
//! use sdfc_codegen::{FieldOptions, field_module};
//! use sdfc_graph::{Dim, Graph, Program};
//!
//! let mut graph = Graph::new();
//! let p = graph.point(0, Dim::Three);
//! let length = graph.length(p);
//! let radius = graph.number(0.5);
//! let distance = graph.sub(length, radius);
//! let program = Program { graph, distance: Some(distance), ..Program::default() };
//!
//! let options = FieldOptions { gradient: false, ..FieldOptions::default() };
//! let shader = field_module(&program, &options)?;
//! let text = shader.wgsl()?;
//! assert!(text.contains("fn sdf_distance(p: vec3<f32>) -> f32"));
//! assert!(text.contains("return (length(p) - 0.5f);"));
//! # Ok::<(), sdfc_codegen::Error>(())
//! ```
//!
//! How it works: nodes are lowered in the order of their ids to expressions of naga's arena, one
//! function for each root; loops of the graph are loops there, and there is no other control flow. No text is assembled:
//! names and statements are data, and naga writes them. A picture's files are parsed, calls to stubs that the scene has no
//! need of are dropped with all that only they reached, then the rest is filled and validated.
//!
//! Limits: constants and results are 32-bit floats; numbers beyond them are an [`Error`]. Operations
//! on constants alone are refused, for the graph folds those. What the graph does not hold as a loop is written out, so
//! drivers take long over thousands of leaves that are not alike.

mod assemble;
mod error;
mod link;
mod lower;
mod names;
mod options;
mod reflect;
mod reflection;
mod shader;
mod stopwatch;
mod target;
mod write;

pub use assemble::field::{field_module, march_module};
pub use assemble::picture::{
    benchmark_module, instrumented_module, normals_module, picture_module, render_module,
    render_module_with_camera,
};
pub use assemble::shadertoy::shadertoy_module;
pub use error::Error;
pub use options::{FieldOptions, Lists, MAX_CONSTANT_LIST, PictureOptions, Stage};
pub use reflection::{
    Buffer, BufferRole, Entry, FunctionInfo, Member, Reflection, Role, Structure, StructureMember,
    Uniform,
};
pub use sdfc_march::{Features, FieldSource};
pub use shader::{Culling, Shader, Written};
pub use stopwatch::Stopwatch;
pub use target::{Code, Target};
pub use write::instructions::FunctionCost;
