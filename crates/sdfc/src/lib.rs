//! Compiles scenes of signed distance functions to specialised shaders.
//!
//! # What
//!
//! [`Compiler`] turns the source of a scene into a [`Scene`], or into [`Diagnostics`] if it has
//! errors. A scene is evaluated on the CPU, written as a shader for another program, explained, or
//! drawn.
//!
//! # How
//!
//! ```
//! use sdfc::{Backend, Code, Compiler, PictureOptions, ShaderOptions, no_progress};
//!
//! let source = "param r = 0.5 in 0.1..1\nsphere(r)\nplane(y: -0.5)";
//! let scene = Compiler::new().compile("ball.sdf", source)?;
//!
//! // The field on the CPU, with a value for the param.
//! let mut frame = scene.defaults();
//! scene.set(&mut frame, "r", 0.25)?;
//! assert_eq!(scene.field(&frame)?.distance([0.0, 2.0, 0.0]), 1.75);
//!
//! // The field as WGSL functions for your own shader.
//! let written = scene.write_shader(&ShaderOptions::new())?;
//! let Code::Text(wgsl) = written.code else { unreachable!("WGSL is text") };
//! assert!(wgsl.contains("fn sdf_distance"));
//!
//! // A picture.
//! let options = PictureOptions::new().size([32, 18]).backend(Backend::Cpu);
//! let picture = scene.render(&options, &mut no_progress)?;
//! assert!(picture.stats.pixels.hit > 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! All are on by default. Without them the crate is the compiler alone: scenes on the CPU and as
//! shaders, without wgpu.
//!
//! - `fonts`: letters in scenes. Without it a scene that uses `text` is an error.
//! - `mesh`: closed triangle meshes and contours with a proven error: `Scene::mesh`,
//!   `Scene::contour`; volume and more as proven intervals: `Scene::measure`; grids of samples:
//!   `Scene::bake`.
//! - `render`: pictures, drawn with wgpu or on the CPU, and encoded as PNG, EXR or GIF.
//! - `wgpu`: the buffers and the bind group that a written shader needs: `bind`.
//!
//! # Limits
//!
//! This crate does not print, open files or exit. A scene that imports files needs a [`Resolver`]
//! that returns their contents. `sdfc-files` has one that reads a folder.

#[cfg(feature = "mesh")]
mod bake;
#[cfg(feature = "wgpu")]
pub mod bind;
mod call_costs;
#[cfg(feature = "mesh")]
mod clearance;
mod compiler;
mod derived_bounds;
mod diagnostics;
#[cfg(feature = "render")]
mod empty_view;
mod error;
mod explain;
mod explanation;
mod field;
#[cfg(feature = "mesh")]
mod limited;
mod marched;
#[cfg(feature = "mesh")]
mod measure;
#[cfg(feature = "mesh")]
mod mesh;
mod params;
#[cfg(feature = "render")]
mod picture;
mod quality;
mod rebase;
mod reflection;
mod scene;
mod shader;
mod shape_facts;
#[cfg(feature = "render")]
mod software;
mod source_id;
mod tapes;
mod uniforms;
#[cfg(feature = "mesh")]
mod wall;

#[cfg(feature = "mesh")]
pub use bake::BakeOptions;
pub use compiler::{CompileWithError, Compiler, format};
pub use diagnostics::{DiagnosticRow, Diagnostics, EditRow, FixRow};
pub use error::Error;
pub use explanation::{Bounds, CallCost, Explanation, Input, QualityRow};
pub use field::{Field, Material};
#[cfg(feature = "mesh")]
pub use limited::Reported;
pub use marched::Marched;
#[cfg(feature = "mesh")]
pub use measure::MeasureOptions;
#[cfg(feature = "mesh")]
pub use mesh::{MeshOptions, MeshSize};
pub use params::{ParamError, Value, degrees};
#[cfg(feature = "render")]
pub use picture::{Backend, Painter, Picture, PictureOptions};
pub use reflection::{
    BufferRow, Certificate, EntryRow, FunctionRow, MemberRow, ParamRow, ShaderReflection, Sides,
    StructRow, UniformRow,
};
pub use scene::{FrontTimes, Scene};
pub use shader::{Emit, MAX_BINDING, ShaderOptions, VIEW_SIZE};
pub use shape_facts::ShapeFacts;
pub use uniforms::uniform_bytes;

pub use sdfc_analyze::LoopStrategy;
pub use sdfc_codegen::{
    Buffer, BufferRole, Code, EntryStage, FieldOptions, Lists, Member, Reflection, Shader, Stage,
    Target, UnknownName, Written,
};
pub use sdfc_diagnostics::{Diagnostic, FileId, LineColumn, Located, Severity, Sources, Span};
pub use sdfc_graph::eval::{FieldSample, FrameValues};
pub use sdfc_graph::{Param, ParamKind};
pub use sdfc_lang::live_literals::{LiveLiteral, MAX_LIVE_LITERALS};
pub use sdfc_lang::{CompileValues, NoFiles, Resolver};
pub use sdfc_march::{Method, UnknownMethod};
#[cfg(feature = "mesh")]
pub use sdfc_mesh::{
    Clearance, Contour, ContourCertificate, ContourFormat, ContourPath, ContourReport,
    DistanceGrid, EncodeError, GridFormat, Measurements, Mesh, MeshCertificate, MeshError,
    MeshFormat, MeshReport, Phase as MeshPhase, Plane, Progress as MeshProgress, Proven, Shell,
    Wall,
};
#[cfg(feature = "render")]
pub use sdfc_render::{Animation, Image, Progress, RasterKind, Stats, Tile, no_progress};
pub use sdfc_render::{Pose, RenderError, View, ViewError};
#[cfg(feature = "wgpu")]
pub use wgpu;
