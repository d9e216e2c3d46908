//! Tests `sdfc doc` from outside.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{folder, run, said};
use serde_json::Value;

/// Returns the status and the text on stdout.
fn doc(args: &str) -> (i32, String) {
    let output = run(&folder(&[]), &format!("doc {args}"));
    (output.status.code().unwrap(), String::from_utf8(output.stdout).unwrap())
}

#[test]
fn everything_is_listed_by_topic() {
    let (status, text) = doc("");
    assert_eq!(status, 0);
    for topic in ["SOLIDS", "REGIONS", "COMBINE", "MATHS", "SETTINGS", "TYPES"] {
        assert!(text.lines().any(|line| line == topic), "{topic} is missing from\n{text}");
    }
    assert!(text.contains("\n  sphere              A ball around the origin.\n"), "{text}");
    assert!(!text.contains('\x1b'), "no colour where no terminal is");
}

#[test]
fn an_entry_is_shown_in_full() {
    let (status, text) = doc("torus");
    let expected = "\
solid torus(major: length = 1 in 0..inf, minor: length = 0.25 in 0..inf)
  A ring around the y axis.
  The distance is exact outside, and also inside while `minor` is at most `major`.

  major  radius of the ring's centre line, in scene units
  minor  radius of its tube, in scene units; if it is above `major`, the hole closes

  contract  exact outside; exact inside if minor <= major; lipschitz 1; bounds -[major + minor,
            minor, major + minor] .. [major + minor, minor, major + minor]
  example   torus(major: 0.8, minor: 0.25)
  source    Quilez, \"3D distance functions\"
  declared  std/solids.sdf:";
    assert!(status == 0 && text.starts_with(expected), "{text}");
}

#[test]
fn all_meanings_of_a_name_are_shown() {
    let (_, text) = doc("round");
    assert!(text.contains("shape round(") && text.contains("kernel round(x)"), "{text}");
}

#[test]
fn a_topic_is_listed() {
    let (status, text) = doc("settings");
    assert!(status == 0 && text.starts_with("SETTINGS\n  camera "), "{text}");
}

#[test]
fn a_misspelt_name_gives_a_suggestion() {
    let output = run(&folder(&[]), "doc spere");
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("there is no entry `spere`; did you mean `sphere`?"));
}

#[test]
fn a_word_that_is_no_name_starts_a_search() {
    let output = run(&folder(&[]), "doc hollow");
    assert_eq!(output.status.code(), Some(0));
    assert!(
        said(&output)
            .contains("there is no entry `hollow`; that is `shell` here; these mention it:")
    );
    assert!(String::from_utf8(output.stdout).unwrap().contains("  shell "));
}

#[test]
fn colours_are_used_on_request() {
    let (_, text) = doc("sphere --color always");
    assert!(text.starts_with("\x1b[36msolid\x1b[0m \x1b[1msphere\x1b[0m(r: length"), "{text}");
}

#[test]
fn a_code_is_explained() {
    let (status, text) = doc("e0109");
    assert!(status == 0 && text.starts_with("E0109 Chained comparison or range\n"), "{text}");
    assert!(text.contains("\n  help      join two comparisons with `&&`\n"), "{text}");
}

#[test]
fn json_entries_have_all_keys() {
    let (status, text) = doc("--json");
    let rows: Value = serde_json::from_str(&text).unwrap();
    let rows = rows.as_array().unwrap();
    assert_eq!(status, 0);
    for row in rows {
        for key in ["name", "kind", "signature", "summary", "contract", "source", "example"] {
            assert!(row[key].is_string(), "{key} of {row}");
        }
        assert_eq!(row["file"].is_string(), row["line"].is_u64(), "{row}");
    }
    let sphere = rows.iter().find(|row| row["name"] == "sphere").unwrap();
    assert_eq!((&sphere["kind"], &sphere["file"]), (&"solid".into(), &"std/solids.sdf".into()));
    assert_eq!(sphere["parameters"][0]["name"], "r");
}
