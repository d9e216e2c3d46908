//! `sdfc-view FILE`: a window on a scene.
//!
//! Exit statuses as those of `sdfc`: 0, the window was closed; 2, the call is wrong; 3, there is no window to
//! be had.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use sdfc_viewer::app::NoWindow;
use sdfc_viewer::examples::EXAMPLES;
use sdfc_viewer::memory::examples_folder;

const USAGE: &str = "usage: sdfc-view [FILE]\n\n\
    Shows the scene in FILE in a window and follows its text as it is edited; without FILE, an example.";
const LOST: &str = "error: the window's device was lost while it was drawn, as all are when a driver is renewed\n\
    help: open the scene again: camera and params are kept";
const NO_WINDOW: &str = "a window needs a display and a driver for Vulkan, Metal, DirectX 12 or OpenGL (Mesa's software \
    drivers do: Debian's mesa-vulkan-drivers or libgl1-mesa-dri); `sdfc render --backend cpu` needs neither";
/// The example that is shown where no file is named: it has something to drag.
const FIRST: &str = "params";

#[allow(clippy::print_stdout, clippy::print_stderr, reason = "a program says what it has to say")]
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
        Some("-h" | "--help") => {
            println!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        Some("-V" | "--version") => {
            println!("sdfc-view {}", env!("CARGO_PKG_VERSION"));
            return ExitCode::SUCCESS;
        }
        Some(_) | None => {}
    }
    if argument == "-" {
        eprintln!("error: a scene from stdin cannot be followed; write it to a file");
        return ExitCode::from(2);
    }
    let path = PathBuf::from(argument);
    // Asked before the window opens: afterwards a file may come and go.
    if let Err(error) = sdfc_files::read(&path) {
        eprintln!("error: {error}");
        return ExitCode::from(2);
    }
    window(&path)
}

#[allow(clippy::print_stderr, reason = "a program says what it has to say")]
fn example() -> ExitCode {
    let first = EXAMPLES.iter().find(|example| example.name == FIRST);
    let Some((example, folder)) = first.zip(examples_folder()) else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    match example.file_in(&folder) {
        Ok(path) => window(&path),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(3)
        }
    }
}

#[allow(clippy::print_stderr, reason = "a program says what it has to say")]
fn window(path: &Path) -> ExitCode {
    match sdfc_viewer::app::run(path) {
        Ok(()) => return ExitCode::SUCCESS,
        Err(NoWindow::Refused(why)) => eprintln!("error: no window: {why}\nhelp: {NO_WINDOW}"),
        Err(NoWindow::Lost) => eprintln!("{LOST}"),
    }
    ExitCode::from(3)
}
