//! The panel beside the picture: params, time, camera, slice, accuracy, drawing.

use eframe::egui::{self, RichText, Ui};

use super::action::Action;
use super::{accuracy_panel, param_sliders, theme};
use crate::session::Session;
use crate::session::orbit_camera::Side;
use crate::views::mode::ViewMode;

/// Shows the panel.
pub fn show(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.add_space(4.0);
        if let Some(model) = session.model.clone() {
            let help = "The scene's params, and numbers that a `let` names.";
            section(ui, "Params", help, |ui| param_sliders::show(ui, session, &model, actions));
            if model.animated {
                section(ui, "Time", "The `time` that the scene reads.", |ui| time(ui, session));
            }
        }
        section(ui, "Camera", "Where the picture is seen from.", |ui| {
            camera(ui, session, actions);
        });
        if session.mode == ViewMode::Slice {
            section(ui, "Slice", "The plane on which the field is shown.", |ui| slice(ui, session));
        }
        section(ui, "Accuracy", "How far the picture is from the exact surface.", |ui| {
            accuracy_panel::show(ui, session);
        });
        section(ui, "Drawing", "How the picture is drawn.", |ui| drawing(ui, session));
    });
}

fn section(ui: &mut Ui, name: &str, help: &str, contents: impl FnOnce(&mut Ui)) {
    let title = RichText::new(name).strong().color(theme::of(ui).weak);
    let header = egui::CollapsingHeader::new(title).default_open(true);
    let shown = header.show_unindented(ui, |ui| {
        ui.add_space(2.0);
        contents(ui);
        ui.add_space(6.0);
    });
    shown.header_response.on_hover_text(help);
}

fn time(ui: &mut Ui, session: &mut Session) {
    let clock = &mut session.clock;
    ui.horizontal(|ui| {
        let text = if clock.playing { "Pause" } else { "Play" };
        if ui.button(text).on_hover_text("Play or pause (Space).").clicked() {
            clock.toggle();
        }
        if ui.button("Rewind").on_hover_text("Set the time to 0.").clicked() {
            clock.time = 0.0;
        }
        ui.spacing_mut().slider_width = (ui.available_width() - 72.0).max(40.0);
        let slider = egui::Slider::new(&mut clock.time, 0.0..=clock.end.max(0.1));
        ui.add(slider.show_value(false)).on_hover_text("The scene's `time`.");
        let seconds = egui::DragValue::new(&mut clock.time).range(0.0..=f64::INFINITY);
        let seconds = ui.add(seconds.speed(0.02).fixed_decimals(2).suffix(" s"));
        seconds.on_hover_text("The scene's `time` in seconds: drag, or click to type.");
    });
    ui.horizontal(|ui| {
        let speed = egui::DragValue::new(&mut clock.speed).speed(0.02).range(-10.0..=10.0);
        let speed = ui.add(speed.prefix("speed ×"));
        speed.on_hover_text("Scene seconds per second; negative plays backwards.");
        ui.checkbox(&mut clock.looping, "loop").on_hover_text("Start again at the end.");
        let end = egui::DragValue::new(&mut clock.end).speed(0.1).range(0.1..=3600.0);
        ui.add(end.prefix("end ").suffix(" s")).on_hover_text("The end of the time, in seconds.");
    });
}

fn camera(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    let Some(camera) = session.camera().copied() else { return };
    ui.horizontal_wrapped(|ui| {
        if ui.button("Fit view").on_hover_text("See the whole scene (F).").clicked() {
            session.fit_view();
        }
        let reset = egui::Button::new("Reset camera");
        let reset = ui.add_enabled(!session.follows_scene(), reset);
        let reset = reset.on_hover_text("Back to the scene's own camera (H).");
        if reset.on_disabled_hover_text("This is the scene's own camera.").clicked() {
            session.reset_camera();
        }
        let help = format!("Copy the camera to paste into the scene (C): {}", camera.text());
        if ui.button("Copy").on_hover_text(help).clicked() {
            actions.push(Action::Copy(camera.text()));
        }
    });
    let sides = [
        ("Front", Side::Front, "Look from the front, along -z (1)."),
        ("Right", Side::Right, "Look from the right, along -x (3)."),
        ("Top", Side::Top, "Look from above, along -y (7)."),
        ("Back", Side::Back, "Look from behind, along +z (2)."),
        ("Left", Side::Left, "Look from the left, along +x (4)."),
        ("Bottom", Side::Bottom, "Look from below, along +y (8)."),
    ];
    for row in sides.chunks(3) {
        ui.columns(3, |columns| {
            for ((name, side, help), ui) in row.iter().zip(columns) {
                let button = egui::Button::new(RichText::new(*name).small());
                let size = egui::vec2(ui.available_width(), 18.0);
                if ui.add_sized(size, button).on_hover_text(*help).clicked() {
                    session.move_camera(|camera| camera.look_from(*side));
                }
            }
        });
    }
    ui.horizontal_wrapped(|ui| {
        let mut parallel = camera.is_parallel();
        let checkbox = ui.checkbox(&mut parallel, "orthographic");
        if checkbox.on_hover_text("Parallel rays, without perspective (P).").changed() {
            session.move_camera(|camera| camera.set_parallel(parallel));
        }
        ui.checkbox(&mut session.show_bounds, "bounds")
            .on_hover_text("Show the scene's bounds, if it has any (B).");
        if let Some(fov) = camera.fov() {
            let mut degrees = fov.to_degrees();
            let drag = egui::DragValue::new(&mut degrees).range(2.0..=150.0).speed(0.3);
            let drag = ui.add(drag.prefix("fov ").suffix("°").max_decimals(1));
            if drag.on_hover_text("Vertical field of view.").changed() {
                session.move_camera(|camera| camera.set_fov(degrees.to_radians()));
            }
        }
    });
}

fn slice(ui: &mut Ui, session: &mut Session) {
    let slice = &mut session.slice;
    ui.horizontal(|ui| {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            ui.selectable_value(&mut slice.axis, axis, name)
                .on_hover_text("The axis that the plane is perpendicular to.");
        }
        let drag = egui::DragValue::new(&mut slice.offset).speed(0.01).max_decimals(4);
        let drag = ui.add(drag.prefix("at "));
        drag.on_hover_text("The plane's coordinate on that axis, in scene units.");
    });
    ui.checkbox(&mut slice.on_top, "draw over the scene")
        .on_hover_text("Show the plane through surfaces in front of it, to see inside shapes.");
    let drag = egui::DragValue::new(&mut slice.spacing).speed(0.005).range(1e-4..=1e4);
    let drag = ui.add(drag.prefix("line spacing ").max_decimals(4));
    drag.on_hover_text("The distance from line to line, in scene units.");
}

fn drawing(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        ui.label("samples per pixel");
        let own = session.model.as_ref().and_then(|it| it.scene.program().settings.samples);
        let mut samples = session.samples.or(own).unwrap_or(4);
        for count in [1, 4, 16, 64] {
            ui.selectable_value(&mut samples, count, count.to_string())
                .on_hover_text("Rays averaged in each pixel once the camera rests.");
        }
        if Some(samples) != session.samples.or(own.or(Some(4))) {
            session.samples = Some(samples);
        }
    });
    let mut live = session.build().live_literals;
    let text = "A changed number shows without compiling a new shader, and numbers in the panel \
                “Code” can be dragged. Off: numbers are constants, and the shader is faster.";
    if ui.checkbox(&mut live, "adjustable numbers").on_hover_text(text).changed() {
        session.update_build(|build| build.live_literals = live);
    }
    let mut on_cpu = session.build().on_cpu;
    let text = "Draw on the CPU instead of the GPU: slower, but a check of the shader.";
    if ui.checkbox(&mut on_cpu, "draw on the CPU").on_hover_text(text).changed() {
        session.update_build(|build| build.on_cpu = on_cpu);
    }
}
