//! Compiles the variants of a scene and draws them.

use std::time::Instant;

use sdfc::Scene;
use sdfc_codegen::{benchmark_module, instrumented_module};
use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;
use sdfc_render::{
    CompileTimes, EvaluationCounts, Frame, Image, LeafEvaluations, OnProgress, Pipeline, Progress,
    RenderOptions, TileSize, View, milliseconds_since, uniform_values,
};

use super::kind::Kind;
use super::setup::Setup;
use crate::baseline::{self, Encoded, Inexpressible};
use crate::error::MeasureError;

/// A frame that takes longer, in milliseconds, is drawn in tiles, so that no driver resets the GPU.
const MAX_SINGLE_TILE_MS: f64 = 1000.0;
/// A frame that takes longer, in milliseconds, is timed once.
const MAX_REPEATED_MS: f64 = 10_000.0;

/// A variant that is measured.
pub(super) struct Candidate {
    pub(super) kind: Kind,
    pub(super) pipeline: Pipeline,
    pub(super) uniforms: Vec<[f32; 4]>,
    pub(super) compile: CompileTimes,
    pub(super) first_picture: f64,
    pub(super) options: RenderOptions,
    /// Number of timed frames.
    pub(super) repetitions: u32,
    pub(super) image: Image,
    pub(super) leaf_evaluations: LeafEvaluations,
    pub(super) iterations: Option<usize>,
    pub(super) times: Vec<f64>,
    /// CPU time of each, for a software GPU.
    pub(super) cpu: Vec<f64>,
}

/// The data of a variant, without the view.
enum Data {
    Encoded(Encoded),
    Uniforms(Vec<[f32; 4]>),
}

impl Setup<'_> {
    /// Compiles a variant and draws its first frame. Returns [`Inexpressible`] if the variant
    /// cannot express the scene.
    pub(super) fn draw_first(
        &self,
        kind: Kind,
        counter: &mut FrameCounter<'_, '_>,
    ) -> Result<Result<Candidate, Inexpressible>, MeasureError> {
        let live = self.live.ok().filter(|_| kind == Kind::LiveLiterals);
        let scene = live.unwrap_or(self.scene);
        let start = Instant::now();
        let program = match self.program(kind) {
            Ok(program) => program,
            Err(inexpressible) => return Ok(Err(inexpressible)),
        };
        let data = match data(kind, scene, program) {
            Ok(data) => data,
            Err(inexpressible) => return Ok(Err(inexpressible)),
        };
        let shader =
            benchmark_module(program, self.options.method, kind.field(self.options.baselines))?;
        let validate = shader.validation_time().as_secs_f64() * 1e3;
        let lower = milliseconds_since(start) - validate;
        let (tables, uniforms, iterations) = match &data {
            Data::Encoded(encoded) => (&encoded.tables[..], Vec::new(), Some(encoded.iterations)),
            Data::Uniforms(uniforms) => (&[][..], uniforms.clone(), None),
        };
        let pipeline = Pipeline::with_tables(self.gpu, shader, uniforms.len(), tables)?;
        let times = scene.times();
        let mut compile = CompileTimes {
            front: Some(times.front),
            analyze: Some(times.analyze),
            lower: Some(lower),
            validate: Some(validate),
            pipeline: Some(pipeline.milliseconds()),
            ..CompileTimes::default()
        };
        if kind == Kind::Units {
            compile.analyze = None;
            compile.why.insert("analyze", "units are read off the shapes".to_owned());
        }
        let options = RenderOptions::default();
        let first = counter.draw(&pipeline, &self.view, &uniforms, &options)?;
        let first_picture =
            times.front + compile.analyze.unwrap_or(0.0) + milliseconds_since(start);
        let of_all =
            |leaves| LeafEvaluations::of_all_leaves(EvaluationCounts::of(&first.image), leaves);
        let whole = TileSize::Fixed(self.options.size);
        let tile_size =
            if first.milliseconds < MAX_SINGLE_TILE_MS { whole } else { options.tile_size };
        let once = first.milliseconds > MAX_REPEATED_MS;
        Ok(Ok(Candidate {
            kind,
            pipeline,
            uniforms,
            first_picture,
            compile,
            options: RenderOptions { tile_size, region: None },
            repetitions: if once { 1 } else { self.options.repetitions.max(1) },
            leaf_evaluations: match &data {
                Data::Uniforms(uniforms) if kind == Kind::Culled => {
                    self.count_leaf_evaluations(program, uniforms, counter)?
                }
                Data::Uniforms(_) => of_all(scene.report().leaves),
                Data::Encoded(encoded) => of_all(encoded.leaves),
            },
            image: first.image,
            iterations,
            times: Vec::new(),
            cpu: Vec::new(),
        }))
    }

    /// Counts leaf evaluations with culling, including those of the culling pass, by an
    /// instrumented shader.
    fn count_leaf_evaluations(
        &self,
        program: &Program,
        uniforms: &[[f32; 4]],
        counter: &mut FrameCounter<'_, '_>,
    ) -> Result<LeafEvaluations, MeasureError> {
        let iterations = program.cullable_loops.iter().map(|one| one.iterations as usize);
        let iterations = iterations.sum::<usize>();
        if iterations != self.scene.report().leaves {
            return Ok(LeafEvaluations::unknown("not every leaf is an iteration of a loop"));
        }
        let shader = instrumented_module(program, self.options.method)?;
        let pipeline = Pipeline::new(self.gpu, shader, uniforms.len())?;
        // A single tile, because the lists of each tile would evaluate the wide tiles again.
        let options = RenderOptions { tile_size: TileSize::Fixed(self.options.size), region: None };
        let frame = counter.draw(&pipeline, &self.view, uniforms, &options)?;
        counter.drawn -= 1;
        let visited = EvaluationCounts::of(&frame.image).mean;
        let before = frame.culling_evaluations as f64 / frame.image.pixels().len() as f64;
        Ok(LeafEvaluations { mean: Some(visited + before), ..LeafEvaluations::default() })
    }

    pub(super) fn draw(
        &self,
        candidate: &Candidate,
        counter: &mut FrameCounter<'_, '_>,
    ) -> Result<Frame, MeasureError> {
        let Candidate { pipeline, uniforms, options, .. } = candidate;
        counter.draw(pipeline, &self.view, uniforms, options)
    }
}

/// Returns the data of a variant at the scene's defaults.
fn data(kind: Kind, scene: &Scene, program: &Program) -> Result<Data, Inexpressible> {
    let frame = FrameValues::defaults(scene.params());
    let uniforms = || Data::Uniforms(uniform_values(program, &frame));
    match kind {
        Kind::Units => baseline::units(scene.graph(), &frame).map(Data::Encoded),
        Kind::Tape => baseline::tape(program, scene.report().leaves, &frame).map(Data::Encoded),
        Kind::Specialized | Kind::Looped | Kind::Culled => Ok(uniforms()),
        Kind::LiveLiterals if scene.live_literals().is_empty() => {
            Err(Inexpressible("no number of the scene can move".to_owned()))
        }
        Kind::LiveLiterals => Ok(uniforms()),
    }
}

/// Counts frames for the progress report.
pub(super) struct FrameCounter<'a, 'b> {
    pub(super) frames: u64,
    pub(super) drawn: u64,
    pub(super) progress: &'a mut OnProgress<'b>,
}

impl FrameCounter<'_, '_> {
    fn draw(
        &mut self,
        pipeline: &Pipeline,
        view: &View,
        uniforms: &[[f32; 4]],
        options: &RenderOptions,
    ) -> Result<Frame, MeasureError> {
        let Self { frames, drawn, progress } = self;
        let frame = pipeline.render(view, uniforms, options, &mut |tile_progress| {
            let Progress { done, total } = tile_progress;
            progress(Progress { done: *drawn * total + done, total: *frames * total })
        })?;
        self.drawn += 1;
        Ok(frame)
    }
}
