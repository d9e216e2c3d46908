//! Samples of a field, taken once, to check all claims with.

use crate::field::Field;
use crate::geometry::{Point, Random, add, distance, length, mix, sub};

/// Number of points that are compared with the surface, and of points and pairs that are compared
/// with a constant.
const POINTS: usize = 240;
const SLOPES: usize = 1200;
const PAIRS: usize = 900;
/// Number of points from which a steeper slope is searched, and number of steps.
const CLIMBS: usize = 6;
const STEPS: usize = 60;

/// A point, the field's value there and the distance to the surface.
pub struct Sample {
    pub p: Point,
    pub f: f64,
    /// An upper bound of the distance to the surface; infinite if none was found.
    pub nearest: f64,
    /// True if the point lies within the bounds.
    pub within: bool,
}

/// The steepest slope between two points.
#[derive(Clone, Copy, Debug)]
pub struct Steepest {
    pub slope: f64,
    pub p: Point,
    pub q: Point,
}

pub struct Samples {
    pub points: Vec<Sample>,
    /// Steepest pair of points within the bounds.
    pub steepest: Steepest,
    /// Points of the surface and of the inside, including the outermost along each axis.
    pub reached: Vec<Point>,
    /// True if the sign changes anywhere.
    pub has_surface: bool,
    /// Longest edge of the window, in scene units.
    pub scale: f64,
    pub axes: usize,
}

impl Samples {
    /// # Errors
    ///
    /// The field is NaN or infinite somewhere.
    pub fn of(field: &Field) -> Result<Self, String> {
        let mut random = Random(7);
        let (scale, axes) = (field.scale(), field.axes);
        let surface = field.evaluator().surface(&mut random);
        let points = points(field, &surface, &mut random)?;
        let steepest = steepest(field, &mut random)?;
        let mut reached = extremes(field, &surface);
        reached.extend(points.iter().filter(|sample| sample.f < 0.0).map(|sample| sample.p));
        let has_surface = !surface.is_empty();
        reached.extend(surface);
        Ok(Self { points, steepest, reached, has_surface, scale, axes })
    }
}

fn points(field: &Field, surface: &[Point], random: &mut Random) -> Result<Vec<Sample>, String> {
    let mut evaluator = field.evaluator();
    let [lo, hi] = field.bounds;
    let reach = 0.5 * field.scale();
    let sample = |round: usize| {
        let p = evaluator.point(random, [0.0, reach][round % 2]);
        let f = evaluator.at(p);
        if !f.is_finite() {
            return Err(format!("the field is {f} at {p:?}"));
        }
        let within = (0..field.axes).all(|axis| lo[axis] <= p[axis] && p[axis] <= hi[axis]);
        Ok(Sample { p, f, nearest: evaluator.nearest(p, surface, random), within })
    };
    (0..POINTS).map(sample).collect()
}

/// Returns the steepest of random pairs, of slopes at random points, and of slopes found by
/// climbing.
fn steepest(field: &Field, random: &mut Random) -> Result<Steepest, String> {
    let mut evaluator = field.evaluator();
    let mut slopes: Vec<Steepest> = Vec::new();
    for _ in 0..SLOPES {
        let p = evaluator.point(random, 0.0);
        // At a kink or a centre there is no slope, and none is claimed.
        let slope = length(evaluator.slope(p));
        if slope.is_finite() {
            slopes.push(Steepest { slope, p, q: p });
        }
    }
    slopes.sort_by(|a, b| b.slope.total_cmp(&a.slope));
    slopes.truncate(CLIMBS);
    let [lo, hi] = field.window();
    for start in &mut slopes {
        let mut reach = 0.25;
        for _ in 0..STEPS {
            let move_to = [0, 1, 2].map(|axis| {
                let offset = reach * (hi[axis] - lo[axis]) * random.signed();
                (start.p[axis] + offset).clamp(lo[axis], hi[axis])
            });
            let slope = length(evaluator.slope(move_to));
            if slope.is_finite() && slope > start.slope {
                *start = Steepest { slope, p: move_to, q: move_to };
            } else {
                reach *= 0.9;
            }
        }
    }
    for round in 0..PAIRS {
        let p = evaluator.point(random, 0.0);
        // Near pairs find steep slopes, far pairs find jumps.
        let q = mix(p, evaluator.point(random, 0.0), [1.0, 1e-2, 1e-4][round % 3]);
        let run = distance(p, q);
        let rise = (evaluator.at(p) - evaluator.at(q)).abs();
        if !rise.is_finite() {
            return Err(format!("the field is not finite at {p:?} or {q:?}"));
        }
        // A change within rounding does not count.
        if run > 1e-7 * field.scale() {
            slopes.push(Steepest { slope: (rise - 1e-12 * field.scale()) / run, p, q });
        }
    }
    let none = Steepest { slope: 0.0, p: [0.0; 3], q: [0.0; 3] };
    Ok(slopes.into_iter().max_by(|a, b| a.slope.total_cmp(&b.slope)).unwrap_or(none))
}

/// Returns the outermost points along each axis that moving along the surface finds.
fn extremes(field: &Field, surface: &[Point]) -> Vec<Point> {
    let mut evaluator = field.evaluator();
    let far = 1e3 * field.scale();
    let mut found = Vec::new();
    for axis in 0..field.axes {
        for sign in [1.0, -1.0] {
            let mut outermost: Vec<Point> = surface.to_vec();
            outermost.sort_by(|a, b| (sign * b[axis]).total_cmp(&(sign * a[axis])));
            for start in outermost.into_iter().take(3) {
                let mut way = [0.0; 3];
                way[axis] = sign * far;
                found.push(evaluator.towards(add(start, way), start));
            }
        }
    }
    found.retain(|p| sub(*p, [0.0; 3]).iter().all(|lane| lane.is_finite()));
    found
}
