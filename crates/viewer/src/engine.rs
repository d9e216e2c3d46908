//! What draws scenes: pipelines, made on two devices that take turns.
//!
//! The running pipeline is taken over where a scene gives the same shader, however else it differs. Two devices, because one
//! that compiles for a pipeline may hold up what is drawn on it.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

use sdfc::codegen::{Shader, render_module_with_camera};
use sdfc::graph::Program;
use sdfc::render::{CpuScene, Gpu, Pipeline, RenderError, milliseconds_since};
use sdfc::{Error, Marched, Scene};

use crate::model::{Engine, Stages};

/// What draws a scene, and with which method; what is otherwise than asked.
pub struct Prepared {
    /// What draws it.
    pub engine: Engine,
    /// The method.
    pub method: String,
    /// The program with what the method asks for, where it is not that of the scene.
    pub enclosed: Option<Program>,
    /// What is otherwise than asked.
    pub note: Option<String>,
}

impl Prepared {
    fn new(engine: Engine, marched: Marched<'_>, elsewhere: Option<String>) -> Self {
        let notes: Vec<String> = elsewhere.into_iter().chain(marched.note).collect();
        let note = (!notes.is_empty()).then(|| notes.join("; "));
        let enclosed = match marched.program {
            Cow::Owned(program) => Some(program),
            Cow::Borrowed(_) => None,
        };
        Self { engine, method: marched.method, enclosed, note }
    }
}

/// A pipeline, and what it was made from.
struct Running {
    text: Text,
    lists: Lists,
    pipeline: Arc<Pipeline>,
}

/// What a driver compiles for a scene.
#[derive(Debug, PartialEq, Eq)]
struct Text {
    picture: String,
    /// What runs before it, and how many rounds each of its loops has.
    culling: Option<(String, Vec<u32>)>,
}

impl Text {
    fn of(shader: &Shader) -> Result<Self, Error> {
        let culling = shader.culling().map(|it| Ok((it.shader.wgsl()?, it.iterations.clone())));
        let culling = culling.transpose().map_err(Error::Codegen)?;
        Ok(Self { picture: shader.wgsl().map_err(Error::Codegen)?, culling })
    }
}

/// What both read from buffers.
#[derive(Debug, PartialEq)]
struct Lists([Vec<[f32; 4]>; 2]);

impl Lists {
    fn of(shader: &Shader) -> Self {
        let culling = shader.culling().map(|culling| culling.shader.lists());
        Self([shader.lists(), culling.unwrap_or_default()].map(<[_]>::to_vec))
    }
}

/// What is kept from one scene to the next.
#[derive(Default)]
pub struct Engines {
    /// The running shader, its lists, and its pipeline.
    running: Option<Running>,
    devices: [Option<Gpu>; 2],
    turn: usize,
    /// How many pipelines have been made.
    pub pipelines: u64,
}

impl Engines {
    /// What draws a scene on a device, by rays that are parallel or not, and with which method. `begins` is asked before a
    /// pipeline is made, which may take a while; `None` where it says no.
    ///
    /// # Errors
    ///
    /// [`Error::Codegen`] where there is no shader for it, [`Error::Render`] where the device makes no pipeline of it.
    pub fn on_device(
        &mut self,
        scene: &Scene,
        wanted: &str,
        parallel: bool,
        stages: &mut Stages,
        begins: impl FnOnce() -> bool,
    ) -> Result<Option<Prepared>, Error> {
        let start = Instant::now();
        let marched = scene.marched(wanted);
        let shader = render_module_with_camera(&marched.program, &marched.method, parallel);
        let shader = shader.map_err(Error::Codegen)?;
        let (text, lists) = (Text::of(&shader)?, Lists::of(&shader));
        stages.lower = milliseconds_since(start);
        if let Some(running) = self.running.as_mut().filter(|running| running.text == text) {
            if running.lists != lists {
                running.pipeline = Arc::new(running.pipeline.with_lists_of(&shader)?);
                running.lists = lists;
            }
            let engine = Engine::Gpu(Arc::clone(&running.pipeline));
            return Ok(Some(Prepared::new(engine, marched, None)));
        }
        if !begins() {
            return Ok(None);
        }
        let gpu = match self.device() {
            Ok(gpu) => gpu,
            Err(error) => {
                let note = format!("drawn on the processor: {error}");
                return on_cpu(scene, wanted, Some(note)).map(Some);
            }
        };
        let start = Instant::now();
        let pipeline = Pipeline::new(&gpu, shader, marched.program.uniforms.len())?;
        stages.pipeline = Some(milliseconds_since(start));
        self.pipelines += 1;
        let pipeline = Arc::new(pipeline);
        self.running = Some(Running { text, lists, pipeline: Arc::clone(&pipeline) });
        Ok(Some(Prepared::new(Engine::Gpu(pipeline), marched, None)))
    }

    /// The device that is not drawing.
    fn device(&mut self) -> Result<Gpu, RenderError> {
        self.turn = (self.turn + 1) % self.devices.len();
        let place = &mut self.devices[self.turn];
        if let Some(gpu) = place {
            return Ok(gpu.clone());
        }
        let gpu = Gpu::new()?;
        *place = Some(gpu.clone());
        Ok(gpu)
    }

    /// Whether devices were opened that may be lost by now.
    pub fn has_devices(&self) -> bool {
        self.devices.iter().any(Option::is_some)
    }

    /// Opens others from then on.
    pub fn forget_devices(&mut self) {
        self.devices = [None, None];
        self.running = None;
    }
}

/// What draws a scene on the processor, and `why` that is so.
///
/// # Errors
///
/// Where the processor cannot draw it either.
pub fn on_cpu(scene: &Scene, wanted: &str, why: Option<String>) -> Result<Prepared, Error> {
    let marched = scene.marched_on_cpu(wanted);
    let engine = Engine::Cpu(Arc::new(CpuScene::new(&marched.program)?));
    Ok(Prepared::new(engine, marched, why))
}
