//! Scenes from files and from stdin.

use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// No scene is larger; the compiler's own limit is smaller and says so with a diagnostic.
const MAX_BYTES: u64 = 64 << 20;

/// A scene's text and the name that diagnostics give it.
pub struct Input {
    /// The path as it was written, or `<stdin>`.
    pub name: String,
    /// The text.
    pub text: String,
}

/// Reads a file, or stdin for `-`.
///
/// # Errors
///
/// The file is missing, unreadable, no UTF-8 or larger than 64 MiB: the call is wrong.
pub fn read(path: &Path) -> Result<Input, Failure> {
    let is_stdin = path.as_os_str() == "-";
    let name = if is_stdin { "<stdin>".to_owned() } else { path.display().to_string() };
    let bytes = if is_stdin {
        read_all(std::io::stdin().lock())
    } else {
        std::fs::File::open(path).and_then(read_all)
    };
    let bytes = bytes.map_err(|e| Failure::Call(format!("cannot read {name}: {e}")))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Failure::Call(format!("{name} is larger than {} MiB", MAX_BYTES >> 20)));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Input { name, text }),
        Err(e) => {
            let at = e.utf8_error().valid_up_to();
            Err(Failure::Call(format!(
                "{name} is not UTF-8 text: the byte at offset {at} is wrong"
            )))
        }
    }
}

/// The files that a scene may import: those below the folder where it lies, for stdin the current one.
pub struct Folder(PathBuf);

impl Folder {
    /// Of the scene at `path`.
    pub fn of(path: &Path) -> Self {
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
        Self(parent.unwrap_or(Path::new(".")).to_owned())
    }

    fn place(&self, path: &str) -> std::io::Result<PathBuf> {
        let (folder, place) = (self.0.canonicalize()?, self.0.join(path).canonicalize()?);
        // A link could lead out of the folder although the path does not.
        if place.starts_with(&folder) { Ok(place) } else { Err(ErrorKind::PermissionDenied.into()) }
    }
}

impl sdfc::Resolver for Folder {
    fn read(&self, path: &str) -> Result<String, String> {
        let place = self.place(path).map_err(|e| e.to_string())?;
        match read(&place) {
            Ok(input) => Ok(input.text),
            Err(failure) => Err(failure.to_string()),
        }
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        let place = self.place(path).map_err(|e| e.to_string())?;
        let file = std::fs::File::open(place).map_err(|e| e.to_string())?;
        let bytes = read_all(file).map_err(|e| e.to_string())?;
        if bytes.len() as u64 > MAX_BYTES {
            return Err(format!("it is larger than {} MiB", MAX_BYTES >> 20));
        }
        Ok(bytes)
    }
}

fn read_all(from: impl Read) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}
