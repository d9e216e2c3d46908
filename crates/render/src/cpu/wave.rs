//! Drawing a group of pixels in waves: all camera rays, then all shadow rays, then all reflections.

use glam::DVec3;
use sdfc_graph::eval::Packet;
use sdfc_march::{PixelBlock, UNPROVEN};

use super::cells::Cells;
use super::environment::EnvironmentBatch;
use super::gradients::Gradient;
use super::pixels::Pixels;
use super::pre_intersection::PreIntersectionBatch;
use super::ray::{Batch, LANES, Ray, Real, packed_from, surface_values};
use super::shade::{Paint, Surface};
use super::surroundings::{IncomingLight, background_color, clear_fraction, light_visibility};
use super::trace::copies::trace_among_copies;
use super::trace::{Limits, Trace, cone_width, trace};
use crate::image::HIT;
use crate::view::footprint::Footprint;
use crate::view::{Background, View, ViewFog, ViewLight, ViewOcclusion, ViewShadow, ViewSource};

/// The number of samples above a surface for ambient occlusion.
const OCCLUSION_SAMPLES: u32 = 5;
/// The slope from which on a field is taken for a distance.
const STEEP: f64 = 0.99;
/// Tolerance of a shadow ray in widths of its footprint, which is as wide as the ray starts above
/// the surface.
const SHADOW_TOLERANCE: f64 = 0.25;
/// The state of one thread that draws groups of pixels.
#[derive(Clone)]
pub(super) struct Wave<'a, T> {
    pub(super) view: &'a View,
    pub(super) limits: Limits<T>,
    pub(super) field: &'a Cells<'a>,
    /// The part of the field that is marched where the rest is intersected analytically.
    pub(super) marched: Option<&'a Cells<'a>>,
    pub(super) pre_intersection: Option<PreIntersectionBatch<'a, T>>,
    /// Bounds of the field on a segment.
    pub(super) range: Option<Batch<'a, T>>,
    /// `None` if only depths are drawn.
    pub(super) gradient: Option<Gradient<'a, T>>,
    pub(super) material: Option<Batch<'a, T>>,
    /// What the distance is likely to be, for soft shadows and ambient occlusion.
    pub(super) estimate: Option<Batch<'a, T>>,
    /// The gradient and the value of the field, if soft shadows follow its gradients.
    pub(super) projection: Option<Batch<'a, T>>,
    /// The light of a picture of the surroundings.
    pub(super) environment: Option<EnvironmentBatch<'a, T>>,
}

/// A pixel while it is drawn.
#[derive(Clone, Copy, Default)]
struct Shade {
    color: DVec3,
    evaluations: u32,
    /// True if a ray passed a stretch without a proof that it is free.
    unproven: bool,
}

impl Shade {
    /// Adds what a ray cost, and what it left unproven.
    fn count<T: Real>(&mut self, trace: &Trace<'_, T>) {
        self.evaluations += trace.evaluations;
        self.unproven = self.unproven || trace.unproven;
    }
}

/// A camera ray or a reflection of one.
#[derive(Clone, Copy)]
struct ViewRay<T> {
    /// Index of the pixel in the group.
    pixel: usize,
    ray: Ray<T>,
    /// Factor of the light along the ray.
    weight: DVec3,
    /// Roughness of the mirrors before, which spread the highlights that they show.
    blur: f64,
}

/// The hit of a view ray.
struct SurfaceHit<T> {
    view_ray: ViewRay<T>,
    t: T,
    surface: Surface,
    /// Length of the gradient there.
    slope: f64,
}

impl<T: Real> SurfaceHit<T> {
    fn point(&self) -> DVec3 {
        vector(self.view_ray.ray.at(self.t))
    }
}

impl<T: Real> Pixels for Wave<'_, T> {
    fn pixels(&mut self, positions: &[[u32; 2]]) -> Vec<PixelBlock> {
        let rays: Vec<Ray<T>> =
            positions.iter().map(|position| self.camera_ray(*position)).collect();
        let primary = self.traces(&rays, self.limits);
        let mut shades = vec![Shade::default(); positions.len()];
        let camera_ray =
            |pixel: usize| ViewRay { pixel, ray: rays[pixel], weight: DVec3::ONE, blur: 0.0 };
        let mut left = self.view.reflections;
        let mut hits = self.lit_hits(camera_ray, &primary, left, &mut shades);
        while left > 0 {
            left -= 1;
            // A surface that mirrors nothing needs no reflected ray.
            let mirrors = |ray: &ViewRay<T>| ray.weight.cmpgt(DVec3::ZERO).any();
            let view_rays: Vec<ViewRay<T>> =
                hits.iter().map(|hit| self.reflected(hit)).filter(mirrors).collect();
            let rays: Vec<Ray<T>> = view_rays.iter().map(|view_ray| view_ray.ray).collect();
            let traces = self.traces(&rays, self.limits);
            hits = self.lit_hits(|index| view_rays[index], &traces, left, &mut shades);
        }
        let pixels = primary.iter().zip(shades);
        pixels.map(|(trace, shade)| self.block(trace, shade)).collect()
    }
}

impl<'a, T: Real> Wave<'a, T> {
    /// Traces rays; those that record their clearance are marched through the whole field.
    fn traces(&mut self, rays: &[Ray<T>], limits: Limits<T>) -> Vec<Trace<'a, T>> {
        let records_clearance = limits.records_clearance;
        let projection = self.projection.as_mut();
        let Some(pre_intersection) = &mut self.pre_intersection else {
            return trace(self.field, self.range.as_mut(), projection, rays, None, &limits);
        };
        let known = pre_intersection.look(rays, records_clearance);
        if records_clearance {
            return trace(self.field, self.range.as_mut(), projection, rays, Some(&known), &limits);
        }
        let copies = pre_intersection.copies.as_mut();
        if let Some(copies) = copies.filter(|_| limits.method.intersects_copies()) {
            return trace_among_copies(copies, rays, &known, &limits);
        }
        let Some(marched) = self.marched else {
            return trace(self.field, self.range.as_mut(), projection, rays, Some(&known), &limits);
        };
        let mut traces = trace(marched, self.range.as_mut(), None, rays, Some(&known), &limits);
        // Cells of another field have no gradients.
        traces.iter_mut().for_each(|trace| trace.cell = None);
        traces
    }

    /// Adds what view rays see, given by their index: the background where they hit nothing, and
    /// the lights where they hit a surface. Adds what the rays cost, too. `left` is the number of
    /// reflections that can still follow.
    fn lit_hits(
        &mut self,
        view_ray: impl Fn(usize) -> ViewRay<T>,
        traces: &[Trace<'_, T>],
        left: u32,
        shades: &mut [Shade],
    ) -> Vec<SurfaceHit<T>> {
        let (mut seen, mut missed) = (Vec::new(), Vec::new());
        for (index, trace) in traces.iter().enumerate() {
            let view_ray = view_ray(index);
            let shade = &mut shades[view_ray.pixel];
            shade.count(trace);
            if trace.status == HIT {
                seen.push((view_ray, *trace));
            } else {
                missed.push(view_ray);
            }
        }
        let behind: Vec<(DVec3, f64)> =
            missed.iter().map(|ray| (vector(ray.ray.direction), ray.blur)).collect();
        for (view_ray, background) in missed.iter().zip(self.backgrounds(&behind)) {
            shades[view_ray.pixel].color += background * view_ray.weight;
        }
        let mut hits = self.hits(&seen);
        let open = self.unoccluded_fractions(&hits, shades);
        let ambient = self.ambient(&hits, &open, left > 0);
        let haze = self.haze(&hits);
        let lit = ambient.into_iter().zip(haze);
        for (SurfaceHit { view_ray, t, .. }, (reflected, haze)) in hits.iter_mut().zip(lit) {
            let clear = clear_fraction(self.view, (*t).into());
            shades[view_ray.pixel].color +=
                (reflected * clear + haze * (1.0 - clear)) * view_ray.weight;
            view_ray.weight *= clear;
        }
        for light in &self.view.lights {
            self.light(light, &hits, shades);
        }
        hits
    }

    /// The background in directions, as mirrors of some roughness show it.
    fn backgrounds(&mut self, seen: &[(DVec3, f64)]) -> Vec<DVec3> {
        match &mut self.environment {
            Some(environment) => environment.radiance(seen),
            None => seen.iter().map(|&(to, _)| background_color(self.view, to)).collect(),
        }
    }

    /// The colour of the fog before each hit.
    fn haze(&mut self, hits: &[SurfaceHit<T>]) -> Vec<DVec3> {
        match self.view.fog {
            None => vec![DVec3::ZERO; hits.len()],
            Some(ViewFog { color: Some(color), .. }) => vec![color; hits.len()],
            Some(ViewFog { color: None, .. }) => {
                let behind = hits.iter().map(|hit| (-hit.surface.toward_eye, 0.0));
                self.backgrounds(&behind.collect::<Vec<_>>())
            }
        }
    }

    /// The light that each hit emits, and that it reflects of the ambient light or of the
    /// surroundings.
    fn ambient(&mut self, hits: &[SurfaceHit<T>], open: &[f64], ray_follows: bool) -> Vec<DVec3> {
        if let Some(environment) = &mut self.environment {
            let normals: Vec<DVec3> = hits.iter().map(|hit| hit.surface.normal).collect();
            let irradiance = environment.irradiance(&normals);
            let mirrors = hits
                .iter()
                .map(|hit| (hit.surface.mirrored_direction(), hit.surface.roughness()))
                .collect::<Vec<_>>();
            let light = irradiance.into_iter().zip(environment.radiance(&mirrors));
            let reflected = hits.iter().zip(open).zip(light);
            return reflected
                .map(|((hit, &open), (irradiance, radiance))| {
                    hit.surface.reflected_environment(irradiance, radiance, ray_follows, open)
                })
                .collect();
        }
        let reflected = |(hit, &open): (&SurfaceHit<T>, &f64)| {
            let surface = &hit.surface;
            let ambient = surface.ambient(self.view.ambient * open);
            if !self.mirrors_sky() {
                return ambient;
            }
            let sky = background_color(self.view, surface.mirrored_direction());
            ambient + surface.mirrored_sky(sky, self.view.ambient) * open
        };
        hits.iter().zip(open).map(reflected).collect()
    }

    /// True if materials mirror the sky without reflected rays.
    fn mirrors_sky(&self) -> bool {
        let is_sky = matches!(self.view.background, Background::Sky { .. });
        is_sky && self.material.is_some() && self.view.reflections == 0
    }

    /// The unoccluded fraction of ambient light at each hit: 1, less what the field falls below
    /// the height above the surface, the nearer the more.
    fn unoccluded_fractions(&mut self, hits: &[SurfaceHit<T>], shades: &mut [Shade]) -> Vec<f64> {
        let mut open = vec![1.0; hits.len()];
        let Some(ViewOcclusion { radius, strength }) = self.view.occlusion else { return open };
        let weight = |sample: u32| 0.5f64.powi(sample as i32);
        let total: f64 = (1..=OCCLUSION_SAMPLES).map(weight).sum();
        for sample in 1..=OCCLUSION_SAMPLES {
            let height = radius * f64::from(sample) / f64::from(OCCLUSION_SAMPLES);
            let above = |hit: &SurfaceHit<T>| hit.point() + hit.surface.normal * height;
            let points: Vec<[T; 3]> =
                hits.iter().map(|hit| above(hit).to_array().map(T::constant)).collect();
            let distances = self.distances_above(&points, hits);
            for ((open, hit), distance) in open.iter_mut().zip(hits).zip(distances) {
                let occluded = (1.0 - distance / height).clamp(0.0, 1.0);
                *open -= strength * occluded * weight(sample) / total;
                shades[hit.view_ray.pixel].evaluations += 1;
            }
        }
        open
    }

    /// Distances to surfaces from points above hits. Beside a surface whose field is a distance,
    /// the field of others may be flatter.
    fn distances_above(&mut self, points: &[[T; 3]], hits: &[SurfaceHit<T>]) -> Vec<f64> {
        let values = self.field.values(points);
        let mut distances: Vec<f64> =
            values.into_iter().zip(hits).map(|(value, hit)| value / hit.slope).collect();
        if let Some(estimate) = &mut self.estimate {
            let steep = (0..hits.len()).filter(|&index| hits[index].slope > STEEP);
            let steep: Vec<usize> = steep.collect();
            for group in steep.chunks(LANES) {
                let above = packed_from(group.iter().map(|&index| points[index]));
                let Packet(estimates) = estimate.scalar(above);
                for (&index, estimate) in group.iter().zip(estimates) {
                    distances[index] = estimate.into();
                }
            }
        }
        distances
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

    /// Normals and materials at the hits.
    fn hits(&mut self, seen: &[(ViewRay<T>, Trace<'_, T>)]) -> Vec<SurfaceHit<T>> {
        let Some(gradient) = &mut self.gradient else { return Vec::new() };
        let points: Vec<[T; 3]> =
            seen.iter().map(|(view_ray, trace)| view_ray.ray.at(trace.t)).collect();
        let gradients = gradient.at(self.field, &points, |index| seen[index].1.cell);
        let hit =
            |(&(view_ray, Trace { t, .. }), gradient): (&(ViewRay<T>, Trace<'_, T>), DVec3)| {
                let surface = Surface::new(gradient, -vector(view_ray.ray.direction));
                let slope = if gradient.length() > 0.0 { gradient.length() } else { 1.0 };
                SurfaceHit { view_ray, t, surface, slope }
            };
        let mut hits: Vec<SurfaceHit<T>> = seen.iter().zip(gradients).map(hit).collect();
        if let Some(material) = &mut self.material {
            let lanes = |vector: DVec3| vector.to_array().map(T::constant);
            let vectors = |(hit, &point): (&SurfaceHit<T>, &[T; 3])| {
                [point, lanes(hit.surface.normal), lanes(hit.surface.toward_eye)]
            };
            let surfaces: Vec<_> = hits.iter().zip(&points).map(vectors).collect();
            for (hit, fields) in hits.iter_mut().zip(surface_values(material, &surfaces)) {
                let paint = Paint::of_fields(&fields);
                hit.surface.paint = paint.map(|paint| paint.roughened(hit.view_ray.blur));
            }
        }
        hits
    }

    /// Adds the light of one light source, and the evaluations of its shadow rays.
    fn light(&mut self, light: &ViewLight, hits: &[SurfaceHit<T>], shades: &mut [Shade]) {
        let lit = hits.iter().map(|hit| {
            let incoming = IncomingLight::seen_from(hit.point(), light);
            (hit, incoming, hit.surface.lit(&incoming) * hit.view_ray.weight)
        });
        // A surface that reflects nothing needs no shadow ray.
        let casts = light.shadow != ViewShadow::Off;
        let (shadowed, lit_anyway): (Vec<_>, Vec<_>) =
            lit.partition(|(.., lit)| casts && lit.cmpgt(DVec3::ZERO).any());
        for (hit, _, lit) in lit_anyway {
            shades[hit.view_ray.pixel].color += lit;
        }
        let rays: Vec<Ray<T>> =
            shadowed.iter().map(|(hit, incoming, _)| self.shadow_ray(hit, incoming)).collect();
        let sharpness = match light.shadow {
            ViewShadow::Soft(sharpness) => Some(sharpness),
            ViewShadow::Off | ViewShadow::Hard => None,
        };
        let limits = Limits {
            records_clearance: sharpness.is_some(),
            full_light: T::constant(1.0 / sharpness.unwrap_or(1.0)),
            ends_at_light: !matches!(light.source, ViewSource::Sun(_)),
            ..self.limits
        };
        let mut traces = self.traces(&rays, limits);
        if limits.records_clearance {
            self.estimate_clearances(&rays, &mut traces, limits.ends_at_light);
        }
        let is_estimated = self.estimate.is_some() || self.projection.is_some();
        for ((hit, _, lit), trace) in shadowed.into_iter().zip(traces) {
            let shade = &mut shades[hit.view_ray.pixel];
            shade.count(&trace);
            if trace.status != HIT {
                // Near a flat surface that the ray leaves, the field falls behind the distance.
                let is_flat = !is_estimated && hit.slope < STEEP;
                let flatness = if is_flat { hit.slope } else { 1.0 };
                let clearance: f64 = trace.clearance.into();
                shade.color += lit * light_visibility(light, clearance / flatness);
            }
        }
    }

    /// Takes the clearance of rays from an estimate of the distance where it is least: a field that
    /// is divided by a Lipschitz constant would make it too small.
    fn estimate_clearances(
        &mut self,
        rays: &[Ray<T>],
        traces: &mut [Trace<'_, T>],
        ends_at_light: bool,
    ) {
        let Some(estimate) = &mut self.estimate else { return };
        let known = |index: &usize| T::constant(0.0) < traces[*index].closest;
        let indices: Vec<usize> = (0..traces.len()).filter(known).collect();
        for group in indices.chunks(LANES) {
            let points = group.iter().map(|&index| rays[index].at(traces[index].closest));
            let Packet(distances) = estimate.scalar(packed_from(points));
            for (&index, distance) in group.iter().zip(distances) {
                let Trace { clearance, closest, .. } = &mut traces[index];
                let width = cone_width(&rays[index], *closest, ends_at_light);
                *clearance = clearance.max(distance.div(width));
            }
        }
    }

    /// The largest error of the hit along the ray.
    fn near(&self, SurfaceHit { view_ray, t, .. }: &SurfaceHit<T>) -> T {
        self.limits.tolerance(&view_ray.ray, *t).max(view_ray.ray.rounding(*t))
    }

    /// The origin of a secondary ray: above the surface, and a little before the hit, since in a
    /// crease one surface's normal does not lead out of the other.
    fn lifted(&self, hit: &SurfaceHit<T>, lift: T) -> [T; 3] {
        let back = T::constant(0.25) * self.near(hit);
        let point = hit.view_ray.ray.at(hit.t - back);
        let normal = hit.surface.normal.to_array().map(T::constant);
        std::array::from_fn(|axis| point[axis] + lift * normal[axis])
    }

    /// A ray from a surface towards a light.
    fn shadow_ray(&self, hit: &SurfaceHit<T>, incoming: &IncomingLight) -> Ray<T> {
        let half_pixel = hit.view_ray.ray.footprint(hit.t);
        let lift = (T::constant(3.0) * self.near(hit)).max(half_pixel);
        Ray {
            origin: self.lifted(hit, lift),
            direction: incoming.direction.to_array().map(T::constant),
            t_max: T::constant(incoming.distance.unwrap_or(self.view.t_max)),
            radius: T::constant(0.5) * lift,
            spread: T::constant(0.0),
            tolerance: T::constant(SHADOW_TOLERANCE),
        }
    }

    /// The reflection of a view ray.
    fn reflected(&self, hit: &SurfaceHit<T>) -> ViewRay<T> {
        let SurfaceHit { view_ray, t, surface, .. } = hit;
        let direction = surface.mirrored_direction();
        let ray = Ray {
            origin: self.lifted(hit, T::constant(1.5) * self.near(hit)),
            direction: direction.to_array().map(T::constant),
            t_max: T::constant(self.view.t_max),
            radius: view_ray.ray.footprint(*t),
            spread: view_ray.ray.spread,
            tolerance: view_ray.ray.tolerance,
        };
        let factor = surface.mirrored_fraction() * self.view.reflection_strength;
        let weight = view_ray.weight * factor;
        ViewRay { pixel: view_ray.pixel, ray, weight, blur: surface.roughness() }
    }

    fn block(&self, trace: &Trace<'_, T>, shade: Shade) -> PixelBlock {
        let t: f64 = trace.t.into();
        let exposure = self.view.exposure;
        let color = exposure.map_or(shade.color, |exposure| exposure.developed(shade.color));
        let depth = if t > self.view.t_max { self.view.t_max } else { t };
        PixelBlock {
            color: color.as_vec3().extend(1.0).to_array(),
            depth: depth as f32,
            status: trace.status,
            unproven: if shade.unproven { UNPROVEN } else { 0 },
            evaluations: shade.evaluations,
            primary_evaluations: trace.evaluations,
        }
    }
}

fn vector<T: Real>(lanes: [T; 3]) -> DVec3 {
    DVec3::from(lanes.map(Into::into))
}
