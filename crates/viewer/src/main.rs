//! `sdfc-view FILE`: shows a scene in a window.
//!
//! Exit codes: 0, the window was closed; 2, invalid command line or unreadable file; 3, no window
//! could be opened, its device was lost, or stdout cannot be written.

use std::io::{ErrorKind, Write, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use sdfc_viewer::app::WindowError;
use sdfc_viewer::examples::WELCOME;
use sdfc_viewer::settings::examples_folder;

const USAGE: &str = "usage: sdfc-view [FILE]\n\n\
    Shows the scene in FILE in a window and follows the file as it is edited.\n\
    It offers to create FILE if there is none. Without FILE it shows an example.";
const DEVICE_LOST: &str = "error: the GPU was lost while the window was drawn, as happens when a \
    driver is updated\n\
    help: open the scene again: camera, params and unsaved text are kept";
const NO_WINDOW: &str = "a window needs a display and a driver for Vulkan, Metal, DirectX 12 or \
    OpenGL; Mesa's software drivers work (on Debian: mesa-vulkan-drivers or libgl1-mesa-dri). \
    `sdfc render --backend cpu` needs neither";

#[allow(clippy::print_stderr, reason = "a program prints messages")]
fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args_os().skip(1).collect();
    let argument = match &arguments[..] {
        [] => return example(),
        [argument] => argument,
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match argument.to_str() {
        Some("-h" | "--help") => return print(USAGE),
        Some("-V" | "--version") => {
            return print(concat!("sdfc-view ", env!("CARGO_PKG_VERSION")));
        }
        Some(_) | None => {}
    }
    if argument == "-" {
        eprintln!("error: a scene on stdin cannot be watched for changes; write it to a file");
        return ExitCode::from(2);
    }
    let path = PathBuf::from(argument);
    // The window offers to create a missing scene.
    if !can_be_created(&path)
        && let Err(error) = sdfc_files::read(&path)
    {
        eprintln!("error: {error}");
        return ExitCode::from(2);
    }
    window(&path)
}

/// Writes a line to stdout. A closed pipe is not an error: the reader has seen enough.
#[allow(clippy::print_stderr, reason = "a program prints messages")]
fn print(text: &str) -> ExitCode {
    let mut out = stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            eprintln!("error: cannot write to stdout: {error}");
            ExitCode::from(3)
        }
        _ => ExitCode::SUCCESS,
    }
}

/// True if there is no such file, but the folder of a file with the ending of a scene.
fn can_be_created(path: &Path) -> bool {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let is_scene = path.extension().is_some_and(|ending| ending == "sdf");
    is_scene && !path.exists() && folder.unwrap_or(Path::new(".")).is_dir()
}

#[allow(clippy::print_stderr, reason = "a program prints messages")]
fn example() -> ExitCode {
    let Some(folder) = examples_folder() else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    match WELCOME.file_in(&folder) {
        Ok(path) => window(&path),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(3)
        }
    }
}

#[allow(clippy::print_stderr, reason = "a program prints messages")]
fn window(path: &Path) -> ExitCode {
    match sdfc_viewer::app::run(path) {
        Ok(()) => return ExitCode::SUCCESS,
        Err(WindowError::Refused(why)) => eprintln!("error: no window: {why}\nhelp: {NO_WINDOW}"),
        Err(WindowError::DeviceLost) => eprintln!("{DEVICE_LOST}"),
    }
    ExitCode::from(3)
}
