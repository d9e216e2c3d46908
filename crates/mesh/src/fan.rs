//! Proves that no wall thinner than a limit begins in a box.

use sdfc_graph::eval::Evaluator;

use crate::field::{Frame, LocalField, Prism, Prober, ROUNDING};
use crate::normals::{Sloped, spread};
use crate::vector::{Vec3, add, between, dot, length, scale, sub, unit};

/// The surface at the other end of a wall is turned by at least this angle. A smaller limit would
/// count the two faces at a sharp edge as a wall of thickness 0: at this one, edges sharper than
/// 40 degrees have none. Edges of 45, 60 and 90 degrees are common, and keep a distance from it.
pub(crate) const LEAST_TURN: f64 = 140.0 / 180.0 * std::f64::consts::PI;
/// Most pieces that are examined for a box.
const MOST_PIECES: u64 = 200;
/// Pieces are not divided below this part of the box.
const FINEST: f64 = 0.25;
/// Distances of planes from the middle that are tried, as parts of the box.
const THICKNESSES: [f64; 3] = [1e-4, 2e-3, 0.05];
/// The field is nearly linear in a box if the surface lies in this part of it.
const FLAT: f64 = 0.01;
/// A gradient at least this far from the axis is bounded about another axis.
const FAR_TURN: f64 = 0.8;
/// Angles are compared with this margin for rounding.
const MARGIN: f64 = 1e-9;

/// The field around a box, with its registers.
pub(crate) struct Surroundings<'f> {
    pub(crate) prober: Prober<'f>,
    slope: Evaluator<'f, Sloped>,
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

/// The region that walls from a box may cross: they begin between two heights over the frame's
/// center, and end below, in directions around the frame's normal.
struct Fan {
    frame: Frame,
    heights: [f64; 2],
    /// The greatest angle between the frame's normal and that of the surface in the box.
    angle: f64,
}

/// A part of a fan: its range along each direction of the frame.
type Piece = [[f64; 2]; 3];

impl<'f> Surroundings<'f> {
    pub(crate) fn new(field: &'f LocalField<'_>) -> Self {
        Self { prober: field.prober(), slope: field.prepare(), cells: 0 }
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
        let axis = self.axis(bounds)?;
        let angle = spread(&mut self.slope, bounds, axis).atan();
        if 2.0 * angle + MARGIN >= LEAST_TURN {
            return None;
        }
        let frame = Frame::around(bounds, axis);
        let heights = self.heights(&frame);
        Some(Fan { frame, heights, angle })
    }

    /// Returns a direction near all gradients in a box, as samples tell: the center of a small ball
    /// around them (M. Bădoiu and K. Clarkson, Smaller core-sets for balls, 2003).
    fn axis(&mut self, [lo, hi]: [Vec3; 2]) -> Option<Vec3> {
        let mut normals = Vec::new();
        for corner in 0..8 {
            let point = std::array::from_fn(|axis| {
                let is_upper = corner >> axis & 1 == 1;
                if is_upper { hi[axis] } else { lo[axis] }
            });
            normals.extend(unit(self.prober.sample(point).1));
        }
        normals.extend(unit(self.prober.sample(between(lo, hi, 0.5)).1));
        let mut center = unit(normals.iter().fold([0.0; 3], |sum, normal| add(sum, *normal)))?;
        for round in 1..=8 {
            let cosine = |normal: &&Vec3| dot(**normal, center);
            let least = normals.iter().min_by(|a, b| cosine(a).total_cmp(&cosine(b)))?;
            if dot(*least, center) > 0.999 {
                break;
            }
            center = unit(between(center, *least, 1.0 / f64::from(round + 1)))?;
        }
        Some(center)
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
            let axis = longest(&piece);
            let [from, to] = piece[axis];
            if examined >= MOST_PIECES || to - from <= FINEST * side {
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
        let normal = fan.frame.normal;
        let Some(sample) = unit(self.prober.sample(prism.center).1) else { return false };
        let turn = angle_between(sample, normal);
        if fan.angle + turn >= LEAST_TURN {
            return false;
        }
        let axis = match turn > FAR_TURN {
            true => unit(add(sample, normal)),
            false => Some(normal),
        };
        let Some(axis) = axis else { return false };
        let turn = angle_between(axis, normal);
        let rest = spread(&mut self.slope, around(prism), axis).atan();
        rest < std::f64::consts::FRAC_PI_2 && fan.angle + turn + rest + MARGIN < LEAST_TURN
    }
}

impl Fan {
    /// Returns the whole fan to a depth.
    fn whole(&self, depth: f64) -> Piece {
        let [lo, hi] = self.heights;
        let beside = depth * self.angle.sin() * (1.0 + MARGIN);
        let [_, u, v] = self.frame.half.map(|half| half + beside);
        [[lo - depth, hi], [-u, u], [-v, v]]
    }

    /// Returns how far a piece is from the box, beside it.
    fn aside(&self, piece: &Piece) -> [f64; 2] {
        let [_, u, v] = self.frame.half;
        [(piece[1], u), (piece[2], v)]
            .map(|([from, to], half)| (from - half).max(-half - to).max(0.0))
    }

    /// Returns the least distance between the surface in the box and a piece.
    fn distance(&self, piece: &Piece) -> f64 {
        let [u, v] = self.aside(piece);
        let below = (self.heights[0] - piece[0][1]).max(0.0);
        length([below, u, v]) * (1.0 - 1e-12)
    }

    /// False if it is proven that no direction of the fan leads to a piece.
    fn may_contain(&self, piece: &Piece) -> bool {
        let [u, v] = self.aside(piece);
        let below = self.heights[1] - piece[0][0];
        let [_, by_u, by_v] = self.frame.half;
        u.hypot(v) <= (self.angle.tan() + MARGIN) * below + MARGIN * (by_u + by_v)
    }

    /// Returns a piece that contains the middle of each segment from the box to a piece.
    fn midway(&self, piece: &Piece) -> Piece {
        let [_, u, v] = self.frame.half;
        let begins = [self.heights, [-u, u], [-v, v]];
        [0, 1, 2].map(|axis| [0, 1].map(|end| 0.5 * (begins[axis][end] + piece[axis][end])))
    }

    fn prism(&self, piece: &Piece) -> Prism {
        let Frame { center, normal, tangents: [u, v], .. } = self.frame;
        let directions = [normal, u, v];
        let mut prism = Prism { center, axes: [[0.0; 3]; 3] };
        for (axis, direction) in directions.into_iter().enumerate() {
            let [from, to] = piece[axis];
            prism.center = add(prism.center, scale(direction, 0.5 * (from + to)));
            prism.axes[axis] = scale(direction, 0.5 * (to - from) * (1.0 + 1e-12));
        }
        prism
    }
}

/// Returns the direction along which a piece is divided. Along the depth it is divided first,
/// because fields have kinks in the middle of walls.
fn longest(piece: &Piece) -> usize {
    let [depth, u, v] = piece.map(|[from, to]| to - from);
    match () {
        () if 2.0 * depth >= u.max(v) => 0,
        () if u >= v => 1,
        () => 2,
    }
}

/// Returns the angle between unit vectors (W. Kahan's formula, which is exact for small angles).
pub(crate) fn angle_between(a: Vec3, b: Vec3) -> f64 {
    2.0 * length(sub(a, b)).atan2(length(add(a, b)))
}

/// Returns the box around a prism.
fn around(prism: &Prism) -> [Vec3; 2] {
    let half = [0, 1, 2].map(|i| prism.axes.iter().map(|axis| axis[i].abs()).sum::<f64>());
    let half = [0, 1, 2].map(|i| half[i] * (1.0 + 1e-12) + 1e-15 * prism.center[i].abs());
    [sub(prism.center, half), add(prism.center, half)]
}
