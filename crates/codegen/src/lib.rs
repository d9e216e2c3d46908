//! From sdfc graphs to naga modules: lowering, linking, validation, writers, reflection.
//!
//! This is the only crate of sdfc that uses naga. It takes a [`Program`](sdfc_graph::Program), flat
//! math over one point, and makes these modules of it:
//!
//! - [`field_module`]: the distance, its gradient and the material as functions for embedders.
//!   Params are members of one uniform structure.
//! - [`march_module`]: the same, with a ray method beside them.
//! - [`render_module`]: the compute shader of a picture. The scene's functions replace the stubs of
//!   a ray method and of shading, which are the `.wgsl` files of `sdfc-march`.
//! - [`picture_module`] and [`shadertoy_module`]: pictures for other engines.
//!
//! Each returns a [`Shader`]: a validated module, which can be written in the language of a
//! [`Target`] or handed to wgpu as it is.
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
//! # How it works
//!
//! Nodes are lowered in the order of their ids to expressions of naga's arena, one function for
//! each root. Loops of the graph become loops; there is no other control flow. No source is
//! concatenated: names and statements are data, and naga writes them. A *template module* is parsed
//! from the WGSL files of a picture: calls to stubs that the scene does not need are dropped, with
//! everything that only they reached. Then a function of the scene is *bound* to each remaining
//! stub, and the module is validated.
//!
//! # Limits
//!
//! Constants and results are 32-bit floats; numbers beyond them are an [`Error`]. Operations on
//! constants alone are refused, because the graph folds them. What the graph does not hold as a
//! loop is unrolled, so drivers take long over thousands of primitives that are not alike.

mod assemble;
mod by_name;
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
pub use by_name::{UnknownName, by_name};
pub use error::Error;
pub use options::{FieldOptions, Lists, MAX_CONSTANT_LIST, PictureOptions, Stage};
pub use reflection::{
    Buffer, BufferRole, Entry, EntryStage, FunctionInfo, Member, Reflection, Role, Structure,
    StructureMember, Uniform,
};
pub use sdfc_march::{Features, FieldSource};
pub use shader::{Culling, Shader, Written};
pub use stopwatch::Stopwatch;
pub use target::{Code, Target};
pub use write::instructions::FunctionCost;
