//! `sdfc view`: becomes the viewer, a program of its own, so that `sdfc` is built without a user interface.

use std::path::Path;
use std::process::Command;

use crate::args::View;
use crate::failure::Failure;

/// Runs the command; where it can become the viewer, it does not come back.
///
/// # Errors
///
/// There is no viewer, or it does not start.
pub fn run(args: &View) -> Result<(), Failure> {
    let own = std::env::current_exe()
        .map_err(|e| Failure::Machine(format!("cannot tell where sdfc is: {e}")))?;
    let name = format!("sdfc-view{}", std::env::consts::EXE_SUFFIX);
    let viewer = own.with_file_name(name);
    if !viewer.is_file() {
        return Err(Failure::Machine(format!(
            "there is no viewer at {}; `cargo build --release -p sdfc-viewer` builds it there, \
             `cargo install --path crates/viewer` installs it",
            viewer.display()
        )));
    }
    let mut command = Command::new(&viewer);
    command.arg(&args.file);
    become_it(&viewer, command)
}

fn unstarted(viewer: &Path, error: &std::io::Error) -> Failure {
    Failure::Machine(format!("{} does not start: {error}", viewer.display()))
}

#[cfg(unix)]
fn become_it(viewer: &Path, mut command: Command) -> Result<(), Failure> {
    use std::os::unix::process::CommandExt;
    Err(unstarted(viewer, &command.exec()))
}

/// Waits for it; ctrl-C reaches both, since they share a console.
#[cfg(not(unix))]
fn become_it(viewer: &Path, mut command: Command) -> Result<(), Failure> {
    let status = command.status().map_err(|error| unstarted(viewer, &error))?;
    match status.code() {
        Some(0) => Ok(()),
        // It has said what is wrong.
        Some(code) => std::process::exit(code),
        None => Err(Failure::Machine("the viewer was ended".to_owned())),
    }
}
