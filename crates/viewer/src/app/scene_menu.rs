//! The menu behind the scene's name: examples, recent scenes, scenes in the same folder, the theme.

use std::path::{Path, PathBuf};

use eframe::egui::{self, RichText, Ui};

use super::path_dialog::Purpose;
use super::theme;
use crate::examples::{EXAMPLES, Example};
use crate::session::Session;
use crate::settings::{Settings, examples_folder};

/// The most scenes of the same folder that are listed.
const MAX_IN_FOLDER: usize = 60;
/// The most recent scenes that are listed.
const MAX_RECENT: usize = 15;

/// The user's choice.
pub enum Choice {
    /// Open this scene.
    Open(PathBuf),
    /// Ask for a path.
    Ask(Purpose),
    /// Show the examples.
    ShowExamples,
    /// An example could not be written; why.
    Failed(String),
}

/// Shows the scene's name as a button that opens the menu.
pub fn show(ui: &mut Ui, session: &mut Session, settings: &mut Settings) -> Option<Choice> {
    let path = &session.path().to_owned();
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut choice = None;
    let button = (RichText::new(&name).strong(), RichText::new("▾").monospace());
    let menu = ui.menu_button(button, |ui| {
        ui.set_min_width(180.0);
        for (purpose, text, help) in [
            (Purpose::New, "New…", "Create a scene."),
            (Purpose::Open, "Open…", "Open a scene by its path."),
            (
                Purpose::SaveAs,
                "Save as…",
                "Write the scene with its changed numbers to a new file.",
            ),
        ] {
            if ui.button(text).on_hover_text(help).clicked() {
                choice = Some(Choice::Ask(purpose));
                ui.close();
            }
        }
        ui.separator();
        restore_example(ui, session, &mut choice);
        let text = "Example scenes, each about one feature. Opening one copies it to a file of \
                    yours.";
        if ui.button("Examples…").on_hover_text(text).clicked() {
            choice = Some(Choice::ShowExamples);
            ui.close();
        }
        let menu = ui.menu_button("Open recent", |ui| recent(ui, path, settings, &mut choice));
        menu.response.on_hover_text("Scenes that were open before, the last one first.");
        let menu = ui.menu_button("In this folder", |ui| in_folder(ui, path, &mut choice));
        menu.response.on_hover_text("Other scenes in the folder of this one.");
        ui.label(RichText::new("or drop a file on the window").small().color(theme::of(ui).weak));
        ui.separator();
        let light = ui.checkbox(&mut settings.light, "Light theme");
        if light.on_hover_text("Dark text on light panels.").clicked() {
            theme::set_light(ui.ctx(), settings.light);
        }
        let text = "A drag with the middle button turns the camera, and with Shift it moves the \
                    camera, as in Blender.";
        ui.checkbox(&mut session.middle_turns, "Middle button turns").on_hover_text(text);
    });
    // The arrow is no part of the name.
    menu.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
    let text = format!("{}\n\nOpens and creates scenes.", path.display());
    menu.response.on_hover_text(text);
    choice
}

/// Shows a button that restores the open example, if it was edited.
fn restore_example(ui: &mut Ui, session: &Session, choice: &mut Option<Choice>) {
    let folder = examples_folder().filter(|folder| session.path().parent() == Some(folder));
    let is_open = |example: &&Example| session.path().file_stem() == Some(example.name.as_ref());
    let Some((folder, example)) = folder.zip(EXAMPLES.iter().find(is_open)) else { return };
    let edited = **session.text() != *example.source;
    let button = ui.add_enabled(edited, egui::Button::new("Restore example"));
    let text = "Open the example as it was. Your version is kept in a file beside it.";
    let button = button.on_hover_text(text);
    if button.on_disabled_hover_text("The example has not been edited.").clicked() {
        let restored = example.restore_in(&folder);
        *choice = Some(restored.map_or_else(Choice::Failed, Choice::Open));
        ui.close();
    }
}

fn recent(ui: &mut Ui, current: &Path, settings: &Settings, choice: &mut Option<Choice>) {
    ui.set_min_width(160.0);
    let current = std::path::absolute(current).unwrap_or_default();
    let paths = settings.scenes.iter().map(|scene| PathBuf::from(&scene.path));
    let others = paths.filter(|path| *path != current && path.is_file());
    list(ui, others.take(MAX_RECENT).collect(), choice);
}

fn in_folder(ui: &mut Ui, current: &Path, choice: &mut Option<Choice>) {
    ui.set_min_width(160.0);
    let folder = current.parent().filter(|it| !it.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let is_scene = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "sdf");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_scene).collect();
    paths.retain(|path| path.file_name() != current.file_name());
    paths.sort();
    paths.truncate(MAX_IN_FOLDER);
    list(ui, paths, choice);
}

fn list(ui: &mut Ui, paths: Vec<PathBuf>, choice: &mut Option<Choice>) {
    if paths.is_empty() {
        ui.label(RichText::new("none").color(theme::of(ui).weak));
    }
    egui::ScrollArea::vertical().max_height(460.0).show(ui, |ui| {
        for path in paths {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                *choice = Some(Choice::Open(path));
                ui.close();
            }
        }
    });
}
