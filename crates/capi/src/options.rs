//! Options as JSON: a library that gains an option keeps its functions.

use std::ffi::c_char;

use serde::de::DeserializeOwned;

use crate::boundary::{Failure, text};

/// Reads an object with options. Null has the defaults.
///
/// # Safety
///
/// `options` is null or ends in a null byte.
pub(crate) unsafe fn options<T: DeserializeOwned + Default>(
    options: *const c_char,
) -> Result<T, Failure> {
    if options.is_null() {
        return Ok(T::default());
    }
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    let options = unsafe { text(options)? };
    serde_json::from_str(options).map_err(|error| Failure::argument(format!("options: {error}")))
}
