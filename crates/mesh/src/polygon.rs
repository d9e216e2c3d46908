//! Closed paths in a plane: orientation, crossings and nesting.

/// A point of the plane.
pub(crate) type Point = [f64; 2];

/// The sides of paths, by the rows of a grid that they lie in.
pub(crate) struct Rows {
    lowest: f64,
    height: f64,
    /// Sides as the index of a path and its two ends.
    rows: Vec<Vec<(usize, [Point; 2])>>,
}

/// Returns the sides of a closed path.
pub(crate) fn sides(path: &[Point]) -> impl Iterator<Item = [Point; 2]> + '_ {
    (0..path.len()).map(|index| [path[index], path[(index + 1) % path.len()]])
}

/// Returns the area within a path, negative if it is clockwise.
pub(crate) fn area(path: &[Point]) -> f64 {
    // About a point of the path, because far from it digits cancel.
    let [x, y] = path.first().copied().unwrap_or_default();
    let part = |[a, b]: [Point; 2]| (a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y);
    0.5 * sides(path).map(part).sum::<f64>()
}

impl Rows {
    /// Sorts the sides of paths into about as many rows as the square root of their number.
    pub(crate) fn new(paths: &[Vec<Point>]) -> Self {
        Self::of(paths.iter().map(|path| sides(path).collect()).collect())
    }

    /// Sorts sides, which are given for each path.
    pub(crate) fn of(paths: Vec<Vec<[Point; 2]>>) -> Self {
        let points = || paths.iter().flatten().flatten();
        let lowest = points().map(|point| point[1]).fold(f64::INFINITY, f64::min);
        let highest = points().map(|point| point[1]).fold(f64::NEG_INFINITY, f64::max);
        let count = (points().count() as f64 / 2.0).sqrt().ceil().max(1.0);
        let height = ((highest - lowest) / count).max(f64::MIN_POSITIVE);
        let mut found = Self { lowest, height, rows: vec![Vec::new(); count as usize] };
        for (index, sides) in paths.into_iter().enumerate() {
            for side in sides {
                let [a, b] = side.map(|point| found.row(point[1]));
                for row in a.min(b)..=a.max(b) {
                    found.rows[row].push((index, side));
                }
            }
        }
        found
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.lowest) / self.height) as usize).min(self.rows.len() - 1)
    }

    /// Returns the paths that cross or touch themselves or others, other than in the ends of
    /// successive sides.
    pub(crate) fn crossing(mut self) -> Vec<usize> {
        let mut found = Vec::new();
        let least = |side: &[Point; 2]| side[0][0].min(side[1][0]);
        for row in &mut self.rows {
            row.sort_by(|(_, a), (_, b)| least(a).total_cmp(&least(b)));
            for (index, (path, side)) in row.iter().enumerate() {
                let end = side[0][0].max(side[1][0]);
                let rest = row[index + 1..].iter().take_while(|(_, other)| least(other) <= end);
                for (other_path, _) in rest.filter(|(_, other)| meet(*side, *other)) {
                    found.extend([*path, *other_path]);
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Returns the side that a ray from a point to the left meets first.
    fn left_of(&self, [x, y]: Point) -> Option<(usize, [Point; 2])> {
        let mut nearest: Option<(f64, (usize, [Point; 2]))> = None;
        for entry in &self.rows[self.row(y)] {
            let [a, b] = entry.1;
            if (a[1] <= y) == (b[1] <= y) {
                continue;
            }
            let at = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            if at < x && nearest.is_none_or(|(known, _)| at > known) {
                nearest = Some((at, *entry));
            }
        }
        nearest.map(|(_, entry)| entry)
    }
}

/// True if two sides have a common point that is not an end of both.
fn meet([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let shared = [a, b].into_iter().filter(|end| *end == c || *end == d).count();
    if shared == 2 {
        return true;
    }
    let [abc, abd] = [turn(a, b, c), turn(a, b, d)];
    let [cda, cdb] = [turn(c, d, a), turn(c, d, b)];
    if shared == 1 {
        // Successive sides meet again only if they lie on one line and on one side of the end.
        let end = if a == c || a == d { a } else { b };
        let other = |[p, q]: [Point; 2]| if p == end { q } else { p };
        let ([px, py], [qx, qy]) = (other([a, b]), other([c, d]));
        let along = (px - end[0]) * (qx - end[0]) + (py - end[1]) * (qy - end[1]);
        return abc == 0.0 && abd == 0.0 && along > 0.0;
    }
    let is_apart = |axis: usize| {
        a[axis].max(b[axis]) < c[axis].min(d[axis]) || c[axis].max(d[axis]) < a[axis].min(b[axis])
    };
    abc * abd <= 0.0 && cda * cdb <= 0.0 && !is_apart(0) && !is_apart(1)
}

/// Returns a number whose sign tells to which side a path turns: positive for left.
fn turn(a: Point, b: Point, c: Point) -> f64 {
    let coord = |[x, y]: Point| robust::Coord { x, y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// For each path, returns the path directly around it. Paths do not cross. They have the inside on
/// the left.
pub(crate) fn parents(paths: &[Vec<Point>]) -> Vec<Option<usize>> {
    let rows = Rows::new(paths);
    let leftmost = |path: &Vec<Point>| {
        path.iter().copied().min_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or_default()
    };
    let mut order: Vec<(Point, usize)> =
        paths.iter().enumerate().map(|(index, path)| (leftmost(path), index)).collect();
    order.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]));
    let mut parents = vec![None; paths.len()];
    for (point, index) in order {
        parents[index] = rows.left_of(point).and_then(|(other, [a, b])| {
            // The inside of the scene is to the left of a side: to its right if that leads down.
            let is_around = (area(&paths[other]) > 0.0) == (b[1] < a[1]);
            if is_around { Some(other) } else { parents[other] }
        });
    }
    parents
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, half: f64) -> Vec<Point> {
        vec![[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]]
    }

    fn hole(x: f64, y: f64, half: f64) -> Vec<Point> {
        square(x, y, half).into_iter().rev().collect()
    }

    #[test]
    fn each_path_knows_the_path_around_it() {
        let paths = [
            square(0.0, 0.0, 1.0),
            hole(0.5, 0.0, 0.4),
            square(0.5, 0.0, 0.2),
            hole(-0.5, 0.0, 0.4),
            square(5.0, 0.0, 1.0),
            square(-0.55, 0.0, 0.1),
            square(-0.3, 0.0, 0.1),
        ];
        let expected = [None, Some(0), Some(1), Some(0), None, Some(3), Some(3)];
        assert_eq!(parents(&paths), expected);
    }

    #[test]
    fn crossing_paths_are_found() {
        let crossing = |paths: &[Vec<Point>]| Rows::new(paths).crossing();
        let apart = [square(0.0, 0.0, 1.0), hole(0.0, 0.0, 0.5), square(3.0, 0.0, 1.0)];
        assert_eq!(crossing(&apart), [0usize; 0]);
        let touching = [square(0.0, 0.0, 1.0), square(3.0, 0.0, 0.5), square(2.0, 0.0, 1.0)];
        assert_eq!(crossing(&touching), [0, 1, 2]);
        let spike = vec![[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
        assert_eq!(crossing(&[spike]), [0]);
        let eight = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(crossing(&[square(9.0, 0.0, 1.0), eight]), [1]);
    }
}
