//! The front end of sdfc: name resolution, type checking and elaboration of scenes, and the shape
//! library in `std`.
//!
//! # What
//!
//! [`front`] compiles a scene from source to graph: it parses the scene, checks it against the
//! library, and elaborates it to shape instances and their formulas. [`reference::entries`] lists
//! the names that a scene can use.
//!
//! # How
//!
//! The checker resolves names and types and makes every coercion explicit ([`hir`]). The elaborator
//! ([`elab`]) inlines functions, unrolls lists and builds the graph. The graph derives each value's
//! evaluation rate (compile time, per frame, per point) from its arguments. Both phases collect
//! diagnostics and continue after an error.
//!
//! ```
//! use sdfc_diagnostics::Sources;
//!
//! let mut sources = Sources::new();
//! let file = sources.add("scene.sdf", "let ball = sphere(0.5)\nball | plane(y: -0.5)\n");
//! let (elaborated, found) = sdfc_lang::front(&mut sources, file);
//! assert!(found.is_empty());
//! let scene = elaborated.expect("the scene has no errors").scene;
//! let root = scene.graph.shape(scene.root.expect("the scene draws a solid"));
//! assert_eq!(root.definition, "union");
//! assert_eq!(scene.graph.shape(root.children[0]).name.as_deref(), Some("ball"));
//! ```
//!
//! # Limits
//!
//! The parser ([`sdfc_syntax`]), [`import`] and the elaborator ([`elab`]) have limits. A ray method
//! that this version does not have is the error `E0411`.

pub mod arcs;
pub mod assets;
pub mod cells;
mod check;
pub mod elab;
pub mod environment;
pub mod font;
pub mod hir;
pub mod import;
pub mod inspect;
pub mod library;
pub mod live_literals;
pub mod outline;
pub mod polygon;
mod reachability;
pub mod receivers;
pub mod reference;
pub mod settings;
mod spelling;
mod synonyms;
mod syntax_words;
pub mod uses;

use sdfc_diagnostics::{Code, Diagnostic, FileId, Sources, has_errors};
use sdfc_syntax::ast;

use check::{SceneFile, SceneFiles};
pub use check::{check, check_library, check_with_imports};
pub use elab::{Claimed, CompileValues, Declared, DeclaredPromise, Elaborated, Site};
pub use import::{NoFiles, Resolver};
pub use spelling::nearest as nearest_name;

/// Parses, checks and elaborates a scene without imports.
///
/// Adds the library's files to `sources`, since messages show lines of them. Returns the scene and
/// the diagnostics of all phases that ran, in the order of the phases. If there is no scene, at
/// least one diagnostic is an error.
pub fn front(sources: &mut Sources, file: FileId) -> (Option<Elaborated>, Vec<Diagnostic>) {
    front_with_imports(sources, file, &NoFiles)
}

/// Like [`front`], for scenes with imports. The resolver reads the imported files, which are added
/// to `sources` under their paths.
pub fn front_with_imports(
    sources: &mut Sources,
    file: FileId,
    resolver: &dyn Resolver,
) -> (Option<Elaborated>, Vec<Diagnostic>) {
    front_with(sources, file, resolver, Options::default())
}

/// Options of the front end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options<'v> {
    /// Numbers written in the scene become params, see [`live_literals`].
    pub live_literals: bool,
    /// If the scene has more than [`live_literals::MAX_LIVE_LITERALS`] literals, those nearest to
    /// this byte offset become params; the first ones if it is `None`.
    pub focus: Option<u32>,
    /// Values for the params that decide what the scene consists of; `None` for their defaults.
    pub values: Option<&'v CompileValues>,
    /// All params are constants. Without effect on live literals.
    pub constant_params: bool,
    /// Arguments of `camera(...)` that replace the scene's camera, such as `eye: [4, 3, 5]`. They
    /// can use the names of the scene.
    pub camera: Option<&'v str>,
}

/// Like [`front_with_imports`], with options.
pub fn front_with(
    sources: &mut Sources,
    file: FileId,
    resolver: &dyn Resolver,
    options: Options<'_>,
) -> (Option<Elaborated>, Vec<Diagnostic>) {
    let checked = check_scene(sources, file, resolver, options.camera, None);
    let (program, mut found) = (checked.program, checked.found);
    if has_errors(&found) {
        return (None, found);
    }
    let assets = assets::Assets::new(resolver);
    let defaults = CompileValues::new();
    let values = options.values.unwrap_or(&defaults);
    let (elaborated, of_elaboration) = if options.live_literals {
        live_literals::elaborate(&program, &assets, sources, file, options.focus, values)
    } else {
        elab::elaborate(&program, &assets, values, options.constant_params)
    };
    found.extend(of_elaboration);
    (elaborated, found)
}

/// Returns the params that a scene declares, also if it cannot be elaborated with their defaults.
/// There are none if the scene does not pass the check.
pub fn declared_params(
    sources: &mut Sources,
    file: FileId,
    resolver: &dyn Resolver,
) -> Vec<sdfc_graph::Param> {
    let checked = check_scene(sources, file, resolver, None, None);
    if has_errors(&checked.found) {
        return Vec::new();
    }
    elab::declared_params(&checked.program, &assets::Assets::new(resolver))
}

/// A scene after the check.
struct Checked {
    tree: ast::File,
    imports: Vec<import::Imported>,
    program: hir::Program,
    /// The tables, if they were asked for.
    uses: Option<uses::Uses>,
    /// The diagnostics of the parser, the imports and the checker.
    found: Vec<Diagnostic>,
}

/// Parses and checks a scene, with another camera if there is one. Fills `uses` if it is there.
fn check_scene(
    sources: &mut Sources,
    file: FileId,
    resolver: &dyn Resolver,
    camera: Option<&str>,
    uses: Option<uses::Uses>,
) -> Checked {
    let (tree, mut found) = sdfc_syntax::parse(sources, file);
    // The library comes before the imports, so that its file ids are the same in every scene.
    let library = library::add_to(sources);
    // The parser stopped early: declarations in the rest of the file would seem to be missing.
    if found.iter().any(|it| matches!(it.code, Code::NESTING | Code::TOO_LARGE)) {
        let (imports, program) = (Vec::new(), hir::Program::default());
        return Checked { tree, imports, program, uses, found };
    }
    let (imports, of_imports) = import::load(sources, (file, &tree), resolver);
    found.extend(of_imports);
    let camera = camera.map(|arguments| {
        let file = sources.add("camera", format!("camera({arguments})"));
        let (tree, of_camera) = sdfc_syntax::parse(sources, file);
        found.extend(of_camera);
        (file, tree)
    });
    let camera = camera.as_ref().map(|(file, tree)| (*file, tree));
    let scene = SceneFile { file, tree: &tree, path: resolver.scene_path() };
    let scene = SceneFiles { imports: &imports, scene, camera };
    let checked = reachability::check(sources, &library, scene, uses);
    let parsed = !has_errors(&found);
    // A part that could not be parsed may use or draw the items that warnings call unused.
    found.extend(checked.diagnostics.into_iter().filter(|it| parsed || it.is_error()));
    Checked { tree, imports, program: checked.program, uses: checked.uses, found }
}
