//! Every scene under `examples/` compiles without a finding that its text does not name, is formatted, and draws something; the library is
//! formatted too.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sdfc::{Backend, PictureOptions, unwatched};

use sdfc_tests::example_sources;

#[test]
fn examples_are_formatted() {
    for (name, text) in example_sources().unwrap() {
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
    for (name, text) in example_sources().unwrap() {
        assert!(text.starts_with("// "), "{name} begins with no comment");
    }
}

#[test]
fn examples_compile_without_a_finding_that_they_do_not_explain_and_draw_something() {
    let options = PictureOptions { size: [32, 20], backend: Backend::Cpu, ..Default::default() };
    for (name, text) in example_sources().unwrap() {
        let compiled = sdfc::compile(&name, &text);
        let explained = compiled.diagnostics.iter().all(|found| text.contains(found.code.0));
        assert!(explained, "{}", compiled.diagnostics_text(false));
        let scene = compiled.scene.unwrap();
        let pixels = scene.render(&options, &mut unwatched).unwrap().stats.pixels;
        assert!(pixels.hit > 32 && pixels.nan == 0, "{name}: {pixels:?}");
    }
}
