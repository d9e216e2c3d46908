//! The modules of a crate do not depend on each other in cycles.

use std::collections::BTreeMap;

use sdfc_test_support::repository;

use crate::cycles::{ModulePath, cycles};
use crate::files::files;
use crate::report;

/// Returns the sources of the modules of a crate. A program beside a library is no part of it.
fn modules(krate: &str) -> BTreeMap<ModulePath, String> {
    let folder = repository().join("crates").join(krate).join("src");
    let has_library = folder.join("lib.rs").exists();
    let mut modules = BTreeMap::new();
    for path in files(&folder, "rs") {
        let below = path.strip_prefix(&folder).unwrap().with_extension("");
        let names = below.components().map(|name| name.as_os_str().to_str().unwrap().to_owned());
        let mut names: Vec<String> = names.collect();
        let file = names.last().cloned().unwrap_or_default();
        let is_program = names[0] == "bin" || (has_library && names == ["main"]);
        if is_program || file == "tests" {
            continue;
        }
        if file == "mod" || names == ["lib"] || names == ["main"] {
            names.pop();
        }
        modules.insert(names, std::fs::read_to_string(&path).unwrap());
    }
    modules
}

#[test]
fn modules_have_no_cycles() {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(repository().join("crates")).unwrap() {
        let krate = entry.unwrap().file_name().into_string().unwrap();
        let modules = modules(&krate);
        for group in cycles(&modules) {
            let name = |path: ModulePath| {
                if path.is_empty() { "the root".to_owned() } else { path.join("::") }
            };
            let names: Vec<String> = group.into_iter().map(name).collect();
            found.push((format!("crates/{krate}/src"), names.join(", ")));
        }
    }
    report(&found);
}
