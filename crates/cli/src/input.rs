//! Scenes from files and from stdin.

use std::io::Read;
use std::path::Path;

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

fn read_all(from: impl Read) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}
