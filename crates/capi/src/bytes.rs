//! Results that are files.

use crate::boundary::{free, guarded, handle, store};

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
        unsafe {
            let Bytes(bytes) = handle(bytes)?;
            store(length, &[bytes.len()])?;
            data = bytes.as_ptr();
        }
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
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { free(bytes) }
}
