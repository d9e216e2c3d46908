//! `sdfc render --watch`: draws the picture again when a file of the scene changes.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use sdfc_diagnostics::Sources;
use sdfc_files::Folder;

use crate::args::Render;
use crate::console::Console;
use crate::failure::Failure;
use crate::farm::provenance::Recorded;
use crate::interrupt::Interrupt;

/// Time between two looks at the files.
const PAUSE: Duration = Duration::from_millis(200);

/// Draws until Ctrl-C. A scene with errors is reported, and drawn again when it has changed.
///
/// # Errors
///
/// The command line is wrong, the scene is stdin or cannot be read at first, or the machine cannot
/// draw or write.
pub fn run(args: &Render, interrupt: &Interrupt, console: &Console) -> Result<(), Failure> {
    if args.file.as_os_str() == "-" {
        return Err(Failure::Call("stdin cannot be watched; name a file".to_owned()));
    }
    let mut seen = Files::of(&args.file)?;
    loop {
        match super::once(args, interrupt, console) {
            // The errors of the scene have been printed.
            Ok(()) | Err(Failure::Scene) => {}
            Err(Failure::Interrupted(_)) => return Ok(()),
            Err(failure) => return Err(failure),
        }
        loop {
            if interrupt.flow().is_break() {
                return Ok(());
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
    /// The scene and the files that it imports.
    fn of(scene: &Path) -> Result<Self, Failure> {
        let input = sdfc_files::read(scene)?;
        let folder = Folder::of(scene);
        let files = Recorded::new(&folder);
        let mut sources = Sources::new();
        let file = sources.add(input.name, input.text);
        sdfc_lang::import::visit(&mut sources, file, &files);
        let imports = files.paths().into_iter().map(|path| folder.path().join(path));
        let paths = std::iter::once(scene.to_owned()).chain(imports);
        Ok(Self(paths.map(|path| (path.clone(), state(&path))).collect()))
    }

    fn have_changed(&self) -> bool {
        self.0.iter().any(|(path, before)| state(path) != *before)
    }
}

fn state(path: &Path) -> Option<State> {
    let data = std::fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}
