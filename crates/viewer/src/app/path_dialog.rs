//! Asks for a path: of a new scene, of a scene to open, or of a copy.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use eframe::egui::{self, Context, Key, RichText, Ui};

use super::theme;
use crate::session::Session;

/// The contents of a new scene.
pub const NEW_SCENE: &str = "// A new scene. Type, or hold Alt and drag a number. F1 lists all keys.\n\
     sphere(0.5).translate(y: 0.5).color(#e07a4f)\n\
     plane()\n";
/// The most files of a folder that are listed.
const MAX_LISTED: usize = 200;

/// What the path is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A scene is created there.
    New,
    /// The scene there is opened.
    Open,
    /// The scene is written there, with its changed numbers.
    SaveAs,
}

impl Purpose {
    fn title(self) -> &'static str {
        match self {
            Self::New => "New scene",
            Self::Open => "Open a scene",
            Self::SaveAs => "Save the scene as",
        }
    }

    fn button(self) -> &'static str {
        match self {
            Self::New => "Create",
            Self::Open => "Open",
            Self::SaveAs => "Save",
        }
    }
}

/// The file that the user chose.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Chosen {
    /// Opens this scene.
    Open(PathBuf),
    /// The scene was written to this file, which becomes the scene.
    SavedAs(PathBuf),
}

/// The dialog, while it is shown.
#[derive(Debug, Default)]
pub struct PathDialog {
    purpose: Option<Purpose>,
    path: String,
    error: String,
    takes_focus: bool,
}

impl PathDialog {
    /// Opens the dialog with a proposed path.
    pub fn open(&mut self, purpose: Purpose, session: &Session) {
        let path = session.path();
        let proposed = match purpose {
            Purpose::New => path.with_file_name("new.sdf"),
            Purpose::Open => path.parent().unwrap_or(Path::new("")).join(""),
            Purpose::SaveAs => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                path.with_file_name(format!("{stem}-copy.sdf"))
            }
        };
        let path = std::path::absolute(&proposed).unwrap_or(proposed).display().to_string();
        *self = Self { purpose: Some(purpose), path, error: String::new(), takes_focus: true };
    }

    /// Shows the dialog. Returns the file once it is chosen, and written if it is new.
    pub fn show(&mut self, ctx: &Context, session: &Session) -> Option<Chosen> {
        let purpose = self.purpose?;
        let modal = egui::Modal::new(egui::Id::unique("path"));
        let modal = modal.show(ctx, |ui| self.contents(ui, purpose, session));
        let chosen = modal.inner.clone().unwrap_or_default();
        if chosen.is_some() || modal.inner.is_none() || modal.should_close() {
            *self = Self::default();
        }
        chosen
    }

    /// Returns `None` if the dialog was cancelled, else the file if one was chosen.
    fn contents(
        &mut self,
        ui: &mut Ui,
        purpose: Purpose,
        session: &Session,
    ) -> Option<Option<Chosen>> {
        ui.set_width(460.0_f32.min(ui.ctx().content_rect().width() - 40.0));
        ui.label(RichText::new(purpose.title()).strong());
        let edit = egui::TextEdit::singleline(&mut self.path).desired_width(f32::INFINITY);
        let edit = ui.add(edit).on_hover_text("The path of the file, ending in .sdf.");
        if std::mem::take(&mut self.takes_focus) {
            edit.request_focus();
        }
        if edit.changed() {
            self.error.clear();
        }
        let mut accepted = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if purpose == Purpose::Open
            && let Some(listed) = listing(ui, Path::new(&self.path))
        {
            self.path = listed.display().to_string();
            if listed.is_dir() {
                self.path.push(std::path::MAIN_SEPARATOR);
            } else {
                accepted = true;
            }
        }
        if !self.error.is_empty() {
            ui.label(RichText::new(&self.error).small().color(theme::of(ui).error));
        }
        let mut cancelled = false;
        ui.horizontal(|ui| {
            accepted |=
                ui.button(purpose.button()).on_hover_text("Use this path (Enter).").clicked();
            cancelled = ui.button("Cancel").on_hover_text("Close this dialog (Esc).").clicked();
        });
        if cancelled {
            return None;
        }
        if !accepted {
            return Some(None);
        }
        let chosen = choose(purpose, PathBuf::from(self.path.trim()), session);
        Some(chosen.map_err(|why| self.error = why).ok())
    }
}

/// Writes the file if it is new.
fn choose(purpose: Purpose, path: PathBuf, session: &Session) -> Result<Chosen, String> {
    match purpose {
        Purpose::Open => match path.is_file() {
            true => Ok(Chosen::Open(path)),
            false => Err("there is no such file".to_owned()),
        },
        Purpose::New => create(&path, NEW_SCENE).map(|()| Chosen::Open(path)),
        Purpose::SaveAs => create(&path, &session.current_text()).map(|()| Chosen::SavedAs(path)),
    }
}

/// Writes a new file.
///
/// # Errors
///
/// The file exists, is no scene, or cannot be written. The message is one line.
pub fn create(path: &Path, text: &str) -> Result<(), String> {
    if path.extension().is_none_or(|ending| ending != "sdf") {
        return Err("a scene's name ends in .sdf".to_owned());
    }
    sdfc_files::create(path, text.as_bytes()).map_err(|error| {
        if error.kind() == ErrorKind::AlreadyExists {
            "this file exists; choose another name".to_owned()
        } else {
            format!("cannot write {}: {error}", path.display())
        }
    })
}

/// Lists folders and scenes of the path's folder. Returns the one that was clicked.
fn listing(ui: &mut Ui, path: &Path) -> Option<PathBuf> {
    let is_folder = path.as_os_str().to_string_lossy().ends_with(std::path::MAIN_SEPARATOR);
    let folder = if is_folder { path } else { path.parent()? };
    let is_hidden =
        |path: &PathBuf| path.file_name().is_some_and(|it| it.to_string_lossy().starts_with('.'));
    let is_listed = |path: &PathBuf| {
        !is_hidden(path) && (path.extension().is_some_and(|it| it == "sdf") || path.is_dir())
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|it| it.path()).filter(is_listed).collect();
    paths.sort_by_key(|path| (!path.is_dir(), path.clone()));
    paths.truncate(MAX_LISTED);
    let mut clicked = None;
    egui::ScrollArea::vertical().max_height(240.0).show(ui, |ui| {
        if let Some(parent) = folder.parent()
            && ui.button("..").on_hover_text(parent.display().to_string()).clicked()
        {
            clicked = Some(parent.to_owned());
        }
        for path in paths {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let name = if path.is_dir() { format!("{name}/") } else { name.into_owned() };
            if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                clicked = Some(path);
            }
        }
    });
    clicked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_scene_is_written_only_where_there_is_none() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        create(&path, NEW_SCENE).unwrap();
        assert!(create(&path, "").unwrap_err().contains("exists"));
        assert!(create(&folder.path().join("a.png"), "").is_err());
        assert!(create(&folder.path().join("b").join("a.sdf"), "").is_err());
        let compiled = sdfc::Compiler::new().compile("a", NEW_SCENE).unwrap();
        assert!(compiled.draws() && compiled.diagnostics().is_empty());
    }
}
