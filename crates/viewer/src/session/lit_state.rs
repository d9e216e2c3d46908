//! The question which pixels show the code at the cursor, and its answer.

use std::sync::mpsc::Receiver;

use crate::render::shape_mask::{MaskRequest, MaskWorker, ShapeMask};
use crate::session::tabs::TabFile;

/// The question about the code at the cursor, and its answer.
#[derive(Debug)]
pub struct LitShapes {
    pub(super) worker: MaskWorker,
    pub(super) masks: Receiver<ShapeMask>,
    pub(super) asked: Option<MaskRequest>,
    pub(super) mask: Option<ShapeMask>,
    /// The position, the model and the number of the picture that were looked at last.
    pub(super) looked_at: Option<(TabFile, usize, u64, u64)>,
}

impl LitShapes {
    /// Nothing is lit.
    pub fn new(worker: MaskWorker, masks: Receiver<ShapeMask>) -> Self {
        Self { worker, masks, asked: None, mask: None, looked_at: None }
    }

    /// Receives answers. Returns true if there are any.
    pub fn poll(&mut self) -> bool {
        let Some(mask) = self.masks.try_iter().last() else { return false };
        self.mask = Some(mask);
        true
    }

    /// Lights nothing.
    pub fn clear(&mut self) {
        (self.asked, self.mask, self.looked_at) = (None, None, None);
    }
}
