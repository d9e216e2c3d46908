//! Texts, and scenes with the files that they import.

use std::collections::BTreeMap;

use sdfc::{Compiler, Diagnostics, Emit, Scene, ShaderOptions, Target};
use sdfc_ide::{Analysis, NoFiles};

use crate::files::Files;
use crate::{NAME, parts, vocabulary};

/// The largest number of operations of a scene whose shader is written. Larger scenes take
/// seconds, which would hide faults of the others.
const MAX_OPERATIONS: usize = 2000;

/// Parses and formats a text, and asks the language service about it. Formatting a formatted text
/// must change nothing.
pub fn text(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(once) = sdfc::format(NAME, text) {
        let twice = sdfc::format(NAME, &once).map_err(|e| e.to_string());
        assert_eq!(twice.as_deref(), Ok(&*once), "formatted again");
    }
    let scene = Analysis::new(NAME, text, &NoFiles);
    let middle = text.floor_char_boundary(text.len() / 2);
    sdfc_ide::diagnostics(&scene, false);
    sdfc_ide::tokens(&scene);
    sdfc_ide::folds(&scene);
    sdfc_ide::symbols(&scene);
    sdfc_ide::hints(&scene, 0..text.len(), &[]);
    sdfc_ide::complete(NAME, text, middle, &NoFiles, &[]);
    sdfc_ide::signature_help(&scene, middle);
    sdfc_ide::hover(&scene, middle, &mut |_| None);
    sdfc_ide::actions(&scene, middle..middle);
    sdfc_ide::selection(&scene, middle);
    sdfc_ide::references(&scene, &[], middle, true);
    // A place without a name cannot be renamed, and says so.
    let _ = sdfc_ide::rename(&scene, &[], middle, "renamed");
}

/// Compiles a text of tokens.
pub fn tokens(bytes: &[u8]) {
    compile(&Compiler::new(), &vocabulary::text(bytes));
}

/// Compiles a scene, with and without live literals, and writes its shader.
pub fn scene(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Some(scene) = compile(&Compiler::new(), text) else { return };
    write(&scene, bytes.len());
    let live = compile(&Compiler::new().live_literals(None), text);
    write(&live.expect("a scene compiles with live literals too"), bytes.len());
}

/// Compiles a scene with files. The first part is the scene, and each pair of other parts is the
/// path and the contents of a file.
pub fn imports(bytes: &[u8]) {
    let mut parts = parts(bytes);
    let Some(Ok(text)) = parts.next().map(std::str::from_utf8) else { return };
    let mut files = Files::default();
    while let (Some(path), Some(contents)) = (parts.next(), parts.next()) {
        files.0.insert(String::from_utf8_lossy(path).into_owned(), contents.to_vec());
    }
    compile(&Compiler::new().resolver(&files), text)
        .iter()
        .for_each(|scene| write(scene, bytes.len()));
    sdfc_ide::diagnostics(&Analysis::new(NAME, text, &files), false);
}

/// Compiles and writes a scene with two letters of a font.
pub fn font(bytes: &[u8]) {
    letters(bytes).iter().for_each(|scene| write(scene, bytes.len()));
}

fn letters(font: &[u8]) -> Option<Scene> {
    let files = Files(BTreeMap::from([("a.ttf".to_owned(), font.to_vec())]));
    let text = "text(\"Aq\", font: \"a.ttf\").extrude(0.1)\n";
    compile(&Compiler::new().resolver(&files), text)
}

/// Compiles a text, and checks that its diagnostics can be shown.
fn compile(compiler: &Compiler<'_>, text: &str) -> Option<Scene> {
    match compiler.compile(NAME, text) {
        Ok(scene) => {
            check(scene.diagnostics());
            Some(scene)
        }
        Err(errors) => {
            check(&errors);
            None
        }
    }
}

/// Each diagnostic has a place in its source, a code and words.
fn check(diagnostics: &Diagnostics) {
    for it in diagnostics {
        let source = diagnostics.sources().text(it.span.file);
        assert!(source.get(it.span.start as usize..it.span.end as usize).is_some(), "{it:?}");
        assert!(!it.message.is_empty() && !it.code.0.is_empty(), "{it:?}");
    }
    diagnostics.render(false);
}

/// Writes the shader of a scene, and evaluates its field. The length of the input selects
/// the target, because all targets would take several times as long.
fn write(scene: &Scene, length: usize) {
    if !scene.draws() || scene.report().distance_cost.operations > MAX_OPERATIONS {
        return;
    }
    let target = Target::ALL[length % Target::ALL.len()];
    let options = ShaderOptions::new()
        .target(target)
        .emit(Emit::default_for(target))
        .stage(target.default_stage());
    let written = scene.write_shader(&options);
    let written = written.unwrap_or_else(|error| panic!("{}: {error}", target.name()));
    scene.reflect(&options, &written);
    let mut field = scene.field(&scene.defaults()).unwrap_or_else(|error| panic!("{error}"));
    field.distance([0.3, 0.2, 0.1]);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A target that refuses its seed tests little.
    #[test]
    fn the_seed_of_the_fonts_is_a_font() {
        assert!(letters(include_bytes!("../seeds/letters.ttf")).is_some());
        assert!(letters(b"no font").is_none());
    }
}
