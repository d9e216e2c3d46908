//! From a compiled scene to a picture, on the GPU or the CPU.

use std::time::Instant;

use sdfc_codegen::render_module;
use sdfc_graph::eval::{FrameValues, evaluate_frame};
use sdfc_render::{
    AdapterInfo, CompileTimes, CpuScene, Frame, FrameTimes, Gpu, Image, OnProgress, Pipeline,
    RenderError, RenderOptions, Stats, View, Why,
};

use crate::compile::milliseconds;
use crate::{Error, Scene};

/// Where a picture is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// On the GPU if there is an adapter, else on the CPU.
    #[default]
    Auto,
    /// On the GPU, or not at all.
    Gpu,
    /// On the CPU.
    Cpu,
}

/// How a picture is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Ray method; `None` takes the scene's, or `auto`.
    pub method: Option<String>,
    /// Where.
    pub backend: Backend,
    /// Values of params, time and frame; `None` takes the defaults at time 0.
    pub frame: Option<FrameValues>,
    /// How often the frame is drawn, to time it; at least 1.
    pub repetitions: u32,
}

impl Default for PictureOptions {
    /// 640 by 360, everything else left to the scene and the machine.
    fn default() -> Self {
        let (size, backend, repetitions) = ([640, 360], Backend::Auto, 1);
        Self { size, method: None, backend, frame: None, repetitions }
    }
}

/// A finished picture.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Pixels: colour, depth, status, evaluations.
    pub image: Image,
    /// Figures.
    pub stats: Stats,
    /// Why it was drawn elsewhere than asked, in one line.
    pub note: Option<String>,
}

impl Scene {
    /// The method that pictures are marched with unless told otherwise.
    pub fn method(&self) -> &str {
        self.program.settings.march.method.as_deref().unwrap_or(sdfc_march::METHODS[0].name)
    }

    /// Draws the scene. `progress` is called now and then and may cancel.
    ///
    /// # Errors
    ///
    /// [`Error::View`] where the settings make no picture, [`Error::Render`] where the machine cannot
    /// draw it, [`Error::Codegen`] where the scene cannot be lowered.
    pub fn render(
        &self,
        options: &PictureOptions,
        progress: &mut OnProgress<'_>,
    ) -> Result<Picture, Error> {
        let start = Instant::now();
        let defaults = || FrameValues::defaults(self.params());
        let values = options.frame.clone().unwrap_or_else(defaults);
        let bounds = self.bounds_at(&values);
        let view = View::new(&self.program, &values, bounds, options.size)?;
        let method = options.method.as_deref().unwrap_or(self.method());
        let request = Request { view, values, method, repetitions: options.repetitions.max(1) };
        let (mut picture, note) = match options.backend {
            Backend::Cpu => (self.render_cpu(&request, progress)?, None),
            Backend::Gpu => (self.render_gpu(&Gpu::new()?, &request, progress)?, None),
            Backend::Auto => match Gpu::new() {
                Ok(gpu) => (self.render_gpu(&gpu, &request, progress)?, None),
                Err(error) => {
                    let note = format!("{error}; drawn on the CPU");
                    (self.render_cpu(&request, progress)?, Some(note))
                }
            },
        };
        let first = self.times.front + self.times.analyze + milliseconds(start);
        let extra = picture.stats.frame_ms.median * f64::from(request.repetitions - 1);
        picture.stats.set_first_picture(first - extra);
        picture.note = note;
        Ok(picture)
    }

    fn render_gpu(
        &self,
        gpu: &Gpu,
        request: &Request<'_>,
        progress: &mut OnProgress<'_>,
    ) -> Result<Picture, Error> {
        let start = Instant::now();
        let shader = render_module(&self.program, request.method)?;
        let validate = shader.validation_time().as_secs_f64() * 1e3;
        let lower = milliseconds(start) - validate;
        let slots = &self.program.uniforms;
        let uniforms: Vec<[f32; 4]> = evaluate_frame(&self.program.graph, slots, &request.values)
            .into_iter()
            .map(|lanes| lanes.map(|lane| lane as f32))
            .collect();
        let pipeline = Pipeline::new(gpu, shader, uniforms.len())?;
        let compile = CompileTimes {
            lower: Some(lower),
            validate: Some(validate),
            pipeline: Some(pipeline.milliseconds()),
            ..self.compile_times()
        };
        let (frame, spent) = repeated(request.repetitions, || {
            pipeline.render(&request.view, &uniforms, &RenderOptions::default(), progress)
        })?;
        self.picture(frame, &spent, Some(gpu.info()), request.method, compile)
    }

    fn render_cpu(
        &self,
        request: &Request<'_>,
        progress: &mut OnProgress<'_>,
    ) -> Result<Picture, Error> {
        let start = Instant::now();
        let scene = CpuScene::new(&self.program)?;
        let no_shader = || "drawn on the CPU, without a shader".to_owned();
        let compile = CompileTimes {
            lower: Some(milliseconds(start)),
            why: Why::from([("validate", no_shader()), ("pipeline", no_shader())]),
            ..self.compile_times()
        };
        let (frame, spent) = repeated(request.repetitions, || {
            let options = RenderOptions::default();
            scene.render(&request.view, &request.values, request.method, &options, progress)
        })?;
        self.picture(frame, &spent, None, request.method, compile)
    }

    fn compile_times(&self) -> CompileTimes {
        let (front, analyze) = (Some(self.times.front), Some(self.times.analyze));
        CompileTimes { front, analyze, ..CompileTimes::default() }
    }

    fn picture(
        &self,
        frame: Frame,
        spent: &[f64],
        adapter: Option<&AdapterInfo>,
        method: &str,
        compile_ms: CompileTimes,
    ) -> Result<Picture, Error> {
        let frame_ms = FrameTimes::of(spent, frame.clock).ok_or(Error::NothingDrawn)?;
        let mut stats = Stats::new(&frame, frame_ms, adapter, method, compile_ms);
        stats.set_leaves(self.report.leaves);
        Ok(Picture { image: frame.image, stats, note: None })
    }
}

/// What both renderers need.
struct Request<'a> {
    view: View,
    values: FrameValues,
    method: &'a str,
    repetitions: u32,
}

/// The last frame, and the time that each took.
fn repeated(
    repetitions: u32,
    mut draw: impl FnMut() -> Result<Frame, RenderError>,
) -> Result<(Frame, Vec<f64>), RenderError> {
    let mut frame = draw()?;
    let mut spent = vec![frame.milliseconds];
    for _ in 1..repetitions {
        frame = draw()?;
        spent.push(frame.milliseconds);
    }
    Ok((frame, spent))
}
