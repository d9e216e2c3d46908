//! A field whose cells are kept from frame to frame.

use std::sync::{Arc, Mutex, PoisonError};

use sdfc_graph::eval::{FrameValues, Tape};

use super::Cells;
use super::octree::Octree;
use crate::view::View;

/// Smaller fields have one cell if nothing is to be proven of cells.
const MIN_OPERATIONS: usize = 200;

/// Larger octrees are not kept after their frame: about 80 MB.
const MAX_KEPT_OPERATIONS: usize = 1 << 22;

/// A field, with the cells of its last frame.
#[derive(Clone, Debug)]
pub(crate) struct CachedField {
    pub(crate) tape: Arc<Tape>,
    octree: Arc<Mutex<Option<Arc<Octree>>>>,
}

impl CachedField {
    pub(crate) fn new(tape: Tape) -> Self {
        Self { tape: Arc::new(tape), octree: Arc::default() }
    }

    /// All of space as one cell.
    pub(crate) fn whole<'a>(&self, frame: &'a FrameValues) -> Cells<'a> {
        Cells::one(&self.tape, frame)
    }

    /// The cells of a picture, if the field is large enough to pay for them. Cells that the last
    /// picture has made are used again if the values that the field depends on are the same. With
    /// `proves`, cells are also divided to prove that they hold no surface.
    pub(crate) fn cells<'a>(&self, frame: &'a FrameValues, view: &View, proves: bool) -> Cells<'a> {
        if !proves && self.tape.operations() < MIN_OPERATIONS {
            return self.whole(frame);
        }
        let mut kept = self.octree.lock().unwrap_or_else(PoisonError::into_inner);
        let octree = match kept.take().filter(|octree| octree.serves(frame, view)) {
            Some(octree) => octree,
            None => Arc::new(Octree::new(&self.tape, frame, view)),
        };
        *kept = Some(Arc::clone(&octree));
        Cells::of(octree, &self.tape, frame, view, proves)
    }

    /// Frees the cells if they are too many to be kept.
    pub(crate) fn end_frame(&self) {
        let mut kept = self.octree.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.as_ref().is_some_and(|octree| octree.operations() > MAX_KEPT_OPERATIONS) {
            *kept = None;
        }
    }
}
