//! How a session handles the events of its workers.

use std::sync::Arc;
use std::time::Instant;

use sdfc_render::Pose;

use super::Session;
use crate::compile::request::{CompileEvent, CompileReport, FileTexts};
use crate::render::picture::RenderEvent;
use crate::scene::model::Model;
use crate::session::orbit_camera::OrbitCamera;

/// After this many device losses without a picture in between, the CPU draws.
const MAX_DEVICE_LOSSES: u32 = 3;

impl Session {
    /// Handles the events of all workers. Returns true if anything changed.
    pub fn poll(&mut self) -> bool {
        let mut changed = false;
        while let Ok(report) = self.compile_reports.try_recv() {
            self.handle_compile_report(report);
            changed = true;
        }
        while let Ok(event) = self.render_events.try_recv() {
            self.handle_render_event(event);
            changed = true;
        }
        while let Ok(outcome) = self.export_outcomes.try_recv() {
            self.handle_export_outcome(outcome);
            changed = true;
        }
        while let Ok(answer) = self.language_answers.try_recv() {
            self.language = Some(answer);
            changed = true;
        }
        changed |= self.entry_pictures.poll() | self.handles.poll();
        changed | self.lit_shapes.poll() | self.accuracy.poll()
    }

    fn handle_compile_report(&mut self, report: CompileReport) {
        // Another scene may have been opened since the build began.
        if report.path == *self.path() {
            self.handle_compile_event(report.event, report.began);
        }
    }

    fn handle_compile_event(&mut self, event: CompileEvent, began: Instant) {
        match event {
            CompileEvent::Unreadable(why) => {
                self.building = false;
                let shown = if self.model.is_some() { "; showing the last version" } else { "" };
                self.problem = Some(format!("{why}{shown}"));
                self.watch_own_folder();
            }
            CompileEvent::BuildingPipeline => self.building = true,
            CompileEvent::FilesChanged(files) => self.set_read(files, began),
            CompileEvent::Compiled { text, imports, files, diagnostics, folders, draws: _ } => {
                self.set_read(files, began);
                self.tabs.keep_imports(&imports);
                (self.diagnosed, self.diagnosed_imports) = (text, imports);
                (self.diagnostics, self.building, self.problem) = (diagnostics, false, None);
                let refused = self.watcher.set_folders(&folders);
                if let Some(folder) = refused.first() {
                    let folder = folder.display();
                    self.problem = Some(format!("cannot watch {folder} for changes"));
                }
            }
            CompileEvent::Empty => {
                let text = "the scene draws nothing: write a shape on a line of its own";
                self.problem = Some(text.to_owned());
            }
            CompileEvent::Failed(why) => (self.building, self.problem) = (false, Some(why)),
            CompileEvent::Ready(model) => self.set_model(model),
        }
    }

    /// Records the texts of the files as they were read after a moment.
    fn set_read(&mut self, files: FileTexts, after: Instant) {
        self.tabs.set_read(files.imports, after);
        self.edit(|draft| files.scene.into_iter().for_each(|file| draft.set_read(file, after)));
    }

    fn set_model(&mut self, model: Arc<Model>) {
        self.building = false;
        self.carry_values_over(&model);
        let is_edit = self.model.is_some();
        let before = self.stated_camera();
        self.model = Some(model);
        let after = self.stated_camera();
        // A user who edits the scene's camera wants to see it.
        self.follows_scene |= is_edit && after.is_some() && before != after;
        if self.camera.is_none() {
            self.camera = Some(OrbitCamera::new(&Pose::fitted(None, 1.0)));
        }
    }

    /// The camera that the scene states, with params at their defaults.
    fn stated_camera(&self) -> Option<Pose> {
        let model = self.model.as_ref()?;
        let program = model.scene.program();
        program.settings.camera?;
        Pose::new(program, &model.defaults(), None, 1.0).ok()
    }

    fn handle_render_event(&mut self, event: RenderEvent) {
        match event {
            RenderEvent::Picture(picture) => {
                (self.render_error, self.device_losses) = (None, 0);
                (self.picture, self.moving) = (Some(picture), None);
                self.picture_count += 1;
            }
            RenderEvent::Moving(moving) => {
                (self.render_error, self.device_losses) = (None, 0);
                self.moving = Some(moving);
            }
            RenderEvent::Failed { message, machine, device_generation } => {
                self.render_error = Some(message);
                // Every request to a lost device fails; new devices are requested only once.
                let is_first = device_generation == self.build.device_generation;
                if machine && is_first && !self.build.on_cpu {
                    self.device_losses += 1;
                    let on_cpu = self.device_losses > MAX_DEVICE_LOSSES;
                    self.messages.push(if on_cpu {
                        format!("the GPU was lost {} times: drawing on the CPU", self.device_losses)
                    } else {
                        "the GPU was lost and is opened again".to_owned()
                    });
                    self.update_build(|build| {
                        build.device_generation += 1;
                        build.on_cpu = on_cpu;
                    });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::mpsc::{Receiver, channel};

    use super::*;
    use crate::session::save_state::{SaveState, Saved};
    use crate::test_support::TIMEOUT;

    /// A session with a scene that draws nothing, which reports when a worker wakes the window.
    fn opened(path: &Path) -> (Session, Receiver<()>) {
        std::fs::write(path, "let a = 1\n").unwrap();
        let (sender, woken) = channel();
        // Sending fails only at the end of a test.
        let wake = move || sender.send(()).unwrap_or_default();
        (Session::open(path, Arc::new(wake)).unwrap(), woken)
    }

    #[test]
    fn what_was_built_of_another_scene_is_ignored() {
        let folder = tempfile::tempdir().unwrap();
        let (mut session, woken) = opened(&folder.path().join("a.sdf"));
        woken.recv_timeout(TIMEOUT).unwrap();
        session.handles.selected = Some("r".to_owned());
        session.open_other(folder.path().join("missing.sdf"));
        while session.problem.is_none() {
            woken.recv_timeout(TIMEOUT).unwrap();
            session.poll();
        }
        assert_eq!((&**session.text(), &session.handles.selected), ("", &None));
        assert!(session.problem.as_ref().unwrap().contains("missing.sdf"), "{:?}", session.problem);
    }

    #[test]
    fn the_answer_about_a_scene_of_the_same_name_is_not_used() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("b")).unwrap();
        let (mut session, _woken) = opened(&folder.path().join("a.sdf"));
        session.ask_about_text(None);
        let answer = session.language_answers.recv_timeout(TIMEOUT).unwrap();
        session.language = Some(answer.clone());
        assert!(session.answer_about_text().is_some());
        session.open_other(folder.path().join("b").join("a.sdf"));
        assert!(session.language.is_none());
        // It may arrive only now.
        session.language = Some(answer);
        assert!(session.answer_about_text().is_none());
    }

    #[test]
    fn a_build_that_began_before_the_file_was_saved_does_not_bring_its_text_back() {
        let folder = tempfile::tempdir().unwrap();
        let (mut session, _woken) = opened(&folder.path().join("a.sdf"));
        let compiled = session.compile_reports.recv_timeout(TIMEOUT).unwrap();
        let again = || CompileReport {
            path: compiled.path.clone(),
            began: compiled.began,
            event: CompileEvent::FilesChanged(FileTexts {
                scene: Some("let a = 1\n".into()),
                ..FileTexts::default()
            }),
        };
        session.handle_compile_report(again());
        session.edit(|draft| draft.set_text("let a = 2\n"));
        session.save_to_file(Saved::All);
        let outcome = session.export_outcomes.recv_timeout(TIMEOUT).unwrap();
        session.handle_export_outcome(outcome);
        assert_eq!(session.save_state(), SaveState::Idle);
        session.handle_compile_report(again());
        assert_eq!((&**session.text(), session.has_unsaved_changes()), ("let a = 2\n", false));
    }
}
