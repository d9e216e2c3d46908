//! Evaluates a shape's field, and finds points of its surface, as the oracle of the checks.
//!
//! The oracle finds the surface by changes of sign alone. It never uses a value of the field as a
//! distance; values and slopes only say where to search next.

use sdfc_graph::eval::{Dual, Evaluator, FrameValues, Tape, evaluate_frame};
use sdfc_graph::{Dim, Expander, Graph, Scene, ShapeId, bounds};

use crate::geometry::{Point, Random, add, combine, distance, dot, length, mix, scaled, sub};

/// Half the size of the window in which a shape without bounds is sampled.
const REACH: f64 = 1.5;
/// Number of points among which changes of sign are searched, and number of surface points to find.
const SEEDS: usize = 1500;
const SURFACE: usize = 500;
/// A change of sign is narrowed to this length, relative to the scale of the field, if the segment
/// that it is searched on is long enough that f64 has points so near to each other. Nearer to the
/// surface the signs are those of rounding errors.
const NARROW: f64 = 1e-14;
const FINEST: f64 = 4.0 * f64::EPSILON;
/// Steps along the surface towards a point.
const MOVES: usize = 40;
/// Relative distance along the surface below which the search stops.
const STALL: f64 = 1e-12;
/// Directions in which the other side of a corner is searched: towards points of the surface, and
/// random ones.
const AIMS: usize = 60;
/// Relative distance to a point that is tried instead of another.
const NEARBY: f64 = 1e-7;

/// The field of a shape as a program, undivided.
pub struct Field {
    tape: Tape,
    frame: FrameValues,
    /// Number of axes: 2 for a region.
    pub axes: usize,
    /// Stated or derived bounds.
    pub bounds: [Point; 2],
}

impl Field {
    /// Returns `None` if the shape is empty or its program is too large.
    pub fn new(scene: &Scene, id: ShapeId) -> Option<Self> {
        let mut graph: Graph = scene.graph.clone();
        let dim = graph.shape(id).dim;
        let frame = FrameValues::defaults(&scene.params);
        let ends = bounds(&mut graph, id, &scene.params);
        let ends = evaluate_frame(&graph, &ends, &frame);
        let bounds = [0, 1].map(|end| [ends[end][0], ends[end][1], ends[end][2]]);
        let axes = if dim == Dim::Two { 2 } else { 3 };
        if (0..axes).any(|axis| bounds[0][axis] > bounds[1][axis]) {
            return None;
        }
        let point = graph.point(0, Dim::Three);
        let point = if axes == 2 { graph.swizzle(point, &[0, 1]) } else { point };
        let distance = Expander::new().field(&mut graph, id, point).ok()?;
        let tape = Tape::new(&graph, &[distance]).ok()?;
        Some(Self { tape, frame, axes, bounds })
    }

    /// Returns an evaluator of the field.
    pub fn evaluator(&self) -> FieldEvaluator<'_> {
        let value = self.tape.prepare(&self.frame);
        let dual = self.tape.prepare(&self.frame);
        FieldEvaluator { field: self, scale: self.scale(), value, dual }
    }

    /// Returns the bounds, cut where they are infinite.
    pub fn window(&self) -> [Point; 2] {
        let cut = |end: f64, instead: f64| if end.is_finite() { end } else { instead };
        let [lo, hi] = self.bounds;
        let end = |from: Point, instead: f64| {
            [0, 1, 2].map(|axis| if axis < self.axes { cut(from[axis], instead) } else { 0.0 })
        };
        // A finite end may lie beyond the default for the other end, which is infinite.
        let lo = end(lo, -REACH);
        let hi = end(hi, REACH);
        [
            combine(lo, hi, |lo, hi| lo.min(hi - REACH / 2.0).max(lo.min(hi))),
            combine(lo, hi, f64::max),
        ]
    }

    /// Returns the length of the window's longest edge.
    pub fn scale(&self) -> f64 {
        let [lo, hi] = self.window();
        sub(hi, lo).into_iter().fold(1e-6, f64::max)
    }
}

/// A field with its registers.
pub struct FieldEvaluator<'f> {
    field: &'f Field,
    scale: f64,
    value: Evaluator<'f, f64>,
    dual: Evaluator<'f, Dual>,
}

impl FieldEvaluator<'_> {
    pub fn at(&mut self, p: Point) -> f64 {
        self.value.scalar(p)
    }

    /// Returns the gradient.
    pub fn slope(&mut self, p: Point) -> Point {
        let mut slope = self.dual.scalar(Dual::point(p)).partials;
        // Only the picture of a region depends on z, not its field.
        slope[self.field.axes..].fill(0.0);
        slope
    }

    /// Returns a random point of the window, grown by `grown`. One coordinate in four lies on a
    /// face, and one in eight in the middle, because formulas fail at edges, corners and axes.
    pub fn point(&self, random: &mut Random, grown: f64) -> Point {
        let [lo, hi] = self.field.window();
        [0, 1, 2].map(|axis| {
            if axis >= self.field.axes {
                return 0.0;
            }
            let (lo, hi) = (lo[axis] - grown, hi[axis] + grown);
            match random.below(8) {
                0 => lo,
                1 => hi,
                2 if lo < 0.0 && hi > 0.0 => 0.0,
                _ => lo + (hi - lo) * random.unit(),
            }
        })
    }

    /// Returns points of the surface, found between points of opposite sign.
    pub fn surface(&mut self, random: &mut Random) -> Vec<Point> {
        let margin = 0.1 * self.scale;
        let seeds: Vec<Point> =
            (0..SEEDS).map(|i| self.point(random, if i % 2 == 0 { 0.0 } else { margin })).collect();
        // Where the field is 0, the point is on neither side.
        let mut side = |sign: f64| -> Vec<Point> {
            seeds.iter().copied().filter(|&p| sign * self.at(p) > 0.0).collect()
        };
        let (inside, outside) = (side(-1.0), side(1.0));
        if inside.is_empty() || outside.is_empty() {
            return Vec::new();
        }
        (0..SURFACE)
            .map(|i| {
                let from = inside[i % inside.len()];
                let to = outside[random.below(outside.len())];
                self.between(from, to)
            })
            .collect()
    }

    /// Returns the last point inside on the segment from a point inside to one outside.
    ///
    /// This is the ITP method (Oliveira and Takahashi, ACM TOMS 47, 2020): it tests signs near the
    /// zero of the line through the values at both ends, but never needs more than one step more
    /// than bisection, whatever the values are.
    fn between(&mut self, inside: Point, outside: Point) -> Point {
        let narrow = NARROW * self.scale / distance(inside, outside);
        if narrow >= 1.0 {
            return inside;
        }
        let narrow = narrow.max(FINEST);
        let steps = 1 + (-narrow.log2()).ceil() as i32;
        let (mut lo, mut hi) = (0.0, 1.0);
        let (mut at_lo, mut at_hi) = (self.at(inside), self.at(outside));
        for step in 0..steps {
            let (width, middle) = (hi - lo, 0.5 * (lo + hi));
            if width <= narrow {
                break;
            }
            let zero = (at_hi * lo - at_lo * hi) / (at_hi - at_lo);
            // Beside the zero towards the middle, so that the next sign moves the farther end.
            let beside = (0.2 * width * width).max(0.5 * narrow);
            let aim = if (zero - middle).abs() > beside {
                zero + beside.copysign(middle - zero)
            } else {
                middle
            };
            // As far from the middle as the rest of the steps makes up for by bisection.
            let reach = (0.5 * narrow * 2_f64.powi(steps - step) - 0.5 * width).max(0.0);
            let at =
                if aim.is_finite() { aim.clamp(middle - reach, middle + reach) } else { middle };
            let value = self.at(mix(inside, outside, at));
            if value < 0.0 { (lo, at_lo) = (at, value) } else { (hi, at_hi) = (at, value) }
        }
        mix(inside, outside, lo)
    }

    /// Returns where a line crosses the surface within `reach` of `p`, if it does.
    fn on_line(&mut self, p: Point, direction: Point, reach: f64) -> Option<Point> {
        let is_inside = self.at(p) < 0.0;
        for share in [0.05, 0.25, 1.0] {
            for sign in [1.0, -1.0] {
                let q = add(p, scaled(direction, sign * share * reach));
                if (self.at(q) < 0.0) != is_inside {
                    return Some(if is_inside { self.between(p, q) } else { self.between(q, p) });
                }
            }
        }
        None
    }

    /// Moves a point along the surface to a local minimum of the distance to the target.
    pub fn towards(&mut self, target: Point, from: Point) -> Point {
        let mut at = from;
        let mut step = 1.0;
        for _ in 0..MOVES {
            let slope = self.slope(at);
            let steep = length(slope);
            if !(steep.is_finite() && steep > 0.0) {
                break;
            }
            let normal = scaled(slope, 1.0 / steep);
            let way = sub(target, at);
            let along = sub(way, scaled(normal, dot(way, normal)));
            if length(along) <= STALL * length(way) {
                break;
            }
            let moved = add(at, scaled(along, step));
            let found = self.on_line(moved, normal, length(along) * step);
            match found.filter(|&found| distance(found, target) < distance(at, target)) {
                Some(found) => {
                    at = found;
                    step = f64::min(1.0, step * 1.5);
                }
                None if step > 1e-6 => step *= 0.35,
                None => break,
            }
        }
        at
    }

    /// Returns an upper bound of the distance from `p` to the surface: to the nearest points found,
    /// moved along the surface, and to the foot point that the field's gradient gives, if the sign
    /// changes there. Infinite if no point was found.
    pub fn nearest(&mut self, p: Point, surface: &[Point], random: &mut Random) -> f64 {
        let mut nearest: Vec<(f64, Point)> = surface.iter().map(|&s| (distance(p, s), s)).collect();
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut least = nearest.first().map_or(f64::INFINITY, |first| first.0);
        for (_, start) in nearest.into_iter().take(2) {
            let found = self.towards(p, start);
            least = least.min(distance(p, found));
        }
        // On a face, or right above it, the descent may run along the face; from a nearby point it
        // does not.
        let near = NEARBY * self.scale;
        let axes = self.field.axes;
        for round in 0..5 {
            let reach = if round == 0 { 0.0 } else { near };
            let offset =
                [0, 1, 2].map(|axis| if axis < axes { reach * random.signed() } else { 0.0 });
            if let Some(foot) = self.foot(add(p, offset)) {
                return least.min(foot + length(offset));
            }
        }
        self.corner(p, surface, random).map_or(least, |corner| least.min(corner))
    }

    /// Returns the distance from `p` to the foot point that the gradient gives, if the sign changes
    /// near it. The descent to a sharp corner may miss the surface.
    fn corner(&mut self, p: Point, surface: &[Point], random: &mut Random) -> Option<f64> {
        let (f, slope) = (self.at(p), self.slope(p));
        let foot = sub(p, scaled(slope, f / length(slope)));
        let aims = surface.iter().step_by(surface.len().div_ceil(AIMS).max(1));
        let mut ways: Vec<Point> = aims.map(|&aim| sub(aim, foot)).collect();
        ways.extend((0..AIMS).map(|_| [0; 3].map(|_| random.signed())));
        for way in ways {
            let mut beside = add(foot, scaled(way, NEARBY * self.scale / length(way)));
            // From there, follow the field's gradient; only the sign of the field counts.
            for _ in 0..3 {
                let found = self.at(beside);
                if found * f < 0.0 {
                    return Some(distance(p, beside));
                }
                let slope = self.slope(beside);
                beside = sub(beside, scaled(slope, 1.05 * found / dot(slope, slope)));
            }
        }
        None
    }

    /// Returns the distance from `p` to the surface along the gradient, if it is |f|.
    fn foot(&mut self, p: Point) -> Option<f64> {
        let (f, slope) = (self.at(p), self.slope(p));
        let steep = length(slope);
        if !(steep.is_finite() && steep > 0.0 && f != 0.0) {
            return None;
        }
        let down = scaled(slope, -f.signum() / steep);
        let beyond = add(p, scaled(down, f.abs() * (1.0 + 1e-7) + 1e-9));
        let before = add(p, scaled(down, f.abs() * (1.0 - 1e-4)));
        // A zero inside the solid is no surface; at the surface the sign stays changed.
        let past = add(p, scaled(down, f.abs() + 1e-4 * self.scale));
        let is_inside = f < 0.0;
        let crossed = (self.at(beyond) <= 0.0) != is_inside || self.at(beyond) == 0.0;
        let stays = (self.at(past) < 0.0) != is_inside;
        let before = (self.at(before) < 0.0) == is_inside;
        (crossed && stays && before).then(|| distance(p, beyond))
    }
}
