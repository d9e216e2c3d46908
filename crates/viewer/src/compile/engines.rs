//! Prepares a scene for drawing: pipelines on two GPU devices, or the CPU renderer.
//!
//! The running pipeline is reused if a scene gives the same shader. New pipelines are made on the
//! device that is not drawing, because a device that compiles a pipeline may delay other work
//! submitted to it.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

use sdfc::{Error, Marched, Method, Scene};
use sdfc_codegen::{Shader, render_module_with_camera};
use sdfc_graph::Program;
use sdfc_render::{CpuScene, Gpu, Pipeline, RenderError, milliseconds_since};

use crate::render::window_device::WindowDevice;
use crate::scene::model::{BuildTimes, Engine};

/// A scene that is ready to be drawn.
pub struct PreparedEngine {
    /// The pipeline or the CPU renderer.
    pub engine: Engine,
    /// The ray method that is used.
    pub method: Method,
    /// The program with the method's additions; `None` if the method adds nothing.
    pub method_program: Option<Program>,
    /// A note for the user if the request could not be followed, with the reason.
    pub note: Option<String>,
}

impl PreparedEngine {
    fn new(engine: Engine, marched: Marched<'_>, why_cpu: Option<String>) -> Self {
        let notes: Vec<String> = why_cpu.into_iter().chain(marched.note).collect();
        let note = (!notes.is_empty()).then(|| notes.join("; "));
        let method_program = match marched.program {
            Cow::Owned(program) => Some(program),
            Cow::Borrowed(_) => None,
        };
        Self { engine, method: marched.method, method_program, note }
    }
}

/// The pipeline that draws, and the sources and lists that it was made from.
struct RunningPipeline {
    sources: ShaderSources,
    lists: ShaderLists,
    pipeline: Arc<Pipeline>,
}

/// The shader source that the driver compiles for a scene.
#[derive(Debug, PartialEq, Eq)]
struct ShaderSources {
    picture: String,
    /// The culling pass, and the iteration count of each of its loops.
    culling: Option<(String, Vec<u32>)>,
}

impl ShaderSources {
    fn new(shader: &Shader) -> Result<Self, Error> {
        let culling = shader.culling().map(|it| Ok((it.shader.wgsl()?, it.iterations.clone())));
        let culling = culling.transpose().map_err(Error::Codegen)?;
        Ok(Self { picture: shader.wgsl().map_err(Error::Codegen)?, culling })
    }
}

/// The lists that the picture and the culling pass read from storage buffers.
#[derive(Debug, PartialEq)]
struct ShaderLists([Vec<[f32; 4]>; 2]);

impl ShaderLists {
    fn new(shader: &Shader) -> Self {
        let culling = shader.culling().map(|culling| culling.shader.lists());
        Self([shader.lists(), culling.unwrap_or_default()].map(<[_]>::to_vec))
    }
}

/// The devices and the running pipeline, kept from one scene to the next.
#[derive(Default)]
pub struct Engines {
    running: Option<RunningPipeline>,
    devices: [Option<Gpu>; 2],
    /// The device of the window, which then draws in place of the others.
    window: Option<WindowDevice>,
    /// Index of the device that the running pipeline is on.
    drawing_device: usize,
    /// The number of pipelines made so far.
    pub pipelines: u64,
}

impl Engines {
    /// Prepares a scene for the GPU, or for the CPU if there is no GPU or if it is a software
    /// driver that draws the scene's long formula slowly. `proceed` is called before a pipeline is
    /// made, which may take seconds; if it returns false, so does this, as `None`.
    ///
    /// # Errors
    ///
    /// [`Error::Codegen`] if no shader can be generated, [`Error::Render`] if the device cannot
    /// make a pipeline of it.
    pub fn on_gpu(
        &mut self,
        scene: &Scene,
        method: Method,
        parallel: bool,
        build_times: &mut BuildTimes,
        proceed: impl FnOnce() -> bool,
    ) -> Result<Option<PreparedEngine>, Error> {
        let start = Instant::now();
        let marched = scene.marched(method);
        let shader = render_module_with_camera(&marched.program, marched.method, parallel);
        let shader = shader.map_err(Error::Codegen)?;
        let (sources, lists) = (ShaderSources::new(&shader)?, ShaderLists::new(&shader));
        build_times.lower = milliseconds_since(start);
        if let Some(running) = self.running.as_mut().filter(|running| running.sources == sources) {
            if running.lists != lists {
                running.pipeline = Arc::new(running.pipeline.with_lists_of(&shader)?);
                running.lists = lists;
            }
            let engine = Engine::Gpu(Arc::clone(&running.pipeline));
            return Ok(Some(PreparedEngine::new(engine, marched, None)));
        }
        if !proceed() {
            return Ok(None);
        }
        let gpu = match self.next_device() {
            Ok(gpu) => gpu,
            Err(error) => {
                let note = format!("drawn on the CPU: {error}");
                return on_cpu(scene, method, Some(note)).map(Some);
            }
        };
        if let Some(why) = scene.faster_on_cpu(&gpu, method) {
            return on_cpu(scene, method, Some(why)).map(Some);
        }
        let start = Instant::now();
        let pipeline = Pipeline::new(&gpu, shader, marched.program.uniforms.len())?;
        build_times.pipeline = Some(milliseconds_since(start));
        self.pipelines += 1;
        let pipeline = Arc::new(pipeline);
        self.running = Some(RunningPipeline { sources, lists, pipeline: Arc::clone(&pipeline) });
        Ok(Some(PreparedEngine::new(Engine::Gpu(pipeline), marched, None)))
    }

    /// Switches to the device that is not drawing, and opens it if needed. The device of a window
    /// is that of a GPU, whose driver can compile while it draws.
    fn next_device(&mut self) -> Result<Gpu, RenderError> {
        if let Some(window) = &self.window {
            return Ok(window.gpu().clone());
        }
        self.drawing_device = (self.drawing_device + 1) % self.devices.len();
        let device = &mut self.devices[self.drawing_device];
        if let Some(gpu) = device {
            return Ok(gpu.clone());
        }
        let gpu = Gpu::new()?;
        *device = Some(gpu.clone());
        Ok(gpu)
    }

    /// Draws on the device of the window from now on, or on devices without a window.
    pub fn set_window(&mut self, window: Option<&WindowDevice>) {
        if self.window.as_ref() != window {
            self.drop_devices();
            self.window = window.cloned();
        }
    }

    /// True if the device of the window draws.
    pub fn draw_on_window(&self) -> bool {
        self.window.is_some()
    }

    /// Returns true if a device is open, which may be lost by now.
    pub fn has_devices(&self) -> bool {
        self.window.is_some() || self.devices.iter().any(Option::is_some)
    }

    /// Drops the devices and the running pipeline; new devices are opened when needed.
    pub fn drop_devices(&mut self) {
        self.devices = [None, None];
        self.running = None;
    }
}

/// Prepares a scene for the CPU; `why` becomes a part of the note.
///
/// # Errors
///
/// The CPU renderer cannot draw the scene.
pub fn on_cpu(scene: &Scene, method: Method, why: Option<String>) -> Result<PreparedEngine, Error> {
    let marched = scene.marched_on_cpu(method);
    let engine = Engine::Cpu(Arc::new(CpuScene::new(&marched.program)?));
    Ok(PreparedEngine::new(engine, marched, why))
}
