//! The thread that draws: the newest request, coarse first where the scene is slow, then finer.
//!
//! While the camera moves, one pass is drawn whose resolution is chosen so that it should take no longer than
//! `BUDGET`; when it rests, passes of up to full resolution follow, and then more rays for each pixel. A
//! newer request ends a finer pass at its next tile; the first pass is finished, so that a camera that never
//! rests is seen to move, unless it takes longer than `PATIENCE`.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use sdfc::render::{
    Clock, EvaluationCounts, Frame, Image, PixelCounts, Pose, Progress, RenderError, RenderOptions,
    TileSize, View, milliseconds_since, sample_offsets, uniform_values,
};
use sdfc::{Error, FrameValues};

use crate::legend::Legend;
use crate::mailbox::{Attendant, Mailbox};
use crate::mode::{Mode, Slice};
use crate::model::{Engine, Model};
use crate::views::{Seen, paint};

/// Milliseconds that a pass may take while the camera moves.
pub const BUDGET: f64 = 30.0;
/// A first pass that takes longer gives way to a newer request.
const PATIENCE: Duration = Duration::from_millis(300);
/// Milliseconds of one tile, after which another request can be heard.
const TILE: f64 = 16.0;
/// Columns and rows are divided by at most this.
const COARSEST: u32 = 8;
/// What a scene is drawn with first, when nothing is known of its cost.
const UNKNOWN: u32 = 4;
/// Milliseconds that rays may be added to each pixel: edges are smooth long before.
const SMOOTHING: f64 = 20_000.0;

/// What is to be drawn.
#[derive(Clone, Debug)]
pub struct Request {
    /// The scene.
    pub model: Arc<Model>,
    /// The values of its params, and the time.
    pub frame: FrameValues,
    /// From where.
    pub pose: Pose,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What is shown.
    pub mode: Mode,
    /// The plane of [`Mode::Slice`].
    pub slice: Slice,
    /// Whether the next request is likely to differ: one pass is enough.
    pub moving: bool,
    /// Whether finer passes may take long.
    pub refine: bool,
    /// Rays for each pixel when all else is done.
    pub samples: u32,
    /// The knob of the method, as a multiple of the scene's.
    pub tolerance: f64,
}

impl Request {
    /// Whether the same is asked for.
    pub fn is(&self, other: &Self) -> bool {
        self.draws_as(other)
            && (self.mode, self.slice) == (other.mode, other.slice)
            && (self.moving, self.refine) == (other.moving, other.refine)
            && self.samples == other.samples
    }

    /// Whether the same rays are drawn.
    fn draws_as(&self, other: &Self) -> bool {
        self.model.serial == other.model.serial
            && self.size == other.size
            && self.pose == other.pose
            && self.frame == other.frame
            && self.tolerance == other.tolerance
    }
}

/// A picture to show.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What was asked for.
    pub request: Arc<Request>,
    /// Depths, ends and counts, one ray a pixel.
    pub image: Arc<Image>,
    /// Their rays.
    pub view: View,
    /// Red, green, blue, alpha in sRGB.
    pub rgba: Vec<u8>,
    /// What the colours mean.
    pub legend: Legend,
    /// Columns and rows are so many times fewer than asked for.
    pub divisor: u32,
    /// Rays for each pixel.
    pub samples: u32,
    /// Whether nothing finer follows.
    pub finished: bool,
    /// What drawing took, in milliseconds; of one ray a pixel.
    pub milliseconds: f64,
    /// What measured that.
    pub clock: Clock,
    /// From taking the request to handing this over, in milliseconds.
    pub latency: f64,
    /// Evaluations of the field.
    pub evaluations: EvaluationCounts,
    /// How the rays ended.
    pub counts: PixelCounts,
}

/// What the painter tells.
#[derive(Debug)]
pub enum Painted {
    /// There is a picture.
    Picture(Box<Picture>),
    /// There is none.
    Failed {
        /// Why.
        message: String,
        /// Whether another device may help.
        machine: bool,
        /// Of the scene: which devices it was made for.
        renewed: u32,
    },
}

/// The thread, as others see it.
#[derive(Debug)]
pub struct Painter(Attendant<Request>);

impl Painter {
    /// Starts it. `wake` is called after each message.
    ///
    /// # Errors
    ///
    /// Where the system gives no thread.
    pub fn new(to: Sender<Painted>, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let tell = move |message| {
            // The receiver is gone only where the window is.
            let _ = to.send(message);
            wake();
        };
        let begin = |requests| {
            let mut studio = Studio::new(requests, tell);
            move |request| studio.guarded(request)
        };
        Attendant::start("painter", begin).map(Self)
    }

    /// Asks for a picture in place of whatever was asked before.
    pub fn ask(&self, request: Request) {
        self.0.mailbox().put(request);
    }
}

/// Why a pass gave no picture.
enum Stop {
    Superseded,
    Error(Error),
}

/// The finest picture of the last request.
struct Drawn {
    request: Arc<Request>,
    view: View,
    /// One ray a pixel.
    frame: Frame,
    image: Arc<Image>,
    /// Sum of the colours of so many rays.
    sum: Image,
    samples: u32,
    divisor: u32,
}

/// What the thread keeps between requests.
struct Studio<T> {
    requests: Arc<Mailbox<Request>>,
    tell: T,
    drawn: Option<Drawn>,
    /// Milliseconds a pixel, of the model with this number.
    cost: Option<(u64, f64)>,
    started: Instant,
}

impl<T: FnMut(Painted)> Studio<T> {
    fn new(requests: Arc<Mailbox<Request>>, tell: T) -> Self {
        Self { requests, tell, drawn: None, cost: None, started: Instant::now() }
    }

    /// A fault in a driver must not end all drawing.
    fn guarded(&mut self, request: Request) {
        self.started = Instant::now();
        let renewed = request.model.renewed;
        match catch_unwind(AssertUnwindSafe(|| self.serve(Arc::new(request)))) {
            Ok(Ok(())) | Ok(Err(Stop::Superseded)) => {}
            Ok(Err(Stop::Error(error))) => {
                self.drawn = None;
                let machine = error.is_machine();
                (self.tell)(Painted::Failed { message: error.to_string(), machine, renewed });
            }
            Err(_) => {
                self.drawn = None;
                let message = "the device driver failed while drawing".to_owned();
                (self.tell)(Painted::Failed { message, machine: true, renewed });
            }
        }
    }

    fn serve(&mut self, request: Arc<Request>) -> Result<(), Stop> {
        let same = self.drawn.as_ref().is_some_and(|drawn| drawn.request.draws_as(&request));
        if let Some(drawn) = self.drawn.as_mut().filter(|_| same) {
            drawn.request = Arc::clone(&request);
            self.show(&request);
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
        self.smooth(&request)?;
        // For the pointer, which cannot wait for it.
        request.model.shapes.leaves(&request.model.scene);
        Ok(())
    }

    /// How coarse a first pass must be.
    fn first_divisor(&self, request: &Request) -> u32 {
        let pixels = f64::from(request.size[0]) * f64::from(request.size[1]);
        let cost = self.cost.filter(|(serial, _)| *serial == request.model.serial);
        let Some((_, cost)) = cost else { return UNKNOWN };
        let mut divisor = 1;
        while divisor < COARSEST && cost * pixels / f64::from(divisor * divisor) > BUDGET {
            divisor *= 2;
        }
        divisor
    }

    /// Draws at a resolution, and shows it.
    fn pass(&mut self, request: &Arc<Request>, divisor: u32, gives_way: bool) -> Result<(), Stop> {
        let start = Instant::now();
        let size = request.size.map(|side| side.div_ceil(divisor).max(1));
        let (model, values) = (&request.model, &request.frame);
        let program = model.scene.drawn();
        let bounds = model.scene.bounds_at(values);
        let view = View::from_pose(program, values, bounds, size, &request.pose)
            .map_err(|error| Stop::Error(error.into()))?
            .with_scaled_parameter(model.knob(), request.tolerance);
        let frame = self.frame(request, &view, gives_way)?;
        let (sum, image) = (frame.image.clone(), Arc::new(frame.image.clone()));
        let request = Arc::clone(request);
        let drawn = Drawn { request, view, frame, image, sum, samples: 1, divisor };
        let request = Arc::clone(&drawn.request);
        self.drawn = Some(drawn);
        self.show(&request);
        let pixels = f64::from(size[0]) * f64::from(size[1]);
        self.cost = Some((request.model.serial, milliseconds_since(start) / pixels));
        Ok(())
    }

    /// One ray for each pixel.
    fn frame(&mut self, request: &Request, view: &View, gives_way: bool) -> Result<Frame, Stop> {
        let start = Instant::now();
        let requests = Arc::clone(&self.requests);
        let mut reached = 0.0;
        let mut progress = |progress: Progress| {
            reached = progress.done as f64;
            let must = gives_way || start.elapsed() > PATIENCE;
            if must && requests.calls() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let options = RenderOptions { tile_size: TileSize::Adaptive { milliseconds: TILE } };
        let (model, values) = (&request.model, &request.frame);
        let result = match &model.engine {
            Engine::Gpu(pipeline) => {
                let uniforms = uniform_values(model.marched(), values);
                pipeline.render(view, &uniforms, &options, &mut progress)
            }
            Engine::Cpu(scene) => {
                scene.render(view, values, &model.method, &options, &mut progress)
            }
        };
        result.map_err(|error| {
            if error != RenderError::Cancelled {
                return Stop::Error(error.into());
            }
            // Known by now, so that the next first pass is coarse enough.
            self.cost = Some((model.serial, milliseconds_since(start) / f64::max(reached, 1.0)));
            Stop::Superseded
        })
    }

    /// More rays for each pixel, as many again each time before they are shown.
    fn smooth(&mut self, request: &Arc<Request>) -> Result<(), Stop> {
        let places = sample_offsets(request.samples).map_err(|error| Stop::Error(error.into()))?;
        let start = Instant::now();
        let wants = |drawn: &Drawn| {
            request.mode == Mode::Shaded
                && drawn.divisor == 1
                && (drawn.samples as usize) < places.len()
                && milliseconds_since(start) < SMOOTHING
                && request.refine
        };
        while let Some(drawn) = self.drawn.as_ref().filter(|drawn| wants(drawn)) {
            // The first ray went through the middle of the pixel, near enough to the first place.
            let Some(place) = places.get(drawn.samples as usize) else { break };
            let view = drawn.view.shifted(*place);
            let frame = self.frame(request, &view, true)?;
            let Some(drawn) = &mut self.drawn else { break };
            drawn.sum.add(&frame.image);
            drawn.samples += 1;
            if drawn.samples.is_power_of_two() || !wants(drawn) {
                self.show(request);
            }
        }
        Ok(())
    }

    /// Paints what has been drawn, and hands it over.
    fn show(&mut self, request: &Arc<Request>) {
        let Some(drawn) = &self.drawn else { return };
        let mut colors = drawn.sum.clone();
        colors.divide(drawn.samples as f32);
        let seen = Seen {
            colors: &colors,
            image: &drawn.image,
            view: &drawn.view,
            probe: &request.model.probe,
            scene: &request.model.scene,
            shapes: &request.model.shapes,
            frame: &request.frame,
            slice: request.slice,
            origin: request.model.scene.drawn().origin,
        };
        let (rgba, legend) = paint(request.mode, seen);
        let smooth = request.mode != Mode::Shaded || drawn.samples >= request.samples;
        let picture = Picture {
            request: Arc::clone(request),
            image: Arc::clone(&drawn.image),
            view: drawn.view.clone(),
            rgba,
            legend,
            divisor: drawn.divisor,
            samples: drawn.samples,
            finished: drawn.divisor == 1 && smooth,
            milliseconds: drawn.frame.milliseconds,
            clock: drawn.frame.clock,
            latency: milliseconds_since(self.started),
            evaluations: EvaluationCounts::of(&drawn.image),
            counts: drawn.image.counts(),
        };
        (self.tell)(Painted::Picture(Box::new(picture)));
    }
}
