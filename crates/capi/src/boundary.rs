//! What crosses from C and back: pointers, texts, errors, and no panic.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::Status;

/// Why a call fails.
pub(crate) struct Failure {
    status: Status,
    message: String,
}

impl Failure {
    pub(crate) fn not_utf8(what: &str) -> Self {
        Self { status: Status::NotUtf8, message: format!("the {what} is not UTF-8") }
    }

    pub(crate) fn argument(error: impl Display) -> Self {
        Self { status: Status::Argument, message: error.to_string() }
    }

    pub(crate) fn scene(error: impl Display) -> Self {
        Self { status: Status::Scene, message: error.to_string() }
    }

    pub(crate) fn internal(error: impl Display) -> Self {
        Self { status: Status::Internal, message: error.to_string() }
    }

    fn null() -> Self {
        Self { status: Status::Null, message: "a pointer is null that may not be".to_owned() }
    }
}

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// Runs a call, and keeps why it failed.
pub(crate) fn guarded(call: impl FnOnce() -> Result<(), Failure>) -> Status {
    // What a call leaves half done in a scene are values of params, each of which is whole.
    let done = catch_unwind(AssertUnwindSafe(call));
    let done = done.unwrap_or_else(|_| Err(Failure::internal("sdfc panicked, which is its fault")));
    let (status, message) = match done {
        Ok(()) => (Status::Ok, String::new()),
        Err(Failure { status, message }) => (status, message.replace('\0', "\u{fffd}")),
    };
    // A thread that is ending has no place for it any more.
    let _ = LAST.try_with(|last| last.replace(CString::new(message).unwrap_or_default()));
    status
}

pub(crate) fn last_error() -> *const c_char {
    LAST.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// # Safety
///
/// Null, or ends in a null byte and lives as long as is said.
pub(crate) unsafe fn text<'a>(text: *const c_char) -> Result<&'a str, Failure> {
    if text.is_null() {
        return Err(Failure::null());
    }
    // SAFETY: as this function's.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|_| Failure::not_utf8("text"))
}

/// # Safety
///
/// Null, or what it is said to point to, which nobody changes meanwhile.
pub(crate) unsafe fn handle<'a, T>(pointer: *const T) -> Result<&'a T, Failure> {
    // SAFETY: as this function's.
    unsafe { pointer.as_ref() }.ok_or_else(Failure::null)
}

/// # Safety
///
/// Null, or what it is said to point to, which nobody else has meanwhile.
pub(crate) unsafe fn handle_mut<'a, T>(pointer: *mut T) -> Result<&'a mut T, Failure> {
    // SAFETY: as this function's.
    unsafe { pointer.as_mut() }.ok_or_else(Failure::null)
}

/// As many elements; null will do for none.
///
/// # Safety
///
/// Null, or has so many, which nobody changes meanwhile.
pub(crate) unsafe fn slice<'a, T>(first: *const T, count: usize) -> Result<&'a [T], Failure> {
    fits::<T>(count)?;
    match (first.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(Failure::null()),
        // SAFETY: as this function's.
        (false, _) => Ok(unsafe { std::slice::from_raw_parts(first, count) }),
    }
}

/// As [`slice`], to be written.
///
/// # Safety
///
/// Null, or has so many, which nobody else has meanwhile.
pub(crate) unsafe fn slice_mut<'a, T>(first: *mut T, count: usize) -> Result<&'a mut [T], Failure> {
    fits::<T>(count)?;
    match (first.is_null(), count) {
        (_, 0) => Ok(&mut []),
        (true, _) => Err(Failure::null()),
        // SAFETY: as this function's.
        (false, _) => Ok(unsafe { std::slice::from_raw_parts_mut(first, count) }),
    }
}

/// Nothing in memory is larger.
fn fits<T>(count: usize) -> Result<(), Failure> {
    let bytes = count.checked_mul(size_of::<T>());
    let fits = bytes.is_some_and(|bytes| isize::try_from(bytes).is_ok());
    if fits { Ok(()) } else { Err(Failure::argument(format!("{count} elements: too many"))) }
}

/// Copies bytes to where there may be too little room.
pub(crate) fn fill(room: &mut [u8], bytes: &[u8]) -> Result<(), Failure> {
    let short = || Failure::argument(format!("{} bytes do not fit", bytes.len()));
    room.get_mut(..bytes.len()).ok_or_else(short)?.copy_from_slice(bytes);
    Ok(())
}
