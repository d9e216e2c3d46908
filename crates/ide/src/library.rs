//! The library and the reference, parsed once.

use std::sync::OnceLock;

use rustc_hash::FxHashMap;
use sdfc_diagnostics::{FileId, Sources, Span};
use sdfc_lang::library::{Entry, FILES};
use sdfc_lang::reference;
use sdfc_syntax::ast::{self, Decl, Item};

/// The library's trees and the reference.
#[derive(Debug)]
pub struct Library {
    /// The sources, with the file ids that the library has in every analysis.
    pub sources: Sources,
    trees: Vec<ast::File>,
    /// File and item of each declaration, by the span of its name.
    by_name: FxHashMap<Span, (usize, usize)>,
    /// All entries of the reference.
    pub entries: Vec<Entry>,
}

/// Name and text of each file of the library.
pub fn library_files() -> &'static [(&'static str, &'static str)] {
    FILES
}

/// Returns the library.
pub fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(Library::new)
}

impl Library {
    fn new() -> Self {
        let mut sources = Sources::new();
        // The scene is the first file of an analysis; the library follows.
        sources.add("", "");
        let ids: Vec<FileId> = FILES.iter().map(|(name, text)| sources.add(*name, *text)).collect();
        let trees: Vec<ast::File> =
            ids.iter().map(|id| sdfc_syntax::parse(&sources, *id).0).collect();
        let mut by_name = FxHashMap::default();
        for (file, tree) in trees.iter().enumerate() {
            for (at, item) in tree.items.iter().enumerate() {
                if let Some(decl) = item.as_decl() {
                    by_name.insert(decl.name.span, (file, at));
                }
            }
        }
        Self { sources, trees, by_name, entries: reference::entries() }
    }

    /// All declarations.
    pub fn declarations(&self) -> impl Iterator<Item = &Decl> {
        self.trees.iter().flat_map(|tree| &tree.items).filter_map(Item::as_decl)
    }

    /// The declaration whose name has this span.
    pub fn declaration(&self, name: Span) -> Option<&Decl> {
        let (file, at) = self.by_name.get(&name)?;
        self.trees.get(*file)?.items.get(*at)?.as_decl()
    }

    /// The tree of one of the library's files.
    pub fn tree(&self, file: FileId) -> Option<&ast::File> {
        self.trees.get((file.0 as usize).checked_sub(1)?)
    }

    /// The entry of a kernel name, a setting or a type.
    pub fn entry(&self, kind: &str, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.kind == kind && entry.name == name)
    }
}
