//! The thread that compares what is shown with the oracle: how many rays missed a surface or met one that is not
//! there, and how far off their depths are; of the method that draws, or of all methods at all their settings.
//!
//! Only the newest case counts. It is compared at a reduced size, because a proof of each ray takes far longer than
//! marching it.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, PoisonError, RwLock};
use std::time::Instant;

use sdfc::accuracy_data::{Counts, Metrics};
use sdfc::codegen::render_module_with_camera;
use sdfc::march::{METHODS, MethodDefinition};
use sdfc::render::{
    Frame, Gpu, Pipeline, Pose, Progress, RenderError, RenderOptions, View, milliseconds_since,
    uniform_values,
};
use sdfc::{Comparison, Error, FrameValues};

use crate::mailbox::{Attendant, Mailbox};
use crate::model::{Engine, Model};

/// Most pixels of a picture that is compared.
const MOST_PIXELS: f64 = 24_000.0;
/// Progress is told in so many parts.
const PARTS: u32 = 1000;

/// What is to be compared.
#[derive(Clone, Debug)]
pub struct Case {
    /// The scene.
    pub model: Arc<Model>,
    /// The values of its params, and the time.
    pub frame: FrameValues,
    /// From where.
    pub pose: Pose,
    /// Width and height of what is shown, in pixels.
    pub size: [u32; 2],
    /// The knob of the method, as a multiple of the scene's.
    pub tolerance: f64,
    /// Whether all methods are, beside the one that draws.
    pub all: bool,
}

impl Case {
    /// Whether the same is seen, whatever draws it.
    pub fn sees(&self, other: &Self) -> bool {
        self.model.content == other.model.content
            && self.size == other.size
            && self.pose == other.pose
            && self.frame == other.frame
    }

    /// Whether the same rays are marched in the same way.
    pub fn draws_as(&self, other: &Self) -> bool {
        self.sees(other)
            && self.model.serial == other.model.serial
            && self.tolerance == other.tolerance
    }

    /// The size at which it is compared: the same shape, of so many pixels that the oracle need not be waited for long.
    pub fn reduced(&self) -> [u32; 2] {
        let [width, height] = self.size.map(f64::from);
        let scale = (MOST_PIXELS / (width * height).max(1.0)).sqrt().min(1.0);
        [width, height].map(|side| ((side * scale).round() as u32).max(1))
    }
}

/// A method at one setting against the oracle.
#[derive(Clone, Debug)]
pub struct Figures {
    /// Which method.
    pub method: String,
    /// Its knob, as a multiple of the scene's.
    pub part: f64,
    /// How far off it is.
    pub metrics: Metrics,
    /// Operations of the field's formula for each pixel.
    pub operations: f64,
    /// What the picture took, in milliseconds.
    pub milliseconds: f64,
}

impl Figures {
    /// Pixels that are wrong or were given up.
    pub fn failed(&self) -> u64 {
        let metrics = &self.metrics;
        metrics.missed + metrics.false_hits + metrics.nan + metrics.capped
    }

    /// Whether it is at least as good in all that counts, and better in something.
    fn beats(&self, other: &Self) -> bool {
        let figures = |of: &Self| [of.operations, of.failed() as f64, of.metrics.depth.pixels.p99];
        let (mine, others) = (figures(self), figures(other));
        mine != others && mine.iter().zip(&others).all(|(a, b)| a <= b)
    }
}

/// What came of a case, so far.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The case.
    pub case: Arc<Case>,
    /// Width and height that were compared.
    pub size: [u32; 2],
    /// What the oracle says.
    pub counts: Counts,
    /// Of what is shown.
    pub shown: Figures,
    /// Of methods and settings, as far as they were drawn.
    pub all: Vec<Figures>,
    /// Methods that could not be, and why.
    pub refused: Vec<String>,
    /// From taking the case, in milliseconds.
    pub milliseconds: f64,
    /// Whether nothing more comes.
    pub finished: bool,
}

impl Judgement {
    /// Whether nothing that was compared is better in cost and accuracy than this one of [`Self::all`].
    pub fn is_best(&self, figures: &Figures) -> bool {
        !self.all.iter().any(|other| other.beats(figures))
    }
}

/// What the judge tells.
#[derive(Debug)]
pub enum Judged {
    /// Figures, perhaps not yet all.
    Judgement(Box<Judgement>),
    /// There are none; why.
    Failed(String),
    /// What was being compared is given up.
    Cancelled,
}

/// The thread, as others see it.
#[derive(Debug)]
pub struct Judge {
    cases: Attendant<Option<Case>>,
    progress: Arc<Reached>,
}

/// How far it is.
#[derive(Debug, Default)]
struct Reached {
    busy: AtomicBool,
    part: AtomicU32,
    what: RwLock<&'static str>,
}

impl Judge {
    /// Starts it. `wake` is called when there is something to tell.
    ///
    /// # Errors
    ///
    /// Where the system gives no thread.
    pub fn new(
        to: Sender<Judged>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> std::io::Result<Self> {
        let progress = Arc::new(Reached::default());
        let reached = Arc::clone(&progress);
        let begin = |cases| {
            let mut court = Court::new(cases, reached, to, Box::new(wake));
            move |order| court.serve(order)
        };
        Ok(Self { cases: Attendant::start("judge", begin)?, progress })
    }

    /// Has a case compared in place of whatever is being compared.
    pub fn ask(&self, case: Case) {
        self.progress.busy.store(true, Ordering::Relaxed);
        self.cases.mailbox().put(Some(case));
    }

    /// Gives up what is being compared.
    pub fn cancel(&self) {
        self.cases.mailbox().put(None);
    }

    /// The part that is done, 0 to 1, of what; `None` where nothing is to be done.
    pub fn progress(&self) -> Option<(f32, &'static str)> {
        if !self.progress.busy.load(Ordering::Relaxed) {
            return None;
        }
        let part = self.progress.part.load(Ordering::Relaxed) as f32 / PARTS as f32;
        // A word, replaced whole.
        Some((part, *self.progress.what.read().unwrap_or_else(PoisonError::into_inner)))
    }
}

/// A view that the oracle was asked about, and what all methods make of it as far as that was asked.
struct Compared {
    case: Arc<Case>,
    comparison: Comparison,
    all: Vec<Figures>,
    refused: Vec<String>,
}

/// What the thread keeps between cases.
struct Court {
    cases: Arc<Mailbox<Option<Case>>>,
    progress: Arc<Reached>,
    wake: Box<dyn Fn() + Send + Sync>,
    to: Sender<Judged>,
    /// The last view that the oracle was asked about.
    compared: Option<Compared>,
    /// A device of its own, since one that compiles holds up what else is drawn on it.
    gpu: Option<Gpu>,
    started: Instant,
}

impl Court {
    fn new(
        cases: Arc<Mailbox<Option<Case>>>,
        progress: Arc<Reached>,
        to: Sender<Judged>,
        wake: Box<dyn Fn() + Send + Sync>,
    ) -> Self {
        let started = Instant::now();
        Self { cases, progress, wake, to, compared: None, gpu: None, started }
    }

    /// Compares; `None` only ends what was being compared.
    fn serve(&mut self, order: Option<Case>) {
        if let Some(case) = order {
            self.guarded(Arc::new(case));
        }
        // One that came in meanwhile is not done.
        self.progress.busy.store(self.cases.calls(), Ordering::Relaxed);
        (self.wake)();
    }

    fn tell(&self, judged: Judged) {
        // The receiver is gone only where the window is.
        let _ = self.to.send(judged);
        (self.wake)();
    }

    /// A fault in a driver must not end all comparing.
    fn guarded(&mut self, case: Arc<Case>) {
        self.started = Instant::now();
        let judged = match catch_unwind(AssertUnwindSafe(|| self.judge(case))) {
            Ok(Ok(())) => return,
            Ok(Err(Error::Render(RenderError::Cancelled))) => Judged::Cancelled,
            Ok(Err(error)) => Judged::Failed(error.to_string()),
            Err(_) => Judged::Failed("the device driver failed while drawing".to_owned()),
        };
        self.gpu = None;
        self.tell(judged);
    }

    fn judge(&mut self, case: Arc<Case>) -> Result<(), Error> {
        let kept = self.compared.take().filter(|before| before.case.sees(&case));
        let mut compared = match kept {
            Some(before) => Compared { case, ..before },
            None => {
                let comparison = self.truth(&case)?;
                Compared { case, comparison, all: Vec::new(), refused: Vec::new() }
            }
        };
        let result = self.compare(&mut compared);
        self.compared = Some(compared);
        result
    }

    fn truth(&self, case: &Case) -> Result<Comparison, Error> {
        self.begin("asking the oracle");
        let scene = &case.model.scene;
        let bounds = scene.bounds_at(&case.frame);
        let view = View::from_pose(scene.drawn(), &case.frame, bounds, case.reduced(), &case.pose)?;
        scene.comparison(view, case.frame.clone(), &|progress| self.reached(progress))
    }

    fn compare(&mut self, compared: &mut Compared) -> Result<(), Error> {
        self.begin("drawing");
        let Compared { case, comparison, .. } = &*compared;
        let model = &case.model;
        let view = comparison.view().with_scaled_parameter(model.knob(), case.tolerance);
        let drawn = match &model.engine {
            Engine::Gpu(pipeline) => {
                let uniforms = uniform_values(model.marched(), &case.frame);
                self.draw(pipeline, &view, &uniforms)?
            }
            Engine::Cpu(scene) => {
                let options = RenderOptions::default();
                let mut watch = |progress| self.reached(progress);
                scene.render(&view, &case.frame, &model.method, &options, &mut watch)?
            }
        };
        let of = (model.method.as_str(), case.tolerance);
        let shown = figures(case, comparison, of, &drawn);
        if case.all {
            self.compare_all(compared, shown)
        } else {
            self.tell(Judged::Judgement(Box::new(self.judgement(compared, shown, true))));
            Ok(())
        }
    }

    fn judgement(&self, compared: &Compared, shown: Figures, finished: bool) -> Judgement {
        Judgement {
            case: Arc::clone(&compared.case),
            size: compared.comparison.view().size,
            counts: compared.comparison.counts(),
            shown,
            all: compared.all.clone(),
            refused: compared.refused.clone(),
            milliseconds: milliseconds_since(self.started),
            finished,
        }
    }

    /// Every method that there is, at every setting that a chart shows.
    fn compare_all(&mut self, compared: &mut Compared, shown: Figures) -> Result<(), Error> {
        (compared.all, compared.refused) = Default::default();
        self.tell(Judged::Judgement(Box::new(self.judgement(compared, shown.clone(), false))));
        self.begin("drawing with all methods");
        let gpu = self.gpu()?;
        for (done, method) in METHODS.iter().enumerate() {
            if let Err(error) = self.compare_method(&gpu, method, compared) {
                if matches!(error, Error::Render(RenderError::Cancelled)) {
                    return Err(error);
                }
                compared.refused.push(format!("{}: {error}", method.name));
            }
            let progress = Progress { done: done as u64 + 1, total: METHODS.len() as u64 };
            let finished = progress.done == progress.total;
            let judgement = self.judgement(compared, shown.clone(), finished);
            self.tell(Judged::Judgement(Box::new(judgement)));
            if !finished && self.reached(progress).is_break() {
                return Err(Error::Render(RenderError::Cancelled));
            }
        }
        Ok(())
    }

    fn compare_method(
        &self,
        gpu: &Gpu,
        method: &'static MethodDefinition,
        compared: &mut Compared,
    ) -> Result<(), Error> {
        let Compared { case, comparison, all, .. } = compared;
        let scene = &case.model.scene;
        // `auto` is shown under its own name also where it is another method.
        let marched = scene.marched(method.name);
        let shader =
            render_module_with_camera(&marched.program, &marched.method, case.pose.parallel)?;
        let pipeline = Pipeline::new(gpu, shader, marched.program.uniforms.len())?;
        let uniforms = uniform_values(&marched.program, &case.frame);
        for part in method.chart_factors {
            let view = comparison.view().with_scaled_parameter(method.parameter, *part);
            let drawn = self.draw(&pipeline, &view, &uniforms)?;
            all.push(figures(case, comparison, (method.name, *part), &drawn));
        }
        Ok(())
    }

    fn gpu(&mut self) -> Result<Gpu, Error> {
        if let Some(gpu) = &self.gpu {
            return Ok(gpu.clone());
        }
        let gpu = Gpu::new()?;
        Ok(self.gpu.insert(gpu).clone())
    }

    fn draw(
        &self,
        pipeline: &Pipeline,
        view: &View,
        uniforms: &[[f32; 4]],
    ) -> Result<Frame, Error> {
        let mut watch = |_| self.cancelled();
        Ok(pipeline.render(view, uniforms, &RenderOptions::default(), &mut watch)?)
    }

    fn begin(&self, what: &'static str) {
        *self.progress.what.write().unwrap_or_else(PoisonError::into_inner) = what;
        self.progress.part.store(0, Ordering::Relaxed);
        (self.wake)();
    }

    fn reached(&self, Progress { done, total }: Progress) -> ControlFlow<()> {
        let part = (done * u64::from(PARTS) / total.max(1)) as u32;
        let before = self.progress.part.fetch_max(part, Ordering::Relaxed);
        if part / 10 > before / 10 {
            (self.wake)();
        }
        self.cancelled()
    }

    fn cancelled(&self) -> ControlFlow<()> {
        if self.cases.calls() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn figures(
    case: &Case,
    comparison: &Comparison,
    (method, part): (&str, f64),
    drawn: &Frame,
) -> Figures {
    let scene = &case.model.scene;
    let metrics = comparison.metrics(&drawn.image);
    let operations = scene.operations(&scene.marched(method), metrics.evaluations.mean);
    let milliseconds = drawn.milliseconds;
    Figures { method: method.to_owned(), part, metrics, operations, milliseconds }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, channel};
    use std::time::Duration;

    use super::*;
    use crate::worker::tests::model;

    /// Long enough for a busy machine; reached only where a test fails.
    const PATIENCE: Duration = Duration::from_secs(300);

    fn judge() -> (Judge, Receiver<Judged>) {
        let (sender, judged) = channel();
        (Judge::new(sender, || ()).unwrap(), judged)
    }

    fn case(text: &str) -> Case {
        let model = model(text);
        let frame = model.defaults();
        let pose = Pose::new(model.scene.program(), &frame, None, 1.5).unwrap();
        Case { model, frame, pose, size: [1200, 800], tolerance: 1.0, all: false }
    }

    const BLEND: &str = "union(sphere(0.5), box(0.4).translate(x: 0.5), blend: smooth(0.2))\n\
                         camera(eye: [0, 1, 3], target: 0, fov: 40deg)\n";

    #[allow(clippy::wildcard_enum_match_arm, reason = "a test that meets anything else fails")]
    fn judgement(judged: &Receiver<Judged>) -> Judgement {
        match judged.recv_timeout(PATIENCE).unwrap() {
            Judged::Judgement(judgement) => *judgement,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_is_shown_is_compared_at_a_reduced_size() {
        let (judge, judged) = judge();
        let case = case(BLEND);
        judge.ask(case.clone());
        let found = judgement(&judged);
        assert!(found.finished && found.all.is_empty());
        assert_eq!(found.size, [190, 126]);
        let counts = found.counts;
        assert_eq!(counts.hit + counts.miss + counts.edge + counts.undecided, 190 * 126);
        assert_eq!(found.shown.failed(), 0, "{:?}", found.shown);
        assert!(found.shown.metrics.depth.pixels.p99 < 0.25, "{:?}", found.shown);
        // Coarser by far: seen to be so.
        judge.ask(Case { tolerance: 1000.0, ..case });
        let coarse = judgement(&judged);
        assert!(coarse.shown.metrics.evaluations.mean < found.shown.metrics.evaluations.mean);
        assert!(coarse.shown.metrics.depth.pixels.p99 > found.shown.metrics.depth.pixels.p99);
    }

    #[test]
    fn a_cancelled_case_gives_no_figures_and_the_next_one_does() {
        let (judge, judged) = judge();
        // A billion cells: nothing but cancelling ends that soon.
        judge.ask(case(
            "intersection(gyroid(0.05, 0.01), sphere(1))\ncamera(eye: [0, 0, 3], target: 0)\n",
        ));
        while judge.progress().is_some_and(|(_, what)| what.is_empty()) {
            std::thread::sleep(Duration::from_millis(1));
        }
        judge.cancel();
        assert!(matches!(judged.recv_timeout(PATIENCE).unwrap(), Judged::Cancelled));
        judge.ask(case(BLEND));
        assert!(judgement(&judged).finished);
    }

    #[test]
    fn beaten_figures_are_not_the_best() {
        let found = |operations, p99| {
            let mut metrics = Metrics::default();
            metrics.depth.pixels.p99 = p99;
            let method = "auto".to_owned();
            Figures { method, part: 1.0, metrics, operations, milliseconds: 0.0 }
        };
        let (cheap, dear, worse) = (found(1.0, 0.5), found(9.0, 0.1), found(9.0, 0.2));
        assert!(dear.beats(&worse) && !worse.beats(&dear));
        assert!(!cheap.beats(&dear) && !dear.beats(&cheap) && !dear.beats(&dear));
    }
}
