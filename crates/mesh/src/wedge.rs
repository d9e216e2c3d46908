//! Proves that mesh and surface are near each other in a box where two faces meet in an edge.

use crate::field::{Frame, Prism, Prober};
use crate::nearness::{crosses_once, cut, is_in_box, line_in_box, polygon_in_box};
use crate::vector::{Vec3, add, between, cross, dot, length, scale, sub, unit};

/// Faces whose normals enclose an angle with a smaller sine have no edge.
const LEAST_SINE: f64 = 0.3;
/// The least cosine of half the angle between the normals. Sharper edges need small boxes.
const LEAST_COSINE: f64 = 0.2;
/// A part of the box, for the rounding of heights.
const ROUNDING: f64 = 1e-12;
/// Points near the edge through which lines are tried, as parts of the box, and the part of their
/// way to the edge that they are moved: a line through the edge itself would meet two triangles.
const LINES: [Vec3; 4] =
    [[0.013, 0.071, 0.029], [-0.313, 0.217, 0.109], [0.271, -0.419, 0.341], [-0.57, 0.61, -0.53]];
const TO_EDGE: f64 = 0.95;

/// Two planes that meet in an edge, in coordinates from the middle of a box.
struct Wedge {
    /// Unit normals of the planes, away from the convex side, and their heights.
    normals: [Vec3; 2],
    offsets: [f64; 2],
    /// The direction between both normals, and its cosine to them.
    up: Vec3,
    cosine: f64,
    /// True if the convex side is inside.
    is_convex: bool,
}

/// True if the mesh in a box is nearly two planes with an edge, and the field has different signs
/// at the error's distance on both sides of it.
///
/// The height of a point is the greater of its heights over the two planes. Along the direction
/// `up` between the normals it grows by their cosine for each unit of length. Let the mesh lie
/// between two heights in the box grown by the error, and let the field have one sign from the
/// cosine times the error above the lower height, and the other sign from that much below the upper
/// one. Then each point of the mesh in the box has both signs within the error along `up`. Each
/// point of the surface has points on both sides of the mesh there: those above the upper height
/// are connected, because the end of one line is above it over both planes, and those below the
/// lower height are convex. The line crosses the mesh an odd number of times, which shows that they
/// are different sides. All triangles that meet the grown box are given.
pub(crate) fn is_wedge(
    prober: &mut Prober<'_>,
    bounds: [Vec3; 2],
    triangles: &[[Vec3; 3]],
    error: f64,
) -> bool {
    let middle = between(bounds[0], bounds[1], 0.5);
    let local: Vec<[Vec3; 3]> =
        triangles.iter().map(|corners| corners.map(|corner| sub(corner, middle))).collect();
    let half = sub(bounds[1], middle);
    let Some(wedge) = Wedge::of(&local, half) else { return false };
    let grown = half.map(|half| (half + error) * (1.0 + ROUNDING));
    let Some([lo, hi]) = wedge.heights(&local, grown) else { return false };
    let step = error * wedge.cosine;
    hi - lo < 2.0 * step
        && wedge.is_crossed(&local, [half, grown], [lo, hi])
        && wedge.is_below(prober, middle, grown, hi - step)
        && wedge.is_above(prober, middle, grown, lo + step)
}

/// A triangle: its unit normal, its area and its center.
struct Face {
    normal: Vec3,
    area: f64,
    center: Vec3,
}

impl Face {
    fn of([a, b, c]: [Vec3; 3]) -> Option<Self> {
        let twice = cross(sub(b, a), sub(c, a));
        let center = scale(add(add(a, b), c), 1.0 / 3.0);
        Some(Self { normal: unit(twice)?, area: 0.5 * length(twice), center })
    }
}

impl Wedge {
    /// The wedge of the mesh in a box: the planes of its largest triangle and of the largest one at
    /// an angle to it.
    fn of(triangles: &[[Vec3; 3]], half: Vec3) -> Option<Self> {
        let within = triangles.iter().filter(|corners| is_in_box(**corners, half));
        let faces: Vec<Face> = within.copied().filter_map(Face::of).collect();
        let largest = |a: &&Face, b: &&Face| a.area.total_cmp(&b.area);
        let first = faces.iter().max_by(largest)?;
        let is_other = |face: &&Face| length(cross(first.normal, face.normal)) > LEAST_SINE;
        let second = faces.iter().filter(is_other).max_by(largest)?;
        // The convex side is below both planes.
        let is_convex = dot(sub(second.center, first.center), first.normal) < 0.0;
        let sign = if is_convex { 1.0 } else { -1.0 };
        let normals = [first, second].map(|face| scale(face.normal, sign));
        let offsets = [dot(normals[0], first.center), dot(normals[1], second.center)];
        let up = unit(add(normals[0], normals[1]))?;
        let cosine = dot(up, normals[0]).min(dot(up, normals[1]));
        (cosine > LEAST_COSINE).then_some(Self { normals, offsets, up, cosine, is_convex })
    }

    /// The heights of a point over both planes.
    fn over(&self, point: Vec3) -> [f64; 2] {
        [0, 1].map(|i| dot(self.normals[i], point) - self.offsets[i])
    }

    /// The least and the greatest height of the mesh in a box.
    fn heights(&self, triangles: &[[Vec3; 3]], half: Vec3) -> Option<[f64; 2]> {
        let margin = ROUNDING * (half[0] + half[1] + half[2]);
        let mut found: Option<[f64; 2]> = None;
        for corners in triangles {
            let polygon = polygon_in_box(*corners, half);
            for i in 0..2 {
                // The height is that over plane i where the other one is lower.
                let rest = cut(&polygon, |point| {
                    let over = self.over(*point);
                    over[1 - i] - over[i]
                });
                for point in rest {
                    let height = self.over(point)[i];
                    let [lo, hi] = found.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
                    found = Some([lo.min(height - margin), hi.max(height + margin)]);
                }
            }
        }
        found
    }

    /// True if a line along `up` crosses the mesh an odd number of times on its way through the
    /// grown box, from below the lower height to above the upper one over both planes.
    fn is_crossed(
        &self,
        triangles: &[[Vec3; 3]],
        [half, grown]: [Vec3; 2],
        [lo, hi]: [f64; 2],
    ) -> bool {
        let frame = Frame::around([scale(grown, -1.0), grown], self.up);
        let corners: Vec<[Vec3; 3]> = triangles
            .iter()
            .map(|corners| corners.map(|corner| frame.coordinates(corner)))
            .collect();
        let apart = sub(self.normals[0], self.normals[1]);
        LINES.iter().any(|part| {
            let start = [0, 1, 2].map(|axis| part[axis] * half[axis]);
            let [a, b] = self.over(start);
            let start = sub(start, scale(apart, TO_EDGE * (a - b) / dot(apart, apart)));
            let Some([from, to]) = line_in_box(start, self.up, grown) else { return false };
            let at = |t: f64| self.over(add(start, scale(self.up, t)));
            if at(from).iter().any(|height| *height >= lo) || at(to).iter().any(|h| *h <= hi) {
                return false;
            }
            let [height, u, v] = frame.coordinates(start);
            crosses_once(&corners, [u, v], [height + from, height + to])
        })
    }

    /// True if the field is proven to have the sign of the convex side where both heights in a box
    /// are at most a limit.
    fn is_below(&self, prober: &mut Prober<'_>, middle: Vec3, half: Vec3, limit: f64) -> bool {
        let Some(along) = unit(cross(self.normals[0], self.normals[1])) else { return false };
        let [n, m] = self.normals;
        // The directions in which one height grows by 1, and the other one and the position along
        // the edge stay.
        let volume = dot(n, cross(m, along));
        let directions =
            [scale(cross(m, along), 1.0 / volume), scale(cross(along, n), 1.0 / volume)];
        let reach = |axis: Vec3| dot(axis.map(f64::abs), half) * (1.0 + ROUNDING);
        let mut center = middle;
        let mut axes = [[0.0; 3], [0.0; 3], scale(along, reach(along))];
        for i in 0..2 {
            let least = -reach(self.normals[i]);
            let most = (limit + self.offsets[i]).min(-least);
            if most <= least {
                return true;
            }
            center = add(center, scale(directions[i], 0.5 * (least + most)));
            axes[i] = scale(directions[i], 0.5 * (most - least) * (1.0 + ROUNDING));
        }
        prober.side_over(&Prism { center, axes }) == Some(self.is_convex)
    }

    /// True if the field is proven to have the sign of the other side where a height in a box is at
    /// least a limit.
    fn is_above(&self, prober: &mut Prober<'_>, middle: Vec3, half: Vec3, limit: f64) -> bool {
        let grown = [sub(middle, half), add(middle, half)];
        self.normals.iter().zip(self.offsets).all(|(normal, offset)| {
            let frame = Frame::around(grown, *normal);
            let (from, to) = (limit + offset, frame.half[0]);
            from >= to || prober.side_over(&frame.part(from.max(-to), to)) == Some(!self.is_convex)
        })
    }
}

#[cfg(test)]
mod tests {
    use sdfc_graph::eval::{FrameValues, Tape};
    use sdfc_graph::{Dim, Graph};

    use super::*;
    use crate::field::LocalField;

    const BOX: [Vec3; 2] = [[-0.5; 3], [0.5; 3]];
    const ERROR: f64 = 0.1;

    /// Two faces that meet along z at a point: below it along y, and to its left along x.
    fn faces([x, y]: [f64; 2]) -> Vec<[Vec3; 3]> {
        let quad = |a: [f64; 2], b: [f64; 2]| {
            let at = |[x, y]: [f64; 2], z: f64| [x, y, z];
            [[at(a, -2.0), at(b, -2.0), at(b, 2.0)], [at(a, -2.0), at(b, 2.0), at(a, 2.0)]]
        };
        [quad([x, -2.0], [x, y]), quad([x, y], [-2.0, y])].concat()
    }

    /// True if it is proven that the faces are near the surface of a quarter of space, which is
    /// solid where x and y are negative, or empty there.
    fn is_near(triangles: &[[Vec3; 3]], is_solid: bool) -> bool {
        let mut graph = Graph::new();
        let p = graph.point(0, Dim::Three);
        let (x, y) = (graph.component(p, 0), graph.component(p, 1));
        let quarter = graph.max(x, y);
        let root = if is_solid { quarter } else { graph.neg(quarter) };
        let tape = Tape::new(&graph, &[root]).unwrap();
        let frame = FrameValues::default();
        let field = LocalField::new(&tape, &frame);
        is_wedge(&mut field.prober(), BOX, triangles, ERROR)
    }

    #[test]
    fn an_edge_is_near_within_the_error_alone() {
        for is_solid in [true, false] {
            let outward = |triangles: Vec<[Vec3; 3]>| match is_solid {
                true => triangles,
                false => triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect(),
            };
            assert!(is_near(&outward(faces([0.0, 0.0])), is_solid));
            assert!(is_near(&outward(faces([0.05, -0.06])), is_solid));
            assert!(!is_near(&outward(faces([0.0, 0.15])), is_solid));
            assert!(!is_near(&outward(faces([-0.11, 0.0])), is_solid));
        }
    }

    #[test]
    fn an_edge_without_one_of_its_faces_is_not_near() {
        let whole = faces([0.0, 0.0]);
        assert!(!is_near(&whole[..2], true));
        assert!(!is_near(&whole[1..], true));
        let twice = [whole.clone(), whole].concat();
        assert!(!is_near(&twice, true));
    }
}
