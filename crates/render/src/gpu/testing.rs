//! Support for tests that need an adapter.
//!
//! Such tests belong in a target without the standard harness, so that on a machine without an
//! adapter they are reported as ignored, never as passed:
//!
//! ```no_run
//! use libtest_mimic::{Arguments, Trial};
//! use sdfc_render::{Gpu, testing};
//!
//! let ignored = testing::without_gpu();
//! let draws = Trial::test("draws", || {
//!     let gpu = Gpu::new()?;
//!     assert!(!gpu.info().name.is_empty());
//!     Ok(())
//! });
//! libtest_mimic::run(&Arguments::from_args(), vec![draws.with_ignored_flag(ignored)]).exit();
//! ```
//!
//! With `SDFC_REQUIRE_GPU=1` in the environment they run everywhere, and fail if
//! [`Gpu::new`](crate::Gpu::new) does.
//!
//! A device can be lost on purpose: [`lose`] does it, and [`LOSE_DEVICE`] makes a program of a
//! debug build do it.

use std::sync::OnceLock;

pub use super::injection::LOSE_DEVICE;

use super::device::Gpu;
use crate::error::RenderError;

/// The environment variable that makes tests fail instead of being ignored if there is no adapter.
pub const REQUIRE_GPU: &str = "SDFC_REQUIRE_GPU";

/// Returns true if tests that need an adapter are ignored: there is none, and none is required.
pub fn without_gpu() -> bool {
    static WITHOUT: OnceLock<bool> = OnceLock::new();
    *WITHOUT.get_or_init(|| {
        ignored(std::env::var_os(REQUIRE_GPU).is_some_and(|v| v == "1"), || Gpu::new().is_ok())
    })
}

/// Opens the adapter as if it could bind no larger storage buffers.
///
/// # Errors
///
/// As [`Gpu::new`].
pub fn with_storage(bytes: u64) -> Result<Gpu, RenderError> {
    Gpu::with_limits(|limits| wgpu::Limits { max_storage_buffer_binding_size: bytes, ..limits })
}

/// Loses the device.
pub fn lose(gpu: &Gpu) {
    gpu.device.destroy();
}

fn ignored(required: bool, present: impl FnOnce() -> bool) -> bool {
    !required && !present()
}

#[cfg(test)]
mod tests {
    use super::ignored;

    #[test]
    fn tests_are_ignored_only_without_an_adapter_that_nobody_requires() {
        assert!(ignored(false, || false));
        assert!(!ignored(false, || true));
        assert!(!ignored(true, || false));
        assert!(!ignored(true, || true));
    }
}
