//! The window around an [`App`]: what shows it, and what befalls it.
//!
//! The app outlives its window. Where the device that shows the window is lost, as all are when a driver is renewed or
//! the adapter is unplugged, another window is opened with the same app in it.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::rc::Rc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Duration;

use eframe::egui::{self, Context, Ui, Vec2, ViewportCommand};
use eframe::egui_wgpu::{RenderState, SurfaceErrorAction, WgpuConfiguration};
use eframe::wgpu::{CurrentSurfaceTexture, PollType};

use super::App;
use crate::memory::{self, Memory};

/// What shows the window, in the order in which it is tried: OpenGL is also where Vulkan, Metal and DirectX 12 are not.
const RENDERERS: [eframe::Renderer; 2] = [eframe::Renderer::Wgpu, eframe::Renderer::Glow];
/// So many windows of one renderer may lose their device.
const MOST_LOSSES: u32 = 4;
/// A surface that gives nothing to draw on is asked again after so long.
const AGAIN: Duration = Duration::from_millis(100);
/// What was asked of a device is done after so long, or never.
const PATIENCE: Duration = Duration::from_secs(5);
/// The environment variable that makes a build with debug assertions lose the window's device, once it has shown so
/// many frames, or, with `.5` behind the number, in the middle of the next.
pub const LOSE_WINDOW: &str = "SDFC_LOSE_WINDOW_AFTER";

/// The app, once the first window is there.
type Shared = Rc<RefCell<Option<App>>>;

/// Why there is no window, or none any more.
#[derive(Debug)]
pub enum NoWindow {
    /// None could be opened; why, in one line.
    Refused(String),
    /// Its device was lost while it was drawn. What there is to remember is kept.
    Lost,
}

/// Opens a window on a scene, and stays until it is closed.
///
/// # Errors
///
/// Why there is none.
pub fn run(path: &Path) -> Result<(), NoWindow> {
    let app = Shared::default();
    let mut refusals = Vec::new();
    for renderer in RENDERERS {
        match windows(path, renderer, &app) {
            Ok(()) => return Ok(()),
            Err(Refusal::Final(why)) => return Err(why),
            Err(Refusal::OfRenderer(why)) => refusals.push(why),
        }
    }
    Err(NoWindow::Refused(refusals.join("; ")))
}

/// Why a renderer shows no window.
enum Refusal {
    /// Another may serve.
    OfRenderer(String),
    /// None need be asked.
    Final(NoWindow),
}

/// One window after the other, until one is closed.
fn windows(path: &Path, renderer: eframe::Renderer, app: &Shared) -> Result<(), Refusal> {
    for _ in 0..MOST_LOSSES {
        let events = Arc::new(Events::default());
        let ended = catch_unwind(AssertUnwindSafe(|| window(path, renderer, app, &events)));
        match ended {
            Ok(_) if events.has_lost_device() => {}
            Ok(ended) => {
                return ended.map_err(|error| match is_of_renderer(&error) {
                    true => Refusal::OfRenderer(error.to_string()),
                    false => Refusal::Final(NoWindow::Refused(error.to_string())),
                });
            }
            // egui's own, where the device gives it no buffers: the event loop cannot be used again.
            Err(_) if events.has_lost_device() => {
                app.borrow_mut().as_mut().into_iter().for_each(App::leave);
                return Err(Refusal::Final(NoWindow::Lost));
            }
            Err(panic) => resume_unwind(panic),
        }
    }
    Err(Refusal::OfRenderer(format!("the window's device was lost {MOST_LOSSES} times")))
}

/// Whether another renderer may serve.
fn is_of_renderer(error: &eframe::Error) -> bool {
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

fn window(
    path: &Path,
    renderer: eframe::Renderer,
    shared: &Shared,
    events: &Arc<Events>,
) -> eframe::Result {
    let place = memory::usual_place();
    let remembered = place.as_deref().map(Memory::read).unwrap_or_default();
    let viewport = egui::ViewportBuilder::default()
        .with_title(title(shared.borrow_mut().as_mut().map_or(path, |app| app.session().path())))
        .with_app_id("sdfc-view")
        .with_inner_size(remembered.window.unwrap_or([1200.0, 760.0]))
        .with_min_inner_size([480.0, 320.0]);
    let wgpu_options = surface_options(events);
    let options = eframe::NativeOptions { viewport, renderer, wgpu_options, ..Default::default() };
    let create: eframe::AppCreator<'_> = Box::new(move |creation| {
        let ctx = &creation.egui_ctx;
        events.listen(creation);
        match &mut *shared.borrow_mut() {
            Some(app) => app.enter(ctx),
            none => *none = Some(App::new(ctx, path, place)?),
        }
        let (app, events) = (Rc::clone(shared), Arc::clone(events));
        Ok(Box::new(Shell { app, events }))
    });
    eframe::run_native("sdfc-view", options, create)
}

/// What the window is called.
pub fn title(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    format!("{name} · sdfc")
}

/// As egui does it, and noted.
fn surface_options(events: &Arc<Events>) -> WgpuConfiguration {
    let events = Arc::clone(events);
    let on_surface_status = Arc::new(move |status: &CurrentSurfaceTexture| match status {
        // A resize, most of the time: nothing is amiss.
        CurrentSurfaceTexture::Outdated => SurfaceErrorAction::Reconfigure,
        CurrentSurfaceTexture::Lost => {
            events.tell("the window's surface was lost and is made anew");
            SurfaceErrorAction::RecreateSurface
        }
        // Nothing of the window is to be seen; what shows it again asks for a frame.
        CurrentSurfaceTexture::Occluded => SurfaceErrorAction::SkipFrame,
        CurrentSurfaceTexture::Timeout | CurrentSurfaceTexture::Validation => {
            events.tell("the window could not be drawn, and is drawn again");
            events.again();
            SurfaceErrorAction::SkipFrame
        }
        CurrentSurfaceTexture::Success(_) | CurrentSurfaceTexture::Suboptimal(_) => {
            SurfaceErrorAction::SkipFrame
        }
    });
    WgpuConfiguration { on_surface_status, ..Default::default() }
}

/// What befell the window, from whatever thread noticed it.
#[derive(Default)]
struct Events {
    noted: Mutex<Noted>,
    context: OnceLock<Context>,
    /// With its queue, without which a device never says that it is lost.
    state: OnceLock<RenderState>,
}

#[derive(Debug, Default)]
struct Noted {
    /// To be told in the status line.
    remarks: Vec<&'static str>,
    /// Whether the device is lost.
    lost: bool,
}

impl Events {
    /// From then on the device's faults are noted. Unheard, they would end the program.
    fn listen(self: &Arc<Self>, creation: &eframe::CreationContext<'_>) {
        self.context.get_or_init(|| creation.egui_ctx.clone());
        let Some(state) = &creation.wgpu_render_state else { return };
        let device = &self.state.get_or_init(|| state.clone()).device;
        // They are the device's own, which these hold.
        let noticed = [Arc::downgrade(self), Arc::downgrade(self)];
        let [lost, failed] = noticed;
        device.set_device_lost_callback(move |_, _| {
            if let Some(events) = lost.upgrade() {
                events.noted().lost = true;
                events.again();
            }
        });
        // What a lost device is asked for comes here too; a frame later the window is another one.
        device.on_uncaptured_error(Arc::new(move |_| {
            failed.upgrade().iter().for_each(|events| events.again());
        }));
    }

    fn tell(&self, remark: &'static str) {
        let remarks = &mut self.noted().remarks;
        if !remarks.contains(&remark) {
            remarks.push(remark);
        }
    }

    /// Has another frame drawn soon.
    fn again(&self) {
        if let Some(ctx) = self.context.get() {
            ctx.request_repaint_after(AGAIN);
        }
    }

    /// Asks the device, which may not have said it yet.
    fn has_lost_device(&self) -> bool {
        self.poll();
        self.noted().lost
    }

    fn poll(&self) {
        if let Some(state) = self.state.get() {
            // That panics where the device is lost meanwhile.
            let wait = PollType::Wait { submission_index: None, timeout: Some(PATIENCE) };
            drop(catch_unwind(AssertUnwindSafe(|| state.device.poll(wait))));
        }
    }

    fn noted(&self) -> MutexGuard<'_, Noted> {
        // Each of its fields stands for itself.
        self.noted.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What eframe runs: the app in this window.
struct Shell {
    app: Shared,
    events: Arc<Events>,
}

/// Of all windows.
static FRAMES: AtomicU32 = AtomicU32::new(0);

impl Shell {
    /// For tests: lost, and heard of, between two frames or in the middle of one.
    fn lose_if_asked(&self, part: &str) {
        if cfg!(debug_assertions)
            && let Some(state) = self.events.state.get()
            && let Some(after) = std::env::var_os(LOSE_WINDOW)
            && *after == *format!("{}{part}", FRAMES.load(Ordering::Relaxed))
        {
            state.device.destroy();
            self.events.poll();
        }
    }
}

impl eframe::App for Shell {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        self.lose_if_asked("");
        if self.events.noted().lost {
            // With nothing to draw, nothing is asked of the device until the window is gone.
            return ui.ctx().send_viewport_cmd(ViewportCommand::Close);
        }
        let Some(app) = &mut *self.app.borrow_mut() else { return };
        let remarks = std::mem::take(&mut self.events.noted().remarks);
        app.session().remarks.extend(remarks.into_iter().map(str::to_owned));
        app.show(ui);
        self.lose_if_asked(".5");
        FRAMES.fetch_add(1, Ordering::Relaxed);
    }

    fn on_exit(&mut self, _: Option<&eframe::glow::Context>) {
        if let Some(app) = &mut *self.app.borrow_mut() {
            app.leave();
        }
    }
}

/// The monitor that the window is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Monitor {
    /// Pixels.
    size: Vec2,
    /// Of these in a point.
    scale: f32,
}

impl Monitor {
    /// `None` where the system does not say.
    pub fn of(ctx: &Context) -> Option<Self> {
        let points = ctx.pixels_per_point();
        ctx.input(|input| {
            let viewport = input.viewport();
            let size = (viewport.monitor_size? * points).round();
            Some(Self { size, scale: viewport.native_pixels_per_point? })
        })
    }
}

impl std::fmt::Display for Monitor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { size, scale } = self;
        write!(f, "a monitor of {} × {} pixels, {scale} to a point", size.x, size.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_befalls_the_surface_is_told_once_and_mended() {
        use CurrentSurfaceTexture::{Lost, Occluded, Outdated, Timeout, Validation};
        let events = Arc::new(Events::default());
        let on_status = surface_options(&events).on_surface_status;
        // Resized or out of sight: nothing is amiss.
        assert!(matches!(on_status(&Outdated), SurfaceErrorAction::Reconfigure));
        assert!(matches!(on_status(&Occluded), SurfaceErrorAction::SkipFrame));
        assert!(events.noted().remarks.is_empty());
        for _ in 0..2 {
            assert!(matches!(on_status(&Lost), SurfaceErrorAction::RecreateSurface));
            assert!(matches!(on_status(&Timeout), SurfaceErrorAction::SkipFrame));
            assert!(matches!(on_status(&Validation), SurfaceErrorAction::SkipFrame));
        }
        let told = events.noted().remarks.join("; ");
        assert_eq!(
            told,
            "the window's surface was lost and is made anew; the window could not be drawn, and is drawn again"
        );
    }
}
