//! Compiles scenes in the build script of a Rust program, which reads the result with `include!`.
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), sdfc_build::Error> {
//!     sdfc_build::Build::new().scene("src/ball.sdf")
//! }
//! ```
//!
//! ```ignore
//! // src/main.rs
//! mod ball {
//!     include!(concat!(env!("OUT_DIR"), "/ball.rs"));
//! }
//! ```
//!
//! The module has these items:
//!
//! - `SHADER`: the source (`&[u32]` for SPIR-V).
//! - `REFLECTION`: JSON as `sdfc compile --reflect` writes it.
//! - `Params`: a structure with a member for each param, `time` and `frame` that the shader reads.
//!   It has the layout of the uniform buffer, and the scene's defaults are its `Default`. All
//!   padding is made of members, so that [`Build::bytemuck`] can derive `Pod` for it; without that,
//!   `to_bytes` copies the members.
//! - `GROUP` and `BINDING` of that uniform buffer.
//! - `LISTS`: the contents of the storage buffer for long lists.
//!
//! The program that includes the module needs no part of sdfc at run time. The build script runs
//! again only when the scene or a file that it imports has changed. A procedural macro would
//! compile the scene again after every edit of the program, in editors at every keystroke.

mod module;

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use sdfc::{Compiler, Diagnostics, Resolver, ShaderOptions};
use sdfc_files::Folder;

/// The options for compiling scenes.
#[derive(Clone, Debug, Default)]
pub struct Build {
    options: ShaderOptions,
    bytemuck: bool,
}

/// The reason why a scene was not compiled, with positions in its source.
pub struct Error(String);

/// The same as [`Display`](std::fmt::Display), because a failing `main` prints this one.
impl std::fmt::Debug for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Error {}

/// The result of compiling a scene.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The source of the module.
    pub text: String,
    /// The warnings, one line each: `src/ball.sdf:3:7: W0601: ...`.
    pub warnings: Vec<String>,
}

impl Build {
    /// Creates the default options: the field in WGSL.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the part of the shader that is written, its language and its names.
    pub fn options(mut self, options: ShaderOptions) -> Self {
        self.options = options;
        self
    }

    /// Sets if `Params` derives `bytemuck::Pod` and `bytemuck::Zeroable`. The program must depend
    /// on `bytemuck` with its feature `derive`.
    pub fn bytemuck(mut self, derive: bool) -> Self {
        self.bytemuck = derive;
        self
    }

    /// Compiles a scene to `$OUT_DIR/NAME.rs`, where `NAME` is the name of its file. Cargo will run
    /// the build script again when the scene or one of its imports changes.
    ///
    /// # Errors
    ///
    /// The scene has errors, or a file cannot be read or written. Each error is also printed for
    /// Cargo with its position.
    pub fn scene(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let folder = std::env::var_os("OUT_DIR");
        let folder = folder
            .ok_or_else(|| Error("OUT_DIR is not set; call this from a build script".into()))?;
        let name = path.file_stem().unwrap_or_default();
        let mut read = Vec::new();
        let generated = self.generate(path, &mut read);
        read.iter()
            .for_each(|path| instruct_cargo("rerun-if-changed", &path.display().to_string()));
        match generated {
            Ok(Generated { text, warnings }) => {
                warnings.iter().for_each(|warning| instruct_cargo("warning", warning));
                let to = PathBuf::from(folder).join(name).with_extension("rs");
                std::fs::write(&to, text)
                    .map_err(|why| Error(format!("cannot write {}: {why}", to.display())))
            }
            Err((lines, error)) => {
                lines.iter().for_each(|line| instruct_cargo("error", line));
                Err(error)
            }
        }
    }

    /// Compiles a scene and returns its module. Appends the files that were read to `read`, also on
    /// errors.
    ///
    /// # Errors
    ///
    /// Returns one line for each diagnostic, such as `src/ball.sdf:3:7: E0201: ...`, and an error
    /// that shows all of them with source lines.
    pub fn generate(
        &self,
        path: &Path,
        read: &mut Vec<PathBuf>,
    ) -> Result<Generated, (Vec<String>, Error)> {
        read.push(path.to_owned());
        let one = |why: String| (vec![why.clone()], Error(why));
        let input = sdfc_files::read(path).map_err(|why| one(why.to_string()))?;
        let files = RecordingFolder { folder: Folder::of(path), requested: RefCell::default() };
        let compiled = Compiler::new().resolver(&files).compile(&input.name, &input.text);
        let RecordingFolder { folder, requested } = files;
        let requested = requested.into_inner();
        read.extend(requested.iter().map(|path| folder.file(path)));
        let path = |file: &String| match requested.contains(file) {
            true => folder.file(file).display().to_string(),
            false => file.clone(),
        };
        let scene = match compiled {
            Ok(scene) => scene,
            Err(errors) => return Err((lines(&errors, path), Error(format!("\n{errors}")))),
        };
        let warnings = lines(scene.diagnostics(), path);
        let failed = |why: String| one(format!("{}: {why}", input.name));
        let written = scene.write_shader(&self.options).map_err(|why| failed(why.to_string()))?;
        let reflection = scene.reflect(&self.options, &written);
        let text = module::text(&written.code, &reflection, self.bytemuck).map_err(failed)?;
        Ok(Generated { text, warnings })
    }
}

/// Formats each diagnostic as one line. `path` returns the path of a file with a given name.
fn lines(diagnostics: &Diagnostics, path: impl Fn(&String) -> String) -> Vec<String> {
    let rows = diagnostics.rows().into_iter();
    let line = rows.map(|row| {
        let help = row.help.replace('\n', "; ");
        let help = if help.is_empty() { help } else { format!(" ({help})") };
        let file = path(&row.file);
        format!("{file}:{}:{}: {}: {}{help}", row.line, row.column, row.code, row.message)
    });
    line.collect()
}

#[allow(clippy::print_stdout, reason = "build scripts instruct Cargo on stdout")]
fn instruct_cargo(instruction: &str, value: &str) {
    println!("cargo::{instruction}={}", value.replace('\n', " "));
}

/// A resolver for the files below a folder that records the requested paths.
struct RecordingFolder {
    folder: Folder,
    requested: RefCell<Vec<String>>,
}

impl Resolver for RecordingFolder {
    fn read(&self, path: &str) -> Result<String, String> {
        self.requested.borrow_mut().push(path.to_owned());
        self.folder.read(path)
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        self.requested.borrow_mut().push(path.to_owned());
        self.folder.read_bytes(path)
    }
}
