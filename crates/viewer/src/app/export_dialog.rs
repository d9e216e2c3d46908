//! The export dialog: a picture, an animation, a shader, or a screenshot of the window.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use eframe::egui::{self, Context, RichText, Ui};
use sdfc::{Backend, Emit, PictureOptions, ShaderOptions, Stage, Target};
use sdfc_render::MAX_SIDE;

use super::number_widget::number_drag;
use super::theme;
use crate::export::exporter::ExportJob;
use crate::session::Session;

/// The duration of each frame of an animation, in hundredths of a second.
const HUNDREDTHS: u32 = 4;
/// The shortest and the longest animation, in seconds.
const SECONDS: RangeInclusive<f64> = 0.04..=600.0;

/// The kind of file that is exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ExportKind {
    Picture,
    Animation,
    Shader,
    Screenshot,
}

impl ExportKind {
    const ALL: [(Self, &'static str, &'static str); 4] = [
        (
            Self::Picture,
            "Picture",
            "A picture of any size, as .png, or as .exr with linear colours.",
        ),
        (Self::Animation, "Animation", "The scene from time 0 for a number of seconds, as .gif."),
        (
            Self::Shader,
            "Shader",
            "A shader for your own program, with the scene's numbers as constants.",
        ),
        (Self::Screenshot, "Screenshot", "The window with its panels, as .png."),
    ];
}

/// Pixels and samples of an exported picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct PictureSize {
    size: [u32; 2],
    samples: u32,
}

/// The dialog, with the last choices.
#[derive(Clone, Debug)]
pub struct ExportDialog {
    kind: ExportKind,
    /// The file; empty until the dialog is opened.
    path: String,
    /// The scene that the file name was proposed for.
    scene: PathBuf,
    picture: PictureSize,
    /// Smaller, because an animation has many pictures.
    animation: PictureSize,
    /// The length of an animation in seconds, if the user gives another one than the clock's end.
    seconds: Option<f64>,
    /// An existing file that the user was asked about and that may be replaced if asked again.
    replaces: Option<PathBuf>,
    /// True until the file's name has the keyboard.
    was_opened: bool,
    target: Target,
    emit: Emit,
    stage: Stage,
    /// The file for a screenshot of the next frame, which does not show the dialog.
    screenshot: Option<PathBuf>,
}

impl Default for ExportDialog {
    fn default() -> Self {
        Self {
            kind: ExportKind::Picture,
            path: String::new(),
            scene: PathBuf::new(),
            picture: PictureSize { size: [1920, 1080], samples: 16 },
            animation: PictureSize { size: [640, 360], samples: 4 },
            seconds: None,
            replaces: None,
            was_opened: true,
            target: Target::Wgsl,
            emit: Emit::Field,
            stage: Stage::Compute,
            screenshot: None,
        }
    }
}

impl ExportDialog {
    /// Shows the dialog if it is open.
    pub fn show(&mut self, ctx: &Context, session: &Session, open: &mut bool) {
        if let Some(path) = self.screenshot.take() {
            take_screenshot(ctx, path, session);
        }
        if *open && self.scene != session.path() {
            self.scene = session.path().to_owned();
            self.path = self.proposed();
            self.seconds = None;
        }
        self.was_opened |= !*open;
        let mut stays_open = *open;
        let window =
            egui::Window::new("Export").open(&mut stays_open).resizable(false).collapsible(false);
        window.default_pos([80.0, 60.0]).show(ctx, |ui| self.contents(ui, session, open));
        *open &= stays_open;
    }

    fn contents(&mut self, ui: &mut Ui, session: &Session, open: &mut bool) {
        ui.set_width(400.0);
        ui.horizontal(|ui| {
            for (kind, name, help) in ExportKind::ALL {
                if ui.selectable_value(&mut self.kind, kind, name).on_hover_text(help).clicked() {
                    self.path = self.proposed();
                }
            }
        });
        ui.separator();
        match self.kind {
            ExportKind::Picture => picture_size(ui, &mut self.picture),
            ExportKind::Animation => {
                picture_size(ui, &mut self.animation);
                let before = self.length(session);
                let mut seconds = before;
                let drag = number_drag(&mut seconds).range(SECONDS).speed(0.05);
                labelled(ui, "length", |ui| {
                    let help = "In seconds from time 0, with 25 frames per second. It is the end \
                                of the clock unless you change it.";
                    ui.add(drag.suffix(" s")).on_hover_text(help);
                });
                if seconds != before {
                    self.seconds = Some(seconds);
                }
            }
            ExportKind::Shader => self.shader(ui),
            ExportKind::Screenshot => {}
        }
        let mut entered = false;
        labelled(ui, "file", |ui| {
            let edit = egui::TextEdit::singleline(&mut self.path).desired_width(f32::INFINITY);
            let edit = ui.add(edit).on_hover_text(&self.path);
            if std::mem::take(&mut self.was_opened) {
                edit.request_focus();
            }
            // Enter in a field for a number ends typing the number and does not save.
            entered = edit.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        });
        let path = PathBuf::from(&self.path);
        let problem = self.problem(&path, session);
        ui.horizontal(|ui| {
            let ready = problem.is_none() && session.model.is_some();
            let asks = self.replaces.as_ref() == Some(&path);
            let text = if asks { "Replace" } else { "Save" };
            let button = ui.add_enabled(ready, egui::Button::new(text));
            let button = button.on_hover_text("Write the file in the background (Enter).");
            if button.clicked() || entered && ready {
                if path.exists() && !asks {
                    self.replaces = Some(path.clone());
                } else {
                    self.replaces = None;
                    self.save(ui.ctx(), path.clone(), session, open);
                }
            }
            let text = match problem {
                Some(problem) => problem,
                None if self.replaces.as_ref() == Some(&path) => {
                    "the file exists: replace it?".to_owned()
                }
                None => String::new(),
            };
            ui.label(RichText::new(text).small().color(theme::of(ui).warning));
        });
    }

    /// The length of an animation in seconds.
    fn length(&self, session: &Session) -> f64 {
        self.seconds.unwrap_or(session.clock.end.clamp(*SECONDS.start(), *SECONDS.end()))
    }

    fn shader(&mut self, ui: &mut Ui) {
        labelled(ui, "language", |ui| {
            let combo = egui::ComboBox::from_id_salt("target").selected_text(self.target.name());
            let combo = combo.show_ui(ui, |ui| {
                for target in Target::ALL {
                    let choice = ui.selectable_value(&mut self.target, target, target.name());
                    if choice.on_hover_text("The shading language of your program.").clicked() {
                        self.path = self.proposed();
                    }
                }
            });
            combo.response.on_hover_text("The shading language of your program.");
        });
        if self.target == Target::Shadertoy {
            self.emit = Emit::Render;
            return;
        }
        labelled(ui, "contents", |ui| {
            let parts = [
                (Emit::Field, "field", "Functions of distance, gradient and material."),
                (Emit::March, "march", "The same, and the ray method."),
                (Emit::Render, "render", "The complete shader that draws the picture."),
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
                    let button = egui::Button::selectable(
                        self.stage == stage,
                        format!("{} stage", stage.name()),
                    );
                    let button = ui
                        .add_enabled(there, button)
                        .on_hover_text("The pipeline stage that runs the shader.");
                    let why = "The language has no such stage.";
                    if button.on_disabled_hover_text(why).clicked() {
                        self.stage = stage;
                    }
                }
            });
        }
    }

    /// A file beside the scene, with the scene's name.
    fn proposed(&self) -> String {
        let extension = match self.kind {
            ExportKind::Picture => "png",
            ExportKind::Animation => "gif",
            ExportKind::Screenshot => "window.png",
            ExportKind::Shader => match self.target {
                Target::Wgsl => "wgsl",
                Target::Glsl | Target::GlslEs | Target::Shadertoy => "glsl",
                Target::Hlsl => "hlsl",
                Target::Msl => "metal",
                Target::Spirv => "spv",
            },
        };
        self.scene.with_extension(extension).display().to_string()
    }

    /// Why the file cannot be written, if that is known before writing.
    fn problem(&self, path: &Path, session: &Session) -> Option<String> {
        let canonical =
            |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if self.path.trim().is_empty() {
            return Some("enter a file name".to_owned());
        }
        if canonical(path) == canonical(session.path())
            || path.extension().is_some_and(|it| it == "sdf")
        {
            return Some("a scene cannot be overwritten".to_owned());
        }
        match self.kind {
            ExportKind::Picture | ExportKind::Screenshot => sdfc_files::Format::of(path).err(),
            ExportKind::Animation
                if path.extension().is_none_or(|extension| extension != "gif") =>
            {
                Some("an animation must be a .gif file".to_owned())
            }
            ExportKind::Animation | ExportKind::Shader => None,
        }
    }

    fn save(&mut self, ctx: &Context, path: PathBuf, session: &Session, open: &mut bool) {
        let Some(model) = &session.model else { return };
        let frames = match self.kind {
            ExportKind::Picture => vec![session.values(model)],
            ExportKind::Animation => session.frames(model, self.length(session), HUNDREDTHS),
            ExportKind::Shader => {
                let (scene, source) =
                    (self.scene.clone(), session.param_values.source_with_values(&model.source));
                let (target, emit, stage) = (self.target, self.emit, self.stage);
                let method = session.build().method;
                let options =
                    ShaderOptions::new().target(target).emit(emit).stage(stage).method(method);
                return session.exports().send(ExportJob::Shader { scene, source, path, options });
            }
            ExportKind::Screenshot => {
                (*open, self.screenshot) = (false, Some(path));
                return ctx.request_repaint();
            }
        };
        let PictureSize { size, samples } = match self.kind {
            ExportKind::Animation => self.animation,
            ExportKind::Picture | ExportKind::Shader | ExportKind::Screenshot => self.picture,
        };
        let options = PictureOptions::new()
            .size(size)
            .method(session.build().method)
            .backend(if session.build().on_cpu { Backend::Cpu } else { Backend::Auto })
            .pose(session.manual_pose())
            .tolerance(session.tolerance)
            .samples(Some(samples));
        let (model, options) = (std::sync::Arc::clone(model), Box::new(options));
        let job = ExportJob::Picture { model, path, options, frames, hundredths: HUNDREDTHS };
        session.exports().send(job);
    }
}

/// Requests the pixels of the next frame, which does not show the dialog.
fn take_screenshot(ctx: &Context, path: PathBuf, session: &Session) {
    let send = session.exports().sender();
    ctx.request_screenshot(move |image| {
        let size = image.size.map(|side| side as u32);
        let rgba = image.as_raw().to_vec();
        send(ExportJob::Screenshot { path, size, rgba });
    });
}

fn picture_size(ui: &mut Ui, picture: &mut PictureSize) {
    labelled(ui, "size", |ui| {
        let [width, height] = &mut picture.size;
        ui.add(egui::DragValue::new(width).range(1..=MAX_SIDE).speed(4))
            .on_hover_text("Width in pixels.");
        ui.label("×");
        ui.add(egui::DragValue::new(height).range(1..=MAX_SIDE).speed(4))
            .on_hover_text("Height in pixels.");
        for (name, size) in [("HD", [1920, 1080]), ("4K", [3840, 2160]), ("square", [2048; 2])] {
            let text = format!("{} × {} pixels.", size[0], size[1]);
            if ui.small_button(name).on_hover_text(text).clicked() {
                picture.size = size;
            }
        }
    });
    labelled(ui, "samples", |ui| {
        for count in [1, 4, 16, 64] {
            ui.selectable_value(&mut picture.samples, count, count.to_string())
                .on_hover_text("Samples per pixel; more is smoother and slower.");
        }
    });
}

fn labelled(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        let left = egui::Layout::left_to_right(egui::Align::Center);
        ui.allocate_ui_with_layout(egui::vec2(76.0, 18.0), left, |ui| {
            ui.set_min_width(76.0);
            ui.label(RichText::new(name).color(theme::of(ui).weak));
        });
        contents(ui);
    });
}
