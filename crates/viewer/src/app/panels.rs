//! The bar above the picture, and the knobs beside it.

use eframe::egui::{self, RichText, Ui};
use sdfc::march::{METHODS, MethodParameter};

use super::menu::{self, Choice};
use super::params::{self, drag};
use super::{Shows, Wish, accuracy, style};
use crate::memory::Memory;
use crate::mode::Mode;
use crate::orbit::Side;
use crate::session::Session;

/// The view after this one.
pub fn next_mode(mode: Mode) -> Mode {
    let at = Mode::ALL.iter().position(|it| *it == mode).unwrap_or(0);
    Mode::ALL[(at + 1) % Mode::ALL.len()]
}

/// The menu of scenes, view, method, what is open.
pub fn bar(
    ui: &mut Ui,
    session: &mut Session,
    shows: &mut Shows,
    memory: &mut Memory,
) -> Option<Choice> {
    let row = ui.horizontal(|ui| {
        let choice = menu::show(ui, session.path(), memory);
        state(ui, session);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.toggle_value(&mut shows.help, "?").on_hover_text("Keys and buttons.");
            ui.toggle_value(&mut shows.knobs, "Knobs").on_hover_text("Params, time, camera. K");
            ui.toggle_value(&mut shows.source, "Text")
                .on_hover_text("The scene's text; its numbers can be dragged. T");
            ui.toggle_value(&mut shows.save, "Save")
                .on_hover_text("A picture, an animation, the shader, the window. Ctrl S");
            ui.separator();
            tolerance(ui, session);
            methods(ui, session);
            modes(ui, session);
        });
        choice
    });
    row.inner
}

/// How fine the method is, where it has a knob.
fn tolerance(ui: &mut Ui, session: &mut Session) {
    let Some(knob) = session.model.as_ref().and_then(|model| model.knob()) else { return };
    let what = match knob {
        MethodParameter::Steps => "How many steps a ray may take",
        MethodParameter::Epsilon => "How near to the surface a hit is, in scene units",
        MethodParameter::Tolerance => "How near to the surface a hit is, in widths of a pixel",
    };
    let speed = session.tolerance * 0.02;
    let drag = drag(&mut session.tolerance).range(1e-3..=1e3).speed(speed).prefix("×");
    let text = format!("{what}: a multiple of what the scene says. A double click resets it.");
    let response = ui.add(drag).on_hover_text(text);
    if response.double_clicked() {
        session.tolerance = 1.0;
    }
}

/// What the compiler is about.
fn state(ui: &mut Ui, session: &Session) {
    let errors = session.findings.errors();
    if errors > 0 {
        let text = if errors == 1 { "1 error".to_owned() } else { format!("{errors} errors") };
        let shown = if session.model.is_some() { ", showing the last good scene" } else { "" };
        ui.label(RichText::new(format!("{text}{shown}")).small().color(style::of(ui).error));
    } else if session.building {
        ui.label(RichText::new("building…").small().color(style::of(ui).accent));
    }
}

fn modes(ui: &mut Ui, session: &mut Session) {
    let combo = egui::ComboBox::from_id_salt("mode").selected_text(session.mode.name());
    let combo = combo.height(400.0).show_ui(ui, |ui| {
        for mode in Mode::ALL {
            ui.selectable_value(&mut session.mode, mode, mode.name()).on_hover_text(mode.help());
        }
    });
    combo.response.on_hover_text("What is shown. V for the next.");
}

fn methods(ui: &mut Ui, session: &mut Session) {
    let chosen = session.build().method.clone();
    let own = session.model.as_ref().map_or("auto", |model| model.scene.method()).to_owned();
    let shown = chosen.clone().unwrap_or_else(|| own.clone());
    let combo = egui::ComboBox::from_id_salt("method").selected_text(shown);
    let combo = combo.height(400.0).show_ui(ui, |ui| {
        let text = format!("as the scene says ({own})");
        let scenes_own = ui.selectable_label(chosen.is_none(), text);
        if scenes_own.on_hover_text("What `march` in the scene says, else auto.").clicked() {
            session.set_build(|build| build.method = None);
        }
        for method in METHODS {
            let is_chosen = chosen.as_deref() == Some(method.name);
            if ui.selectable_label(is_chosen, method.name).on_hover_text(method.summary).clicked() {
                session.set_build(|build| build.method = Some(method.name.to_owned()));
            }
        }
    });
    combo.response.on_hover_text("How rays are marched.");
}

/// Params, time, camera, quality.
pub fn knobs(ui: &mut Ui, session: &mut Session, wishes: &mut Vec<Wish>) {
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.add_space(4.0);
        if let Some(model) = session.model.clone() {
            section(ui, "Params", "What the scene lets you move: its `param`s, and numbers to which a `let` gives a name.", |ui| params::show(ui, session, &model, wishes));
            if model.moves {
                section(ui, "Time", "The `time` that the scene reads.", |ui| time(ui, session));
            }
        }
        section(ui, "Camera", "From where the scene is seen.", |ui| camera(ui, session, wishes));
        if session.mode == Mode::Slice {
            section(ui, "Slice", "A plane through the scene that shows its field.", |ui| slice(ui, session));
        }
        section(ui, "Accuracy", "How far the picture is from the truth.", |ui| accuracy::show(ui, session));
        section(ui, "Drawing", "How fine, and what draws.", |ui| drawing(ui, session));
    });
}

fn section(ui: &mut Ui, name: &str, help: &str, contents: impl FnOnce(&mut Ui)) {
    let title = RichText::new(name).strong().color(style::of(ui).weak);
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
        if ui.button(text).on_hover_text("Play or pause. Space").clicked() {
            clock.toggle();
        }
        if ui.button("To 0").on_hover_text("Back to 0.").clicked() {
            clock.time = 0.0;
        }
        let slider = egui::Slider::new(&mut clock.time, 0.0..=clock.end.max(0.1));
        ui.add(slider.show_value(false)).on_hover_text("The scene's `time`.");
        let seconds = egui::DragValue::new(&mut clock.time).range(0.0..=f64::INFINITY);
        let seconds = ui.add(seconds.speed(0.02).fixed_decimals(2).suffix(" s"));
        seconds.on_hover_text("The scene's `time`: drag, or click to type.");
    });
    ui.horizontal(|ui| {
        let speed = egui::DragValue::new(&mut clock.speed).speed(0.02).range(-10.0..=10.0);
        ui.add(speed.suffix("×")).on_hover_text("Speed.");
        ui.checkbox(&mut clock.looping, "loop").on_hover_text("Start again at the end.");
        let end = egui::DragValue::new(&mut clock.end).speed(0.1).range(0.1..=3600.0);
        ui.add(end.prefix("at ").suffix(" s")).on_hover_text("The end.");
    });
}

fn camera(ui: &mut Ui, session: &mut Session, wishes: &mut Vec<Wish>) {
    let Some(orbit) = session.orbit().copied() else { return };
    ui.horizontal_wrapped(|ui| {
        if ui.button("Frame").on_hover_text("See all of the scene. F").clicked() {
            session.frame_all();
        }
        let home = ui.add_enabled(!session.follows(), egui::Button::new("Scene's own"));
        let home = home.on_hover_text("Back to the camera of the scene. H");
        if home.on_disabled_hover_text("The camera is the scene's own.").clicked() {
            session.go_home();
        }
        if ui.button("Copy").on_hover_text(format!("Copy {}", orbit.text())).clicked() {
            wishes.push(Wish::Copy(orbit.text()));
        }
    });
    let sides = [
        ("Front", Side::Front, "From the front. 1"),
        ("Right", Side::Right, "From the right. 3"),
        ("Top", Side::Top, "From above. 7"),
        ("Back", Side::Back, "From behind. 2"),
        ("Left", Side::Left, "From the left. 4"),
        ("Bottom", Side::Bottom, "From below. 8"),
    ];
    for row in sides.chunks(3) {
        ui.columns(3, |columns| {
            for ((name, side, help), ui) in row.iter().zip(columns) {
                let button = egui::Button::new(RichText::new(*name).small());
                let size = egui::vec2(ui.available_width(), 18.0);
                if ui.add_sized(size, button).on_hover_text(*help).clicked() {
                    session.move_camera(|orbit| orbit.look_from(*side));
                }
            }
        });
    }
    ui.horizontal(|ui| {
        let mut parallel = orbit.is_parallel();
        if ui
            .checkbox(&mut parallel, "parallel")
            .on_hover_text("Rays without perspective. P")
            .changed()
        {
            session.move_camera(|orbit| orbit.set_parallel(parallel));
        }
        ui.checkbox(&mut session.guides, "axes").on_hover_text(
            "Where the axes point, and the box that the scene lies in, if it ends. B",
        );
        if let Some(fov) = orbit.fov() {
            let mut degrees = fov.to_degrees();
            let drag = egui::DragValue::new(&mut degrees).range(2.0..=150.0).speed(0.3);
            let drag = ui.add(drag.suffix("°").max_decimals(1));
            if drag.on_hover_text("Vertical field of view.").changed() {
                session.move_camera(|orbit| orbit.set_fov(degrees.to_radians()));
            }
        }
    });
}

fn slice(ui: &mut Ui, session: &mut Session) {
    let slice = &mut session.slice;
    ui.horizontal(|ui| {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            ui.selectable_value(&mut slice.axis, axis, name)
                .on_hover_text("The axis that the plane crosses at right angles.");
        }
        let drag = egui::DragValue::new(&mut slice.offset).speed(0.01).max_decimals(4);
        ui.add(drag.prefix("at ")).on_hover_text("Where it crosses it.");
    });
    ui.checkbox(&mut slice.over, "over the scene")
        .on_hover_text("Shown also where something stands before it: the inside of what it cuts.");
    let drag = egui::DragValue::new(&mut slice.spacing).speed(0.005).range(1e-4..=1e4);
    ui.add(drag.prefix("a line every ").max_decimals(4)).on_hover_text("In scene units.");
}

fn drawing(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        ui.label("rays a pixel");
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
    let mut live = session.build().live;
    let text = "Numbers in the scene are shader inputs, so that a changed one shows without a new shader. Without, \
                they are constants, and the shader is the fastest one.";
    if ui.checkbox(&mut live, "live numbers").on_hover_text(text).changed() {
        session.set_build(|build| build.live = live);
    }
    let mut on_cpu = session.build().on_cpu;
    let text =
        "Draw on the processor, with the second implementation that the shader is checked against.";
    if ui.checkbox(&mut on_cpu, "on the processor").on_hover_text(text).changed() {
        session.set_build(|build| build.on_cpu = on_cpu);
    }
}
