//! Params, and numbers that the scene names, each with a widget of its kind.

use eframe::egui::{self, Response, RichText, SliderClamping, Ui};
use sdfc::graph::{Param, ParamKind};
use sdfc::lang::live_literals::LiveLiteral;

use super::{Wish, source, style};
use crate::knobs::{display_text, value_text};
use crate::model::Model;
use crate::session::Session;

/// What stands beside the slider of a param.
const BESIDE_SLIDER: f32 = 96.0;

/// The section of the panel.
pub fn show(ui: &mut Ui, session: &mut Session, model: &Model, wishes: &mut Vec<Wish>) {
    let is_empty = model.declared().is_empty();
    if is_empty && model.named().next().is_none() {
        let text = "none: `param r = 0.5 in 0..1` or `let r = 0.5` in the scene makes a slider here. Under “Text” its \
                    numbers can be dragged.";
        ui.label(RichText::new(text).small().color(style::of(ui).weak));
    }
    if !is_empty {
        declared(ui, session, model, wishes);
    }
    let mut is_moved = false;
    for (name, slot, param) in model.named() {
        named(ui, session, name, slot, param);
        is_moved |= session.knobs.literal(slot) != slot.value;
    }
    if is_moved {
        source::orders(ui, session, model, wishes);
    }
}

fn declared(ui: &mut Ui, session: &mut Session, model: &Model, wishes: &mut Vec<Wish>) {
    let values = session.values(model);
    for (param, lanes) in model.declared().iter().zip(values.params) {
        let moved = session.knobs.params.contains_key(&param.name);
        let mut value = lanes;
        let back = moved.then(|| value_text(param, param.default));
        let widget = |ui: &mut Ui, name: Named<'_>| knob(ui, param, &mut value, name);
        if row(ui, &param.name, &hint(param), back, widget) {
            session.knobs.params.remove(&param.name);
        } else if value != lanes {
            session.knobs.params.insert(param.name.clone(), value);
        }
    }
    ui.horizontal(|ui| {
        let reset = ui.add_enabled(!session.knobs.params.is_empty(), egui::Button::new("Reset"));
        let reset = reset.on_hover_text("All params back to what the scene says.");
        if reset.on_disabled_hover_text("No param has been moved.").clicked() {
            session.knobs.params.clear();
        }
        let copy = ui.button("Copy values");
        if copy.on_hover_text("Copy them as arguments of `sdfc render`.").clicked() {
            wishes.push(Wish::Copy(session.knobs.arguments(model)));
        }
    });
}

/// A number that the scene gives a name.
fn named(ui: &mut Ui, session: &mut Session, name: &str, slot: &LiveLiteral, param: &Param) {
    let is_angle = param.kind == ParamKind::Angle;
    let unit = if is_angle { 1f64.to_degrees() } else { 1.0 };
    let before = session.knobs.literal(slot);
    let mut value = before * unit;
    let text = &param.summary;
    let hint = format!(
        "`let {name} = {text}` in the scene. Drag the number to go beyond the slider; `param {name} = {text} in \
         LOW..HIGH` in its place has ends of your own."
    );
    let back = (before != slot.value).then(|| text.clone());
    let limits = param.range.map(|ends| ends.map(|end| end * unit));
    let ends = usual_ends(slot.value * unit);
    let suffix = if is_angle { "°" } else { "" };
    let widget = |ui: &mut Ui, name: Named<'_>| {
        number_knob(ui, &mut value, [ends, limits], suffix, name);
    };
    if row(ui, name, &hint, back, widget) {
        session.knobs.set_literal(slot, slot.value);
    } else if value != before * unit {
        session.knobs.set_literal(slot, value / unit);
    }
}

/// Ends of the slider for a number without any: the number lies in the middle.
fn usual_ends(value: f64) -> Option<[f64; 2]> {
    let ends = if value == 0.0 { [-1.0, 1.0] } else { [0.0, 2.0 * value] };
    Some([ends[0].min(ends[1]), ends[0].max(ends[1])])
}

/// What stands before a widget.
#[derive(Clone, Copy)]
struct Named<'h> {
    /// The name, for those who hear it.
    label: egui::Id,
    /// What the pointer is told.
    hint: &'h str,
}

impl Named<'_> {
    fn explains(self, widget: Response) {
        widget.labelled_by(self.label).on_hover_text(self.hint);
    }
}

/// A name, its widget and, where there is something to go back to, the way back: gives whether that is gone.
fn row(
    ui: &mut Ui,
    name: &str,
    hint: &str,
    back: Option<String>,
    widget: impl FnOnce(&mut Ui, Named<'_>),
) -> bool {
    ui.horizontal(|ui| {
        let color = if back.is_some() { style::of(ui).accent } else { style::of(ui).text };
        let left = egui::Layout::left_to_right(egui::Align::Center);
        let label = ui.allocate_ui_with_layout(egui::vec2(84.0, 18.0), left, |ui| {
            ui.set_min_width(84.0);
            let name = RichText::new(name).color(color);
            ui.add(egui::Label::new(name).truncate()).on_hover_text(hint).id
        });
        // Room for the number and for the way back, so that the panel does not grow when something is moved.
        ui.spacing_mut().slider_width = (ui.available_width() - BESIDE_SLIDER).max(48.0);
        widget(ui, Named { label: label.inner, hint });
        let button = egui::Button::new(RichText::new("reset").small()).frame(false);
        back.is_some_and(|text| ui.add(button).on_hover_text(format!("Back to {text}.")).clicked())
    })
    .inner
}

fn hint(param: &Param) -> String {
    let kind = match param.kind {
        ParamKind::Number => "a number",
        ParamKind::Int => "a whole number",
        ParamKind::Angle => "an angle",
        ParamKind::Bool => "true or false",
        ParamKind::Color => "a colour",
        ParamKind::Choice => "a choice",
    };
    let summary = if param.summary.is_empty() { &param.name } else { &param.summary };
    let default = value_text(param, param.default);
    format!("{summary}\n{kind}; {default} in the scene")
}

/// The widget for a param.
fn knob(ui: &mut Ui, param: &Param, value: &mut [f64; 4], name: Named<'_>) {
    let [number, ..] = value;
    match param.kind {
        ParamKind::Number => number_knob(ui, number, [param.range; 2], "", name),
        ParamKind::Angle => {
            let mut degrees = number.to_degrees();
            let range = param.range.map(|ends| ends.map(f64::to_degrees));
            number_knob(ui, &mut degrees, [range; 2], "°", name);
            if degrees.to_radians() != *number {
                *number = degrees.to_radians();
                if let Some([low, high]) = param.range {
                    *number = number.clamp(low, high);
                }
            }
        }
        ParamKind::Int => {
            let before = *number;
            let range = param.range.map(|[low, high]| [low.ceil(), high.floor()]);
            number_knob(ui, number, [range; 2], "", name);
            if *number != before {
                *number = number.round();
            }
        }
        ParamKind::Bool => {
            let mut on = *number != 0.0;
            name.explains(ui.checkbox(&mut on, ""));
            *number = f64::from(u8::from(on));
        }
        ParamKind::Color => {
            let mut color = [value[0], value[1], value[2]].map(|lane| lane as f32);
            let button = egui::color_picker::color_edit_button_rgb(ui, &mut color);
            if button.changed() {
                for (lane, new) in value.iter_mut().zip(color) {
                    *lane = f64::from(new);
                }
            }
            name.explains(button);
        }
        ParamKind::Choice => {
            let mut index = *number as usize;
            let called = |index: usize| param.choices.get(index).map_or("", String::as_str);
            let combo = egui::ComboBox::from_id_salt(&param.name).selected_text(called(index));
            let combo = combo.show_ui(ui, |ui| {
                for choice in 0..param.choices.len() {
                    let choice = ui.selectable_value(&mut index, choice, called(choice));
                    choice.on_hover_text(name.hint);
                }
            });
            *number = index as f64;
            name.explains(combo.response);
        }
    }
}

/// A number that can be dragged and typed. It is shown rounded; opened and left as it was, it keeps its value.
pub fn drag(number: &mut f64) -> egui::DragValue<'_> {
    let before = *number;
    let read = move |text: &str| match text.trim() {
        same if same == display_text(before) => Some(before),
        other => other.parse().ok(),
    };
    let drag = egui::DragValue::new(number).custom_formatter(|value, _| display_text(value));
    drag.custom_parser(read)
}

/// A slider where there are finite ends for it, and the number, which can be dragged and typed, up to its limits.
fn number_knob(
    ui: &mut Ui,
    number: &mut f64,
    [ends, limits]: [Option<[f64; 2]>; 2],
    unit: &str,
    name: Named<'_>,
) {
    let [low, high] = limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let mut speed = (number.abs() * 0.005).max(0.002);
    if let Some(ends) = ends.map(|ends| ends.map(|end| end.clamp(low, high)))
        && ends.iter().all(|end| end.is_finite())
    {
        let [first, last] = ends;
        // A number beyond the ends stays where it is.
        let slider = egui::Slider::new(number, first..=last).clamping(SliderClamping::Edits);
        name.explains(ui.add(slider.show_value(false)));
        speed = (last - first) / 400.0;
    }
    name.explains(ui.add(drag(number).range(low..=high).speed(speed).suffix(unit)));
}
