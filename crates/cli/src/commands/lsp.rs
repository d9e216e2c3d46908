//! `sdfc lsp`: serves editors over stdin and stdout.

mod preview;

use std::ops::Range;
use std::path::{Path, PathBuf};

use sdfc::{Backend, PictureOptions, no_progress};
use sdfc_lsp::{Compile, Compiled, Connection, Disk, Resolver, ShapeFacts, serve};

use crate::cache::user_folder;
use crate::failure::Failure;

use preview::Drawer;

/// Folders below a scene's folder are searched down to this depth.
const MAX_DEPTH: usize = 4;
/// At most this many entries of folders are looked at.
const MAX_ENTRIES: usize = 4096;
/// At most this many scenes are found.
const MAX_SCENES: usize = 256;
/// Width and height of the pictures of library entries in pixels.
const EXAMPLE_SIZE: [u32; 2] = [160, 120];

/// Answers an editor until it asks to end.
///
/// # Errors
///
/// The editor does not keep to the protocol, or stdin or stdout fails.
pub fn run() -> Result<(), Failure> {
    let (connection, threads) = Connection::stdio();
    let files = Files { library: write_library() };
    let served = serve(&connection, &files, &Compiler, &Drawer);
    drop(connection);
    let joined = threads.join().map_err(|e| Failure::Machine(format!("stdin or stdout: {e}")));
    served.map_err(|why| Failure::Machine(format!("the editor's connection: {why}")))?;
    joined
}

/// The files of this machine.
struct Files {
    library: Option<PathBuf>,
}

impl Disk for Files {
    fn read(&self, path: &Path) -> Result<String, String> {
        let input = sdfc_files::read(path).map_err(|e| e.to_string())?;
        Ok(input.text)
    }

    fn read_bytes(&self, path: &Path) -> Result<Vec<u8>, String> {
        sdfc_files::read_bytes(path).map_err(|e| e.to_string())
    }

    fn file(&self, folder: &Path, path: &str) -> PathBuf {
        sdfc_files::Folder::new(folder.to_owned()).file(path)
    }

    fn scenes(&self, folder: &Path) -> Vec<PathBuf> {
        let (mut scenes, mut looked_at) = (Vec::new(), 0);
        let mut open = vec![(folder.to_owned(), 0)];
        while let Some((folder, depth)) = open.pop() {
            for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
                looked_at += 1;
                if looked_at > MAX_ENTRIES || scenes.len() >= MAX_SCENES {
                    return scenes;
                }
                let (path, hidden) =
                    (entry.path(), entry.file_name().to_string_lossy().starts_with('.'));
                let kind = entry.file_type();
                if kind.as_ref().is_ok_and(std::fs::FileType::is_dir) {
                    if depth < MAX_DEPTH && !hidden {
                        open.push((path, depth + 1));
                    }
                } else if is_scene(&path) {
                    scenes.push(path);
                }
            }
        }
        scenes
    }

    fn scenes_in(&self, folder: &Path) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().take(MAX_ENTRIES);
        let paths = entries.map(|entry| entry.path());
        paths.filter(|path| is_scene(path)).take(MAX_SCENES).collect()
    }

    fn library(&self) -> Option<PathBuf> {
        self.library.clone()
    }
}

fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "sdf")
}

/// The compiler of this program.
struct Compiler;

impl Compile for Compiler {
    fn compile(
        &self,
        name: &str,
        text: &str,
        resolver: &dyn Resolver,
    ) -> Option<Box<dyn Compiled>> {
        let scene = sdfc::Compiler::new().resolver(resolver).compile(name, text).ok()?;
        Some(Box::new(CompiledScene(scene)))
    }

    fn picture(&self, name: &str, text: &str) -> Option<Vec<u8>> {
        let scene = sdfc::Compiler::new().compile(name, text).ok()?;
        let options = PictureOptions::new().size(EXAMPLE_SIZE).backend(Backend::Cpu);
        let picture = scene.render(&options.samples(4), &mut no_progress).ok()?;
        picture.image.to_png().ok()
    }
}

/// A compiled scene.
struct CompiledScene(sdfc::Scene);

impl Compiled for CompiledScene {
    fn facts(&self, call: Range<usize>) -> Option<ShapeFacts> {
        let facts = self.0.shape_facts(call)?;
        Some(ShapeFacts { cost: facts.cost(), quality: facts.quality })
    }

    fn uncertified(&self) -> Vec<(Range<usize>, String)> {
        self.0.uncertified_calls()
    }
}

/// Writes the library's files to the user's cache folder, so that editors can show them.
fn write_library() -> Option<PathBuf> {
    let name = concat!("library-", env!("CARGO_PKG_VERSION"));
    let folder = user_folder(name, |variable| std::env::var_os(variable))?;
    for (name, text) in sdfc_lang::library::FILES {
        let path = folder.join(name);
        if std::fs::read_to_string(&path).is_ok_and(|known| known == *text) {
            continue;
        }
        std::fs::create_dir_all(path.parent()?).ok()?;
        sdfc_files::write(&path, text.as_bytes()).ok()?;
    }
    Some(folder)
}
