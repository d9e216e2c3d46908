//! Every scene under `examples/` compiles without a finding that its text does not name, is formatted, and draws something; the library is
//! formatted too.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};

use sdfc::{Backend, PictureOptions, unwatched};

fn scenes(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(scenes(&path));
        } else if path.extension().is_some_and(|e| e == "sdf") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// (name, text) of each scene.
fn texts() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).unwrap().replace("\r\n", "\n");
        (path.strip_prefix(&folder).unwrap().display().to_string(), text)
    };
    let texts: Vec<_> = scenes(&folder).into_iter().map(read).collect();
    assert!(texts.len() > 12, "the examples were not found");
    texts
}

#[test]
fn examples_are_formatted() {
    for (name, text) in texts() {
        let formatted = sdfc::format(&name, &text, false);
        assert!(formatted.as_deref() == Ok(&text), "{name}: run `sdfc fmt`");
    }
}

#[test]
fn the_library_is_formatted() {
    for (name, text) in sdfc::lang::library::FILES {
        let text = text.replace("\r\n", "\n");
        let formatted = sdfc::format(name, &text, false);
        assert!(formatted.as_deref() == Ok(&*text), "{name}: run `sdfc fmt crates/lang/std/*.sdf`");
    }
}

#[test]
fn examples_say_what_they_show() {
    for (name, text) in texts() {
        assert!(text.starts_with("// "), "{name} begins with no comment");
    }
}

#[test]
fn examples_compile_without_a_finding_that_they_do_not_explain_and_draw_something() {
    let options = PictureOptions { size: [32, 20], backend: Backend::Cpu, ..Default::default() };
    for (name, text) in texts() {
        let compiled = sdfc::compile(&name, &text);
        let explained = compiled.diagnostics.iter().all(|found| text.contains(found.code.0));
        assert!(explained, "{}", compiled.diagnostics_text(false));
        let scene = compiled.scene.unwrap();
        let pixels = scene.render(&options, &mut unwatched).unwrap().stats.pixels;
        assert!(pixels.hit > 32 && pixels.nan == 0, "{name}: {pixels:?}");
    }
}
