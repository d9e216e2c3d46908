//! Errors of a window's device and surface, recorded on any thread.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Duration;

use eframe::egui::Context;
use eframe::egui_wgpu::{RenderState, SurfaceErrorAction, WgpuConfiguration, WgpuSetup};
use eframe::wgpu::{Backend, CurrentSurfaceTexture, DeviceType, PollType};
use sdfc_render::Gpu;

use crate::render::window_device::WindowDevice;

/// The delay before drawing again on a surface that could not be drawn on.
const RETRY_DELAY: Duration = Duration::from_millis(100);
/// The environment variable that makes the window's device draw the scene (`1`), or not (`0`).
pub const DRAW_ON_WINDOW: &str = "SDFC_DRAW_ON_WINDOW";
/// The longest wait for the device to finish its work.
const DEVICE_TIMEOUT: Duration = Duration::from_secs(5);

/// The events of one window.
#[derive(Default)]
pub struct WindowEvents {
    recorded: Mutex<Recorded>,
    context: OnceLock<Context>,
    /// Kept with its queue, without which a device does not report that it is lost.
    state: OnceLock<RenderState>,
    /// The same device, if it draws the scene too.
    gpu: OnceLock<Gpu>,
}

#[derive(Debug, Default)]
struct Recorded {
    /// Messages for the status line.
    messages: Vec<&'static str>,
    device_lost: bool,
}

impl WindowEvents {
    /// Records the device's errors from now on. Errors without a handler would end the program.
    pub fn listen(self: &Arc<Self>, creation: &eframe::CreationContext<'_>) {
        self.context.get_or_init(|| creation.egui_ctx.clone());
        let Some(state) = &creation.wgpu_render_state else { return };
        let device = &self.state.get_or_init(|| state.clone()).device;
        // The device owns the callbacks and these events hold the device, hence weak references.
        let [lost, failed] = [Arc::downgrade(self), Arc::downgrade(self)];
        device.set_device_lost_callback(move |_, message| {
            if let Some(events) = lost.upgrade() {
                events.gpu.get().iter().for_each(|gpu| gpu.report_loss(&message));
                events.recorded().device_lost = true;
                events.request_frame();
            }
        });
        // Errors of a lost device arrive here too; a frame later there is a new window.
        device.on_uncaptured_error(Arc::new(move |_| {
            failed.upgrade().iter().for_each(|events| events.request_frame());
        }));
    }

    /// The device that shows the window; `None` with OpenGL.
    pub fn state(&self) -> Option<&RenderState> {
        self.state.get()
    }

    /// Returns the device of the window if the scene is drawn on it too, which is so on a GPU. With
    /// a software driver, the copy of a picture costs little, and with a separate device, the
    /// frames of the window do not wait for the rays.
    pub fn drawing_device(&self) -> Option<(&RenderState, WindowDevice)> {
        let state = self.state()?;
        let info = state.adapter.get_info();
        let has_compute = matches!(info.backend, Backend::Vulkan | Backend::Metal | Backend::Dx12);
        let is_wanted = match std::env::var(DRAW_ON_WINDOW).as_deref() {
            Ok("1") => true,
            Ok("0") => false,
            Ok(_) | Err(_) => info.device_type != DeviceType::Cpu,
        };
        let open = || Gpu::of_program(&state.adapter, &state.device, &state.queue);
        let shares = has_compute && is_wanted;
        shares.then(|| (state, WindowDevice::new(self.gpu.get_or_init(open).clone())))
    }

    /// Takes out the messages for the status line.
    pub fn take_messages(&self) -> Vec<&'static str> {
        std::mem::take(&mut self.recorded().messages)
    }

    /// Returns true if the device has reported that it is lost.
    pub fn device_lost_reported(&self) -> bool {
        self.recorded().device_lost
    }

    /// Returns true if the device is lost, after asking it.
    pub fn is_device_lost(&self) -> bool {
        self.poll_device();
        self.device_lost_reported()
    }

    /// Waits for the device, which then reports whether it is lost.
    pub fn poll_device(&self) {
        if let Some(state) = self.state.get() {
            // Polling panics if the device is lost meanwhile.
            let wait = PollType::Wait { submission_index: None, timeout: Some(DEVICE_TIMEOUT) };
            drop(catch_unwind(AssertUnwindSafe(|| state.device.poll(wait))));
        }
    }

    fn add_message(&self, message: &'static str) {
        let messages = &mut self.recorded().messages;
        if !messages.contains(&message) {
            messages.push(message);
        }
    }

    /// Requests another frame soon.
    fn request_frame(&self) {
        if let Some(ctx) = self.context.get() {
            ctx.request_repaint_after(RETRY_DELAY);
        }
    }

    fn recorded(&self) -> MutexGuard<'_, Recorded> {
        // The fields are independent, so a poisoned lock holds a valid value.
        self.recorded.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// egui's handling of surface errors, which are also recorded.
pub fn wgpu_options(events: &Arc<WindowEvents>) -> WgpuConfiguration {
    let events = Arc::clone(events);
    let on_surface_status = Arc::new(move |status: &CurrentSurfaceTexture| match status {
        // Usually after a resize.
        CurrentSurfaceTexture::Outdated => SurfaceErrorAction::Reconfigure,
        CurrentSurfaceTexture::Lost => {
            events.add_message("the window's surface was lost and created again");
            SurfaceErrorAction::RecreateSurface
        }
        // The window is hidden; showing it again requests a frame.
        CurrentSurfaceTexture::Occluded => SurfaceErrorAction::SkipFrame,
        CurrentSurfaceTexture::Timeout | CurrentSurfaceTexture::Validation => {
            events.add_message("the window could not be drawn; trying again");
            events.request_frame();
            SurfaceErrorAction::SkipFrame
        }
        CurrentSurfaceTexture::Success(_) | CurrentSurfaceTexture::Suboptimal(_) => {
            SurfaceErrorAction::SkipFrame
        }
    });
    let mut options = WgpuConfiguration { on_surface_status, ..Default::default() };
    if let WgpuSetup::CreateNew(setup) = &mut options.wgpu_setup {
        // All limits of the adapter: the device may draw the scene too.
        setup.device_descriptor = Arc::new(Gpu::descriptor);
    }
    options
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surface_errors_are_repaired_and_reported_once() {
        use CurrentSurfaceTexture::{Lost, Occluded, Outdated, Timeout, Validation};
        let events = Arc::new(WindowEvents::default());
        let on_status = wgpu_options(&events).on_surface_status;
        // A resize or a hidden window is no error.
        assert!(matches!(on_status(&Outdated), SurfaceErrorAction::Reconfigure));
        assert!(matches!(on_status(&Occluded), SurfaceErrorAction::SkipFrame));
        assert!(events.take_messages().is_empty());
        for _ in 0..2 {
            assert!(matches!(on_status(&Lost), SurfaceErrorAction::RecreateSurface));
            assert!(matches!(on_status(&Timeout), SurfaceErrorAction::SkipFrame));
            assert!(matches!(on_status(&Validation), SurfaceErrorAction::SkipFrame));
        }
        assert_eq!(
            events.take_messages(),
            [
                "the window's surface was lost and created again",
                "the window could not be drawn; trying again"
            ]
        );
    }
}
