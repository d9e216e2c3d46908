//! Imports: loads the files that a scene imports, and reports circular imports.
//!
//! This module opens no files: the caller passes a [`Resolver`].

use rustc_hash::FxHashMap;
use sdfc_diagnostics::{Code, Diagnostic, FileId, Sources, Span, has_errors};
use sdfc_syntax::ast::{self, Item};

/// The largest number of files that a scene can import, directly or indirectly.
pub const MAX_FILES: usize = 256;

/// Reads files for the compiler.
pub trait Resolver {
    /// Reads a source file. The path is relative to the folder of the opened scene, with `/` as
    /// separator and without `.` and `..`, as in `parts/gear.sdf`.
    ///
    /// # Errors
    ///
    /// Returns the reason in one line, such as `no such file`.
    fn read(&self, path: &str) -> Result<String, String>;

    /// Reads a binary file: a font or a picture. The path is as for [`Resolver::read`].
    ///
    /// # Errors
    ///
    /// Returns the reason in one line.
    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        self.read(path).map(String::into_bytes)
    }

    /// The name of a source file in diagnostics, if it is not below the folder of the scene.
    fn name_of(&self, _path: &str) -> Option<String> {
        None
    }

    /// The path of the scene below the folder that paths are relative to; empty for a scene in that
    /// folder. An editor checks an imported file by itself, and its imports may lead to folders
    /// above its own.
    fn scene_path(&self) -> &str {
        ""
    }
}

const WITHOUT_FILES: &str = "this scene was opened without access to files";

/// A resolver without files, for scenes without imports.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl Resolver for NoFiles {
    fn read(&self, _: &str) -> Result<String, String> {
        Err(WITHOUT_FILES.into())
    }
}

/// An imported file.
#[derive(Clone, Debug)]
pub struct Imported {
    /// Its id in the [`Sources`].
    pub file: FileId,
    /// Its path relative to the folder of the scene.
    pub path: String,
    /// Its syntax tree.
    pub tree: ast::File,
    /// True if it was parsed without errors. Otherwise a missing name may be in a part that could
    /// not be parsed.
    pub whole: bool,
}

/// A file whose imports are being loaded.
struct Open {
    /// Its index among the imported files; `None` for the scene itself.
    at: Option<usize>,
    path: String,
    /// The imports that are not loaded yet, last first.
    imports: Vec<(String, Span)>,
}

/// Reads and parses all files that a scene imports, each once. A file comes after the files that it
/// imports itself.
///
/// Returns the files with diagnostics about imports that cannot be loaded and about their syntax.
/// In `sources` a file has the name of the scene with its last part replaced: beside
/// `parts/shelf.sdf`, the import `hook.sdf` is called `parts/hook.sdf`. The resolver can give it
/// another name.
pub fn load(
    sources: &mut Sources,
    (scene, tree): (FileId, &ast::File),
    resolver: &dyn Resolver,
) -> (Vec<Imported>, Vec<Diagnostic>) {
    let scene_path = resolver.scene_path();
    let name = sources.name(scene);
    let folder = name.strip_suffix(scene_path).filter(|_| !scene_path.is_empty());
    let folder = folder.unwrap_or_else(|| folder_of(name)).to_owned();
    let mut found = Vec::new();
    let mut loaded: Vec<Imported> = Vec::new();
    let mut known: FxHashMap<String, Option<usize>> = FxHashMap::default();
    let mut done = Vec::new();
    let mut open = vec![Open { at: None, path: scene_path.to_owned(), imports: imports(tree) }];
    while let Some(file) = open.last_mut() {
        let Some((written, span)) = file.imports.pop() else {
            done.extend(file.at);
            open.pop();
            continue;
        };
        let Ok(path) = locate(&file.path, &written).map_err(|why| found.push(error(span, why)))
        else {
            continue;
        };
        if let Some(first) = open.iter().position(|file| file.at.is_some() && file.path == path) {
            let circle: Vec<&str> = open[first..].iter().map(|file| file.path.as_str()).collect();
            let why = format!("these files import each other: {} -> {path}", circle.join(" -> "));
            found.push(error(span, why));
            continue;
        }
        if known.contains_key(&path) {
            continue;
        }
        if known.len() >= MAX_FILES {
            found.push(error(span, format!("a scene can import at most {MAX_FILES} files")));
            break;
        }
        let text = match resolver.read(&path) {
            Ok(text) => text,
            Err(why) => {
                found.push(error(span, format!("`{path}` cannot be read: {why}")));
                known.insert(path, None);
                continue;
            }
        };
        let name = resolver.name_of(&path).unwrap_or_else(|| format!("{folder}{path}"));
        let id = sources.add(name, text);
        let (tree, of_parser) = sdfc_syntax::parse(sources, id);
        let whole = !has_errors(&of_parser);
        found.extend(of_parser);
        known.insert(path.clone(), Some(loaded.len()));
        open.push(Open { at: Some(loaded.len()), path: path.clone(), imports: imports(&tree) });
        loaded.push(Imported { file: id, path, tree, whole });
    }
    done.extend(open.iter().rev().filter_map(|file| file.at));
    let mut files: Vec<Option<Imported>> = loaded.into_iter().map(Some).collect();
    let ordered = done.into_iter().filter_map(|at| files[at].take()).collect();
    (ordered, found)
}

/// Reads the files that a scene imports, for what the resolver learns from it. Files that cannot be
/// read are skipped.
pub fn visit(sources: &mut Sources, scene: FileId, resolver: &dyn Resolver) {
    let (tree, _) = sdfc_syntax::parse(sources, scene);
    load(sources, (scene, &tree), resolver);
}

/// The folder in a path, with the separator at its end; empty if there is none.
fn folder_of(name: &str) -> &str {
    let end = name.rfind(std::path::is_separator).map_or(0, |last| last + 1);
    &name[..end]
}

/// The imports of a file, last first.
fn imports(tree: &ast::File) -> Vec<(String, Span)> {
    let imports = tree.items.iter().rev().filter_map(Item::as_import);
    imports.map(|import| (import.path.text.clone(), import.path.span)).collect()
}

/// The diagnostic for an import in a scene without access to files.
pub(crate) fn refuse_without_files(item: &Item) -> Option<Diagnostic> {
    item.as_import().map(|import| error(import.path.span, WITHOUT_FILES.into()))
}

fn error(span: Span, why: String) -> Diagnostic {
    Diagnostic::error(Code::IMPORT, span, why)
}

/// Returns the path of an import relative to the folder of the scene. `from` is the path of the
/// importing file, empty for the scene.
///
/// # Errors
///
/// Returns the reason if the path is invalid.
pub fn locate(from: &str, written: &str) -> Result<String, String> {
    if written.is_empty() {
        return Err("the path of an import is empty".into());
    }
    if written.starts_with('/') || written.contains([':', '\\', '\0']) {
        return Err(format!("`{written}` must be a path relative to this file, with `/`"));
    }
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in written.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                if parts.pop().is_none() {
                    return Err(format!("`{written}` is outside the folder of the scene"));
                }
            }
            part => parts.push(part),
        }
    }
    match parts.is_empty() {
        true => Err(format!("`{written}` is a folder")),
        false => Ok(parts.join("/")),
    }
}

/// Returns the prefix of the names of each file's params, for the paths of all files with params.
///
/// The prefix is the name of the file without its ending: `gear` for `parts/gear.sdf`. Before it
/// come as many folders as tell the file from all others: `house/storey` and `tower/storey`.
/// Prefixes of different files are different.
pub(crate) fn param_prefixes(paths: &[&str]) -> Vec<String> {
    let deepest = paths.iter().map(|path| path.matches('/').count()).max().unwrap_or(0);
    let prefix = |path: &str| {
        let is_unique = |folders: usize| {
            let label = label(path, folders);
            paths.iter().filter(|other| self::label(other, folders) == label).count() == 1
        };
        let folders = (0..=deepest).find(|folders| is_unique(*folders));
        // Files that differ only in their endings keep these: a label has no dot in its last part.
        folders.map_or_else(|| path.to_owned(), |folders| label(path, folders).to_owned())
    };
    paths.iter().map(|path| prefix(path)).collect()
}

/// The name of a file without its ending, after its innermost folders: `b/gear` for
/// `a/b/gear.sdf` and one folder.
fn label(path: &str, folders: usize) -> &str {
    let start = path.rmatch_indices('/').nth(folders).map_or(0, |(slash, _)| slash + 1);
    let name = path.rfind('/').map_or(0, |slash| slash + 1);
    let end = path[name..].find('.').map_or(path.len(), |dot| name + dot);
    &path[start..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_outside_the_scenes_folder_are_refused() {
        assert_eq!(locate("", "parts/gear.sdf").as_deref(), Ok("parts/gear.sdf"));
        assert_eq!(locate("parts/gear.sdf", "./tooth.sdf").as_deref(), Ok("parts/tooth.sdf"));
        assert_eq!(locate("a/b/c.sdf", "../../d.sdf").as_deref(), Ok("d.sdf"));
        for bad in ["../a.sdf", "/etc/passwd", "a\\b.sdf", "c:/a.sdf", "", ".", "a/../../b"] {
            assert!(locate("", bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn the_prefix_of_params_is_the_name_of_their_file() {
        assert_eq!(param_prefixes(&["parts/gear.sdf", "rack"]), ["gear", "rack"]);
        assert_eq!(param_prefixes(&["v1.2/gear.sdf"]), ["gear"]);
    }

    #[test]
    fn files_of_the_same_name_have_the_fewest_folders_that_tell_them_apart() {
        let paths = ["a/house/storey.sdf", "a/tower/storey.sdf", "storey.sdf", "a/roof.sdf"];
        let expected = ["house/storey", "tower/storey", "storey", "roof"];
        assert_eq!(param_prefixes(&paths), expected);
        let paths = ["a/b/c/x.sdf", "d/b/c/x.sdf", "e/x.sdf"];
        assert_eq!(param_prefixes(&paths), ["a/b/c/x", "d/b/c/x", "e/x"]);
    }

    #[test]
    fn files_that_differ_only_in_their_endings_have_different_prefixes() {
        let paths = ["a/x.sdf", "a/x.old.sdf", "b/x.sdf"];
        assert_eq!(param_prefixes(&paths), ["a/x.sdf", "a/x.old.sdf", "b/x"]);
    }
}
