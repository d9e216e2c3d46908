//! Writes files atomically.

use std::fs::File;
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
    let mut file = Replacement::begin(path)?;
    file.write_all(bytes)?;
    file.finish()
}

/// Replaces a file as [`write()`] does, if it still has the contents that the caller has read.
/// Returns false, and changes nothing, if another program has changed it since.
///
/// # Errors
///
/// As [`write()`]; the file cannot be read.
pub fn write_unless_changed(path: &Path, before: &[u8], after: &[u8]) -> std::io::Result<bool> {
    let mut file = Replacement::begin(path)?;
    file.write_all(after)?;
    // As late as can be: an editor may save the file at any time.
    if std::fs::read(path)? != before {
        return Ok(false);
    }
    file.finish()?;
    Ok(true)
}

/// Writes a new file, completely or not at all.
///
/// # Errors
///
/// [`ErrorKind::AlreadyExists`] if the path exists, also as a folder or a link; the folder is
/// missing or not writable, or the disk is full.
pub fn create(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    if std::fs::symlink_metadata(path).is_ok() {
        return Err(ErrorKind::AlreadyExists.into());
    }
    let mut file = temporary(path)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    file.persist_noclobber(path).map_err(|error| error.error)?;
    Ok(())
}

/// A file that is written part by part. It gets its name by [`Self::finish`]; dropped before, it is
/// deleted, and an existing file stays as it was.
#[derive(Debug)]
pub struct Replacement {
    path: PathBuf,
    to: Destination,
}

#[derive(Debug)]
enum Destination {
    Temporary(NamedTempFile),
    Device(File),
}

impl Replacement {
    /// Begins to replace a file, as [`write()`] does.
    ///
    /// # Errors
    ///
    /// The folder is missing or not writable, or the path is a folder.
    pub fn begin(path: &Path) -> std::io::Result<Self> {
        let to = match is_device(path) {
            true => Destination::Device(File::options().write(true).open(path)?),
            false => Destination::Temporary(temporary(path)?),
        };
        Ok(Self { path: path.to_owned(), to })
    }

    /// Gives the file its name.
    ///
    /// # Errors
    ///
    /// The disk is full, or the path has become a folder.
    pub fn finish(self) -> std::io::Result<()> {
        let Destination::Temporary(file) = self.to else { return Ok(()) };
        if let Ok(before) = std::fs::metadata(&self.path) {
            file.as_file().set_permissions(before.permissions())?;
        }
        file.as_file().sync_all()?;
        file.persist(target(&self.path)).map_err(|error| error.error)?;
        Ok(())
    }

    /// Returns the path of the temporary file; `None` if a device is written to. A process that
    /// ends without destroying this value removes that file by itself.
    pub fn temporary_path(&self) -> Option<&Path> {
        match &self.to {
            Destination::Temporary(file) => Some(file.path()),
            Destination::Device(_) => None,
        }
    }

    fn file(&mut self) -> &mut File {
        match &mut self.to {
            Destination::Temporary(file) => file.as_file_mut(),
            Destination::Device(file) => file,
        }
    }
}

impl Write for Replacement {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.file().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file().flush()
    }
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

    #[test]
    fn a_file_without_its_end_has_no_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gif");
        std::fs::write(&path, "old").unwrap();
        let mut file = Replacement::begin(&path).unwrap();
        file.write_all(b"half").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert!(file.temporary_path().unwrap().exists());
        drop(file);
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_new_file_replaces_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let [file, link, gone] = ["a.sdf", "b.sdf", "c.sdf"].map(|it| folder.path().join(it));
        create(&file, b"new").unwrap();
        symlink(&gone, &link).unwrap();
        for path in [&file, &link, folder.path()] {
            let error = create(path, b"newer").unwrap_err();
            assert_eq!(error.kind(), ErrorKind::AlreadyExists, "{}", path.display());
        }
        assert_eq!(std::fs::read(&file).unwrap(), b"new");
        assert!(create(&gone.join("d.sdf"), b"new").is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn a_changed_file_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, "saved by an editor").unwrap();
        assert!(!write_unless_changed(&path, b"read", b"formatted").unwrap());
        assert_eq!(std::fs::read(&path).unwrap(), b"saved by an editor");
        assert!(write_unless_changed(&path, b"saved by an editor", b"formatted").unwrap());
        assert_eq!(std::fs::read(&path).unwrap(), b"formatted");
    }
}
