//! The analytic pre-intersection of rays: where they hit the analytic part of the scene, and the
//! interval in which the rest is marched.

use sdfc_graph::eval::{FrameValues, Packet, Tape, TapeError};
use sdfc_graph::{FAR, Program};

use super::cells::CachedField;
use super::ray::{Batch, LANES, Ray, Real, packed};

/// Functions of rays, compiled for the CPU.
#[derive(Clone, Debug)]
pub(super) struct PreIntersectionTapes {
    /// First hits and intervals in the box, if there are such, in this order.
    hits_and_clips: Tape,
    has_hits: bool,
    has_clip: bool,
    /// The field of the marched part; `None` if there is none.
    marched: Option<CachedField>,
    /// The intersection of copies, as in the program's rays.
    copies: Option<Tape>,
}

impl PreIntersectionTapes {
    /// `None` if the program has no analytic part and no box.
    pub(super) fn new(program: &Program) -> Result<Option<Self>, TapeError> {
        let Program { graph, rays, .. } = program;
        let marched = program.marched_field();
        let roots: Vec<_> = rays.first_hit.into_iter().chain(rays.clip).collect();
        if roots.is_empty() && rays.copies.is_none() {
            return Ok(None);
        }
        let copies = rays.copies.map(|copies| Tape::for_rays(graph, &[copies])).transpose()?;
        let (has_hits, has_clip) = (rays.first_hit.is_some(), rays.clip.is_some());
        let hits_and_clips = Tape::for_rays(graph, &roots)?;
        let marched = marched
            .map(|marched| Tape::new(graph, &[marched]).map(CachedField::new))
            .transpose()?;
        Ok(Some(Self { hits_and_clips, has_hits, has_clip, marched, copies }))
    }

    /// The part of the field that is marched, if that is not all of it.
    pub(super) fn marched(&self) -> Option<&CachedField> {
        self.marched.as_ref().filter(|_| self.has_hits)
    }

    pub(super) fn prepare<T: Real>(&self, frame: &FrameValues) -> PreIntersectionBatch<'_, T> {
        PreIntersectionBatch {
            hits_and_clips: self.hits_and_clips.prepare::<Packet<T, LANES>>(frame),
            has_hits: self.has_hits,
            has_clip: self.has_clip,
            has_marched: self.marched.is_some(),
            copies: self.copies.as_ref().map(|tape| tape.prepare(frame)),
        }
    }
}

/// The same functions for one frame.
#[derive(Clone)]
pub(super) struct PreIntersectionBatch<'t, T> {
    hits_and_clips: Batch<'t, T>,
    has_hits: bool,
    has_clip: bool,
    has_marched: bool,
    pub(super) copies: Option<Batch<'t, T>>,
}

/// The pre-intersection of a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct PreIntersection<T> {
    /// The hit on the analytic part of the scene; beyond the end of any ray if there is none.
    met: T,
    /// The interval to march; empty (end before start) if there is nothing to march.
    pub(super) start: T,
    pub(super) end: T,
    /// The number of evaluations that it took.
    pub(super) evaluations: u32,
}

impl<T: Real> PreIntersection<T> {
    /// Nothing is known: the ray is marched from end to end.
    pub(super) fn nothing(ray: &Ray<T>) -> Self {
        let (met, start) = (T::constant(FAR), T::constant(0.0));
        Self { met, start, end: ray.t_max, evaluations: 0 }
    }

    /// The analytic hit, if it is within the ray's length and the march has hit nothing.
    pub(super) fn hit(&self, ray: &Ray<T>) -> Option<T> {
        (self.met <= ray.t_max).then_some(self.met)
    }

    /// Returns true if there is something to march.
    pub(super) fn must_march(&self) -> bool {
        self.start <= self.end
    }
}

impl<T: Real> PreIntersectionBatch<'_, T> {
    /// Pre-intersects rays; the result has their order. Rays that record their clearance are
    /// marched through the whole scene, unless they are blocked anyway.
    pub(super) fn look(
        &mut self,
        rays: &[Ray<T>],
        records_clearance: bool,
    ) -> Vec<PreIntersection<T>> {
        let mut known = Vec::with_capacity(rays.len());
        for group in rays.chunks(LANES) {
            let mut ends = [[[T::constant(0.0); 3]; LANES]; 2];
            for (lane, ray) in group.iter().enumerate() {
                ends[0][lane] = ray.origin;
                ends[1][lane] = ray.direction;
            }
            let results = self.hits_and_clips.eval_ray(packed(&ends[0]), packed(&ends[1])).to_vec();
            for (lane, ray) in group.iter().enumerate() {
                let of = |root: usize, part: usize| {
                    let Packet(lanes) = results[root][part];
                    lanes[lane]
                };
                let met = self.has_hits.then(|| of(0, 0));
                let way =
                    self.has_clip.then(|| [0, 1].map(|end| of(usize::from(self.has_hits), end)));
                known.push(self.known(ray, met, way, records_clearance));
            }
        }
        known
    }

    fn known(
        &self,
        ray: &Ray<T>,
        met: Option<T>,
        way: Option<[T; 2]>,
        records_clearance: bool,
    ) -> PreIntersection<T> {
        let mut known = PreIntersection { evaluations: 1, ..PreIntersection::nothing(ray) };
        known.met = met.unwrap_or(known.met);
        let nowhere = T::constant(-1.0);
        if records_clearance {
            if known.met <= ray.t_max {
                known.end = nowhere;
            }
            return known;
        }
        known.end = if self.has_marched { ray.t_max.min(known.met) } else { nowhere };
        if let Some([enter, exit]) = way {
            known.start = enter.max(T::constant(0.0));
            known.end = known.end.min(exit);
        }
        known
    }
}
