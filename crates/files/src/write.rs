//! Files that appear whole or not at all.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Writes a file beside its place under another name, then renames it, so that whoever reads sees the old bytes or all
/// of the new ones. A link keeps being one: the file that it names is replaced. What is there keeps its permissions.
/// A device, such as `/dev/null`, is written to.
///
/// # Errors
///
/// The folder is missing or takes no new files, the path is a folder, the disk is full. What was there is left as it was.
pub fn write(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    if is_device(path) {
        return std::fs::OpenOptions::new().write(true).open(path)?.write_all(bytes);
    }
    let mut file = temporary(path)?;
    file.write_all(bytes)?;
    if let Ok(before) = std::fs::metadata(path) {
        file.as_file().set_permissions(before.permissions())?;
    }
    file.as_file().sync_all()?;
    file.persist(place(path)).map_err(|error| error.error)?;
    Ok(())
}

/// Fails now where [`write()`] would fail after long work.
///
/// # Errors
///
/// The folder is missing or takes no new files, or the path is a folder.
pub fn check_writable(path: &Path) -> std::io::Result<()> {
    if is_device(path) { Ok(()) } else { temporary(path).map(drop) }
}

/// Whether it exists and is neither a file nor a folder: a terminal, `/dev/null`, a named pipe.
fn is_device(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// The file itself, where the path is a link to it.
fn place(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// A file in the folder where `path` is or will be, which vanishes unless it is renamed.
fn temporary(path: &Path) -> std::io::Result<NamedTempFile> {
    if path.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    let place = place(path);
    let folder = match place.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".sdfc-");
    // Temporary files are private by default; this one becomes the result and is as open as any other.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::{PermissionsExt, symlink};

    use super::*;

    #[test]
    fn what_is_replaced_keeps_its_permissions_and_links_to_it() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("a.sdf"), folder.path().join("b.sdf"));
        std::fs::write(&file, "old").unwrap();
        std::fs::set_permissions(&file, PermissionsExt::from_mode(0o640)).unwrap();
        symlink(&file, &link).unwrap();
        write(&link, b"new").unwrap();
        assert_eq!(std::fs::read(&file).unwrap(), b"new");
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(std::fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
