//! A plane in space, with coordinates of its own.

use sdfc_graph::eval::Number;

use crate::vector::{Vec3, add, cross, dot, scale, sub, unit};

/// A plane, seen from the side that its normal points to.
///
/// Its first coordinate points right and its second one up: the second axis is the one nearest to
/// y. In a plane that is orthogonal to y, the second axis points to -z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    origin: Vec3,
    axes: [Vec3; 2],
    normal: Vec3,
}

/// A normal is along y if its other components are at most this fraction of its length.
const ALONG_Y: f64 = 1e-9;

impl Plane {
    /// Returns the plane of all points whose coordinate along the normal is `offset`, in scene
    /// units. The normal may have any length. `None` if it has none, or if a number is not finite.
    ///
    /// ```
    /// use sdfc_mesh::Plane;
    ///
    /// let plane = Plane::new([2.0, 0.0, 0.0], 0.5).expect("a normal");
    /// assert_eq!(plane.at([3.0, 4.0]), [0.5, 4.0, -3.0]);
    /// assert_eq!(Plane::new([0.0; 3], 0.5), None);
    /// ```
    pub fn new(normal: [f64; 3], offset: f64) -> Option<Self> {
        let normal = unit(normal).filter(|_| offset.is_finite())?;
        let is_along_y = normal[0].hypot(normal[2]) <= ALONG_Y;
        let up = if is_along_y { [0.0, 0.0, -1.0] } else { [0.0, 1.0, 0.0] };
        let second = unit(sub(up, scale(normal, dot(up, normal))))?;
        let axes = [cross(second, normal), second];
        // Adding 0 turns -0 into 0.
        let tidy = |vector: Vec3| vector.map(|x| x + 0.0);
        let origin = tidy(scale(normal, offset));
        Some(Self { origin, axes: axes.map(tidy), normal: tidy(normal) })
    }

    /// Returns the position in space of a point of the plane.
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        self.position([x, y, 0.0])
    }

    /// Returns the coordinate along the normal.
    pub fn offset(&self) -> f64 {
        dot(self.origin, self.normal)
    }

    /// Returns the unit normal.
    pub fn normal(&self) -> [f64; 3] {
        self.normal
    }

    /// Returns the directions of both coordinates: right and up.
    pub fn axes(&self) -> [[f64; 3]; 2] {
        self.axes
    }

    /// Returns the position of a point of the plane in any number type. The third coordinate is
    /// ignored.
    pub(crate) fn position<N: Number>(&self, [x, y, _]: [N; 3]) -> [N; 3] {
        let [right, up] = self.axes;
        [0, 1, 2].map(|axis| {
            let along = |from: N, by: N, part: f64| match part {
                0.0 => from,
                1.0 => from.add(by),
                _ => from.add(by.mul(N::constant(part))),
            };
            along(along(N::constant(self.origin[axis]), x, right[axis]), y, up[axis])
        })
    }

    /// Returns the lowest and the highest coordinate of a box along the normal.
    pub(crate) fn range(&self, [lo, hi]: [Vec3; 2]) -> [f64; 2] {
        let middle = dot(self.normal, scale(add(lo, hi), 0.5));
        let reach = dot(self.normal.map(f64::abs), scale(sub(hi, lo), 0.5));
        [middle - reach, middle + reach]
    }

    /// Returns the rectangle of the plane that a box lies over.
    pub(crate) fn shadow(&self, [lo, hi]: [Vec3; 2]) -> [[f64; 2]; 2] {
        let middle = scale(add(lo, hi), 0.5);
        let half = scale(sub(hi, lo), 0.5);
        let offset = sub(middle, self.origin);
        let range = self.axes.map(|axis| {
            let (middle, reach) = (dot(axis, offset), dot(axis.map(f64::abs), half));
            [middle - reach, middle + reach]
        });
        [[range[0][0], range[1][0]], [range[0][1], range[1][1]]]
    }
}
