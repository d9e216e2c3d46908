//! Every scene under `examples/` is formatted, compiles with no diagnostic that its comments do not
//! name, and draws something. The library is formatted too.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sdfc::{Backend, Compiler, PictureOptions, no_progress};

use sdfc_tests::example_sources;

#[test]
fn examples_are_formatted() {
    for (name, text) in example_sources().unwrap() {
        let formatted = sdfc::format(&name, &text).map_err(|errors| errors.to_string());
        assert!(formatted.as_deref() == Ok(&text), "{name}: run `sdfc fmt`");
    }
}

#[test]
fn the_library_is_formatted() {
    for (name, text) in sdfc_lang::library::FILES.iter().chain([&sdfc_lang::library::LOOK]) {
        let text = text.replace("\r\n", "\n");
        let formatted = sdfc::format(name, &text).map_err(|errors| errors.to_string());
        assert!(formatted.as_deref() == Ok(&*text), "{name}: run `sdfc fmt crates/lang/std/*.sdf`");
    }
}

#[test]
fn examples_begin_with_a_comment() {
    for (name, text) in example_sources().unwrap() {
        assert!(text.starts_with("// "), "{name} begins with no comment");
    }
}

#[test]
fn examples_draw_something_and_explain_their_diagnostics() {
    let options = PictureOptions::new().size([32, 20]).backend(Backend::Cpu);
    for (name, text) in example_sources().unwrap() {
        let scene = Compiler::new().compile(&name, &text).unwrap();
        let warnings = scene.diagnostics();
        assert!(warnings.iter().all(|it| text.contains(it.code.0)), "{warnings}");
        let pixels = scene.render(&options, &mut no_progress).unwrap().stats.pixels;
        assert!(pixels.hit > 32 && pixels.nan == 0, "{name}: {pixels:?}");
    }
}
