//! The functions that `npm/index.js` calls.
//!
//! Strings are passed in two buffers of this module: the page reserves the first and writes the
//! source and the options into it, one after the other; it reads the answer from the second.
#![expect(unsafe_code, reason = "an exported name is an unsafe attribute")]

use std::sync::{Mutex, MutexGuard, PoisonError};

static INPUT: Mutex<Vec<u8>> = Mutex::new(Vec::new());
static ANSWER: Mutex<String> = Mutex::new(String::new());

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Reserves `length` bytes and returns their address.
#[unsafe(no_mangle)]
extern "C" fn reserve(length: usize) -> *const u8 {
    let mut input = locked(&INPUT);
    *input = vec![0; length];
    input.as_ptr()
}

/// Compiles the input in the reserved buffer: `source_length` bytes of source, then the options.
/// Returns the address of the answer.
#[unsafe(no_mangle)]
extern "C" fn compile(source_length: usize) -> *const u8 {
    let input = std::mem::take(&mut *locked(&INPUT));
    let (source, options) = input.split_at(source_length.min(input.len()));
    let [source, options] = [source, options].map(String::from_utf8_lossy);
    let mut answer = locked(&ANSWER);
    *answer = crate::compile(&source, &options);
    answer.as_ptr()
}

/// Returns the length of the last answer in bytes.
#[unsafe(no_mangle)]
extern "C" fn answer_length() -> usize {
    locked(&ANSWER).len()
}
