//! Opens a place of a file in the user's editor.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

/// Editors that take `file:line:column`.
const WITH_COLUMN: [&str; 3] = ["subl", "zed", "kate"];
/// The same behind `--goto`.
const WITH_GOTO: [&str; 4] = ["code", "codium", "cursor", "windsurf"];
/// Editors that need a terminal, which a window has not.
const IN_TERMINAL: [&str; 9] = ["vi", "vim", "nvim", "nano", "hx", "helix", "kak", "micro", "ed"];

/// The user's editor: `$VISUAL`, else `$EDITOR`.
pub fn chosen() -> Option<String> {
    let set = |name| std::env::var(name).ok().filter(|value| !value.trim().is_empty());
    set("VISUAL").or_else(|| set("EDITOR"))
}

/// Opens a file at a line and column.
///
/// # Errors
///
/// Why it did not start, in one line.
pub fn open(editor: &str, path: &Path, place: [u32; 2]) -> Result<(), String> {
    let mut words = editor.split_whitespace();
    let program = words.next().unwrap_or_default();
    let name = Path::new(program).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    if IN_TERMINAL.contains(&name.as_str()) {
        return Err(format!("{name} needs a terminal; $VISUAL may be another with a window"));
    }
    let mut command = Command::new(program);
    command.args(words).args(arguments(&name, path, place));
    command.stdin(Stdio::null());
    let mut child =
        command.spawn().map_err(|error| format!("{program} does not start: {error}"))?;
    // Waited for, so that it leaves no trace in the table of processes when it ends.
    std::thread::spawn(move || child.wait());
    Ok(())
}

fn arguments(name: &str, path: &Path, [line, column]: [u32; 2]) -> Vec<OsString> {
    let mut place = path.as_os_str().to_owned();
    place.push(format!(":{line}:{column}"));
    if WITH_GOTO.contains(&name) {
        vec!["--goto".into(), place]
    } else if WITH_COLUMN.contains(&name) {
        vec![place]
    } else {
        vec![format!("+{line}").into(), path.into()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_editor_has_its_own_way_to_be_told_a_line() {
        let told = |name| arguments(name, Path::new("a b.sdf"), [3, 7]);
        assert_eq!(told("code"), ["--goto", "a b.sdf:3:7"]);
        assert_eq!(told("subl"), ["a b.sdf:3:7"]);
        assert_eq!(told("gvim"), ["+3", "a b.sdf"]);
        assert!(open("/usr/bin/vim", Path::new("a"), [1, 1]).is_err());
    }
}
