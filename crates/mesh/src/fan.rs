//! The region that walls from a box may cross.

use std::f64::consts::PI;

use crate::field::{Frame, Prism};
use crate::vector::{Vec3, add, between, cross, dot, length, scale, sub, unit};

/// The surface at the other end of a wall is turned by at least this angle. A smaller limit would
/// count the two faces at a sharp edge as a wall of thickness 0: at this one, edges sharper than
/// 40 degrees have none. Edges of 45, 60 and 90 degrees are common, and keep a distance from it.
pub(crate) const LEAST_TURN: f64 = 140.0 / 180.0 * PI;
/// Angles are compared with this margin for rounding.
pub(crate) const MARGIN: f64 = 1e-9;

/// The region that walls from a box may cross: they begin between two heights over the frame's
/// center, and end below, in directions around the frame's normal.
pub(crate) struct Fan {
    pub(crate) bounds: [Vec3; 2],
    /// Normals at points of the box.
    pub(crate) normals: Vec<Vec3>,
    pub(crate) frame: Frame,
    pub(crate) heights: [f64; 2],
    /// The axis of all normals in the box.
    pub(crate) axis: Vec3,
    /// The greatest angle between the axis and a normal in the box.
    pub(crate) angle: f64,
}

/// A part of a fan: its range along each direction of the frame.
pub(crate) type Piece = [[f64; 2]; 3];

impl Fan {
    /// Returns the range of the box's surface along each direction of the frame.
    fn begins(&self) -> Piece {
        let [_, u, v] = self.frame.half;
        [self.heights, [-u, u], [-v, v]]
    }

    /// Returns the directions of the frame.
    fn directions(&self) -> [Vec3; 3] {
        let Frame { normal, tangents: [u, v], .. } = self.frame;
        [normal, u, v]
    }

    /// Returns the whole fan to a depth.
    pub(crate) fn whole(&self, depth: f64) -> Piece {
        let begins = self.begins();
        let directions = self.directions();
        std::array::from_fn(|axis| {
            // Directions in the cone around the axis have cosines between these.
            let turn = angle_between(directions[axis], self.axis);
            let most = (turn - self.angle - MARGIN).max(0.0).cos();
            let least = (turn + self.angle + MARGIN).min(PI).cos();
            let [lo, hi] = begins[axis];
            [lo - depth * most.max(0.0), hi - depth * least.min(0.0)]
        })
    }

    /// Returns the least distance between the surface in the box and a piece.
    pub(crate) fn distance(&self, piece: &Piece) -> f64 {
        let begins = self.begins();
        let gaps = std::array::from_fn(|axis| {
            let ([lo, hi], [from, to]) = (begins[axis], piece[axis]);
            (from - hi).max(lo - to).max(0.0)
        });
        length(gaps) * (1.0 - 1e-12)
    }

    /// False if it is proven that no direction of the fan leads to a piece.
    pub(crate) fn may_contain(&self, piece: &Piece) -> bool {
        let begins = self.begins();
        let directions = self.directions();
        // Segments to the box are these, with an error of at most `reach`.
        let (mut segment, mut reach) = ([0.0; 3], [0.0; 3]);
        for (axis, direction) in directions.into_iter().enumerate() {
            let ([lo, hi], [from, to]) = (begins[axis], piece[axis]);
            segment = add(segment, scale(direction, 0.5 * (lo + hi) - 0.5 * (from + to)));
            reach[axis] = 0.5 * (hi - lo) + 0.5 * (to - from);
        }
        let along = dot(segment, self.axis);
        let across = length(sub(segment, scale(self.axis, along)));
        let reach = length(reach) * (1.0 + MARGIN) + MARGIN * length(segment);
        across - reach <= (self.angle.tan() + MARGIN) * (along + reach).max(0.0)
    }

    /// Returns a piece that contains the middle of each segment from the box to a piece.
    pub(crate) fn midway(&self, piece: &Piece) -> Piece {
        let begins = self.begins();
        [0, 1, 2].map(|axis| [0, 1].map(|end| 0.5 * (begins[axis][end] + piece[axis][end])))
    }

    /// Returns the direction along which a piece is divided: where it is longest, but along the
    /// normals of the box rather than along its surface.
    pub(crate) fn longest(&self, piece: &Piece) -> usize {
        let weight = |direction: Vec3| {
            let most = |most: f64, normal: &Vec3| most.max(dot(*normal, direction).abs());
            self.normals.iter().fold(0.3, most)
        };
        let size = self.directions().map(weight);
        let size = [0, 1, 2].map(|axis| size[axis] * (piece[axis][1] - piece[axis][0]));
        [0, 1, 2].into_iter().max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0)
    }

    pub(crate) fn prism(&self, piece: &Piece) -> Prism {
        let mut prism = Prism { center: self.frame.center, axes: [[0.0; 3]; 3] };
        for (axis, direction) in self.directions().into_iter().enumerate() {
            let [from, to] = piece[axis];
            prism.center = add(prism.center, scale(direction, 0.5 * (from + to)));
            prism.axes[axis] = scale(direction, 0.5 * (to - from) * (1.0 + 1e-12));
        }
        prism
    }
}

/// Returns a direction near all of some: the center of a small ball around them (M. Bădoiu and K.
/// Clarkson, Smaller core-sets for balls, 2003).
pub(crate) fn center(directions: &[Vec3]) -> Option<Vec3> {
    let mut center = unit(directions.iter().fold([0.0; 3], |sum, normal| add(sum, *normal)))?;
    for round in 1..=40 {
        let cosine = |normal: &&Vec3| dot(**normal, center);
        let least = directions.iter().min_by(|a, b| cosine(a).total_cmp(&cosine(b)))?;
        if dot(*least, center) > 0.999 {
            break;
        }
        center = unit(between(center, *least, 1.0 / f64::from(round + 1)))?;
    }
    Some(center)
}

/// Returns a frame along two faces that meet in a box, so that flat pieces lie along them.
pub(crate) fn along_faces([lo, hi]: [Vec3; 2], normals: &[Vec3]) -> Option<Frame> {
    let normal = *normals.first()?;
    let cosine = |other: &&Vec3| dot(**other, normal);
    let other = *normals.iter().min_by(|a, b| cosine(a).total_cmp(&cosine(b)))?;
    let u = unit(sub(other, scale(normal, dot(other, normal))))?;
    let v = cross(normal, u);
    let half = scale(sub(hi, lo), 0.5);
    let half = [normal, u, v].map(|a| dot(a.map(f64::abs), half) * (1.0 + 1e-12));
    Some(Frame { center: between(lo, hi, 0.5), normal, tangents: [u, v], half })
}

/// Returns the angle between unit vectors (W. Kahan's formula, which is exact for small angles).
pub(crate) fn angle_between(a: Vec3, b: Vec3) -> f64 {
    2.0 * length(sub(a, b)).atan2(length(add(a, b)))
}
