//! Handles in the picture for the values that are selected in a panel.

use std::sync::Arc;

use glam::DVec3;

use super::Session;
use crate::render::handles::{Handle, HandleRequest};
use crate::scene::handle_values::{HandleValue, LiveParam, values_at};
use crate::session::handle_state::{ValueHandle, ValueHandles};
use crate::session::tabs::TabFile;

impl Session {
    /// Asks for the handles of the param under the pointer, else of the chosen one, else of the
    /// values at the cursor.
    pub fn select_handles(&mut self, cursor: Option<&(TabFile, usize)>) {
        let Some(model) = self.model.clone() else { return };
        if self.handles.is_dragged {
            return;
        }
        let is_scene = *model.source == **self.text();
        let offset = cursor.filter(|(file, _)| is_scene && *file == TabFile::Scene);
        let looked_at = offset.map(|(_, offset)| (*offset, model.serial));
        if self.handles.looked_at != looked_at {
            let at_cursor = match looked_at {
                None => Vec::new(),
                Some((at, _)) => {
                    // The roles of the words decide what is a param.
                    let Some(answer) = self.answer_about_text() else { return };
                    values_at(&model, &answer.tokens, at)
                }
            };
            let handles = &mut self.handles;
            handles.at_cursor = at_cursor;
            // The cursor was moved after the param was chosen.
            handles.selected = handles.selected.take().filter(|_| looked_at.is_none());
            handles.looked_at = looked_at;
        }
        let named = self.handles.hovered.as_ref().or(self.handles.selected.as_ref());
        let values = match named {
            Some(name) => vec![HandleValue::Param(name.clone())],
            None => self.handles.at_cursor.clone(),
        };
        let live: Option<Vec<LiveParam>> =
            values.iter().map(|value| value.live_param(&model)).collect();
        let Some(live) = live.filter(|live| !live.is_empty()) else {
            (self.handles.asked, self.handles.answer) = (None, None);
            return;
        };
        let picture = self.known_picture().filter(|picture| {
            !picture.request.moving && picture.request.model.serial == model.serial
        });
        let Some(picture) = picture else { return };
        let shown = self.value_handles();
        let at = |value: &HandleValue| {
            shown.iter().find(|it| it.value == *value).map(|it| it.handle.origin)
        };
        let asked = HandleRequest::new(picture, live, values.iter().map(at).collect());
        let handles = &mut self.handles;
        if handles.asked.as_ref().is_some_and(|last| last.is_same(&asked)) {
            return;
        }
        handles.values = values;
        handles.asked = Some(asked.clone());
        handles.worker.send(asked);
    }

    /// The handles of the selected values, for those that move something that is seen.
    pub fn value_handles(&self) -> Vec<ValueHandle> {
        let ValueHandles { asked, answer, values, .. } = &self.handles;
        let (Some(asked), Some(answer), Some(model)) = (asked, answer, &self.model) else {
            return Vec::new();
        };
        let is_model = Arc::ptr_eq(&answer.request.request().model, model);
        if !is_model || !answer.request.has_same_params(asked) {
            return Vec::new();
        }
        let is_vector = answer.handles.len() == 3
            && answer.handles.iter().all(|it| it.is_some_and(|it| it.is_translation));
        // The arrows of a vector begin at one point, which all of its values move.
        let common = answer.handles.first().copied().flatten().filter(|_| is_vector);
        let mut moved = DVec3::ZERO;
        let mut found = Vec::new();
        for ((value, start), handle) in
            values.iter().zip(&answer.request.start).zip(&answer.handles)
        {
            let number = value.get(model, &self.param_values);
            if let (Some(number), Some(handle)) = (number, handle) {
                let by = handle.motion * (number - start);
                moved += by;
                let handle = Handle { origin: handle.origin + by, ..*handle };
                let unit = value.unit(model);
                found.push(ValueHandle { value: value.clone(), number, unit, handle });
            }
        }
        if let Some(common) = common {
            found.iter_mut().for_each(|it| it.handle.origin = common.origin + moved);
        }
        found
    }

    /// Changes a value as its slider does.
    pub fn set_value(&mut self, value: &HandleValue, number: f64) {
        if let Some(model) = self.model.clone()
            && number.is_finite()
        {
            value.set(&model, &mut self.param_values, number);
        }
    }
}
