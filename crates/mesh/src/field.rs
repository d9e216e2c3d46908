//! The field of a scene, in the number types that meshing needs.

use std::sync::Arc;

use rayon::prelude::*;
use sdfc_graph::Program;
use sdfc_graph::eval::{
    Affine, BranchPath, Dual, Evaluator, FrameValues, Interval, Number, Tape, TapeError,
};

use crate::plane::Plane;
use crate::vector::{Vec3, add, between, dot, length, scale, sub, tangents};

/// A box that may be rotated: its center and its half axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prism {
    pub(crate) center: Vec3,
    pub(crate) axes: [Vec3; 3],
}

impl Prism {
    /// Returns the box with edges along the axes of coordinates.
    pub(crate) fn aligned([lo, hi]: [Vec3; 2]) -> Self {
        let center = between(lo, hi, 0.5);
        let mut axes = [[0.0; 3]; 3];
        for axis in 0..3 {
            // Rounded up, so that the box covers both corners.
            let half = (hi[axis] - center[axis]).max(center[axis] - lo[axis]);
            axes[axis][axis] = half.next_up();
        }
        Self { center, axes }
    }

    /// Returns the coordinates of the box's points.
    fn coordinates(&self) -> [Affine; 3] {
        let [a, b, c] = self.axes;
        [0, 1, 2].map(|i| Affine::coordinate(self.center[i], [a[i], b[i], c[i]]))
    }
}

/// A frame of three orthogonal directions, and how far a box reaches along them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) center: Vec3,
    pub(crate) normal: Vec3,
    pub(crate) tangents: [Vec3; 2],
    /// Half the extent of the box along the normal and the tangents.
    pub(crate) half: [f64; 3],
}

impl Frame {
    /// Returns the frame of a unit normal around a box.
    pub(crate) fn around([lo, hi]: [Vec3; 2], normal: Vec3) -> Self {
        let center = between(lo, hi, 0.5);
        let half = scale(sub(hi, lo), 0.5);
        let reach = |a: Vec3| dot(a.map(f64::abs), half) * (1.0 + 1e-12);
        let [u, v] = tangents(normal);
        Self { center, normal, tangents: [u, v], half: [reach(normal), reach(u), reach(v)] }
    }

    /// Returns the part of the frame between two heights over its center, as wide as the box.
    pub(crate) fn part(&self, from: f64, to: f64) -> Prism {
        let [u, v] = self.tangents;
        let [_, by_u, by_v] = self.half;
        let center = add(self.center, scale(self.normal, 0.5 * (from + to)));
        let height = 0.5 * (to - from) * (1.0 + 1e-12);
        Prism { center, axes: [scale(self.normal, height), scale(u, by_u), scale(v, by_v)] }
    }

    /// Returns the height and the two other coordinates of a point.
    pub(crate) fn coordinates(&self, point: Vec3) -> Vec3 {
        let offset = sub(point, self.center);
        let [u, v] = self.tangents;
        [dot(offset, self.normal), dot(offset, u), dot(offset, v)]
    }
}

/// Each linear channel of surfaces without a material.
const DEFAULT_COLOR: f32 = 0.8;

/// The field, as tapes.
#[derive(Clone, Debug)]
pub(crate) struct Field {
    distance: Tape,
    /// The fields of `MaterialField::ALL`, if the scene has materials.
    material: Option<Tape>,
}

impl Field {
    /// Prepares a program; `None` if it draws nothing.
    pub(crate) fn new(program: &Program) -> Result<Option<Self>, TapeError> {
        let Some(distance) = program.distance else { return Ok(None) };
        let tape = |roots: &[_]| Tape::new(&program.graph, roots);
        let material = program.material.map(|fields| tape(&fields)).transpose()?;
        Ok(Some(Self { distance: tape(&[distance])?, material }))
    }

    /// Returns the linear colour at each point; nothing if the scene has no materials.
    pub(crate) fn colors(&self, frame: &FrameValues, points: &[Vec3]) -> Vec<[f32; 3]> {
        let Some(material) = &self.material else { return Vec::new() };
        let color = |field: &mut Evaluator<'_, f64>, point: &Vec3| {
            let &[color, coverage, ..] = field.eval(*point) else { return [DEFAULT_COLOR; 3] };
            let mixed = |channel: f64| (channel as f32 - DEFAULT_COLOR) * coverage[0] as f32;
            [color[0], color[1], color[2]].map(|channel| {
                let value = DEFAULT_COLOR + mixed(channel);
                if value.is_finite() { value.max(0.0) } else { DEFAULT_COLOR }
            })
        };
        points.par_iter().map_init(|| material.prepare(frame), color).collect()
    }

    /// Returns the tape of the distance.
    pub(crate) fn distance(&self) -> &Tape {
        &self.distance
    }
}

/// A tape with fewer operations is not specialised to boxes.
const FEW_OPERATIONS: usize = 16;
/// A specialised tape is used if it has at most this fraction of the operations.
const SHORTER: f64 = 0.75;
/// The same for a tape with loops, whose conditions leave out most iterations over a small box.
const SHORTER_THAN_LOOPS: f64 = 0.25;
/// A box is this many times smaller than the one that the tape in use was made for before the tape
/// is specialised again.
const ZOOM: f64 = 3.0;

/// The field around a box.
#[derive(Clone, Debug)]
pub(crate) struct LocalField<'f> {
    /// The field everywhere.
    whole: &'f Tape,
    frame: &'f FrameValues,
    /// The field around the box, if that is much shorter.
    short: Option<Arc<Tape>>,
    /// The side of the last box that it was specialised to.
    side: f64,
    /// The plane that points and boxes lie in. Without one they lie in space.
    plane: Option<Plane>,
    /// The value at the surface.
    level: f64,
}

impl<'f> LocalField<'f> {
    /// Returns the field everywhere.
    pub(crate) fn new(whole: &'f Tape, frame: &'f FrameValues) -> Self {
        Self { whole, frame, short: None, side: f64::INFINITY, plane: None, level: 0.0 }
    }

    /// Returns the field in a plane, as a function of the plane's two coordinates.
    pub(crate) fn in_plane(self, plane: Plane) -> Self {
        Self { plane: Some(plane), ..self }
    }

    /// Returns the field whose surface is at a value other than 0.
    pub(crate) fn at_level(self, level: f64) -> Self {
        Self { level, ..self }
    }

    /// Returns the same field, which is not specialised further.
    #[cfg(test)]
    pub(crate) fn fixed(self) -> Self {
        Self { side: 0.0, ..self }
    }

    fn tape(&self) -> &Tape {
        self.short.as_deref().unwrap_or(self.whole)
    }

    /// Returns the field in a cube that is grown by a margin.
    pub(crate) fn around(self, [lo, hi]: [Vec3; 2], margin: f64) -> Self {
        let side = hi[0] - lo[0];
        let operations = self.tape().operations();
        let has_few = operations < FEW_OPERATIONS;
        if has_few || side * ZOOM > self.side {
            return self;
        }
        let grown = [lo.map(|x| x - margin), hi.map(|x| x + margin)];
        let coordinates = placed(self.plane, Prism::aligned(grown).coordinates());
        let most = if self.tape().has_loops() { SHORTER_THAN_LOOPS } else { SHORTER };
        let is_short = |tape: &Tape| tape.operations() as f64 <= most * operations as f64;
        let found = self.tape().specialized(self.frame, coordinates).filter(is_short);
        Self { short: found.map(Arc::new).or(self.short), side, ..self }
    }

    /// Returns the side of a box as [`Prober::nearly_side_over`], by tighter bounds that take
    /// longer: those of the formula that is left in the box.
    pub(crate) fn nearly_side_over(&self, prism: &Prism, part: f64) -> Option<bool> {
        let coordinates = placed(self.plane, prism.coordinates());
        let range = self.tape().over(self.frame, coordinates).value.range();
        proven(shrunk(range, part), self.level)
    }

    /// Returns the field's evaluator in a number type.
    pub(crate) fn prepare<N: Number>(&self) -> Evaluator<'_, N> {
        self.tape().prepare(self.frame)
    }

    /// Returns the field with registers.
    pub(crate) fn prober(&self) -> Prober<'_> {
        let tape = self.tape();
        Prober {
            value: tape.prepare(self.frame),
            slope: tape.prepare(self.frame),
            interval: tape.prepare(self.frame),
            affine: tape.prepare(self.frame),
            path: BranchPath::default(),
            plane: self.plane,
            level: self.level,
        }
    }
}

/// The part of a field's variation in a box that is rounding. Where flat faces touch within a
/// solid, the field is 0 and nowhere positive, but its bounds exceed 0 by rounding.
pub(crate) const ROUNDING: f64 = 1e-9;

/// Returns the position in space of a point of a plane; the point itself without a plane.
fn placed<N: Number>(plane: Option<Plane>, point: [N; 3]) -> [N; 3] {
    plane.map_or(point, |plane| plane.position(point))
}

/// A field with the registers of its evaluators. Each thread uses its own clone.
#[derive(Clone, Debug)]
pub(crate) struct Prober<'f> {
    value: Evaluator<'f, f64>,
    slope: Evaluator<'f, Dual>,
    interval: Evaluator<'f, Interval>,
    affine: Evaluator<'f, Affine>,
    path: BranchPath,
    plane: Option<Plane>,
    level: f64,
}

/// Returns true if a point with this value is inside. A point without a value counts as outside.
pub(crate) fn is_inside(value: f64) -> bool {
    value < 0.0
}

impl Prober<'_> {
    pub(crate) fn value(&mut self, point: Vec3) -> f64 {
        self.value.scalar(placed(self.plane, point)) - self.level
    }

    /// Returns the value and the gradient.
    pub(crate) fn sample(&mut self, point: Vec3) -> (f64, Vec3) {
        let Dual { value, partials } = self.slope.scalar(placed(self.plane, Dual::point(point)));
        (value - self.level, partials)
    }

    /// Estimates the distance to the surface: the value divided by the gradient's length.
    pub(crate) fn distance(&mut self, point: Vec3) -> f64 {
        let (value, gradient) = self.sample(point);
        let distance = value.abs() / length(gradient);
        if distance.is_finite() { distance } else { value.abs() }
    }

    /// Returns the side of a point, if it is proven in spite of rounding: true for inside.
    pub(crate) fn proven_side(&mut self, point: Vec3) -> Option<bool> {
        let point = placed(self.plane, point.map(Interval::constant));
        proven(self.interval.scalar(point), self.level)
    }

    /// Returns the side of a whole box, if it is proven that all of it is on one side. Where the
    /// formula jumps, as at the borders of repeated cells, it is proven for each result.
    pub(crate) fn side_over(&mut self, prism: &Prism) -> Option<bool> {
        self.nearly_side_over(prism, 0.0)
    }

    /// Returns the side of a whole box, if it is proven that the field crosses 0 nowhere by more
    /// than a part of its variation in the box.
    pub(crate) fn nearly_side_over(&mut self, prism: &Prism, part: f64) -> Option<bool> {
        let box_ = placed(self.plane, prism.coordinates());
        self.path.clear();
        let mut side = None;
        for _ in 0..MOST_PATHS {
            let range = self.affine.scalar_along(box_, &mut self.path).range();
            match proven(shrunk(range, part), self.level) {
                Some(found) if side.is_some_and(|side| side != found) => return None,
                Some(found) => side = Some(found),
                None if self.path.fork(MOST_JUMPS) => continue,
                None => return None,
            }
            if !self.path.advance() {
                return side;
            }
        }
        None
    }

    /// Returns the bounds of the field over a box.
    pub(crate) fn affine_over(&mut self, prism: &Prism) -> Affine {
        self.affine.scalar(placed(self.plane, prism.coordinates()))
    }

    /// True if it is proven that no value in a box is farther from that at the surface than a
    /// limit.
    pub(crate) fn is_within(&mut self, prism: &Prism, limit: f64) -> bool {
        let range = self.affine_over(prism).range();
        range.lo() >= self.level - limit && range.hi() <= self.level + limit
    }

    /// True if it is proven that the surface in a frame lies between two heights, with the inside
    /// below. The frame is extended along its normal by `beyond` in both directions.
    pub(crate) fn is_between(&mut self, frame: &Frame, beyond: f64, lo: f64, hi: f64) -> bool {
        let end = frame.half[0] + beyond;
        let is_outside = hi >= end || self.side_over(&frame.part(hi.max(-end), end)) == Some(false);
        is_outside && (lo <= -end || self.side_over(&frame.part(-end, lo.min(end))) == Some(true))
    }

    /// Finds where the sign changes between two points on different sides, to `tolerance`.
    pub(crate) fn root(&mut self, ends: [Vec3; 2], values: [f64; 2], tolerance: f64) -> f64 {
        let [a, b] = ends;
        let [mut from, mut to] = [0.0, 1.0];
        let [mut low, mut high] = values;
        let side = is_inside(low);
        let span = length(sub(b, a));
        for round in 0..MOST_STEPS {
            if (to - from) * span <= tolerance {
                break;
            }
            let slope = low / (low - high);
            // Every third step halves, so that a jump or a flat field cannot stall the search.
            let part = if round % 3 == 2 || !slope.is_finite() { 0.5 } else { slope };
            let part = part.clamp(0.01, 0.99);
            let t = from + part * (to - from);
            let value = self.value(between(a, b, t));
            // So near by the slope of the bracket that no further step is worth it.
            let rest = value * (to - from) / (high - low) * span;
            if value == 0.0 || rest.abs() <= 0.1 * tolerance {
                return t;
            }
            if is_inside(value) == side {
                (from, low) = (t, value);
            } else {
                (to, high) = (t, value);
            }
        }
        let t = low / (low - high);
        from + if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.5 } * (to - from)
    }
}

/// Steps of a search for a root.
const MOST_STEPS: u32 = 60;
/// Evaluations of a box with different results of jumps.
const MOST_PATHS: u32 = 16;
/// Jumps in a formula over a box that are decided.
const MOST_JUMPS: usize = 3;

/// The range without a part of its width at both ends.
fn shrunk(range: Interval, part: f64) -> Interval {
    let part = part * (range.hi() - range.lo());
    if part > 0.0 { Interval::new(range.lo() + part, range.hi() - part) } else { range }
}

fn proven(range: Interval, level: f64) -> Option<bool> {
    if range.lo() > level {
        Some(false)
    } else if range.hi() < level {
        Some(true)
    } else {
        None
    }
}
