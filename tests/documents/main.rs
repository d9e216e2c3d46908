//! The documentation is correct: code blocks compile or have the diagnostic code that they name,
//! values in tables are right, pictures are current, links lead to files that exist, and the
//! examples in READMEs are those of the crates' documentation.
//!
//! - A block that begins with ```` ```sdf ```` is a scene, or the declarations of one.
//! - ```` ```sdf E0304 ```` is a scene with that code and no other.
//! - A row of a table with the head `| expression | gives |` has two expressions of equal value.
//! - In the tutorial, the gallery and the cookbook, a picture right behind a block shows the scene
//!   of that block.
//! - The scenes beside the gallery's pictures compile, and the pictures show them.
//!
//! The pages of `docs/reference` and `docs/errors` have tests of their own.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

mod charts;
mod gallery;
mod pictures;
mod readmes;

use std::path::PathBuf;

use sdfc::Compiler;
use sdfc_tests::{is_same_picture, repository};

/// The largest difference of two values that count as equal.
const ROUNDING: f64 = 1e-6;

/// Returns the name and the text of every page.
fn pages() -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut folders = vec![repository().join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                found.push(path);
            }
        }
    }
    for page in ["CONTRIBUTING.md", "README.md", "SECURITY.md"] {
        found.push(repository().join(page));
    }
    for entry in std::fs::read_dir(repository().join("crates")).unwrap() {
        found.push(entry.unwrap().path().join("README.md"));
    }
    found.sort();
    let page = |path: PathBuf| {
        let name = path.strip_prefix(repository()).unwrap().display().to_string();
        (name.replace('\\', "/"), std::fs::read_to_string(path).unwrap().replace("\r\n", "\n"))
    };
    found.into_iter().map(page).collect()
}

/// Returns the pages whose blocks are checked here.
fn checked_pages() -> Vec<(String, String)> {
    let elsewhere = ["docs/reference/", "docs/errors/"];
    let is_here = |page: &(String, String)| !elsewhere.iter().any(|it| page.0.starts_with(it));
    pages().into_iter().filter(is_here).collect()
}

/// Returns the `sdf` blocks of a page: line, the rest of the line behind ```` ```sdf ````, text.
fn blocks(page: &str) -> Vec<(usize, String, String)> {
    let mut found = Vec::new();
    let mut open: Option<(usize, String, String)> = None;
    for (number, line) in page.lines().enumerate() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(info)) => open = Some((number + 1, info.trim().to_owned(), String::new())),
            (Some(_), Some(_)) => found.extend(open.take()),
            (Some((_, _, text)), None) => {
                text.push_str(line);
                text.push('\n');
            }
            (None, None) => {}
        }
    }
    let sdf_block = |(line, info, text): (usize, String, String)| {
        let rest = info.strip_prefix("sdf")?;
        Some((line, rest.trim().to_owned(), text))
    };
    found.into_iter().filter_map(sdf_block).collect()
}

/// Returns the rows of the tables of expressions: line, expression, value.
fn values(page: &str) -> Vec<(usize, String, String)> {
    let mut found = Vec::new();
    let mut inside = false;
    for (number, line) in page.lines().enumerate() {
        inside = line == "| expression | gives |" || (inside && line.starts_with('|'));
        let cells: Vec<&str> = line.split('`').collect();
        if inside && cells.len() == 5 {
            let unescaped = |cell: &str| cell.replace("\\|", "|");
            found.push((number + 1, unescaped(cells[1]), unescaped(cells[3])));
        }
    }
    found
}

#[test]
fn every_block_compiles_or_has_the_code_that_it_names() {
    let mut wrong = Vec::new();
    let mut count = 0;
    for (page, text) in checked_pages() {
        for (line, expected, block) in blocks(&text) {
            count += 1;
            let found = Compiler::new().verify(true).check(&page, &block);
            let codes: Vec<&str> = found.iter().map(|it| it.code.0).collect();
            // A block may have declarations only, which draw nothing.
            let fits = match &*expected {
                "" => codes.iter().all(|code| *code == "W0604"),
                code => !codes.is_empty() && codes.iter().all(|it| *it == code),
            };
            if !fits {
                wrong.push(format!("{page}:{line}\n{found}"));
            }
        }
    }
    assert!(count > 15, "the blocks were not found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn formatting_the_formatted_blocks_changes_nothing() {
    let mut count = 0;
    for (page, text) in pages() {
        for (line, _, block) in blocks(&text) {
            let Ok(once) = sdfc::format(&page, &block) else { continue };
            count += 1;
            let twice = sdfc::format(&page, &once).map_err(|errors| errors.to_string());
            assert_eq!(twice.as_ref(), Ok(&once), "{page}:{line}");
        }
    }
    assert!(count > 100, "the blocks were not found");
}

#[test]
fn every_expression_gives_what_is_said() {
    let mut wrong = Vec::new();
    let mut count = 0;
    for (page, text) in checked_pages() {
        for (line, expression, value) in values(&text) {
            count += 1;
            // The field at the origin is how far the two are apart.
            let apart = match &*value {
                "true" | "false" => format!("if ({expression}) == {value} {{ 0 }} else {{ 1 }}"),
                _ => format!("distance({expression}, {value})"),
            };
            let scene = format!("let apart = {apart}\nsolid it() = length(p) + apart\nit()");
            let apart = match Compiler::new().verify(true).compile(&page, &scene) {
                Ok(scene) => scene.distance([0.0; 3]).unwrap(),
                Err(errors) => {
                    wrong.push(format!("{page}:{line}: {expression}\n{errors}"));
                    continue;
                }
            };
            if apart > ROUNDING {
                wrong.push(format!("{page}:{line}: {expression} is not {value}: {apart:?}"));
            }
        }
    }
    assert!(count > 30, "the values were not found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_picture_behind_a_block_shows_its_scene() {
    let shown: Vec<(String, String)> = ["docs/tutorial.md", "docs/gallery.md", "docs/cookbook.md"]
        .into_iter()
        .flat_map(|page| {
            let page = std::fs::read_to_string(repository().join(page)).unwrap();
            pictures::shown(&page.replace("\r\n", "\n"))
        })
        .collect();
    assert!(shown.len() > 10, "the pictures were not found");
    for (path, block) in shown {
        let file = repository().join("docs").join(&path);
        let drawn = pictures::drawn(&block);
        let is_same = || is_same_picture(&std::fs::read(&file).unwrap_or_default(), &drawn);
        if std::env::var_os("DOCUMENTS_UPDATE").is_some() && !is_same() {
            std::fs::write(&file, &drawn).unwrap();
        }
        assert!(is_same(), "{path} is out of date; rewrite it with DOCUMENTS_UPDATE=1");
    }
}

#[test]
fn scenes_of_the_gallery_are_formatted_and_explain_their_diagnostics() {
    let page = std::fs::read_to_string(repository().join("docs/gallery.md")).unwrap();
    let entries = gallery::entries();
    assert!(entries.len() > 10, "the scenes were not found");
    for gallery::Entry { name, text } in entries {
        for link in [format!("(gallery/{name}.sdf)"), format!("(gallery/{name}.jpg)")] {
            assert!(page.contains(&link), "the gallery has no link `{link}`");
        }
        assert!(text.starts_with("// "), "{name} begins with no comment");
        let formatted = sdfc::format(&name, &text).map_err(|errors| errors.to_string());
        assert!(formatted.as_deref() == Ok(&*text), "{name}: run `sdfc fmt docs/gallery/*.sdf`");
        let found = Compiler::new().verify(true).check(&name, &text);
        assert!(found.iter().all(|it| text.contains(it.code.0)), "{found}");
    }
}

#[test]
fn pictures_of_the_gallery_show_their_scenes() {
    let mut wrong = Vec::new();
    for entry in gallery::entries() {
        let mut difference = entry.difference();
        if !difference.is_small() && std::env::var_os("DOCUMENTS_UPDATE").is_some() {
            entry.draw();
            difference = entry.difference();
        }
        println!("{}: {difference}", entry.name);
        if !difference.is_small() {
            wrong.push(format!("{}: {difference}", entry.name));
        }
    }
    let wrong = wrong.join("\n");
    assert!(wrong.is_empty(), "out of date; rewrite with DOCUMENTS_UPDATE=1:\n{wrong}");
}

#[test]
fn every_link_within_the_repository_leads_to_a_file() {
    let mut broken = Vec::new();
    for (page, text) in pages() {
        let folder = repository().join(&page).parent().unwrap().to_owned();
        // Every second part is a code block, where brackets and parentheses are not links.
        let prose: String = text.split("\n```").step_by(2).collect();
        let targets = prose.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        let pictures = prose.split("src=\"").skip(1).filter_map(|rest| rest.split('"').next());
        for target in targets.chain(pictures).filter(|target| !target.contains("://")) {
            let path = target.split('#').next().unwrap_or_default();
            if !path.is_empty() && !folder.join(path).exists() {
                broken.push(format!("{page}: {target}"));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}
