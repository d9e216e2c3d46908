//! The generated parser of `editors/tree-sitter-sdf`.

use tree_sitter::Language;
use tree_sitter_language::LanguageFn;

unsafe extern "C" {
    fn tree_sitter_sdf() -> *const ();
}

/// Returns the grammar.
pub fn language() -> Language {
    // SAFETY: the function is that of the parser that `tree-sitter generate` wrote, which returns a
    // pointer to a static `TSLanguage`.
    unsafe { LanguageFn::from_raw(tree_sitter_sdf) }.into()
}
