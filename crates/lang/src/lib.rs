//! Names, types, stages and elaboration of sdfc scenes; the library in `std`.
//!
//! # What
//!
//! [`front`] takes a scene from text to graph: parsed, checked against the library, elaborated to
//! shape instances and the math that they are made of. [`reference::entries`] says what a scene
//! can name.
//!
//! # How
//!
//! The checker resolves names and types and writes every coercion out ([`hir`]); the elaborator
//! ([`elab`]) inlines, unrolls and builds the graph, in which each value's stage (compile time,
//! per frame, per point) follows from what it depends on. Both collect their findings and go on.
//!
//! ```
//! use sdfc_diagnostics::Sources;
//!
//! let mut sources = Sources::new();
//! let file = sources.add("scene.sdf", "let ball = sphere(0.5)\nball | plane(y: -0.5)\n");
//! let (elaborated, found) = sdfc_lang::front(&mut sources, file);
//! assert!(found.is_empty());
//! let scene = elaborated.expect("the scene is right").scene;
//! let root = scene.graph.shape(scene.root.expect("it draws something"));
//! assert_eq!(root.definition, "union");
//! assert_eq!(scene.graph.shape(root.children[0]).name.as_deref(), Some("ball"));
//! ```
//!
//! # Limits
//!
//! Those of the parser ([`sdfc_syntax`]), of [`import`] and of elaboration ([`elab`]). A ray
//! method that this version does not have is refused with `E0411`.

pub mod arcs;
mod check;
pub mod elab;
pub mod font;
pub mod hir;
pub mod import;
pub mod library;
pub mod live_literals;
pub mod outline;
mod reach;
pub mod reference;
pub mod settings;
mod spelling;
mod synonyms;

use sdfc_diagnostics::{Code, Diagnostic, FileId, Sources, has_errors};

pub use check::{check, check_library, check_with_imports};
pub use elab::{Claimed, Declared, DeclaredPromise, Elaborated, Site};
pub use import::{NoFiles, Resolver};

/// Parses, checks and elaborates a scene. The library's files are added to `sources`, since
/// messages show lines of them. Without a scene there is at least one error among the findings;
/// all findings of the phases that ran are there, in the order of the phases.
pub fn front(sources: &mut Sources, file: FileId) -> (Option<Elaborated>, Vec<Diagnostic>) {
    front_with_imports(sources, file, &NoFiles)
}

/// As [`front`], for scenes that import files: the resolver gives their texts, which are added
/// to `sources` under their paths.
pub fn front_with_imports(
    sources: &mut Sources,
    file: FileId,
    resolver: &dyn Resolver,
) -> (Option<Elaborated>, Vec<Diagnostic>) {
    front_with(sources, file, resolver, Options::default())
}

/// How a scene is elaborated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Numbers written in the scene become params, see [`live_literals`].
    pub live_literals: bool,
    /// If the scene has more than [`live_literals::MAX_LIVE_LITERALS`] literals, those nearest to
    /// this byte offset become params; the first ones if it is `None`.
    pub focus: Option<u32>,
}

/// As [`front_with_imports`], with options.
pub fn front_with(
    sources: &mut Sources,
    file: FileId,
    resolver: &dyn Resolver,
    options: Options,
) -> (Option<Elaborated>, Vec<Diagnostic>) {
    let (scene, mut found) = sdfc_syntax::parse(sources, file);
    // The parser gave up in the middle: the rest would seem to lack what it declares.
    if found.iter().any(|it| matches!(it.code, Code::NESTING | Code::TOO_LARGE)) {
        return (None, found);
    }
    // The library comes before the imports, so that its places are the same in every scene.
    let library = library::add_to(sources);
    let (imports, of_imports) = import::load(sources, (file, &scene), resolver);
    found.extend(of_imports);
    let (program, of_check) = reach::check(sources, &library, &imports, (file, &scene));
    let parsed = !has_errors(&found);
    // What could not be read may have used or drawn what seems to be idle.
    found.extend(of_check.into_iter().filter(|it| parsed || it.is_error()));
    if has_errors(&found) {
        return (None, found);
    }
    let fonts = font::Fonts::new(resolver);
    let (elaborated, of_elaboration) = if options.live_literals {
        live_literals::elaborate(&program, &fonts, sources, file, options.focus)
    } else {
        elab::elaborate(&program, &fonts)
    };
    found.extend(of_elaboration);
    (elaborated, found)
}
