//! One shape's field with the means to ask it.

use sdfc_graph::eval::{Dual, Evaluator, FrameValues, Tape, evaluate_frame};
use sdfc_graph::{Dim, Expander, Graph, NodeId, ShapeId};

use crate::certify::quality::Promise;
use crate::refute::frames::axes;

/// Pairs for a constant, points for bounds and promises, points of the surface.
const PAIRS: usize = 1500;
const POINTS: usize = 400;
const SURFACE: usize = 200;
/// Halvings of a way between two signs; rounds of the search for the nearest point of a surface.
const HALVINGS: usize = 50;
const ROUNDS: usize = 300;
/// How far a shape is looked at where nothing bounds it.
const REACH: f64 = 2.0;
/// Relative slack of constants and distances. A promise that fails by less is not told.
const SLACK: f64 = 1e-6;
const INEXACT: f64 = 1e-3;

type Point = [f64; 3];

pub(super) struct Probe {
    tape: Tape,
    frame: FrameValues,
    axes: usize,
    /// Stated or derived bounds: as they are, and cut where they are infinite.
    bounds: [Point; 2],
    region: [Point; 2],
    /// Longest edge of the region.
    scale: f64,
    random: Random,
}

impl Probe {
    /// `None` where the field does not expand, or the bounds hold nothing.
    pub(super) fn new(
        graph: &mut Graph,
        shape: ShapeId,
        corners: [NodeId; 2],
        frame: &FrameValues,
    ) -> Option<Self> {
        let dim = graph.shape(shape).dim;
        let values = evaluate_frame(graph, &corners, frame);
        let corner = |lanes: &[f64; 4]| [lanes[0], lanes[1], lanes[2]];
        let bounds = [corner(values.first()?), corner(values.get(1)?)];
        let point = graph.point(0, Dim::Three);
        let point = match dim {
            Dim::Two => graph.swizzle(point, &[0, 1]),
            Dim::Three => point,
        };
        let field = Expander::new().field(graph, shape, point).ok()?;
        let tape = Tape::new(graph, &[field]).ok()?;
        let mut region = [[0.0; 3]; 2];
        let mut scale = 0.0f64;
        for axis in 0..axes(dim) {
            let [lo, hi] = [bounds[0][axis], bounds[1][axis]];
            let (lo, hi) = match (lo.is_finite(), hi.is_finite()) {
                (true, true) => (lo, hi),
                (true, false) => (lo, lo + 2.0 * REACH),
                (false, true) => (hi - 2.0 * REACH, hi),
                (false, false) => (-REACH, REACH),
            };
            if lo > hi {
                return None;
            }
            (region[0][axis], region[1][axis]) = (lo, hi);
            scale = scale.max(hi - lo);
        }
        let (axes, frame, random) = (axes(dim), frame.clone(), Random(7));
        (scale > 0.0).then_some(Self { tape, frame, axes, bounds, region, scale, random })
    }

    fn field(&self) -> Evaluator<'_, f64> {
        self.tape.prepare(&self.frame)
    }

    pub(super) fn at(&self, p: Point) -> f64 {
        self.field().scalar(p)
    }

    /// A point without the coordinates that the shape does not have.
    pub(super) fn lanes(&self, p: Point) -> Vec<f64> {
        p[..self.axes].to_vec()
    }

    /// A point of the region grown by a share of its size.
    fn point(&mut self, grown: f64) -> Point {
        let mut point = [0.0; 3];
        for (axis, place) in point.iter_mut().enumerate().take(self.axes) {
            let (lo, hi) = (self.region[0][axis], self.region[1][axis]);
            let margin = grown * self.scale;
            *place = lo - margin + (hi - lo + 2.0 * margin) * self.random.next();
        }
        point
    }

    /// A point of the shape that lies outside its bounds.
    pub(super) fn beyond_bounds(&mut self) -> Option<(Vec<f64>, f64)> {
        let slack = SLACK * self.scale;
        (0..PAIRS).find_map(|round| {
            let p = self.point([0.02, 0.2, 1.0][round % 3]);
            let beyond = |axis: usize| {
                p[axis] < self.bounds[0][axis] - slack || p[axis] > self.bounds[1][axis] + slack
            };
            let field = self.at(p);
            (field < -slack && (0..self.axes).any(beyond)).then(|| (self.lanes(p), field))
        })
    }

    /// Two points of the region between which the field changes by more than `constant` times the way.
    pub(super) fn steeper(&mut self, constant: f64) -> Option<(Point, Point, f64)> {
        let pairs: Vec<[Point; 2]> =
            (0..PAIRS).map(|_| [self.point(0.0), self.point(0.0)]).collect();
        let mut field = self.field();
        let mut slopes = self.tape.prepare::<Dual>(&self.frame);
        pairs.into_iter().enumerate().find_map(|(round, [p, other])| {
            let share = [1.0, 1e-2, 1e-4][round % 3];
            let uphill = slopes.scalar(Dual::point(p)).partials;
            let step = 1e-5 * self.scale / distance(uphill, [0.0; 3]).max(1e-30);
            let near = self.within([0, 1, 2].map(|axis| p[axis] + step * uphill[axis]));
            [mix(p, other, share), near].into_iter().find_map(|q| {
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

    /// A point at which the field is not what is promised outside and inside; the field and the distance there.
    pub(super) fn no_distance(&mut self, promised: [Promise; 2]) -> Option<(Vec<f64>, f64, f64)> {
        let surface = self.surface();
        if surface.is_empty() {
            return None;
        }
        for round in 0..POINTS {
            let p = self.point([0.0, 0.5][round % 2]);
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
                let way = self.nearest(p, nearest);
                let slack = INEXACT * way + SLACK * self.scale;
                let under = promise == Promise::Exact && size < way - slack;
                if size > way + slack || under {
                    return Some((self.lanes(p), field, way));
                }
            }
        }
        None
    }

    /// Whether the point that an exact distance and its gradient name lies on the surface.
    fn has_foot(&self, p: Point, field: f64) -> bool {
        let slope = self.tape.prepare::<Dual>(&self.frame).scalar(Dual::point(p)).partials;
        let foot = [0, 1, 2].map(|axis| p[axis] - field * slope[axis]);
        self.at(foot).abs() <= INEXACT * field.abs() + SLACK * self.scale
    }

    /// Points between points of opposite sign.
    fn surface(&mut self) -> Vec<Point> {
        let points: Vec<Point> = (0..4 * SURFACE).map(|i| self.point([0.0, 0.1][i % 2])).collect();
        let mut field = self.tape.prepare::<f64>(&self.frame);
        let (inside, outside): (Vec<_>, Vec<_>) =
            points.into_iter().partition(|&p| field.scalar(p) < 0.0);
        if inside.is_empty() || outside.is_empty() {
            return Vec::new();
        }
        let mut random = Random(11);
        (0..SURFACE)
            .map(|i| {
                let from = inside[i % inside.len()];
                let to = outside[(random.next() * outside.len() as f64) as usize % outside.len()];
                crossing(&mut field, from, to)
            })
            .collect()
    }

    /// The way to the nearest point of the surface, by a search around a first one.
    fn nearest(&mut self, p: Point, first: Point) -> f64 {
        let mut field = self.tape.prepare::<f64>(&self.frame);
        let sign = field.scalar(p) < 0.0;
        let mut best = first;
        for round in 0..ROUNDS {
            let way = distance(p, best);
            // Wide at first, then narrow.
            let spread = 0.5f64.powf(12.0 * round as f64 / ROUNDS as f64);
            let mut aim = best;
            for place in aim.iter_mut().take(self.axes) {
                *place += way * spread * (2.0 * self.random.next() - 1.0);
            }
            let length = distance(p, aim).max(1e-30);
            let aim = mix(p, aim, way * (1.0 - 1e-6) / length);
            if (field.scalar(aim) < 0.0) != sign {
                best = crossing(&mut field, p, aim);
            }
        }
        distance(p, best)
    }
}

/// Where the sign changes between two points that differ in it.
fn crossing(field: &mut Evaluator<'_, f64>, mut from: Point, mut to: Point) -> Point {
    let sign = field.scalar(from) < 0.0;
    for _ in 0..HALVINGS {
        let middle = mix(from, to, 0.5);
        let end = if (field.scalar(middle) < 0.0) == sign { &mut from } else { &mut to };
        *end = middle;
    }
    from
}

fn mix(a: Point, b: Point, t: f64) -> Point {
    [0, 1, 2].map(|axis| a[axis] + (b[axis] - a[axis]) * t)
}

fn distance(a: Point, b: Point) -> f64 {
    [0, 1, 2].map(|axis| (a[axis] - b[axis]).powi(2)).iter().sum::<f64>().sqrt()
}

/// SplitMix64: the same numbers on every machine.
pub(super) struct Random(pub(super) u64);

impl Random {
    /// One of the first so many whole numbers.
    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    /// In 0..1.
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
