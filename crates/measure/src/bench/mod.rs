//! Compares the speed of the specialised shader with shaders that interpret the scene.

mod suite;

use std::time::Instant;

use cpu_time::ProcessTime;
use sdfc::{Error, Method, Scene};
use sdfc_analyze::{LoopStrategy, cost, prepare_with};
use sdfc_codegen::{FieldSource, benchmark_module, instrumented_module};
use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;
use sdfc_render::{
    CompileTimes, EvaluationCounts, Frame, FrameTimes, Gpu, HIT, Image, LeafEvaluations,
    OnProgress, Pipeline, Progress, RenderOptions, TileSize, View, Why, edges, milliseconds_since,
    uniform_values,
};
use serde::Serialize;

use crate::baseline::{self, Encoded, Inexpressible};
use crate::error::MeasureError;

pub use suite::{large_suite, suite};

/// The variant that the others are compared with.
const REFERENCE: &str = "specialized";
/// Hits whose depths differ by more tolerances than this are different. Rounding alone may make a
/// ray take one step more, which is at most about one tolerance long.
const MAX_DEPTH_TOLERANCES: f64 = 4.0;
/// A picture that differs in a greater fraction of its pixels, without edges, is refused.
const MAX_DIFFERING: f64 = 1e-3;
/// A frame that takes longer, in milliseconds, is drawn in tiles, so that no driver resets the GPU.
const MAX_SINGLE_TILE_MS: f64 = 1000.0;
/// Slow variants, and those that compile slowly, are not measured on scenes with more leaves.
const MAX_INTERPRETED_LEAVES: usize = 300;
/// Loops without culling are not measured on scenes with more leaves.
const MAX_UNCULLED_LEAVES: usize = 2000;
/// A field with more operations is not measured unrolled: with normals by its gradient, and by
/// differences.
const MAX_UNROLLED_OPERATIONS: [usize; 2] = [5000, 14_000];
/// A frame that takes longer, in milliseconds, is timed once.
const MAX_REPEATED_MS: f64 = 10_000.0;

/// Options of [`bench()`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BenchOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Number of timed frames per variant, after one that is not timed; at least 1. Only one if
    /// frames take longer than ten seconds.
    pub repetitions: u32,
    /// Ray method of all variants.
    pub method: Method,
    /// True if interpreters and live literals are measured too. Then all variants draw without
    /// materials and take normals by differences, as interpreters must; otherwise each draws the
    /// picture of `sdfc render`.
    pub baselines: bool,
}

impl BenchOptions {
    /// The default options: 640 by 360 pixels, five frames, the method `sphere`, with baselines.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets width and height in pixels.
    #[must_use]
    pub fn size(self, size: [u32; 2]) -> Self {
        Self { size, ..self }
    }

    /// Sets the number of timed frames.
    #[must_use]
    pub fn repetitions(self, repetitions: u32) -> Self {
        Self { repetitions, ..self }
    }

    /// Sets if interpreters and live literals are measured too.
    #[must_use]
    pub fn baselines(self, baselines: bool) -> Self {
        Self { baselines, ..self }
    }
}

impl Default for BenchOptions {
    /// As [`BenchOptions::new`]; `sphere` is the method of the op-unit interpreter.
    fn default() -> Self {
        Self { size: [640, 360], repetitions: 5, method: Method::Sphere, baselines: true }
    }
}

/// The results, as `bench --json` writes them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchReport {
    /// Name of the GPU.
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
    /// The variant that `sdfc render` uses by default.
    pub auto: &'static str,
    /// Its frame time relative to the fastest variant (CPU time where measured).
    pub auto_times_best_frame: Option<f64>,
    /// Its time to the first picture relative to the fastest variant.
    pub auto_times_best_first_picture: Option<f64>,
    /// One for each way to evaluate the field.
    pub variants: Vec<BenchVariant>,
}

/// One way to evaluate the field. A value that is not available is null, with the reason in `why`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchVariant {
    /// `units`, `tape`, `specialized`, `specialized-slots`, `rolled` or `pruned`.
    pub name: &'static str,
    /// Time of one frame without compilation.
    pub frame_ms: Option<FrameTimes>,
    /// Median frame time relative to `specialized`.
    pub times_specialized: Option<f64>,
    /// Median CPU time of this process per frame, for a software GPU. Other processes do not count.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cpu_ms: Option<f64>,
    /// CPU time relative to `specialized`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cpu_times_specialized: Option<f64>,
    /// Stages of compilation; encoding the tables is part of `lower`.
    pub compile_ms: Option<CompileTimes>,
    /// From reading the scene to its first finished picture, in milliseconds.
    pub first_picture_ms: Option<f64>,
    /// Field evaluations, including shadows, without normals.
    pub evals_per_pixel: Option<EvaluationCounts>,
    /// Evaluations of leaves.
    pub leaf_evals_per_pixel: Option<LeafEvaluations>,
    /// Iterations of the interpreter's loop per evaluation; null without an interpreter.
    pub iterations_per_eval: Option<usize>,
    /// Number of live literals, for `specialized-slots` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slots: Option<usize>,
    /// Pixels that differ from those of `specialized`, without edges.
    pub differing_pixels: Option<usize>,
    /// Why values are null, by their keys.
    #[serde(skip_serializing_if = "Why::is_empty")]
    pub why: Why,
}

/// How a variant evaluates the field.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Units,
    Tape,
    Specialized,
    LiveLiterals,
    /// Loops over similar parts, with all iterations.
    Rolled,
    /// The same; primary rays use the active lists of their tiles.
    Pruned,
}

impl Kind {
    /// The order is that of a row.
    const ALL: [Self; 6] = [
        Self::Units,
        Self::Tape,
        Self::Specialized,
        Self::LiveLiterals,
        Self::Rolled,
        Self::Pruned,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Units => "units",
            Self::Tape => "tape",
            Self::Specialized => REFERENCE,
            Self::LiveLiterals => "specialized-slots",
            Self::Rolled => "rolled",
            Self::Pruned => "pruned",
        }
    }

    fn field(self, by_differences: bool) -> FieldSource {
        match self {
            Self::Units => FieldSource::Units,
            Self::Tape => FieldSource::Tape,
            Self::Specialized | Self::LiveLiterals | Self::Rolled | Self::Pruned => {
                match by_differences {
                    true => FieldSource::Distance,
                    false => FieldSource::Scene,
                }
            }
        }
    }
}

/// A variant that is measured.
struct Candidate {
    kind: Kind,
    pipeline: Pipeline,
    uniforms: Vec<[f32; 4]>,
    compile: CompileTimes,
    first_picture: f64,
    options: RenderOptions,
    /// Number of timed frames.
    repetitions: u32,
    image: Image,
    leaf_evaluations: LeafEvaluations,
    iterations: Option<usize>,
    times: Vec<f64>,
    /// CPU time of each, for a software GPU.
    cpu: Vec<f64>,
}

/// The data of a variant, without the view.
enum Data {
    Encoded(Encoded),
    Uniforms(Vec<[f32; 4]>),
}

/// The data that all variants of a row share.
struct Setup<'a> {
    scene: &'a Scene,
    live: Result<&'a Scene, &'a str>,
    gpu: &'a Gpu,
    options: &'a BenchOptions,
    view: View,
    /// The unrolled field.
    unrolled: Program,
    /// The field with loops, without and with culling. `None` if no parts are similar.
    rolled: Option<Program>,
    pruned: Option<Program>,
    /// The variant that [`LoopStrategy::Auto`] chooses.
    auto: Kind,
}

/// Measures the scene at its params' defaults. First each variant draws one frame that is not
/// timed. Then the variants draw one timed frame each in turn, as often as repetitions are asked
/// for.
///
/// `live` is the same scene compiled with live literals, or the reason why there is none.
///
/// # Errors
///
/// [`MeasureError::Scene`] for a failure of the scene or the machine.
pub fn bench(
    scene: &Scene,
    live: Result<&Scene, &str>,
    name: &str,
    gpu: &Gpu,
    options: &BenchOptions,
    progress: &mut OnProgress<'_>,
) -> Result<BenchRow, MeasureError> {
    if !scene.draws() {
        return Err(Error::NothingDrawn.into());
    }
    let setup = Setup::new(scene, live, gpu, options)?;
    let repetitions = options.repetitions.max(1);
    let frames = u64::from(repetitions + 1) * Kind::ALL.len() as u64;
    let mut counter = FrameCounter { frames, drawn: 0, progress };
    // A variant that takes minutes to compile cannot be the reference.
    let first = if setup.is_unrolled() { Kind::Specialized } else { Kind::Pruned };
    let reference = match setup.draw_first(first, &mut counter)? {
        Ok(candidate) => candidate,
        Err(Inexpressible(why)) => return Err(MeasureError::Inexpressible(why)),
    };
    let (mut candidates, mut variants) = (Vec::new(), Vec::new());
    for kind in Kind::ALL.into_iter().filter(|kind| *kind != first) {
        match setup.draw_first(kind, &mut counter)? {
            Ok(candidate) if setup.refusal(&candidate, &reference).is_none() => {
                candidates.push(candidate);
                continue;
            }
            Ok(candidate) => variants.push(setup.result(&candidate, &reference)),
            Err(Inexpressible(why)) => variants.push(BenchVariant::missing(kind.name(), &why)),
        }
        counter.frames -= u64::from(repetitions);
    }
    candidates.push(reference);
    for repetition in 0..repetitions {
        for candidate in
            candidates.iter_mut().filter(|candidate| repetition < candidate.repetitions)
        {
            let start = ProcessTime::try_now().ok().filter(|_| gpu.info().software);
            let frame = setup.draw(candidate, &mut counter)?;
            candidate.times.push(frame.milliseconds);
            let cpu = start.and_then(|start| start.try_elapsed().ok());
            candidate.cpu.extend(cpu.map(|time| time.as_secs_f64() * 1e3));
        }
    }
    if let Some(reference) = candidates.last() {
        variants.extend(candidates.iter().map(|candidate| setup.result(candidate, reference)));
    }
    let index = |name| Kind::ALL.iter().position(|kind| kind.name() == name);
    variants.sort_by_key(|variant| index(variant.name));
    let auto = setup.auto.name();
    let frame =
        |variant: &BenchVariant| variant.cpu_ms.or(variant.frame_ms.map(|times| times.median));
    Ok(BenchRow {
        scene: name.to_owned(),
        leaves: scene.report().leaves,
        size: options.size,
        method: options.method.name().to_owned(),
        auto,
        auto_times_best_frame: times_best(&variants, auto, frame),
        auto_times_best_first_picture: times_best(&variants, auto, |v| v.first_picture_ms),
        variants,
    })
}

/// Returns a metric of a variant relative to the smallest of all variants.
fn times_best(
    variants: &[BenchVariant],
    name: &str,
    metric: impl Fn(&BenchVariant) -> Option<f64>,
) -> Option<f64> {
    let own = metric(variants.iter().find(|variant| variant.name == name)?)?;
    let best = variants.iter().filter_map(&metric).reduce(f64::min)?;
    Some(own / best)
}

impl<'a> Setup<'a> {
    fn new(
        scene: &'a Scene,
        live: Result<&'a Scene, &'a str>,
        gpu: &'a Gpu,
        options: &'a BenchOptions,
    ) -> Result<Self, MeasureError> {
        let prepared = |strategy| prepare_with(scene.graph(), [0.0; 3], strategy);
        let unrolled = prepared(LoopStrategy::Unrolled)?.program;
        let found = prepared(LoopStrategy::Looped)?;
        let pruned = Some(found.program).filter(|_| !found.report.loops.is_empty());
        let rolled =
            pruned.clone().map(|program| Program { cullable_loops: Vec::new(), ..program });
        let pruned = pruned.filter(|program| !program.cullable_loops.is_empty());
        let frame = FrameValues::defaults(scene.params());
        let seen = pruned.as_ref().unwrap_or(&unrolled);
        let view = View::new(seen, &frame, scene.bounds_at(&frame), options.size)?;
        let auto = match (scene.report().loops.is_empty(), pruned.is_some()) {
            (true, _) => Kind::Specialized,
            (false, true) => Kind::Pruned,
            (false, false) => Kind::Rolled,
        };
        Ok(Self { scene, live, gpu, options, view, unrolled, rolled, pruned, auto })
    }

    /// Returns true if the unrolled field compiles in reasonable time.
    fn is_unrolled(&self) -> bool {
        self.pruned.is_none()
            || cost(&self.unrolled.graph, self.unrolled.distance.as_slice()).operations
                <= self.max_operations()
    }

    fn max_operations(&self) -> usize {
        MAX_UNROLLED_OPERATIONS[usize::from(self.options.baselines)]
    }

    /// Returns the program that a variant is compiled from.
    fn program(&self, kind: Kind) -> Result<&Program, Inexpressible> {
        fn alike(program: &Option<Program>) -> Result<&Program, Inexpressible> {
            let why = "few of its parts are similar, or have no Lipschitz constant";
            program.as_ref().ok_or_else(|| Inexpressible(why.to_owned()))
        }
        let leaves = self.scene.report().leaves;
        match kind {
            Kind::Units | Kind::Tape | Kind::LiveLiterals if !self.options.baselines => {
                Err(Inexpressible("left out".to_owned()))
            }
            Kind::Units | Kind::Tape | Kind::LiveLiterals if leaves > MAX_INTERPRETED_LEAVES => {
                let why = format!("over {MAX_INTERPRETED_LEAVES} leaves, which take it minutes");
                Err(Inexpressible(why))
            }
            Kind::Specialized if !self.is_unrolled() => {
                let most = self.max_operations();
                let why = format!("over {most} operations, which take minutes to compile");
                Err(Inexpressible(why))
            }
            Kind::Units | Kind::Tape | Kind::Specialized => Ok(&self.unrolled),
            Kind::LiveLiterals => match self.live {
                Ok(live) => Ok(live.program()),
                Err(why) => Err(Inexpressible(why.to_owned())),
            },
            Kind::Rolled if leaves > MAX_UNCULLED_LEAVES => {
                let why =
                    format!("over {MAX_UNCULLED_LEAVES} leaves, all of which it visits each time");
                Err(Inexpressible(why))
            }
            Kind::Rolled => alike(&self.rolled),
            Kind::Pruned => alike(&self.pruned),
        }
    }

    /// Compiles a variant and draws its first frame. Returns [`Inexpressible`] if the variant
    /// cannot express the scene.
    fn draw_first(
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
            options: RenderOptions { tile_size },
            repetitions: if once { 1 } else { self.options.repetitions.max(1) },
            leaf_evaluations: match &data {
                Data::Uniforms(uniforms) if kind == Kind::Pruned => {
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
        let options = RenderOptions { tile_size: TileSize::Fixed(self.options.size) };
        let frame = counter.draw(&pipeline, &self.view, uniforms, &options)?;
        counter.drawn -= 1;
        let visited = EvaluationCounts::of(&frame.image).mean;
        let before = frame.culling_evaluations as f64 / frame.image.pixels().len() as f64;
        Ok(LeafEvaluations { mean: Some(visited + before), ..LeafEvaluations::default() })
    }

    fn draw(
        &self,
        candidate: &Candidate,
        counter: &mut FrameCounter<'_, '_>,
    ) -> Result<Frame, MeasureError> {
        let Candidate { pipeline, uniforms, options, .. } = candidate;
        counter.draw(pipeline, &self.view, uniforms, options)
    }

    /// Returns the results of a variant; null if its picture differs from the reference.
    fn result(&self, candidate: &Candidate, reference: &Candidate) -> BenchVariant {
        let clock = if self.gpu.has_timestamps() {
            sdfc_render::Clock::Gpu
        } else {
            sdfc_render::Clock::Wall
        };
        let frame_ms = FrameTimes::of(&candidate.times, clock);
        let median = |times: &[f64]| FrameTimes::of(times, clock).map(|times| times.median);
        let ratio =
            |of: fn(&Candidate) -> &[f64]| Some(median(of(candidate))? / median(of(reference))?);
        let evals = EvaluationCounts::of(&candidate.image);
        let mut variant = BenchVariant {
            name: candidate.kind.name(),
            frame_ms,
            times_specialized: ratio(|candidate| &candidate.times),
            cpu_ms: median(&candidate.cpu),
            cpu_times_specialized: ratio(|candidate| &candidate.cpu),
            compile_ms: Some(candidate.compile.clone()),
            first_picture_ms: Some(candidate.first_picture),
            evals_per_pixel: Some(evals),
            leaf_evals_per_pixel: Some(candidate.leaf_evaluations.clone()),
            iterations_per_eval: candidate.iterations,
            slots: self
                .live
                .ok()
                .filter(|_| candidate.kind == Kind::LiveLiterals)
                .map(|live| live.live_literals().len()),
            differing_pixels: Some(self.differing(candidate, reference)),
            why: Why::new(),
        };
        if candidate.iterations.is_none() {
            variant.why.insert("iterations_per_eval", "the field is not interpreted".to_owned());
        }
        if let Some(reason) = self.refusal(candidate, reference) {
            variant.refuse(&reason);
        }
        variant
    }

    /// Returns why the time of a variant is meaningless, if its picture differs from the reference.
    fn refusal(&self, candidate: &Candidate, reference: &Candidate) -> Option<String> {
        let differing = self.differing(candidate, reference);
        let pixels = candidate.image.pixels().len();
        if differing as f64 <= MAX_DIFFERING * pixels as f64 {
            return None;
        }
        Some(format!(
            "another picture: {differing} of {pixels} pixels differ; software drivers end the loops of \
             an invocation after a number of iterations, Mesa 22.3 after 65,535"
        ))
    }

    /// Counts pixels that differ and are no edge in either picture.
    fn differing(&self, candidate: &Candidate, reference: &Candidate) -> usize {
        let (a, b) = (&candidate.image, &reference.image);
        let near = (MAX_DEPTH_TOLERANCES * self.view.epsilon) as f32;
        let edges = edges(a).into_iter().zip(edges(b)).map(|(a, b)| a || b);
        let pairs = a.pixels().iter().zip(b.pixels()).zip(edges);
        let differ = pairs.filter(|((a, b), edge)| match [a, b].map(|pixel| pixel.status == HIT) {
            // NaN and infinities count as different.
            [true, true] if (a.depth - b.depth).abs() <= near => false,
            [false, false] => false,
            [true, true] | [true, false] | [false, true] => !edge,
        });
        differ.count()
    }
}

/// Returns the data of a variant at the scene's defaults.
fn data(kind: Kind, scene: &Scene, program: &Program) -> Result<Data, Inexpressible> {
    let frame = FrameValues::defaults(scene.params());
    let uniforms = || Data::Uniforms(uniform_values(program, &frame));
    match kind {
        Kind::Units => baseline::units(scene.graph(), &frame).map(Data::Encoded),
        Kind::Tape => baseline::tape(program, scene.report().leaves, &frame).map(Data::Encoded),
        Kind::Specialized | Kind::Rolled | Kind::Pruned => Ok(uniforms()),
        Kind::LiveLiterals if scene.live_literals().is_empty() => {
            Err(Inexpressible("no number of the scene can move".to_owned()))
        }
        Kind::LiveLiterals => Ok(uniforms()),
    }
}

/// Counts frames for the progress report.
struct FrameCounter<'a, 'b> {
    frames: u64,
    drawn: u64,
    progress: &'a mut OnProgress<'b>,
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

impl BenchVariant {
    /// Returns a variant without results, for one reason.
    fn missing(name: &'static str, reason: &str) -> Self {
        let keys = [
            "frame_ms",
            "times_specialized",
            "compile_ms",
            "first_picture_ms",
            "evals_per_pixel",
            "leaf_evals_per_pixel",
            "iterations_per_eval",
            "differing_pixels",
        ];
        Self {
            name,
            frame_ms: None,
            times_specialized: None,
            cpu_ms: None,
            cpu_times_specialized: None,
            compile_ms: None,
            first_picture_ms: None,
            evals_per_pixel: None,
            leaf_evals_per_pixel: None,
            iterations_per_eval: None,
            slots: None,
            differing_pixels: None,
            why: keys.map(|key| (key, reason.to_owned())).into(),
        }
    }

    /// Removes meaningless results.
    fn refuse(&mut self, reason: &str) {
        (self.frame_ms, self.times_specialized, self.first_picture_ms) = (None, None, None);
        (self.cpu_ms, self.cpu_times_specialized) = (None, None);
        (self.evals_per_pixel, self.leaf_evals_per_pixel) = (None, None);
        for key in [
            "frame_ms",
            "times_specialized",
            "first_picture_ms",
            "evals_per_pixel",
            "leaf_evals_per_pixel",
        ] {
            self.why.insert(key, reason.to_owned());
        }
    }
}
