//! Results that are files.

use crate::boundary::{guarded, handle, handle_mut};

/// The content of a file.
#[derive(Debug)]
pub struct Bytes(pub(crate) Vec<u8>);

/// Returns the bytes, and stores their number in `length`. Returns null for null.
///
/// # Safety
///
/// `bytes` is null or valid, and is not freed while its content is used. `length` is null or valid
/// for a write.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_bytes_data(bytes: *const Bytes, length: *mut usize) -> *const u8 {
    let mut data = std::ptr::null();
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (Bytes(bytes), length) = unsafe { (handle(bytes)?, handle_mut(length)?) };
        (data, *length) = (bytes.as_ptr(), bytes.len());
        Ok(())
    });
    data
}

/// Frees the content of a file. Does nothing for null.
///
/// # Safety
///
/// The bytes were returned by a function whose documentation says so, and are not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_bytes_free(bytes: *mut Bytes) {
    if !bytes.is_null() {
        // SAFETY: the pointer came from a `Box`, and the caller does not use it again.
        drop(unsafe { Box::from_raw(bytes) });
    }
}
