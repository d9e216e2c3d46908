//! Conversions at the C boundary: pointers, strings, errors. No panic crosses it.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};

use serde::Serialize;

use crate::status::Status;

/// The reason why a call failed.
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
        Self { status: Status::Null, message: "a required pointer is null".to_owned() }
    }
}

impl From<sdfc::Error> for Failure {
    fn from(error: sdfc::Error) -> Self {
        let status = if is_stopped(&error) {
            Status::Stopped
        } else if error.is_machine() {
            Status::Machine
        } else if error.is_call() {
            Status::Argument
        } else {
            Status::Scene
        };
        Self { status, message: error.to_string() }
    }
}

/// True if the progress callback stopped the work.
fn is_stopped(error: &sdfc::Error) -> bool {
    #[cfg(feature = "mesh")]
    if matches!(error, sdfc::Error::Mesh(sdfc::MeshError::Cancelled)) {
        return true;
    }
    matches!(error, sdfc::Error::Render(sdfc::RenderError::Cancelled))
}

thread_local! {
    static LAST: RefCell<(Status, CString)> = RefCell::new((Status::Ok, CString::default()));
}

/// Runs a call and stores the reason if it failed.
pub(crate) fn guarded(call: impl FnOnce() -> Result<(), Failure>) -> Status {
    // A call that panics may leave some params of a scene set and others not; each is valid.
    let result = catch_unwind(AssertUnwindSafe(call));
    let result = result.unwrap_or_else(|_| Err(Failure::internal("sdfc panicked; this is a bug")));
    let (status, message) = match result {
        Ok(()) => (Status::Ok, String::new()),
        Err(Failure { status, message }) => (status, message.replace('\0', "\u{fffd}")),
    };
    // The storage of a thread that is ending may be gone.
    let message = CString::new(message).unwrap_or_default();
    let _ = LAST.try_with(|last| last.replace((status, message)));
    status
}

pub(crate) fn last_error() -> *const c_char {
    LAST.try_with(|last| last.borrow().1.as_ptr()).unwrap_or(c"".as_ptr())
}

pub(crate) fn last_status() -> Status {
    LAST.try_with(|last| last.borrow().0).unwrap_or(Status::Internal)
}

/// Converts a C string.
///
/// # Safety
///
/// The pointer is null, or the string ends in a null byte and lives as long as the result.
pub(crate) unsafe fn text<'a>(text: *const c_char) -> Result<&'a str, Failure> {
    if text.is_null() {
        return Err(Failure::null());
    }
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|_| Failure::not_utf8("text"))
}

/// Converts a pointer to a reference, or fails if it is null.
///
/// # Safety
///
/// The pointer is null, or valid for reads, and nobody changes its target while the reference
/// lives.
pub(crate) unsafe fn handle<'a, T>(pointer: *const T) -> Result<&'a T, Failure> {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { pointer.as_ref() }.ok_or_else(Failure::null)
}

/// Converts a pointer to an object of this library to a mutable reference, or fails if it is null.
///
/// # Safety
///
/// The pointer is null, or valid for writes, and nobody else uses its target while the reference
/// lives.
pub(crate) unsafe fn handle_mut<'a, T>(pointer: *mut T) -> Result<&'a mut T, Failure> {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { pointer.as_mut() }.ok_or_else(Failure::null)
}

/// Converts a pointer and a count to a slice. The pointer may be null if the count is 0.
///
/// # Safety
///
/// The pointer is null, or valid for reads of `count` elements, and nobody changes them while the
/// slice lives.
pub(crate) unsafe fn slice<'a, T>(first: *const T, count: usize) -> Result<&'a [T], Failure> {
    fits::<T>(count)?;
    match (first.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(Failure::null()),
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        (false, _) => Ok(unsafe { std::slice::from_raw_parts(first, count) }),
    }
}

/// Fails if `count` elements are larger than anything in memory can be.
fn fits<T>(count: usize) -> Result<(), Failure> {
    let bytes = count.checked_mul(size_of::<T>());
    let fits = bytes.is_some_and(|bytes| isize::try_from(bytes).is_ok());
    if fits { Ok(()) } else { Err(Failure::argument(format!("{count} elements: too many"))) }
}

/// Fails if a pointer to `count` elements that a call writes is null. It may be null if `count` is
/// 0.
pub(crate) fn writable<T>(to: *mut T, count: usize) -> Result<(), Failure> {
    fits::<T>(count)?;
    if to.is_null() && count > 0 { Err(Failure::null()) } else { Ok(()) }
}

/// Copies values to memory of the caller, which may be uninitialised, or fails if it is null.
///
/// # Safety
///
/// The pointer is null, or valid for writes of as many elements as there are values.
pub(crate) unsafe fn store<T: Copy>(to: *mut T, values: &[T]) -> Result<(), Failure> {
    writable(to, values.len())?;
    if !values.is_empty() {
        // SAFETY: the pointer is not null; the rest is guaranteed by the caller.
        unsafe { std::ptr::copy(values.as_ptr(), to, values.len()) };
    }
    Ok(())
}

/// Returns a pointer into an object, or null if the object is null.
///
/// # Safety
///
/// The object is null, or valid for reads, and nobody changes it during the call.
pub(crate) unsafe fn pointer_into<T, P>(
    object: *const T,
    get: impl FnOnce(&T) -> *const P,
) -> *const P {
    let mut found = std::ptr::null();
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        found = get(unsafe { handle(object)? });
        Ok(())
    });
    found
}

/// Runs a call and returns its result, which [`free`] frees, or null if the call failed.
pub(crate) fn boxed<T>(call: impl FnOnce() -> Result<T, Failure>) -> *mut T {
    let mut made = std::ptr::null_mut();
    guarded(|| {
        made = Box::into_raw(Box::new(call()?));
        Ok(())
    });
    made
}

/// Runs a call and returns its string, which `sdfc_string_free` frees, or null if the call failed.
pub(crate) fn string(call: impl FnOnce() -> Result<CString, Failure>) -> *mut c_char {
    let mut made = std::ptr::null_mut();
    guarded(|| {
        made = call()?.into_raw();
        Ok(())
    });
    made
}

/// Frees a result of [`boxed`]. Does nothing for null.
///
/// # Safety
///
/// The object is null, or was returned by [`boxed`] and is not used again.
pub(crate) unsafe fn free<T>(object: *mut T) {
    if !object.is_null() {
        // SAFETY: the pointer came from a `Box`, and the caller does not use it again.
        drop(unsafe { Box::from_raw(object) });
    }
}

/// Returns a value as JSON. JSON escapes null bytes, so the string has none.
pub(crate) fn json(value: &impl Serialize) -> Result<CString, Failure> {
    let text = serde_json::to_string(value).map_err(Failure::internal)?;
    CString::new(text).map_err(Failure::internal)
}
