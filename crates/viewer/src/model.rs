//! A scene that has compiled, with what draws it.

use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

use sdfc::graph::{FrameInput, Node, Param, Program, reachable};
use sdfc::lang::live_literals::LiveLiteral;
use sdfc::march::{MethodParameter, method};
use sdfc::render::{CpuScene, Pipeline};
use sdfc::{FrameValues, Scene};

use crate::identity::Shapes;
use crate::probe::Probe;

/// What draws a scene.
#[derive(Clone, Debug)]
pub enum Engine {
    /// A shader on a device; scenes that differ only in their numbers share one.
    Gpu(Arc<Pipeline>),
    /// The program itself.
    Cpu(Arc<CpuScene>),
}

/// Where the time from reading to being ready went, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stages {
    /// Parsing, checking, elaborating.
    pub front: f64,
    /// Analyses and passes.
    pub analyze: f64,
    /// Lowering to the shader.
    pub lower: f64,
    /// Making the pipeline; `None` where the running one serves.
    pub pipeline: Option<f64>,
}

/// A scene that draws something, ready to be drawn. It does not change.
#[derive(Debug)]
pub struct Model {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Its own text.
    pub text: String,
    /// What draws it.
    pub engine: Engine,
    /// The method that it is drawn with.
    pub method: String,
    /// Whether it is drawn by parallel rays.
    pub parallel: bool,
    /// The program with what the method asks for, where it is not that of the scene.
    pub enclosed: Option<Program>,
    /// Its field on the CPU.
    pub probe: Arc<Probe>,
    /// Its shapes by name.
    pub shapes: Arc<Shapes>,
    /// Whether the picture depends on time or frame.
    pub moves: bool,
    /// When its text was read.
    pub begun: Instant,
    /// Where the time went.
    pub stages: Stages,
    /// How many pipelines the worker has made so far.
    pub pipelines: u64,
    /// A number of its own.
    pub serial: u64,
    /// A number of what was read: models that only draw it otherwise share it.
    pub content: u64,
    /// How often devices had been opened anew when it was made.
    pub renewed: u32,
    /// What is drawn otherwise than asked, and why.
    pub note: Option<String>,
}

impl Model {
    /// The params that the scene declares, with their positions.
    pub fn declared(&self) -> &[Param] {
        let count = self.scene.params().len() - self.scene.slots().len();
        self.scene.params().get(..count).unwrap_or_default()
    }

    /// Its numbers that move, and the params that they are.
    pub fn literals(&self) -> impl Iterator<Item = (&LiveLiteral, &Param)> {
        let params = self.scene.params();
        self.scene.slots().iter().filter_map(|slot| Some((slot, params.get(slot.param)?)))
    }

    /// Those that are all of a `let` with a line of its own, by its name.
    pub fn named(&self) -> impl Iterator<Item = (&str, &LiveLiteral, &Param)> {
        self.literals().filter_map(|(slot, param)| {
            let (start, end) = (slot.span.start as usize, slot.span.end as usize);
            Some((let_name(&self.text, start..end)?, slot, param))
        })
    }

    /// The program that the engine was made from.
    pub fn marched(&self) -> &Program {
        self.enclosed.as_ref().unwrap_or(self.scene.drawn())
    }

    /// What the method can be made finer or coarser by.
    pub fn knob(&self) -> Option<MethodParameter> {
        method(&self.method).and_then(|method| method.parameter)
    }

    /// The values of a frame in which nothing has been changed.
    pub fn defaults(&self) -> FrameValues {
        FrameValues::defaults(self.scene.params())
    }

    /// The name of the adapter; `None` on the CPU.
    pub fn adapter(&self) -> Option<&str> {
        match &self.engine {
            Engine::Gpu(pipeline) => Some(&pipeline.gpu().info().name),
            Engine::Cpu(_) => None,
        }
    }
}

/// The name in `let name = value`, where that is all of a line but for a comment.
fn let_name(text: &str, value: Range<usize>) -> Option<&str> {
    let (before, after) = (text.get(..value.start)?, text.get(value.end..)?);
    let (line, rest) = (before.rsplit('\n').next()?, after.lines().next().unwrap_or_default());
    let name = line.trim_start_matches('\u{feff}').strip_prefix("let ")?.trim_end();
    let ends = rest.trim().is_empty() || rest.trim_start().starts_with("//");
    name.strip_suffix('=').map(str::trim).filter(|_| ends)
}

/// Whether anything per frame reads time or frame.
pub fn reads_time(scene: &Scene) -> bool {
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
    fn a_number_has_the_name_of_the_let_that_it_is_all_of() {
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
