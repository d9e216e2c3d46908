//! Opens the window, and opens another one if its device is lost.
//!
//! The [`App`] outlives its window. When the device that shows the window is lost, as happens when
//! a driver is updated or the GPU is unplugged, a new window is opened with the same app in it.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use eframe::egui::{self, Ui, ViewportCommand};

use super::root::{App, title};
use super::window_events::{WindowEvents, wgpu_options};
use crate::settings::{self, Settings};

/// The renderers of the window, in the order of preference. OpenGL serves without Vulkan, Metal and
/// DirectX 12.
const RENDERERS: [eframe::Renderer; 2] = [eframe::Renderer::Wgpu, eframe::Renderer::Glow];
/// After this many device losses the next renderer is tried.
const MAX_LOSSES: u32 = 4;
/// An environment variable for tests: a build with debug assertions loses the window's device after
/// this many frames; with `.5` behind the number, in the middle of the next frame.
pub const LOSE_WINDOW: &str = "SDFC_LOSE_WINDOW_AFTER";

/// The app; `None` until the first window is open.
type SharedApp = Rc<RefCell<Option<App>>>;

/// Why there is no window.
#[derive(Debug)]
pub enum WindowError {
    /// No window could be opened; why, in one line.
    Refused(String),
    /// The device was lost while the window was drawn. The settings and the texts that are not
    /// saved were stored.
    DeviceLost,
}

/// Opens a window on a scene and returns when it is closed.
///
/// # Errors
///
/// No window could be opened, or its device was lost while it was drawn.
pub fn run(path: &Path) -> Result<(), WindowError> {
    let app = SharedApp::default();
    let mut refusals = Vec::new();
    for renderer in RENDERERS {
        match run_with(renderer, path, &app) {
            Ok(()) => return Ok(()),
            Err(Failure::Final(error)) => return Err(error),
            Err(Failure::TryNext(why)) => refusals.push(why),
        }
    }
    Err(WindowError::Refused(refusals.join("; ")))
}

/// Why a renderer does not show a window.
enum Failure {
    /// Another renderer may work.
    TryNext(String),
    /// No renderer can work.
    Final(WindowError),
}

/// Opens a window, and another one whenever its device is lost, until one is closed.
fn run_with(renderer: eframe::Renderer, path: &Path, app: &SharedApp) -> Result<(), Failure> {
    for _ in 0..MAX_LOSSES {
        let events = Arc::new(WindowEvents::default());
        let ended = catch_unwind(AssertUnwindSafe(|| run_window(path, renderer, app, &events)));
        match ended {
            Ok(_) if events.is_device_lost() => {}
            Ok(ended) => {
                return ended.map_err(|error| match is_renderer_error(&error) {
                    true => Failure::TryNext(error.to_string()),
                    false => Failure::Final(WindowError::Refused(error.to_string())),
                });
            }
            // egui panics if a lost device gives it no buffers. The event loop cannot be used
            // again.
            Err(panic) => {
                app.borrow_mut().as_mut().into_iter().for_each(App::rescue);
                if events.is_device_lost() {
                    return Err(Failure::Final(WindowError::DeviceLost));
                }
                resume_unwind(panic);
            }
        }
    }
    Err(Failure::TryNext(format!("the window's device was lost {MAX_LOSSES} times")))
}

/// Returns true if another renderer may work.
fn is_renderer_error(error: &eframe::Error) -> bool {
    match error {
        eframe::Error::Wgpu(_)
        | eframe::Error::Glutin(_)
        | eframe::Error::NoGlutinConfigs(..)
        | eframe::Error::OpenGL(_) => true,
        eframe::Error::AppCreation(_)
        | eframe::Error::Winit(_)
        | eframe::Error::WinitEventLoop(_) => false,
    }
}

fn run_window(
    path: &Path,
    renderer: eframe::Renderer,
    shared: &SharedApp,
    events: &Arc<WindowEvents>,
) -> eframe::Result {
    let settings_path = settings::default_path();
    let stored = settings_path.as_deref().map(Settings::read).unwrap_or_default();
    let viewport = egui::ViewportBuilder::default()
        .with_title(title(shared.borrow_mut().as_mut().map_or(path, |app| app.session().path())))
        .with_app_id("sdfc-view")
        .with_inner_size(stored.window.unwrap_or([1440.0, 860.0]))
        .with_min_inner_size([480.0, 320.0]);
    let wgpu_options = wgpu_options(events);
    let options = eframe::NativeOptions { viewport, renderer, wgpu_options, ..Default::default() };
    let create: eframe::AppCreator<'_> = Box::new(move |creation| {
        let ctx = &creation.egui_ctx;
        events.listen(creation);
        let mut app = shared.borrow_mut();
        match &mut *app {
            Some(app) => app.move_to_window(ctx),
            none => *none = Some(App::new(ctx, path, settings_path)?),
        }
        if let (Some(app), Some((state, device))) = (&mut *app, events.drawing_device()) {
            app.draw_on_window(state, device);
        }
        drop(app);
        let (app, events) = (Rc::clone(shared), Arc::clone(events));
        Ok(Box::new(WindowApp { app, events }))
    });
    eframe::run_native("sdfc-view", options, create)
}

/// The eframe app of one window.
struct WindowApp {
    app: SharedApp,
    events: Arc<WindowEvents>,
}

/// Frames of all windows, for [`LOSE_WINDOW`].
static FRAMES: AtomicU32 = AtomicU32::new(0);

impl WindowApp {
    /// For tests: loses the device between two frames, or in the middle of one.
    fn lose_device_if_asked(&self, frame: u32, suffix: &str) {
        if cfg!(debug_assertions)
            && let Some(state) = self.events.state()
            && let Some(after) = std::env::var_os(LOSE_WINDOW)
            && *after == *format!("{frame}{suffix}")
        {
            state.device.destroy();
            self.events.poll_device();
        }
    }
}

impl eframe::App for WindowApp {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let frame = FRAMES.fetch_add(1, Ordering::Relaxed);
        self.lose_device_if_asked(frame, "");
        if self.events.device_lost_reported() {
            // Without anything to draw, the lost device is not used until the window is closed.
            return ui.ctx().send_viewport_cmd(ViewportCommand::Close);
        }
        let Some(app) = &mut *self.app.borrow_mut() else { return };
        let messages = self.events.take_messages();
        app.session().messages.extend(messages.into_iter().map(str::to_owned));
        app.show(ui);
        self.lose_device_if_asked(frame, ".5");
    }

    fn on_exit(&mut self, _: Option<&eframe::glow::Context>) {
        if let Some(app) = &mut *self.app.borrow_mut() {
            app.close();
        }
    }
}
