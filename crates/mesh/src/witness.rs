//! Finds walls: points of the surface, and where the solid ends behind them.

use crate::fan::{LEAST_TURN, angle_between};
use crate::field::{Prism, Prober, is_inside};
use crate::vector::{Vec3, add, between, length, scale, sub, tangents, unit};

/// A wall: its ends, and their distance rounded up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Witness {
    pub(crate) thickness: f64,
    pub(crate) ends: [Vec3; 2],
}

/// Steps towards the surface.
const MOST_STEPS: u32 = 20;
/// Segments that are proven to be inside, or not, on the way to the end of a wall.
const MOST_SEGMENTS: u32 = 300;
/// Rounds of improving a wall.
const MOST_ROUNDS: u32 = 30;
/// Positions are known to this part of the longest side.
const EXACT: f64 = 1e-12;
/// Both ends of a wall are this part of the longest side from segments that are proven to be
/// inside.
const NEAR: f64 = 1e-7;

/// Looks for walls in a solid with bounds whose longest side is given.
pub(crate) struct Finder<'p, 'f> {
    pub(crate) prober: &'p mut Prober<'f>,
    pub(crate) longest: f64,
}

impl Finder<'_, '_> {
    /// Returns the wall at a point of the surface near a point, if it is thinner than a limit.
    pub(crate) fn wall(&mut self, start: Vec3, reach: f64, limit: f64) -> Option<Witness> {
        let (begin, normal) = self.on_surface(start, reach)?;
        let inward = scale(normal, -1.0);
        let end = self.end(begin, inward, limit)?;
        let (_, gradient) = self.prober.sample(end);
        let turn = angle_between(unit(gradient)?, normal);
        let thickness = length(sub(end, begin)) * (1.0 + 1e-9) + 20.0 * EXACT * self.longest;
        (turn >= LEAST_TURN && thickness < limit)
            .then_some(Witness { thickness, ends: [begin, end] })
    }

    /// Moves the begin of a wall over the surface while the wall becomes thinner.
    pub(crate) fn improve(&mut self, mut best: Witness, mut step: f64) -> Witness {
        for _ in 0..MOST_ROUNDS {
            if step < 1e-6 * self.longest {
                break;
            }
            let Some(normal) = unit(self.prober.sample(best.ends[0]).1) else { break };
            let [u, v] = tangents(normal);
            let moves = [(u, 1.0), (u, -1.0), (v, 1.0), (v, -1.0)];
            let better = moves.into_iter().find_map(|(direction, sign)| {
                let start = add(best.ends[0], scale(direction, sign * step));
                self.wall(start, step, best.thickness * (1.0 - 1e-9))
            });
            match better {
                Some(better) => best = better,
                None => step *= 0.4,
            }
        }
        best
    }

    /// Returns a point of the surface near a point, and the normal there.
    fn on_surface(&mut self, start: Vec3, reach: f64) -> Option<(Vec3, Vec3)> {
        let mut point = start;
        for _ in 0..MOST_STEPS {
            let (value, gradient) = self.prober.sample(point);
            let step = scale(gradient, -value / crate::vector::dot(gradient, gradient));
            if length(step).is_nan() || length(sub(point, start)) > 4.0 * reach {
                return None;
            }
            point = add(point, step);
            if length(step) <= 1e-3 * NEAR * self.longest {
                break;
            }
        }
        let normal = unit(self.prober.sample(point).1)?;
        let offset = scale(normal, NEAR * self.longest);
        let ends = [add(point, offset), sub(point, offset)];
        let values = ends.map(|end| self.prober.value(end));
        if is_inside(values[0]) || !is_inside(values[1]) {
            return None;
        }
        let t = self.prober.root(ends, values, EXACT * self.longest);
        let point = between(ends[0], ends[1], t);
        Some((point, unit(self.prober.sample(point).1)?))
    }

    /// Returns where the solid ends on a ray from a point of its surface.
    fn end(&mut self, begin: Vec3, direction: Vec3, limit: f64) -> Option<Vec3> {
        let least = NEAR * self.longest;
        let mut from = least;
        let mut step = limit.min(self.longest);
        for _ in 0..MOST_SEGMENTS {
            if from >= limit {
                return None;
            }
            let to = from + step;
            if self.is_inside(begin, direction, [from, to]) {
                from = to;
                step *= 2.0;
                continue;
            }
            if step > least {
                step = (0.4 * step).max(0.9 * least);
                continue;
            }
            let ends = [from, to].map(|t| add(begin, scale(direction, t)));
            let values = ends.map(|end| self.prober.value(end));
            if !is_inside(values[1]) && is_inside(values[0]) {
                let t = self.prober.root(ends, values, EXACT * self.longest);
                return Some(between(ends[0], ends[1], t));
            }
            // Faces touch here.
            from = to;
        }
        None
    }

    /// True if a part of a ray is proven to be inside.
    fn is_inside(&mut self, begin: Vec3, direction: Vec3, [from, to]: [f64; 2]) -> bool {
        let center = add(begin, scale(direction, 0.5 * (from + to)));
        if !is_inside(self.prober.value(center)) {
            return false;
        }
        let half = scale(direction, 0.5 * (to - from) * (1.0 + 1e-9));
        self.prober.side_over(&Prism { center, axes: [half, [0.0; 3], [0.0; 3]] }) == Some(true)
    }
}
