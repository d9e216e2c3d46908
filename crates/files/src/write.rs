//! Writes files atomically.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Replaces a file atomically: writes a temporary file beside it and renames that, so that a reader
/// sees the old contents or all of the new. A symbolic link stays a link, and its target is
/// replaced. An existing file keeps its permissions. A device, such as `/dev/null`, is written to
/// directly.
///
/// # Errors
///
/// The folder is missing or not writable, the path is a folder, or the disk is full. An existing
/// file then stays as it was.
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
    file.persist(target(path)).map_err(|error| error.error)?;
    Ok(())
}

/// Checks that [`write()`] would succeed, before a long computation.
///
/// # Errors
///
/// The folder is missing or not writable, or the path is a folder.
pub fn check_writable(path: &Path) -> std::io::Result<()> {
    if is_device(path) { Ok(()) } else { temporary(path).map(drop) }
}

/// Returns true if it exists and is neither a file nor a folder: a terminal, `/dev/null`, a named
/// pipe.
fn is_device(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|it| !it.is_file() && !it.is_dir())
}

/// Returns the target of a symbolic link, or the path itself.
fn target(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Creates a temporary file in the folder of `path`. It is deleted unless it is renamed.
fn temporary(path: &Path) -> std::io::Result<NamedTempFile> {
    if path.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    let target = target(path);
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".sdfc-");
    // Temporary files are private by default. This one becomes the result and gets the usual
    // permissions.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::{PermissionsExt, symlink};

    use super::*;

    #[test]
    fn a_replaced_file_keeps_its_permissions_and_links() {
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
