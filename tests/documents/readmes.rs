//! The examples in the READMEs of the crates are those of the crates' documentation, which doctests
//! compile and run.

use sdfc_tests::repository;

/// Returns the Rust blocks of a page.
fn rust_blocks(page: &str) -> Vec<&str> {
    let blocks = page.split("```rust\n").skip(1);
    blocks.map(|rest| rest.split("\n```").next().unwrap_or_default()).collect()
}

/// Returns the documentation of a crate as a reader sees it: without the hidden lines of examples.
fn documentation(source: &str) -> String {
    let lines = source.lines().filter_map(|line| line.strip_prefix("//!"));
    let lines = lines.map(|line| line.strip_prefix(' ').unwrap_or(line));
    let shown: Vec<_> = lines.filter(|line| *line != "#" && !line.starts_with("# ")).collect();
    shown.join("\n")
}

#[test]
fn examples_of_readmes_are_those_of_the_documentation() {
    let mut checked = 0;
    for entry in std::fs::read_dir(repository().join("crates")).unwrap() {
        let folder = entry.unwrap().path();
        let read = |path: &str| std::fs::read_to_string(folder.join(path)).unwrap_or_default();
        let readme = read("README.md").replace("\r\n", "\n");
        assert!(!readme.is_empty(), "{} has no README.md", folder.display());
        let documentation = documentation(&read("src/lib.rs").replace("\r\n", "\n"));
        for block in rust_blocks(&readme) {
            checked += 1;
            assert!(
                documentation.contains(block),
                "the example of {}/README.md is not in src/lib.rs:\n{block}",
                folder.display()
            );
        }
    }
    assert!(checked > 5, "the examples were not found");
}
