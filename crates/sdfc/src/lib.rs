//! A compiler for signed distance functions: scene scripts to specialised shaders.
//!
//! # What
//!
//! [`compile`] takes the text of a scene and gives [`Compiled`]: findings as data, and a [`Scene`] if
//! none of them is an error. A scene can be evaluated on the CPU, written as a shader, explained, and
//! drawn.
//!
//! # How
//!
//! ```
//! use sdfc::{Backend, PictureOptions, compile, no_progress};
//!
//! let compiled = compile("ball.sdf", "sphere(0.5)\nplane(y: -0.5)");
//! assert!(compiled.diagnostics.is_empty());
//! let scene = compiled.scene.expect("no errors");
//!
//! let shader = scene.field_shader(&sdfc::FieldOptions::default())?;
//! assert!(shader.wgsl()?.contains("fn sdf_distance"));
//!
//! let options = PictureOptions { size: [32, 18], backend: Backend::Cpu, ..Default::default() };
//! let picture = scene.render(&options, &mut no_progress)?;
//! assert!(picture.stats.pixels.hit > 0);
//! # Ok::<(), sdfc::Error>(())
//! ```
//!
//! # Features
//!
//! All are on by default. Without any this is the compiler: a scene on the CPU and as a shader, without wgpu.
//!
//! - `fonts`: letters in scenes; without it a scene that uses `text` is refused.
//! - `render`: pictures, drawn with wgpu or on the CPU, and written as files.
//! - `wgpu`: the buffers and the bind group that a written shader wants of its host: [`bind`].
//! - `measure`: the oracle, charts and benchmarks; needs `render`.
//!
//! # Limits
//!
//! Nothing here prints, opens files or exits. A scene that imports other files needs a [`Resolver`] that hands
//! them in, see [`compile_with_imports`].

#[cfg(feature = "measure")]
mod accuracy;
#[cfg(feature = "measure")]
pub mod baseline;
#[cfg(feature = "measure")]
mod bench;
#[cfg(feature = "wgpu")]
pub mod bind;
#[cfg(feature = "measure")]
mod comparison;
mod compile;
mod error;
mod explain;
#[cfg(feature = "measure")]
mod faults;
mod field;
mod findings;
mod marched;
mod origin;
mod params;
#[cfg(feature = "render")]
mod picture;
mod quality;
mod reflection;
mod rows;
#[cfg(feature = "measure")]
mod sampler;
mod scene;
mod shader;
mod uniforms;

#[cfg(feature = "measure")]
pub use accuracy::{ChartOptions, OracleOptions};
#[cfg(feature = "measure")]
pub use bench::{BenchOptions, BenchReport, BenchRow, BenchVariant, large_suite, suite};
#[cfg(feature = "measure")]
pub use comparison::Comparison;
pub use compile::{
    Compiled, FrontTimes, Scene, SourceErrors, check, compile, compile_with, compile_with_imports,
    format,
};
pub use error::Error;
pub use explain::{Bounds, Explanation, Knob, QualityRow};
#[cfg(feature = "measure")]
pub use faults::{FaultReport, FaultRow, FaultVariant, faults};
pub use field::{Field, Material};
pub use marched::Marched;
pub use params::{ParamError, Value};
#[cfg(feature = "render")]
pub use picture::{Backend, Painter, Picture, PictureOptions};
pub use reflection::{
    BufferRow, Certificate, EntryRow, FunctionRow, MemberRow, ParamRow, ShaderReflection, Sides,
    StructRow, UniformRow,
};
pub use rows::DiagnosticRow;
#[cfg(feature = "measure")]
pub use sampler::Sampler;
pub use shader::{Emit, ShaderOptions, VIEW_SIZE};

#[cfg(feature = "measure")]
pub use sdfc_accuracy as accuracy_data;
pub use sdfc_analyze as analyze;
pub use sdfc_analyze::LoopStrategy;
pub use sdfc_codegen as codegen;
pub use sdfc_codegen::{Code, FieldOptions, Shader, Stage, Target, Written};
pub use sdfc_diagnostics as diagnostics;
pub use sdfc_graph as graph;
pub use sdfc_graph::eval::{FieldSample, FrameValues};
pub use sdfc_lang as lang;
pub use sdfc_lang::Resolver;
pub use sdfc_march as march;
pub use sdfc_render as render;
pub use sdfc_render::{Progress, no_progress};
pub use uniforms::uniform_bytes;
#[cfg(feature = "wgpu")]
pub use wgpu;
