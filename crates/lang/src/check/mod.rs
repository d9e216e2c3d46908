//! Names and types: from parsed files to a [`Program`] in which nothing is left to guess.
//!
//! Every body of the scene is checked, called or not; bodies of the library only when the
//! scene reaches them. Findings are collected; a value with an error has the type
//! [`Type::Error`], about which nothing more is said.
//!
//! One module per question: what a name means (`names`, `value`), which declaration a call
//! means (`overload`), where its arguments go (`call`, `arguments`), what the kernel takes
//! (`kernel`, `builtins`, `math`, `iterate`), what becomes of operators, brackets, blocks and
//! lambdas, and what fits where (`types`, `coerce`). Declarations are opened when they are first
//! mentioned (`decl`), what stands at top level drives it all (`top`), and circles are found at
//! the end (`order`).
#![allow(
    clippy::wildcard_enum_match_arm,
    reason = "the rule for all other types and forms is an error message, also for new ones"
)]

mod advice;
mod arguments;
mod block;
mod body;
mod builtins;
mod call;
mod coerce;
mod decl;
mod expr;
mod iterate;
pub(crate) mod kernel;
mod lambda;
mod list;
mod math;
mod names;
mod operators;
mod order;
mod overload;
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

/// Checks a scene that stands alone, as [`check_with_imports`] does; imports are errors.
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

/// Checks a scene and what it imports against the library. The program is complete and free of [`Type::Error`]
/// if no error is among the findings, which come in the order of their places.
///
/// Library bodies that the scene does not reach are not looked at; [`check_library`] does that.
///
/// `imports` are the files that [`load`](crate::import::load) gives for the scene; what it could
/// not give, it has reported.
pub fn check_with_imports(
    library: &[(FileId, ast::File)],
    imports: &[Imported],
    scene: (FileId, &ast::File),
) -> (Program, Vec<Diagnostic>) {
    check_items(&whole(library), imports, scene)
}

/// As [`check_with_imports`], with those of the library's items that are given for each of its files.
pub(crate) fn check_items<'a>(
    library: &[(FileId, Vec<&'a Item>)],
    imports: &'a [Imported],
    scene: (FileId, &'a ast::File),
) -> (Program, Vec<Diagnostic>) {
    let mut checker = Checker::new(library);
    for import in imports {
        let module = checker.add_module(&import.tree.items, Some(&import.path), false);
        checker.modules[module].whole = import.whole;
    }
    let module = checker.add_module(&scene.1.items, Some(""), false);
    for (import, module) in imports.iter().zip(library.len()..) {
        checker.check_imported(module, &import.tree);
    }
    checker.check_scene(module, scene);
    checker.finish()
}

/// Checks every declaration of the library, in both dimensions where it has two.
pub fn check_library(library: &[(FileId, ast::File)]) -> (Program, Vec<Diagnostic>) {
    check_library_items(&whole(library))
}

/// As [`check_library`], of the items that are given for each file.
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

/// Position in [`Checker::decls`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct DeclIndex(usize);
/// Position in [`Checker::lets`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct LetIndex(usize);
/// Position in [`Checker::params`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct ParamIndex(usize);

/// A declaration of some file.
#[derive(Debug)]
struct DeclInfo<'a> {
    ast: &'a ast::Decl,
    module: usize,
    /// Checked once per dimension.
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

/// How far a `let` or `param` has come.
#[derive(Clone, Debug)]
enum State<Id> {
    Unseen,
    Open,
    Done(Id, Type),
    /// An error was reported.
    Failed,
}

/// Everything that checking knows, in tables by index.
#[derive(Debug, Default)]
struct Checker<'a> {
    modules: Vec<names::Module<'a>>,
    /// Public names of the library.
    library: FxHashMap<&'a str, names::Entry>,
    settings: Vec<SettingRow>,
    decls: Vec<DeclInfo<'a>>,
    lets: Vec<LetInfo<'a>>,
    params: Vec<ParamInfo<'a>>,
    /// What has been asked for of each declaration, by dimension where it has two.
    instances: FxHashMap<(DeclIndex, Option<Dim>), decl::Instance<'a>>,
    /// Bodies whose type is known and that nobody has looked at yet.
    pending: Vec<decl::Pending<'a>>,
    /// The body at hand.
    body: body::Body<'a>,
    order: order::Order,
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

    /// Adds a finding; while a reading is tried out it may yet be forgotten.
    fn report(&mut self, found: Diagnostic) {
        self.body.attempts.last_mut().unwrap_or(&mut self.diagnostics).push(found);
    }

    /// The result: at most one finding per place, in the order of places. A body with errors
    /// may not mention all that it declares, so beside errors nothing is called unused.
    fn finish(mut self) -> (Program, Vec<Diagnostic>) {
        self.check_order();
        let mut found = std::mem::take(&mut self.diagnostics);
        if has_errors(&found) {
            found.retain(|found| found.code != sdfc_diagnostics::Code::UNUSED);
        }
        let mut places = FxHashSet::default();
        found.retain(|found| places.insert(found.span));
        found.sort_by_key(|found| (found.span.file, found.span.start, found.span.end));
        (self.program, found)
    }

    /// A type that was inferred somewhere deep needs stack for the way there.
    fn with_stack<T>(&mut self, run: impl FnOnce(&mut Self) -> T) -> T {
        stacker::maybe_grow(128 * 1024, 1024 * 1024, || run(self))
    }
}

/// A value about which nothing more is said.
fn poison(span: Span) -> Expr {
    Expr { kind: ExprKind::Error, ty: Type::Error, span }
}

/// A signature that is shared while bodies are checked.
type Shared<'a> = Rc<decl::Signature<'a>>;
