//! Data that the viewer keeps in JSON files of its own.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Reads a file. A file that is missing or invalid, or that has more than `max_bytes` bytes, gives
/// the default: the viewer did not write it.
pub fn read<T: DeserializeOwned + Default>(path: &Path, max_bytes: u64) -> T {
    let small = std::fs::metadata(path).is_ok_and(|found| found.len() <= max_bytes);
    let text = small.then(|| std::fs::read_to_string(path).ok()).flatten();
    text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
}

/// Writes a file and makes its folder. Errors are ignored: the data is then lost.
pub fn write(path: &Path, value: &impl Serialize) {
    if let (Some(folder), Ok(text)) = (path.parent(), serde_json::to_string_pretty(value)) {
        let _ = std::fs::create_dir_all(folder);
        let _ = sdfc_files::write(path, text.as_bytes());
    }
}
