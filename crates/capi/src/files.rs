//! Files that scenes import, from the program that calls.

use std::ffi::{CString, c_char, c_int, c_void};

use sdfc::Resolver;
use sdfc::lang::NoFiles;

use crate::Status;
use crate::boundary::{guarded, handle_mut, slice};

/// The contents of a file that a scene imports, given by `sdfc_file_give`.
#[derive(Debug, Default)]
pub struct File {
    bytes: Vec<u8>,
}

/// Gives a file that a scene imports to `file`, and returns 0; anything else where there is none or the scene may not have it,
/// which is then an error at its `import`. `path` is below the scene's folder, with `/` between its parts and neither `.` nor `..`
/// among them: `parts/gear.sdf`. `context` is what `sdfc_compile_with_files` was given.
pub type Read = Option<
    unsafe extern "C" fn(context: *mut c_void, path: *const c_char, file: *mut File) -> c_int,
>;

/// Adds bytes to a file that a scene imports, which are copied. A scene's text is UTF-8.
///
/// # Safety
///
/// The file is that of a call of `sdfc_read` that has not returned; there are that many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_file_give(
    file: *mut File,
    bytes: *const c_void,
    length: usize,
) -> Status {
    guarded(|| {
        // SAFETY: as this function's.
        let (file, bytes) = unsafe { (handle_mut(file)?, slice(bytes.cast::<u8>(), length)?) };
        file.bytes.extend_from_slice(bytes);
        Ok(())
    })
}

/// The program that calls, as it is asked for files.
pub(crate) struct Host {
    read: Read,
    context: *mut c_void,
}

impl Host {
    /// # Safety
    ///
    /// The function may be called with that context as long as this lives.
    pub(crate) unsafe fn new(read: Read, context: *mut c_void) -> Self {
        Self { read, context }
    }
}

impl Resolver for Host {
    fn read(&self, path: &str) -> Result<String, String> {
        String::from_utf8(self.read_bytes(path)?).map_err(|_| "the file is not UTF-8".to_owned())
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        let Some(read) = self.read else { return NoFiles.read_bytes(path) };
        let path = CString::new(path).map_err(|_| "a path has no null byte".to_owned())?;
        let mut file = File::default();
        // SAFETY: as `new`'s; path and file live until it returns.
        let refused = unsafe { read(self.context, path.as_ptr(), &raw mut file) };
        if refused == 0 { Ok(file.bytes) } else { Err("the program gives no such file".to_owned()) }
    }
}
