//! The thread that draws the latest request: coarse first if the scene is slow, then finer.
//!
//! While the camera moves, one pass is drawn at a resolution that should keep it within
//! [`PASS_BUDGET_MS`]. When the camera rests, passes up to the full resolution follow, then more
//! samples per pixel. A newer request interrupts a finer pass at its next tile. It does not
//! interrupt the first pass, or a camera that never rests would never be seen to move, unless that
//! pass takes longer than `FIRST_PASS_LIMIT`.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use sdfc::Error;
use sdfc_render::{
    EvaluationCounts, Frame, Image, Progress, RenderError, RenderOptions, TileSize, View,
    milliseconds_since, sample_offsets, uniform_values,
};

use crate::latest_channel::LatestChannel;
use crate::render::picture::{Picture, RenderEvent, RenderRequest};
use crate::scene::model::Engine;
use crate::views::input::ViewInput;
use crate::views::mode::ViewMode;
use crate::views::slice_plane::SlicePlane;
use crate::worker_thread::WorkerThread;

/// The longest time of a pass while the camera moves, in milliseconds.
pub const PASS_BUDGET_MS: f64 = 30.0;
/// After this long a newer request interrupts a first pass.
const FIRST_PASS_LIMIT: Duration = Duration::from_millis(300);
/// Milliseconds per tile; a newer request is noticed between tiles.
const TILE_MS: f64 = 16.0;
/// The coarsest pass divides width and height by this.
const MAX_DIVISOR: u32 = 8;
/// The divisor of a scene's first pass, when its cost is not known yet.
const FIRST_DIVISOR: u32 = 4;
/// The longest time spent on more samples per pixel, in milliseconds. Edges are smooth long before.
const SAMPLING_LIMIT_MS: f64 = 20_000.0;

/// A handle to the render worker; dropping it ends the thread.
#[derive(Debug)]
pub struct RenderWorker(WorkerThread<RenderRequest>);

impl RenderWorker {
    /// Starts the thread. It sends `events` and calls `wake` after each.
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn new(
        events: Sender<RenderEvent>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let report = move |event| {
            // Sending fails only after the session is dropped.
            let _ = events.send(event);
            wake();
        };
        let init = |requests| {
            let mut state = RenderState::new(requests, report);
            move |request| state.handle(request)
        };
        WorkerThread::start("render", init).map(Self)
    }

    /// Requests a picture in place of any earlier request.
    pub fn send(&self, request: RenderRequest) {
        self.0.channel().send(request);
    }
}

/// Why a pass gave no picture.
enum Stop {
    /// A newer request waits.
    Superseded,
    Error(Error),
}

/// The finest image of the last request.
struct DrawnImage {
    request: Arc<RenderRequest>,
    view: View,
    /// One ray per pixel.
    frame: Frame,
    image: Arc<Image>,
    /// The sum of the colours of `samples` rays.
    sum: Image,
    samples: u32,
    divisor: u32,
}

/// The thread's state between requests.
struct RenderState<R> {
    requests: Arc<LatestChannel<RenderRequest>>,
    report: R,
    drawn: Option<DrawnImage>,
    /// The serial of a model and its milliseconds per pixel.
    cost: Option<(u64, f64)>,
    started: Instant,
}

impl<R: FnMut(RenderEvent)> RenderState<R> {
    fn new(requests: Arc<LatestChannel<RenderRequest>>, report: R) -> Self {
        Self { requests, report, drawn: None, cost: None, started: Instant::now() }
    }

    /// Handles a request. A panic in a driver is reported and does not end the thread.
    fn handle(&mut self, request: RenderRequest) {
        self.started = Instant::now();
        let device_generation = request.model.device_generation;
        match catch_unwind(AssertUnwindSafe(|| self.draw(Arc::new(request)))) {
            Ok(Ok(())) | Ok(Err(Stop::Superseded)) => {}
            Ok(Err(Stop::Error(error))) => {
                self.drawn = None;
                let machine = error.is_machine();
                let message = error.to_string();
                (self.report)(RenderEvent::Failed { message, machine, device_generation });
            }
            Err(_) => {
                self.drawn = None;
                let message = "the GPU driver crashed while drawing".to_owned();
                (self.report)(RenderEvent::Failed { message, machine: true, device_generation });
            }
        }
    }

    fn draw(&mut self, request: Arc<RenderRequest>) -> Result<(), Stop> {
        let same = self.drawn.as_ref().is_some_and(|drawn| drawn.request.has_same_rays(&request));
        if let Some(drawn) = self.drawn.as_mut().filter(|_| same) {
            drawn.request = Arc::clone(&request);
            self.report_picture(&request);
        } else {
            self.drawn = None;
            let first = self.first_divisor(&request);
            self.pass(&request, first, false)?;
        }
        if request.moving {
            return Ok(());
        }
        while let Some(divisor) = self.drawn.as_ref().map(|drawn| drawn.divisor)
            && divisor > 1
            && request.refine
        {
            self.pass(&request, divisor / 2, true)?;
        }
        self.add_samples(&request)?;
        // Built here because hovering needs it and must not wait for it.
        request.model.shapes.leaves(&request.model.scene);
        Ok(())
    }

    /// The divisor at which a first pass should stay within the budget.
    fn first_divisor(&self, request: &RenderRequest) -> u32 {
        let pixels = f64::from(request.size[0]) * f64::from(request.size[1]);
        let cost = self.cost.filter(|(serial, _)| *serial == request.model.serial);
        let Some((_, cost)) = cost else { return FIRST_DIVISOR };
        let mut divisor = 1;
        while divisor < MAX_DIVISOR && cost * pixels / f64::from(divisor * divisor) > PASS_BUDGET_MS
        {
            divisor *= 2;
        }
        divisor
    }

    /// Draws at a fraction of the resolution and reports the picture.
    fn pass(
        &mut self,
        request: &Arc<RenderRequest>,
        divisor: u32,
        interruptible: bool,
    ) -> Result<(), Stop> {
        let start = Instant::now();
        let size = request.size.map(|side| side.div_ceil(divisor).max(1));
        let (model, values) = (&request.model, &request.frame);
        let program = model.scene.drawn();
        let bounds = model.scene.bounds_at(values);
        let view = View::from_pose(program, values, bounds, size, &request.pose)
            .map_err(|error| Stop::Error(error.into()))?
            .with_scaled_parameter(model.method_parameter(), request.tolerance);
        let frame = self.frame(request, &view, interruptible)?;
        let (sum, image) = (frame.image.clone(), Arc::new(frame.image.clone()));
        let request = Arc::clone(request);
        let drawn = DrawnImage { request, view, frame, image, sum, samples: 1, divisor };
        let request = Arc::clone(&drawn.request);
        self.drawn = Some(drawn);
        self.report_picture(&request);
        let pixels = f64::from(size[0]) * f64::from(size[1]);
        self.cost = Some((request.model.serial, milliseconds_since(start) / pixels));
        Ok(())
    }

    /// Draws one ray per pixel.
    fn frame(
        &mut self,
        request: &RenderRequest,
        view: &View,
        interruptible: bool,
    ) -> Result<Frame, Stop> {
        let start = Instant::now();
        let requests = Arc::clone(&self.requests);
        let mut reached = 0.0;
        let mut progress = |progress: Progress| {
            reached = progress.done as f64;
            let may_stop = interruptible || start.elapsed() > FIRST_PASS_LIMIT;
            if may_stop && requests.is_interrupted() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let options =
            RenderOptions { tile_size: TileSize::Adaptive { milliseconds: TILE_MS }, region: None };
        let (model, values) = (&request.model, &request.frame);
        let result = match &model.engine {
            Engine::Gpu(pipeline) => {
                let uniforms = uniform_values(model.marched(), values);
                pipeline.render(view, &uniforms, &options, &mut progress)
            }
            Engine::Cpu(scene) => scene.render(view, values, model.method, &options, &mut progress),
        };
        result.map_err(|error| {
            if error != RenderError::Cancelled {
                return Stop::Error(error.into());
            }
            // The tiles so far tell the cost, so that the next first pass is coarse enough.
            self.cost = Some((model.serial, milliseconds_since(start) / f64::max(reached, 1.0)));
            Stop::Superseded
        })
    }

    /// Adds samples to each pixel. The picture is reported whenever their number has doubled.
    fn add_samples(&mut self, request: &Arc<RenderRequest>) -> Result<(), Stop> {
        let offsets = sample_offsets(request.samples).map_err(|error| Stop::Error(error.into()))?;
        let start = Instant::now();
        let wants_more = |drawn: &DrawnImage| {
            request.mode == ViewMode::Shaded
                && drawn.divisor == 1
                && (drawn.samples as usize) < offsets.len()
                && milliseconds_since(start) < SAMPLING_LIMIT_MS
                && request.refine
        };
        while let Some(drawn) = self.drawn.as_ref().filter(|drawn| wants_more(drawn)) {
            // The first ray, through the middle of the pixel, is near enough to the first offset.
            let Some(offset) = offsets.get(drawn.samples as usize) else { break };
            let view = drawn.view.shifted(*offset);
            let frame = self.frame(request, &view, true)?;
            let Some(drawn) = &mut self.drawn else { break };
            drawn.sum.add(&frame.image);
            drawn.samples += 1;
            if drawn.samples.is_power_of_two() || !wants_more(drawn) {
                self.report_picture(request);
            }
        }
        Ok(())
    }

    /// Applies the view and reports the picture.
    fn report_picture(&mut self, request: &Arc<RenderRequest>) {
        let Some(drawn) = &self.drawn else { return };
        let mut colors = drawn.sum.clone();
        colors.divide(drawn.samples as f32);
        let input = ViewInput {
            colors: &colors,
            image: &drawn.image,
            view: &drawn.view,
            field: &request.model.field,
            scene: &request.model.scene,
            shapes: &request.model.shapes,
            frame: &request.frame,
            slice: match request.model.scene.is_planar() {
                true => SlicePlane { axis: 2, offset: 0.0, ..request.slice },
                false => request.slice,
            },
            origin: request.model.scene.drawn().origin,
        };
        let (rgba, legend) = request.mode.paint(&input);
        let has_all_samples = request.mode != ViewMode::Shaded || drawn.samples >= request.samples;
        let picture = Picture {
            request: Arc::clone(request),
            image: Arc::clone(&drawn.image),
            view: drawn.view.clone(),
            rgba,
            legend,
            divisor: drawn.divisor,
            samples: drawn.samples,
            finished: drawn.divisor == 1 && has_all_samples,
            milliseconds: drawn.frame.milliseconds,
            clock: drawn.frame.clock,
            latency: milliseconds_since(self.started),
            evaluations: EvaluationCounts::of(&drawn.image),
            counts: drawn.image.counts(),
        };
        (self.report)(RenderEvent::Picture(Box::new(picture)));
    }
}
