//! What the oracle found, kept in a folder.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use sdfc::accuracy_data::TruthStore;

use crate::args::Cache;
use crate::output::Output;

/// All truths of a folder take at most so many bytes; those go that were not asked for the longest.
const MOST_BYTES: u64 = 256 << 20;
const ENDING: &str = "truth";

/// A folder of truths. That it cannot be read or written is no reason to fail.
pub struct TruthFolder {
    folder: PathBuf,
}

impl TruthFolder {
    /// The one that is asked for, or the user's.
    pub fn of(cache: &Cache) -> Option<Self> {
        let folder = cache.cache.clone().or_else(|| users(|name| std::env::var_os(name)));
        folder.filter(|_| !cache.no_cache).map(|folder| Self { folder })
    }

    fn path(&self, key: &str) -> PathBuf {
        self.folder.join(key).with_extension(ENDING)
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
        let _ = std::fs::create_dir_all(&self.folder);
        let _ = Output::File(self.path(key)).write(bytes);
        thin_out(&self.folder, MOST_BYTES);
    }
}

/// The folder for caches by the customs of the system.
fn users(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let folder = |name| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let home = || folder("HOME");
    let caches = if cfg!(windows) {
        folder("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        home().map(|home| home.join("Library/Caches"))
    } else {
        folder("XDG_CACHE_HOME").or_else(|| home().map(|home| home.join(".cache")))
    };
    caches.map(|caches| caches.join("sdfc").join("truths"))
}

/// Removes the oldest truths of a folder until the rest takes so many bytes.
fn thin_out(folder: &Path, most: u64) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let truths = entries.filter(|entry| entry.path().extension().is_some_and(|e| e == ENDING));
    let mut truths: Vec<(SystemTime, u64, PathBuf)> = truths
        .filter_map(|entry| {
            let about = entry.metadata().ok()?;
            Some((about.modified().ok()?, about.len(), entry.path()))
        })
        .collect();
    truths.sort_unstable_by(|a, b| b.cmp(a));
    let mut taken = 0;
    for (_, bytes, path) in truths {
        taken += bytes;
        if taken > most {
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
    fn a_folder_keeps_what_was_asked_for_last() {
        let place = tempfile::tempdir().unwrap();
        let folder = TruthFolder { folder: place.path().join("not/there/yet") };
        for (age, key) in ["a", "b", "c"].into_iter().enumerate() {
            folder.put(key, &[0; 100]);
            let file = std::fs::File::options().append(true).open(folder.path(key)).unwrap();
            file.set_modified(SystemTime::now() - Duration::from_secs(100 - age as u64)).unwrap();
        }
        std::fs::write(folder.folder.join("note.txt"), [0; 500]).unwrap();
        assert_eq!(folder.get("a"), Some(vec![0; 100]));
        thin_out(&folder.folder, 200);
        let has = ["a", "b", "c"].map(|key| folder.path(key).exists());
        assert_eq!(has, [true, false, true]);
        assert!(folder.folder.join("note.txt").exists(), "what is no truth stays");
    }

    #[test]
    #[cfg(all(unix, not(target_os = "macos")))]
    fn the_users_folder_is_where_the_system_says() {
        let at = |pairs: &'static [(&str, &str)]| {
            users(|name| {
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
