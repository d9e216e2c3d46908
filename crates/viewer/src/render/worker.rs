//! The thread that draws the latest request: coarse first if the scene is slow, then finer.
//!
//! While the camera moves, one pass is drawn at a resolution that should keep it within
//! [`PASS_BUDGET_MS`]. When the camera rests, passes up to the full resolution follow, then more
//! samples per pixel. A newer request interrupts a finer pass at its next tile. It does not
//! interrupt the first pass, or a camera that never rests would never be seen to move, unless that
//! pass takes longer than `FIRST_PASS_LIMIT`.
//!
//! A view that is slow to compute is shown for few pixels first, then for more of them. A newer
//! request interrupts that too.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use sdfc::Error;
use sdfc_render::{
    Clock, EvaluationCounts, Frame, Image, Pipeline, Progress, RenderError, RenderOptions,
    TileSize, View, milliseconds_since, sample_offsets, uniform_values,
};

use crate::latest_channel::LatestChannel;
use crate::render::images::Images;
use crate::render::pacing::{PASS_BUDGET_MS, Pacing};
use crate::render::picture::{MovingPicture, Picture, RenderEvent, RenderRequest};
use crate::render::view_painter::{ColoredView, first_stride, paint};
use crate::render::window_device::DevicePictures;
use crate::scene::field_probe::IsInterrupted;
use crate::scene::model::Engine;
use crate::views::input::ViewInput;
use crate::views::mode::ViewMode;
use crate::views::slice_plane::SlicePlane;
use crate::worker_thread::WorkerThread;

/// After this long a newer request interrupts a first pass.
const FIRST_PASS_LIMIT: Duration = Duration::from_millis(300);
/// Milliseconds per tile; a newer request is noticed between tiles.
const TILE_MS: f64 = 16.0;
/// Milliseconds per tile on the device of the window, whose frames wait for a tile.
const WINDOW_TILE_MS: f64 = 8.0;
/// A view that is computed for all pixels within this time, in milliseconds, is shown at once.
const QUICK_VIEW_MS: f64 = 60.0;
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

impl From<RenderError> for Stop {
    fn from(error: RenderError) -> Self {
        match error == RenderError::Cancelled {
            true => Self::Superseded,
            false => Self::Error(error.into()),
        }
    }
}

/// The finest image of the last request.
struct DrawnImage {
    request: Arc<RenderRequest>,
    view: View,
    /// One ray per pixel, and the time that they took.
    image: Arc<Image>,
    milliseconds: f64,
    clock: Clock,
    /// The sum of the colours of `samples` rays, if there are several.
    sum: Option<Image>,
    samples: u32,
    divisor: u32,
    /// The last picture of the request's view, of all pixels or of some.
    colored: Option<ColoredView>,
}

/// The thread's state between requests.
struct RenderState<R> {
    requests: Arc<LatestChannel<RenderRequest>>,
    report: R,
    drawn: Option<DrawnImage>,
    pacing: Pacing,
    images: Images,
    /// For pictures that stay on the device of the window.
    on_window: Option<DevicePictures>,
    /// The pixels of the window per pixel of the last picture with the request's rays and view.
    shown_scale: Option<u32>,
    started: Instant,
}

impl<R: FnMut(RenderEvent)> RenderState<R> {
    fn new(requests: Arc<LatestChannel<RenderRequest>>, report: R) -> Self {
        let (pacing, images, started) = (Pacing::default(), Images::default(), Instant::now());
        let (drawn, on_window, shown_scale) = (None, None, None);
        Self { requests, report, drawn, pacing, images, on_window, shown_scale, started }
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
            let before = std::mem::replace(&mut drawn.request, Arc::clone(&request));
            if (before.mode, before.slice) != (request.mode, request.slice) {
                (drawn.colored, self.shown_scale) = (None, None);
            }
            self.report_picture(&request, false)?;
        } else {
            (self.drawn, self.shown_scale) = (None, None);
            if let Engine::Gpu(pipeline) = &request.model.engine
                && stays_on_device(&request)
            {
                return self.show_moving(&request, pipeline);
            }
            let pixels = f64::from(request.size[0]) * f64::from(request.size[1]);
            let first = self.pacing.first_divisor(request.model.serial, pixels);
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

    /// Draws a picture of something that moves, and leaves it on the device of the window.
    fn show_moving(
        &mut self,
        request: &Arc<RenderRequest>,
        pipeline: &Pipeline,
    ) -> Result<(), Stop> {
        let (start, gpu) = (Instant::now(), pipeline.gpu());
        let pixels = f64::from(request.size[0]) * f64::from(request.size[1]);
        let divisor = self.pacing.first_divisor(request.model.serial, pixels);
        let view = view(request, divisor)?;
        if !self.on_window.as_ref().is_some_and(|pictures| pictures.are_on(gpu)) {
            self.on_window = Some(DevicePictures::new(gpu)?);
        }
        let Some(pictures) = &mut self.on_window else { return Ok(()) };
        let (display, texture) = pictures.next(gpu, view.size)?;
        let uniforms = uniform_values(request.model.marched(), &request.frame);
        let tiles = TileSize::Adaptive { milliseconds: WINDOW_TILE_MS };
        let mut reached = 0.0;
        let mut progress = |progress: Progress| {
            reached = progress.done as f64;
            proceed(start.elapsed() <= FIRST_PASS_LIMIT || !self.requests.is_interrupted())
        };
        let shown = pipeline.show(&view, &uniforms, tiles, (display, &texture), &mut progress);
        self.pacing.record(request.model.serial, milliseconds_since(start), reached);
        let milliseconds = shown?;
        let latency = milliseconds_since(self.started);
        let request = Arc::clone(request);
        let picture = MovingPicture { request, texture, divisor, milliseconds, latency };
        (self.report)(RenderEvent::Moving(picture));
        Ok(())
    }

    /// Draws at a fraction of the resolution and reports the picture.
    fn pass(
        &mut self,
        request: &Arc<RenderRequest>,
        divisor: u32,
        interruptible: bool,
    ) -> Result<(), Stop> {
        let start = Instant::now();
        let view = view(request, divisor)?;
        let frame = self.frame(request, &view, interruptible)?;
        let pixels = f64::from(view.size[0]) * f64::from(view.size[1]);
        self.pacing.record(request.model.serial, milliseconds_since(start), pixels);
        let Frame { image, milliseconds, clock, .. } = frame;
        self.drawn = Some(DrawnImage {
            request: Arc::clone(request),
            view,
            image: self.images.keep(image),
            milliseconds,
            clock,
            sum: None,
            samples: 1,
            divisor,
            colored: None,
        });
        self.report_picture(request, interruptible)
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
            proceed(!(may_stop && requests.is_interrupted()))
        };
        let options =
            RenderOptions { tile_size: TileSize::Adaptive { milliseconds: TILE_MS }, region: None };
        let (model, values) = (&request.model, &request.frame);
        let result = match &model.engine {
            Engine::Gpu(pipeline) => {
                let uniforms = uniform_values(model.marched(), values);
                let old = self.images.take();
                pipeline.render_in_place_of(old, view, &uniforms, &options, &mut progress)
            }
            Engine::Cpu(scene) => scene.render(view, values, model.method, &options, &mut progress),
        };
        result.map_err(|error| {
            if error == RenderError::Cancelled {
                // The tiles so far tell the cost, so that the next first pass is coarse enough.
                self.pacing.record(model.serial, milliseconds_since(start), reached);
            }
            error.into()
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
            drawn.sum.get_or_insert_with(|| drawn.image.as_ref().clone()).add(&frame.image);
            self.images.keep(frame.image);
            drawn.samples += 1;
            drawn.colored = None;
            if drawn.samples.is_power_of_two() || !wants_more(drawn) {
                self.report_picture(request, false)?;
            }
        }
        Ok(())
    }

    /// Applies the view to few pixels, then to more, and reports each picture. While something
    /// moves, that ends when the next picture would take longer than a pass may. A newer request
    /// interrupts every picture after the first one, and that one too if it is `interruptible`.
    fn report_picture(
        &mut self,
        request: &Arc<RenderRequest>,
        interruptible: bool,
    ) -> Result<(), Stop> {
        let Some(drawn) = &self.drawn else { return Ok(()) };
        let mut stride = first_stride(request.mode, drawn.image.size());
        if let Some(colored) = &drawn.colored {
            (self.report)(picture(drawn, colored, self.started));
            if colored.stride == 1 {
                return Ok(());
            }
            stride = colored.stride / 2;
        }
        // A finer image begins where the coarser one was left.
        while stride > 1 && self.shown_scale.is_some_and(|scale| drawn.divisor * stride >= scale) {
            stride /= 2;
        }
        let mut may_stop = interruptible || drawn.colored.is_some();
        loop {
            let Some(drawn) = &mut self.drawn else { return Ok(()) };
            let start = Instant::now();
            let interrupted = || may_stop && self.requests.is_interrupted();
            let colored = colored(drawn, stride, &interrupted)?;
            // An interrupted view has pixels without a value. The shaded one needs no field.
            if request.mode != ViewMode::Shaded && interrupted() {
                return Err(Stop::Superseded);
            }
            let milliseconds = milliseconds_since(start);
            let is_quick = milliseconds * f64::from(stride * stride) < QUICK_VIEW_MS;
            if stride == 1 || !is_quick {
                (self.report)(picture(drawn, &colored, self.started));
                self.shown_scale = Some(drawn.divisor * stride);
                drawn.colored = Some(colored);
                may_stop = true;
            }
            let next_milliseconds = milliseconds * 4.0;
            if stride == 1 || !is_quick && request.moving && next_milliseconds > PASS_BUDGET_MS {
                return Ok(());
            }
            stride = if is_quick { 1 } else { stride / 2 };
        }
    }
}

/// Returns true if the window can show the picture without its pixels on the CPU: it moves, and the
/// view needs no field.
fn stays_on_device(request: &RenderRequest) -> bool {
    request.model.on_window && request.moving && request.mode == ViewMode::Shaded
}

fn proceed(proceed: bool) -> ControlFlow<()> {
    if proceed { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}

/// The rays of a request at a fraction of its resolution.
fn view(request: &RenderRequest, divisor: u32) -> Result<View, Stop> {
    let size = request.size.map(|side| side.div_ceil(divisor).max(1));
    let (model, values) = (&request.model, &request.frame);
    let bounds = model.scene.bounds_at(values);
    let view = View::from_pose(model.scene.drawn(), values, bounds, size, &request.pose);
    let view = view.map_err(|error| Stop::Error(error.into()))?;
    Ok(view.with_scaled_parameter(model.method_parameter(), request.tolerance))
}

/// Applies the request's view to every `stride`-th pixel.
fn colored(
    drawn: &DrawnImage,
    stride: u32,
    interrupted: IsInterrupted<'_>,
) -> Result<ColoredView, Stop> {
    let mean = drawn.sum.clone().map(|mut sum| {
        sum.divide(drawn.samples as f32);
        sum
    });
    let request = &drawn.request;
    let input = ViewInput {
        colors: mean.as_ref().unwrap_or(&drawn.image),
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
        stride: 1,
        interrupted,
    };
    paint(request.mode, &input, stride).map_err(|error| Stop::Error(error.into()))
}

/// The picture that the window shows.
fn picture(drawn: &DrawnImage, colored: &ColoredView, started: Instant) -> RenderEvent {
    let request = Arc::clone(&drawn.request);
    let has_all_samples = request.mode != ViewMode::Shaded || drawn.samples >= request.samples;
    let ColoredView { rgba, size, legend, stride } = colored.clone();
    RenderEvent::Picture(Box::new(Picture {
        request,
        image: Arc::clone(&drawn.image),
        view: drawn.view.clone(),
        rgba,
        rgba_size: size,
        legend,
        divisor: drawn.divisor,
        stride,
        samples: drawn.samples,
        finished: drawn.divisor == 1 && stride == 1 && has_all_samples,
        milliseconds: drawn.milliseconds,
        clock: drawn.clock,
        latency: milliseconds_since(started),
        evaluations: EvaluationCounts::of(&drawn.image),
        counts: drawn.image.counts(),
    }))
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, channel};

    use super::*;
    use crate::test_support::{TIMEOUT, model};

    /// A field that takes long to evaluate.
    fn slow_scene() -> String {
        let ball = |index: u32| {
            let [x, y] = [index % 20, index / 20].map(|at| f64::from(at) * 0.21 - 2.0);
            format!("sphere(0.1{index:03}).translate([{x}, {y}, 0.0{index}])")
        };
        let balls: Vec<String> = (0..400).map(ball).collect();
        let camera = "camera(eye: [0, 0, 7], target: [0, 0, 0], fov: 40deg)";
        format!("union({}, blend: smooth(0.05))\n{camera}\n", balls.join(",\n"))
    }

    fn slow_request(size: [u32; 2]) -> RenderRequest {
        let model = model(&slow_scene());
        let frame = model.defaults();
        RenderRequest {
            pose: model.scene.pose(&frame, 1.5).unwrap(),
            frame,
            size,
            mode: ViewMode::Shaded,
            slice: Default::default(),
            moving: true,
            refine: true,
            samples: 1,
            tolerance: 1.0,
            model,
        }
    }

    fn next_picture(events: &Receiver<RenderEvent>) -> Box<Picture> {
        match events.recv_timeout(TIMEOUT).unwrap() {
            RenderEvent::Picture(picture) => picture,
            RenderEvent::Failed { message, .. } => panic!("{message}"),
            RenderEvent::Moving(_) => panic!("there is no window"),
        }
    }

    #[test]
    fn a_slow_view_is_shown_coarsely_first_and_interrupted_by_the_next_one() {
        let request = slow_request([480, 320]);
        let (sender, events) = channel();
        let worker = RenderWorker::new(sender, || {}).unwrap();
        let next = || next_picture(&events);
        worker.send(request.clone());
        assert_eq!((next().stride, next_is_none(&events)), (1, true));
        // The same rays: nothing is drawn again, few pixels are computed.
        worker.send(RenderRequest { mode: ViewMode::Normals, ..request.clone() });
        let coarse = next();
        assert_eq!((coarse.request.mode, coarse.stride > 1), (ViewMode::Normals, true));
        let [width, height] = coarse.rgba_size;
        assert_eq!(coarse.rgba.len(), (4 * width * height) as usize);
        // At rest more pixels follow, until another view is wanted.
        let normals = RenderRequest { mode: ViewMode::Normals, moving: false, ..request.clone() };
        worker.send(normals);
        let finer = std::iter::repeat_with(next).find(|it| it.stride < coarse.stride).unwrap();
        worker.send(RenderRequest { mode: ViewMode::GradientLength, ..request });
        let other = std::iter::repeat_with(next).find(|it| {
            assert!(!it.finished, "the view of {:?} was finished first", it.request.mode);
            it.request.mode == ViewMode::GradientLength
        });
        assert_eq!(other.unwrap().divisor, finer.divisor);
    }

    #[test]
    fn a_view_of_a_finished_picture_is_interrupted_by_the_next_one() {
        let request = RenderRequest { moving: false, ..slow_request([360, 240]) };
        let (sender, events) = channel();
        let worker = RenderWorker::new(sender, || {}).unwrap();
        let mut pictures = std::iter::repeat_with(|| next_picture(&events));
        worker.send(request.clone());
        pictures.find(|it| it.finished).unwrap();
        // All rays are known: only the view is computed.
        worker.send(RenderRequest { mode: ViewMode::Normals, ..request.clone() });
        let coarse = pictures.next().unwrap();
        assert_eq!((coarse.request.mode, coarse.stride > 2), (ViewMode::Normals, true));
        worker.send(RenderRequest { mode: ViewMode::GradientLength, ..request });
        let finest = pictures.take_while(|it| it.request.mode == ViewMode::Normals);
        let finest = finest.map(|it| it.stride).min();
        assert!(finest.is_none_or(|stride| stride > 1), "{finest:?}");
    }

    fn next_is_none(events: &Receiver<RenderEvent>) -> bool {
        events.recv_timeout(Duration::from_millis(100)).is_err()
    }
}
