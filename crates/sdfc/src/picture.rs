//! Draws pictures of a scene, on the GPU or the CPU.

use std::borrow::Cow;
use std::str::FromStr;
use std::sync::OnceLock;
use std::time::Instant;

use sdfc_analyze::prepare_with;
use sdfc_codegen::{UnknownName, by_name, render_module, render_module_with_camera};
use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;
use sdfc_march::Method;
use sdfc_render::{
    AdapterInfo, CompileTimes, CpuScene, Frame, FrameTimes, Gpu, Image, LeafEvaluations,
    OnProgress, Pipeline, PixelCounts, Pose, Progress, RenderError, RenderOptions, Stats, Tile,
    TileSize, View, Why, milliseconds_since, sample_offsets, uniform_values,
};

use crate::empty_view::why_empty;
use crate::error::Error;
use crate::marched::Marched;
use crate::scene::Scene;

/// The device that draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// The GPU if there is one, otherwise the CPU. The CPU also draws long flat formulas for which
    /// a software driver of a GPU would take longer.
    #[default]
    Auto,
    /// The GPU. Without one, drawing fails.
    Gpu,
    /// The CPU.
    Cpu,
}

impl Backend {
    /// All backends.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Gpu, Self::Cpu];

    /// The backend's name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Gpu => "gpu",
            Self::Cpu => "cpu",
        }
    }

    /// What draws.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Auto => {
                "The GPU if there is one, otherwise the CPU. The CPU also draws long formulas that \
                 a software driver would draw more slowly"
            }
            Self::Gpu => "The GPU",
            Self::Cpu => "The CPU",
        }
    }
}

impl FromStr for Backend {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        by_name("backend", name, &Self::ALL, Self::name)
    }
}

/// Options of [`Scene::render`] and [`Scene::painter`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PictureOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The region of the picture that is drawn; `None` is all of it. Its pixels are those of the
    /// whole picture, bit for bit.
    pub region: Option<Tile>,
    /// Ray method; `None` takes the scene's, or `auto`.
    pub method: Option<Method>,
    /// The device that draws.
    pub backend: Backend,
    /// The camera; `None` takes the scene's, or one that sees the whole scene.
    pub pose: Option<Pose>,
    /// Factor by which the method's parameter, most often its tolerance, differs from the scene's.
    pub tolerance: f64,
    /// Values of params, time and frame; `None` takes the defaults at time 0.
    pub frame: Option<FrameValues>,
    /// Rays per pixel, from 1 to [`MAX_SAMPLES`](sdfc_render::MAX_SAMPLES); `None` takes the
    /// scene's, or 1.
    pub samples: Option<u32>,
    /// Distance between the isolines of a planar picture; `None` takes the scene's.
    pub isolines: Option<f64>,
    /// True for linear light without exposure and tone curve, as files with a high dynamic range
    /// hold it.
    pub hdr: bool,
    /// Number of times that the frame is drawn, to time it; at least 1.
    pub repetitions: u32,
}

impl PictureOptions {
    /// The default options: 640 by 360 pixels, everything else chosen by the scene and the machine.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets width and height in pixels.
    #[must_use]
    pub fn size(self, size: [u32; 2]) -> Self {
        Self { size, ..self }
    }

    /// Sets the region of the picture that is drawn; `None` is all of it.
    #[must_use]
    pub fn region(self, region: impl Into<Option<Tile>>) -> Self {
        Self { region: region.into(), ..self }
    }

    /// Sets the ray method; `None` takes the scene's, or `auto`.
    #[must_use]
    pub fn method(self, method: impl Into<Option<Method>>) -> Self {
        Self { method: method.into(), ..self }
    }

    /// Sets the device that draws.
    #[must_use]
    pub fn backend(self, backend: Backend) -> Self {
        Self { backend, ..self }
    }

    /// Sets the camera; `None` takes the scene's, or one that sees the whole scene.
    #[must_use]
    pub fn pose(self, pose: impl Into<Option<Pose>>) -> Self {
        Self { pose: pose.into(), ..self }
    }

    /// Sets the factor by which the method's parameter, most often its tolerance, differs from the
    /// scene's.
    #[must_use]
    pub fn tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Sets the values of params, time and frame; `None` takes the defaults at time 0.
    #[must_use]
    pub fn frame(self, frame: impl Into<Option<FrameValues>>) -> Self {
        Self { frame: frame.into(), ..self }
    }

    /// Sets the number of rays per pixel; `None` takes the scene's, or 1.
    #[must_use]
    pub fn samples(self, samples: impl Into<Option<u32>>) -> Self {
        Self { samples: samples.into(), ..self }
    }

    /// Sets the distance between the isolines of a planar picture; `None` takes the scene's.
    #[must_use]
    pub fn isolines(self, isolines: impl Into<Option<f64>>) -> Self {
        Self { isolines: isolines.into(), ..self }
    }

    /// Draws linear light, without exposure and tone curve.
    #[must_use]
    pub fn hdr(self, hdr: bool) -> Self {
        Self { hdr, ..self }
    }

    /// Sets how often the frame is drawn, to time it.
    #[must_use]
    pub fn repetitions(self, repetitions: u32) -> Self {
        Self { repetitions, ..self }
    }
}

impl Default for PictureOptions {
    /// As [`PictureOptions::new`].
    fn default() -> Self {
        Self {
            size: [640, 360],
            region: None,
            method: None,
            backend: Backend::Auto,
            pose: None,
            tolerance: 1.0,
            frame: None,
            samples: None,
            isolines: None,
            hdr: false,
            repetitions: 1,
        }
    }
}

/// A finished picture.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Picture {
    /// The pixels: colour, depth, status, number of evaluations.
    pub image: Image,
    /// Times and counts.
    pub stats: Stats,
    /// One line that says why the device or the method differs from the options.
    pub note: Option<String>,
    /// One line that says what part of the picture is unproven, and why; `None` if no ray can have
    /// missed more than the method's tolerance.
    pub unproven: Option<String>,
}

/// The time of a tile after the device was lost: a fourth of the usual time.
const SMALL_TILE_MS: f64 = 15.0;
/// What a picture says if the device was lost once.
const AGAIN: &str = "the device was lost once, and the picture was drawn again in smaller tiles";

impl Scene {
    /// Draws the scene. `progress` is called repeatedly and may cancel.
    ///
    /// # Errors
    ///
    /// [`Error::View`] if the settings give no valid view, [`Error::Render`] if the machine cannot
    /// draw the scene, [`Error::Codegen`] if the scene cannot be lowered.
    pub fn render(
        &self,
        options: &PictureOptions,
        progress: &mut OnProgress<'_>,
    ) -> Result<Picture, Error> {
        let defaults = || self.defaults();
        let values = options.frame.clone().unwrap_or_else(defaults);
        self.painter(options)?.paint(&values, options.repetitions, progress)
    }

    /// Prepares to draw many pictures that differ only in the frame's values, without compiling
    /// again. `frame` and `repetitions` of the options have no effect here.
    ///
    /// # Errors
    ///
    /// [`Error::Render`] if the machine cannot draw or there are too many samples,
    /// [`Error::Codegen`] if the scene cannot be lowered, [`Error::NotPlanar`] and
    /// [`Error::Spacing`] if isolines cannot be drawn.
    pub fn painter(&self, options: &PictureOptions) -> Result<Painter<'_>, Error> {
        self.painter_with(options, Gpu::new)
    }

    /// As [`Scene::painter`], on a GPU that is open. Opening one takes longer than drawing a small
    /// picture.
    ///
    /// # Errors
    ///
    /// As [`Scene::painter`].
    pub fn painter_on(&self, gpu: &Gpu, options: &PictureOptions) -> Result<Painter<'_>, Error> {
        self.painter_with(options, || Ok(gpu.clone()))
    }

    fn painter_with(
        &self,
        options: &PictureOptions,
        open: impl FnOnce() -> Result<Gpu, RenderError>,
    ) -> Result<Painter<'_>, Error> {
        let start = Instant::now();
        let method = options.method.unwrap_or(self.method());
        let samples = options.samples.or(self.program.settings.samples).unwrap_or(1);
        let samples = sample_offsets(samples)?;
        let gpu = match options.backend {
            Backend::Gpu => Ok(open()?),
            Backend::Cpu => Err(None),
            Backend::Auto => match open() {
                Ok(gpu) => self.faster_on_cpu(&gpu, method).map_or(Ok(gpu), |why| Err(Some(why))),
                Err(error) => Err(Some(format!("{error}; drawn on the CPU"))),
            },
        };
        // A method that the CPU lacks is an error if both are asked for by name.
        let both = options.backend == Backend::Cpu && options.method.is_some();
        let Marched { mut program, method, note: why } = match gpu {
            Err(_) if !both => self.marched_on_cpu(method),
            Ok(_) | Err(_) => self.marched(method),
        };
        if options.hdr {
            program.to_mut().settings.exposure = None;
        }
        if let Some(spacing) = options.isolines {
            program = Cow::Owned(self.with_isolines(spacing)?);
        }
        let (engine, compile, note) = match gpu {
            Ok(gpu) => {
                let parallel = options.pose.map(|pose| pose.parallel);
                let make = |gpu: &Gpu| self.pipeline(gpu, &program, method, parallel);
                let (engine, compile) = match make(&gpu) {
                    // Once more: the device may have been lost to another program's fault.
                    Err(Error::Render(error)) if error.is_device_failure() => make(&Gpu::new()?)?,
                    made => made?,
                };
                (engine, compile, None)
            }
            Err(note) => {
                let scene = CpuScene::new(&program)?;
                (Engine::Cpu(Box::new(scene)), cpu_times(start), note)
            }
        };
        let idle = options.method.filter(|_| self.is_planar());
        let idle = idle.map(|method| format!("regions have no rays, so `{method}` has no effect"));
        let notes: Vec<String> = note.into_iter().chain(why.clone()).chain(idle).collect();
        let note = (!notes.is_empty()).then(|| notes.join("; "));
        let (front, analyze) = (Some(self.times.front), Some(self.times.analyze));
        let compile = CompileTimes { front, analyze, ..compile };
        let PictureOptions { size, region, pose, tolerance, hdr, .. } = *options;
        Ok(Painter {
            scene: self,
            program,
            engine,
            reopened: OnceLock::new(),
            method,
            why,
            size,
            region,
            pose,
            tolerance,
            hdr,
            samples,
            compile,
            note,
            start,
        })
    }

    /// The program of the picture with other isolines.
    fn with_isolines(&self, spacing: f64) -> Result<Program, Error> {
        if !self.is_planar() {
            return Err(Error::NotPlanar);
        }
        if !(spacing > 0.0 && spacing.is_finite()) {
            return Err(Error::Spacing(spacing));
        }
        let mut scene = self.graph().clone();
        scene.settings.isolines = Some(scene.graph.number(spacing));
        Ok(prepare_with(&scene, self.drawn().origin, self.loops)?.program)
    }

    fn pipeline(
        &self,
        gpu: &Gpu,
        program: &Program,
        method: Method,
        parallel: Option<bool>,
    ) -> Result<(Engine, CompileTimes), Error> {
        let start = Instant::now();
        let shader = match parallel {
            Some(parallel) => render_module_with_camera(program, method, parallel)?,
            None => render_module(program, method)?,
        };
        let validate = shader.validation_time().as_secs_f64() * 1e3;
        let lower = milliseconds_since(start) - validate;
        let pipeline = Pipeline::new(gpu, shader, program.uniforms.len())?;
        let compile = CompileTimes {
            lower: Some(lower),
            validate: Some(validate),
            pipeline: Some(pipeline.milliseconds()),
            ..CompileTimes::default()
        };
        Ok((Engine::Gpu(Box::new(pipeline)), compile))
    }
}

fn cpu_times(start: Instant) -> CompileTimes {
    let no_shader = || "drawn on the CPU, without a shader".to_owned();
    CompileTimes {
        lower: Some(milliseconds_since(start)),
        why: Why::from([("validate", no_shader()), ("pipeline", no_shader())]),
        ..CompileTimes::default()
    }
}

/// The device that draws, with the scene compiled for it.
#[derive(Debug)]
enum Engine {
    Gpu(Box<Pipeline>),
    Cpu(Box<CpuScene>),
}

/// Draws one scene with one method at one size: see [`Scene::painter`].
#[derive(Debug)]
pub struct Painter<'s> {
    scene: &'s Scene,
    /// The scene's program, with the functions that the method needs.
    program: Cow<'s, Program>,
    engine: Engine,
    /// The engine after the device was lost.
    reopened: OnceLock<Engine>,
    method: Method,
    /// Why this method draws, if the field is uncertified.
    why: Option<String>,
    size: [u32; 2],
    region: Option<Tile>,
    pose: Option<Pose>,
    tolerance: f64,
    hdr: bool,
    /// The points at which rays pass through a pixel.
    samples: Vec<[f64; 2]>,
    compile: CompileTimes,
    note: Option<String>,
    start: Instant,
}

impl Painter<'_> {
    /// Draws one frame, `repetitions` times (at least once) to time it.
    ///
    /// `progress` is called repeatedly and may cancel; it counts each sample of a pixel.
    ///
    /// # Errors
    ///
    /// [`Error::View`] if the settings give no valid view, [`Error::Render`] if the machine cannot
    /// draw the scene.
    pub fn paint(
        &self,
        values: &FrameValues,
        repetitions: u32,
        progress: &mut OnProgress<'_>,
    ) -> Result<Picture, Error> {
        let scene = self.scene;
        let view = self.view(values)?;
        let repetitions = repetitions.max(1);
        let Repeated { frame, spent, first_drawn } =
            repeated(repetitions, || self.averaged(&view, values, &mut *progress))?;
        let frame_ms = FrameTimes::of(&spent, frame.clock).ok_or(Error::NothingDrawn)?;
        let adapter = self.adapter();
        let mut stats =
            Stats::new(&frame, frame_ms, adapter, self.method_name(), self.compile.clone());
        match self.engine() {
            Engine::Gpu(pipeline) if pipeline.leaves_out() => {
                let why = "rays visit the parts that can matter to them, which `sdfc bench` counts";
                stats.leaf_evals_per_pixel = LeafEvaluations::unknown(why);
            }
            Engine::Gpu(_) | Engine::Cpu(_) => stats.set_leaves(scene.report.leaves),
        }
        let unproven = self.unproven(&mut stats.pixels);
        stats.why.extend(unproven.clone().map(|why| ("unproven", why)));
        stats.why.extend(self.why.clone().map(|why| ("method", why)));
        let drawn = first_drawn.duration_since(self.start).as_secs_f64() * 1e3;
        stats.set_first_picture(scene.times.front + scene.times.analyze + drawn);
        let again = self.reopened.get().map(|_| AGAIN.to_owned());
        // A region may show nothing, and another camera is the caller's affair.
        let is_whole = self.region.is_none() && self.pose.is_none();
        let empty = is_whole.then(|| why_empty(scene, values, &stats.pixels)).flatten();
        let notes: Vec<String> = self.note.iter().cloned().chain(again).chain(empty).collect();
        let note = (!notes.is_empty()).then(|| notes.join("; "));
        Ok(Picture { image: frame.image, stats, note, unproven })
    }

    /// Changes the size and the camera of the following pictures, without compiling again.
    ///
    /// Returns false and changes nothing if the painter was made without a camera of its own, or if
    /// rays of one camera are parallel and those of the other are not: the shader differs.
    pub fn aim(&mut self, size: [u32; 2], pose: Pose) -> bool {
        let fits = self.pose.is_some_and(|before| before.parallel == pose.parallel);
        if fits {
            (self.size, self.pose) = (size, Some(pose));
        }
        fits
    }

    /// The name of the ray method; "none" for a planar picture.
    fn method_name(&self) -> &'static str {
        if self.program.is_planar() { "none" } else { self.method.name() }
    }

    /// Returns what part of a picture with these pixels is unproven, and counts it.
    fn unproven(&self, pixels: &mut PixelCounts) -> Option<String> {
        let all = pixels.all();
        let why = if self.method.definition().misses_thin_parts && !self.program.is_planar() {
            pixels.unproven = all;
            "its samples are a step apart, and what is thinner may lie between two of them"
        } else if self.scene.trusts_uncertified(self.method) {
            pixels.unproven = all;
            "the field is uncertified, and its value is the length of the steps"
        } else if pixels.unproven > pixels.capped {
            "bounds of the field are too wide to tell, so the rays were sampled"
        } else {
            "the rays ran out of steps"
        };
        let why = match self.scene.steepest_shape() {
            Some(shape) if pixels.unproven <= pixels.capped => format!("{why}; {shape}"),
            Some(_) | None => why.to_owned(),
        };
        if pixels.loops_ended > 0 {
            return Some(format!(
                "{} of {all} pixels may be wrong: the driver ended their loops early, as \
                 llvmpipe of Mesa 22.3 does after 65,535 iterations; draw with a newer driver or on \
                 the CPU, or use fewer parts",
                pixels.loops_ended
            ));
        }
        let (unproven, method) = (pixels.unproven, self.method);
        (unproven > 0).then(|| {
            format!(
                "{unproven} of {all} pixels are unproven with `{method}`: {why}; parts may be \
                 missing or wrong"
            )
        })
    }

    fn view(&self, values: &FrameValues) -> Result<View, Error> {
        let view = match &self.pose {
            Some(pose) => {
                let (program, bounds) = (self.scene.drawn(), self.scene.bounds_at(values));
                View::from_pose(program, values, bounds, self.size, pose)?
            }
            None => self.scene.view(values, self.size)?,
        };
        let view = if self.hdr { View { exposure: None, ..view } } else { view };
        Ok(view.with_scaled_parameter(self.method.definition().parameter, self.tolerance))
    }

    /// The GPU that draws; `None` for the CPU.
    pub fn adapter(&self) -> Option<&AdapterInfo> {
        match self.engine() {
            Engine::Gpu(pipeline) => Some(pipeline.gpu().info()),
            Engine::Cpu(_) => None,
        }
    }

    /// Returns the mean of all samples in linear light. Depth and status are those of the first
    /// sample, which is nearest to the centre of the pixel.
    fn averaged(
        &self,
        view: &View,
        values: &FrameValues,
        progress: &mut OnProgress<'_>,
    ) -> Result<Frame, RenderError> {
        let count = self.samples.len() as u64;
        let (mut mean, mut old): (Option<Frame>, Option<Image>) = (None, None);
        for (place, before) in self.samples.iter().zip(0..) {
            let mut part = |part: Progress| {
                let done = part.total * before + part.done;
                progress(Progress { done, total: part.total * count })
            };
            let frame = self.one(old.take(), &view.shifted(*place), values, &mut part)?;
            match &mut mean {
                None => mean = Some(frame),
                Some(mean) => {
                    mean.image.add(&frame.image);
                    mean.milliseconds += frame.milliseconds;
                    mean.tiles += frame.tiles;
                    old = Some(frame.image);
                }
            }
        }
        let mut mean = mean.ok_or(RenderError::Samples(0))?;
        mean.image.divide(self.samples.len() as f32);
        Ok(mean)
    }

    /// The engine that draws the next picture.
    fn engine(&self) -> &Engine {
        self.reopened.get().unwrap_or(&self.engine)
    }

    /// Draws one frame, on a GPU in the memory of a picture that is no longer needed. If the device
    /// fails, another one draws it in smaller tiles; if that fails too, the failure is the result.
    fn one(
        &self,
        old: Option<Image>,
        view: &View,
        values: &FrameValues,
        progress: &mut OnProgress<'_>,
    ) -> Result<Frame, RenderError> {
        let drawn = self.drawn(old, view, values, progress);
        match drawn {
            Err(error) if error.is_device_failure() && self.reopened.get().is_none() => {
                let engine = self.reopen().ok_or(error)?;
                self.reopened.get_or_init(|| engine);
                self.drawn(None, view, values, progress)
            }
            drawn => drawn,
        }
    }

    /// Opens the device anew and compiles the scene for it.
    fn reopen(&self) -> Option<Engine> {
        let gpu = Gpu::new().ok()?;
        let parallel = self.pose.map(|pose| pose.parallel);
        let made = self.scene.pipeline(&gpu, &self.program, self.method, parallel);
        made.ok().map(|(engine, _)| engine)
    }

    fn drawn(
        &self,
        old: Option<Image>,
        view: &View,
        values: &FrameValues,
        progress: &mut OnProgress<'_>,
    ) -> Result<Frame, RenderError> {
        let tile_size = match self.reopened.get() {
            Some(_) => TileSize::Adaptive { milliseconds: SMALL_TILE_MS },
            None => TileSize::default(),
        };
        let options = RenderOptions { region: self.region, tile_size };
        match self.engine() {
            Engine::Gpu(pipeline) => {
                let uniforms = uniform_values(&self.program, values);
                pipeline.render_in_place_of(old, view, &uniforms, &options, progress)
            }
            Engine::Cpu(scene) => scene.render(view, values, self.method, &options, progress),
        }
    }
}

/// Frames of the same picture.
struct Repeated {
    /// The last of them.
    frame: Frame,
    /// The time of each in milliseconds.
    spent: Vec<f64>,
    /// When the first was drawn.
    first_drawn: Instant,
}

fn repeated(
    repetitions: u32,
    mut draw: impl FnMut() -> Result<Frame, RenderError>,
) -> Result<Repeated, RenderError> {
    let mut frame = draw()?;
    let first_drawn = Instant::now();
    let mut spent = vec![frame.milliseconds];
    for _ in 1..repetitions {
        frame = draw()?;
        spent.push(frame.milliseconds);
    }
    Ok(Repeated { frame, spent, first_drawn })
}

#[cfg(test)]
mod tests {
    use sdfc_render::{Clock, Footprint};

    use super::*;

    #[test]
    fn the_first_picture_is_there_before_the_next_one_begins() {
        let mut begins = Vec::new();
        let frame = || -> Result<Frame, RenderError> {
            begins.push(Instant::now());
            let image = Image::new([1, 1], Footprint::default())?;
            let (milliseconds, tiles) = (begins.len() as f64, 1);
            Ok(Frame { image, milliseconds, clock: Clock::Gpu, tiles, culling_evaluations: 0 })
        };
        let Repeated { spent, first_drawn, .. } = repeated(3, frame).unwrap();
        assert_eq!(spent, [1.0, 2.0, 3.0]);
        assert!((begins[0]..=begins[1]).contains(&first_drawn));
    }
}
