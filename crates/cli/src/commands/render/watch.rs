//! `sdfc render --watch`: draws the picture again when a file of the scene changes.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use sdfc::{Compiler, Resolver};
use sdfc_files::Folder;

use crate::args::Render;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupt;

/// Time between two looks at the files.
const PAUSE: Duration = Duration::from_millis(200);

/// Draws until Ctrl-C. A scene with errors is reported, and drawn again when it has changed. So is
/// a scene that the command line no longer fits.
///
/// # Errors
///
/// The command line is wrong, the scene is stdin or cannot be read at first, the machine cannot
/// draw or write, or Ctrl-C was pressed.
pub fn run(args: &Render, console: &Console) -> Result<(), Failure> {
    if args.file.as_os_str() == "-" {
        return Err(Failure::Call("stdin cannot be watched; name a file".to_owned()));
    }
    let interrupt = Interrupt::watch("stopped", console);
    let mut seen = Files::of(&args.file)?;
    let mut has_drawn = false;
    loop {
        match super::once(args, &interrupt, console) {
            Ok(()) => has_drawn = true,
            // The errors of the scene have been printed.
            Err(Failure::Scene) => {}
            // The command line was right before, so the scene has changed.
            Err(failure @ Failure::Call(_)) if has_drawn => console.failure(&failure),
            Err(failure) => return Err(failure),
        }
        loop {
            if interrupt.flow().is_break() {
                return Err(interrupt.failure());
            }
            std::thread::sleep(PAUSE);
            // While an editor replaces a file, it may be missing for a moment.
            if seen.have_changed()
                && let Ok(now) = Files::of(&args.file)
            {
                seen = now;
                break;
            }
        }
    }
}

/// The files of a scene, each with its state when it was last read.
struct Files(Vec<(PathBuf, Option<State>)>);

/// Time of the last change, and size in bytes.
type State = (SystemTime, u64);

impl Files {
    /// The scene, and the imports and fonts that it names, also those that cannot be read.
    fn of(scene: &Path) -> Result<Self, Failure> {
        let input = sdfc_files::read(scene)?;
        let noted = Noted { folder: Folder::of(scene), paths: RefCell::default() };
        // Drawing prints the diagnostics.
        drop(Compiler::new().resolver(&noted).check(&input.name, &input.text));
        let Noted { folder, paths } = noted;
        let others = paths.into_inner().into_iter().map(|path| folder.file(&path));
        let paths = std::iter::once(scene.to_owned()).chain(others);
        Ok(Self(paths.map(|path| (path.clone(), state(&path))).collect()))
    }

    fn have_changed(&self) -> bool {
        self.0.iter().any(|(path, before)| state(path) != *before)
    }
}

/// Reads the files that a scene names, and notes the path of each before that.
struct Noted {
    folder: Folder,
    paths: RefCell<BTreeSet<String>>,
}

impl Noted {
    fn note(&self, path: &str) {
        self.paths.borrow_mut().insert(path.to_owned());
    }
}

impl Resolver for Noted {
    fn read(&self, path: &str) -> Result<String, String> {
        self.note(path);
        self.folder.read(path)
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        self.note(path);
        self.folder.read_bytes(path)
    }
}

fn state(path: &Path) -> Option<State> {
    let data = std::fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}
