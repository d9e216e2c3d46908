//! A scene that was parsed and checked, with the positions of all its names.

use std::sync::OnceLock;

use rustc_hash::FxHashMap;
use sdfc_diagnostics::{Diagnostic, FileId, Sources, Span};
use sdfc_lang::Resolver;
use sdfc_lang::hir::Program;
use sdfc_lang::import::{Imported, locate};
use sdfc_lang::inspect::{Inspection, inspect, inspect_at};
use sdfc_lang::uses::{Target, Uses};
use sdfc_syntax::ast::{self, Item};

use crate::library::library;
use crate::tree::{Node, nodes};

/// The thing that a name refers to.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Referent {
    /// Something whose declared name has this span.
    Declared(Span),
    /// The point `p`, or the ray's origin `o` or direction `d`.
    Implicit,
    /// A name of the kernel.
    Kernel(&'static str),
    /// A setting.
    Setting(&'static str),
    /// A parameter of a kernel function or a setting: kind and name of the callee, and its name.
    Parameter(&'static str, &'static str, String),
    /// A word of a type.
    Type(String),
}

/// A name in the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// Its position.
    pub span: Span,
    /// The thing that it refers to.
    pub referent: Referent,
    /// True if it declares what it refers to.
    pub declares: bool,
}

/// A scene with its imports, parsed and checked.
#[derive(Debug)]
pub struct Analysis {
    pub(crate) sources: Sources,
    pub(crate) file: FileId,
    /// See [`Resolver::scene_path`].
    scene_path: String,
    pub(crate) program: Program,
    pub(crate) tree: ast::File,
    pub(crate) imports: Vec<Imported>,
    pub(crate) uses: Uses,
    pub(crate) found: Vec<Diagnostic>,
    /// See [`Analysis::index_declarations`].
    declared: OnceLock<FxHashMap<Span, usize>>,
    /// See [`Analysis::occurrences`].
    occurrences: OnceLock<Vec<Occurrence>>,
}

impl Analysis {
    /// Parses and checks a scene. `name` is its path in messages and locations; imported files are
    /// named by paths beside it.
    pub fn new(name: &str, text: &str, resolver: &dyn Resolver) -> Self {
        let mut sources = Sources::new();
        let file = sources.add(name, text);
        let inspection = inspect(&mut sources, file, resolver);
        Self::of(sources, (file, resolver.scene_path()), inspection)
    }

    /// Parses and checks a scene in which the name `cursor` marks the position of the cursor.
    pub(crate) fn at_cursor(name: &str, text: &str, resolver: &dyn Resolver, cursor: &str) -> Self {
        let mut sources = Sources::new();
        let file = sources.add(name, text);
        let inspection = inspect_at(&mut sources, file, resolver, cursor);
        Self::of(sources, (file, resolver.scene_path()), inspection)
    }

    fn of(sources: Sources, (file, path): (FileId, &str), inspection: Inspection) -> Self {
        let Inspection { program, tree, imports, uses, diagnostics: found } = inspection;
        let (scene_path, declared, occurrences) =
            (path.to_owned(), OnceLock::new(), OnceLock::new());
        Self {
            sources,
            file,
            scene_path,
            program,
            tree,
            imports,
            uses,
            found,
            declared,
            occurrences,
        }
    }

    /// The text of the scene.
    pub fn text(&self) -> &str {
        self.sources.text(self.file)
    }

    /// The name of the scene.
    pub fn name(&self) -> &str {
        self.sources.name(self.file)
    }

    /// The names of the files that the scene imports, directly or not.
    pub fn imported(&self) -> impl Iterator<Item = &str> {
        self.imports.iter().map(|import| self.sources.name(import.file))
    }

    /// The text of a file of this analysis.
    pub fn text_of(&self, name: &str) -> Option<&str> {
        let mut ids = (0..self.sources.len() as u32).map(FileId);
        ids.find(|id| self.sources.name(*id) == name).map(|id| self.sources.text(id))
    }

    /// The tree of a file.
    pub(crate) fn tree_of(&self, file: FileId) -> Option<&ast::File> {
        if file == self.file {
            return Some(&self.tree);
        }
        let import = self.imports.iter().find(|import| import.file == file);
        import.map(|import| &import.tree).or_else(|| library().tree(file))
    }

    /// The file that an import of the scene names, if it was read.
    pub(crate) fn imported_file(&self, written: &str) -> Option<&Imported> {
        let path = locate(&self.scene_path, written).ok()?;
        self.imports.iter().find(|import| import.path == path)
    }

    /// The trees of the scene and its imports.
    pub(crate) fn trees(&self) -> impl Iterator<Item = &ast::File> {
        std::iter::once(&self.tree).chain(self.imports.iter().map(|import| &import.tree))
    }

    /// The name at a byte offset of the scene. A cursor behind the last letter counts.
    pub(crate) fn occurrence(&self, offset: usize) -> Option<&Occurrence> {
        let of_scene = self.occurrences().iter().filter(|it| it.span.file == self.file);
        let holds =
            |it: &&Occurrence| it.span.start as usize <= offset && offset <= it.span.end as usize;
        of_scene.filter(holds).max_by_key(|it| it.span.start)
    }

    /// The source text of a span.
    pub(crate) fn slice(&self, span: Span) -> &str {
        self.sources.slice(span)
    }

    /// The declaration in a file or in the library whose name has this span.
    pub(crate) fn declaration(&self, name: Span) -> Option<&ast::Decl> {
        library().declaration(name).or_else(|| {
            let at = self.declared.get_or_init(|| self.index_declarations()).get(&name)?;
            self.tree_of(name.file)?.items.get(*at)?.as_decl()
        })
    }

    /// The index of each declaration among the items of its file, by the span of its name.
    fn index_declarations(&self) -> FxHashMap<Span, usize> {
        let items = self.trees().flat_map(|tree| tree.items.iter().enumerate());
        items.filter_map(|(at, item)| Some((item.as_decl()?.name.span, at))).collect()
    }

    /// The names of the scene and its imports, by position. They are found when they are first
    /// asked for: diagnostics and completion do without.
    pub(crate) fn occurrences(&self) -> &[Occurrence] {
        self.occurrences.get_or_init(|| self.find_occurrences())
    }

    fn find_occurrences(&self) -> Vec<Occurrence> {
        let declared =
            |span| Occurrence { span, referent: Referent::Declared(span), declares: true };
        let mut all = Vec::new();
        for node in self.trees().flat_map(|tree| nodes(&tree.items)) {
            match node {
                Node::Item(Item::Param(it)) => all.push(declared(it.name.span)),
                Node::Item(Item::Decl(it)) => all.push(declared(it.name.span)),
                Node::Item(Item::Let(it)) => all.push(declared(it.name.span)),
                Node::Item(Item::Import(_) | Item::Expr(_)) => {}
                Node::Parm(it) => all.push(declared(it.name.span)),
                Node::Let(it) => all.push(declared(it.name.span)),
                Node::For(it) => all.push(declared(it.name.span)),
                Node::Type(it) => {
                    if let ast::TypeExprKind::Named(word) = &it.kind {
                        let referent = Referent::Type(word.clone());
                        all.push(Occurrence { span: it.span, referent, declares: false });
                    }
                }
                Node::Signature(_) | Node::Clause(_) | Node::Expr(_) | Node::Arg(_) => {}
            }
        }
        for (span, target) in &self.uses.targets {
            let referent = match *target {
                Target::Declared(span) => Referent::Declared(span),
                Target::Implicit => Referent::Implicit,
                Target::Kernel(name) => Referent::Kernel(name),
                Target::Setting(name) => Referent::Setting(name),
            };
            all.push(Occurrence { span: *span, referent, declares: false });
        }
        all.extend(self.named_arguments());
        all.sort_by_key(|it| (it.span, !it.declares));
        all.dedup_by_key(|it| it.span);
        all
    }

    /// The names of named arguments.
    fn named_arguments(&self) -> Vec<Occurrence> {
        let mut all = Vec::new();
        for (callee, call) in &self.uses.calls {
            let Some(target) = self.uses.targets.get(callee) else { continue };
            for argument in &call.arguments {
                let (Some(span), Some(name)) =
                    (argument.name, call.parameters.get(argument.parameter))
                else {
                    continue;
                };
                let referent = match *target {
                    Target::Declared(of) => {
                        let parms = self.declaration(of).map(|decl| &decl.signature.parms);
                        let parm = parms.and_then(|parms| parms.get(argument.parameter));
                        parm.map(|parm| Referent::Declared(parm.name.span))
                    }
                    Target::Implicit => None,
                    Target::Kernel(of) => Some(Referent::Parameter("kernel", of, name.clone())),
                    Target::Setting(of) => Some(Referent::Parameter("setting", of, name.clone())),
                };
                all.extend(referent.map(|referent| Occurrence { span, referent, declares: false }));
            }
        }
        all
    }
}
