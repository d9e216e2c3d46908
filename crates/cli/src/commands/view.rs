//! `sdfc view`: runs the viewer. It is a separate program, so that `sdfc` has no user interface.

use std::path::Path;
use std::process::Command;

use crate::args::View;
use crate::failure::Failure;

/// Runs the viewer. On Unix this process is replaced and the function does not return.
///
/// # Errors
///
/// The viewer is not installed, or does not start.
pub fn run(args: &View) -> Result<(), Failure> {
    let own = std::env::current_exe()
        .map_err(|e| Failure::Machine(format!("cannot find the folder of sdfc: {e}")))?;
    let name = format!("sdfc-view{}", std::env::consts::EXE_SUFFIX);
    let viewer = own.with_file_name(name);
    if !viewer.is_file() {
        return Err(Failure::Machine(format!(
            "there is no viewer at {}; build it with `cargo build --release -p sdfc-viewer`, or \
             install it with `cargo install --path crates/viewer`",
            viewer.display()
        )));
    }
    let mut command = Command::new(&viewer);
    command.arg(&args.file);
    exec(&viewer, command)
}

fn cannot_start(viewer: &Path, error: &std::io::Error) -> Failure {
    Failure::Machine(format!("cannot start {}: {error}", viewer.display()))
}

#[cfg(unix)]
fn exec(viewer: &Path, mut command: Command) -> Result<(), Failure> {
    use std::os::unix::process::CommandExt;
    Err(cannot_start(viewer, &command.exec()))
}

/// Waits for the viewer. Ctrl-C reaches both processes, since they share a console.
#[cfg(not(unix))]
fn exec(viewer: &Path, mut command: Command) -> Result<(), Failure> {
    let status = command.status().map_err(|error| cannot_start(viewer, &error))?;
    match status.code() {
        Some(0) => Ok(()),
        // The viewer has printed its error.
        Some(code) => std::process::exit(code),
        None => Err(Failure::Machine("the viewer was terminated".to_owned())),
    }
}
