//! The squares of pixels that share a shorter formula of a planar picture.
//!
//! Each square holds the tape of the pixels in it, from one evaluation in affine arithmetic: it
//! leaves out the operands that cannot matter there. A square that shows one colour has none. So a
//! large formula is examined once for each square and not for each pixel.

use std::sync::{Arc, OnceLock};

use sdfc_graph::eval::{Affine, FrameValues, RootsOver, Tape};

use crate::view::View;

/// Sides of the squares in pixels, each a part of the one before.
const SIDES: [u32; 3] = [128, 64, 32];
/// The side of the smallest squares.
pub(super) const FINEST: u32 = SIDES[SIDES.len() - 1];
/// A square is divided if its formula has this many operations.
const MIN_OPERATIONS: usize = 24;
/// Squares overlap by this fraction of their distance from the origin, for the rounding of points
/// in f32.
const MARGIN: f64 = 1e-6;

/// What the pixels of a square show.
#[derive(Clone, Debug)]
pub(super) enum Shown {
    /// Linear red, green and blue, and a number with the sign of the distance, all the same.
    Same([f32; 4]),
    /// The values of this formula.
    Formula(Arc<Tape>),
}

/// The squares of one picture. They are made when they are first needed.
#[derive(Debug)]
pub(super) struct PlanarCells<'a> {
    view: &'a View,
    frame: &'a FrameValues,
    whole: Shown,
    levels: Vec<Level>,
}

/// The squares of one side, row by row.
#[derive(Debug)]
struct Level {
    side: u32,
    columns: u32,
    squares: Vec<OnceLock<Shown>>,
}

impl<'a> PlanarCells<'a> {
    /// The squares of a picture whose pixels are computed by a tape.
    pub(super) fn new(tape: &Arc<Tape>, view: &'a View, frame: &'a FrameValues) -> Self {
        let level = |side: u32| {
            let [columns, rows] = view.size.map(|length| length.div_ceil(side));
            let squares = (0..columns as usize * rows as usize).map(|_| OnceLock::new()).collect();
            Level { side, columns, squares }
        };
        let levels = SIDES.into_iter().map(level).collect();
        Self { view, frame, whole: Shown::Formula(Arc::clone(tape)), levels }
    }

    /// What is shown around a pixel.
    pub(super) fn at(&self, pixel: [u32; 2]) -> &Shown {
        let mut around = &self.whole;
        for level in &self.levels {
            let Shown::Formula(tape) = around else { return around };
            if tape.operations() < MIN_OPERATIONS {
                return around;
            }
            let [column, row] = pixel.map(|place| place / level.side);
            let index = row as usize * level.columns as usize + column as usize;
            let Some(square) = level.squares.get(index) else { return around };
            around = square.get_or_init(|| self.examine(tape, [column, row], level.side));
        }
        around
    }

    /// What a square shows, given the formula around it.
    fn examine(&self, around: &Arc<Tape>, [column, row]: [u32; 2], side: u32) -> Shown {
        let [first, last] = [0, side - 1].map(|offset| {
            let [x, y] = [column * side + offset, row * side + offset];
            self.view.ray(x, y)[0]
        });
        let across = self.view.right.normalize_or_zero();
        let upward = self.view.up.normalize_or_zero();
        let (center, diagonal) = ((first + last) / 2.0, (last - first) / 2.0);
        let halves = [across, upward].map(|axis| axis * diagonal.dot(axis).abs());
        let margin = MARGIN * (center.length() + diagonal.length());
        let middle = [0, 1, 2].map(|axis| {
            let slopes = [halves[0][axis], halves[1][axis]]
                .map(|slope| if slope < 0.0 { slope - margin } else { slope + margin });
            Affine::coordinate(center[axis], [slopes[0], slopes[1], 0.0])
        });
        // The width of a pixel is rounded, too.
        let width = 2.0 * self.view.footprint().radius;
        let width = Affine::coordinate(width, [0.0, 0.0, MARGIN * width]);
        let over = around.over_rays(self.frame, [middle, [width; 3]]);
        if let Some(shown) = same(&over) {
            return Shown::Same(shown);
        }
        let shorter = over.tape.filter(|tape| tape.operations() < around.operations());
        Shown::Formula(shorter.map_or_else(|| Arc::clone(around), Arc::new))
    }
}

/// What is shown everywhere, if the colour is the same and the distance keeps its sign.
fn same(over: &RootsOver) -> Option<[f32; 4]> {
    let [lanes] = over.values.as_slice() else { return None };
    let [red, green, blue, distance] = lanes.map(|lane| lane.range());
    let color = [red, green, blue];
    if !color.iter().all(|range| range.lo() == range.hi()) {
        return None;
    }
    let sign = if distance.lo() > 0.0 {
        1.0
    } else if distance.hi() < 0.0 {
        -1.0
    } else {
        return None;
    };
    let [red, green, blue] = color.map(|range| range.lo() as f32);
    Some([red, green, blue, sign])
}
