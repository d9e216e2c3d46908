//! Opens a position of a file in the user's editor.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

/// Editors that take an argument `file:line:column`.
const WITH_COLUMN: [&str; 3] = ["subl", "zed", "kate"];
/// Editors that take the same after `--goto`.
const WITH_GOTO: [&str; 4] = ["code", "codium", "cursor", "windsurf"];
/// Editors that need a terminal, which the viewer does not have.
const IN_TERMINAL: [&str; 9] = ["vi", "vim", "nvim", "nano", "hx", "helix", "kak", "micro", "ed"];

/// The user's editor: `$VISUAL`, else `$EDITOR`.
pub fn from_environment() -> Option<String> {
    let set = |name| std::env::var(name).ok().filter(|value| !value.trim().is_empty());
    set("VISUAL").or_else(|| set("EDITOR"))
}

/// Opens a file at a line and column.
///
/// # Errors
///
/// The editor does not start. The message is one line.
pub fn open(editor: &str, path: &Path, position: [u32; 2]) -> Result<(), String> {
    let mut words = editor.split_whitespace();
    let program = words.next().unwrap_or_default();
    let name = Path::new(program).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    if IN_TERMINAL.contains(&name.as_str()) {
        return Err(format!("{name} needs a terminal; set $VISUAL to an editor with a window"));
    }
    let mut command = Command::new(program);
    command.args(words).args(arguments(&name, path, position));
    command.stdin(Stdio::null());
    let mut child =
        command.spawn().map_err(|error| format!("{program} does not start: {error}"))?;
    // Waiting for the process removes it from the process table when it ends.
    std::thread::spawn(move || child.wait());
    Ok(())
}

fn arguments(name: &str, path: &Path, [line, column]: [u32; 2]) -> Vec<OsString> {
    let mut position = path.as_os_str().to_owned();
    position.push(format!(":{line}:{column}"));
    if WITH_GOTO.contains(&name) {
        vec!["--goto".into(), position]
    } else if WITH_COLUMN.contains(&name) {
        vec![position]
    } else {
        vec![format!("+{line}").into(), path.into()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_editor_gets_the_line_in_its_own_syntax() {
        let arguments_of = |name| arguments(name, Path::new("a b.sdf"), [3, 7]);
        assert_eq!(arguments_of("code"), ["--goto", "a b.sdf:3:7"]);
        assert_eq!(arguments_of("subl"), ["a b.sdf:3:7"]);
        assert_eq!(arguments_of("gvim"), ["+3", "a b.sdf"]);
        assert!(open("/usr/bin/vim", Path::new("a"), [1, 1]).is_err());
    }
}
