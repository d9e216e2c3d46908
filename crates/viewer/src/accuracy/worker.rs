//! The thread that compares pictures with the oracle: how many rays missed a surface or hit one
//! that is not there, and how far off their depths are.
//!
//! It handles the latest job only. Pictures are compared at a reduced size.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, PoisonError, RwLock};
use std::time::Instant;

use sdfc::{Error, Method};
use sdfc_codegen::render_module_with_camera;
use sdfc_measure::{Comparison, operations};
use sdfc_render::{
    Frame, Gpu, Pipeline, Progress, RenderError, RenderOptions, View, milliseconds_since,
    uniform_values,
};

use crate::accuracy::comparison::{ComparisonJob, ComparisonResult, MethodResult};
use crate::latest_channel::LatestChannel;
use crate::scene::model::Engine;
use crate::worker_thread::WorkerThread;

/// Progress is stored as a whole number from 0 to this.
const PROGRESS_STEPS: u32 = 1000;

/// A report of the accuracy worker.
#[derive(Debug)]
pub enum AccuracyEvent {
    /// A result, which may be extended by the next.
    Result(Box<ComparisonResult>),
    /// The comparison failed; why.
    Failed(String),
    /// The comparison was cancelled.
    Cancelled,
}

/// A handle to the accuracy worker; dropping it ends the thread.
#[derive(Debug)]
pub struct AccuracyWorker {
    /// `None` cancels the current job.
    thread: WorkerThread<Option<ComparisonJob>>,
    progress: Arc<SharedProgress>,
}

/// The progress of the current job, shared between threads.
#[derive(Debug, Default)]
struct SharedProgress {
    busy: AtomicBool,
    /// From 0 to [`PROGRESS_STEPS`].
    done: AtomicU32,
    step: RwLock<&'static str>,
}

impl AccuracyWorker {
    /// Starts the thread. It sends `events` and calls `wake` after each, and when progress changes.
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn new(
        events: Sender<AccuracyEvent>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> std::io::Result<Self> {
        let progress = Arc::new(SharedProgress::default());
        let shared = Arc::clone(&progress);
        let init = |jobs| {
            let mut runner = ComparisonRunner::new(jobs, shared, events, Box::new(wake));
            move |job| runner.handle(job)
        };
        Ok(Self { thread: WorkerThread::start("accuracy", init)?, progress })
    }

    /// Compares a picture in place of the current job.
    pub fn send(&self, job: ComparisonJob) {
        self.progress.busy.store(true, Ordering::Relaxed);
        self.thread.channel().send(Some(job));
    }

    /// Cancels the current job.
    pub fn cancel(&self) {
        self.thread.channel().send(None);
    }

    /// The fraction of the current step that is done, 0 to 1, and the step's name; `None` if
    /// nothing is being compared.
    pub fn progress(&self) -> Option<(f32, &'static str)> {
        if !self.progress.busy.load(Ordering::Relaxed) {
            return None;
        }
        let done = self.progress.done.load(Ordering::Relaxed) as f32 / PROGRESS_STEPS as f32;
        // The name is replaced whole, so a poisoned lock holds a valid one.
        Some((done, *self.progress.step.read().unwrap_or_else(PoisonError::into_inner)))
    }
}

/// The oracle's answer for one view, and the results compared with it.
struct CachedComparison {
    job: Arc<ComparisonJob>,
    comparison: Comparison,
    all: Vec<MethodResult>,
    refused: Vec<String>,
}

/// The thread's state between jobs.
struct ComparisonRunner {
    jobs: Arc<LatestChannel<Option<ComparisonJob>>>,
    progress: Arc<SharedProgress>,
    wake: Box<dyn Fn() + Send + Sync>,
    events: Sender<AccuracyEvent>,
    cached: Option<CachedComparison>,
    /// A device for "All methods", since compiling pipelines delays other work on a device.
    gpu: Option<Gpu>,
    started: Instant,
}

impl ComparisonRunner {
    fn new(
        jobs: Arc<LatestChannel<Option<ComparisonJob>>>,
        progress: Arc<SharedProgress>,
        events: Sender<AccuracyEvent>,
        wake: Box<dyn Fn() + Send + Sync>,
    ) -> Self {
        let started = Instant::now();
        Self { jobs, progress, wake, events, cached: None, gpu: None, started }
    }

    /// Handles a job; `None` was sent to cancel the job before it.
    fn handle(&mut self, job: Option<ComparisonJob>) {
        if let Some(job) = job {
            self.run(Arc::new(job));
        }
        // Still busy if another job has arrived meanwhile.
        self.progress.busy.store(self.jobs.is_interrupted(), Ordering::Relaxed);
        (self.wake)();
    }

    fn report(&self, event: AccuracyEvent) {
        // Sending fails only after the session is dropped.
        let _ = self.events.send(event);
        (self.wake)();
    }

    /// Runs a job. A panic in a driver is reported and does not end the thread.
    fn run(&mut self, job: Arc<ComparisonJob>) {
        self.started = Instant::now();
        let event = match catch_unwind(AssertUnwindSafe(|| self.compare(job))) {
            Ok(Ok(())) => return,
            Ok(Err(Error::Render(RenderError::Cancelled))) => AccuracyEvent::Cancelled,
            Ok(Err(error)) => AccuracyEvent::Failed(error.to_string()),
            Err(_) => AccuracyEvent::Failed("the GPU driver crashed while drawing".to_owned()),
        };
        self.gpu = None;
        self.report(event);
    }

    fn compare(&mut self, job: Arc<ComparisonJob>) -> Result<(), Error> {
        let cached = self.cached.take().filter(|cached| cached.job.has_same_oracle(&job));
        let mut current = match cached {
            Some(cached) => CachedComparison { job, ..cached },
            None => {
                let comparison = self.ask_oracle(&job)?;
                CachedComparison { job, comparison, all: Vec::new(), refused: Vec::new() }
            }
        };
        let result = self.compare_shown(&mut current);
        self.cached = Some(current);
        result
    }

    /// Proves for each ray where it hits the surface.
    fn ask_oracle(&self, job: &ComparisonJob) -> Result<Comparison, Error> {
        self.begin_step("proving each ray");
        let scene = &job.model.scene;
        let bounds = scene.bounds_at(&job.frame);
        let size = job.compared_size();
        let view = View::from_pose(scene.drawn(), &job.frame, bounds, size, &job.pose)?;
        Comparison::new(scene, view, job.frame.clone(), &|progress| self.update(progress))
    }

    /// Compares the shown picture, and all methods if the job asks for them.
    fn compare_shown(&mut self, current: &mut CachedComparison) -> Result<(), Error> {
        self.begin_step("drawing");
        let CachedComparison { job, comparison, .. } = &*current;
        let model = &job.model;
        let view = comparison.view().with_scaled_parameter(model.method_parameter(), job.tolerance);
        let drawn = match &model.engine {
            Engine::Gpu(pipeline) => {
                let uniforms = uniform_values(model.marched(), &job.frame);
                self.draw(pipeline, &view, &uniforms)?
            }
            Engine::Cpu(scene) => {
                let options = RenderOptions::default();
                let mut progress = |progress| self.update(progress);
                scene.render(&view, &job.frame, model.method, &options, &mut progress)?
            }
        };
        let setting = (model.method, job.tolerance);
        let shown = method_result(job, comparison, setting, &drawn);
        if job.all_methods {
            self.compare_all_methods(current, shown)
        } else {
            self.report_result(current, shown, true);
            Ok(())
        }
    }

    fn report_result(&self, current: &CachedComparison, shown: MethodResult, finished: bool) {
        let result = ComparisonResult {
            job: Arc::clone(&current.job),
            size: current.comparison.view().size,
            counts: current.comparison.counts(),
            shown,
            all: current.all.clone(),
            refused: current.refused.clone(),
            milliseconds: milliseconds_since(self.started),
            finished,
        };
        self.report(AccuracyEvent::Result(Box::new(result)));
    }

    /// Compares every ray method at every setting that the chart shows.
    fn compare_all_methods(
        &mut self,
        current: &mut CachedComparison,
        shown: MethodResult,
    ) -> Result<(), Error> {
        (current.all, current.refused) = Default::default();
        self.report_result(current, shown.clone(), false);
        self.begin_step("drawing with all methods");
        let gpu = self.gpu()?;
        for (done, method) in Method::all().enumerate() {
            if let Err(error) = self.compare_method(&gpu, method, current) {
                if matches!(error, Error::Render(RenderError::Cancelled)) {
                    return Err(error);
                }
                current.refused.push(format!("{method}: {error}"));
            }
            let progress = Progress { done: done as u64 + 1, total: Method::all().len() as u64 };
            let finished = progress.done == progress.total;
            self.report_result(current, shown.clone(), finished);
            if !finished && self.update(progress).is_break() {
                return Err(Error::Render(RenderError::Cancelled));
            }
        }
        Ok(())
    }

    fn compare_method(
        &self,
        gpu: &Gpu,
        method: Method,
        current: &mut CachedComparison,
    ) -> Result<(), Error> {
        let CachedComparison { job, comparison, all, .. } = current;
        let scene = &job.model.scene;
        // A result of `auto` has that name even if `auto` chose another method.
        let marched = scene.marched(method);
        let shader =
            render_module_with_camera(&marched.program, marched.method, job.pose.parallel)?;
        let pipeline = Pipeline::new(gpu, shader, marched.program.uniforms.len())?;
        let uniforms = uniform_values(&marched.program, &job.frame);
        for setting in method.definition().chart_factors {
            let view =
                comparison.view().with_scaled_parameter(method.definition().parameter, *setting);
            let drawn = self.draw(&pipeline, &view, &uniforms)?;
            all.push(method_result(job, comparison, (method, *setting), &drawn));
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
        let mut progress = |_| self.check_cancelled();
        Ok(pipeline.render(view, uniforms, &RenderOptions::default(), &mut progress)?)
    }

    fn begin_step(&self, name: &'static str) {
        *self.progress.step.write().unwrap_or_else(PoisonError::into_inner) = name;
        self.progress.done.store(0, Ordering::Relaxed);
        (self.wake)();
    }

    fn update(&self, Progress { done, total }: Progress) -> ControlFlow<()> {
        let done = (done * u64::from(PROGRESS_STEPS) / total.max(1)) as u32;
        let before = self.progress.done.fetch_max(done, Ordering::Relaxed);
        if done / 10 > before / 10 {
            (self.wake)();
        }
        self.check_cancelled()
    }

    fn check_cancelled(&self) -> ControlFlow<()> {
        if self.jobs.is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn method_result(
    job: &ComparisonJob,
    comparison: &Comparison,
    (method, setting): (Method, f64),
    drawn: &Frame,
) -> MethodResult {
    let scene = &job.model.scene;
    let metrics = comparison.metrics(&drawn.image);
    let operations = operations(scene, &scene.marched(method), metrics.evaluations.mean);
    let milliseconds = drawn.milliseconds;
    MethodResult { method, setting, metrics, operations, milliseconds }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, channel};

    use sdfc_render::Pose;

    use super::*;
    use crate::test_support::{TIMEOUT, model};

    fn start() -> (AccuracyWorker, Receiver<AccuracyEvent>) {
        let (sender, events) = channel();
        (AccuracyWorker::new(sender, || ()).unwrap(), events)
    }

    fn job(source: &str) -> ComparisonJob {
        let model = model(source);
        let frame = model.defaults();
        let pose = Pose::new(model.scene.program(), &frame, None, 1.5).unwrap();
        let size = [1200, 800];
        ComparisonJob { model, frame, pose, size, tolerance: 1.0, all_methods: false }
    }

    const BLEND: &str = "union(sphere(0.5), box(0.4).translate(x: 0.5), blend: smooth(0.2))\n\
                         camera(eye: [0, 1, 3], target: 0, fov: 40deg)\n";

    #[allow(clippy::wildcard_enum_match_arm, reason = "a test that meets anything else fails")]
    fn expect_result(events: &Receiver<AccuracyEvent>) -> ComparisonResult {
        match events.recv_timeout(TIMEOUT).unwrap() {
            AccuracyEvent::Result(result) => *result,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_shown_picture_is_compared_at_a_reduced_size() {
        let (worker, events) = start();
        let job = job(BLEND);
        worker.send(job.clone());
        let fine = expect_result(&events);
        assert!(fine.finished && fine.all.is_empty());
        assert_eq!(fine.size, [190, 126]);
        let counts = fine.counts;
        assert_eq!(counts.hit + counts.miss + counts.edge + counts.undecided, 190 * 126);
        assert_eq!(fine.shown.failed(), 0, "{:?}", fine.shown);
        assert!(fine.shown.metrics.depth.pixels.p99 < 0.25, "{:?}", fine.shown);
        // A far coarser tolerance gives fewer evaluations and larger errors.
        worker.send(ComparisonJob { tolerance: 1000.0, ..job });
        let coarse = expect_result(&events);
        assert!(coarse.shown.metrics.evaluations.mean < fine.shown.metrics.evaluations.mean);
        assert!(coarse.shown.metrics.depth.pixels.p99 > fine.shown.metrics.depth.pixels.p99);
    }

    #[test]
    fn a_cancelled_job_gives_no_result_and_the_next_one_does() {
        let (worker, events) = start();
        // A billion cells: without cancelling, the oracle would take far longer than the timeout.
        worker.send(job(
            "intersection(gyroid(0.05, 0.01), sphere(1))\ncamera(eye: [0, 0, 3], target: 0)\n",
        ));
        while worker.progress().is_some_and(|(_, step)| step.is_empty()) {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        worker.cancel();
        assert!(matches!(events.recv_timeout(TIMEOUT).unwrap(), AccuracyEvent::Cancelled));
        worker.send(job(BLEND));
        assert!(expect_result(&events).finished);
    }
}
