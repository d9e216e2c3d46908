//! The functions that `npm/index.js` calls.
//!
//! Texts cross by two buffers of this module: the page reserves the first and writes both texts into it, one behind
//! the other, and reads the answer from the second.
#![expect(unsafe_code, reason = "an exported name is an unsafe attribute")]

use std::sync::{Mutex, MutexGuard, PoisonError};

static ASKED: Mutex<Vec<u8>> = Mutex::new(Vec::new());
static ANSWER: Mutex<String> = Mutex::new(String::new());

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes room for so many bytes; gives where.
#[unsafe(no_mangle)]
extern "C" fn reserve(length: usize) -> *const u8 {
    let mut asked = locked(&ASKED);
    *asked = vec![0; length];
    asked.as_ptr()
}

/// Compiles what was written there: the scene in so many bytes, the options in the rest. Gives where the answer is.
#[unsafe(no_mangle)]
extern "C" fn compile(source_length: usize) -> *const u8 {
    let asked = std::mem::take(&mut *locked(&ASKED));
    let (source, options) = asked.split_at(source_length.min(asked.len()));
    let [source, options] = [source, options].map(String::from_utf8_lossy);
    let mut answer = locked(&ANSWER);
    *answer = crate::compile(&source, &options);
    answer.as_ptr()
}

/// Bytes of the last answer.
#[unsafe(no_mangle)]
extern "C" fn answer_length() -> usize {
    locked(&ANSWER).len()
}
