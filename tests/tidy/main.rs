//! The rules of `docs/ARCHITECTURE.md` that a compiler cannot check: who may name whom, and how long a
//! file may be.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use sdfc_tests::repository;
use serde_json::Value;

/// A file that nobody can hold in mind is split before it gets here.
const MAX_LINES: usize = 800;

/// What each crate may depend on of this workspace. A new crate needs a row.
const MAY_KNOW: [(&str, &[&str]); 16] = [
    ("diagnostics", &[]),
    ("syntax", &["diagnostics"]),
    ("graph", &[]),
    ("lang", &["diagnostics", "graph", "syntax"]),
    ("analyze", &["graph"]),
    ("march", &[]),
    ("codegen", &["graph", "march"]),
    ("render", &["codegen", "graph", "march"]),
    ("accuracy", &["graph"]),
    (
        "sdfc",
        &[
            "accuracy",
            "analyze",
            "codegen",
            "diagnostics",
            "graph",
            "lang",
            "march",
            "render",
            "syntax",
        ],
    ),
    ("files", &["sdfc"]),
    ("cli", &["files", "sdfc"]),
    ("capi", &["sdfc"]),
    ("build", &["files", "sdfc"]),
    ("web", &["sdfc"]),
    ("viewer", &["files", "sdfc"]),
];

/// Dependencies that only these crates may have.
const RESERVED: [(&str, &[&str]); 10] = [
    ("eframe", &["viewer"]),
    ("notify", &["viewer"]),
    ("naga", &["codegen"]),
    ("wgpu", &["render", "sdfc"]),
    ("logos", &["syntax"]),
    ("codespan-reporting", &["diagnostics"]),
    ("clap", &["cli"]),
    ("indicatif", &["cli"]),
    ("tempfile", &["files"]),
    ("plotters", &["accuracy"]),
];

/// Crates that must not know what the library in `std/*.sdf` is called.
const WITHOUT_SHAPES: [&str; 7] =
    ["syntax", "graph", "analyze", "march", "codegen", "render", "accuracy"];

/// Library names that are also ray methods, and the crates that speak of ray methods.
const ALSO_METHODS: ([&str; 2], [&str; 3]) =
    (["sphere", "segment"], ["march", "codegen", "render"]);

/// Library names that are also operations of the kernel.
const ALSO_KERNEL: [&str; 1] = ["round"];

fn short(package: &str) -> &str {
    package.strip_prefix("sdfc-").unwrap_or(package)
}

/// (crate, dependency) for every dependency that ends up in a product. Examples stand outside.
fn dependencies() -> Vec<(String, String)> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version", "1", "--offline"])
        .current_dir(repository())
        .output()
        .unwrap();
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let list = |value: &Value, key: &str| value[key].as_array().unwrap().clone();
    let name = |value: &Value| value["name"].as_str().unwrap().to_owned();
    let crates = repository().join("crates").canonicalize().unwrap();
    let is_crate = |package: &Value| {
        Path::new(package["manifest_path"].as_str().unwrap()).starts_with(&crates)
    };
    list(&metadata, "packages")
        .iter()
        .filter(|package| is_crate(package))
        .flat_map(|package| {
            let of_product =
                list(package, "dependencies").into_iter().filter(|d| d["kind"].is_null());
            of_product.map(|d| (name(package), name(&d))).collect::<Vec<_>>()
        })
        .collect()
}

/// Every file below `folder` whose name ends in `.extension`.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            let hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes()[0] == b'.');
            let foreign = path.ends_with("target") || path.ends_with("node_modules");
            if path.is_dir() && !hidden && !foreign {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The part of a source file that is in the product: what follows `#[cfg(test)]` is tests.
fn product(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    text.split("#[cfg(test)]").next().unwrap_or_default().to_owned()
}

/// Product sources of the crate in this folder, with the file they come from.
fn sources(krate: &str) -> Vec<(PathBuf, String)> {
    let folder = repository().join("crates").join(krate).join("src");
    let found = files(&folder, "rs").into_iter().filter(|path| !path.ends_with("tests.rs"));
    found.map(|path| (path.clone(), product(&path))).collect()
}

#[test]
fn crates_know_only_what_the_architecture_allows() {
    for (from, to) in dependencies() {
        let (from, to) = (short(&from), short(&to));
        let row = MAY_KNOW.iter().find(|row| row.0 == from);
        let (_, allowed) = row.unwrap_or_else(|| panic!("crate {from} has no row in MAY_KNOW"));
        if MAY_KNOW.iter().any(|row| row.0 == to) {
            assert!(allowed.contains(&to), "{from} must not depend on {to}");
        }
        if let Some((_, owners)) = RESERVED.iter().find(|row| row.0 == to) {
            assert!(owners.contains(&from), "only {owners:?} may depend on {to}, not {from}");
        }
    }
}

#[test]
fn every_crate_has_a_row() {
    for entry in std::fs::read_dir(repository().join("crates")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(MAY_KNOW.iter().any(|row| row.0 == name), "crate {name} has no row in MAY_KNOW");
    }
}

#[test]
fn no_file_is_too_long() {
    for extension in ["rs", "wgsl", "sdf", "md"] {
        for path in files(&repository(), extension) {
            let lines = std::fs::read_to_string(&path).unwrap().lines().count();
            assert!(
                lines <= MAX_LINES,
                "{} has {lines} lines, more than {MAX_LINES}",
                path.display()
            );
        }
    }
}

#[test]
fn only_the_library_names_shapes() {
    let mut names = BTreeSet::new();
    for path in files(&repository().join("crates/lang/std"), "sdf") {
        let text = std::fs::read_to_string(&path).unwrap();
        let words = ["solid ", "region ", "shape ", "fn "];
        for line in text.lines() {
            let rest = words.iter().find_map(|word| line.strip_prefix(word));
            names.extend(rest.and_then(|rest| rest.split('(').next()).map(str::to_owned));
        }
    }
    assert!(names.contains("sphere"), "the library was not found");
    let fields_and_kernel = ["color", "roughness", "metallic", "emission", "occlusion"];
    let names = names.iter().filter(|name| {
        !ALSO_KERNEL.contains(&name.as_str()) && !fields_and_kernel.contains(&name.as_str())
    });
    for name in names {
        let quoted = format!("\"{name}\"");
        let (methods, speakers) = ALSO_METHODS;
        let method = |krate: &str| methods.contains(&name.as_str()) && speakers.contains(&krate);
        for krate in WITHOUT_SHAPES.into_iter().filter(|krate| !method(krate)) {
            for (path, text) in sources(krate) {
                assert!(!text.contains(&quoted), "{} names {quoted}", path.display());
            }
        }
    }
}

#[test]
fn only_programs_open_files_or_print() {
    let opens = ["std::fs", "File::open", "File::create"];
    let prints = ["println!", "eprintln!", "process::exit"];
    for (krate, _) in MAY_KNOW.iter().filter(|row| !["build", "cli", "viewer"].contains(&row.0)) {
        let opens = opens.iter().filter(|_| *krate != "files");
        let forbidden: Vec<&str> = opens.chain(&prints).copied().collect();
        for (path, text) in sources(krate) {
            let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
            for line in code {
                let found = forbidden.iter().find(|word| line.contains(**word));
                assert!(found.is_none(), "{} uses {found:?}", path.display());
            }
        }
    }
}
