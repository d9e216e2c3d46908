//! A compiled scene together with the pipeline or CPU renderer that draws it.

use std::sync::Arc;
use std::time::Instant;

use sdfc::{FrameValues, Method, Scene};
use sdfc_graph::{FrameInput, Node, Param, Program, reachable};
use sdfc_march::MethodParameter;
use sdfc_render::{CpuScene, Pipeline};

use crate::scene::document::TextsByPath;
use crate::scene::field_probe::FieldProbe;
use crate::scene::shapes::ShapeIndex;
use crate::scene::source_numbers::SourceNumber;

/// The pipeline or CPU renderer that draws a scene.
#[derive(Clone, Debug)]
pub enum Engine {
    /// A pipeline on a GPU; scenes that differ only in their numbers share one.
    Gpu(Arc<Pipeline>),
    /// The CPU renderer.
    Cpu(Arc<CpuScene>),
}

/// The duration of each step from reading to being ready, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildTimes {
    /// Parsing, checking and elaboration.
    pub front: f64,
    /// Analyses and optimisation passes.
    pub analyze: f64,
    /// Generating the shader.
    pub lower: f64,
    /// Making the pipeline; `None` if the running one is reused.
    pub pipeline: Option<f64>,
}

/// A scene that is ready to be drawn. It is immutable.
#[derive(Debug)]
pub struct Model {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Its source.
    pub source: String,
    /// The texts of the files that it imports, by their path beside the scene.
    pub imports: Arc<TextsByPath>,
    /// The numbers of its source that can change, in the order of their positions.
    pub numbers: Vec<SourceNumber>,
    /// The pipeline or CPU renderer that draws it.
    pub engine: Engine,
    /// The ray method that is used.
    pub method: Method,
    /// True for an orthographic camera.
    pub parallel: bool,
    /// The program with the method's additions; `None` if the method adds nothing.
    pub method_program: Option<Program>,
    /// Its field, evaluated on the CPU.
    pub field: Arc<FieldProbe>,
    /// Its shapes and their names.
    pub shapes: Arc<ShapeIndex>,
    /// True if the picture depends on `time` or `frame`.
    pub animated: bool,
    /// When its source was read.
    pub read_at: Instant,
    /// The duration of each step of the build.
    pub build_times: BuildTimes,
    /// The number of pipelines made so far.
    pub pipelines: u64,
    /// True if the device of the window draws it, unless the CPU does.
    pub on_window: bool,
    /// A number that no other model has; later models have greater ones.
    pub serial: u64,
    /// A number that models of the same source share, however they are drawn.
    pub content_id: u64,
    /// The [device generation](crate::compile::request::BuildRequest::device_generation) that it
    /// was made for.
    pub device_generation: u32,
    /// A note for the user if the request could not be followed, with the reason.
    pub note: Option<String>,
}

impl Model {
    /// The text of an imported file that was compiled with the scene; `None` for other files.
    pub fn import_text(&self, path: &str) -> Option<&str> {
        self.imports.get(path).map(|text| &**text)
    }

    /// The params that the scene declares.
    pub fn declared(&self) -> &[Param] {
        let count = self.scene.params().len() - self.scene.live_literals().len();
        self.scene.params().get(..count).unwrap_or_default()
    }

    /// The number whose literal, without its sign, starts at a byte of the source.
    pub fn number_at(&self, start: usize) -> Option<&SourceNumber> {
        let start = u32::try_from(start).ok()?;
        let index = self.numbers.binary_search_by_key(&start, |number| number.span.start).ok()?;
        self.numbers.get(index)
    }

    /// The program that the engine was made from.
    pub fn marched(&self) -> &Program {
        self.method_program.as_ref().unwrap_or(self.scene.drawn())
    }

    /// The parameter of the ray method that makes it finer or coarser.
    pub fn method_parameter(&self) -> Option<MethodParameter> {
        self.method.definition().parameter
    }

    /// The frame values with every param at its default.
    pub fn defaults(&self) -> FrameValues {
        FrameValues::defaults(self.scene.params())
    }

    /// The name of the GPU; `None` if the CPU draws.
    pub fn gpu_name(&self) -> Option<&str> {
        match &self.engine {
            Engine::Gpu(pipeline) => Some(&pipeline.gpu().info().name),
            Engine::Cpu(_) => None,
        }
    }
}

/// Returns true if anything evaluated per frame reads `time` or `frame`.
pub fn is_animated(scene: &Scene) -> bool {
    let program = scene.program();
    let mut roots = program.uniforms.clone();
    roots.extend(program.settings.nodes());
    let is_time = |node| matches!(node, Node::Frame(FrameInput::Time | FrameInput::Frame, _));
    reachable(&program.graph, &roots).into_iter().any(|id| is_time(program.graph.node(id)))
}
