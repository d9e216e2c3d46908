//! Samples of one shape's field.

use sdfc_graph::eval::{Dual, Evaluator, FrameValues, Tape};
use sdfc_graph::{Expander, Graph, NodeId, ShapeId};

use crate::certify::promise::Promise;
use crate::refute::sampling::{
    Effort, Point, REACH, Random, corners_at, distance, grown, longest, point_of, window,
};

/// Number of pairs of points for a constant, of points for bounds and promises, and of points on
/// the surface.
const PAIRS: usize = 1500;
const POINTS: usize = 400;
const SURFACE: usize = 200;
/// Bisections between points of opposite sign, and iterations of the search for the nearest point
/// of a surface.
const BISECTIONS: usize = 50;
/// Number of points on a line that is searched for a film, and of steps of the search for the least
/// value between two of them.
const LINE_POINTS: usize = 24;
const NARROWINGS: usize = 48;
const ITERATIONS: usize = 300;
/// Fraction of the region's size by which the lines reach beyond it.
const BEYOND: f64 = 0.2;
/// The least value on a film, as a fraction of the values beside it.
const FILM: f64 = 1e-6;
/// How much steeper than between two points of a line the field may be between them.
const STEEPEST: f64 = 8.0;
/// Relative tolerances of constants and of distances. A promise that fails by less is not reported.
const SLACK: f64 = 1e-6;
const INEXACT: f64 = 1e-3;

/// One shape's field at fixed values of the params.
pub(super) struct Probe {
    tape: Tape,
    frame: FrameValues,
    axes: usize,
    /// Stated or derived bounds.
    bounds: [Point; 2],
    /// The bounds, limited where they are infinite.
    region: [Point; 2],
    /// The longest edge of the region.
    scale: f64,
    random: Random,
    effort: Effort,
}

impl Probe {
    /// Expands the field. Returns `None` if that fails, or if the bounds are empty.
    pub(super) fn new(
        graph: &mut Graph,
        shape: ShapeId,
        corners: [NodeId; 2],
        frame: &FrameValues,
        effort: Effort,
    ) -> Option<Self> {
        let dim = graph.shape(shape).dim;
        let axes = dim.point_type().width();
        let bounds = corners_at(graph, corners, frame)?;
        let point = point_of(graph, dim);
        let field = Expander::new().field(graph, shape, point).ok()?;
        let tape = Tape::new(graph, &[field]).ok()?;
        let region = window(bounds, axes, REACH)?;
        let scale = longest(region);
        let (frame, random) = (frame.clone(), Random(7));
        (scale > 0.0).then_some(Self { tape, frame, axes, bounds, region, scale, random, effort })
    }

    fn field(&self) -> Evaluator<'_, f64> {
        self.tape.prepare(&self.frame)
    }

    /// The field at a point.
    pub(super) fn at(&self, p: Point) -> f64 {
        self.field().scalar(p)
    }

    /// The coordinates of a point in the shape's dimension.
    pub(super) fn lanes(&self, p: Point) -> Vec<f64> {
        p[..self.axes].to_vec()
    }

    /// A random point of the region, which is enlarged by a fraction of its size.
    fn point(&mut self, enlarged: f64) -> Point {
        self.point_in(self.region, enlarged)
    }

    /// A random point of a box, which is enlarged by a fraction of its size.
    fn point_in(&mut self, region: [Point; 2], enlarged: f64) -> Point {
        let margin = enlarged * longest(region);
        self.random.point(grown(region, [margin; 3]), self.axes)
    }

    /// A point inside the shape and outside its bounds, and the field there.
    pub(super) fn beyond_bounds(&mut self) -> Option<(Vec<f64>, f64)> {
        let slack = SLACK * self.scale;
        (0..self.effort.samples(PAIRS, 1, &self.tape)).find_map(|index| {
            let p = self.point([0.02, 0.2, 1.0][index % 3]);
            let beyond = |axis: usize| {
                p[axis] < self.bounds[0][axis] - slack || p[axis] > self.bounds[1][axis] + slack
            };
            let field = self.at(p);
            (field < -slack && (0..self.axes).any(beyond)).then(|| (self.lanes(p), field))
        })
    }

    /// Two points of the region between which the slope exceeds `constant`, and the slope.
    pub(super) fn steeper(&mut self, constant: f64) -> Option<(Point, Point, f64)> {
        let count = self.effort.samples(PAIRS, 1, &self.tape);
        let pairs: Vec<[Point; 2]> =
            (0..count).map(|_| [self.point(0.0), self.point(0.0)]).collect();
        let mut field = self.field();
        let mut slopes = self.tape.prepare::<Dual>(&self.frame);
        pairs.into_iter().enumerate().find_map(|(index, [p, other])| {
            let fraction = [1.0, 1e-2, 1e-4][index % 3];
            let uphill = slopes.scalar(Dual::point(p)).partials;
            let step = 1e-5 * self.scale / distance(uphill, [0.0; 3]).max(1e-30);
            let near = self.within([0, 1, 2].map(|axis| p[axis] + step * uphill[axis]));
            [mix(p, other, fraction), near].into_iter().find_map(|q| {
                let (a, b) = (field.scalar(p), field.scalar(q));
                let (rise, run) = ((a - b).abs(), distance(p, q));
                let rounding = 1e-12 * (a.abs() + self.scale);
                (run > 0.0 && rise > constant * run * (1.0 + SLACK) + rounding).then_some((
                    p,
                    q,
                    rise / run,
                ))
            })
        })
    }

    fn within(&self, p: Point) -> Point {
        [0, 1, 2].map(|axis| p[axis].clamp(self.region[0][axis], self.region[1][axis]))
    }

    /// A point at which the field breaks the promises for outside and inside, the field and the
    /// distance there. All searches for distances share the evaluations that a test may take.
    pub(super) fn wrong_distance(
        &mut self,
        promised: [Promise; 2],
    ) -> Option<(Vec<f64>, f64, f64)> {
        let surface = self.surface();
        if surface.is_empty() {
            return None;
        }
        let mut left = self.effort.evaluations(&self.tape);
        for index in 0..self.effort.samples(POINTS, 1, &self.tape) {
            let p = self.point([0.0, 0.5][index % 2]);
            let field = self.at(p);
            let promise = promised[usize::from(field < 0.0)];
            if !field.is_finite() || promise == Promise::None {
                continue;
            }
            let nearest = surface
                .iter()
                .copied()
                .min_by(|a, b| distance(p, *a).total_cmp(&distance(p, *b)))?;
            let size = field.abs();
            let too_far = size > distance(p, nearest) * (1.0 + INEXACT) + SLACK * self.scale;
            if too_far || (promise == Promise::Exact && !self.has_foot(p, field)) {
                let (nearest_surface, is_found) = self.nearest_distance(p, nearest, &mut left);
                let slack = INEXACT * nearest_surface + SLACK * self.scale;
                let exact = is_found && promise == Promise::Exact;
                let under = exact && size < nearest_surface - slack;
                if size > nearest_surface + slack || under {
                    return Some((self.lanes(p), field, nearest_surface));
                }
            }
        }
        None
    }

    /// True if the nearest surface point, as an exact distance and its gradient give it, is on the
    /// surface.
    fn has_foot(&self, p: Point, field: f64) -> bool {
        let slope = self.tape.prepare::<Dual>(&self.frame).scalar(Dual::point(p)).partials;
        let foot = [0, 1, 2].map(|axis| p[axis] - field * slope[axis]);
        self.at(foot).abs() <= INEXACT * field.abs() + SLACK * self.scale
    }

    /// The scalar operations of one evaluation.
    pub(super) fn operations(&self) -> u64 {
        self.tape.operations() as u64
    }

    /// The scalar operations that [`Self::film_in`] takes at most, if a line has one such minimum.
    pub(super) fn operations_of_line(&self) -> u64 {
        (LINE_POINTS + NARROWINGS) as u64 * self.operations()
    }

    /// A point of a film on a random line through a box: a minimum of the field along the line that
    /// is 0 and not negative. Axes on which the box is infinite are limited.
    pub(super) fn film_in(&mut self, bounds: [Point; 2]) -> Option<Vec<f64>> {
        let region = window(bounds, self.axes, REACH)?;
        let [from, to] = [(); 2].map(|()| self.point_in(region, BEYOND));
        let mut at = film_between(&mut self.field(), from, to)?;
        // Other coordinates are rounding errors.
        for coordinate in &mut at {
            *coordinate = if coordinate.abs() < 1e-9 * self.scale { 0.0 } else { *coordinate };
        }
        Some(self.lanes(at))
    }

    /// Points of the surface, by bisection between points of opposite sign.
    fn surface(&mut self) -> Vec<Point> {
        // Each point of the surface takes a bisection.
        let count = self.effort.samples(SURFACE, BISECTIONS, &self.tape);
        let points: Vec<Point> = (0..4 * count).map(|i| self.point([0.0, 0.1][i % 2])).collect();
        let mut field = self.tape.prepare::<f64>(&self.frame);
        let (inside, outside): (Vec<_>, Vec<_>) =
            points.into_iter().partition(|&p| field.scalar(p) < 0.0);
        if inside.is_empty() || outside.is_empty() {
            return Vec::new();
        }
        let mut random = Random(11);
        (0..count)
            .map(|i| {
                let from = inside[i % inside.len()];
                let to = outside[(random.next() * outside.len() as f64) as usize % outside.len()];
                crossing(&mut field, from, to)
            })
            .collect()
    }

    /// The distance to the nearest point of the surface, by a random search that starts at `first`.
    /// Returns false with an upper bound if no evaluations are left for the search.
    fn nearest_distance(&mut self, p: Point, first: Point, left: &mut u64) -> (f64, bool) {
        let mut field = self.tape.prepare::<f64>(&self.frame);
        let sign = field.scalar(p) < 0.0;
        let mut best = first;
        for index in 0..ITERATIONS {
            let nearest_surface = distance(p, best);
            if *left == 0 {
                return (nearest_surface, false);
            }
            // The search narrows with each iteration.
            let spread = 0.5f64.powf(12.0 * index as f64 / ITERATIONS as f64);
            let mut target = best;
            for coordinate in target.iter_mut().take(self.axes) {
                *coordinate += nearest_surface * spread * self.random.signed();
            }
            let length = distance(p, target).max(1e-30);
            let target = mix(p, target, nearest_surface * (1.0 - 1e-6) / length);
            *left -= 1;
            if (field.scalar(target) < 0.0) != sign {
                best = crossing(&mut field, p, target);
                *left = left.saturating_sub(BISECTIONS as u64);
            }
        }
        (distance(p, best), true)
    }
}

/// The point between two points of opposite sign at which the sign changes.
fn crossing(field: &mut Evaluator<'_, f64>, mut from: Point, mut to: Point) -> Point {
    let sign = field.scalar(from) < 0.0;
    for _ in 0..BISECTIONS {
        let middle = mix(from, to, 0.5);
        let end = if (field.scalar(middle) < 0.0) == sign { &mut from } else { &mut to };
        *end = middle;
    }
    from
}

/// A point between two points at which the field is 0 and a minimum along the line.
fn film_between(field: &mut Evaluator<'_, f64>, from: Point, to: Point) -> Option<Point> {
    let step = 1.0 / (LINE_POINTS - 1) as f64;
    let mut at = |t: f64| field.scalar(mix(from, to, t));
    let values: Vec<f64> = (0..LINE_POINTS).map(|i| at(i as f64 * step)).collect();
    (1..LINE_POINTS - 1).find_map(|i| {
        let [before, least, after] = [values[i - 1], values[i], values[i + 1]];
        if !(least > 0.0 && least <= before && least < after) {
            return None;
        }
        let ends = [i - 1, i + 1].map(|i| i as f64 * step);
        zero_between(&mut at, ends, [before, after]).map(|t| mix(from, to, t))
    })
}

/// Where the field is 0 at its minimum between two parameters of a line, by golden-section search.
/// `None` if it is negative somewhere on the way, or if only an unlikely slope could lead to 0.
fn zero_between(
    at: &mut impl FnMut(f64) -> f64,
    [mut lo, mut hi]: [f64; 2],
    [before, after]: [f64; 2],
) -> Option<f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    // Where two faces coincide, rounding errors may give a tiny negative value.
    let rounding = FILM * before.min(after);
    let steepest = STEEPEST * before.max(after) / (hi - lo);
    let [mut a, mut b] = [hi - GOLDEN * (hi - lo), lo + GOLDEN * (hi - lo)];
    let [mut at_a, mut at_b] = [at(a), at(b)];
    for _ in 0..NARROWINGS {
        let least = at_a.min(at_b);
        if least < -rounding || least > steepest * (hi - lo) + rounding {
            return None;
        }
        if at_a < at_b {
            (hi, b, at_b) = (b, a, at_a);
            a = hi - GOLDEN * (hi - lo);
            at_a = at(a);
        } else {
            (lo, a, at_a) = (a, b, at_b);
            b = lo + GOLDEN * (hi - lo);
            at_b = at(b);
        }
    }
    (at_a.min(at_b) <= rounding).then_some(0.5 * (lo + hi))
}

fn mix(a: Point, b: Point, t: f64) -> Point {
    [0, 1, 2].map(|axis| a[axis] + (b[axis] - a[axis]) * t)
}

#[cfg(test)]
mod tests {
    use sdfc_graph::Dim;

    use super::*;

    /// A ball of radius 1 whose field is a multiple of the distance, and the number of evaluations
    /// that a test may take.
    fn ball(slope: f64, evaluations: u64) -> Probe {
        let mut graph = Graph::new();
        let p = point_of(&mut graph, Dim::Three);
        let (length, one, slope) = (graph.length(p), graph.number(1.0), graph.number(slope));
        let distance = graph.sub(length, one);
        let field = graph.mul(distance, slope);
        let tape = Tape::new(&graph, &[field]).unwrap();
        let effort = Effort(evaluations * tape.operations() as u64);
        let (frame, bounds) = (FrameValues::default(), [[-1.0; 3], [1.0; 3]]);
        let (axes, region, scale, random) = (3, bounds, 2.0, Random(7));
        Probe { tape, frame, axes, bounds, region, scale, random, effort }
    }

    #[test]
    fn a_search_takes_no_more_evaluations_than_are_left() {
        let search = |mut left: u64| {
            let found = ball(1.0, 0).nearest_distance([2.0, 0.0, 0.0], [0.6, 0.8, 0.0], &mut left);
            (found, left)
        };
        let ((distance, is_found), left) = search(1_000_000);
        assert!(is_found && (distance - 1.0).abs() < 1e-3, "{distance}");
        let taken = 1_000_000 - left;
        assert!((ITERATIONS as u64..100_000).contains(&taken), "{taken}");
        let ((distance, is_found), left) = search(100);
        assert!(!is_found && left == 0 && distance > 1.0, "{distance}");
    }

    #[test]
    fn the_searches_of_a_test_share_its_evaluations() {
        let exact = [Promise::Exact; 2];
        assert!(ball(0.5, 100_000).wrong_distance(exact).is_some());
        // Not enough for one search, without which the distance may be less.
        assert_eq!(ball(0.5, ITERATIONS as u64 - 1).wrong_distance(exact), None);
        // A point of the surface suffices.
        assert!(ball(2.0, ITERATIONS as u64 - 1).wrong_distance(exact).is_some());
        assert_eq!(ball(1.0, 100_000).wrong_distance(exact), None);
    }
}
