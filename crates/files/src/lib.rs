//! File access of the programs: reads scenes from files and stdin, resolves their imports, and
//! writes results. The library `sdfc` itself opens no files.
//!
//! ```no_run
//! use std::path::Path;
//!
//! let path = Path::new("scene.sdf");
//! let input = sdfc_files::read(path)?;
//! let folder = sdfc_files::Folder::of(path);
//! let compiled = sdfc::Compiler::new().resolver(&folder).compile(&input.name, &input.text);
//! # Ok::<(), sdfc_files::ReadError>(())
//! ```

#[cfg(feature = "pictures")]
mod format;
mod write;

#[cfg(feature = "pictures")]
pub use format::{Format, read_picture};
pub use write::{Replacement, check_writable, create, write, write_unless_changed};

use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

/// The largest file that is read, in bytes. The compiler has a smaller limit for scenes and reports
/// it with a diagnostic.
const MAX_BYTES: u64 = 64 << 20;

/// The source of a scene, and its name in diagnostics.
pub struct Input {
    /// The path as given, or `<stdin>`.
    pub name: String,
    /// The source.
    pub text: String,
}

/// The reason why a file could not be read, in one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError(String);

impl std::fmt::Display for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ReadError {}

/// Reads a file, or stdin for `-`.
///
/// # Errors
///
/// The file is missing, unreadable, not UTF-8 or larger than 64 MiB.
pub fn read(path: &Path) -> Result<Input, ReadError> {
    let is_stdin = path.as_os_str() == "-";
    let name = if is_stdin { "<stdin>".to_owned() } else { path.display().to_string() };
    let bytes = if is_stdin {
        read_all(std::io::stdin().lock())
    } else {
        std::fs::File::open(path).and_then(read_all)
    };
    let bytes = bytes.map_err(|e| ReadError(format!("cannot read {name}: {e}")))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(ReadError(format!("{name} is larger than {} MiB", MAX_BYTES >> 20)));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Input { name, text }),
        Err(e) => {
            let at = e.utf8_error().valid_up_to();
            Err(ReadError(format!("{name} is not UTF-8 text: invalid byte at offset {at}")))
        }
    }
}

/// The environment variable that lists folders of shared modules, as `PATH` lists folders.
pub const MODULE_FOLDERS: &str = "SDFC_PATH";

/// The files that a scene may import: those below its folder, which is the current folder for
/// stdin, and those below the folders of shared modules.
#[derive(Clone, Debug)]
pub struct Folder {
    own: PathBuf,
    /// Searched in this order, after the scene's own folder.
    modules: Vec<PathBuf>,
}

impl Folder {
    /// Creates the resolver for the scene at `path`, with the folders of [`MODULE_FOLDERS`].
    pub fn of(path: &Path) -> Self {
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
        Self::new(parent.unwrap_or(Path::new(".")).to_owned())
    }

    /// The resolver for scenes in a folder, with the folders of [`MODULE_FOLDERS`].
    pub fn new(own: PathBuf) -> Self {
        let listed = std::env::var_os(MODULE_FOLDERS).unwrap_or_default();
        // An empty part would be the current folder, which nobody means.
        let modules = std::env::split_paths(&listed).filter(|it| !it.as_os_str().is_empty());
        Self { own, modules: modules.collect() }
    }

    /// Returns the path of the scene's folder.
    pub fn path(&self) -> &Path {
        &self.own
    }

    /// Where a file with this path is: below the first folder that has one, or below the scene's
    /// folder if none has.
    pub fn file(&self, path: &str) -> PathBuf {
        self.base(path).join(path)
    }

    fn base(&self, path: &str) -> &Path {
        let mut bases = std::iter::once(&self.own).chain(&self.modules);
        bases.find(|base| base.join(path).exists()).unwrap_or(&self.own)
    }

    fn resolve(&self, path: &str) -> std::io::Result<PathBuf> {
        let base = self.base(path);
        let (folder, file) = (base.canonicalize()?, base.join(path).canonicalize()?);
        // A symbolic link could lead out of the folder although the path does not.
        if file.starts_with(&folder) { Ok(file) } else { Err(ErrorKind::PermissionDenied.into()) }
    }
}

impl sdfc::Resolver for Folder {
    fn read(&self, path: &str) -> Result<String, String> {
        let file = self.resolve(path).map_err(|e| e.to_string())?;
        match read(&file) {
            Ok(input) => Ok(input.text),
            Err(error) => Err(error.to_string()),
        }
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        let file = self.resolve(path).map_err(|e| e.to_string())?;
        read_bytes(&file).map_err(|e| e.to_string())
    }

    fn name_of(&self, path: &str) -> Option<String> {
        let base = self.base(path);
        (base != self.own).then(|| base.join(path).display().to_string())
    }
}

/// Reads a binary file.
///
/// # Errors
///
/// The file is missing, unreadable or larger than 64 MiB.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, ReadError> {
    let bytes = std::fs::File::open(path).and_then(read_all);
    let bytes = bytes.map_err(|e| ReadError(e.to_string()))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(ReadError(format!("the file is larger than {} MiB", MAX_BYTES >> 20)));
    }
    Ok(bytes)
}

fn read_all(from: impl Read) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sdfc::Resolver;

    #[test]
    fn imports_stay_in_the_folder_of_the_scene() {
        let root = tempfile::tempdir().unwrap();
        let inside = root.path().join("scene");
        std::fs::create_dir(&inside).unwrap();
        std::fs::write(root.path().join("secret.sdf"), "outside").unwrap();
        std::fs::write(inside.join("part.sdf"), "inside").unwrap();
        let folder = Folder::of(&inside.join("scene.sdf"));
        assert_eq!(folder.read("part.sdf").as_deref(), Ok("inside"));
        assert!(folder.read("../secret.sdf").is_err());
        assert!(folder.read("missing.sdf").is_err());
    }

    #[test]
    fn shared_modules_come_after_the_folder_of_the_scene() {
        let root = tempfile::tempdir().unwrap();
        let [own, first, second] = ["scene", "first", "second"].map(|it| root.path().join(it));
        for (folder, files) in
            [(&own, &["a.sdf"][..]), (&first, &["a.sdf", "b.sdf"]), (&second, &["b.sdf", "c.sdf"])]
        {
            std::fs::create_dir(folder).unwrap();
            for file in files {
                let name = folder.file_name().unwrap().to_string_lossy();
                std::fs::write(folder.join(file), name.as_bytes()).unwrap();
            }
        }
        let folder = Folder { own: own.clone(), modules: vec![first, second.clone()] };
        for (file, place) in [("a.sdf", "scene"), ("b.sdf", "first"), ("c.sdf", "second")] {
            assert_eq!(folder.read(file).as_deref(), Ok(place), "{file}");
        }
        assert_eq!(folder.file("c.sdf"), second.join("c.sdf"));
        assert_eq!(folder.file("missing.sdf"), own.join("missing.sdf"));
        // A module's folder is no way to the files beside it.
        std::fs::write(root.path().join("secret.sdf"), "outside").unwrap();
        assert!(folder.read("../secret.sdf").is_err());
    }

    #[test]
    fn an_invalid_byte_is_reported_with_its_offset() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("a.sdf");
        std::fs::write(&path, b"box\xff").unwrap();
        let Err(error) = read(&path) else { panic!("the file is not UTF-8") };
        assert!(error.to_string().contains("offset 3"), "{error}");
    }
}
