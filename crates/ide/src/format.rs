//! Formats a scene.

use sdfc_diagnostics::Sources;

/// Returns the formatted text, or `None` if the text does not parse.
pub fn format(text: &str) -> Option<String> {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", text);
    sdfc_syntax::format(&sources, file).ok()
}
