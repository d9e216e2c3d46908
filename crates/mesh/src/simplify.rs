//! Leaves out points of closed paths that nearly lie on a line or an arc.

use crate::curve::{Curve, fitted};
use crate::polygon::{Point, Rows, parents};

/// A path moves by at most this fraction of the error when points are left out.
const MOVED: f64 = 0.3;
/// Coordinates are rounded to a power of ten that is at most this fraction of the error.
const DIGITS: f64 = 1e-3;
/// Lines take the place of arcs in proofs, within this fraction of the error.
pub(crate) const DIVIDED: f64 = 0.04;

/// Returns paths with fewer points and shorter numbers, with arcs if they are wanted. They neither
/// cross nor jump over each other: where they would, paths stay as they are.
pub(crate) fn simplified(paths: Vec<Vec<Point>>, error: f64, has_arcs: bool) -> Vec<Curve> {
    let mut found: Vec<Curve> = paths.iter().map(|path| shorter(path, error, has_arcs)).collect();
    let mut is_kept = vec![false; paths.len()];
    let around = parents(&paths);
    loop {
        let hulls = found.iter().map(|curve| curve.hull(DIVIDED * error)).collect();
        let mut wrong = Rows::of(hulls).crossing();
        if wrong.is_empty() {
            let divided: Vec<Vec<Point>> =
                found.iter().map(|curve| curve.lines(DIVIDED * error)).collect();
            wrong = moved(&around, &parents(&divided));
        }
        wrong.retain(|index| !is_kept[*index]);
        if wrong.is_empty() {
            return found;
        }
        for index in wrong {
            is_kept[index] = true;
            found[index] = Curve::of_lines(paths[index].clone());
        }
    }
}

/// Returns the paths that are no longer in the path that was around them, and these paths.
fn moved(before: &[Option<usize>], after: &[Option<usize>]) -> Vec<usize> {
    let both = before.iter().zip(after).enumerate();
    both.filter(|(_, (before, after))| before != after)
        .flat_map(|(index, (before, after))| [Some(index), *before, *after])
        .flatten()
        .collect()
}

fn shorter(path: &[Point], error: f64, has_arcs: bool) -> Curve {
    let whole = || Curve::of_lines(path.to_vec());
    // The point that is farthest from another one is a corner wherever the path has corners.
    let Some([x, y]) = path.first().copied() else { return Curve::default() };
    let away = |index: &usize| (path[*index][0] - x).hypot(path[*index][1] - y);
    let start = (0..path.len()).max_by(|a, b| away(a).total_cmp(&away(b)));
    let Some(start) = start else { return Curve::default() };
    let mut turned: Vec<Point> = [&path[start..], &path[..=start]].concat();
    let scale = 10f64.powi(-(DIGITS * error).log10().floor() as i32);
    let rounded = |point: Point| point.map(|x| (x * scale).round() / scale);
    if turned.iter().all(|point| rounded(*point).iter().all(|x| x.is_finite())) {
        turned.iter_mut().for_each(|point| *point = rounded(*point));
        turned.dedup();
    }
    if turned.len() < 4 {
        return whole();
    }
    let lines = kept(&turned, MOVED * error);
    let curve = match has_arcs {
        true => fitted(&turned, &lines, MOVED * error),
        false => {
            Curve::of_lines(lines[..lines.len() - 1].iter().map(|index| turned[*index]).collect())
        }
    };
    let is_area = curve.points.len() > 2 || curve.has_arcs();
    if is_area { curve } else { whole() }
}

/// Returns the indices of the ends of a path and of the points between that are needed to stay
/// within a distance (Douglas and Peucker, 1973).
fn kept(path: &[Point], distance: f64) -> Vec<usize> {
    let mut is_kept = vec![false; path.len()];
    let mut waiting = vec![[0, path.len() - 1]];
    while let Some([from, to]) = waiting.pop() {
        is_kept[from] = true;
        is_kept[to] = true;
        let away = |index: &usize| to_segment(path[*index], path[from], path[to]);
        let farthest = (from + 1..to).max_by(|a, b| away(a).total_cmp(&away(b)));
        if let Some(farthest) = farthest
            && away(&farthest) > distance
        {
            waiting.extend([[from, farthest], [farthest, to]]);
        }
    }
    (0..path.len()).filter(|index| is_kept[*index]).collect()
}

/// Returns the distance of a point from a segment.
fn to_segment([x, y]: Point, a: Point, b: Point) -> f64 {
    let [along_x, along_y] = [b[0] - a[0], b[1] - a[1]];
    let squared = along_x * along_x + along_y * along_y;
    let t = ((x - a[0]) * along_x + (y - a[1]) * along_y) / squared;
    let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
    (x - a[0] - t * along_x).hypot(y - a[1] - t * along_y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::area;

    #[test]
    fn points_on_a_line_are_left_out_and_corners_are_kept() {
        let mut square = Vec::new();
        for i in 0..10 {
            square.push([f64::from(i) / 10.0, 0.0001 * f64::from(i % 2)]);
        }
        square.extend([[1.0, 0.0], [1.0, 0.5], [1.0, 1.0], [0.0, 1.0]]);
        let found = simplified(vec![square], 0.01, true);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].points, [[1.0, 1.0], [0.0, 1.0], [0.0, 0.0], [1.0, 0.0]]);
        assert_eq!(found[0].bulges, [0.0; 4]);
    }

    #[test]
    fn a_path_does_not_jump_over_another_one() {
        // A bulge below the error, and a small square within it.
        let bulge: Vec<Point> = vec![[0.0, 0.0], [0.5, -0.02], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let small = vec![[0.49, -0.01], [0.49, -0.005], [0.51, -0.005], [0.51, -0.01]];
        let paths = vec![bulge.clone(), small];
        let found = simplified(paths.clone(), 0.1, true);
        assert_eq!(found[0].points, bulge);
        assert!(area(&found[1].points) < 0.0);
        let alone = simplified(vec![bulge], 0.1, true);
        assert_eq!(alone[0].points.len(), 4);
    }
}
