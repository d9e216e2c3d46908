//! Finds an adapter, opens its device, and turns wgpu's reports into errors.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    time::Duration,
};

use super::injection::loses_device;
use crate::error::RenderError;
use crate::stats::AdapterInfo;

/// An open device without a window.
///
/// All errors of its calls are returned as [`RenderError`]: those of the calling thread through
/// error scopes; those that arrive otherwise (a lost device) through handlers that store them until
/// the next call. A clone is the same device.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    info: AdapterInfo,
    timestamps: bool,
    faults: Arc<Faults>,
}

/// Errors that arrived outside a call: the first of each kind.
#[derive(Debug, Default)]
struct Faults {
    lost: Mutex<Option<String>>,
    uncaptured: Mutex<Option<RenderError>>,
}

impl Gpu {
    /// Opens the adapter that the system prefers for heavy work; a software adapter is accepted.
    ///
    /// # Errors
    ///
    /// [`RenderError::NoAdapter`] or [`RenderError::NoDevice`].
    pub fn new() -> Result<Self, RenderError> {
        Self::with_limits(|limits| limits)
    }

    /// As [`Gpu::new`], with limits that may be lower than the adapter's.
    pub(crate) fn with_limits(
        lowered: impl FnOnce(wgpu::Limits) -> wgpu::Limits,
    ) -> Result<Self, RenderError> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
        let instance = wgpu::Instance::new(descriptor);
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..wgpu::RequestAdapterOptions::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|error| RenderError::NoAdapter(error.to_string()))?;
        let limits = lowered(adapter.limits());
        Self::open(&adapter, limits)
    }

    fn open(adapter: &wgpu::Adapter, limits: wgpu::Limits) -> Result<Self, RenderError> {
        let descriptor = descriptor(adapter, limits);
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| RenderError::NoDevice(error.to_string()))?;
        let gpu = Self::of_program(adapter, &device, &queue);
        gpu.faults.listen(&device);
        Ok(gpu)
    }

    /// Wraps a device that a program has opened itself, as for a window. Its limits should be those
    /// of the adapter. The program keeps the callbacks of the device, so it has to report a loss by
    /// [`Gpu::report_loss`].
    pub fn of_program(adapter: &wgpu::Adapter, device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self {
            device: device.clone(),
            queue: queue.clone(),
            info: AdapterInfo::of(&adapter.get_info()),
            timestamps: device.features().contains(wgpu::Features::TIMESTAMP_QUERY),
            faults: Arc::new(Faults::default()),
        }
    }

    /// The device that [`Gpu::new`] opens on an adapter.
    pub fn descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
        descriptor(adapter, adapter.limits())
    }

    /// Records that the device of a program is lost: all calls from now on fail.
    pub fn report_loss(&self, message: &str) {
        lock(&self.faults.lost).get_or_insert_with(|| message.to_owned());
    }

    /// The description of the adapter.
    pub fn info(&self) -> &AdapterInfo {
        &self.info
    }

    /// Returns true if the adapter can measure times.
    pub fn has_timestamps(&self) -> bool {
        self.timestamps
    }

    /// Refuses a storage buffer that is larger than the adapter can bind.
    pub(crate) fn has_storage(&self, what: &'static str, bytes: u64) -> Result<(), RenderError> {
        let limits = self.device.limits();
        let binding = limits.max_storage_buffer_binding_size;
        at_most(what, bytes, "maxStorageBufferBindingSize", binding)?;
        at_most(what, bytes, "maxBufferSize", limits.max_buffer_size)
    }

    /// Refuses textures that are larger than those of the adapter.
    pub(crate) fn has_texture_side(&self, side: u32) -> Result<(), RenderError> {
        let limit = self.device.limits().max_texture_dimension_2d;
        at_most("a picture", side.into(), "maxTextureDimension2D", limit.into())
    }

    /// Refuses more workgroups in a row than the adapter can run.
    pub(crate) fn has_workgroups(
        &self,
        what: &'static str,
        groups: u64,
    ) -> Result<(), RenderError> {
        let limit = self.device.limits().max_compute_workgroups_per_dimension;
        at_most(what, groups, "maxComputeWorkgroupsPerDimension", limit.into())
    }

    /// Runs calls to the device; the first error of any of them becomes the result.
    pub(crate) fn scoped<T>(
        &self,
        what: &str,
        calls: impl FnOnce() -> T,
    ) -> Result<T, RenderError> {
        self.lose_if_asked();
        let push = |filter| self.device.push_error_scope(filter);
        let internal = push(wgpu::ErrorFilter::Internal);
        let memory = push(wgpu::ErrorFilter::OutOfMemory);
        let validation = push(wgpu::ErrorFilter::Validation);
        let value = calls();
        // Scopes close in reverse order; natively their answers are ready at once.
        let errors = [
            pollster::block_on(validation.pop()),
            pollster::block_on(memory.pop()),
            pollster::block_on(internal.pop()),
        ];
        self.faults.check()?;
        let Some(error) = errors.into_iter().flatten().next() else { return Ok(value) };
        // A lost device refuses calls, and reports the reason only when it is polled.
        let _ = self.poll(wgpu::PollType::Poll);
        self.faults.check()?;
        Err(render_error(&error, what))
    }

    /// Waits until the device has finished all submitted work, or until the timeout.
    pub(crate) fn wait(&self, patience: Option<Duration>) -> Result<(), RenderError> {
        self.lose_if_asked();
        let polled = self.poll(wgpu::PollType::Wait { submission_index: None, timeout: patience });
        self.faults.check()?;
        match polled {
            Some(Ok(_)) => Ok(()),
            Some(Err(wgpu::PollError::Timeout)) => {
                Err(RenderError::Stalled(patience.map_or(0, |time| time.as_secs())))
            }
            Some(Err(error)) => Err(RenderError::DeviceLost(error.to_string())),
            None => Err(RenderError::DeviceLost("while waiting for it".to_owned())),
        }
    }

    fn lose_if_asked(&self) {
        if loses_device() {
            self.device.destroy();
        }
    }

    /// `None` if wgpu panicked, as it does if the device is lost while it is waited for. That
    /// leaves nothing of this crate half-changed, since results are read only after the wait.
    fn poll(&self, poll: wgpu::PollType) -> Option<Result<wgpu::PollStatus, wgpu::PollError>> {
        catch_unwind(AssertUnwindSafe(|| self.device.poll(poll))).ok()
    }
}

fn descriptor(adapter: &wgpu::Adapter, limits: wgpu::Limits) -> wgpu::DeviceDescriptor<'static> {
    wgpu::DeviceDescriptor {
        label: Some("sdfc"),
        // Timestamps at the borders of a pass need no further feature.
        required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
        // All limits of the adapter, because the default buffer sizes are smaller.
        required_limits: limits,
        ..wgpu::DeviceDescriptor::default()
    }
}

impl Faults {
    fn listen(self: &Arc<Self>, device: &wgpu::Device) {
        let faults = Arc::clone(self);
        device.set_device_lost_callback(move |reason, message| {
            let said = format!("{reason:?}: {message}");
            lock(&faults.lost).get_or_insert_with(|| said.trim_end_matches([':', ' ']).to_owned());
        });
        let faults = Arc::clone(self);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            lock(&faults.uncaptured).get_or_insert_with(|| render_error(&error, "the device"));
        }));
    }

    fn check(&self) -> Result<(), RenderError> {
        // A lost device stays lost; another error is reported once.
        if let Some(message) = lock(&self.lost).as_ref() {
            return Err(RenderError::DeviceLost(message.clone()));
        }
        lock(&self.uncaptured).take().map_or(Ok(()), Err)
    }
}

/// The value behind a lock, also after a panic elsewhere: it is replaced whole or not at all.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn at_most(
    what: &'static str,
    needed: u64,
    name: &'static str,
    limit: u64,
) -> Result<(), RenderError> {
    if needed > limit { Err(RenderError::Limit { what, needed, name, limit }) } else { Ok(()) }
}

fn render_error(error: &wgpu::Error, what: &str) -> RenderError {
    match error {
        wgpu::Error::OutOfMemory { .. } => RenderError::OutOfMemory(what.to_owned()),
        wgpu::Error::Validation { description, .. } => {
            RenderError::Validation(description.trim_end().to_owned())
        }
        wgpu::Error::Internal { description, .. } => {
            RenderError::DeviceLost(description.trim_end().to_owned())
        }
    }
}

impl AdapterInfo {
    fn of(info: &wgpu::AdapterInfo) -> Self {
        let driver = format!("{} {}", info.driver, info.driver_info);
        Self {
            name: info.name.clone(),
            driver: driver.trim().to_owned(),
            backend: info.backend.to_str().to_owned(),
            software: info.device_type == wgpu::DeviceType::Cpu,
        }
    }
}
