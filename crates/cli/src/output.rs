//! Writes results to files and to stdout.

use std::io::{ErrorKind, Write, stdout};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use sdfc_files::{Replacement, check_writable, write, write_unless_changed};
use serde::Serialize;

use crate::failure::Failure;

/// The destination of a result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Output {
    /// A file. It is written under a temporary name and then renamed.
    File(PathBuf),
    /// Standard output.
    Stdout,
}

impl Output {
    /// Makes a destination from a path; `-` is stdout.
    pub fn new(path: &Path) -> Self {
        if path.as_os_str() == "-" { Self::Stdout } else { Self::File(path.to_owned()) }
    }

    /// Checks early that the destination can be written, before long work.
    ///
    /// # Errors
    ///
    /// The folder does not exist or is not writable.
    pub fn check(&self) -> Result<(), Failure> {
        match self {
            Self::Stdout => Ok(()),
            Self::File(path) => check_writable(path).map_err(|e| cannot_write(path, &e)),
        }
    }

    /// Writes the new contents of a file that has been read, unless it has been changed since.
    ///
    /// # Errors
    ///
    /// As [`Self::write`]; the file has been changed.
    pub fn write_unless_changed(&self, before: &[u8], after: &[u8]) -> Result<(), Failure> {
        let Self::File(path) = self else { return self.write(after) };
        let _writing = writing();
        match write_unless_changed(path, before, after) {
            Ok(true) => Ok(()),
            Ok(false) => Err(Failure::Machine(format!(
                "{}: another program has just changed the file; try again",
                path.display()
            ))),
            Err(error) => Err(cannot_write(path, &error)),
        }
    }

    /// Writes `bytes`.
    ///
    /// # Errors
    ///
    /// The destination is not writable or the disk is full. A closed pipe is not an error.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        match self {
            Self::Stdout => to_stdout(bytes),
            Self::File(path) => {
                let _writing = writing();
                write(path, bytes).map_err(|e| cannot_write(path, &e))
            }
        }
    }
}

/// Held while a file is written.
static WRITING: Mutex<()> = Mutex::new(());

fn writing() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The temporary file of the [`PartialFile`] that is not finished. There is at most one.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

fn unfinished() -> MutexGuard<'static, Option<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs `act`, which ends the process, while no file is being written. Removes the file that is not
/// finished.
pub fn while_nothing_is_written(act: impl FnOnce()) {
    let _writing = writing();
    if let Some(path) = unfinished().take() {
        // The process ends anyway.
        let _ = std::fs::remove_file(path);
    }
    act();
}

/// Remembers in [`UNFINISHED`] that there is a file, until this is dropped.
struct Unfinished;

impl Unfinished {
    fn new(file: &Replacement) -> Self {
        *unfinished() = file.temporary_path().map(Path::to_owned);
        Self
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        *unfinished() = None;
    }
}

/// A file that is written part by part, and gets its name when it is finished.
pub struct PartialFile {
    path: PathBuf,
    file: Replacement,
    failure: Option<Failure>,
    // The last field, which is dropped after the file.
    unfinished: Unfinished,
}

impl PartialFile {
    /// Begins a file.
    ///
    /// # Errors
    ///
    /// As [`Output::check`].
    pub fn begin(path: &Path) -> Result<Self, Failure> {
        let _writing = writing();
        let file = Replacement::begin(path).map_err(|e| cannot_write(path, &e))?;
        let unfinished = Unfinished::new(&file);
        Ok(Self { path: path.to_owned(), file, failure: None, unfinished })
    }

    /// Returns why a part was not written, also if the writer ignored the error.
    pub fn failure(&mut self) -> Option<Failure> {
        self.failure.take()
    }

    /// Gives the file its name.
    ///
    /// # Errors
    ///
    /// The disk is full, now or when a part was written.
    pub fn finish(self) -> Result<(), Failure> {
        let _writing = writing();
        let Self { path, file, failure, unfinished } = self;
        let finished = match failure {
            Some(failure) => Err(failure),
            None => file.finish().map_err(|e| cannot_write(&path, &e)),
        };
        drop(unfinished);
        finished
    }

    fn noted<T>(&mut self, written: std::io::Result<T>) -> std::io::Result<T> {
        written.inspect_err(|e| {
            self.failure.get_or_insert_with(|| cannot_write(&self.path, e));
        })
    }
}

impl Write for PartialFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.file.write(bytes);
        self.noted(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        let flushed = self.file.flush();
        self.noted(flushed)
    }
}

impl std::fmt::Display for Output {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Stdout => f.write_str("stdout"),
        }
    }
}

/// A result and, if it is asked for, a report about it in JSON.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WithReport {
    /// The path of the result.
    pub path: PathBuf,
    output: Output,
    report: Option<Output>,
}

impl WithReport {
    /// Makes the destinations, and checks early that they can be written. Without `path` the result
    /// is named after the scene.
    ///
    /// # Errors
    ///
    /// Two of the outputs and the scene are the same file, or a folder does not exist or is not
    /// writable.
    pub fn new(
        scene: &Path,
        path: Option<&Path>,
        extension: &str,
        report: Option<&Path>,
    ) -> Result<Self, Failure> {
        let path = path.map_or_else(|| named_after(scene, extension), Path::to_owned);
        let paths = [Some(path.as_path()), report];
        distinct(scene, &paths.into_iter().flatten().collect::<Vec<&Path>>())?;
        let output = Output::new(&path);
        output.check()?;
        let report = report.map(Output::new);
        report.as_ref().map_or(Ok(()), Output::check)?;
        Ok(Self { path, output, report })
    }

    /// Writes the result, and the report if it is asked for.
    ///
    /// # Errors
    ///
    /// A destination is not writable, the disk is full, or the report is no JSON.
    pub fn write(&self, bytes: &[u8], report: &impl Serialize) -> Result<(), Failure> {
        self.output.write(bytes)?;
        match &self.report {
            Some(output) => output.write(&json(report)?),
            None => Ok(()),
        }
    }
}

/// Returns a value as JSON with a final newline.
///
/// # Errors
///
/// Never, for the plain data that commands write.
pub fn json(value: &impl Serialize) -> Result<Vec<u8>, Failure> {
    let text = serde_json::to_vec_pretty(value);
    let mut bytes = text.map_err(|e| Failure::Machine(format!("cannot write JSON: {e}")))?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Returns the failure of a command that cannot write a file, with advice.
pub fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Machine(format!("cannot write {}: {error}{}", path.display(), advice(error)))
}

/// What to do about a file that cannot be written. Other errors say what they are.
const ADVICE: [(&[ErrorKind], &str); 4] = [
    (
        &[ErrorKind::StorageFull, ErrorKind::QuotaExceeded, ErrorKind::FileTooLarge],
        "; free space, or write to another disk",
    ),
    (
        &[ErrorKind::PermissionDenied, ErrorKind::ReadOnlyFilesystem],
        "; choose a folder that you may write to",
    ),
    (&[ErrorKind::NotFound, ErrorKind::NotADirectory], "; create its folder, or choose another"),
    (&[ErrorKind::IsADirectory], "; add the name of a file"),
];

/// Says what to do about a file that cannot be written.
fn advice(error: &std::io::Error) -> &'static str {
    let known = ADVICE.iter().find(|(kinds, _)| kinds.contains(&error.kind()));
    known.map_or("", |(_, advice)| *advice)
}

/// Writes to stdout. A closed pipe is not an error: the reader has seen enough.
pub fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Machine(format!("cannot write to stdout: {e}{}", advice(&e))))
        }
        _ => Ok(()),
    }
}

/// Checks that no output overwrites the scene or another output.
///
/// # Errors
///
/// Two of the paths are the same file.
pub fn distinct(scene: &Path, outputs: &[&Path]) -> Result<(), Failure> {
    let resolved = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let is_stream = |path: &Path| path.as_os_str() == "-";
    for (index, path) in outputs.iter().enumerate() {
        if !is_stream(path) && resolved(path) == resolved(scene) {
            let name = path.display();
            return Err(Failure::Call(format!(
                "the output {name} is the scene itself; choose another file"
            )));
        }
        if outputs[..index].iter().any(|other| resolved(other) == resolved(path)) {
            let name = path.display();
            return Err(Failure::Call(format!(
                "two outputs are written to {name}; choose different files"
            )));
        }
    }
    Ok(())
}

/// Returns the default output of a scene: `ball.png` in the current folder for `scenes/ball.sdf`.
pub fn named_after(scene: &Path, extension: &str) -> PathBuf {
    let stem = scene.file_stem().filter(|stem| *stem != "-");
    let mut name = stem.map_or_else(|| "scene".into(), ToOwned::to_owned);
    name.push(".");
    name.push(extension);
    PathBuf::from(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outputs_are_named_after_their_scenes() {
        let name = |scene: &str| named_after(Path::new(scene), "png");
        assert_eq!(name("a/b.c/ball.sdf"), Path::new("ball.png"));
        assert_eq!(name("ball"), Path::new("ball.png"));
        assert_eq!(name("-"), Path::new("scene.png"));
    }
}
