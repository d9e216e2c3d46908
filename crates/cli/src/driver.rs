//! Keeps a message of graphics drivers off the terminal.
//!
//! On a machine without a desktop session, libwayland, which Mesa's drivers load, prints
//! `error: XDG_RUNTIME_DIR is invalid or not set in the environment`, as if sdfc had failed. It
//! prints nothing if the variable is set but nothing listens there.

/// Starts the process again with the variable set, if it is not. Returns if that is not needed or
/// not possible.
#[cfg(target_os = "linux")]
pub fn silence() {
    use std::os::unix::process::CommandExt;
    use std::path::Path;

    const VARIABLE: &str = "XDG_RUNTIME_DIR";
    /// A file, so that no other user can put a socket below it.
    const NOWHERE: &str = "/dev/null";
    let is_set =
        std::env::var_os(VARIABLE).is_some_and(|it| it.as_encoded_bytes().starts_with(b"/"));
    let Some(program) = std::env::current_exe().ok().filter(|_| !is_set) else { return };
    let mut args = std::env::args_os();
    let name = args.next().unwrap_or_default();
    // A loader that was started with the path of sdfc is the program, and takes other arguments.
    if Path::new(&name).file_name() != program.file_name() {
        return;
    }
    let mut again = std::process::Command::new(program);
    again.arg0(name).args(args).env(VARIABLE, NOWHERE);
    // It replaces this process, or returns an error.
    let _ = again.exec();
}

/// Does nothing: other systems print no such message.
#[cfg(not(target_os = "linux"))]
pub fn silence() {}
