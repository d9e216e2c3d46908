//! The result of calls.

/// The result of a call.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The call succeeded.
    Ok = 0,
    /// A required pointer is null.
    Null = 1,
    /// A string is not UTF-8.
    NotUtf8 = 2,
    /// An unknown name, a value that an argument, param or option does not take, or a buffer that
    /// is too small.
    Argument = 3,
    /// The scene has errors, draws nothing, or cannot be written with these options.
    Scene = 4,
    /// A bug in sdfc.
    Internal = 5,
    /// The machine cannot do it: there is no GPU, or not enough memory.
    Machine = 6,
    /// The progress callback stopped the work.
    Stopped = 7,
}
