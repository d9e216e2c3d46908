//! Scenes compiled while a Rust program is built: called from its `build.rs`, read by `include!`.
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
//! The module has `SHADER`, the text (`&[u32]` in SPIR-V); `REFLECTION`, JSON as of `sdfc compile --reflect`; `GROUP` and
//! `BINDING` of the structure of params, which is `Params`: a member for each param, `time` and `frame` that the shader
//! reads, in the layout of the uniform buffer, with the scene's defaults as its `Default`; and `LISTS`, what the
//! storage buffer of long lists holds. `Params` has no padding that is not a member, so that [`Build::bytemuck`] may derive
//! `Pod` for it; without, `to_bytes` copies.
//!
//! The program that includes it needs no part of sdfc when it runs. A build script runs again only when the
//! scene, or a file that it imports, has changed: an edit of the program's own text does not compile the scene again, as a
//! procedural macro would, at each keystroke where an editor checks the program.

mod module;

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use sdfc::{Compiled, Resolver, ShaderOptions};
use sdfc_files::Folder;

/// How scenes are compiled.
#[derive(Clone, Debug, Default)]
pub struct Build {
    options: ShaderOptions,
    bytemuck: bool,
}

/// Why a scene is not compiled, with the places in its file.
pub struct Error(String);

/// Shows as [`Display`](std::fmt::Display) does, since that is how a failing `main` shows it.
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

/// What was made of a scene.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The module's text.
    pub text: String,
    /// Warnings, a line each: `src/ball.sdf:3:7: W0601: ...`.
    pub warnings: Vec<String>,
}

impl Build {
    /// The field in WGSL.
    pub fn new() -> Self {
        Self::default()
    }

    /// Which part of the shader is written, in which language, with which names.
    pub fn options(mut self, options: ShaderOptions) -> Self {
        self.options = options;
        self
    }

    /// Whether `Params` derives `bytemuck::Pod` and `bytemuck::Zeroable`, of the program's own `bytemuck`, whose feature
    /// `derive` it needs.
    pub fn bytemuck(mut self, derive: bool) -> Self {
        self.bytemuck = derive;
        self
    }

    /// Compiles a scene to `$OUT_DIR/NAME.rs`, called as the file, and tells Cargo of all files that it was made from.
    ///
    /// # Errors
    ///
    /// What is wrong with the scene; Cargo has been told each with its place.
    pub fn scene(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let folder = std::env::var_os("OUT_DIR");
        let folder =
            folder.ok_or_else(|| Error("OUT_DIR is not set: is this a build script?".into()))?;
        let name = path.file_stem().unwrap_or_default();
        let mut read = Vec::new();
        let made = self.generate(path, &mut read);
        read.iter().for_each(|path| tell("rerun-if-changed", &path.display().to_string()));
        match made {
            Ok(Generated { text, warnings }) => {
                warnings.iter().for_each(|warning| tell("warning", warning));
                let to = PathBuf::from(folder).join(name).with_extension("rs");
                std::fs::write(&to, text)
                    .map_err(|why| Error(format!("cannot write {}: {why}", to.display())))
            }
            Err((lines, error)) => {
                lines.iter().for_each(|line| tell("error", line));
                Err(error)
            }
        }
    }

    /// The module of a scene; `read` gets the files that it was made from, also where there is none.
    ///
    /// # Errors
    ///
    /// A line for each finding, `src/ball.sdf:3:7: E0201: ...`, and all of them with the lines of the scene.
    pub fn generate(
        &self,
        path: &Path,
        read: &mut Vec<PathBuf>,
    ) -> Result<Generated, (Vec<String>, Error)> {
        read.push(path.to_owned());
        let one = |why: String| (vec![why.clone()], Error(why));
        let input = sdfc_files::read(path).map_err(|why| one(why.to_string()))?;
        let files = Noted { folder: Folder::of(path), asked: RefCell::default() };
        let compiled = sdfc::compile_with_imports(&input.name, &input.text, &files);
        let beside = path.parent().unwrap_or(Path::new(""));
        let asked = files.asked.into_inner();
        read.extend(asked.iter().map(|asked| beside.join(asked)));
        let lines = lines(&compiled, |file| match asked.contains(file) {
            true => beside.join(file).display().to_string(),
            false => file.clone(),
        });
        let scene = match compiled.into_scene() {
            Ok(scene) => scene,
            Err(errors) => return Err((lines, Error(format!("\n{errors}")))),
        };
        let failed = |why: String| one(format!("{}: {why}", input.name));
        let written = scene.write_shader(&self.options).map_err(|why| failed(why.to_string()))?;
        let reflection = scene.reflect(&self.options, &written);
        let text = module::text(&written.code, &reflection, self.bytemuck).map_err(failed)?;
        Ok(Generated { text, warnings: lines })
    }
}

/// The findings as compilers show them in one line; `path` of a file's name is where it lies.
fn lines(compiled: &Compiled, path: impl Fn(&String) -> String) -> Vec<String> {
    let rows = compiled.rows().into_iter();
    let line = rows.map(|row| {
        let help = row.help.replace('\n', "; ");
        let help = if help.is_empty() { help } else { format!(" ({help})") };
        let file = path(&row.file);
        format!("{file}:{}:{}: {}: {}{help}", row.line, row.column, row.code, row.message)
    });
    line.collect()
}

#[allow(clippy::print_stdout, reason = "that is how a build script speaks to Cargo")]
fn tell(what: &str, value: &str) {
    println!("cargo::{what}={}", value.replace('\n', " "));
}

/// The files below a folder, and which of them were asked for.
struct Noted {
    folder: Folder,
    asked: RefCell<Vec<String>>,
}

impl Resolver for Noted {
    fn read(&self, path: &str) -> Result<String, String> {
        self.asked.borrow_mut().push(path.to_owned());
        self.folder.read(path)
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        self.asked.borrow_mut().push(path.to_owned());
        self.folder.read_bytes(path)
    }
}
