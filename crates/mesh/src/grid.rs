//! The grid of whole numbers that cells, faces and edges lie on.

use crate::vector::Vec3;

/// A position on the grid, in units of the smallest cell.
pub(crate) type Corner = [u32; 3];

/// A cube of the octree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Cell {
    /// The lowest corner.
    pub(crate) at: Corner,
    /// The side, a power of two.
    pub(crate) size: u32,
}

/// A square between two cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Face {
    pub(crate) at: Corner,
    pub(crate) size: u32,
    /// The axis that the face is orthogonal to.
    pub(crate) axis: u8,
}

/// A segment along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Edge {
    pub(crate) at: Corner,
    pub(crate) size: u32,
    pub(crate) axis: u8,
}

/// Returns a position moved along an axis.
fn moved(mut at: Corner, axis: usize, by: u32) -> Corner {
    at[axis] += by;
    at
}

impl Cell {
    fn corners(self) -> [Corner; 8] {
        std::array::from_fn(|i| {
            std::array::from_fn(|axis| self.at[axis] + self.size * (i as u32 >> axis & 1))
        })
    }

    /// Returns the side in the plane z = 0, which is the whole cell of a flat grid.
    pub(crate) fn base(self) -> Face {
        self.side(2, false)
    }

    /// Returns the lower or the upper side along an axis.
    pub(crate) fn side(self, axis: u8, is_upper: bool) -> Face {
        let by = if is_upper { self.size } else { 0 };
        Face { at: moved(self.at, usize::from(axis), by), size: self.size, axis }
    }

    /// Returns the lowest corners of the cells of this size that share a face or an edge with it,
    /// of those within a grid.
    pub(crate) fn beside(self, grid: &Grid) -> impl Iterator<Item = Corner> + use<> {
        let (cell, end) = (self, grid.size);
        let corner = move |index: i64| {
            let steps = [index % 3 - 1, index / 3 % 3 - 1, index / 9 - 1];
            let is_shared = matches!(steps.iter().filter(|step| **step == 0).count(), 1 | 2);
            let mut at = cell.at;
            for axis in 0..3 {
                let x = i64::from(at[axis]) + steps[axis] * i64::from(cell.size);
                at[axis] = u32::try_from(x).ok().filter(|x| *x < end)?;
            }
            is_shared.then_some(at)
        };
        (0..27).filter_map(corner)
    }

    /// Returns bits of the sides that contain a position: `1 << 2 * axis` for the lower one.
    pub(crate) fn sides(self, at: Corner) -> u8 {
        let mut sides = 0;
        for axis in 0..3 {
            sides |= u8::from(at[axis] == self.at[axis]) << (2 * axis);
            sides |= u8::from(at[axis] == self.at[axis] + self.size) << (2 * axis + 1);
        }
        sides
    }
}

impl Face {
    /// Returns the cells below and above that have the face's size. The face at the lower limit of
    /// the grid has none below.
    pub(crate) fn cells(self) -> [Option<Cell>; 2] {
        let axis = usize::from(self.axis);
        let below = self.at[axis].checked_sub(self.size).map(|x| {
            let mut at = self.at;
            at[axis] = x;
            Cell { at, size: self.size }
        });
        [below, Some(Cell { at: self.at, size: self.size })]
    }

    pub(crate) fn quarters(self) -> [Self; 4] {
        let size = self.size / 2;
        let [u, v] = self.plane();
        std::array::from_fn(|i| {
            let at = moved(self.at, u, size * (i as u32 & 1));
            Self { at: moved(at, v, size * (i as u32 >> 1)), size, axis: self.axis }
        })
    }

    /// Returns the axes of the face's plane, so that `axis` and they are right-handed.
    pub(crate) fn plane(self) -> [usize; 2] {
        let axis = usize::from(self.axis);
        [(axis + 1) % 3, (axis + 2) % 3]
    }

    /// Returns the sides, counter-clockwise as seen from above. The flag tells if a side is run
    /// through against its axis.
    pub(crate) fn sides(self) -> [(Edge, bool); 4] {
        let [u, v] = self.plane();
        let edge = |at, axis: usize| Edge { at, size: self.size, axis: axis as u8 };
        [
            (edge(self.at, u), false),
            (edge(moved(self.at, u, self.size), v), false),
            (edge(moved(self.at, v, self.size), u), true),
            (edge(self.at, v), true),
        ]
    }
}

impl Edge {
    pub(crate) fn ends(self) -> [Corner; 2] {
        [self.at, moved(self.at, usize::from(self.axis), self.size)]
    }

    pub(crate) fn halves(self) -> [Self; 2] {
        let size = self.size / 2;
        let upper = moved(self.at, usize::from(self.axis), size);
        [Self { size, ..self }, Self { at: upper, size, ..self }]
    }

    /// Returns the cells of the edge's size around it.
    pub(crate) fn cells(self) -> impl Iterator<Item = Cell> {
        let axis = usize::from(self.axis);
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        (0..4).filter_map(move |i| {
            let mut at = self.at;
            at[u] = at[u].checked_sub(if i & 1 == 1 { self.size } else { 0 })?;
            at[v] = at[v].checked_sub(if i & 2 == 2 { self.size } else { 0 })?;
            Some(Cell { at, size: self.size })
        })
    }

    /// Returns bits of the sides of a cell that contain the edge without its ends.
    pub(crate) fn sides_in(self, cell: Cell) -> u8 {
        let own = 3 << (2 * self.axis);
        cell.sides(self.at) & !own
    }
}

/// Where the grid lies in the scene or in a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    /// The position of the corner 0, a multiple of a sixteenth of `unit`.
    pub(crate) origin: Vec3,
    /// The side of the smallest cell, a power of two.
    pub(crate) unit: f64,
    /// The side of the whole grid in units, a power of two.
    pub(crate) size: u32,
    /// True if all positions on the grid are 32-bit floats.
    pub(crate) is_single: bool,
    /// True if the grid lies in the plane z = 0: its cells are squares.
    pub(crate) is_flat: bool,
}

/// Half the thickness of a flat grid, as a fraction of the error.
const THICKNESS: f64 = 1e-3;
/// The whole grid has at most this many cells along an axis.
pub(crate) const MAX_SIDE: u32 = 1 << 24;
/// A grid coordinate is at most this many sixteenths of a unit from the origin.
const SINGLE_STEPS: f64 = 16_777_216.0;
const DOUBLE_STEPS: f64 = 9e15 / 65_536.0;

impl Grid {
    /// Returns the grid around a box whose smallest cell is at most a quarter of `error`; `None` if
    /// f64 has too few digits for it, or if it has more than [`MAX_SIDE`] cells along an axis.
    pub(crate) fn around([lo, hi]: [Vec3; 2], error: f64) -> Option<Self> {
        let unit = (0.25 * error).log2().floor().exp2();
        let step = unit / 16.0;
        let extent = (0..3).fold(0.0, |extent: f64, axis| extent.max(hi[axis] - lo[axis]));
        let cells = (extent / unit * 1.02 + 8.0).ceil();
        let is_small = cells <= f64::from(MAX_SIDE);
        if !is_small {
            return None;
        }
        let size = (cells as u32).next_power_of_two();
        // An odd number of steps keeps round numbers of the scene off the planes of the grid.
        let spare = f64::from(size) - extent / unit;
        let shift = (spare * 0.41 * 16.0).floor() * step + 5.0 * step;
        let origin = lo.map(|x| (x / step).floor() * step - shift);
        let end = f64::from(size) * unit;
        let greatest = origin.iter().fold(0.0, |a: f64, x| a.max(x.abs()).max((x + end).abs()));
        let steps = greatest / step;
        let fits = steps <= DOUBLE_STEPS && unit.is_normal();
        let is_single = steps <= SINGLE_STEPS && unit > 1e-30;
        fits.then_some(Self { origin, unit, size, is_single, is_flat: false })
    }

    /// Returns the same for a rectangle in the plane z = 0.
    pub(crate) fn around_flat([lo, hi]: [[f64; 2]; 2], error: f64) -> Option<Self> {
        let [lo, hi] = [lo, hi].map(|[x, y]| [x, y, 0.0]);
        let grid = Self::around([lo, hi], error)?;
        Some(Self { origin: [grid.origin[0], grid.origin[1], 0.0], is_flat: true, ..grid })
    }

    pub(crate) fn root(&self) -> Cell {
        Cell { at: [0; 3], size: self.size }
    }

    /// Returns the box in which the error is proven: the whole grid. A flat grid is a little thick,
    /// so that boxes and walls meet in spite of rounding.
    pub(crate) fn proof_bounds(&self, error: f64) -> [Vec3; 2] {
        let [mut lo, mut hi] = self.bounds(self.root());
        if self.is_flat {
            lo[2] = -THICKNESS * error;
            hi[2] = THICKNESS * error;
        }
        [lo, hi]
    }

    /// Returns the cells that a cell is divided into: eight, or four of a flat grid.
    pub(crate) fn children(&self, cell: Cell) -> impl Iterator<Item = Cell> + use<> {
        let size = cell.size / 2;
        Cell { size, ..cell }
            .corners()
            .into_iter()
            .take(self.count())
            .map(move |at| Cell { at, size })
    }

    /// Returns the corners of a cell: eight, or four of a flat grid.
    pub(crate) fn corners(&self, cell: Cell) -> impl Iterator<Item = Corner> + use<> {
        cell.corners().into_iter().take(self.count())
    }

    fn count(&self) -> usize {
        if self.is_flat { 4 } else { 8 }
    }

    pub(crate) fn position(&self, at: Corner) -> Vec3 {
        std::array::from_fn(|axis| self.origin[axis] + f64::from(at[axis]) * self.unit)
    }

    pub(crate) fn length(&self, size: u32) -> f64 {
        f64::from(size) * self.unit
    }

    pub(crate) fn bounds(&self, cell: Cell) -> [Vec3; 2] {
        let lo = self.position(cell.at);
        let mut hi = lo.map(|x| x + self.length(cell.size));
        if self.is_flat {
            hi[2] = lo[2];
        }
        [lo, hi]
    }

    /// Returns the distance that vertices keep from the ends of edges and the sides of faces and
    /// cells.
    pub(crate) fn margin(&self, size: u32) -> f64 {
        (self.length(size) / 32.0).min(self.unit / 8.0)
    }

    /// Rounds a vertex to 32-bit floats if the whole grid consists of such.
    pub(crate) fn rounded(&self, point: Vec3) -> Vec3 {
        if self.is_single { point.map(|x| f64::from(x as f32)) } else { point }
    }
}
