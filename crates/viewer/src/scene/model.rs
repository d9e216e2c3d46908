//! A compiled scene together with the pipeline or CPU renderer that draws it.

use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

use sdfc::{FrameValues, Method, Scene};
use sdfc_graph::{FrameInput, Node, Param, Program, reachable};
use sdfc_lang::live_literals::LiveLiteral;
use sdfc_march::MethodParameter;
use sdfc_render::{CpuScene, Pipeline};

use crate::scene::field_probe::FieldProbe;
use crate::scene::shapes::ShapeIndex;

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
    /// The params that the scene declares.
    pub fn declared(&self) -> &[Param] {
        let count = self.scene.params().len() - self.scene.live_literals().len();
        self.scene.params().get(..count).unwrap_or_default()
    }

    /// The live literals of its source, each with the param that it became.
    pub fn literals(&self) -> impl Iterator<Item = (&LiveLiteral, &Param)> {
        let params = self.scene.params();
        self.scene
            .live_literals()
            .iter()
            .filter_map(|literal| Some((literal, params.get(literal.param)?)))
    }

    /// The live literals named by a line `let name = literal`, with that name.
    pub fn named(&self) -> impl Iterator<Item = (&str, &LiveLiteral, &Param)> {
        self.literals().filter_map(|(literal, param)| {
            let (start, end) = (literal.span.start as usize, literal.span.end as usize);
            Some((let_name(&self.source, start..end)?, literal, param))
        })
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

/// The name in a line `let name = value`, which may end with a comment; `None` for other lines.
/// `value` is the byte range of the value in the source.
fn let_name(source: &str, value: Range<usize>) -> Option<&str> {
    let (before, after) = (source.get(..value.start)?, source.get(value.end..)?);
    let (line, rest) = (before.rsplit('\n').next()?, after.lines().next().unwrap_or_default());
    let name = line.trim_start_matches('\u{feff}').strip_prefix("let ")?.trim_end();
    let ends = rest.trim().is_empty() || rest.trim_start().starts_with("//");
    name.strip_suffix('=').map(str::trim).filter(|_| ends)
}

/// Returns true if anything evaluated per frame reads `time` or `frame`.
pub fn is_animated(scene: &Scene) -> bool {
    let program = scene.program();
    let mut roots = program.uniforms.clone();
    roots.extend(program.settings.nodes());
    let is_time = |node| matches!(node, Node::Frame(FrameInput::Time | FrameInput::Frame, _));
    reachable(&program.graph, &roots).into_iter().any(|id| is_time(program.graph.node(id)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_literal_has_a_name_if_it_is_the_whole_value_of_a_let() {
        let name = |text: &str| {
            let at = text.find("0.4").unwrap();
            let_name(text, at..at + 3).map(str::to_owned)
        };
        let named = ["let k = 0.4", "\u{feff}let k = 0.4\r\nsphere(k)\n", "a()\nlet  k=0.4 // k"];
        named.iter().for_each(|text| assert_eq!(name(text).as_deref(), Some("k"), "{text}"));
        let unnamed =
            ["let k = 0.4 + 1", "let k = -0.4", "sphere(0.4)", "  let k = 0.4", "outlet = 0.4"];
        unnamed.iter().for_each(|text| assert_eq!(name(text), None, "{text}"));
    }
}
