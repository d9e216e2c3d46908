//! A widget for each param of the scene, and for each number that a `let` names.

use eframe::egui::{self, Response, RichText, SliderClamping, Ui};
use sdfc_graph::{Param, ParamKind};

use super::action::Action;
use super::number_widget::number_drag;
use super::{number_buttons, theme};
use crate::scene::model::Model;
use crate::scene::number_text::value_text;
use crate::scene::source_numbers::SourceNumber;
use crate::session::Session;
use crate::session::save_state::Saved;

/// The space beside a slider for its number and its reset button, in points.
const BESIDE_SLIDER: f32 = 96.0;

/// Shows the section "Params" of the panel.
pub fn show(ui: &mut Ui, session: &mut Session, model: &Model, actions: &mut Vec<Action>) {
    let is_empty = model.declared().is_empty();
    let mut named_numbers = model.numbers.iter().filter(|number| number.name.is_some()).peekable();
    if is_empty && named_numbers.peek().is_none() {
        let text = "The scene has none. A line `param r = 0.5 in 0..1` or `let r = 0.5` in it adds \
                    a slider here. In the panel “Code” every number can be dragged.";
        ui.label(RichText::new(text).small().color(theme::of(ui).weak));
    }
    if !is_empty {
        declared(ui, session, model, actions);
    }
    let mut is_changed = false;
    for number in named_numbers {
        named(ui, session, number);
        is_changed |= session.param_values.number(number) != number.value;
    }
    if is_changed {
        number_buttons::show(ui, session, model, actions);
    }
}

fn declared(ui: &mut Ui, session: &mut Session, model: &Model, actions: &mut Vec<Action>) {
    let values = session.values(model);
    for (param, lanes) in model.declared().iter().zip(values.params) {
        let changed = session.param_values.params.contains_key(&param.name);
        let mut value = lanes;
        let default = changed.then(|| value_text(param, param.default));
        let widget = |ui: &mut Ui, label: RowLabel<'_>| {
            param_widget(ui, param, &mut value, label);
        };
        let response = row(ui, &param.name, &hint(param), default, widget);
        if response.is_reset {
            session.param_values.params.remove(&param.name);
        } else if value != lanes {
            session.param_values.params.insert(param.name.clone(), value);
        }
        if response.is_hovered {
            session.handles.hovered = Some(param.name.clone());
        }
        if response.is_chosen || value != lanes {
            session.handles.selected = Some(param.name.clone());
        }
    }
    ui.horizontal_wrapped(|ui| {
        let is_changed = !session.param_values.params.is_empty();
        let unchanged = "No param has been changed.";
        let save = ui.add_enabled(is_changed, egui::Button::new("Save params"));
        let save = save.on_hover_text("Write the values to the scene's file, as the defaults.");
        if save.on_disabled_hover_text(unchanged).clicked() {
            session.save_to_file(Saved::Params);
        }
        let reset = ui.add_enabled(is_changed, egui::Button::new("Reset params"));
        let reset = reset.on_hover_text("Reset all params to their defaults.");
        if reset.on_disabled_hover_text(unchanged).clicked() {
            session.param_values.params.clear();
        }
        let copy = ui.button("Copy values");
        let help = "Copy the values as `--set` arguments of `sdfc render`.";
        if copy.on_hover_text(help).clicked() {
            actions.push(Action::Copy(session.param_values.arguments(model)));
        }
    });
}

/// A slider for a number that a `let` names.
fn named(ui: &mut Ui, session: &mut Session, number: &SourceNumber) {
    let unit = if number.is_angle { 1f64.to_degrees() } else { 1.0 };
    let before = session.param_values.number(number);
    let mut value = before * unit;
    let (name, text) = (number.name.as_deref().unwrap_or_default(), &number.text);
    let hint = format!(
        "`let {name} = {text}` in the scene. Drag the number to go beyond the slider. For a slider \
         with other ends, write `param {name} = {text} in LOW..HIGH` instead."
    );
    let default = (before != number.value).then(|| text.clone());
    let limits = number.range.map(|ends| ends.map(|end| end * unit));
    let ends = default_ends(number.value * unit);
    let suffix = if number.is_angle { "°" } else { "" };
    let widget = |ui: &mut Ui, label: RowLabel<'_>| {
        slider(ui, &mut value, [ends, limits], suffix, label);
    };
    if row(ui, name, &hint, default, widget).is_reset {
        session.param_values.set_number(number, number.value);
    } else if value != before * unit {
        session.param_values.set_number(number, value / unit);
    }
}

/// The ends of a slider for a number without a range: the number is in the middle.
fn default_ends(value: f64) -> Option<[f64; 2]> {
    let ends = if value == 0.0 { [-1.0, 1.0] } else { [0.0, 2.0 * value] };
    Some([ends[0].min(ends[1]), ends[0].max(ends[1])])
}

/// The label in front of a widget.
#[derive(Clone, Copy)]
struct RowLabel<'h> {
    /// The label's id, for screen readers.
    id: egui::Id,
    /// The hover text.
    hint: &'h str,
}

impl RowLabel<'_> {
    fn attach(self, widget: Response) {
        widget.labelled_by(self.id).on_hover_text(self.hint);
    }
}

/// What the user does with a row.
struct RowResponse {
    /// True if the value is reset.
    is_reset: bool,
    /// True if the pointer is over the row.
    is_hovered: bool,
    /// True if the name was clicked.
    is_chosen: bool,
}

/// A row with a name, a widget and, if the value was changed, a button that resets it to `default`.
fn row(
    ui: &mut Ui,
    name: &str,
    hint: &str,
    default: Option<String>,
    widget: impl FnOnce(&mut Ui, RowLabel<'_>),
) -> RowResponse {
    let row = ui.horizontal(|ui| {
        let color = if default.is_some() { theme::of(ui).accent } else { theme::of(ui).text };
        let left = egui::Layout::left_to_right(egui::Align::Center);
        let label = ui.allocate_ui_with_layout(egui::vec2(84.0, 18.0), left, |ui| {
            ui.set_min_width(84.0);
            let name = RichText::new(name).color(color);
            ui.add(egui::Label::new(name).truncate()).on_hover_text(hint).id
        });
        let id = label.inner.with("name");
        let chosen = ui.interact(label.response.rect, id, egui::Sense::click());
        let info = format!("choose {name}");
        chosen.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &info));
        let chosen = chosen.on_hover_text(hint).clicked();
        // Room for the number and the button, so that the panel does not grow when a value changes.
        ui.spacing_mut().slider_width = (ui.available_width() - BESIDE_SLIDER).max(48.0);
        widget(ui, RowLabel { id: label.inner, hint });
        let button = egui::Button::new(RichText::new("reset").small()).frame(false);
        let is_reset = default.is_some_and(|text| {
            ui.add(button).on_hover_text(format!("Reset to {text}.")).clicked()
        });
        (is_reset, chosen)
    });
    let (is_reset, is_chosen) = row.inner;
    let is_hovered = ui.rect_contains_pointer(row.response.rect);
    RowResponse { is_reset, is_hovered, is_chosen }
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
    let note = match param.fixed {
        Some(_) => "\nIt decides what the scene consists of: each change compiles the scene again.",
        None => "",
    };
    format!("{summary}\n{kind}; default {default}{note}")
}

/// The widget for a param of any kind.
fn param_widget(ui: &mut Ui, param: &Param, value: &mut [f64; 4], label: RowLabel<'_>) {
    let [number, ..] = value;
    match param.kind {
        ParamKind::Number => slider(ui, number, [param.range; 2], "", label),
        ParamKind::Angle => {
            let mut degrees = number.to_degrees();
            let range = param.range.map(|ends| ends.map(f64::to_degrees));
            slider(ui, &mut degrees, [range; 2], "°", label);
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
            slider(ui, number, [range; 2], "", label);
            if *number != before {
                *number = number.round();
            }
        }
        ParamKind::Bool => {
            let mut on = *number != 0.0;
            label.attach(ui.checkbox(&mut on, ""));
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
            label.attach(button);
        }
        ParamKind::Choice => {
            let mut index = *number as usize;
            let called = |index: usize| param.choices.get(index).map_or("", String::as_str);
            let combo = egui::ComboBox::from_id_salt(&param.name).selected_text(called(index));
            let combo = combo.show_ui(ui, |ui| {
                for choice in 0..param.choices.len() {
                    let choice = ui.selectable_value(&mut index, choice, called(choice));
                    choice.on_hover_text(label.hint);
                }
            });
            *number = index as f64;
            label.attach(combo.response);
        }
    }
}

/// A slider if its ends are finite, and the number, which can be dragged and typed within its
/// limits.
fn slider(
    ui: &mut Ui,
    number: &mut f64,
    [ends, limits]: [Option<[f64; 2]>; 2],
    unit: &str,
    label: RowLabel<'_>,
) {
    let [low, high] = limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let mut speed = (number.abs() * 0.005).max(0.002);
    if let Some(ends) = ends.map(|ends| ends.map(|end| end.clamp(low, high)))
        && ends.iter().all(|end| end.is_finite())
    {
        let [first, last] = ends;
        // A number beyond the ends is not clamped until it is dragged.
        let slider = egui::Slider::new(number, first..=last).clamping(SliderClamping::Edits);
        label.attach(ui.add(slider.show_value(false)));
        speed = (last - first) / 400.0;
    }
    label.attach(ui.add(number_drag(number).range(low..=high).speed(speed).suffix(unit)));
}
