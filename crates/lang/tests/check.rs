//! The checker on the library and on whole scenes.
#![allow(missing_docs)]

mod common;

use common::Library;
use sdfc_diagnostics::render;

#[test]
fn every_library_entry_checks_in_both_dimensions() {
    let library = Library::new();
    let (program, found) = library.check_all();
    assert!(found.is_empty(), "{}", render(&library.sources, &found, false));
    assert!(program.shapes.len() > 20);
}

#[test]
fn a_scene_reaches_only_what_it_needs() {
    let (program, found, _) = Library::new().check("sphere(1)\n");
    assert!(found.is_empty());
    let names: Vec<&str> = program.shapes.iter().map(|shape| shape.name.as_str()).collect();
    assert_eq!(names, ["union", "sphere"]);
}
