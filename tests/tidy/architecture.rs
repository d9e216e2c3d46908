//! The rules of `docs/ARCHITECTURE.md` that the compiler cannot check: which crate may depend on
//! which, and which may use files, print or know the library.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use sdfc_test_support::repository;
use serde_json::Value;

use crate::files::{files, product};

/// The crates of this workspace that each crate may depend on. A new crate needs a row.
const MAY_DEPEND_ON: [(&str, &[&str]); 19] = [
    ("diagnostics", &[]),
    ("syntax", &["diagnostics"]),
    ("graph", &[]),
    ("lang", &["diagnostics", "graph", "syntax"]),
    ("ide", &["diagnostics", "lang", "syntax"]),
    ("lsp", &["ide"]),
    ("analyze", &["graph"]),
    ("march", &[]),
    ("codegen", &["graph", "march"]),
    ("render", &["codegen", "graph", "march"]),
    ("mesh", &["graph"]),
    (
        "sdfc",
        &[
            "analyze",
            "codegen",
            "diagnostics",
            "graph",
            "lang",
            "march",
            "mesh",
            "render",
            "syntax",
        ],
    ),
    ("files", &["sdfc"]),
    ("measure", &["analyze", "codegen", "graph", "march", "render", "sdfc"]),
    ("cli", &["diagnostics", "files", "lang", "lsp", "march", "measure", "render", "sdfc"]),
    ("capi", &["sdfc"]),
    ("build", &["files", "sdfc"]),
    ("web", &["sdfc"]),
    (
        "viewer",
        &[
            "analyze",
            "codegen",
            "diagnostics",
            "files",
            "graph",
            "ide",
            "lang",
            "march",
            "measure",
            "render",
            "sdfc",
            "syntax",
        ],
    ),
];

/// Dependencies that are reserved for these crates.
const RESERVED: [(&str, &[&str]); 11] = [
    ("eframe", &["viewer"]),
    ("notify", &["viewer"]),
    ("naga", &["codegen"]),
    ("wgpu", &["render", "sdfc"]),
    ("logos", &["syntax"]),
    ("lsp-server", &["lsp"]),
    ("codespan-reporting", &["diagnostics"]),
    ("clap", &["cli"]),
    ("indicatif", &["cli"]),
    ("tempfile", &["files"]),
    ("plotters", &["measure"]),
];

/// Crates that must not contain names of the library in `std/*.sdf`.
const WITHOUT_SHAPES: [&str; 7] =
    ["syntax", "graph", "analyze", "march", "mesh", "codegen", "render"];

/// Library names that are also ray methods, and the crates that may name ray methods.
const ALSO_METHODS: ([&str; 2], [&str; 3]) =
    (["sphere", "segment"], ["march", "codegen", "render"]);

/// Library names that are also operations of the kernel.
const ALSO_KERNEL: [&str; 1] = ["round"];

fn short(package: &str) -> &str {
    package.strip_prefix("sdfc-").unwrap_or(package)
}

/// Returns (crate, dependency) for every dependency that is not only for tests or builds.
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
            let normal = list(package, "dependencies").into_iter().filter(|d| d["kind"].is_null());
            normal.map(|d| (name(package), name(&d))).collect::<Vec<_>>()
        })
        .collect()
}

/// Returns the files of a crate and their source without tests.
fn sources(krate: &str) -> Vec<(PathBuf, String)> {
    let folder = repository().join("crates").join(krate).join("src");
    let files = files(&folder, "rs").into_iter().filter(|path| !path.ends_with("tests.rs"));
    files.map(|path| (path.clone(), product(&path))).collect()
}

#[test]
fn crates_depend_only_on_what_the_architecture_allows() {
    for (from, to) in dependencies() {
        let (from, to) = (short(&from), short(&to));
        let row = MAY_DEPEND_ON.iter().find(|row| row.0 == from);
        let (_, allowed) =
            row.unwrap_or_else(|| panic!("crate {from} has no row in MAY_DEPEND_ON"));
        if MAY_DEPEND_ON.iter().any(|row| row.0 == to) {
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
        assert!(
            MAY_DEPEND_ON.iter().any(|row| row.0 == name),
            "crate {name} has no row in MAY_DEPEND_ON"
        );
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
        let (methods, crates) = ALSO_METHODS;
        let method = |krate: &str| methods.contains(&name.as_str()) && crates.contains(&krate);
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
    for (krate, _) in
        MAY_DEPEND_ON.iter().filter(|row| !["build", "cli", "viewer"].contains(&row.0))
    {
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
