//! How fine the cells of one picture are.

use super::cell::Cell;
use crate::view::View;
use crate::view::footprint::Footprint;

/// A cell whose side is at most this many pixels wide is not divided; more where a division costs
/// more or gains less.
const FINEST_PIXELS: f64 = 16.0;
/// Tapes with fewer operations are not shortened further.
const FEW_OPERATIONS: usize = 40;

/// How fine the cells of one picture are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    eye: [f64; 3],
    footprint: Footprint,
    /// True if cells are divided to prove that they hold no surface.
    proves: bool,
}

impl Sight {
    pub(super) fn new(view: &View, proves: bool) -> Self {
        Self { eye: view.eye.to_array(), footprint: view.footprint(), proves }
    }

    /// True if smaller cells take a cell's place.
    pub(super) fn divides(&self, cell: &Cell) -> bool {
        let is_worth = self.proves || cell.operations() >= FEW_OPERATIONS;
        if cell.is_free() || !is_worth {
            return false;
        }
        let finest = if self.proves { FINEST_PIXELS } else { FINEST_PIXELS * cell.price.sqrt() };
        let width = 2.0 * self.footprint.at(cell.cube.distance(self.eye));
        2.0 * cell.cube.half > finest * width
    }
}
