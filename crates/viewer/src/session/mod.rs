//! Everything that the window does, without the window: one open scene, its workers and settings.

mod camera_control;
pub mod clock;
pub mod draft;
mod events;
pub mod handle_state;
mod handles;
mod lit_shapes;
mod lit_state;
pub mod orbit_camera;
pub mod save_state;
mod saving;
mod shown_text;
pub mod tabs;
mod text;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sdfc::{CompileValues, FrameValues, Scene};
use sdfc_ide::ExampleScene;

use crate::accuracy::checks::AccuracyChecks;
use crate::accuracy::comparison::ComparisonJob;
use crate::compile::diagnostics::{SceneDiagnostics, ShownDiagnostic};
use crate::compile::file_watcher::FileWatcher;
use crate::compile::request::{BuildRequest, CompileReport};
use crate::compile::worker::CompileWorker;
use crate::export::exporter::ExportOutcome;
use crate::export::worker::ExportWorker;
use crate::language::worker::{LanguageAnswer, LanguageRequest, LanguageWorker};
use crate::render::handles::HandleWorker;
use crate::render::picture::{MovingPicture, Picture, RenderEvent, RenderRequest};
use crate::render::pixel_info::PixelInfo;
use crate::render::shape_mask::MaskWorker;
use crate::render::window_device::WindowDevice;
use crate::render::worker::RenderWorker;
use crate::scene::document::{TextsByPath, folders_of, path_of};
use crate::scene::model::Model;
use crate::scene::param_values::ParamValues;
use crate::session::clock::Clock;
use crate::session::draft::Draft;
use crate::session::handle_state::ValueHandles;
use crate::session::lit_state::LitShapes;
use crate::session::orbit_camera::{CameraState, OrbitCamera};
use crate::session::save_state::Saving;
use crate::session::tabs::Tabs;
use crate::small_pictures::SmallPictures;
use crate::views::mode::ViewMode;
use crate::views::slice_plane::SlicePlane;

/// The most frames of an animation.
const MAX_FRAMES: f64 = 20_000.0;

/// Wakes the window's thread.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// One open scene.
#[derive(Debug)]
pub struct Session {
    build: BuildRequest,
    compile_worker: CompileWorker,
    compile_reports: Receiver<CompileReport>,
    render_worker: RenderWorker,
    render_events: Receiver<RenderEvent>,
    export_worker: ExportWorker,
    export_outcomes: Receiver<ExportOutcome>,
    language_worker: LanguageWorker,
    language_answers: Receiver<LanguageAnswer>,
    language_request: Option<LanguageRequest>,
    /// The last answer of the language service, which may be about an earlier text.
    pub language: Option<LanguageAnswer>,
    /// Pictures of library entries.
    pub entry_pictures: SmallPictures<ExampleScene>,
    /// True if a text is formatted when it is saved.
    pub format_on_save: bool,
    /// True if a drag with the middle button turns the camera, as in Blender.
    pub middle_turns: bool,
    watcher: FileWatcher,
    /// The request that a change on disk repeats, shared with the watcher's thread.
    repeated_build: Arc<Mutex<BuildRequest>>,
    /// The camera; `None` until the first scene gives one.
    camera: Option<OrbitCamera>,
    /// True while the camera is the scene's own and has not been moved by hand.
    follows_scene: bool,
    /// The scene and its values that the camera of a scene without a camera was fitted to.
    fitted: Option<(Arc<Scene>, FrameValues)>,
    /// The changed params and numbers.
    pub param_values: ParamValues,
    /// The scene's time.
    pub clock: Clock,
    /// The view.
    pub mode: ViewMode,
    /// The plane of [`ViewMode::Slice`].
    pub slice: SlicePlane,
    /// True if the scene's bounds are drawn over the picture.
    pub show_bounds: bool,
    /// Samples per pixel; `None` takes the scene's.
    pub samples: Option<u32>,
    /// The ray method's parameter, such as its tolerance, as a multiple of the scene's.
    pub tolerance: f64,
    /// True if the picture is refined to full resolution, however long that takes.
    pub refine: bool,
    /// The last good scene.
    pub model: Option<Arc<Model>>,
    /// The text of the scene: that of the file, or one that was edited in the window.
    draft: Draft,
    /// The texts of other files.
    tabs: Tabs,
    /// Whether the changed values are being written to the file.
    saving: Saving,
    /// Errors and warnings of the text that was compiled last.
    pub diagnostics: SceneDiagnostics,
    /// That text.
    diagnosed: Arc<str>,
    /// The texts of the imported files that were compiled with it.
    diagnosed_imports: TextsByPath,
    /// Why there is no newer model, apart from diagnostics.
    pub problem: Option<String>,
    /// Why the last picture could not be drawn.
    pub render_error: Option<String>,
    /// True while a pipeline is being made.
    pub building: bool,
    /// The last picture whose pixels are known.
    pub picture: Option<Box<Picture>>,
    /// The newer picture of something that moves, if there is one.
    pub moving: Option<MovingPicture>,
    lit_shapes: LitShapes,
    /// Handles in the picture.
    pub handles: ValueHandles,
    /// The number of pictures received.
    pub picture_count: u64,
    /// Messages for the status line; the window takes them out.
    pub messages: Vec<String>,
    /// Comparisons with the oracle.
    pub accuracy: AccuracyChecks,
    last_request: Option<RenderRequest>,
    /// Width and height of the last request in pixels.
    size: [u32; 2],
    /// The number of devices lost since the last picture.
    device_losses: u32,
}

impl Session {
    /// Opens a scene and starts the workers. They call `wake` when there is something to
    /// [`poll`](Self::poll).
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn open(path: &Path, wake: Wake) -> std::io::Result<Self> {
        let build = BuildRequest::new(path);
        let (sender, compile_reports) = channel();
        let wake_window = Arc::clone(&wake);
        let compile_worker = CompileWorker::new(sender, move || wake_window())?;
        let (sender, render_events) = channel();
        let wake_window = Arc::clone(&wake);
        let render_worker = RenderWorker::new(sender, move || wake_window())?;
        let (sender, export_outcomes) = channel();
        let wake_window = Arc::clone(&wake);
        let export_worker = ExportWorker::new(sender, move || wake_window())?;
        let (sender, language_answers) = channel();
        let wake_window = Arc::clone(&wake);
        let language_worker = LanguageWorker::new(sender, move || wake_window())?;
        let (sender, masks) = channel();
        let wake_window = Arc::clone(&wake);
        let lit_shapes = LitShapes::new(MaskWorker::new(sender, move || wake_window())?, masks);
        let (sender, answers) = channel();
        let wake_window = Arc::clone(&wake);
        let handles = ValueHandles::new(HandleWorker::new(sender, move || wake_window())?, answers);
        let wake_window = Arc::clone(&wake);
        let entry_pictures = SmallPictures::new(move || wake_window())?;
        let accuracy = AccuracyChecks::new(move || wake())?;
        let repeated_build = Arc::new(Mutex::new(build.clone()));
        let (requests, repeated) = (compile_worker.requests(), Arc::clone(&repeated_build));
        let watcher = FileWatcher::new(move || requests.send(lock(&repeated).clone()));
        let mut session = Self {
            build,
            compile_worker,
            compile_reports,
            render_worker,
            render_events,
            export_worker,
            export_outcomes,
            language_worker,
            language_answers,
            language_request: None,
            language: None,
            entry_pictures,
            format_on_save: false,
            middle_turns: false,
            watcher,
            repeated_build,
            camera: None,
            follows_scene: true,
            fitted: None,
            param_values: ParamValues::default(),
            clock: Clock::default(),
            mode: ViewMode::default(),
            slice: SlicePlane::default(),
            show_bounds: false,
            samples: None,
            tolerance: 1.0,
            refine: true,
            model: None,
            draft: Draft::default(),
            tabs: Tabs::default(),
            saving: Saving::default(),
            diagnostics: SceneDiagnostics::default(),
            diagnosed: Arc::default(),
            diagnosed_imports: TextsByPath::new(),
            problem: None,
            render_error: None,
            building: false,
            picture: None,
            moving: None,
            lit_shapes,
            handles,
            picture_count: 0,
            messages: Vec::new(),
            accuracy,
            last_request: None,
            size: [16, 9],
            device_losses: 0,
        };
        session.watch_own_folder();
        session.request_build();
        Ok(session)
    }

    /// The scene's file.
    pub fn path(&self) -> &Path {
        &self.build.path
    }

    /// The current build request.
    pub fn build(&self) -> &BuildRequest {
        &self.build
    }

    /// Changes how the scene is built, and builds it if anything changed.
    pub fn update_build(&mut self, change: impl FnOnce(&mut BuildRequest)) {
        let mut build = self.build.clone();
        change(&mut build);
        if build != self.build {
            self.build = build;
            self.request_build();
        }
    }

    /// Opens another scene in place of this one.
    pub fn open_other(&mut self, path: PathBuf) {
        self.build = BuildRequest {
            path,
            draft: None,
            imports: TextsByPath::new(),
            method: None,
            parallel: None,
            values: CompileValues::new(),
            ..self.build.clone()
        };
        (self.camera, self.model, self.last_request) = (None, None, None);
        (self.picture, self.moving) = (None, None);
        (self.param_values, self.clock) = (ParamValues::default(), Clock::default());
        (self.diagnostics, self.problem, self.render_error) =
            (SceneDiagnostics::default(), None, None);
        (self.draft, self.saving) = (Draft::default(), Saving::default());
        self.tabs = Tabs::default();
        (self.language, self.language_request, self.handles.selected) = (None, None, None);
        self.lit_shapes.clear();
        (self.follows_scene, self.fitted, self.tolerance) = (true, None, 1.0);
        self.accuracy.reset();
        self.watch_own_folder();
        self.request_build();
    }

    /// Restores a stored camera and params.
    pub fn restore(&mut self, camera: Option<&CameraState>, params: &BTreeMap<String, [f64; 4]>) {
        if let Some(camera) = camera.and_then(OrbitCamera::from_state) {
            (self.camera, self.follows_scene) = (Some(camera), false);
        }
        self.param_values.params = params.clone();
    }

    /// The frame values of an animation from time 0 on. Each frame is shown for that many
    /// hundredths of a second.
    pub fn frames(&self, model: &Model, seconds: f64, hundredths: u32) -> Vec<FrameValues> {
        let length = f64::from(hundredths) / 100.0;
        let count = (seconds / length).round().clamp(1.0, MAX_FRAMES) as u32;
        let clock = |number: u32| Clock { time: f64::from(number) * length, ..self.clock };
        let clocks = (0..count).map(clock);
        clocks.map(|clock| self.param_values.frame(model, clock.time, clock.frame())).collect()
    }

    /// The export worker.
    pub fn exports(&self) -> &ExportWorker {
        &self.export_worker
    }

    /// Requests a picture of `size` pixels, unless it is the one requested last. `moving` is true
    /// if the next request is likely to differ.
    pub fn request_picture(&mut self, size: [u32; 2], moving: bool) {
        if size.contains(&0) {
            return;
        }
        self.size = size;
        self.follow_scene_camera();
        let Some(model) = self.model.clone() else { return };
        let Some(camera) = &mut self.camera else { return };
        camera.set_planar(model.scene.is_planar());
        let mut camera = *camera;
        let parallel = camera.is_parallel();
        if model.parallel != parallel {
            // Until there is a shader for this projection, the running one is used.
            self.update_build(|build| build.parallel = Some(parallel));
            camera.set_parallel(model.parallel);
        }
        self.compile_for_params(&model);
        let request = RenderRequest {
            frame: self.values(&model),
            pose: camera.pose(),
            size,
            mode: self.mode,
            slice: self.slice,
            moving,
            refine: self.refine,
            samples: self.samples(&model),
            tolerance: self.tolerance,
            model,
        };
        if self.last_request.as_ref().is_some_and(|last| last.is_same(&request)) {
            self.compare_if_finished();
            return;
        }
        self.last_request = Some(request.clone());
        self.render_worker.send(request);
    }

    /// Requests a build if a changed param is a constant of the model. Until it is done, the model
    /// is drawn as it is.
    fn compile_for_params(&mut self, model: &Model) {
        if model.scene.needs_compile(&self.param_values.params) {
            let values = self.param_values.params.clone();
            self.update_build(|build| build.values = values);
        }
    }

    /// The request that the shown picture answers.
    pub fn shown_request(&self) -> Option<&RenderRequest> {
        let moving = self.moving.as_ref().map(|moving| &moving.request);
        moving.or(self.picture.as_ref().map(|picture| &picture.request)).map(Arc::as_ref)
    }

    /// Returns true until the chosen view of the picture is there, if only for some of its pixels.
    pub fn is_view_pending(&self) -> bool {
        self.shown_request().is_some_and(|request| request.mode != self.mode)
    }

    /// Draws on the device of the window from now on, or on devices without a window.
    pub fn set_window_device(&mut self, device: Option<WindowDevice>) {
        // Its pictures are gone with a lost device.
        self.moving = None;
        self.update_build(|build| build.window_device = device);
    }

    /// The last request as a comparison job; `None` for a planar picture, which has no rays.
    fn comparison_job(&self, all_methods: bool) -> Option<ComparisonJob> {
        let RenderRequest { model, frame, pose, size, tolerance, .. } =
            self.last_request.as_ref().filter(|last| !last.model.scene.is_planar())?.clone();
        Some(ComparisonJob { model, frame, pose, size, tolerance, all_methods })
    }

    /// Compares the picture with the oracle; with `all_methods` also those of every ray method.
    pub fn compare(&mut self, all_methods: bool) {
        if let Some(job) = self.comparison_job(all_methods) {
            self.accuracy.start(job);
        }
    }

    /// Returns true if the accuracy result is that of the current picture.
    pub fn accuracy_is_current(&self) -> bool {
        let now = self.comparison_job(false);
        let result = self.accuracy.result.as_ref();
        result.zip(now).is_some_and(|(result, now)| result.job.has_same_picture(&now))
    }

    /// Starts an automatic comparison once the picture is finished: drawing and proving at the same
    /// time would compete for the CPU.
    fn compare_if_finished(&mut self) {
        let is_finished = |picture: &Picture| {
            let last = self.last_request.as_ref();
            picture.finished && last.is_some_and(|last| last.is_same(&picture.request))
        };
        if self.accuracy.automatic
            && self.known_picture().is_some_and(is_finished)
            && let Some(job) = self.comparison_job(false)
        {
            self.accuracy.start_if_new(job);
        }
    }

    /// Samples per pixel of the finished picture.
    pub fn samples(&self, model: &Model) -> u32 {
        self.samples.or(model.scene.program().settings.samples).unwrap_or(4)
    }

    /// Returns true if the picture depends on time.
    pub fn is_animated(&self) -> bool {
        self.model.as_ref().is_some_and(|model| model.animated)
    }

    /// Param values and time of the current frame.
    pub fn values(&self, model: &Model) -> FrameValues {
        self.param_values.frame(model, self.clock.time, self.clock.frame())
    }

    /// The pixel at a position of the picture, given as fractions of width and height from the
    /// upper left corner. `None` while the pixels of the shown picture are not known.
    pub fn pixel_info(&self, position: [f64; 2]) -> Option<PixelInfo> {
        PixelInfo::at(self.known_picture()?, position)
    }

    /// The shown picture, if its pixels are known.
    pub fn known_picture(&self) -> Option<&Picture> {
        self.picture.as_deref().filter(|_| self.moving.is_none())
    }

    /// The path of the file that a diagnostic is about, absolute if the scene's path is.
    pub fn path_of(&self, diagnostic: &ShownDiagnostic) -> PathBuf {
        path_of(&self.build.path, &diagnostic.file)
    }

    fn watch_own_folder(&mut self) {
        let own = folders_of(&self.build.path);
        self.watcher.set_folders(&own);
    }

    fn request_build(&self) {
        *lock(&self.repeated_build) = self.build.clone();
        self.compile_worker.send(self.build.clone());
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // The value is replaced whole, so a poisoned lock holds a valid one.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
