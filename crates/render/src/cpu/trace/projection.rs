//! Follows gradients to the surface, from points that a ray towards a light passes: a field may be
//! the distance to something that is not there.

use sdfc_graph::eval::Packet;

use super::{Limits, Passing, Walk};
use crate::cpu::ray::{Batch, LANES, Real, packed_from};

/// The most steps along gradients.
const MAX_PROJECTIONS: usize = 10;
/// A surface is reached at this fraction of the way.
const ARRIVED: f64 = 0.02;
/// Samples whose gradients are followed are at least this far from each other, as a fraction of the
/// distance there: the least distance of a straight ray is missed by less than a hundredth.
const MIN_WAY: f64 = 0.25;

/// A way along gradients.
struct Way<T> {
    point: [T; 3],
    /// The field at the point.
    distance: T,
    length: T,
    /// The length from which on it does not matter.
    limit: T,
    ended: bool,
}

/// Replaces the distances of what rays pass by ways along the gradients, and drops what does not
/// matter. `field` has the gradient and the value as its results. Each passing has the index of its
/// ray.
pub(super) fn project<T: Real>(
    field: &mut Batch<'_, T>,
    walks: &mut [Walk<T>],
    passings: &mut Vec<(usize, Passing<T>)>,
    limits: &Limits<T>,
) {
    passings.retain(|(index, passing)| walks[*index].needs_projection(passing, limits));
    for group in passings.chunks_mut(LANES) {
        let start = |(index, passing): &(usize, Passing<T>)| Way {
            point: walks[*index].whole.at(passing.along),
            distance: passing.aside,
            length: T::constant(0.0),
            limit: walks[*index].limit(passing, limits),
            ended: false,
        };
        let mut ways: Vec<Way<T>> = group.iter().map(start).collect();
        follow(field, &mut ways);
        for ((index, passing), way) in group.iter_mut().zip(ways) {
            walks[*index].projection = (passing.along, way.length);
            passing.aside = passing.aside.max(way.length);
        }
    }
}

/// Follows gradients by steps as long as the distance.
fn follow<T: Real>(field: &mut Batch<'_, T>, ways: &mut [Way<T>]) {
    let mut gradients = vec![[T::constant(0.0); 3]; ways.len()];
    for step in 0..=MAX_PROJECTIONS {
        let points = packed_from(ways.iter().map(|way| way.point));
        let &[[x, y, z, _], [Packet(values), ..]] = field.eval(points) else { return };
        for (lane, (way, gradient)) in ways.iter_mut().zip(&mut gradients).enumerate() {
            if step > 0 {
                way.distance = values[lane];
                way.ended |= way.distance < T::constant(ARRIVED) * way.length;
            }
            *gradient = [x, y, z].map(|Packet(lanes)| lanes[lane]);
            if !way.ended && step < MAX_PROJECTIONS {
                way.advance(*gradient);
            }
        }
        if ways.iter().all(|way| way.ended) {
            return;
        }
    }
}

impl<T: Real> Way<T> {
    /// Takes a step against the gradient, unless the way gets so long that it does not matter.
    fn advance(&mut self, gradient: [T; 3]) {
        let [x, y, z] = gradient;
        let square = (x * x + y * y + z * z).max(T::constant(1e-12));
        let inverse = T::constant(1.0).div(square.sqrt());
        let stride = self.distance * inverse;
        self.length = self.length + stride;
        self.ended = self.length >= self.limit;
        for (position, slope) in self.point.iter_mut().zip(gradient) {
            *position = *position - stride * inverse * slope;
        }
    }
}

impl<T: Real> Walk<T> {
    /// The distance of what the ray passes from which on it does not matter.
    fn limit(&self, passing: &Passing<T>, limits: &Limits<T>) -> T {
        let clearance = self.clearance;
        let least = if clearance < limits.full_light { clearance } else { limits.full_light };
        least * passing.width
    }

    /// True if the way along gradients may matter: the field is less than the limit, the last
    /// followed sample is not near, and its way does not prove that this one is too long. A
    /// distance falls by no more than the ray moves.
    fn needs_projection(&self, passing: &Passing<T>, limits: &Limits<T>) -> bool {
        let limit = self.limit(passing, limits);
        let (at, length) = self.projection;
        let way = (passing.along - at).abs();
        passing.aside < limit && T::constant(MIN_WAY) * length <= way && length - way < limit
    }
}
