//! The octree of the CPU renderer's cells, which grows where rays and points ask for it.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use sdfc_graph::eval::{Affine, FieldOver, FrameValues, Tape};

use super::cell::{Cell, Cube};
use crate::view::View;
use crate::view::footprint::Footprint;

/// A cell whose side is at most this many pixels wide is not divided; more where a division costs
/// more or gains less.
const FINEST_PIXELS: f64 = 16.0;
/// The least part of a tape that a division is expected to leave out.
const LEAST_SHARE: f64 = 0.05;
/// A shorter tape has at most this fraction of the operations.
const SHORTER: f64 = 0.75;
/// Tapes with fewer operations are not shortened further.
const FEW_OPERATIONS: usize = 40;
/// Cells that are larger in the picture than this fraction of it are divided at once: the tape is
/// seldom shorter there.
const COARSEST: f64 = 0.5;
/// The maximum number of divisions from the root to a cell.
const MAX_DEPTH: u32 = 20;
/// Half the side of the root in lengths of rays: a ray that starts at the end of another one stays
/// in it.
const ROOT_RAYS: f64 = 2.0;
/// Cells overlap by this fraction of the root, for the rounding of points in f32.
const MARGIN: f64 = 4e-6;
/// The maximum number of operations of all shorter tapes together; beyond it no tape is shortened.
/// It keeps them below 600 MB.
const MAX_OPERATIONS: usize = 1 << 25;

/// A cube of the octree. Its contents are made when they are first needed.
#[derive(Debug, Default)]
struct Node {
    cell: OnceLock<Cell>,
    children: OnceLock<Box<[Node; 8]>>,
}

/// The cubes around the eye.
#[derive(Debug)]
pub(super) struct Octree {
    cube: Cube,
    root: Node,
    margin: f64,
    eye: [f64; 3],
    footprint: Footprint,
    /// The larger side of the picture.
    pixels: f64,
    /// Number of operations of all shorter tapes.
    operations: AtomicUsize,
    /// True if cells are divided to prove that they hold no surface.
    proves: bool,
}

impl Octree {
    /// An octree around the eye.
    pub(super) fn new(view: &View, proves: bool) -> Self {
        let (center, half) = (view.eye.to_array(), ROOT_RAYS * view.t_max);
        let extent = half + center.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        Self {
            cube: Cube { center, half },
            root: Node::default(),
            margin: MARGIN * extent,
            eye: center,
            footprint: view.footprint(),
            pixels: f64::from(view.size[0].max(view.size[1])),
            operations: AtomicUsize::new(0),
            proves,
        }
    }

    pub(super) fn contains(&self, point: [f64; 3]) -> bool {
        self.cube.contains(point)
    }

    /// The smallest cell around a point.
    pub(super) fn at<'c>(
        &'c self,
        whole: &'c Cell,
        frame: &FrameValues,
        point: [f64; 3],
    ) -> &'c Cell {
        let (mut node, mut cube, mut around) = (&self.root, self.cube, whole);
        for depth in 0.. {
            let cell = node.cell.get_or_init(|| self.examine(around, frame, cube, depth));
            around = cell;
            if !cell.is_divided {
                break;
            }
            let (index, child) = cube.child(point);
            (node, cube) = (&node.children.get_or_init(Box::default)[index], child);
        }
        around
    }

    /// The cell of a cube, given the cell around it.
    fn examine(&self, around: &Cell, frame: &FrameValues, cube: Cube, depth: u32) -> Cell {
        let side = 2.0 * cube.half;
        let width = 2.0 * self.footprint.at(cube.distance(self.eye));
        let is_open = depth < MAX_DEPTH && side > 64.0 * self.margin;
        if is_open && side > COARSEST * self.pixels * width {
            return Cell { cube, is_divided: true, ..Cell::everything(&around.tape) };
        }
        let over = around.tape.over(frame, cube.coordinates(self.margin));
        let is_free = over.value.range().lo() > 0.0;
        let (tape, price) = self.shortened(around, frame, cube, over);
        let finest = if self.proves { FINEST_PIXELS } else { FINEST_PIXELS * price.sqrt() };
        let is_worth = self.proves || tape.operations() >= FEW_OPERATIONS;
        let is_divided = !is_free && is_worth && is_open && side > finest * width;
        Cell { cube, tape, is_free: is_free && self.proves, is_divided }
    }

    /// The tape of a cube, and the price of another division: the number of operations that it
    /// takes for each operation at a point that it is expected to save.
    fn shortened(
        &self,
        around: &Cell,
        frame: &FrameValues,
        cube: Cube,
        FieldOver { tape, operations, .. }: FieldOver,
    ) -> (Arc<Tape>, f64) {
        let has_loops = around.tape.has_loops();
        // A loop may run fewer iterations at a point than it can run in the cube.
        let at_point = if has_loops {
            let middle = cube.center.map(|x| Affine::coordinate(x, [0.0; 3]));
            operations.min(around.tape.over(frame, middle).operations)
        } else {
            operations
        };
        let at_point = at_point.max(1) as f64;
        // Straight code of the same length is faster than a loop over lists.
        let most = if has_loops { at_point } else { SHORTER * at_point };
        let shorter = tape.filter(|tape| tape.operations() as f64 <= most).filter(|tape| {
            let stored = self.operations.fetch_add(tape.operations(), Ordering::Relaxed);
            stored < MAX_OPERATIONS
        });
        // The next division is expected to leave out the same part as this one.
        let left = shorter.as_ref().map_or(at_point, |tape| tape.operations() as f64);
        let price = operations as f64 / at_point / (1.0 - left / at_point).max(LEAST_SHARE);
        (shorter.map_or_else(|| Arc::clone(&around.tape), Arc::new), price)
    }
}
