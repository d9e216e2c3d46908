//! Compares the speed of the specialised shader with shaders that interpret the scene.

mod candidate;
mod kind;
mod options;
mod report;
mod setup;
mod suite;

use cpu_time::ProcessTime;
use sdfc::{Error, Scene};
use sdfc_render::{EvaluationCounts, FrameTimes, Gpu, HIT, OnProgress, Why, edges};

use crate::baseline::Inexpressible;
use crate::error::MeasureError;
use candidate::{Candidate, FrameCounter};
use kind::Kind;
use report::times_best;
use setup::Setup;

pub use options::BenchOptions;
pub use report::{BenchReport, BenchRow, BenchVariant};
pub use suite::{large_suite, suite};

/// Hits whose depths differ by more tolerances than this are different. Rounding alone may make a
/// ray take one step more, which is at most about one tolerance long.
const MAX_DEPTH_TOLERANCES: f64 = 4.0;
/// A picture that differs in a greater fraction of its pixels, without edges, is refused.
const MAX_DIFFERING: f64 = 1e-3;

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
    scene.needs_solids("a benchmark of rays")?;
    let setup = Setup::new(scene, live, gpu, options)?;
    let repetitions = options.repetitions.max(1);
    let frames = u64::from(repetitions + 1) * Kind::ALL.len() as u64;
    let mut counter = FrameCounter { frames, drawn: 0, progress };
    // A variant that takes minutes to compile cannot be the reference.
    let first = if setup.is_unrolled() { Kind::Specialized } else { Kind::Culled };
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

impl Setup<'_> {
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
            live_literals: self
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
