//! The bar above the picture: scene menu, view, ray method, and buttons that open panels.

use eframe::egui::{self, RichText, Ui};
use sdfc_march::{Method, MethodParameter};

use super::number_widget::number_drag;
use super::open_panels::OpenPanels;
use super::scene_menu::{self, Choice};
use super::theme;
use crate::session::Session;
use crate::settings::Settings;
use crate::views::mode::ViewMode;

/// Below this width in points the names of view, method and tolerance are left out.
const WIDE: f32 = 900.0;
/// Below this width the tolerance is left out too.
const NARROW: f32 = 600.0;

/// Shows the bar; returns the choice of the scene menu.
pub fn show(
    ui: &mut Ui,
    session: &mut Session,
    panels: &mut OpenPanels,
    settings: &mut Settings,
) -> Option<Choice> {
    let width = ui.available_width();
    let (wide, narrow) = (width >= WIDE, width < NARROW);
    // From the right, so that the rest of the row is left for the scene's name.
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    let size = egui::vec2(width, ui.spacing().interact_size.y);
    let row = ui.allocate_ui_with_layout(size, layout, |ui| {
        if narrow {
            ui.spacing_mut().item_spacing.x = 3.0;
        }
        ui.toggle_value(&mut panels.help, "?").on_hover_text("Keys and mouse (? or F1).");
        ui.toggle_value(&mut panels.controls, "Controls")
            .on_hover_text("Params, time, camera, accuracy, drawing (K).");
        ui.toggle_value(&mut panels.code, "Code").on_hover_text("The scene's source (T).");
        ui.toggle_value(&mut panels.export, "Export")
            .on_hover_text("Save a picture, an animation, a shader or a screenshot (Ctrl+E).");
        if !narrow {
            ui.separator();
            tolerance(ui, session, wide);
        }
        ui.spacing_mut().combo_width = if narrow { 50.0 } else { 100.0 };
        methods(ui, session, wide);
        views(ui, session, wide);
        let rest = egui::Layout::left_to_right(egui::Align::Center);
        ui.with_layout(rest, |ui| {
            let choice = scene_menu::show(ui, session, settings);
            compile_state(ui, session);
            choice
        })
        .inner
    });
    row.inner
}

/// The parameter of the ray method, if it has one.
fn tolerance(ui: &mut Ui, session: &mut Session, wide: bool) {
    let parameter = session.model.as_ref().and_then(|model| model.method_parameter());
    let Some(parameter) = parameter else { return };
    let (name, what) = match parameter {
        MethodParameter::Steps => ("Steps", "How many steps a ray may take"),
        MethodParameter::Epsilon => {
            ("Epsilon", "How close to the surface a ray must come, in scene units")
        }
        MethodParameter::Tolerance => {
            ("Tolerance", "How close to the surface a ray must come, in pixel widths")
        }
    };
    let prefix = if wide { format!("{name} ×") } else { "×".to_owned() };
    let speed = session.tolerance * 0.02;
    let drag = number_drag(&mut session.tolerance).range(1e-3..=1e3).speed(speed).prefix(prefix);
    let text = format!("{what}, as a multiple of the scene's setting. Double-click to reset.");
    let response = ui.add(drag).on_hover_text(text);
    if response.double_clicked() {
        session.tolerance = 1.0;
    }
}

/// The number of errors, or the compile worker's current step.
fn compile_state(ui: &mut Ui, session: &Session) {
    let errors = session.diagnostics.errors();
    if errors > 0 {
        let text = if errors == 1 { "1 error".to_owned() } else { format!("{errors} errors") };
        let shown = if session.model.is_some() { ", showing the last good scene" } else { "" };
        let text = RichText::new(format!("{text}{shown}")).small().color(theme::of(ui).error);
        ui.add(egui::Label::new(text).truncate());
    } else if session.building {
        let text = RichText::new("compiling the shader…").small();
        ui.add(egui::Label::new(text.color(theme::of(ui).accent)).truncate());
    }
}

/// A chosen value, with its name if there is room.
fn named(name: &str, value: &str, wide: bool) -> String {
    if wide { format!("{name}: {value}") } else { value.to_owned() }
}

fn views(ui: &mut Ui, session: &mut Session, wide: bool) {
    let text = named("View", session.mode.name(), wide);
    let text = if session.is_view_pending() { format!("{text}, computing…") } else { text };
    let combo = egui::ComboBox::from_id_salt("view").selected_text(text);
    let combo = combo.height(400.0).show_ui(ui, |ui| {
        for mode in ViewMode::ALL {
            ui.selectable_value(&mut session.mode, mode, mode.name()).on_hover_text(mode.help());
        }
    });
    combo.response.on_hover_text("The view: what the picture shows (V for the next).");
}

fn methods(ui: &mut Ui, session: &mut Session, wide: bool) {
    let chosen = session.build().method;
    let own = session.model.as_ref().map_or(Method::Auto, |model| model.scene.method());
    let shown = chosen.unwrap_or(own);
    let text = named("Ray method", shown.name(), wide);
    let combo = egui::ComboBox::from_id_salt("method").selected_text(text);
    let combo = combo.height(400.0).show_ui(ui, |ui| {
        let text = format!("the scene's ({own})");
        let scenes_own = ui.selectable_label(chosen.is_none(), text);
        if scenes_own
            .on_hover_text("The method that `march` in the scene states, or auto.")
            .clicked()
        {
            session.update_build(|build| build.method = None);
        }
        for method in Method::for_users() {
            let label = ui.selectable_label(chosen == Some(method), method.name());
            if label.on_hover_text(method.summary()).clicked() {
                session.update_build(|build| build.method = Some(method));
            }
        }
    });
    combo.response.on_hover_text("The ray method: how the surface is found along each ray.");
}
