//! A cell of space, with the field there.

use std::sync::Arc;

use sdfc_graph::eval::{Affine, Tape};

/// A cube, parallel to the axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cube {
    pub(super) center: [f64; 3],
    pub(super) half: f64,
}

impl Cube {
    pub(super) fn contains(&self, point: [f64; 3]) -> bool {
        (0..3).all(|axis| (point[axis] - self.center[axis]).abs() <= self.half)
    }

    /// The index of the child that contains a point, and its cube.
    pub(super) fn child(&self, point: [f64; 3]) -> (usize, Self) {
        let half = 0.5 * self.half;
        let (mut index, mut center) = (0, self.center);
        for axis in 0..3 {
            let is_upper = point[axis] >= self.center[axis];
            index |= usize::from(is_upper) << axis;
            center[axis] += if is_upper { half } else { -half };
        }
        (index, Self { center, half })
    }

    /// The distance to a point.
    pub(super) fn distance(&self, point: [f64; 3]) -> f64 {
        let beyond = |axis: usize| ((point[axis] - self.center[axis]).abs() - self.half).max(0.0);
        (0..3).map(|axis| beyond(axis).powi(2)).sum::<f64>().sqrt()
    }

    /// The coordinates of its points, grown by a margin.
    pub(super) fn coordinates(&self, margin: f64) -> [Affine; 3] {
        [0, 1, 2].map(|axis| {
            let mut slopes = [0.0; 3];
            slopes[axis] = self.half + margin;
            Affine::coordinate(self.center[axis], slopes)
        })
    }
}

/// A cell of space, with the field there.
#[derive(Debug)]
pub(crate) struct Cell {
    /// Infinite for all of space.
    pub(super) cube: Cube,
    /// The field there.
    pub(super) tape: Arc<Tape>,
    /// A lower bound of the field in the cube.
    pub(super) least: f64,
    /// The number of operations that a division takes for each operation that it is expected to
    /// save at a point.
    pub(super) price: f64,
}

impl Cell {
    pub(super) fn everything(tape: &Arc<Tape>) -> Self {
        Self {
            cube: Cube { center: [0.0; 3], half: f64::INFINITY },
            tape: Arc::clone(tape),
            least: f64::NEG_INFINITY,
            price: 1.0,
        }
    }

    /// A number that two cells share if they have one tape.
    pub(crate) fn id(&self) -> usize {
        Arc::as_ptr(&self.tape).addr()
    }

    /// True if there is no surface in the cell: the field is positive.
    pub(crate) fn is_free(&self) -> bool {
        self.least > 0.0
    }

    /// The number of operations of the field there.
    pub(crate) fn operations(&self) -> usize {
        self.tape.operations()
    }

    /// The positions between which a ray is in the cell.
    pub(crate) fn span(&self, [origin, direction]: [[f64; 3]; 2]) -> [f64; 2] {
        let mut span = [f64::NEG_INFINITY, f64::INFINITY];
        for axis in 0..3 {
            if direction[axis] != 0.0 {
                let middle = (self.cube.center[axis] - origin[axis]) / direction[axis];
                let reach = self.cube.half / direction[axis].abs();
                span = [span[0].max(middle - reach), span[1].min(middle + reach)];
            }
        }
        span
    }
}
