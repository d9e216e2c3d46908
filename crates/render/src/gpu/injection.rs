//! Faults that a test asks for.

use std::sync::atomic::{AtomicU32, Ordering};

/// The environment variable that makes a build with debug assertions lose its device, as if the
/// adapter had been unplugged, before calls with these numbers: `0,3` are the first and the fourth.
/// The calls of all devices of the process are counted together.
pub const LOSE_DEVICE: &str = "SDFC_LOSE_DEVICE_AT";

/// Called before each call to a device: true if [`LOSE_DEVICE`] asks to lose it.
pub(crate) fn loses_device() -> bool {
    static CALLS: AtomicU32 = AtomicU32::new(0);
    if cfg!(debug_assertions)
        && let Ok(numbers) = std::env::var(LOSE_DEVICE)
    {
        let call = CALLS.fetch_add(1, Ordering::Relaxed).to_string();
        return numbers.split(',').any(|number| number == call);
    }
    false
}
