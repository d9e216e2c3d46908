//! The values that are selected in a panel, and their handles in the picture.

use std::sync::mpsc::Receiver;

use crate::render::handles::{Handle, HandleRequest, HandleWorker, Handles};
use crate::scene::handle_values::HandleValue;
use crate::scene::number_text::Unit;

/// The selected values, and their handles.
#[derive(Debug)]
pub struct ValueHandles {
    /// The param under the pointer.
    pub hovered: Option<String>,
    /// The param that was chosen last.
    pub selected: Option<String>,
    /// True while a handle is dragged.
    pub is_dragged: bool,
    pub(super) worker: HandleWorker,
    pub(super) answers: Receiver<Handles>,
    pub(super) asked: Option<HandleRequest>,
    pub(super) answer: Option<Handles>,
    pub(super) values: Vec<HandleValue>,
    /// The position and the model that the values were looked up for.
    pub(super) looked_at: Option<(usize, u64)>,
    pub(super) at_cursor: Vec<HandleValue>,
}

impl ValueHandles {
    /// Nothing is selected.
    pub fn new(worker: HandleWorker, answers: Receiver<Handles>) -> Self {
        Self {
            hovered: None,
            selected: None,
            is_dragged: false,
            worker,
            answers,
            asked: None,
            answer: None,
            values: Vec::new(),
            looked_at: None,
            at_cursor: Vec::new(),
        }
    }

    /// Receives answers. Returns true if there are any.
    pub fn poll(&mut self) -> bool {
        let Some(answer) = self.answers.try_iter().last() else { return false };
        self.answer = Some(answer);
        true
    }
}

/// A value with its handle.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueHandle {
    /// The value.
    pub value: HandleValue,
    /// The current number.
    pub number: f64,
    /// The unit in which a text has it.
    pub unit: Unit,
    /// The handle where it is for that number.
    pub handle: Handle,
}
