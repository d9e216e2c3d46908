//! Proves that no wall thinner than a limit begins in a box.

use std::f64::consts::FRAC_PI_2;

use sdfc_graph::eval::Evaluator;

use crate::fan::{Fan, LEAST_TURN, MARGIN, Piece, along_faces, angle_between, center};
use crate::field::{Frame, LocalField, Prism, Prober, ROUNDING};
use crate::normals::{Sloped, spread};
use crate::vector::{Vec3, add, dot, length, scale, sub, unit};

/// Most pieces that are examined for each level between the fan and its box.
const FEW_PIECES: u64 = 14;
/// The same for a box that is at most as large as the tolerance.
const MOST_PIECES: u64 = 1000;
/// Pieces are not divided below this part of the box.
const FINEST: f64 = 0.25;
/// Distances of planes from the middle that are tried, as parts of the box.
const THICKNESSES: [f64; 3] = [1e-4, 2e-3, 0.05];
/// The field is nearly linear in a box if the surface lies in this part of it.
const FLAT: f64 = 0.01;
/// Fans that are wider have a frame along the faces that meet in the box.
const WIDE: f64 = 0.3;

/// The field around a box, with its registers.
pub(crate) struct Surroundings<'f> {
    pub(crate) prober: Prober<'f>,
    slope: Evaluator<'f, Sloped>,
    tolerance: f64,
    /// Number of boxes and pieces that were examined.
    pub(crate) cells: u64,
}

/// What is known about the walls that begin in a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Found {
    /// The box has no surface.
    Nothing,
    /// No wall that begins in the box is thinner.
    Thickness(f64),
}

impl<'f> Surroundings<'f> {
    pub(crate) fn new(field: &'f LocalField<'_>, tolerance: f64) -> Self {
        Self { prober: field.prober(), slope: field.prepare(), tolerance, cells: 0 }
    }

    /// Returns what is proven about walls that begin in a box and are thinner than a limit.
    pub(crate) fn examine(&mut self, bounds: [Vec3; 2], limit: f64) -> Found {
        self.cells += 1;
        if self.is_one_sided(&Prism::aligned(bounds)) {
            return Found::Nothing;
        }
        let Some(fan) = self.fan(bounds) else { return Found::Thickness(0.0) };
        match fan.heights[0] > fan.heights[1] {
            true => Found::Nothing,
            false => Found::Thickness(self.thickness(&fan, bounds[1][0] - bounds[0][0], limit)),
        }
    }

    /// True if it is proven that the field does not change its sign in a box. Where faces touch
    /// within a solid, it is 0 and exceeds 0 by rounding only.
    fn is_one_sided(&mut self, prism: &Prism) -> bool {
        self.prober.nearly_side_over(prism, ROUNDING).is_some()
    }

    /// Returns the fan of a box; `None` if normals in it may be those of both ends of a wall.
    fn fan(&mut self, bounds: [Vec3; 2]) -> Option<Fan> {
        let [lo, hi] = bounds;
        let margin = 0.5 * (hi[0] - lo[0]);
        let grown = [lo.map(|x| x - margin), hi.map(|x| x + margin)];
        // Outside of an edge, gradients turn from one face to the other one. Points around the box
        // show the normals beyond an edge at its border.
        let tries = [(bounds, 2, 0.0), (grown, 3, 0.0), (grown, 3, f64::INFINITY)];
        let (normals, axis, angle) = tries.into_iter().find_map(|(samples, count, most)| {
            let normals = self.normals(samples, count, most);
            let axis = center(&normals)?;
            let angle = spread(&mut self.slope, bounds, axis).atan();
            (2.0 * angle + MARGIN < LEAST_TURN).then_some((normals, axis, angle))
        })?;
        let frame = match angle > WIDE {
            true => along_faces(bounds, &normals)?,
            false => Frame::around(bounds, axis),
        };
        let heights = self.heights(&frame);
        Some(Fan { bounds, normals, axis, frame, heights, angle })
    }

    /// Returns normals at points of a grid in a box where the field is at most a value.
    fn normals(&mut self, [lo, hi]: [Vec3; 2], count: usize, most: f64) -> Vec<Vec3> {
        let point = |index: usize| {
            let steps = [index % count, index / count % count, index / count.pow(2)];
            std::array::from_fn(|axis| {
                let part = steps[axis] as f64 / (count - 1) as f64;
                lo[axis] + part * (hi[axis] - lo[axis])
            })
        };
        let points = (0..count.pow(3)).map(point);
        let samples = points.map(|point| self.prober.sample(point));
        let is_counted = |(value, _): &(f64, Vec3)| *value <= most;
        samples.filter(is_counted).filter_map(|(_, gradient)| unit(gradient)).collect()
    }

    /// Returns heights over a frame's center between which the surface in it lies. They are out of
    /// order if there is none.
    fn heights(&mut self, frame: &Frame) -> [f64; 2] {
        let end = frame.half[0] * (1.0 + 1e-12);
        let (center, [slope, u, v], error) =
            self.prober.affine_over(&frame.part(-end, end)).terms();
        let middle = -center / slope * end;
        let rest = (u.abs() + v.abs() + error) / slope * end * (1.0 + 1e-12) + 1e-12 * end;
        let [mut lo, mut hi] = [-end, end];
        if slope > 0.0 && middle.is_finite() && rest.is_finite() {
            [lo, hi] = [lo.max(middle - rest), hi.min(middle + rest)];
        }
        if hi - lo <= FLAT * end {
            return [lo, hi];
        }
        // Kinks that cancel each other make the bounds rough, but not on both sides of the kink.
        let (value, gradient) = self.prober.sample(frame.center);
        let height = -value / dot(gradient, frame.normal);
        for part in THICKNESSES {
            let [from, to] = [height - part * end, height + part * end];
            if from > lo && to < hi && self.prober.is_between(frame, 0.0, from, to) {
                return [from, to];
            }
        }
        [lo, hi]
    }

    /// Returns how far it is proven that no wall in a fan ends, up to a limit.
    fn thickness(&mut self, fan: &Fan, side: f64, limit: f64) -> f64 {
        let mut waiting = vec![fan.whole(limit)];
        let mut examined = 0;
        let is_small = side <= self.tolerance;
        // Divisions down to the size of the box.
        let levels = (limit / side).log2().clamp(0.0, 64.0);
        let few = FEW_PIECES + (FEW_PIECES as f64 * levels) as u64;
        let most = if is_small { MOST_PIECES } else { few.min(MOST_PIECES) };
        loop {
            let nearest = |a: &usize, b: &usize| {
                fan.distance(&waiting[*a]).total_cmp(&fan.distance(&waiting[*b]))
            };
            let Some(index) = (0..waiting.len()).min_by(nearest) else { return limit };
            let piece = waiting.swap_remove(index);
            let distance = fan.distance(&piece);
            if distance >= limit {
                return limit;
            }
            if !fan.may_contain(&piece) {
                continue;
            }
            examined += 1;
            self.cells += 1;
            if self.has_no_end(fan, &piece) {
                continue;
            }
            let is_hopeless = self.has_end(fan, &piece, limit);
            let axis = fan.longest(&piece);
            let [from, to] = piece[axis];
            if is_hopeless || examined >= most || to - from <= FINEST * side {
                return distance;
            }
            for half in [[from, 0.5 * (from + to)], [0.5 * (from + to), to]] {
                let mut part = piece;
                part[axis] = half;
                waiting.push(part);
            }
        }
    }

    /// True if it is proven that no wall from the fan's box ends in a piece: there is no surface,
    /// or its normals are not turned far enough, or a segment to it leaves the solid before.
    fn has_no_end(&mut self, fan: &Fan, piece: &Piece) -> bool {
        let prism = fan.prism(piece);
        self.is_one_sided(&prism) || self.is_turned_little(fan, &prism) || {
            let middle = fan.prism(&fan.midway(piece));
            self.prober.value(middle.center) > 0.0 && self.prober.side_over(&middle) == Some(false)
        }
    }

    /// True if it is proven that normals in a box and those at the fan's begin enclose less than
    /// the angle of a wall.
    fn is_turned_little(&mut self, fan: &Fan, prism: &Prism) -> bool {
        let normal = fan.axis;
        let Some(sample) = unit(self.prober.sample(prism.center).1) else { return false };
        if fan.angle + angle_between(sample, normal) >= LEAST_TURN {
            return false;
        }
        let bounds = around(prism);
        let is_little =
            |from: f64, to: f64| from.max(to) < FRAC_PI_2 && from + to + MARGIN < LEAST_TURN;
        if is_little(fan.angle, spread(&mut self.slope, bounds, normal).atan()) {
            return true;
        }
        // Both are near an axis between them, if the piece has a corner.
        let mut normals = self.normals(bounds, 2, f64::INFINITY);
        normals.extend(fan.normals.iter().copied());
        let Some(axis) = center(&normals) else { return false };
        let from = spread(&mut self.slope, fan.bounds, axis).atan();
        from < FRAC_PI_2 && is_little(from, spread(&mut self.slope, bounds, axis).atan())
    }

    /// True if a wall may end in a piece as far as a sample tells: a division does not help.
    fn has_end(&mut self, fan: &Fan, piece: &Piece, limit: f64) -> bool {
        let center = fan.prism(piece).center;
        let (value, gradient) = self.prober.sample(center);
        let Some(sample) = unit(gradient) else { return false };
        if fan.angle + angle_between(sample, fan.axis) < LEAST_TURN {
            return false;
        }
        let end = add(center, scale(sample, -value / length(gradient)));
        let end = fan.frame.coordinates(end).map(|x| [x, x]);
        let is_in_piece = (0..3).all(|axis| {
            let [from, to] = piece[axis];
            from <= end[axis][0] && end[axis][0] <= to
        });
        is_in_piece
            && fan.may_contain(&end)
            && fan.distance(&end) < limit
            && self.prober.value(fan.prism(&fan.midway(&end)).center) < 0.0
    }
}

/// Returns the box around a prism.
fn around(prism: &Prism) -> [Vec3; 2] {
    let half = [0, 1, 2].map(|i| prism.axes.iter().map(|axis| axis[i].abs()).sum::<f64>());
    let half = [0, 1, 2].map(|i| half[i] * (1.0 + 1e-12) + 1e-15 * prism.center[i].abs());
    [sub(prism.center, half), add(prism.center, half)]
}

#[cfg(test)]
mod tests;
