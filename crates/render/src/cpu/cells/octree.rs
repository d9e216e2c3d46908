//! The octree of the CPU renderer's cells, which grows where rays and points ask for it.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use sdfc_graph::eval::{Affine, FieldOver, FrameValues, Tape};

use super::cell::{Cell, Cube};
use super::sight::Sight;
use crate::view::View;

/// The least part of a tape that a division is expected to leave out.
const LEAST_SHARE: f64 = 0.05;
/// A shorter tape has at most this fraction of the operations.
const SHORTER: f64 = 0.75;
/// Cells of these first levels are divided at once: they are too large to tell anything.
const COARSE_LEVELS: u32 = 3;
/// The maximum number of divisions from the root to a cell.
const MAX_DEPTH: u32 = 24;
/// The root reaches from the origin to this many lengths of rays behind the eye, or to the next
/// power of two: a ray that starts at the end of another one stays in it.
const ROOT_RAYS: f64 = 2.0;
/// The middle of the root, in halves of its side: scenes often have surfaces in the planes through
/// the origin, which would then lie in two cells.
const ROOT_CENTER: [f64; 3] = [0.013, 0.017, 0.011];
/// Cells overlap by this fraction of the root, for the rounding of points in f32.
const MARGIN: f64 = 4e-6;
/// The maximum number of operations of all shorter tapes together; beyond it no tape is shortened.
/// It keeps them below 600 MB.
const MAX_OPERATIONS: usize = 1 << 25;
/// The memory of a cell, in operations.
const CELL_OPERATIONS: usize = 8;

/// A cube of the octree. Its contents are made when they are first needed.
#[derive(Debug, Default)]
struct Node {
    cell: OnceLock<Cell>,
    children: OnceLock<Box<[Node; 8]>>,
}

/// A node, its cube and its depth.
#[derive(Clone, Copy)]
struct Place<'c> {
    node: &'c Node,
    cube: Cube,
    depth: u32,
}

/// Rays whose directions have the same signs.
pub(crate) trait Beam<'c> {
    /// The index of the child of a cube that all rays of the beam pass before any other one.
    fn first_child(&self) -> usize;
    /// False if no ray passes a cube that is grown by a margin.
    fn passes(&self, cube: &Cube, margin: f64) -> bool;
    /// Visits a cell; breaks if no ray is left.
    fn visit(&mut self, cell: &'c Cell) -> ControlFlow<()>;
}

/// The cubes around the origin, for one field and the values of one frame. A cell depends on these
/// and the root alone: not on the camera, nor on the order in which cells are made, as long as
/// [`MAX_OPERATIONS`] suffice.
#[derive(Debug)]
pub(super) struct Octree {
    cube: Cube,
    root: Node,
    margin: f64,
    whole: Cell,
    frame: FrameValues,
    /// The per-frame values that the field depends on.
    inputs: Vec<f64>,
    /// Memory of all cells, in operations.
    operations: AtomicUsize,
}

impl Octree {
    /// An octree around the eye.
    pub(super) fn new(tape: &Arc<Tape>, frame: &FrameValues, view: &View) -> Self {
        let half = root_half(view);
        Self {
            cube: Cube { center: ROOT_CENTER.map(|part| part * half), half },
            root: Node::default(),
            margin: MARGIN * half,
            whole: Cell::everything(tape),
            frame: frame.clone(),
            inputs: tape.point_inputs(frame),
            operations: AtomicUsize::new(0),
        }
    }

    /// True if a frame with these values and this view has the same cells.
    pub(super) fn serves(&self, frame: &FrameValues, view: &View) -> bool {
        let inputs = self.whole.tape.point_inputs(frame);
        let is_same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
        self.cube.half.to_bits() == root_half(view).to_bits()
            && self.inputs.iter().zip(&inputs).all(is_same)
    }

    /// True if a ray of this length is in the octree, whatever its direction is.
    pub(super) fn surrounds(&self, origin: [f64; 3], length: f64) -> bool {
        let reach = |axis: usize| (origin[axis] - self.cube.center[axis]).abs() + length;
        (0..3).all(|axis| reach(axis) <= self.cube.half)
    }

    /// The memory of all cells, in operations of tapes.
    pub(super) fn operations(&self) -> usize {
        self.operations.load(Ordering::Relaxed)
    }

    /// The smallest cell around a point for an eye; all of space for a point outside.
    pub(super) fn at(&self, sight: &Sight, point: [f64; 3]) -> &Cell {
        let (mut node, mut cube, mut around) = (&self.root, self.cube, &self.whole);
        if !cube.contains(point) {
            return around;
        }
        for depth in 0..=MAX_DEPTH {
            if depth >= COARSE_LEVELS {
                around = node.cell.get_or_init(|| self.examine(around, cube));
                if !(self.may_divide(cube, depth) && sight.divides(around)) {
                    break;
                }
            }
            let index = cube.child_around(point);
            node = &node.children.get_or_init(Box::default)[index];
            cube = cube.child_at(index);
        }
        around
    }

    /// Visits the smallest cells for an eye which a beam passes and which may contain a surface,
    /// in the order of the beam.
    pub(super) fn visit<'c>(&'c self, sight: &Sight, beam: &mut impl Beam<'c>) {
        let root = Place { node: &self.root, cube: self.cube, depth: 0 };
        // A break means that no ray is left.
        let _ = self.visit_in(sight, beam, root, &self.whole);
    }

    fn visit_in<'c>(
        &'c self,
        sight: &Sight,
        beam: &mut impl Beam<'c>,
        Place { node, cube, depth }: Place<'c>,
        mut around: &'c Cell,
    ) -> ControlFlow<()> {
        if !beam.passes(&cube, self.margin) {
            return ControlFlow::Continue(());
        }
        if depth >= COARSE_LEVELS {
            around = node.cell.get_or_init(|| self.examine(around, cube));
            if around.is_free() {
                return ControlFlow::Continue(());
            }
            if !(self.may_divide(cube, depth) && sight.divides(around)) {
                return beam.visit(around);
            }
        }
        let children = node.children.get_or_init(Box::default);
        let first = beam.first_child();
        for index in (0..8).map(|index| index ^ first) {
            let place =
                Place { node: &children[index], cube: cube.child_at(index), depth: depth + 1 };
            self.visit_in(sight, beam, place, around)?;
        }
        ControlFlow::Continue(())
    }

    fn may_divide(&self, cube: Cube, depth: u32) -> bool {
        depth < MAX_DEPTH && 2.0 * cube.half > 64.0 * self.margin
    }

    /// The cell of a cube, given the cell around it.
    fn examine(&self, around: &Cell, cube: Cube) -> Cell {
        let over = around.tape.over(&self.frame, cube.coordinates(self.margin));
        let form = over.value;
        let (tape, price) = self.shortened(around, cube, over);
        self.operations.fetch_add(CELL_OPERATIONS, Ordering::Relaxed);
        Cell::new(cube, self.margin, tape, form, price)
    }

    /// The tape of a cube, and the price of another division: the number of operations that it
    /// takes for each operation at a point that it is expected to save.
    fn shortened(
        &self,
        around: &Cell,
        cube: Cube,
        FieldOver { tape, operations, .. }: FieldOver,
    ) -> (Arc<Tape>, f64) {
        let has_loops = around.tape.has_loops();
        // A loop may run fewer iterations at a point than it can run in the cube.
        let at_point = if has_loops {
            let middle = cube.center.map(|x| Affine::coordinate(x, [0.0; 3]));
            operations.min(around.tape.over(&self.frame, middle).operations)
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

/// Half the side of the root: a power of two, so that it seldom changes with the eye.
fn root_half(view: &View) -> f64 {
    let farthest = view.eye.to_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let shift = ROOT_CENTER.into_iter().fold(0.0, f64::max);
    ((farthest + ROOT_RAYS * view.t_max) / (1.0 - shift)).log2().ceil().exp2()
}
