//! The checker: resolves names and types, and turns parsed files into a [`Program`].
//!
//! Every body of the scene is checked, called or not; bodies of the library only if the scene
//! uses them. Diagnostics are collected. A value with an error has the type [`Type::Error`], for
//! which no further errors are reported.
//!
//! The modules:
//!
//! - `names`, `value`: what a name refers to;
//! - `overload`: which declaration a call refers to;
//! - `call`, `arguments`: how arguments are assigned to parameters;
//! - `foreign`: calls of functions with names from other tools;
//! - `kernel`, `builtins`, `math`, `iterate`: the functions of the kernel;
//! - `operators`, `list`, `records`, `block`, `lambda`, `expr`: the forms of expressions;
//! - `types`, `coerce`: which value can be used where;
//! - `decl`, `clauses`: declarations, which are checked when they are first mentioned;
//! - `top`: the top level of a file, which drives the others;
//! - `order`: circular dependencies, which are found at the end;
//! - `notes`: tables of names and types for editors.
#![allow(
    clippy::wildcard_enum_match_arm,
    reason = "the rule for all other types and forms is an error message, also for new ones"
)]

mod advice;
mod arguments;
mod block;
mod body;
pub(crate) mod builtins;
mod call;
mod clauses;
mod coerce;
mod decl;
mod expr;
mod foreign;
mod formula;
mod iterate;
pub(crate) mod kernel;
mod lambda;
mod list;
mod math;
mod names;
mod notes;
mod operators;
mod order;
mod overload;
mod records;
mod top;
pub(crate) mod types;
mod value;
mod written;

use std::rc::Rc;

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_diagnostics::{Diagnostic, FileId, Span, has_errors};
use sdfc_graph::Dim;
use sdfc_syntax::ast::{self, Item};

use crate::hir::{Expr, ExprKind, GlobalId, Param, ParamId, Program, Type};
use crate::import::{self, Imported};
use crate::settings::{self, SettingRow};
use crate::uses::Uses;

/// Checks a scene without access to other files: imports are errors. See [`check_with_imports`].
pub fn check(
    library: &[(FileId, ast::File)],
    scene: (FileId, &ast::File),
) -> (Program, Vec<Diagnostic>) {
    let (program, of_check) = check_with_imports(library, &[], scene);
    let mut found: Vec<Diagnostic> =
        scene.1.items.iter().filter_map(import::refuse_without_files).collect();
    found.extend(of_check);
    (program, found)
}

/// Checks a scene and its imports against the library.
///
/// If there is no error among the diagnostics, the program is complete and free of
/// [`Type::Error`]. The diagnostics are in the order of their positions. Library bodies that the
/// scene does not use are not checked; see [`check_library`].
///
/// `imports` are the files that [`load`](crate::import::load) returns for the scene; it reports
/// those that it cannot load.
pub fn check_with_imports(
    library: &[(FileId, ast::File)],
    imports: &[Imported],
    scene: (FileId, &ast::File),
) -> (Program, Vec<Diagnostic>) {
    let scene = SceneFile { file: scene.0, tree: scene.1, path: "" };
    let files = SceneFiles { imports, scene, camera: None };
    let checked = check_items(&whole(library), None, files, None);
    (checked.program, checked.diagnostics)
}

/// The file that is checked as a scene.
#[derive(Clone, Copy)]
pub(crate) struct SceneFile<'a> {
    pub file: FileId,
    pub tree: &'a ast::File,
    /// See [`Resolver::scene_path`](import::Resolver::scene_path).
    pub path: &'a str,
}

/// The parsed files of a scene.
#[derive(Clone, Copy)]
pub(crate) struct SceneFiles<'a> {
    pub imports: &'a [Imported],
    pub scene: SceneFile<'a>,
    /// A file with the camera that replaces the scene's.
    pub camera: Option<(FileId, &'a ast::File)>,
}

/// The result of [`check_items`].
pub(crate) struct CheckedItems {
    pub program: Program,
    /// The diagnostics, in the order of their positions.
    pub diagnostics: Vec<Diagnostic>,
    /// The tables, if they were asked for.
    pub uses: Option<Uses>,
}

/// Like [`check_with_imports`], with only the given items of each library file. A scene that does
/// not light itself gets the settings of the look. Fills `uses` if it is there.
pub(crate) fn check_items<'a>(
    library: &[(FileId, Vec<&'a Item>)],
    look: Option<&'a ast::File>,
    SceneFiles { imports, scene, camera }: SceneFiles<'a>,
    uses: Option<Uses>,
) -> CheckedItems {
    let mut checker = Checker::new(library);
    (checker.uses, checker.scene_path) = (uses, scene.path);
    for import in imports {
        let module = checker.add_module(&import.tree.items, Some(&import.path), false);
        checker.modules[module].whole = import.whole;
    }
    let module = checker.add_module(&scene.tree.items, Some(""), false);
    checker.name_params();
    for (import, module) in imports.iter().zip(library.len()..) {
        checker.check_imported(module, &import.tree);
    }
    checker.check_scene(module, scene.file, scene.tree);
    if let Some((_, camera)) = camera {
        checker.replace_camera(module, camera);
    }
    if let Some(look) = look {
        let module = checker.add_module(&look.items, None, true);
        checker.check_look(module, look);
    }
    let uses = checker.uses.take();
    let (program, diagnostics) = checker.finish();
    CheckedItems { program, diagnostics, uses }
}

/// Checks every declaration of the library, once per dimension.
pub fn check_library(library: &[(FileId, ast::File)]) -> (Program, Vec<Diagnostic>) {
    check_library_items(&whole(library))
}

/// Like [`check_library`], for the given items of each file.
pub(crate) fn check_library_items(library: &[(FileId, Vec<&Item>)]) -> (Program, Vec<Diagnostic>) {
    let mut checker = Checker::new(library);
    for module in 0..library.len() {
        checker.check_declarations(module);
    }
    checker.finish()
}

/// All items of each file.
fn whole(library: &[(FileId, ast::File)]) -> Vec<(FileId, Vec<&Item>)> {
    library.iter().map(|(file, ast)| (*file, ast.items.iter().collect())).collect()
}

/// An index into [`Checker::decls`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct DeclIndex(usize);
/// An index into [`Checker::lets`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct LetIndex(usize);
/// An index into [`Checker::params`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct ParamIndex(usize);

/// A declaration of a file.
#[derive(Debug)]
struct DeclInfo<'a> {
    ast: &'a ast::Decl,
    module: usize,
    /// True if it is checked once per dimension.
    generic: bool,
    used: bool,
}

/// A file-level `let`.
#[derive(Debug)]
struct LetInfo<'a> {
    ast: &'a ast::Let,
    module: usize,
    used: bool,
    state: State<GlobalId>,
}

impl<'a> LetInfo<'a> {
    fn new(ast: &'a ast::Let, module: usize) -> Self {
        Self { ast, module, used: false, state: State::Unseen }
    }
}

/// A `param`.
#[derive(Debug)]
struct ParamInfo<'a> {
    ast: &'a ast::Param,
    module: usize,
    used: bool,
    state: State<ParamId>,
    checked: Option<Param>,
}

impl<'a> ParamInfo<'a> {
    fn new(ast: &'a ast::Param, module: usize) -> Self {
        Self { ast, module, used: false, state: State::Unseen, checked: None }
    }
}

/// The progress of checking a `let` or `param`.
#[derive(Clone, Debug)]
enum State<Id> {
    Unseen,
    Open,
    Done(Id, Type),
    /// An error was reported.
    Failed,
}

/// The state of the checker.
#[derive(Debug, Default)]
struct Checker<'a> {
    modules: Vec<names::Module<'a>>,
    /// The path of the scene below the folder that import paths are relative to.
    scene_path: &'a str,
    /// Public names of the library.
    library: FxHashMap<&'a str, names::Entry>,
    settings: Vec<SettingRow>,
    decls: Vec<DeclInfo<'a>>,
    lets: Vec<LetInfo<'a>>,
    params: Vec<ParamInfo<'a>>,
    /// The declarations that were used so far, by dimension if they have two.
    instances: FxHashMap<(DeclIndex, Option<Dim>), decl::Instance<'a>>,
    /// Bodies that are not checked yet; their types are known.
    pending: Vec<decl::Pending<'a>>,
    /// The current body.
    body: body::Body<'a>,
    order: order::Order,
    /// What editors ask for; `None` if nobody does.
    uses: Option<Uses>,
    program: Program,
    diagnostics: Vec<Diagnostic>,
}

impl<'a> Checker<'a> {
    fn new(library: &[(FileId, Vec<&'a Item>)]) -> Self {
        let mut checker = Self { settings: settings::table(), ..Self::default() };
        for (_, items) in library {
            checker.add_module(items.iter().copied(), None, true);
        }
        checker.program.library = library.iter().map(|(file, _)| *file).collect();
        checker
    }

    /// Gives imported files with params the prefixes of their params' names.
    fn name_params(&mut self) {
        let has_params = |module: &usize| self.params.iter().any(|param| param.module == *module);
        let path = |module: usize| Some((module, self.modules[module].path?));
        let files = (0..self.modules.len()).filter(has_params).filter_map(path);
        let (modules, paths): (Vec<_>, Vec<_>) = files.filter(|(_, path)| !path.is_empty()).unzip();
        for (module, prefix) in modules.into_iter().zip(import::param_prefixes(&paths)) {
            self.modules[module].param_prefix = prefix;
        }
    }

    /// Adds a diagnostic. During an attempt it may be discarded later.
    fn report(&mut self, found: Diagnostic) {
        self.body.attempts.last_mut().unwrap_or(&mut self.diagnostics).push(found);
    }

    /// The result, with at most one diagnostic per position, in the order of positions. If there
    /// are errors, warnings about unused names are dropped: a body with errors may not use all
    /// that it declares.
    fn finish(mut self) -> (Program, Vec<Diagnostic>) {
        self.check_order();
        let mut found = std::mem::take(&mut self.diagnostics);
        if has_errors(&found) {
            found.retain(|found| found.code != sdfc_diagnostics::Code::UNUSED);
        }
        let mut spans = FxHashSet::default();
        found.retain(|found| spans.insert(found.span));
        found.sort_by_key(|found| (found.span.file, found.span.start, found.span.end));
        (self.program, found)
    }

    /// Runs a function with enough stack for deeply nested types and expressions.
    fn with_stack<T>(&mut self, run: impl FnOnce(&mut Self) -> T) -> T {
        stacker::maybe_grow(128 * 1024, 1024 * 1024, || run(self))
    }
}

/// A value for which no further errors are reported.
fn poison(span: Span) -> Expr {
    Expr { kind: ExprKind::Error, ty: Type::Error, span }
}

/// A signature that is shared while bodies are checked.
type Shared<'a> = Rc<decl::Signature<'a>>;
