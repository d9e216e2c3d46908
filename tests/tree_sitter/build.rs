//! Compiles the generated parser.
#![allow(missing_docs, reason = "a build script")]

fn main() {
    let folder = "../../editors/tree-sitter-sdf/src";
    let mut build = cc::Build::new();
    build.include(folder).std("c11").warnings(false);
    for file in ["parser.c", "scanner.c"] {
        let path = format!("{folder}/{file}");
        println!("cargo::rerun-if-changed={path}");
        build.file(path);
    }
    build.compile("tree-sitter-sdf");
}
