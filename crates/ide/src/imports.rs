//! The files that a text imports.

use sdfc_diagnostics::Sources;
use sdfc_lang::import::locate;
use sdfc_syntax::ast::Item;

/// Returns the paths of the files that a text imports itself, relative to a folder in which the
/// text is the file `path`. Paths outside of that folder and wrong paths are left out.
pub fn imports(path: &str, text: &str) -> Vec<String> {
    let mut sources = Sources::new();
    let file = sources.add(path, text);
    let (tree, _) = sdfc_syntax::parse(&sources, file);
    let imports = tree.items.iter().filter_map(Item::as_import);
    imports.filter_map(|import| locate(path, &import.path.text).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_relative_to_the_folder() {
        let text =
            "import a from \"../b.sdf\"\nimport c from \"d.sdf\"\nimport e from \"../../f\"\n";
        assert_eq!(imports("parts/g.sdf", text), ["b.sdf", "parts/d.sdf"]);
    }
}
