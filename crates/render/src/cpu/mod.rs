//! The CPU renderer: for machines without an adapter, and the check of the shader.
//!
//! A second implementation of `sphere`, `auto` and `interval` and of the shading, on purpose: it shares the
//! scene's formula with the shader and nothing else. It works in waves: all rays of a group of
//! pixels from the eye, then normals and materials of all hits, then all rays to a lamp; and the
//! same again for all rays from a mirror.

mod ahead;
mod shade;
mod surroundings;
mod trace;

pub use trace::Real;

use std::time::Instant;

use glam::DVec3;
#[cfg(feature = "threads")]
use rayon::prelude::*;
use sdfc_graph::{
    Program,
    eval::{Evaluator, FrameValues, Packet, Tape, TapeError},
};
use sdfc_march::PixelBlock;

use crate::stats::milliseconds_since;
use crate::{
    Clock, Footprint, Frame, Image, OnProgress, Progress, RenderError, RenderOptions, Tile, View,
    ViewLight, ViewOcclusion, ViewShadow,
    frame::no_progress,
    image::{HIT, check_size},
    tiles::Tiler,
};
use ahead::{Ahead, AheadBatch, AheadTapes};
use shade::{Paint, Surface};
use surroundings::{Lamp, behind, through_fog, unshaded};
use trace::{Batch, Limits, Method, Ray, Trace, trace, trace_among_copies, values_at};

/// Pixels that one thread takes at a time.
const GROUP: usize = 512;
/// Places above a surface at which it is asked what takes its light.
const OCCLUSION_SAMPLES: u32 = 5;
/// Tolerance of a ray to a lamp, whose footprint is as wide as it starts above the surface.
const SHADOW_TOLERANCE: f64 = 0.25;
/// Most pixels of a tile; threads wait for each other at its end.
const MAX_TILE_PIXELS: u32 = 1 << 20;

/// A program made ready for the CPU.
#[derive(Clone, Debug)]
pub struct CpuScene {
    field: Tape,
    /// What is known of rays, for methods that ask.
    ahead: Option<AheadTapes>,
    /// Bounds of the field between two points, for the method that asks.
    range: Option<Tape>,
    gradient: Option<Tape>,
    material: Option<Tape>,
}

impl CpuScene {
    /// Names of the ray methods that it has.
    pub const METHODS: [&'static str; Method::ALL.len()] =
        [Method::ALL[0].0, Method::ALL[1].0, Method::ALL[2].0];

    /// Of a program.
    ///
    /// # Errors
    ///
    /// [`RenderError::NothingDrawn`], [`RenderError::Evaluator`] if the program is not flat.
    pub fn new(program: &Program) -> Result<Self, RenderError> {
        let distance = program.distance.ok_or(RenderError::NothingDrawn)?;
        let refused = |error: TapeError| RenderError::Evaluator(error.to_string());
        let tape = |roots: &[_]| Tape::new(&program.graph, roots).map_err(refused);
        let range = program.range.map(|range| Tape::for_rays(&program.graph, &[range]));
        Ok(Self {
            field: tape(&[distance])?,
            ahead: AheadTapes::new(program).map_err(refused)?,
            range: range.transpose().map_err(refused)?,
            gradient: program.gradient.map(|gradient| tape(&[gradient])).transpose()?,
            material: program.material.map(|fields| tape(&fields)).transpose()?,
        })
    }

    /// Draws a frame in f32, as the shader does. The methods are [`Self::METHODS`].
    ///
    /// # Errors
    ///
    /// [`RenderError::MethodNotOnCpu`], [`RenderError::Size`], [`RenderError::OutOfMemory`],
    /// [`RenderError::Cancelled`], [`RenderError::Evaluator`] if the program has no gradient, or for `interval` no range.
    pub fn render(
        &self,
        view: &View,
        frame: &FrameValues,
        method: &str,
        options: &RenderOptions,
        progress: &mut OnProgress<'_>,
    ) -> Result<Frame, RenderError> {
        self.render_in::<f32>(view, frame, method, options, progress)
    }

    /// Draws a frame, marched in `T`: in f64, what a shader's picture is measured against.
    ///
    /// # Errors
    ///
    /// As [`Self::render`].
    pub fn render_in<T: Real>(
        &self,
        view: &View,
        frame: &FrameValues,
        method: &str,
        options: &RenderOptions,
        progress: &mut OnProgress<'_>,
    ) -> Result<Frame, RenderError> {
        if self.gradient.is_none() {
            return Err(RenderError::Evaluator("the program has no gradient".to_owned()));
        }
        let method = self.method(method)?;
        self.draw(view, options, progress, &self.wave::<T>(view, frame, method, true))
    }

    /// Depth, status and evaluations of the rays from the eye, without colours, marched in `T`.
    ///
    /// # Errors
    ///
    /// As [`Self::render`], but a gradient is not needed.
    pub fn depth_map<T: Real>(
        &self,
        view: &View,
        frame: &FrameValues,
        method: &str,
    ) -> Result<Image, RenderError> {
        let wave = self.wave::<T>(view, frame, self.method(method)?, false);
        Ok(self.draw(view, &RenderOptions::default(), &mut no_progress, &wave)?.image)
    }

    fn method(&self, name: &str) -> Result<Method, RenderError> {
        let method = Method::of_name(name)?;
        if method == Method::Interval && self.range.is_none() {
            return Err(RenderError::Evaluator("the program has no range".to_owned()));
        }
        Ok(method)
    }

    fn wave<'a, T: Real>(
        &'a self,
        view: &'a View,
        frame: &FrameValues,
        method: Method,
        shaded: bool,
    ) -> Wave<'a, T> {
        let prepare = |tape: &'a Tape| tape.prepare::<Packet<T, { trace::LANES }>>(frame);
        Wave {
            view,
            limits: Limits {
                method,
                epsilon: T::constant(view.epsilon),
                steps: view.steps,
                watched: false,
            },
            field: prepare(&self.field),
            ahead: self
                .ahead
                .as_ref()
                .filter(|_| method.pre_intersects())
                .map(|a| a.prepare(frame)),
            range: self.range.as_ref().map(|tape| tape.prepare(frame)),
            gradient: self.gradient.as_ref().filter(|_| shaded).map(prepare),
            material: self.material.as_ref().filter(|_| shaded).map(prepare),
        }
    }

    fn draw<T: Real>(
        &self,
        view: &View,
        options: &RenderOptions,
        progress: &mut OnProgress<'_>,
        wave: &Wave<'_, T>,
    ) -> Result<Frame, RenderError> {
        check_size(view.size)?;
        let mut image = Image::new(view.size, view.footprint())?;
        let mut tiler = Tiler::new(view.size, options.tile_size, MAX_TILE_PIXELS);
        let (mut milliseconds, mut tiles, mut done) = (0.0, 0, 0);
        let total = image.pixels().len() as u64;
        while let Some(tile) = tiler.next() {
            let start = now();
            image.put(tile, draw_tile(wave, tile).into_iter());
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

/// Now; `None` where there is no clock, as in WebAssembly.
fn now() -> Option<Instant> {
    (!cfg!(target_family = "wasm")).then(Instant::now)
}

/// The pixels of a tile, drawn by all threads that there are.
fn draw_tile<T: Real>(wave: &Wave<'_, T>, tile: Tile) -> Vec<PixelBlock> {
    let mut pixels = vec![PixelBlock::default(); tile.pixels()];
    let draw = |wave: &mut Wave<'_, T>, (group, pixels): (usize, &mut [PixelBlock])| {
        let places: Vec<[u32; 2]> =
            (0..pixels.len()).map(|index| tile.place(group * GROUP + index)).collect();
        pixels.copy_from_slice(&wave.pixels(&places));
    };
    #[cfg(feature = "threads")]
    pixels.par_chunks_mut(GROUP).enumerate().for_each_init(|| wave.clone(), draw);
    #[cfg(not(feature = "threads"))]
    {
        let mut wave = wave.clone();
        pixels.chunks_mut(GROUP).enumerate().for_each(|group| draw(&mut wave, group));
    }
    pixels
}

/// What one thread needs to draw groups of pixels.
#[derive(Clone)]
struct Wave<'a, T> {
    view: &'a View,
    limits: Limits<T>,
    field: Batch<'a, T>,
    ahead: Option<AheadBatch<'a, T>>,
    /// Bounds of the field between two points.
    range: Option<Evaluator<'a, T>>,
    /// `None`: depths only.
    gradient: Option<Batch<'a, T>>,
    material: Option<Batch<'a, T>>,
}

/// A pixel in the making.
#[derive(Clone, Copy)]
struct Shade {
    color: DVec3,
    evaluations: u32,
}

/// A ray along which the eye sees, from it or from a mirror.
#[derive(Clone, Copy)]
struct Sight<T> {
    /// Position in the group.
    pixel: usize,
    ray: Ray<T>,
    /// What is seen along it counts by this factor.
    weight: f64,
}

/// Where a sight met something.
struct Meeting<T> {
    sight: Sight<T>,
    t: T,
    surface: Surface,
    /// Length of the gradient there.
    slope: f64,
}

impl<T: Real> Meeting<T> {
    fn point(&self) -> DVec3 {
        vector(self.sight.ray.at(self.t))
    }
}

impl<T: Real> Wave<'_, T> {
    fn pixels(&mut self, places: &[[u32; 2]]) -> Vec<PixelBlock> {
        let eyes = places.iter().enumerate();
        let mut sights: Vec<Sight<T>> = eyes
            .map(|(pixel, place)| Sight { pixel, ray: self.camera_ray(*place), weight: 1.0 })
            .collect();
        let mut shades = vec![Shade { color: DVec3::ZERO, evaluations: 0 }; places.len()];
        let seen = self.traced(&sights, &mut shades);
        let mut meetings = self.lit_meetings(&sights, &seen, &mut shades);
        for _ in 0..self.view.reflections {
            sights = meetings.iter().map(|meeting| self.mirrored(meeting)).collect();
            let traces = self.traced(&sights, &mut shades);
            meetings = self.lit_meetings(&sights, &traces, &mut shades);
        }
        let pixels = seen.iter().zip(shades);
        pixels.map(|(trace, shade)| self.block(trace, shade)).collect()
    }

    fn traced(&mut self, sights: &[Sight<T>], shades: &mut [Shade]) -> Vec<Trace<T>> {
        let rays: Vec<Ray<T>> = sights.iter().map(|sight| sight.ray).collect();
        let traces = self.traces(&rays, false);
        for (sight, trace) in sights.iter().zip(&traces) {
            shades[sight.pixel].evaluations += trace.evaluations;
        }
        traces
    }

    /// Marches rays; those that are watched through the whole field, so that it is known how narrowly they pass.
    fn traces(&mut self, rays: &[Ray<T>], watched: bool) -> Vec<Trace<T>> {
        let known = match &mut self.ahead {
            Some(ahead) => ahead.look(rays, watched),
            None => rays.iter().map(Ahead::nothing).collect(),
        };
        let rays: Vec<_> = rays.iter().copied().zip(known).collect();
        let limits = Limits { watched, ..self.limits };
        let ahead = self.ahead.as_mut().filter(|_| !watched);
        let marched = match ahead {
            Some(AheadBatch { copies: Some(copies), .. }) => {
                return trace_among_copies(copies, &rays, &limits);
            }
            Some(AheadBatch { marched, .. }) => marched.as_mut(),
            None => None,
        };
        trace(marched.unwrap_or(&mut self.field), self.range.as_mut(), &rays, &limits)
    }

    /// Adds what lies behind where sights met nothing, and what lights what they met.
    fn lit_meetings(
        &mut self,
        sights: &[Sight<T>],
        traces: &[Trace<T>],
        shades: &mut [Shade],
    ) -> Vec<Meeting<T>> {
        for (sight, _) in sights.iter().zip(traces).filter(|(_, trace)| trace.status != HIT) {
            let seen = behind(self.view, vector(sight.ray.direction));
            shades[sight.pixel].color += seen * sight.weight;
        }
        let mut meetings = self.meetings(sights, traces);
        let open = self.open_parts(&meetings, shades);
        for (Meeting { sight, t, surface, .. }, open) in meetings.iter_mut().zip(open) {
            let (clear, haze) = through_fog(self.view, -surface.toward_eye, (*t).into());
            let own = surface.ambient(self.view.ambient * open);
            shades[sight.pixel].color += (own * clear + haze * (1.0 - clear)) * sight.weight;
            sight.weight *= clear;
        }
        for light in &self.view.lights {
            self.light(light, &meetings, shades);
        }
        meetings
    }

    /// The parts of the light from everywhere that reach where sights met something: 1, less what the field lacks
    /// of the height above it, the nearer the more.
    fn open_parts(&mut self, meetings: &[Meeting<T>], shades: &mut [Shade]) -> Vec<f64> {
        let mut open = vec![1.0; meetings.len()];
        let Some(ViewOcclusion { radius, strength }) = self.view.occlusion else { return open };
        let weight = |sample: u32| 0.5f64.powi(sample as i32);
        let all: f64 = (1..=OCCLUSION_SAMPLES).map(weight).sum();
        for sample in 1..=OCCLUSION_SAMPLES {
            let height = radius * f64::from(sample) / f64::from(OCCLUSION_SAMPLES);
            let above = |meeting: &Meeting<T>| meeting.point() + meeting.surface.normal * height;
            let points: Vec<[T; 3]> =
                meetings.iter().map(|meeting| above(meeting).to_array().map(T::constant)).collect();
            let values = values_at(&mut self.field, &points);
            for ((open, meeting), value) in open.iter_mut().zip(meetings).zip(values) {
                let distance = value.first().map_or(f64::NAN, |lanes| lanes[0]) / meeting.slope;
                let closed = (1.0 - distance / height).clamp(0.0, 1.0);
                *open -= strength * closed * weight(sample) / all;
                shades[meeting.sight.pixel].evaluations += 1;
            }
        }
        open
    }

    fn camera_ray(&self, [x, y]: [u32; 2]) -> Ray<T> {
        let [origin, direction] =
            self.view.ray(x, y).map(|value| value.to_array().map(T::constant));
        let Footprint { radius, spread } = self.view.footprint();
        Ray {
            origin,
            direction,
            t_max: T::constant(self.view.t_max),
            radius: T::constant(radius),
            spread: T::constant(spread),
            tolerance: T::constant(self.view.tolerance),
        }
    }

    /// Normals and materials where sights met something.
    fn meetings(&mut self, sights: &[Sight<T>], traces: &[Trace<T>]) -> Vec<Meeting<T>> {
        let Some(gradient) = &mut self.gradient else { return Vec::new() };
        let met = sights.iter().zip(traces).filter(|(_, trace)| trace.status == HIT);
        let hits: Vec<(Sight<T>, T)> = met.map(|(sight, trace)| (*sight, trace.t)).collect();
        let points: Vec<[T; 3]> = hits.iter().map(|(sight, t)| sight.ray.at(*t)).collect();
        let gradients = values_at(gradient, &points);
        let materials = self.material.as_mut().map(|material| values_at(material, &points));
        let meeting = |(index, (sight, t)): (usize, (Sight<T>, T))| {
            let [x, y, z, _] = gradients[index].first().copied().unwrap_or_default();
            let paint = materials.as_ref().and_then(|fields| Paint::of_fields(&fields[index]));
            let toward_eye = -vector(sight.ray.direction);
            let gradient = DVec3::new(x, y, z);
            let surface = Surface::new(gradient, toward_eye, paint);
            let slope = if gradient.length() > 0.0 { gradient.length() } else { 1.0 };
            Meeting { sight, t, surface, slope }
        };
        hits.into_iter().enumerate().map(meeting).collect()
    }

    /// Adds what a light lights, and the evaluations that it takes to know what shades it.
    fn light(&mut self, light: &ViewLight, meetings: &[Meeting<T>], shades: &mut [Shade]) {
        let lit = meetings.iter().map(|meeting| {
            let lamp = Lamp::seen_from(meeting.point(), light);
            (meeting, lamp, meeting.surface.lit(&lamp) * meeting.sight.weight)
        });
        // A surface that returns nothing needs no ray to the lamp.
        let casts = light.shadow != ViewShadow::Off;
        let (asked, sure): (Vec<_>, Vec<_>) =
            lit.partition(|(.., lit)| casts && lit.cmpgt(DVec3::ZERO).any());
        for (meeting, _, lit) in sure {
            shades[meeting.sight.pixel].color += lit;
        }
        let rays: Vec<Ray<T>> =
            asked.iter().map(|(meeting, lamp, _)| self.lamp_ray(meeting, lamp)).collect();
        let watched = matches!(light.shadow, ViewShadow::Soft(_));
        let traces = self.traces(&rays, watched);
        for ((meeting, _, lit), trace) in asked.into_iter().zip(traces) {
            let shade = &mut shades[meeting.sight.pixel];
            shade.evaluations += trace.evaluations;
            if trace.status != HIT {
                shade.color += lit * unshaded(light, trace.clearance.into());
            }
        }
    }

    /// How far along the ray a hit may be off.
    fn near(&self, Meeting { sight, t, .. }: &Meeting<T>) -> T {
        self.limits.tolerance(&sight.ray, *t).max(sight.ray.rounding(*t))
    }

    /// Where a ray starts that leaves the surface: so far above it, and a little before the hit, since
    /// in a crease one surface's normal does not lead out of the other.
    fn lifted(&self, meeting: &Meeting<T>, lift: T) -> [T; 3] {
        let back = T::constant(0.25) * self.near(meeting);
        let point = meeting.sight.ray.at(meeting.t - back);
        let normal = meeting.surface.normal.to_array().map(T::constant);
        std::array::from_fn(|axis| point[axis] + lift * normal[axis])
    }

    /// From a surface towards a lamp.
    fn lamp_ray(&self, meeting: &Meeting<T>, lamp: &Lamp) -> Ray<T> {
        let half_pixel = meeting.sight.ray.footprint(meeting.t);
        let lift = (T::constant(3.0) * self.near(meeting)).max(half_pixel);
        Ray {
            origin: self.lifted(meeting, lift),
            direction: lamp.direction.to_array().map(T::constant),
            t_max: T::constant(lamp.reach.unwrap_or(self.view.t_max)),
            radius: T::constant(0.5) * lift,
            spread: T::constant(0.0),
            tolerance: T::constant(SHADOW_TOLERANCE),
        }
    }

    /// From a surface to what it mirrors.
    fn mirrored(&self, meeting: &Meeting<T>) -> Sight<T> {
        let Meeting { sight, t, surface, .. } = meeting;
        let inward = -surface.toward_eye;
        let direction = inward - 2.0 * inward.dot(surface.normal) * surface.normal;
        let ray = Ray {
            origin: self.lifted(meeting, T::constant(1.5) * self.near(meeting)),
            direction: direction.to_array().map(T::constant),
            t_max: T::constant(self.view.t_max),
            radius: sight.ray.footprint(*t),
            spread: sight.ray.spread,
            tolerance: sight.ray.tolerance,
        };
        let weight = sight.weight * self.view.reflection_strength;
        Sight { pixel: sight.pixel, ray, weight }
    }

    fn block(&self, trace: &Trace<T>, shade: Shade) -> PixelBlock {
        let t: f64 = trace.t.into();
        let depth = if t > self.view.t_max { self.view.t_max } else { t };
        PixelBlock {
            color: shade.color.as_vec3().extend(1.0).to_array(),
            depth: depth as f32,
            status: trace.status,
            evaluations: shade.evaluations,
            primary_evaluations: trace.evaluations,
        }
    }
}

fn vector<T: Real>(lanes: [T; 3]) -> DVec3 {
    DVec3::from(lanes.map(Into::into))
}
