//! Scenes of several files.
#![allow(missing_docs)]

mod common;

use std::collections::HashMap;

use common::{Library, print::print, verify::verify};
use sdfc_diagnostics::render;
use sdfc_lang::hir::Program;
use sdfc_lang::import::{Resolver, load};
use sdfc_lang::{check_with_imports, front_with_imports};
use sdfc_syntax::parse;

struct Folder(HashMap<&'static str, String>);

impl Resolver for Folder {
    fn read(&self, path: &str) -> Result<String, String> {
        self.0.get(path).cloned().ok_or_else(|| "no such file".into())
    }
}

fn folder(files: &[(&'static str, &str)]) -> Folder {
    Folder(files.iter().map(|(path, text)| (*path, (*text).to_owned())).collect())
}

fn check(scene: &str, files: &[(&'static str, &str)]) -> (Program, String) {
    let library = Library::new();
    let mut sources = library.sources.clone();
    let file = sources.add("scene.sdf", scene);
    let (tree, mut found) = parse(&sources, file);
    let (imports, of_imports) = load(&mut sources, (file, &tree), &folder(files));
    found.extend(of_imports);
    let (program, of_check) = check_with_imports(&library.files, &imports, (file, &tree));
    found.extend(of_check);
    (program, render(&sources, &found, false))
}

const TOOTH: &str = "param depth = 0.1 in 0..1\nlet _half = depth / 2\nfn tooth(r) = r + _half\n";
const GEAR: &str = "import tooth as raised from \"./tooth.sdf\"
param teeth: int = 12 in 3..40
let rim = 0.8
solid gear(r: length = rim) = length(p) - raised(r) - 0.01 * teeth
gear()
camera(eye: [1, 2, 3])
";

#[test]
fn an_import_brings_names_but_not_drawings_or_settings() {
    let (program, rendered) = check(
        "import gear, rim from \"parts/gear.sdf\"
import tooth from \"parts/tooth.sdf\"
let depth = 3
gear(rim + tooth(depth))",
        &[("parts/gear.sdf", GEAR), ("parts/tooth.sdf", TOOTH)],
    );
    assert_eq!(rendered, "");
    verify(&program);
    insta::assert_snapshot!(print(&program));
}

#[test]
fn a_param_of_an_imported_file_can_be_called_time() {
    let clock = "param time = 1 in 0..2\nsolid ball() = length(p) - time\n";
    let (_, rendered) = check("import ball from \"clock.sdf\"\nball()", &[("clock.sdf", clock)]);
    assert_eq!(rendered, "");
}

#[test]
fn a_scene_of_several_files_elaborates() {
    let mut sources = sdfc_diagnostics::Sources::new();
    let file = sources.add("scene.sdf", "import gear from \"parts/gear.sdf\"\ngear(0.5)\n");
    let files = folder(&[("parts/gear.sdf", GEAR), ("parts/tooth.sdf", TOOTH)]);
    let (elaborated, found) = front_with_imports(&mut sources, file, &files);
    assert!(found.is_empty(), "{}", render(&sources, &found, false));
    let names: Vec<String> =
        elaborated.expect("a scene").scene.params.into_iter().map(|param| param.name).collect();
    assert_eq!(names, ["tooth.depth", "gear.teeth"]);
}

#[test]
fn params_of_files_with_the_same_name_have_different_names() {
    let storey = "param width = 1 in 0..2\nfn storey() = box(width)\n";
    let scene = "import storey from \"house/storey.sdf\"
import storey as tower, width from \"tower/storey.sdf\"
import roof from \"roof/storey.sdf\"
roof()
storey()
tower().translate(x: width)
";
    let mut sources = sdfc_diagnostics::Sources::new();
    let file = sources.add("scene.sdf", scene);
    let roof = "fn roof() = sphere(1)\n";
    let files = [("house/storey.sdf", storey), ("tower/storey.sdf", storey)];
    let files = folder(&[files.as_slice(), &[("roof/storey.sdf", roof)]].concat());
    let (elaborated, found) = front_with_imports(&mut sources, file, &files);
    assert!(found.is_empty(), "{}", render(&sources, &found, false));
    let names: Vec<String> =
        elaborated.expect("a scene").scene.params.into_iter().map(|param| param.name).collect();
    assert_eq!(names, ["house/storey.width", "tower/storey.width"]);
}

#[test]
fn imports_that_cannot_be_loaded_are_errors() {
    let scene = "import a from \"none.sdf\"
import b from \"../up.sdf\"
import c from \"/etc/passwd\"
import geer, _half from \"parts/tooth.sdf\"
import toot from \"parts/tooth.sdf\"
import x from \"circle.sdf\"
import y from \"broken.sdf\"
import tooth from \"parts/tooth.sdf\"
import tooth from \"parts/tooth.sdf\"
sphere(a(b) + c + x + y)";
    let files = [
        ("parts/tooth.sdf", TOOTH),
        ("circle.sdf", "import z from \"back.sdf\"\nlet x = z\n"),
        ("back.sdf", "import x from \"circle.sdf\"\nlet z = x\n"),
        ("broken.sdf", "let y = (1\n"),
    ];
    let (_, rendered) = check(scene, &files);
    insta::assert_snapshot!(rendered);
}

#[test]
fn an_unused_import_is_a_warning() {
    let scene = "import tooth, depth as d from \"parts/tooth.sdf\"\nsphere(d)";
    insta::assert_snapshot!(check(scene, &[("parts/tooth.sdf", TOOTH)]).1);
}
