//! Results to files and to stdout.

use std::io::{ErrorKind, Write, stdout};
use std::path::{Path, PathBuf};

use sdfc_files::{check_writable, write};

use crate::failure::Failure;

/// Where a result goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Output {
    /// Written beside its place under another name, then renamed.
    File(PathBuf),
    /// As a stream.
    Stdout,
}

impl Output {
    /// `-` is stdout.
    pub fn new(path: &Path) -> Self {
        if path.as_os_str() == "-" { Self::Stdout } else { Self::File(path.to_owned()) }
    }

    /// Fails now where writing would fail after long work.
    ///
    /// # Errors
    ///
    /// The folder is missing or does not take new files.
    pub fn check(&self) -> Result<(), Failure> {
        match self {
            Self::Stdout => Ok(()),
            Self::File(path) => check_writable(path).map_err(|e| cannot_write(path, &e)),
        }
    }

    /// Writes all of `bytes`.
    ///
    /// # Errors
    ///
    /// The output is not writable or the disk is full. That a reader of stdout has gone away is none.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        match self {
            Self::Stdout => to_stdout(bytes),
            Self::File(path) => write(path, bytes).map_err(|e| cannot_write(path, &e)),
        }
    }
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Machine(format!("cannot write {}: {error}", path.display()))
}

/// Writes to stdout; a closed pipe is a reader that has seen enough.
pub fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Machine(format!("cannot write to stdout: {e}")))
        }
        _ => Ok(()),
    }
}

/// Fails if an output would overwrite the scene or another output.
///
/// # Errors
///
/// Two of the paths are one file: the call is wrong.
pub fn distinct(scene: &Path, outputs: &[&Path]) -> Result<(), Failure> {
    let place = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let is_stream = |path: &Path| path.as_os_str() == "-";
    for (index, path) in outputs.iter().enumerate() {
        if !is_stream(path) && place(path) == place(scene) {
            let name = path.display();
            return Err(Failure::Call(format!("{name} is the scene; write somewhere else")));
        }
        if outputs[..index].iter().any(|other| place(other) == place(path)) {
            let name = path.display();
            return Err(Failure::Call(format!("two outputs go to {name}; one place holds one")));
        }
    }
    Ok(())
}
