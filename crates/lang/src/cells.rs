//! Cells of the plane, each with the pieces of an outline that may be nearest to a point in it.
//!
//! A grid of square cells covers the box around the outline. Five rings of cells surround the box,
//! each four times as wide as the one within: a point that is e sides of a cell outside of the box
//! along an axis is in ring `ceil(log4(1 + 3 e))` of that axis. The last ring has no end. Along the
//! box, four columns or rows of the grid are one of the rings. The index of a column or row of the
//! rings is that of the nearest one along the box, plus the ring above or minus the ring below the
//! box, plus 5.
//!
//! On its way to the nearest point of the outline, a point outside of the box enters it at a point
//! of the border for which the same piece is nearest. So only those pieces matter in the rings.

use crate::outline::{Curve, Point};

/// Number of rings on each side of the box.
const RINGS: i32 = 5;
/// Number of columns or rows of the box that are one outside of it.
const COARSE: usize = 4;
/// Largest number of cells in the box.
pub const MAX_CELLS: usize = 65_536;
/// The last ring is examined up to this many sides of a cell. Farther away, 32-bit floats cannot
/// tell pieces of the outline apart.
const FARTHEST: f64 = 3e7;
/// A cell of the box, one of the rings, and a side of the border are cut in halves up to this many
/// times. Their pieces are those of all parts.
const CUTS_OF_CELL: u32 = 3;
const CUTS_OF_RING: u32 = 5;
const CUTS_OF_BORDER: u32 = 8;
/// A part with this number of pieces or fewer is not cut.
const FEW: usize = 2;
/// A rounded point may be in the cell beside, so parts are enlarged by this fraction of a cell's
/// side, and of their distance from the box.
const ROUNDING: [f64; 2] = [1e-3, 1e-6];

/// Where the cells are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// The lower corner of the box.
    pub corner: Point,
    /// Length of a cell's side.
    pub side: f64,
    /// Number of columns and rows of the box, without the rings.
    pub counts: [usize; 2],
}

/// The pieces of all cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    /// For each cell of the box, and then for each cell of the rings, the index of its first item.
    /// Cells are in rows from the lowest one and from the left. The cells of the rings that lie in
    /// the box have no items. One more entry is the number of items.
    pub starts: Vec<usize>,
    /// Indices of pieces: those of a cell ascend.
    pub items: Vec<usize>,
    /// Number of distances to pieces that were computed.
    pub distances: usize,
}

/// The cells of an outline of circular arcs. An arc is its start, the point where the tangents of
/// both ends meet, and its end.
pub fn cells(arcs: &[Curve], layout: Layout) -> Cells {
    let Layout { corner, side, counts } = layout;
    let scaled = |p: Point| [(p[0] - corner[0]) / side, (p[1] - corner[1]) / side];
    let arcs: Vec<Arc> = arcs.iter().map(|arc| Arc::new(arc.map(scaled))).collect();
    let all: Vec<usize> = (0..arcs.len()).collect();
    let mut search = Search { found: vec![false; arcs.len()], arcs, counts, distances: 0 };
    let fine = counts.map(|count| (0..=count).map(|line| line as f64).collect::<Vec<_>>());
    let mut inner = Grid::new(fine, CUTS_OF_CELL);
    let whole = counts.map(|count| [0, count]);
    search.fill(&mut inner, whole, &all);
    let outer = search.of_border(&all);
    let mut rings = Grid::new(counts.map(ring_lines), CUTS_OF_RING);
    let [columns, rows] = counts.map(|count| {
        let (below, inside) = (RINGS as usize, count.div_ceil(COARSE));
        [0, below, below + inside, 2 * below + inside]
    });
    for (x, column) in columns.windows(2).enumerate() {
        for (y, row) in rows.windows(2).enumerate() {
            if (x, y) != (1, 1) {
                search.fill(&mut rings, [[column[0], column[1]], [row[0], row[1]]], &outer);
            }
        }
    }
    let mut starts = Vec::with_capacity(inner.lists.len() + rings.lists.len() + 1);
    let mut items = Vec::new();
    for list in inner.lists.into_iter().chain(rings.lists) {
        starts.push(items.len());
        items.extend(list);
    }
    starts.push(items.len());
    Cells { starts, items, distances: search.distances }
}

/// A circular arc, with sides of a cell as the unit.
struct Arc {
    middle: Point,
    along: Point,
    half: f64,
    bend: f64,
    /// The arc is within this distance of `middle`: so are the corners of the triangle around it.
    reach: f64,
}

impl Arc {
    fn new([start, control, end]: Curve) -> Self {
        let middle = [f64::midpoint(start[0], end[0]), f64::midpoint(start[1], end[1])];
        let chord = [end[0] - start[0], end[1] - start[1]];
        let long = norm(chord);
        let along = if long > 0.0 { chord.map(|x| x / long) } else { [1.0, 0.0] };
        let half = long / 2.0;
        let v = [control[0] - middle[0], control[1] - middle[1]];
        let height = v[0] * along[1] - v[1] * along[0];
        let bend = if half > 0.0 { height / (half * half) } else { 0.0 };
        Self { middle, along, half, bend, reach: half.max(norm(v)) }
    }

    /// An upper bound of the distance between a point of this arc and one of another arc.
    fn extent(&self, other: &Self) -> f64 {
        let v = [other.middle[0] - self.middle[0], other.middle[1] - self.middle[1]];
        norm(v) + self.reach + other.reach
    }

    /// The distance to a point, by the formula of `_to_arc` in `std/regions.sdf`.
    fn distance(&self, p: Point) -> f64 {
        let v = [p[0] - self.middle[0], p[1] - self.middle[1]];
        let x = v[0] * self.along[0] + v[1] * self.along[1];
        let y = self.along[0] * v[1] - self.along[1] * v[0];
        let (half, bend) = (self.half, self.bend);
        let past = x.abs() - half;
        if past < -half * bend * y {
            let on = bend * (v[0] * v[0] + v[1] * v[1] - half * half) - 2.0 * y;
            (on / (norm([bend * x, bend * y - 1.0]) + norm([bend * half, 1.0]))).abs()
        } else {
            norm([past, y])
        }
    }
}

/// The length of a vector. It is faster than `hypot`, and nothing overflows here.
fn norm([x, y]: Point) -> f64 {
    (x * x + y * y).sqrt()
}

/// Ranges of columns and rows, or of the coordinates x and y.
type Ranges<T> = [[T; 2]; 2];

/// A grid of cells between lines, in sides of a cell from the corner of the box, and the pieces of
/// each cell.
struct Grid {
    lines: [Vec<f64>; 2],
    lists: Vec<Vec<usize>>,
    /// Each cell is cut in halves up to this many times.
    cuts: u32,
}

impl Grid {
    fn new(lines: [Vec<f64>; 2], cuts: u32) -> Self {
        let cells = lines.iter().map(|lines| lines.len() - 1).product();
        Self { lines, lists: vec![Vec::new(); cells], cuts }
    }

    fn region(&self, block: Ranges<usize>) -> Ranges<f64> {
        [0, 1].map(|axis| block[axis].map(|line| self.lines[axis][line]))
    }

    fn list(&mut self, column: usize, row: usize) -> &mut Vec<usize> {
        &mut self.lists[column + (self.lines[0].len() - 1) * row]
    }
}

/// The lines of the rings along an axis, and of the coarse columns or rows between them.
fn ring_lines(count: usize) -> Vec<f64> {
    let outside = |ring: i32| match ring {
        RINGS => FARTHEST,
        _ => (4_f64.powi(ring) - 1.0) / 3.0,
    };
    let below = (1..=RINGS).rev().map(|ring| -outside(ring));
    let inside = (0..count).step_by(COARSE).map(|line| line as f64);
    let above = (0..=RINGS).map(|ring| count as f64 + outside(ring));
    below.chain(inside).chain(above).collect()
}

struct Search {
    arcs: Vec<Arc>,
    counts: [usize; 2],
    /// For each piece, whether it may be nearest in the current cell.
    found: Vec<bool>,
    distances: usize,
}

impl Search {
    /// Fills the lists of a block of cells, whose items are among these.
    fn fill(&mut self, grid: &mut Grid, block: Ranges<usize>, among: &[usize]) {
        let region = grid.region(block);
        let [columns, rows] = block.map(|[first, last]| last - first);
        if columns * rows == 1 {
            *grid.list(block[0][0], block[1][0]) = self.of_regions(&[region], among, grid.cuts);
            return;
        }
        let near = self.nearest(region, among);
        let axis = usize::from(rows > columns);
        let [first, last] = block[axis];
        let middle = usize::midpoint(first, last);
        for range in [[first, middle], [middle, last]] {
            let mut half = block;
            half[axis] = range;
            self.fill(grid, half, &near);
        }
    }

    /// The pieces that may be nearest to a point of the box's border.
    fn of_border(&mut self, among: &[usize]) -> Vec<usize> {
        let [columns, rows] = self.counts.map(|count| count as f64);
        let (across, up) = ([0.0, columns], [0.0, rows]);
        let sides = [[across, [0.0; 2]], [across, [rows; 2]], [[0.0; 2], up], [[columns; 2], up]];
        self.of_regions(&sides, among, CUTS_OF_BORDER)
    }

    /// The pieces that may be nearest in some regions, each of which is cut in parts.
    fn of_regions(&mut self, regions: &[Ranges<f64>], among: &[usize], cuts: u32) -> Vec<usize> {
        self.found.fill(false);
        for &region in regions {
            self.find(region, among, cuts);
        }
        among.iter().copied().filter(|&piece| self.found[piece]).collect()
    }

    /// Marks the pieces that may be nearest in a region as found.
    fn find(&mut self, region: Ranges<f64>, among: &[usize], cuts: u32) {
        let near = self.nearest(region, among);
        if near.iter().all(|&piece| self.found[piece]) {
            return;
        }
        if near.len() <= FEW || cuts == 0 {
            near.into_iter().for_each(|piece| self.found[piece] = true);
            return;
        }
        let axis = usize::from(length(region[1]) > length(region[0]));
        let [lo, hi] = region[axis];
        let middle = middle(self.counts[axis], [lo, hi]);
        for range in [[lo, middle], [middle, hi]] {
            let mut half = region;
            half[axis] = range;
            self.find(half, &near, cuts - 1);
        }
    }

    /// Those of the pieces that may be nearest to a point in a region, all of which is within r of
    /// its middle. One piece is nearest to the middle. Another one is farther than it everywhere in
    /// the region if, at the middle, it is farther by more than r times [`Self::slope`].
    fn nearest(&mut self, region: Ranges<f64>, among: &[usize]) -> Vec<usize> {
        let middle = region.map(|[lo, hi]| f64::midpoint(lo, hi));
        let far = region.iter().flatten().fold(0.0_f64, |far, x| far.max(x.abs()));
        let radius = norm(region.map(length)) / 2.0 + ROUNDING[0] + ROUNDING[1] * far;
        self.distances += among.len();
        let distance = |&piece: &usize| (piece, self.arcs[piece].distance(middle));
        let distances: Vec<(usize, f64)> = among.iter().map(distance).collect();
        let nearest = distances.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
        let Some(nearest) = nearest else { return Vec::new() };
        let may_be_nearest = |&other: &(usize, f64)| {
            let farther = other.1 - nearest.1;
            farther <= 2.0 * radius && farther <= radius * self.slope(nearest, other, radius)
        };
        distances.into_iter().filter(may_be_nearest).map(|(piece, _)| piece).collect()
    }

    /// An upper bound of the slope of the difference of the distances to two pieces, within r of a
    /// point whose distances to them are given. It is the difference of two unit vectors, and
    /// `|x/|x| - y/|y|| <= 2 |x - y| / (|x| + |y|)` (Dunkl and Williams, "A simple norm
    /// inequality", 1964), where `|x - y|` is the distance between points of both pieces.
    fn slope(&self, one: (usize, f64), other: (usize, f64), r: f64) -> f64 {
        let apart = self.arcs[one.0].extent(&self.arcs[other.0]);
        let far = one.1 + other.1 - 2.0 * r;
        if far > apart { 2.0 * apart / far } else { 2.0 }
    }
}

/// Where a range is cut: far from the box, at the geometric mean of the distances from it.
fn middle(count: usize, [lo, hi]: [f64; 2]) -> f64 {
    let last = count as f64 - 1.0;
    if lo > last {
        last + ((lo - last) * (hi - last)).sqrt()
    } else if hi < 1.0 {
        1.0 - ((1.0 - lo) * (1.0 - hi)).sqrt()
    } else {
        f64::midpoint(lo, hi)
    }
}

fn length([lo, hi]: [f64; 2]) -> f64 {
    hi - lo
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arcs::arcs;
    use crate::outline::boundary;

    /// An oval with a notch in one half.
    fn outline() -> Vec<Curve> {
        let at = |i: f64, r: f64| {
            let turn = i * std::f64::consts::TAU / 24.0;
            [r * turn.cos(), 0.6 * r * turn.sin()]
        };
        let r = |i: i32| if i % 24 < 12 { 1.0 } else { 0.4 };
        let curve = |i: i32| {
            let x = f64::from(i);
            [at(x, r(i)), at(x + 0.5, 1.1 * r(i)), at(x + 1.0, r(i + 1))]
        };
        arcs(boundary((0..24).map(curve).collect())).iter().map(|piece| piece.curve).collect()
    }

    /// The cell at a point, by the formula of `_cell` in `std/regions.sdf`.
    fn cell(t: Point, counts: [usize; 2]) -> usize {
        let n = counts.map(|count| count as f64);
        let coarse = n.map(|n| (n / 4.0).ceil());
        let nearest = [0, 1].map(|axis| t[axis].floor().clamp(0.0, n[axis] - 1.0));
        let out = [0, 1].map(|axis| t[axis] - t[axis].clamp(0.0, n[axis]));
        if out == [0.0; 2] {
            return (nearest[0] + n[0] * nearest[1]) as usize;
        }
        let k = [0, 1].map(|axis| {
            let ring = ((1.0 + 3.0 * out[axis].abs()).log2() / 2.0).ceil().min(5.0);
            (nearest[axis] / 4.0).floor() + ring.copysign(out[axis]) + 5.0
        });
        (n[0] * n[1] + k[0] + (coarse[0] + 10.0) * k[1]) as usize
    }

    #[test]
    fn the_nearest_piece_of_any_point_is_in_its_cell() {
        let curves = outline();
        // Four cells for each piece, as in the library.
        let side = (2.2_f64 * 1.4 / (4.0 * curves.len() as f64)).sqrt();
        let counts = [2.2, 1.4].map(|size: f64| (size / side).ceil() as usize);
        let layout = Layout { corner: [-1.1, -0.7], side, counts };
        let cells = cells(&curves, layout);
        let all: Vec<Arc> = curves.iter().map(|&curve| Arc::new(curve)).collect();
        for reach in [1.5, 1.5, 4.0, 30.0, 1e3, 1e5] {
            for i in 0..20_000 {
                // A lattice whose points are spread evenly.
                let steps = [0.754_877_666_246_693, 0.569_840_290_998_053];
                let p = steps.map(|step| reach * (2.0 * (step * f64::from(i)).fract() - 1.0));
                let t = [0, 1].map(|axis| (p[axis] - layout.corner[axis]) / side);
                let cell = cell(t, counts);
                let items = &cells.items[cells.starts[cell]..cells.starts[cell + 1]];
                let nearest = all.iter().map(|arc| arc.distance(p)).fold(f64::INFINITY, f64::min);
                let found = items.iter().map(|&item| all[item].distance(p));
                let found = found.fold(f64::INFINITY, f64::min);
                assert!(found <= nearest + 1e-12 * reach, "{p:?}: {found} instead of {nearest}");
            }
        }
        let mean = cells.items.len() / curves.len();
        assert!(mean < 50, "{mean} items for each piece");
    }
}
