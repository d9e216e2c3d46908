//! Where clauses are sampled: boxes, random points and directions in them, and how many.

use sdfc_graph::eval::{FrameValues, Tape, evaluate_frame};
use sdfc_graph::{Dim, Graph, NodeId};

/// Half the length of the sampled interval on an axis without bounds.
pub(super) const REACH: f64 = 2.0;

pub(super) type Point = [f64; 3];

/// The scalar operations that one test of a clause may take. A field that takes many is sampled at
/// fewer points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort(pub(super) u64);

impl Effort {
    /// How many evaluations of a tape may be taken.
    pub(super) fn evaluations(self, tape: &Tape) -> u64 {
        self.0 / (tape.operations() as u64).max(1)
    }

    /// How many of `count` samples may be taken, each of which counts as some evaluations.
    pub(super) fn samples(self, count: usize, evaluations: usize, tape: &Tape) -> usize {
        let most = self.evaluations(tape) / (evaluations as u64).max(1);
        count.min(usize::try_from(most).unwrap_or(count))
    }
}

/// The point of a formula at level 0, as a part of the point in space.
pub(super) fn point_of(graph: &mut Graph, dim: Dim) -> NodeId {
    let space = graph.point(0, Dim::Three);
    match dim {
        Dim::Two => graph.swizzle(space, &[0, 1]),
        Dim::Three => space,
    }
}

/// The corners of a box at a frame's values.
pub(super) fn corners_at(
    graph: &Graph,
    corners: [NodeId; 2],
    frame: &FrameValues,
) -> Option<[Point; 2]> {
    let values = evaluate_frame(graph, &corners, frame);
    let corner = |end: usize| values.get(end).map(|&[x, y, z, _]| [x, y, z]);
    Some([corner(0)?, corner(1)?])
}

/// The box, limited on axes on which it is infinite. There it is twice `reach` long: from its only
/// end, or around 0. Axes after the first few are 0. Returns `None` if the box is empty.
pub(super) fn window(bounds: [Point; 2], axes: usize, reach: f64) -> Option<[Point; 2]> {
    let mut window = [[0.0; 3]; 2];
    for axis in 0..axes {
        let [lo, hi] = [bounds[0][axis], bounds[1][axis]];
        let (lo, hi) = match (lo.is_finite(), hi.is_finite()) {
            (true, true) => (lo, hi),
            (true, false) => (lo, lo + 2.0 * reach),
            (false, true) => (hi - 2.0 * reach, hi),
            (false, false) => (-reach, reach),
        };
        if lo > hi {
            return None;
        }
        (window[0][axis], window[1][axis]) = (lo, hi);
    }
    Some(window)
}

/// The box, grown by a length along each axis.
pub(super) fn grown([lo, hi]: [Point; 2], by: Point) -> [Point; 2] {
    [[0, 1, 2].map(|axis| lo[axis] - by[axis]), [0, 1, 2].map(|axis| hi[axis] + by[axis])]
}

/// The longest edge of a box.
pub(super) fn longest([lo, hi]: [Point; 2]) -> f64 {
    [0, 1, 2].map(|axis| hi[axis] - lo[axis]).into_iter().fold(0.0, f64::max)
}

pub(super) fn distance(a: Point, b: Point) -> f64 {
    [0, 1, 2].map(|axis| (a[axis] - b[axis]).powi(2)).iter().sum::<f64>().sqrt()
}

/// The SplitMix64 generator: the same numbers on every machine.
pub(super) struct Random(pub(super) u64);

impl Random {
    /// A random integer in `0..count`.
    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    /// A random number in `0..1`.
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A random number in `-1..1`.
    pub(super) fn signed(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }

    /// A random point of a box. Coordinates after the first `axes` are 0.
    pub(super) fn point(&mut self, [lo, hi]: [Point; 2], axes: usize) -> Point {
        let mut point = [0.0; 3];
        for (axis, coordinate) in point.iter_mut().enumerate().take(axes) {
            *coordinate = lo[axis] + (hi[axis] - lo[axis]) * self.next();
        }
        point
    }

    /// A unit vector. All directions are equally likely.
    pub(super) fn direction(&mut self) -> Point {
        self.unit(1.0, Self::signed)
    }

    /// A unit vector, often parallel to an axis or in the plane of two.
    pub(super) fn direction_by_axes(&mut self) -> Point {
        self.unit(f64::INFINITY, |random| match random.below(5) {
            0 | 1 => 0.0,
            2 => 1e-4 * random.signed(),
            _ => random.signed(),
        })
    }

    /// The direction of a random vector that is not longer than `longest`.
    fn unit(&mut self, longest: f64, coordinate: impl Fn(&mut Self) -> f64) -> Point {
        loop {
            let vector = [0, 1, 2].map(|_| coordinate(&mut *self));
            let length = distance(vector, [0.0; 3]);
            if length > 1e-6 && length <= longest {
                return vector.map(|x| x / length);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INFINITY: f64 = f64::INFINITY;

    #[test]
    fn windows_are_finite_and_within_the_bounds() {
        let along_x = |lo: f64, hi: f64| {
            let [lo, hi] = window([[lo, 0.0, 0.0], [hi, 1.0, 1.0]], 3, 1.5)?;
            Some([lo[0], hi[0]])
        };
        assert_eq!(along_x(-1.0, 7.0), Some([-1.0, 7.0]));
        assert_eq!(along_x(10.0, INFINITY), Some([10.0, 13.0]));
        assert_eq!(along_x(-INFINITY, -10.0), Some([-13.0, -10.0]));
        assert_eq!(along_x(-INFINITY, INFINITY), Some([-1.5, 1.5]));
        assert_eq!(along_x(1.0, -1.0), None);
    }

    #[test]
    fn windows_of_regions_are_flat() {
        let bounds = [[-INFINITY; 3], [INFINITY; 3]];
        assert_eq!(window(bounds, 2, 2.0), Some([[-2.0, -2.0, 0.0], [2.0, 2.0, 0.0]]));
    }

    #[test]
    fn points_are_in_their_box_and_directions_are_unit_vectors() {
        let mut random = Random(1);
        let area = grown([[0.0; 3], [1.0, 2.0, 0.0]], [1.0, 0.0, 0.0]);
        for _ in 0..100 {
            let [x, y, z] = random.point(area, 2);
            assert!((-1.0..2.0).contains(&x) && (0.0..2.0).contains(&y) && z == 0.0);
            for vector in [random.direction(), random.direction_by_axes()] {
                assert!((distance(vector, [0.0; 3]) - 1.0).abs() < 1e-12, "{vector:?}");
            }
        }
    }
}
