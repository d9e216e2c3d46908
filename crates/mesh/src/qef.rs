//! The point nearest to several planes: where sharp edges and corners are.

use crate::vector::{SurfacePoint, Vec3, add, dot, scale, sub};

/// Directions in which the planes determine a point this much less than in the best one are left
/// as they are.
const WEAK: f64 = 0.03;

/// Returns the point in a box with the least sum of squared distances to tangent planes, among
/// several the one nearest to `start` (Ju et al., "Dual Contouring of Hermite Data", 2002).
///
/// A sharp edge often leaves a cell near its corner, so the best point of all is often outside.
/// Then the coordinate that is farthest outside is fixed at the limit, and the others are found
/// again: on a line to the best point of all, the edge would be missed.
pub(crate) fn nearest_to_planes(start: Vec3, planes: &[SurfacePoint], [lo, hi]: [Vec3; 2]) -> Vec3 {
    let mut start = start;
    let mut free = [true; 3];
    for _ in 0..3 {
        let point = nearest_along(start, planes, free);
        let beyond = |axis: usize| (lo[axis] - point[axis]).max(point[axis] - hi[axis]);
        let farthest = (0..3).max_by(|a, b| beyond(*a).total_cmp(&beyond(*b))).unwrap_or(0);
        if beyond(farthest) <= 0.0 {
            return point;
        }
        start[farthest] = point[farthest].clamp(lo[farthest], hi[farthest]);
        free[farthest] = false;
    }
    std::array::from_fn(|axis| start[axis].clamp(lo[axis], hi[axis]))
}

/// Returns the same in all space, for changes of the free coordinates alone.
fn nearest_along(start: Vec3, planes: &[SurfacePoint], free: [bool; 3]) -> Vec3 {
    let mut matrix = [[0.0; 3]; 3];
    let mut vector = [0.0; 3];
    for SurfacePoint { position, normal } in planes {
        let distance = dot(*normal, sub(*position, start));
        let slope = [0, 1, 2].map(|axis| if free[axis] { normal[axis] } else { 0.0 });
        for row in 0..3 {
            for column in 0..3 {
                matrix[row][column] += slope[row] * slope[column];
            }
            vector[row] += slope[row] * distance;
        }
    }
    let (values, vectors) = eigen(matrix);
    let greatest = values.iter().fold(0.0, |a: f64, b| a.max(*b));
    let mut point = start;
    for (value, vector_of) in values.into_iter().zip(vectors) {
        if value > WEAK * greatest {
            point = add(point, scale(vector_of, dot(vector_of, vector) / value));
        }
    }
    point
}

/// Eigenvalues and eigenvectors of a symmetric matrix, by Jacobi rotations.
fn eigen(mut a: [[f64; 3]; 3]) -> (Vec3, [Vec3; 3]) {
    let mut vectors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..8 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q].abs() < 1e-300 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            let b = a;
            for k in 0..3 {
                a[k][p] = c * b[k][p] - s * b[k][q];
                a[k][q] = s * b[k][p] + c * b[k][q];
            }
            let b = a;
            for k in 0..3 {
                a[p][k] = c * b[p][k] - s * b[q][k];
                a[q][k] = s * b[p][k] + c * b[q][k];
            }
            let [x, y] = [vectors[p], vectors[q]];
            vectors[p] = sub(scale(x, c), scale(y, s));
            vectors[q] = add(scale(x, s), scale(y, c));
        }
    }
    ([a[0][0], a[1][1], a[2][2]], vectors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_planes_meet_in_their_corner_and_two_at_the_nearest_point_of_their_edge() {
        let plane = |normal, position| SurfacePoint { position, normal };
        let x = plane([1.0, 0.0, 0.0], [0.5, 7.0, 7.0]);
        let y = plane([0.0, 0.6, 0.8], [9.0, 0.6 * 0.25, 0.8 * 0.25]);
        let z = plane([0.0, -0.8, 0.6], [9.0, 0.0, 0.0]);
        let space = [[-9.0; 3], [9.0; 3]];
        let corner = nearest_to_planes([0.1, 0.2, 0.3], &[x, y, z], space);
        let close = |a: Vec3, b: Vec3| sub(a, b).iter().all(|x| x.abs() < 1e-12);
        assert!(close(corner, [0.5, 0.15, 0.2]), "{corner:?}");
        let edge = nearest_to_planes([0.0, 0.0, 0.0], &[x, y], space);
        assert!(close(edge, [0.5, 0.15, 0.2]), "{edge:?}");
    }

    #[test]
    fn an_edge_is_found_where_it_crosses_a_corner_of_the_box() {
        let plane = |normal, position| SurfacePoint { position, normal };
        let floor = plane([0.0, 0.0, -1.0], [0.0, 0.0, 0.25]);
        let wall = plane([0.6, 0.8, 0.0], [0.9, 0.95, 0.5]);
        // The nearest point of the edge is (0.85, 0.9875), beyond the limit of y.
        let [x, y, z] =
            nearest_to_planes([0.4, 0.3875, 0.5], &[floor, wall], [[0.0; 3], [0.95; 3]]);
        assert_eq!([y, z], [0.95, 0.25]);
        assert!((0.6 * x + 0.8 * y - 1.3).abs() < 1e-12 && x < 0.95, "{x}");
    }
}
