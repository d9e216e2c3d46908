//! Tests what an archive installs beside the programs: completions and manual pages.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{folder, names, run, said};

/// The commands that the help lists.
fn commands() -> Vec<String> {
    let help = String::from_utf8(run(&folder(&[]), "--help").stdout).unwrap();
    let (_, list) = help.split_once("Commands:\n").unwrap();
    let (list, _) = list.split_once("\n\n").unwrap();
    let name = |line: &str| line.split_whitespace().next().unwrap_or_default().to_owned();
    // The second line of a long description is indented more.
    let starts = |line: &&str| line.starts_with("  ") && !line.starts_with("   ");
    list.lines().filter(starts).map(name).filter(|name| name != "help").collect()
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = folder(&[]);
    let output = run(&folder, "manual .");
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let mut expected: Vec<String> =
        commands().iter().map(|name| format!("sdfc-{name}.1")).collect();
    assert!(expected.len() > 10, "{expected:?}");
    expected.push("sdfc.1".to_owned());
    expected.sort();
    assert_eq!(names(folder.path()), expected);
    let page = std::fs::read_to_string(folder.path().join("sdfc-render.1")).unwrap();
    assert!(page.contains("\\-\\-region"), "{page}");
    let output = run(&folder, "manual missing");
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
}

#[test]
fn shells_complete_every_command() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let output = run(&folder(&[]), &format!("completions {shell}"));
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        let script = String::from_utf8(output.stdout).unwrap();
        for name in commands() {
            assert!(script.contains(&name), "{shell}: {name}");
        }
    }
}
