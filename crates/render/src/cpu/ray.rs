//! Rays on the CPU, and the evaluation of tapes at several points at once.

use std::ops::{Add, Mul, Sub};

use sdfc_graph::eval::{Evaluator, Number, Packet};

/// The number of points evaluated together: enough that decoding an instruction costs little beside
/// running it.
pub(super) const LANES: usize = 16;

/// An evaluator of [`LANES`] points at a time.
pub(super) type Batch<'t, T> = Evaluator<'t, Packet<T, LANES>>;

/// The number type in which rays are marched: f32, as in the shader, or f64.
pub trait Real:
    Number
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Into<f64>
    + Send
    + Sync
{
}

impl Real for f32 {}
impl Real for f64 {}

/// A ray with the cone that its pixel covers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray<T> {
    pub(super) origin: [T; 3],
    /// A unit vector.
    pub(super) direction: [T; 3],
    pub(super) t_max: T,
    /// Radius of the cone at the origin, and its growth per unit of length.
    pub(super) radius: T,
    pub(super) spread: T,
    /// Distance below which a point is a hit, in widths of the cone there (`auto`, `interval`).
    pub(super) tolerance: T,
}

/// Rounding error of a point relative to its distance from the scene's origin: eight units in the
/// last place of f32, also in f64, so that the tolerances are the same.
const ROUNDING: f64 = 1e-6;

impl<T: Real> Ray<T> {
    pub(super) fn at(&self, t: T) -> [T; 3] {
        std::array::from_fn(|axis| self.origin[axis] + t * self.direction[axis])
    }

    /// Radius of the cone at t.
    pub(super) fn footprint(&self, t: T) -> T {
        self.radius + self.spread * t
    }

    /// The rest of the ray from t on.
    pub(super) fn advanced(&self, t: T) -> Self {
        let (origin, radius, t_max) = (self.at(t), self.footprint(t), self.t_max - t);
        Self { origin, radius, t_max, ..*self }
    }

    /// The part of the ray between two positions.
    pub(super) fn between(&self, [start, end]: [T; 2]) -> Self {
        Self { t_max: end - start, ..self.advanced(start) }
    }

    /// The largest error of a point of the ray by rounding.
    pub(super) fn rounding(&self, t: T) -> T {
        let [x, y, z] = self.origin;
        T::constant(ROUNDING) * ((x * x + y * y + z * z).sqrt() + t)
    }
}

/// Evaluates functions of surfaces, of which each is a point, a normal and a direction to the eye.
pub(super) fn surface_values<T: Real>(
    evaluator: &mut Batch<'_, T>,
    surfaces: &[[[T; 3]; 3]],
) -> Vec<Vec<[f64; 4]>> {
    let mut values = Vec::with_capacity(surfaces.len());
    for group in surfaces.chunks(LANES) {
        let [point, normal, view] =
            [0, 1, 2].map(|vector| packed_from(group.iter().map(|surface| surface[vector])));
        let roots = evaluator.eval_surface(point, normal, view);
        values.extend((0..group.len()).map(|lane| unpacked(roots, lane)));
    }
    values
}

/// One lane of the values of roots.
fn unpacked<T: Real>(roots: &[[Packet<T, LANES>; 4]], lane: usize) -> Vec<[f64; 4]> {
    roots.iter().map(|root| root.map(|Packet(lanes)| lanes[lane].into())).collect()
}

/// At most [`LANES`] points as one point. Lanes without a point are 0.
pub(super) fn packed_from<T: Real>(points: impl Iterator<Item = [T; 3]>) -> [Packet<T, LANES>; 3] {
    let mut filled = [[T::constant(0.0); 3]; LANES];
    for (lane, point) in filled.iter_mut().zip(points) {
        *lane = point;
    }
    packed(&filled)
}

pub(super) fn packed<T: Real>(points: &[[T; 3]; LANES]) -> [Packet<T, LANES>; 3] {
    std::array::from_fn(|axis| Packet(points.map(|point| point[axis])))
}
