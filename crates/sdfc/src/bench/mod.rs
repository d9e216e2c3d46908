//! The specialised shader against shaders that interpret the scene, in one run.

mod suite;

use std::time::Instant;

use sdfc_codegen::{FieldSource, measured_module};
use sdfc_graph::eval::FrameValues;
use sdfc_render::{
    CompileTimes, EvaluationCounts, Frame, FrameTimes, Gpu, HIT, Image, LeafEvaluations,
    OnProgress, Pipeline, Progress, RenderOptions, TileSize, View, Why, edges, uniform_values,
};
use serde::Serialize;

use crate::baseline::{self, Encoded, Inexpressible};
use crate::compile::milliseconds;
use crate::{Error, Scene};

pub use suite::suite;

/// The variant that the others are compared with.
const REFERENCE: &str = "specialized";
/// Hits whose depths differ by more than so many tolerances are different hits: rounding alone may make a ray
/// take one step more, which is at most about one tolerance long.
const TOLERANCES: f64 = 4.0;
/// A picture that differs in more of its pixels, edges left out, is another picture.
const MAX_DIFFERING: f64 = 1e-3;
/// A frame that takes longer, in milliseconds, is drawn in tiles, so that no driver takes it for hung.
const ONE_TILE: f64 = 1000.0;

/// How scenes are measured.
#[derive(Clone, Debug, PartialEq)]
pub struct BenchOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// How many frames of each variant are timed, after one that is not; at least 1.
    pub repetitions: u32,
    /// Ray method of all variants.
    pub method: String,
}

impl Default for BenchOptions {
    /// 640 by 360, five frames, `sphere`: the method of the practical that `units` follows.
    fn default() -> Self {
        Self { size: [640, 360], repetitions: 5, method: "sphere".to_owned() }
    }
}

/// What `bench --json` writes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchReport {
    /// Name of the adapter.
    pub adapter: String,
    /// Name and version of its driver.
    pub driver: String,
    /// One for each scene.
    pub rows: Vec<BenchRow>,
}

/// All variants of one scene; they share everything but the field.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchRow {
    /// Name of the scene.
    pub scene: String,
    /// Leaves of the scene.
    pub leaves: usize,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Ray method.
    pub method: String,
    /// One for each way to evaluate the field.
    pub variants: Vec<BenchVariant>,
}

/// One way to evaluate the field. A figure that cannot be had is null, with the reason in `why`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchVariant {
    /// `units`, `tape`, `specialized` or `specialized-slots`.
    pub name: &'static str,
    /// Time of one frame without compilation.
    pub frame_ms: Option<FrameTimes>,
    /// Median time of a frame in that of `specialized`.
    pub times_specialized: Option<f64>,
    /// Stages of compilation; encoding the tables is part of `lower`.
    pub compile_ms: Option<CompileTimes>,
    /// From reading the scene to its first finished picture, in milliseconds.
    pub first_picture_ms: Option<f64>,
    /// Evaluations of the field, shadows included, those for normals not.
    pub evals_per_pixel: Option<EvaluationCounts>,
    /// Evaluations of leaves.
    pub leaf_evals_per_pixel: Option<LeafEvaluations>,
    /// Turns of the interpreter's loop at each evaluation; none in a shader without one.
    pub turns_per_eval: Option<usize>,
    /// Pixels that differ from those of `specialized`, edges left out.
    pub differing_pixels: Option<usize>,
    /// Why figures are null, by their keys.
    #[serde(skip_serializing_if = "Why::is_empty")]
    pub why: Why,
}

/// A variant that draws.
struct Contestant {
    name: &'static str,
    pipeline: Pipeline,
    uniforms: Vec<[f32; 4]>,
    compile: CompileTimes,
    first_picture: f64,
    options: RenderOptions,
    image: Image,
    leaves: usize,
    turns: Option<usize>,
    times: Vec<f64>,
}

/// What all variants of a row share.
struct Heat<'a> {
    scene: &'a Scene,
    gpu: &'a Gpu,
    options: &'a BenchOptions,
    frame: FrameValues,
    view: View,
}

impl Scene {
    /// Measures the scene at its params' defaults: after a first frame of every variant, which is not timed,
    /// one frame of each in turn, then the next of each. All are unpainted and take normals by differences.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`], [`Error::View`], [`Error::Codegen`], [`Error::Render`].
    pub fn bench(
        &self,
        name: &str,
        gpu: &Gpu,
        options: &BenchOptions,
        progress: &mut OnProgress<'_>,
    ) -> Result<BenchRow, Error> {
        if !self.draws() {
            return Err(Error::NothingDrawn);
        }
        let frame = FrameValues::defaults(self.params());
        let view = View::new(self.program(), &frame, self.bounds_at(&frame), options.size)?;
        let heat = Heat { scene: self, gpu, options, frame, view };
        let units = baseline::units(self.graph(), &heat.frame);
        let tape = baseline::tape(self.program(), self.report().leaves, &heat.frame);
        let entries = [
            ("units", FieldSource::Units, Some(units)),
            ("tape", FieldSource::Tape, Some(tape)),
            (REFERENCE, FieldSource::Distance, None),
        ];
        let frames = u64::from(options.repetitions.max(1) + 1) * entries.len() as u64;
        let mut counted = Counted { frames, drawn: 0, progress };
        let (mut contestants, mut missing) = (Vec::new(), Vec::new());
        for (name, field, encoded) in entries {
            match encoded.transpose() {
                Ok(encoded) => contestants.push(heat.enter(name, field, encoded, &mut counted)?),
                Err(Inexpressible(reason)) => missing.push(BenchVariant::missing(name, &reason)),
            }
        }
        for _ in 0..options.repetitions.max(1) {
            for contestant in &mut contestants {
                let frame = heat.draw(contestant, &mut counted)?;
                contestant.times.push(frame.milliseconds);
            }
        }
        let reason = "literals as slots are not built";
        missing.push(BenchVariant::missing("specialized-slots", reason));
        let mut variants = heat.results(contestants);
        variants.extend(missing);
        variants.sort_by_key(|variant| ORDER.iter().position(|name| *name == variant.name));
        Ok(BenchRow {
            scene: name.to_owned(),
            leaves: self.report().leaves,
            size: options.size,
            method: options.method.clone(),
            variants,
        })
    }
}

/// Names of the variants, in the order of a row.
const ORDER: [&str; 4] = ["units", "tape", REFERENCE, "specialized-slots"];

impl Heat<'_> {
    /// Compiles a variant and draws its first frame.
    fn enter(
        &self,
        name: &'static str,
        field: FieldSource,
        encoded: Option<Encoded>,
        counted: &mut Counted<'_, '_>,
    ) -> Result<Contestant, Error> {
        let start = Instant::now();
        let shader = measured_module(self.scene.program(), &self.options.method, field)?;
        let validate = shader.validation_time().as_secs_f64() * 1e3;
        let lower = milliseconds(start) - validate;
        let uniforms = match encoded {
            Some(_) => Vec::new(),
            None => uniform_values(self.scene.program(), &self.frame),
        };
        let tables = encoded.as_ref().map_or(&[][..], |encoded| &encoded.tables);
        let pipeline = Pipeline::with_tables(self.gpu, shader, uniforms.len(), tables)?;
        let times = self.scene.times();
        let compile = CompileTimes {
            front: Some(times.front),
            analyze: Some(times.analyze),
            lower: Some(lower),
            validate: Some(validate),
            pipeline: Some(pipeline.milliseconds()),
            ..CompileTimes::default()
        };
        let options = RenderOptions::default();
        let first = counted.draw(&pipeline, &self.view, &uniforms, &options)?;
        let whole = TileSize::Fixed(self.options.size);
        let tile_size = if first.milliseconds < ONE_TILE { whole } else { options.tile_size };
        Ok(Contestant {
            name,
            pipeline,
            uniforms,
            compile,
            first_picture: times.front + times.analyze + milliseconds(start),
            options: RenderOptions { tile_size },
            image: first.image,
            leaves: encoded.as_ref().map_or(self.scene.report().leaves, |encoded| encoded.leaves),
            turns: encoded.map(|encoded| encoded.turns),
            times: Vec::new(),
        })
    }

    fn draw(&self, contestant: &Contestant, counted: &mut Counted<'_, '_>) -> Result<Frame, Error> {
        let Contestant { pipeline, uniforms, options, .. } = contestant;
        counted.draw(pipeline, &self.view, uniforms, options)
    }

    fn results(&self, contestants: Vec<Contestant>) -> Vec<BenchVariant> {
        let clock = if self.gpu.has_timestamps() {
            sdfc_render::Clock::Gpu
        } else {
            sdfc_render::Clock::Wall
        };
        let reference = contestants.iter().find(|contestant| contestant.name == REFERENCE);
        let median = |contestant: &Contestant| FrameTimes::of(&contestant.times, clock);
        let base = reference.and_then(median).map(|times| times.median);
        let result = |contestant: &Contestant| {
            let frame_ms = median(contestant);
            let evals = EvaluationCounts::of(&contestant.image);
            let ratio = frame_ms.and_then(|times| Some(times.median / base?));
            let mut variant = BenchVariant {
                name: contestant.name,
                frame_ms,
                times_specialized: ratio,
                compile_ms: Some(contestant.compile.clone()),
                first_picture_ms: Some(contestant.first_picture),
                evals_per_pixel: Some(evals),
                leaf_evals_per_pixel: Some(LeafEvaluations::of_all_leaves(
                    evals,
                    contestant.leaves,
                )),
                turns_per_eval: contestant.turns,
                differing_pixels: reference
                    .map(|other| self.differing(&contestant.image, &other.image)),
                why: Why::new(),
            };
            variant.refuse_another_picture(self.options.size);
            variant
        };
        contestants.iter().map(result).collect()
    }

    /// Pixels that are no edge in either picture and show different things.
    fn differing(&self, a: &Image, b: &Image) -> usize {
        let near = (TOLERANCES * self.view.epsilon) as f32;
        let edges = edges(a).into_iter().zip(edges(b)).map(|(a, b)| a || b);
        let pairs = a.pixels().iter().zip(b.pixels()).zip(edges);
        let differ = pairs.filter(|((a, b), edge)| match [a, b].map(|pixel| pixel.status == HIT) {
            // What is not finite is not near.
            [true, true] if (a.depth - b.depth).abs() <= near => false,
            [false, false] => false,
            [true, true] | [true, false] | [false, true] => !edge,
        });
        differ.count()
    }
}

/// Tells how far all frames are.
struct Counted<'a, 'b> {
    frames: u64,
    drawn: u64,
    progress: &'a mut OnProgress<'b>,
}

impl Counted<'_, '_> {
    fn draw(
        &mut self,
        pipeline: &Pipeline,
        view: &View,
        uniforms: &[[f32; 4]],
        options: &RenderOptions,
    ) -> Result<Frame, Error> {
        let Self { frames, drawn, progress } = self;
        let frame = pipeline.render(view, uniforms, options, &mut |part| {
            let Progress { done, total } = part;
            progress(Progress { done: *drawn * total + done, total: *frames * total })
        })?;
        self.drawn += 1;
        Ok(frame)
    }
}

impl BenchVariant {
    /// All of whose figures cannot be had, for one reason.
    fn missing(name: &'static str, reason: &str) -> Self {
        let keys = [
            "frame_ms",
            "times_specialized",
            "compile_ms",
            "first_picture_ms",
            "evals_per_pixel",
            "leaf_evals_per_pixel",
            "turns_per_eval",
            "differing_pixels",
        ];
        Self {
            name,
            frame_ms: None,
            times_specialized: None,
            compile_ms: None,
            first_picture_ms: None,
            evals_per_pixel: None,
            leaf_evals_per_pixel: None,
            turns_per_eval: None,
            differing_pixels: None,
            why: keys.map(|key| (key, reason.to_owned())).into(),
        }
    }

    /// The time of another picture says nothing.
    fn refuse_another_picture(&mut self, [width, height]: [u32; 2]) {
        if self.turns_per_eval.is_none() {
            self.why.insert("turns_per_eval", "the field is not interpreted".to_owned());
        }
        let pixels = u64::from(width) * u64::from(height);
        let differing = self.differing_pixels.unwrap_or(0);
        if differing as f64 <= MAX_DIFFERING * pixels as f64 {
            return;
        }
        let reason = format!(
            "another picture: {differing} of {pixels} pixels differ from `{REFERENCE}`; software \
             drivers end the loops of an invocation after a number of turns, Mesa 22.3 after 65,535"
        );
        let evaluations = &mut self.evals_per_pixel;
        (self.frame_ms, self.times_specialized, self.first_picture_ms) = (None, None, None);
        (*evaluations, self.leaf_evals_per_pixel) = (None, None);
        for key in [
            "frame_ms",
            "times_specialized",
            "first_picture_ms",
            "evals_per_pixel",
            "leaf_evals_per_pixel",
        ] {
            self.why.insert(key, reason.clone());
        }
    }
}
