//! The smallest distance between two solids.

use std::collections::BinaryHeap;
use std::ops::ControlFlow;

use sdfc_graph::Program;
use sdfc_graph::eval::{FrameValues, Number};
use serde::Serialize;

use crate::certify::parts;
use crate::error::{MeshError, Phase, Progress};
use crate::field::{Field, LocalField, Prism, Prober};
use crate::measurement::{MeasureOptions, Proven};
use crate::mesh::check_relative;
use crate::refine::report;
use crate::vector::{Vec3, add, between, length, longest_side, scale, sub, unit};

/// The smallest distance between two solids.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Clearance {
    /// The distance between the nearest points, in scene units; 0 if the solids collide.
    pub distance: Proven,
    /// True or false if it is proven that the solids have a common inner point, or none.
    pub collides: Option<bool>,
    /// A point of each solid. Their distance is the upper end of `distance`. Equal if the solids
    /// collide.
    pub nearest: Option<[[f64; 3]; 2]>,
    /// True if the limit of boxes was reached before the distance was known well enough. The
    /// interval is true nevertheless.
    pub is_limited: bool,
}

/// Boxes that are divided between two reports of progress.
const CHUNK: u64 = 512;
/// Steps towards a solid.
const MOST_STEPS: u32 = 60;

/// Bounds the smallest distance between two solids.
///
/// Let a and b be fields that never exceed the distance from their solids. Then the distance
/// between the solids is at least the least value of `max(a, 0) + max(b, 0)`: at a point between
/// the nearest points, it is at most the sum of the distances from both. Boxes are divided where
/// this may be least. Points that are proven to be inside bound the distance from above.
///
/// The bounds of the options are around both solids, and `is_certified` tells if both fields never
/// exceed the distance. Otherwise the lower end is 0. The work stops if `progress` breaks.
///
/// # Errors
///
/// [`MeshError`].
pub fn clearance(
    solids: [&Program; 2],
    frame: &FrameValues,
    options: &MeasureOptions,
    is_certified: bool,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Clearance, MeshError> {
    let MeasureOptions { bounds, relative, max_cells } = *options;
    check_relative(bounds, relative)?;
    let [first, second] = solids.map(Field::new);
    let [first, second] =
        [first?.ok_or(MeshError::NothingDrawn)?, second?.ok_or(MeshError::NothingDrawn)?];
    let fields = [&first, &second].map(|field| LocalField::new(field.distance(), frame));
    let [first, second] = &fields;
    let mut pair = Pair { probers: [first.prober(), second.prober()], best: None };
    let longest = longest_side(bounds);
    let mut waiting = BinaryHeap::from([Waiting { least: pair.least(bounds), bounds }]);
    let mut cells = 0;
    let mut is_limited = false;
    while let Some(Waiting { least, bounds }) = waiting.peek().copied() {
        if pair.upper() - least <= relative * longest {
            break;
        }
        if cells >= max_cells {
            is_limited = true;
            break;
        }
        waiting.pop();
        pair.try_point(between(bounds[0], bounds[1], 0.5), longest);
        for bounds in parts(bounds, false) {
            cells += 1;
            let least = pair.least(bounds);
            if least < pair.upper() {
                waiting.push(Waiting { least, bounds });
            }
        }
        if cells % CHUNK == 0 {
            report(progress, Phase::Measuring, cells as usize, max_cells as usize)?;
        }
    }
    // Boxes that were left out are not below the upper end.
    let upper = pair.upper();
    let least = waiting.peek().map_or(upper, |box_| box_.least.min(upper)).max(0.0);
    let collides = if upper == 0.0 { Some(true) } else { (least > 0.0).then_some(false) };
    let lower = if is_certified { least } else { 0.0 };
    Ok(Clearance {
        distance: [lower, upper],
        collides,
        nearest: pair.best.map(|(_, points)| points),
        is_limited,
    })
}

/// A box, and a lower bound of the sum of both distances in it. The least one comes first.
#[derive(Clone, Copy)]
struct Waiting {
    least: f64,
    bounds: [Vec3; 2],
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        other.least.total_cmp(&self.least)
    }
}

/// Two solids, and the nearest points that are known.
struct Pair<'f> {
    probers: [Prober<'f>; 2],
    best: Option<(f64, [Vec3; 2])>,
}

impl Pair<'_> {
    fn upper(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |(distance, _)| distance)
    }

    /// Returns a lower bound of the sum of both distances in a box.
    fn least(&mut self, bounds: [Vec3; 2]) -> f64 {
        let prism = Prism::aligned(bounds);
        let [a, b] = self.probers.each_mut().map(|prober| prober.affine_over(&prism));
        let apart = (a.range().lo().max(0.0) + b.range().lo().max(0.0)).next_down();
        // Where one falls as the other one rises, their sum is known better than each.
        apart.max(a.add(b).range().lo())
    }

    /// Looks for a point of each solid near a point.
    fn try_point(&mut self, point: Vec3, longest: f64) {
        let [a, b] = &mut self.probers;
        let Some(first) = inner(a, point, longest) else { return };
        // The second point is looked for from the first one too, which is nearer in most cases.
        for start in [point, first] {
            let Some(second) = inner(b, start, longest) else { continue };
            let distance = match first == second {
                true => 0.0,
                false => length(sub(first, second)) * (1.0 + 1e-14),
            };
            if self.best.is_none_or(|(known, _)| distance < known) {
                self.best = Some((distance, [first, second]));
            }
        }
    }
}

/// Returns a point that is proven to be inside, by steps down the gradient.
fn inner(prober: &mut Prober<'_>, mut point: Vec3, longest: f64) -> Option<Vec3> {
    let mut extra = 1e-9 * longest;
    for _ in 0..MOST_STEPS {
        if prober.proven_side(point) == Some(true) {
            return Some(point);
        }
        let (_, gradient) = prober.sample(point);
        let step = prober.distance(point) + extra;
        point = add(point, scale(unit(gradient)?, -step));
        extra *= 1.3;
    }
    None
}
