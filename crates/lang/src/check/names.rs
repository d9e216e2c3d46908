//! Name resolution: files, scopes, and suggestions for unknown names.
//!
//! A name is looked up in blocks, parameters, the file, imports, the library and the kernel, in
//! this order.

use rustc_hash::FxHashMap;
use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::Dim;
use sdfc_syntax::ast::{self, DeclKind, Item};

use super::body::LocalIndex;
use super::kernel::{self, Builtin};
use super::{Checker, DeclIndex, LetIndex, ParamIndex, types};
use crate::settings::SettingRow;
use crate::spelling::{Meant, meant};

/// The item that a top-level name of a file refers to.
#[derive(Clone, Debug)]
pub(super) enum Entry {
    /// One declaration, or one for solids and one for regions.
    Decls(Vec<DeclIndex>),
    /// A `let`, visible after its end.
    Let(LetIndex),
    /// A `param`, visible after its end.
    Param(ParamIndex),
}

/// A file.
#[derive(Debug)]
pub(super) struct Module<'a> {
    /// Its path below the folder of the scene; empty for the scene itself, `None` for the library.
    pub path: Option<&'a str>,
    /// The prefix of the names of its params; empty for the scene itself.
    pub param_prefix: String,
    /// True if all of it was parsed.
    pub whole: bool,
    /// Its own top-level names.
    pub names: FxHashMap<&'a str, Entry>,
    /// The names that it imports.
    pub imports: FxHashMap<&'a str, ImportedName>,
}

/// An imported name.
#[derive(Clone, Debug)]
pub(super) struct ImportedName {
    /// The item in the file that declares it; `None` if an error was reported.
    pub entry: Option<Entry>,
    /// The span of the import.
    pub span: Span,
    /// True if something uses it.
    pub used: bool,
}

/// The item that a name refers to at some position.
#[derive(Clone, Debug)]
pub(super) enum Found {
    /// A variable of the current body.
    Local(LocalIndex),
    /// A file-level `let`.
    Let(LetIndex),
    /// A `param`.
    Param(ParamIndex),
    /// A declaration, or one for solids and one for regions.
    Decls(Vec<DeclIndex>),
    /// A name of the kernel.
    Builtin(Builtin),
    /// A setting: the index of its row.
    Setting(usize),
    /// An import that failed and was reported.
    Poisoned,
}

/// The kernel's function with the name of a library entry, such as `round`.
pub(super) fn kernel_alternative(name: &str) -> Option<Builtin> {
    kernel::builtin(name).filter(|builtin| matches!(builtin, Builtin::Math(_)))
}

impl<'a> Checker<'a> {
    /// Adds a file with its declarations, lets, params and names. Returns its index.
    pub(super) fn add_module(
        &mut self,
        items: impl IntoIterator<Item = &'a Item>,
        path: Option<&'a str>,
        library: bool,
    ) -> usize {
        let module = self.modules.len();
        let (names, imports) = Default::default();
        self.modules.push(Module {
            path,
            param_prefix: String::new(),
            whole: true,
            names,
            imports,
        });
        for item in items {
            match item {
                Item::Decl(decl) => self.add_decl(module, decl),
                Item::Let(item) => {
                    let index = LetIndex(self.lets.len());
                    self.lets.push(super::LetInfo::new(item, module));
                    self.add_name(module, &item.name, Entry::Let(index));
                }
                Item::Param(item) => {
                    if path == Some("") {
                        self.refuse_clock(&item.name);
                    }
                    let index = ParamIndex(self.params.len());
                    self.params.push(super::ParamInfo::new(item, module));
                    self.add_name(module, &item.name, Entry::Param(index));
                }
                Item::Import(_) | Item::Expr(_) => {}
            }
        }
        if library {
            let public = self.modules[module].names.iter().filter(|(name, _)| !is_private(name));
            self.library.extend(public.map(|(name, entry)| (*name, entry.clone())));
        }
        module
    }

    fn add_decl(&mut self, module: usize, decl: &'a ast::Decl) {
        let index = DeclIndex(self.decls.len());
        self.decls.push(super::DeclInfo {
            ast: decl,
            module,
            generic: types::is_generic(decl.kind, &decl.signature),
            used: false,
        });
        let name = decl.name.text.as_str();
        if let Some(Entry::Decls(others)) = self.modules[module].names.get_mut(name)
            && let [other] = others[..]
            && two_dimensions(self.decls[other.0].ast, decl)
        {
            others.push(index);
            return;
        }
        self.add_name(module, &decl.name, Entry::Decls(vec![index]));
    }

    fn add_name(&mut self, module: usize, name: &'a ast::Name, entry: Entry) {
        let Some(first) = self.modules[module].names.get(name.text.as_str()) else {
            self.modules[module].names.insert(&name.text, entry);
            return;
        };
        let first = self.entry_span(first);
        let message = format!("`{}` is declared twice in this file", name.text);
        self.report(
            Diagnostic::error(Code::DECLARED_TWICE, name.span, message)
                .note_at(first, "first declared here")
                .help("rename one of them; only operators of a solid and of a region, or functions of a vec2 and of a vec3, may share a name"),
        );
    }

    /// Reports a param called `time` or `frame`: hosts set the clock and the params by name. Params
    /// of imported files are safe, since they have the name of their file as a prefix.
    fn refuse_clock(&mut self, name: &ast::Name) {
        if !matches!(kernel::builtin(&name.text), Some(Builtin::Time | Builtin::Frame)) {
            return;
        }
        let message = format!("a param cannot be called `{}`: that name is built in", name.text);
        let help = format!("use `{}` without declaring it, or choose another name", name.text);
        self.report(Diagnostic::error(Code::CLOCK, name.span, message).help(help));
    }

    /// The span of an entry's name.
    pub(super) fn entry_span(&self, entry: &Entry) -> Span {
        match entry {
            Entry::Decls(decls) => self.decls[decls[0].0].ast.name.span,
            Entry::Let(index) => self.lets[index.0].ast.name.span,
            Entry::Param(index) => self.params[index.0].ast.name.span,
        }
    }

    /// Looks up a name at the current position.
    pub(super) fn look_up(&mut self, name: &str) -> Option<Found> {
        self.note_scope(name);
        if let Some(local) = self.body.find(name) {
            return Some(Found::Local(local));
        }
        self.look_up_outside(name)
    }

    /// Looks up a name outside the current body.
    pub(super) fn look_up_outside(&mut self, name: &str) -> Option<Found> {
        let module = self.body.module;
        if let Some(entry) = self.modules[module].names.get(name)
            && self.is_visible(entry)
        {
            return Some(self.found(&entry.clone()));
        }
        if let Some(imported) = self.modules[module].imports.get_mut(name) {
            imported.used = true;
            return Some(match imported.entry.clone() {
                Some(entry) => self.found(&entry),
                None => Found::Poisoned,
            });
        }
        self.look_up_library(name)
    }

    /// Looks up a name in the library and the kernel.
    pub(super) fn look_up_library(&mut self, name: &str) -> Option<Found> {
        if let Some(entry) = self.library.get(name) {
            return Some(self.found(&entry.clone()));
        }
        if let Some(builtin) = kernel::builtin(name) {
            return Some(Found::Builtin(builtin));
        }
        self.settings.iter().position(|row| row.name == name).map(Found::Setting)
    }

    fn found(&mut self, entry: &Entry) -> Found {
        match entry {
            Entry::Decls(decls) => {
                for decl in decls {
                    self.decls[decl.0].used |= self.body.decl != Some(*decl);
                }
                Found::Decls(decls.clone())
            }
            Entry::Let(index) => {
                self.lets[index.0].used = true;
                Found::Let(*index)
            }
            Entry::Param(index) => {
                self.params[index.0].used = true;
                Found::Param(*index)
            }
        }
    }

    /// True if a name is visible at the current position: a `let` or `param` after its end, a
    /// declaration everywhere.
    pub(super) fn is_visible(&self, entry: &Entry) -> bool {
        match entry {
            Entry::Decls(_) => true,
            Entry::Let(index) => self.lets[index.0].ast.span.end <= self.body.position,
            Entry::Param(index) => self.params[index.0].ast.span.end <= self.body.position,
        }
    }

    /// Reports an unknown name.
    pub(super) fn unknown_name(&mut self, name: &str, span: Span) {
        if name == "p" {
            self.report(
                Diagnostic::error(Code::NO_POINT, span, "`p` exists only in a shape's formula").help(
                    match self.body.point {
                        None => "pass a function of the point: fn(q) = q.y",
                        Some(_) => {
                            "clauses and defaults are about the whole shape: use its parameters and `bounds(a)`"
                        }
                    },
                ),
            );
            return;
        }
        let found = Diagnostic::error(Code::UNKNOWN_NAME, span, format!("unknown name `{name}`"));
        let later = self.modules[self.body.module].names.get(name).map(|e| self.entry_span(e));
        let found = match (later, self.suggestion(name)) {
            (Some(later), _) => found
                .note_at(later, "it is declared here and can be used only after this line")
                .help("move that line above this one"),
            (None, Some(meant)) => {
                let here = meant.instead.clone();
                self.call_form(name, &here, meant.add_to(found))
            }
            (None, None) => found,
        };
        self.report(found);
    }

    /// A suggestion for an unknown name.
    fn suggestion(&self, name: &str) -> Option<Meant> {
        let module = &self.modules[self.body.module];
        let file = module.names.iter().filter(|(_, entry)| self.is_visible(entry));
        let names = self
            .body
            .variables()
            .map(|variable| variable.name)
            .chain(file.map(|(name, _)| *name))
            .chain(module.imports.keys().copied())
            .chain(self.library.keys().copied())
            .chain(kernel::ROWS.iter().map(|row| row.name))
            .chain(self.settings.iter().map(|row: &SettingRow| row.name));
        meant(name, names)
    }
}

/// True if a name is private to its file.
pub(super) fn is_private(name: &str) -> bool {
    name.starts_with('_')
}

/// True if two declarations may share a name, because the first argument distinguishes them: a
/// solid and a region, or functions of a vec2 and of a vec3.
fn two_dimensions(a: &ast::Decl, b: &ast::Decl) -> bool {
    let kinds = matches!(
        (a.kind, b.kind),
        (DeclKind::Solid, DeclKind::Region)
            | (DeclKind::Region, DeclKind::Solid)
            | (DeclKind::Fn, DeclKind::Fn)
    );
    kinds && first_dimension(a).is_some() && first_dimension(a) != first_dimension(b)
}

/// The dimension of a declaration's first parameter. In a `fn` only a point has one; elsewhere, a
/// shape, and a type that contains or makes a shape.
pub(super) fn first_dimension(decl: &ast::Decl) -> Option<Dim> {
    fn of(ty: &ast::TypeExpr) -> Option<Dim> {
        match &ty.kind {
            ast::TypeExprKind::Named(word) => match word.as_str() {
                "region" => Some(Dim::Two),
                "solid" => Some(Dim::Three),
                _ => None,
            },
            ast::TypeExprKind::List(ty) => of(ty),
            ast::TypeExprKind::Record(fields) => fields.iter().find_map(|field| of(&field.ty)),
            ast::TypeExprKind::Fn(_, result) => of(result),
        }
    }
    let first = decl.signature.parms.first()?.ty.as_ref()?;
    match (decl.kind, &first.kind) {
        (DeclKind::Fn, ast::TypeExprKind::Named(word)) => match word.as_str() {
            "vec2" => Some(Dim::Two),
            "vec3" => Some(Dim::Three),
            _ => None,
        },
        (DeclKind::Fn, _) => None,
        (DeclKind::Solid | DeclKind::Region | DeclKind::Shape, _) => of(first),
    }
}
