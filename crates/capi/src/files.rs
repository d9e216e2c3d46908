//! Imports: the files of a scene come from a callback of the calling program.

use std::ffi::{CString, c_char, c_int, c_void};

use sdfc::{NoFiles, Resolver};

use crate::boundary::{guarded, handle_mut, slice};
use crate::status::Status;

/// The contents of a file that a scene imports, given by `sdfc_file_give`.
#[derive(Debug, Default)]
pub struct File {
    bytes: Vec<u8>,
}

/// Callback that reads a file that a scene imports. It passes the contents to `sdfc_file_give` and
/// returns 0. Any other value means that there is no such file or that the scene may not read it;
/// that is an error at its `import`.
///
/// `path` is relative to the scene's folder, uses `/`, and has no parts `.` or `..`:
/// `parts/gear.sdf`. `context` is the pointer that was passed to `sdfc_compile_with_files`.
pub type Read = Option<
    unsafe extern "C" fn(context: *mut c_void, path: *const c_char, file: *mut File) -> c_int,
>;

/// Appends a copy of `length` bytes to a file that a scene imports. The text of a scene must be
/// UTF-8.
///
/// # Safety
///
/// `file` is the pointer that a running call of `sdfc_read` received. `bytes` is valid for `length`
/// bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_file_give(
    file: *mut File,
    bytes: *const c_void,
    length: usize,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (file, bytes) = unsafe { (handle_mut(file)?, slice(bytes.cast::<u8>(), length)?) };
        file.bytes.extend_from_slice(bytes);
        Ok(())
    })
}

/// The resolver that reads imports by the callback of the calling program.
pub(crate) struct CallbackResolver {
    read: Read,
    context: *mut c_void,
}

impl CallbackResolver {
    /// Creates the resolver for a callback.
    ///
    /// # Safety
    ///
    /// `read` may be called with `context` as long as the resolver lives.
    pub(crate) unsafe fn new(read: Read, context: *mut c_void) -> Self {
        Self { read, context }
    }
}

impl Resolver for CallbackResolver {
    fn read(&self, path: &str) -> Result<String, String> {
        String::from_utf8(self.read_bytes(path)?).map_err(|_| "the file is not UTF-8".to_owned())
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        let Some(read) = self.read else { return NoFiles.read_bytes(path) };
        let path = CString::new(path).map_err(|_| "the path has a null byte".to_owned())?;
        let mut file = File::default();
        // SAFETY: guaranteed by the caller of `new`; `path` and `file` live until `read` returns.
        let status = unsafe { read(self.context, path.as_ptr(), &raw mut file) };
        if status == 0 { Ok(file.bytes) } else { Err("the program has no such file".to_owned()) }
    }
}
