//! The cache folder of the user, and the oracle's results in it.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use sdfc_measure::TruthStore;

use crate::args::Cache;
use crate::output::Output;

/// A folder holds at most this many bytes; the least recently used files are removed.
const MAX_BYTES: u64 = 256 << 20;
const EXTENSION: &str = "truth";

/// A folder of cached results. A folder that cannot be read or written is ignored.
pub struct TruthFolder {
    folder: PathBuf,
}

impl TruthFolder {
    /// Returns the folder of the options, or the user's cache folder. `None` with `--no-cache`.
    pub fn new(cache: &Cache) -> Option<Self> {
        let folder =
            cache.cache.clone().or_else(|| user_folder("truths", |name| std::env::var_os(name)));
        folder.filter(|_| !cache.no_cache).map(|folder| Self { folder })
    }

    fn path(&self, key: &str) -> PathBuf {
        self.folder.join(key).with_extension(EXTENSION)
    }
}

impl TruthStore for TruthFolder {
    fn get(&self, key: &str) -> Option<Vec<u8>> {
        let path = self.path(key);
        let bytes = std::fs::read(&path).ok()?;
        if let Ok(file) = std::fs::File::options().append(true).open(&path) {
            let _ = file.set_modified(SystemTime::now());
        }
        Some(bytes)
    }

    fn put(&self, key: &str, bytes: &[u8]) {
        // A full disk or a missing permission costs time, not the result.
        let _ = std::fs::create_dir_all(&self.folder);
        let _ = Output::File(self.path(key)).write(bytes);
        trim(&self.folder, MAX_BYTES);
    }
}

/// Returns a folder in the user's cache by the conventions of the operating system.
pub fn user_folder(below: &str, variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let folder = |name| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let home = || folder("HOME");
    let caches = if cfg!(windows) {
        folder("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        home().map(|home| home.join("Library/Caches"))
    } else {
        folder("XDG_CACHE_HOME").or_else(|| home().map(|home| home.join(".cache")))
    };
    caches.map(|caches| caches.join("sdfc").join(below))
}

/// Removes the least recently used files of a folder until the rest takes at most `max` bytes.
fn trim(folder: &Path, max: u64) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.filter(|entry| entry.path().extension().is_some_and(|e| e == EXTENSION));
    let mut files: Vec<(SystemTime, u64, PathBuf)> = files
        .filter_map(|entry| {
            let metadata = entry.metadata().ok()?;
            Some((metadata.modified().ok()?, metadata.len(), entry.path()))
        })
        .collect();
    files.sort_unstable_by(|a, b| b.cmp(a));
    let mut total = 0;
    for (_, bytes, path) in files {
        total += bytes;
        if total > max {
            let _ = std::fs::remove_file(path);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn the_least_recently_used_files_are_removed_first() {
        let temporary = tempfile::tempdir().unwrap();
        let folder = TruthFolder { folder: temporary.path().join("not/there/yet") };
        for (age, key) in ["a", "b", "c"].into_iter().enumerate() {
            folder.put(key, &[0; 100]);
            let file = std::fs::File::options().append(true).open(folder.path(key)).unwrap();
            file.set_modified(SystemTime::now() - Duration::from_secs(100 - age as u64)).unwrap();
        }
        std::fs::write(folder.folder.join("note.txt"), [0; 500]).unwrap();
        assert_eq!(folder.get("a"), Some(vec![0; 100]));
        trim(&folder.folder, 200);
        let has = ["a", "b", "c"].map(|key| folder.path(key).exists());
        assert_eq!(has, [true, false, true]);
        assert!(folder.folder.join("note.txt").exists(), "other files are not removed");
    }

    #[test]
    #[cfg(all(unix, not(target_os = "macos")))]
    fn the_user_folder_follows_the_conventions_of_the_system() {
        let at = |pairs: &'static [(&str, &str)]| {
            user_folder("truths", |name| {
                pairs.iter().find(|(known, _)| *known == name).map(|(_, value)| value.into())
            })
        };
        let path = |text| Some(PathBuf::from(text));
        assert_eq!(at(&[("HOME", "/h")]), path("/h/.cache/sdfc/truths"));
        assert_eq!(at(&[("HOME", "/h"), ("XDG_CACHE_HOME", "/x")]), path("/x/sdfc/truths"));
        assert_eq!(at(&[("XDG_CACHE_HOME", "x"), ("HOME", "/h")]), path("/h/.cache/sdfc/truths"));
        assert_eq!(at(&[]), None);
    }
}
