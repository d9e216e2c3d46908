//! Pictures: time to the first one, time of a further one, and whether both programs agree.

use std::time::{Duration, Instant};

use anyhow::Result;
use cpu_time::ProcessTime;
use fidget::eval::MathFunction;
use fidget::raster::{pixel, voxel};
use fidget::render::RenderHints;
use fidget::shape::{BoundShape, Shape};
use sdfc::{Backend, PictureOptions, Pose};

use crate::model::{Model, View};

/// What draws a picture.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Renderer {
    FidgetJit,
    FidgetVm,
    SdfcCpu,
    SdfcGpu,
}

impl Renderer {
    pub const ALL: [Self; 4] = [Self::FidgetJit, Self::FidgetVm, Self::SdfcCpu, Self::SdfcGpu];

    pub fn name(self) -> &'static str {
        match self {
            Self::FidgetJit => "fidget-jit",
            Self::FidgetVm => "fidget-vm",
            Self::SdfcCpu => "sdfc-cpu",
            Self::SdfcGpu => "sdfc-gpu",
        }
    }
}

/// Times and pixels of one renderer.
pub struct Drawn {
    /// CPU time of the process, and elapsed time, from its start to the first picture.
    pub first: [Duration; 2],
    /// The same of a further picture; the least of all.
    pub frame: [Duration; 2],
    /// For each pixel, row by row from the top: how deep in the cube the surface is, from 0 to 2
    /// (in a planar picture 0); -1 if there is none.
    pub depths: Vec<f32>,
    /// Device and method, or why the picture is not proven.
    pub note: String,
}

/// Draws the model by parallel rays along z, `frames` times after the first picture. The first
/// picture includes all work from the text of a file that the program can read itself.
pub fn draw(model: &Model, renderer: Renderer, size: u32, frames: u32) -> Result<Drawn> {
    let view = model.view()?;
    let job = Job { model, view, size, frames };
    match renderer {
        Renderer::FidgetJit => job.by_fidget::<fidget::jit::JitFunction>(),
        Renderer::FidgetVm => job.by_fidget::<fidget::vm::VmFunction>(),
        Renderer::SdfcCpu => job.by_sdfc(Backend::Cpu),
        Renderer::SdfcGpu => job.by_sdfc(Backend::Gpu),
    }
}

struct Job<'m> {
    model: &'m Model,
    view: View,
    size: u32,
    frames: u32,
}

struct Clock(Instant, ProcessTime);

impl Clock {
    fn start() -> Self {
        Self(Instant::now(), ProcessTime::now())
    }

    fn elapsed(&self) -> [Duration; 2] {
        [self.1.elapsed(), self.0.elapsed()]
    }
}

impl Job<'_> {
    fn by_fidget<F: MathFunction + RenderHints + Clone>(&self) -> Result<Drawn> {
        let tree = self.model.tree()?;
        let start = Clock::start();
        let (context, root) = self.model.context(tree.as_ref())?;
        let shape = BoundShape::try_from(Shape::<F>::new(&context, root)?)?;
        let size = self.size;
        let flat = pixel::RenderConfig::from_size(size.into());
        let deep = voxel::RenderConfig {
            world_to_model: self.view.matrix(),
            ..voxel::RenderConfig::from_size(size.into())
        };
        let depth = |pixel: &voxel::GeometryPixel| match pixel.depth {
            0 => -1.0,
            depth => 2.0 - 2.0 * depth as f32 / size as f32,
        };
        let is_planar = self.view.is_planar;
        let (depths, first, frame) = self.timed(&start, || {
            if !is_planar {
                return Ok(deep.run(shape.clone()).iter().map(depth).collect());
            }
            let image = flat.run(shape.clone());
            Ok(image.iter().map(|pixel| if pixel.inside() { 0.0 } else { -1.0 }).collect())
        })?;
        Ok(Drawn { first, frame, depths, note: String::new() })
    }

    fn by_sdfc(&self, backend: Backend) -> Result<Drawn> {
        let View { is_planar, center, half } = self.view;
        let start = Clock::start();
        let scene = self.model.scene()?;
        let mut options = PictureOptions::new().size([self.size; 2]).backend(backend).samples(1);
        if !is_planar {
            let [x, y, z] = center;
            let eye = [x, y, z + half];
            options = options.pose(Pose::with_height(eye, center, [0.0, 1.0, 0.0], 2.0 * half)?);
        }
        let painter = scene.painter(&options)?;
        let defaults = scene.defaults();
        let (picture, first, frame) =
            self.timed(&start, || Ok(painter.paint(&defaults, 1, &mut sdfc::no_progress)?))?;
        let depths = picture.image.pixels().iter().map(|pixel| {
            let depth = pixel.depth / half as f32;
            match pixel.status {
                1 if is_planar => 0.0,
                1 if depth <= 2.0 => depth.max(0.0),
                _ => -1.0,
            }
        });
        let stats = &picture.stats;
        let device = stats.driver.clone().unwrap_or_else(|| stats.backend.clone());
        let unproven = match stats.pixels.unproven {
            0 => String::new(),
            count => format!(", {count} unproven"),
        };
        let note = format!("{} on {device}{unproven}", stats.method);
        Ok(Drawn { first, frame, depths: depths.collect(), note })
    }

    /// Draws once, then `frames` times.
    fn timed<T>(
        &self,
        start: &Clock,
        mut draw: impl FnMut() -> Result<T>,
    ) -> Result<(T, [Duration; 2], [Duration; 2])> {
        let mut picture = draw()?;
        let first = start.elapsed();
        let mut frame = [Duration::MAX; 2];
        for _ in 0..self.frames {
            let start = Clock::start();
            picture = draw()?;
            let elapsed = start.elapsed();
            frame = [0, 1].map(|clock: usize| frame[clock].min(elapsed[clock]));
        }
        Ok((picture, first, frame))
    }
}

/// The number of pixels that are a surface in one picture only, also of the eight around them, and
/// of those that are nowhere near as deep as one of these in the other picture, by three voxels.
pub fn differences(a: &[f32], b: &[f32], size: u32) -> [usize; 2] {
    let size = size as usize;
    let near = |picture: &[f32], at: usize| -> Vec<f32> {
        let (x, y) = (at % size, at / size);
        let rows = y.saturating_sub(1)..(y + 2).min(size);
        let columns = x.saturating_sub(1)..(x + 2).min(size);
        rows.flat_map(|row| columns.clone().map(move |column| row * size + column))
            .map(|at| picture[at])
            .collect()
    };
    let mut counts = [0, 0];
    for at in 0..size * size {
        for (one, other) in [(a, b), (b, a)] {
            if one[at] < 0.0 {
                continue;
            }
            let depths: Vec<f32> = near(other, at).into_iter().filter(|&d| d >= 0.0).collect();
            let voxel = 2.0 / size as f32;
            if depths.is_empty() {
                counts[0] += 1;
            } else if depths.iter().all(|depth| (depth - one[at]).abs() > 3.0 * voxel) {
                counts[1] += 1;
            }
        }
    }
    counts
}
