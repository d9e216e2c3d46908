//! What is taken out of the window: a picture, an animation, a shader, the window itself.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Context, RichText, Ui};
use sdfc::render::MAX_SIDE;
use sdfc::{Backend, Emit, PictureOptions, ShaderOptions, Stage, Target};

use super::{params, style};
use crate::clerk::Errand;
use crate::session::Session;

/// Hundredths of a second that a frame of an animation is shown.
const HUNDREDTHS: u32 = 4;

/// What is saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    Picture,
    Animation,
    Shader,
    Window,
}

impl What {
    const ALL: [(Self, &'static str, &'static str); 4] = [
        (
            Self::Picture,
            "Picture",
            "Of any size, drawn in tiles, as .png or, in linear light, .exr.",
        ),
        (Self::Animation, "Animation", "From time 0 to the end that the clock has, as .gif."),
        (
            Self::Shader,
            "Shader",
            "Of the scene with its numbers as constants, for your own program.",
        ),
        (Self::Window, "Window", "What the window shows, panels and all, as .png."),
    ];
}

/// The dialog, and what was chosen in it last.
#[derive(Clone, Debug)]
pub struct Save {
    /// Whether it is shown.
    pub open: bool,
    what: What,
    /// The file; empty until the dialog is opened for a scene.
    path: String,
    /// The scene that the path was made for.
    scene: PathBuf,
    size: [u32; 2],
    samples: u32,
    seconds: f64,
    target: Target,
    emit: Emit,
    stage: Stage,
    /// Where the window goes once it shows no dialog.
    capture: Option<PathBuf>,
}

impl Default for Save {
    fn default() -> Self {
        Self {
            open: false,
            what: What::Picture,
            path: String::new(),
            scene: PathBuf::new(),
            size: [1920, 1080],
            samples: 16,
            seconds: 4.0,
            target: Target::Wgsl,
            emit: Emit::Field,
            stage: Stage::Compute,
            capture: None,
        }
    }
}

impl Save {
    /// Shows the dialog where it is open.
    pub fn show(&mut self, ctx: &Context, session: &Session) {
        if let Some(path) = self.capture.take() {
            screenshot(ctx, path, session);
        }
        if self.open && self.scene != session.path() {
            self.scene = session.path().to_owned();
            self.path = self.proposed();
        }
        let mut open = self.open;
        let window = egui::Window::new("Save").open(&mut open).resizable(false).collapsible(false);
        window.default_pos([80.0, 60.0]).show(ctx, |ui| self.contents(ui, session));
        self.open &= open;
    }

    fn contents(&mut self, ui: &mut Ui, session: &Session) {
        ui.set_width(400.0);
        ui.horizontal(|ui| {
            for (what, name, help) in What::ALL {
                if ui.selectable_value(&mut self.what, what, name).on_hover_text(help).clicked() {
                    self.path = self.proposed();
                }
            }
        });
        ui.separator();
        match self.what {
            What::Picture => self.picture(ui),
            What::Animation => {
                self.picture(ui);
                let drag = params::drag(&mut self.seconds).range(0.04..=600.0).speed(0.05);
                labelled(ui, "length", |ui| {
                    ui.add(drag.suffix(" s")).on_hover_text("25 frames a second, from time 0.");
                });
            }
            What::Shader => self.shader(ui),
            What::Window => {}
        }
        labelled(ui, "file", |ui| {
            let edit = egui::TextEdit::singleline(&mut self.path).desired_width(f32::INFINITY);
            ui.add(edit).on_hover_text(&self.path);
        });
        let path = PathBuf::from(&self.path);
        let trouble = self.trouble(&path, session);
        ui.horizontal(|ui| {
            let ready = trouble.is_none() && session.model.is_some();
            let button = ui.add_enabled(ready, egui::Button::new("Save"));
            let button =
                button.on_hover_text("Written in the background, whole or not at all. Enter");
            let entered = ready && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if button.clicked() || entered {
                self.save(ui.ctx(), path.clone(), session);
            }
            let (text, color) = match trouble {
                Some(trouble) => (trouble, style::of(ui).warning),
                None if path.exists() => ("replaces that file".to_owned(), style::of(ui).weak),
                None => (String::new(), style::of(ui).weak),
            };
            ui.label(RichText::new(text).small().color(color));
        });
    }

    fn picture(&mut self, ui: &mut Ui) {
        labelled(ui, "size", |ui| {
            let [width, height] = &mut self.size;
            ui.add(egui::DragValue::new(width).range(1..=MAX_SIDE).speed(4))
                .on_hover_text("Width in pixels.");
            ui.label("×");
            ui.add(egui::DragValue::new(height).range(1..=MAX_SIDE).speed(4))
                .on_hover_text("Height in pixels.");
            for (name, size) in [("HD", [1920, 1080]), ("4K", [3840, 2160]), ("square", [2048; 2])]
            {
                let text = format!("{} × {} pixels.", size[0], size[1]);
                if ui.small_button(name).on_hover_text(text).clicked() {
                    self.size = size;
                }
            }
        });
        labelled(ui, "rays a pixel", |ui| {
            for count in [1, 4, 16, 64] {
                ui.selectable_value(&mut self.samples, count, count.to_string())
                    .on_hover_text("Rays averaged in each pixel: more are smoother, and take as many times longer.");
            }
        });
    }

    fn shader(&mut self, ui: &mut Ui) {
        labelled(ui, "language", |ui| {
            let combo = egui::ComboBox::from_id_salt("target").selected_text(self.target.name());
            let combo = combo.show_ui(ui, |ui| {
                for target in Target::ALL {
                    let choice = ui.selectable_value(&mut self.target, target, target.name());
                    if choice.on_hover_text("What your program reads.").clicked() {
                        self.path = self.proposed();
                    }
                }
            });
            combo.response.on_hover_text("What your program reads.");
        });
        if self.target == Target::Shadertoy {
            self.emit = Emit::Render;
            return;
        }
        labelled(ui, "what", |ui| {
            let parts = [
                (Emit::Field, "field", "Distance, gradient and material as functions."),
                (Emit::March, "march", "The same and a ray method."),
                (Emit::Render, "render", "The whole shader that draws pictures."),
            ];
            for (emit, name, help) in parts {
                ui.selectable_value(&mut self.emit, emit, name).on_hover_text(help);
            }
        });
        if self.emit == Emit::Render {
            if !self.target.has_stage(self.stage) {
                self.stage = Stage::Fragment;
            }
            labelled(ui, "stage", |ui| {
                for stage in [Stage::Compute, Stage::Fragment] {
                    let there = self.target.has_stage(stage);
                    let button = egui::Button::selectable(self.stage == stage, stage.name());
                    let button = ui
                        .add_enabled(there, button)
                        .on_hover_text("Of the pipeline that runs it.");
                    let why = "The language has no such stage.";
                    if button.on_disabled_hover_text(why).clicked() {
                        self.stage = stage;
                    }
                }
            });
        }
    }

    /// Beside the scene, by its name.
    fn proposed(&self) -> String {
        let ending = match self.what {
            What::Picture => "png",
            What::Animation => "gif",
            What::Window => "window.png",
            What::Shader => match self.target {
                Target::Wgsl => "wgsl",
                Target::Glsl | Target::GlslEs | Target::Shadertoy => "glsl",
                Target::Hlsl => "hlsl",
                Target::Msl => "metal",
                Target::Spirv => "spv",
            },
        };
        self.scene.with_extension(ending).display().to_string()
    }

    fn trouble(&self, path: &Path, session: &Session) -> Option<String> {
        let place = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if self.path.trim().is_empty() {
            return Some("name a file".to_owned());
        }
        if place(path) == place(session.path()) || path.extension().is_some_and(|it| it == "sdf") {
            return Some("a scene is not written over".to_owned());
        }
        match self.what {
            What::Picture | What::Window => sdfc_files::Format::of(path).err(),
            What::Animation if path.extension().is_none_or(|ending| ending != "gif") => {
                Some("animations are written as .gif".to_owned())
            }
            What::Animation | What::Shader => None,
        }
    }

    fn save(&mut self, ctx: &Context, path: PathBuf, session: &Session) {
        let Some(model) = &session.model else { return };
        let frames = match self.what {
            What::Picture => vec![session.values(model)],
            What::Animation => session.frames(model, self.seconds, HUNDREDTHS),
            What::Shader => {
                let (scene, text) = (self.scene.clone(), session.knobs.rewritten(model));
                let (target, emit, stage) = (self.target, self.emit, self.stage);
                let method = session.build().method.clone();
                let options = ShaderOptions { target, emit, stage, method, ..Default::default() };
                return session.clerk().send(Errand::Shader { scene, text, path, options });
            }
            What::Window => {
                (self.open, self.capture) = (false, Some(path));
                return ctx.request_repaint();
            }
        };
        let options = PictureOptions {
            size: self.size,
            method: session.build().method.clone(),
            backend: if session.build().on_cpu { Backend::Cpu } else { Backend::Auto },
            pose: session.moved_pose(),
            tolerance: session.tolerance,
            samples: Some(self.samples),
            ..PictureOptions::default()
        };
        let (model, options) = (std::sync::Arc::clone(model), Box::new(options));
        let errand = Errand::Picture { model, path, options, frames, hundredths: HUNDREDTHS };
        session.clerk().send(errand);
    }
}

/// Asks for the next frame of the window, without the dialog in it.
fn screenshot(ctx: &Context, path: PathBuf, session: &Session) {
    let errands = session.clerk().errands();
    ctx.request_screenshot(move |image| {
        let size = image.size.map(|side| side as u32);
        let rgba = image.as_raw().to_vec();
        errands(Errand::Screen { path, size, rgba });
    });
}

fn labelled(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        let left = egui::Layout::left_to_right(egui::Align::Center);
        ui.allocate_ui_with_layout(egui::vec2(76.0, 18.0), left, |ui| {
            ui.set_min_width(76.0);
            ui.label(RichText::new(name).color(style::of(ui).weak));
        });
        contents(ui);
    });
}
