//! A cell of space, with the field there.

use std::sync::{Arc, OnceLock};

use sdfc_graph::eval::{Affine, FrameValues, Interval, Tape};

/// A cube, parallel to the axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cube {
    pub(crate) center: [f64; 3],
    pub(crate) half: f64,
}

impl Cube {
    pub(crate) fn contains(&self, point: [f64; 3]) -> bool {
        (0..3).all(|axis| (point[axis] - self.center[axis]).abs() <= self.half)
    }

    /// The index of the child that contains a point: bit 0 is set in the upper half along x, bit 1
    /// along y, bit 2 along z.
    pub(super) fn child_around(&self, point: [f64; 3]) -> usize {
        (0..3).map(|axis| usize::from(point[axis] >= self.center[axis]) << axis).sum()
    }

    /// The child with an index.
    pub(super) fn child_at(&self, index: usize) -> Self {
        let half = 0.5 * self.half;
        let shift = |axis: usize| if index >> axis & 1 == 1 { half } else { -half };
        Self { center: [0, 1, 2].map(|axis| self.center[axis] + shift(axis)), half }
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

/// Bound of the rounding of a number in f32, in parts of it.
const ROUNDING: f64 = 1e-6;

/// A number that is taken for infinite, but is finite in f32.
const UNBOUNDED: f64 = 1e30;

/// A cell of space, with the field there.
#[derive(Debug)]
pub(crate) struct Cell {
    /// Infinite for all of space.
    pub(crate) cube: Cube,
    /// The field there.
    pub(super) tape: Arc<Tape>,
    /// The field in the cube, which is larger by the margin of the octree.
    pub(super) form: Affine,
    pub(super) margin: f64,
    /// Bounds of its gradient there, if there are any.
    gradient: OnceLock<Option<[Interval; 3]>>,
    /// The number of operations that a division takes for each operation that it is expected to
    /// save at a point.
    pub(super) price: f64,
}

impl Cell {
    pub(super) fn new(cube: Cube, margin: f64, tape: Arc<Tape>, form: Affine, price: f64) -> Self {
        Self { cube, tape, form, margin, gradient: OnceLock::new(), price }
    }

    pub(super) fn everything(tape: &Arc<Tape>) -> Self {
        let cube = Cube { center: [0.0; 3], half: f64::INFINITY };
        let unknown = Affine::coordinate(f64::NAN, [0.0; 3]);
        Self::new(cube, 0.0, Arc::clone(tape), unknown, 1.0)
    }

    /// A number that two cells share if they have one tape.
    pub(crate) fn id(&self) -> usize {
        Arc::as_ptr(&self.tape).addr()
    }

    /// True if there is no surface in the cell: the field is positive.
    pub(crate) fn is_free(&self) -> bool {
        self.form.range().lo() > 0.0
    }

    /// A linear function and the greatest difference of the field from it, also where the function
    /// is computed in f32 from points of a ray: the value at the center of the cube, the gradient,
    /// and the difference. The difference is [`UNBOUNDED`] if there are no bounds.
    pub(crate) fn linear(&self) -> (f64, [f64; 3], f64) {
        let (value, slopes, error) = self.form.terms();
        let slopes = slopes.map(|slope| slope / (self.cube.half + self.margin));
        let size: f64 = slopes.iter().map(|slope| slope.abs()).sum();
        let error = error + self.margin * size + ROUNDING * value.abs();
        if error < UNBOUNDED { (value, slopes, error) } else { (0.0, [0.0; 3], UNBOUNDED) }
    }

    /// Bounds of the gradient of the field in the cell; `None` if it has no bounds.
    pub(crate) fn gradient(&self, frame: &FrameValues) -> Option<[Interval; 3]> {
        let region = || self.cube.coordinates(self.margin).map(|axis| axis.range());
        *self.gradient.get_or_init(|| self.tape.gradient_over(frame, region()))
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
