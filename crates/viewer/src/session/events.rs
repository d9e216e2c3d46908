//! How a session handles the events of its workers.

use std::sync::Arc;

use sdfc_render::Pose;

use super::Session;
use crate::compile::request::{CompileEvent, FileTexts};
use crate::render::picture::RenderEvent;
use crate::scene::model::Model;
use crate::session::orbit_camera::OrbitCamera;

/// After this many device losses without a picture in between, the CPU draws.
const MAX_DEVICE_LOSSES: u32 = 3;

impl Session {
    /// Handles the events of all workers. Returns true if anything changed.
    pub fn poll(&mut self) -> bool {
        let mut changed = false;
        while let Ok(event) = self.compile_events.try_recv() {
            self.handle_compile_event(event);
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

    fn handle_compile_event(&mut self, event: CompileEvent) {
        match event {
            CompileEvent::Unreadable(why) => {
                self.building = false;
                let shown = if self.model.is_some() { "; showing the last version" } else { "" };
                self.problem = Some(format!("{why}{shown}"));
                self.watch_own_folder();
            }
            CompileEvent::BuildingPipeline => self.building = true,
            CompileEvent::FilesChanged(files) => self.set_files(files),
            CompileEvent::Compiled { text, imports, files, diagnostics, folders, draws: _ } => {
                self.set_files(files);
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

    /// Records the texts of the files on disk.
    fn set_files(&mut self, files: FileTexts) {
        self.tabs.set_files(files.imports);
        self.edit(|draft| files.scene.into_iter().for_each(|file| draft.set_file(file)));
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
                self.picture = Some(picture);
                self.picture_count += 1;
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
