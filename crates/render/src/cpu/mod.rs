//! The CPU renderer, for machines without a GPU and as a check of the shader.
//!
//! It is a second implementation of `sphere`, `auto` and `interval` and of the shading, on purpose:
//! it shares only the scene's formula with the shader. It works in waves: all camera rays of a
//! group of pixels, then normals and materials of all hits, then all rays to a light; and the same
//! again for all reflections. A planar picture has no rays: its pixels are one formula.

mod cells;
mod environment;
mod gradients;
pub(crate) mod method;
mod pixels;
mod planar;
mod planar_cells;
mod pre_intersection;
mod ray;
mod shade;
mod surroundings;
mod trace;
mod wave;

use std::sync::Arc;
use std::time::Instant;

#[cfg(feature = "threads")]
use rayon::prelude::*;
use sdfc_graph::{
    Program,
    eval::{FrameValues, Packet, Tape, TapeError},
};
use sdfc_march::{Method, PixelBlock};

use crate::clock::{Clock, milliseconds_since};
use crate::error::RenderError;
use crate::frame::{Frame, OnProgress, Progress, RenderOptions, no_progress, region_of};
use crate::image::Image;
use crate::tiles::{Tile, Tiler};
use crate::view::View;
use cells::{CachedField, Cells};
use environment::EnvironmentTapes;
use gradients::Gradient;
use method::CpuMethod;
use pixels::Pixels;
use planar::PlanarPixels;
use planar_cells::PlanarCells;
use pre_intersection::PreIntersectionTapes;
use ray::LANES;
use trace::Limits;
use wave::Wave;

pub use ray::Real;

/// Columns and rows of pixels that a thread takes at a time.
const BLOCK: u32 = 32;
/// Columns and rows of pixels whose rays stay together.
const GROUP: u32 = 16;
/// The maximum number of pixels of a tile; threads wait for each other at its end.
const MAX_TILE_PIXELS: u32 = 1 << 20;

/// A program, compiled for the CPU.
#[derive(Clone, Debug)]
pub struct CpuScene {
    field: CachedField,
    /// The analytic pre-intersection, for methods that ask for it.
    pre_intersection: Option<PreIntersectionTapes>,
    /// Bounds of the marched part of the field on a segment, for the method that asks for them.
    range: Option<Tape>,
    gradient: Option<Tape>,
    /// The material of a surface that is seen, see `Program::seen_material`.
    material: Option<Tape>,
    /// What the distance is likely to be, see `Program::estimate`.
    estimate: Option<Tape>,
    /// The gradient and the value of the field, if soft shadows follow its gradients.
    projection: Option<Tape>,
    environment: Option<EnvironmentTapes>,
    /// True if a small value of the field may be far from the surface.
    is_loose: bool,
    /// The pixel of a planar picture, which replaces all others.
    planar_pixel: Option<Arc<Tape>>,
}

impl CpuScene {
    /// The ray methods that it has, the default first.
    pub const METHODS: [Method; 3] = CpuMethod::METHODS;

    /// Compiles a program.
    ///
    /// # Errors
    ///
    /// [`RenderError::NothingDrawn`], [`RenderError::Evaluator`] if the program is not flat.
    pub fn new(program: &Program) -> Result<Self, RenderError> {
        let distance = program.distance.ok_or(RenderError::NothingDrawn)?;
        let refused = |error: TapeError| RenderError::Evaluator(error.to_string());
        let tape = |roots: &[_]| Tape::new(&program.graph, roots).map_err(refused);
        let material = program.seen_material.or(program.material);
        let material = material.map(|fields| Tape::for_surfaces(&program.graph, &fields));
        let planar_pixel =
            program.planar_pixel.map(|pixel| Tape::for_rays(&program.graph, &[pixel]));
        let projected = program.gradient.filter(|_| program.falls_behind);
        let range = program.range.map(|range| Tape::for_rays(&program.graph, &[range]));
        Ok(Self {
            field: CachedField::new(tape(&[distance])?),
            pre_intersection: PreIntersectionTapes::new(program).map_err(refused)?,
            range: range.transpose().map_err(refused)?,
            gradient: program.gradient.map(|gradient| tape(&[gradient])).transpose()?,
            material: material.transpose().map_err(refused)?,
            estimate: program.estimate.map(|estimate| tape(&[estimate])).transpose()?,
            projection: projected.map(|gradient| tape(&[gradient, distance])).transpose()?,
            environment: EnvironmentTapes::new(program).map_err(refused)?,
            is_loose: program.is_loose,
            planar_pixel: planar_pixel.transpose().map_err(refused)?.map(Arc::new),
        })
    }

    /// Draws a frame in f32, as the shader does. The methods are [`Self::METHODS`].
    ///
    /// # Errors
    ///
    /// [`RenderError::MethodNotOnCpu`], [`RenderError::Size`], [`RenderError::OutOfMemory`],
    /// [`RenderError::Cancelled`], [`RenderError::Evaluator`] if the program has no gradient.
    pub fn render(
        &self,
        view: &View,
        frame: &FrameValues,
        method: Method,
        options: &RenderOptions,
        progress: &mut OnProgress<'_>,
    ) -> Result<Frame, RenderError> {
        self.render_in::<f32>(view, frame, method, options, progress)
    }

    /// Draws a frame, marched in `T`. Pictures of shaders are measured against those in f64.
    ///
    /// # Errors
    ///
    /// As [`Self::render`].
    pub fn render_in<T: Real>(
        &self,
        view: &View,
        frame: &FrameValues,
        method: Method,
        options: &RenderOptions,
        progress: &mut OnProgress<'_>,
    ) -> Result<Frame, RenderError> {
        if let Some(tape) = &self.planar_pixel {
            let cells = PlanarCells::new(tape, view, frame);
            let pixels = PlanarPixels::<T>::new(&cells, view, frame);
            return self.draw(view, options, progress, &pixels);
        }
        if self.gradient.is_none() {
            return Err(RenderError::Evaluator("the program has no gradient".to_owned()));
        }
        let method = known_method(method)?;
        let cells = |field: &CachedField| field.cells(frame, view, method.skips_proven());
        let fields = Fields { whole: cells(&self.field), marched: self.marched().map(cells) };
        let wave = self.wave::<T>(view, frame, method, &fields);
        let drawn = self.draw(view, options, progress, &self.shaded(wave, frame));
        drop(fields);
        [Some(&self.field), self.marched()].into_iter().flatten().for_each(CachedField::end_frame);
        drawn
    }

    /// Traces the camera rays alone, marched in `T`: depth, status and evaluations, without
    /// colours. Each ray takes all its steps through the whole field, as in the shader.
    ///
    /// # Errors
    ///
    /// As [`Self::render`], but a gradient is not needed. [`RenderError::Planar`] if the program is
    /// planar.
    pub fn depth_map<T: Real>(
        &self,
        view: &View,
        frame: &FrameValues,
        method: Method,
    ) -> Result<Image, RenderError> {
        if self.planar_pixel.is_some() {
            return Err(RenderError::Planar);
        }
        let cells = |field: &CachedField| field.whole(frame);
        let fields = Fields { whole: cells(&self.field), marched: self.marched().map(cells) };
        let wave = self.wave::<T>(view, frame, known_method(method)?, &fields);
        Ok(self.draw(view, &RenderOptions::default(), &mut no_progress, &wave)?.image)
    }

    /// Counts the camera rays that `method` leaves unproven, marched in f32. It stops at the first
    /// rays by which there are more than `most`. A ray has fewer steps than the view says, if all
    /// rays together might take more than `work` scalar operations. If there is not one step for
    /// each, all count as unproven.
    ///
    /// # Errors
    ///
    /// As [`Self::depth_map`].
    pub fn unproven_rays(
        &self,
        view: &View,
        frame: &FrameValues,
        method: Method,
        most: u64,
        work: u64,
    ) -> Result<u64, RenderError> {
        if self.planar_pixel.is_some() {
            return Err(RenderError::Planar);
        }
        let cells = |field: &CachedField| field.whole(frame);
        let fields = Fields { whole: cells(&self.field), marched: self.marched().map(cells) };
        let mut wave = self.wave::<f32>(view, frame, known_method(method)?, &fields);
        let [width, height] = view.size;
        let rays = u64::from(width) * u64::from(height);
        let range = self.range.as_ref().map_or(0, Tape::operations);
        let field = self.marched().unwrap_or(&self.field).tape.operations();
        let step = rays.saturating_mul(field.saturating_add(range) as u64);
        let steps = u32::try_from(work / step.max(1)).unwrap_or(u32::MAX);
        if steps == 0 {
            return Ok(rays);
        }
        wave.limits.steps = wave.limits.steps.min(steps);
        wave.limits.ends_unproven = true;
        let positions: Vec<[u32; 2]> =
            (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).collect();
        let mut unproven = 0;
        for group in positions.chunks(LANES) {
            let pixels = wave.pixels(group);
            unproven += pixels.iter().filter(|pixel| pixel.unproven != 0).count() as u64;
            if unproven > most {
                break;
            }
        }
        Ok(unproven)
    }

    /// The part of the field that is marched where the rest is intersected analytically.
    fn marched(&self) -> Option<&CachedField> {
        self.pre_intersection.as_ref().and_then(PreIntersectionTapes::marched)
    }

    fn wave<'a, T: Real>(
        &'a self,
        view: &'a View,
        frame: &FrameValues,
        method: CpuMethod,
        fields: &'a Fields<'a>,
    ) -> Wave<'a, T> {
        Wave {
            view,
            limits: Limits {
                method,
                epsilon: T::constant(view.epsilon),
                steps: view.steps,
                records_clearance: false,
                full_light: T::constant(0.0),
                ends_at_light: false,
                ends_unproven: false,
                is_loose: self.is_loose,
            },
            field: &fields.whole,
            marched: fields.marched.as_ref(),
            pre_intersection: self
                .pre_intersection
                .as_ref()
                .filter(|_| method.pre_intersects())
                .map(|a| a.prepare(frame)),
            range: self.range.as_ref().map(|tape| tape.prepare(frame)),
            gradient: None,
            material: None,
            estimate: None,
            projection: None,
            environment: None,
        }
    }

    /// The wave with normals and materials.
    fn shaded<'a, T: Real>(&'a self, wave: Wave<'a, T>, frame: &FrameValues) -> Wave<'a, T> {
        let prepare = |tape: &'a Tape| tape.prepare::<Packet<T, { LANES }>>(frame);
        Wave {
            gradient: self
                .gradient
                .as_ref()
                .map(|tape| Gradient { whole: prepare(tape), operations: tape.operations() }),
            material: self.material.as_ref().map(prepare),
            estimate: self.estimate.as_ref().map(prepare),
            projection: self.projection.as_ref().map(prepare),
            environment: self.environment.as_ref().map(|tapes| tapes.prepare(frame)),
            ..wave
        }
    }

    fn draw(
        &self,
        view: &View,
        options: &RenderOptions,
        progress: &mut OnProgress<'_>,
        pixels: &impl Pixels,
    ) -> Result<Frame, RenderError> {
        let region = region_of(view.size, options)?;
        let mut image = Image::new(region.size, view.footprint())?;
        let mut tiler = Tiler::new(view.size, region, options.tile_size, MAX_TILE_PIXELS)
            .starting_with(BLOCK * BLOCK);
        let (mut milliseconds, mut tiles, mut done) = (0.0, 0, 0);
        let total = tiler.pixels();
        while let Some(tile) = tiler.next() {
            let start = now();
            for (groups, drawn) in draw_tile(pixels, tile) {
                let mut rest = drawn.as_slice();
                for group in groups {
                    let (pixels, others) = rest.split_at(group.pixels().min(rest.len()));
                    image.put(region.origin, group, pixels, |pixel| *pixel);
                    rest = others;
                }
            }
            let elapsed = start.map_or(0.0, milliseconds_since);
            tiler.took(tile, elapsed);
            milliseconds += elapsed;
            tiles += 1;
            done += tile.pixels() as u64;
            if progress(Progress { done, total }).is_break() {
                return Err(RenderError::Cancelled);
            }
        }
        Ok(Frame { image, milliseconds, clock: Clock::Wall, tiles, culling_evaluations: 0 })
    }
}

/// The fields that rays march through.
struct Fields<'a> {
    whole: Cells<'a>,
    marched: Option<Cells<'a>>,
}

fn known_method(method: Method) -> Result<CpuMethod, RenderError> {
    CpuMethod::of(method).ok_or(RenderError::MethodNotOnCpu(method))
}

/// The current time; `None` if there is no clock, as in WebAssembly.
fn now() -> Option<Instant> {
    (!cfg!(target_family = "wasm")).then(Instant::now)
}

/// Draws the blocks of a tile on all threads.
fn draw_tile<P: Pixels>(pixels: &P, tile: Tile) -> Vec<(Vec<Tile>, Vec<PixelBlock>)> {
    let blocks = tile.blocks(BLOCK);
    let draw = |pixels: &mut P, block: Tile| {
        let groups = block.blocks(GROUP);
        let positions: Vec<[u32; 2]> = groups
            .iter()
            .flat_map(|group| (0..group.pixels()).map(|index| group.position(index)))
            .collect();
        (groups, pixels.pixels(&positions))
    };
    #[cfg(feature = "threads")]
    return blocks.into_par_iter().map_init(|| pixels.clone(), draw).collect();
    #[cfg(not(feature = "threads"))]
    {
        let mut pixels = pixels.clone();
        blocks.into_iter().map(|block| draw(&mut pixels, block)).collect()
    }
}

#[cfg(test)]
mod tests;
