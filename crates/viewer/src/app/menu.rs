//! The menu of scenes: examples, what was open before, what lies beside the scene, the theme.

use std::path::{Path, PathBuf};

use eframe::egui::{self, RichText, Ui};

use super::style;
use crate::examples::EXAMPLES;
use crate::memory::{Memory, examples_folder};

/// Scenes that lie beside this one which are listed.
const MOST_BESIDE: usize = 60;
/// Scenes that were open before which are listed.
const MOST_RECENT: usize = 15;

/// What was chosen.
pub enum Choice {
    /// Another scene is to be shown.
    Open(PathBuf),
    /// Something did not work.
    Failed(String),
}

/// The name of the scene, as a button that opens the menu.
pub fn show(ui: &mut Ui, path: &Path, memory: &mut Memory) -> Option<Choice> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut choice = None;
    let menu = ui.menu_button(RichText::new(name).strong(), |ui| {
        ui.set_min_width(180.0);
        let menu = ui.menu_button("Examples", |ui| examples(ui, &mut choice));
        menu.response.on_hover_text("Scenes to begin with, each of which shows one thing.");
        let menu = ui.menu_button("Open before", |ui| recent(ui, path, memory, &mut choice));
        menu.response.on_hover_text("Scenes that this window has shown, the last one first.");
        let menu = ui.menu_button("In this folder", |ui| beside(ui, path, &mut choice));
        menu.response.on_hover_text("Scenes beside this one.");
        ui.label(RichText::new("or drop a file on the window").small().color(style::of(ui).weak));
        ui.separator();
        let light = ui.checkbox(&mut memory.light, "Light");
        if light.on_hover_text("Dark writing on light panels.").clicked() {
            style::set_light(ui.ctx(), memory.light);
        }
    });
    let text = format!("{}\n\nOpens examples and other scenes.", path.display());
    menu.response.on_hover_text(text);
    choice
}

fn examples(ui: &mut Ui, choice: &mut Option<Choice>) {
    ui.set_min_width(160.0);
    let Some(folder) = examples_folder() else {
        ui.label("there is no home folder to put them in");
        return;
    };
    let scroll = egui::ScrollArea::vertical().max_height(460.0);
    scroll.show(ui, |ui| {
        for example in EXAMPLES {
            let place = format!("\n\nOpened as a file of yours in {}.", folder.display());
            let button = ui.button(example.name).on_hover_text(example.summary() + &place);
            if button.clicked() {
                let made = example.file_in(&folder);
                *choice = Some(made.map_or_else(Choice::Failed, Choice::Open));
                ui.close();
            }
        }
    });
}

fn recent(ui: &mut Ui, current: &Path, memory: &Memory, choice: &mut Option<Choice>) {
    ui.set_min_width(160.0);
    let current = std::path::absolute(current).unwrap_or_default();
    let paths = memory.scenes.iter().map(|scene| PathBuf::from(&scene.path));
    let others = paths.filter(|path| *path != current && path.is_file());
    list(ui, others.take(MOST_RECENT).collect(), choice);
}

fn beside(ui: &mut Ui, current: &Path, choice: &mut Option<Choice>) {
    ui.set_min_width(160.0);
    let folder = current.parent().filter(|it| !it.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let is_scene = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "sdf");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_scene).collect();
    paths.retain(|path| path.file_name() != current.file_name());
    paths.sort();
    paths.truncate(MOST_BESIDE);
    list(ui, paths, choice);
}

fn list(ui: &mut Ui, paths: Vec<PathBuf>, choice: &mut Option<Choice>) {
    if paths.is_empty() {
        ui.label(RichText::new("none").color(style::of(ui).weak));
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
