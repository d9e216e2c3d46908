//! The outline of a scene.

use std::ops::Range;

use sdfc_diagnostics::Span;
use sdfc_lang::hir::Type;
use sdfc_syntax::ast::{DeclKind, ExprKind, Item};

use crate::analysis::Analysis;
use crate::declaration::{Declared, headline};
use crate::edit::range;
use crate::tree::Node;

/// The kind of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SymbolKind {
    /// `fn`
    Function,
    /// `solid`, `region` or `shape`
    Shape,
    /// `param`
    Param,
    /// `let`
    Let,
    /// A setting.
    Setting,
    /// A solid that is drawn.
    Drawn,
}

/// An item of the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Its name; the start of its text if it has none.
    pub name: String,
    /// Its head, such as `solid knob(r: length = 1)`.
    pub detail: String,
    /// Its kind.
    pub kind: SymbolKind,
    /// All of it.
    pub range: Range<usize>,
    /// Its name.
    pub name_range: Range<usize>,
}

/// The longest name of a solid without a name, in characters.
const LONGEST: usize = 40;

/// Returns the items of the scene, in the order of the text. Imports are left out.
pub fn symbols(analysis: &Analysis) -> Vec<Symbol> {
    analysis.tree.items.iter().filter_map(|item| symbol(analysis, item)).collect()
}

fn symbol(analysis: &Analysis, item: &Item) -> Option<Symbol> {
    let whole = Node::Item(item).span();
    let named = |kind, name: &sdfc_syntax::ast::Name, declared| Symbol {
        name: name.text.clone(),
        detail: headline(analysis, declared),
        kind,
        range: range(whole),
        name_range: range(name.span),
    };
    match item {
        Item::Import(_) => None,
        Item::Param(it) => Some(named(SymbolKind::Param, &it.name, Declared::Param(it))),
        Item::Let(it) => Some(named(SymbolKind::Let, &it.name, Declared::Let(it))),
        Item::Decl(it) => {
            let kind = match it.kind {
                DeclKind::Fn => SymbolKind::Function,
                DeclKind::Solid | DeclKind::Region | DeclKind::Shape => SymbolKind::Shape,
            };
            Some(named(kind, &it.name, Declared::Decl(it)))
        }
        Item::Expr(e) => {
            let callee = if let ExprKind::Call(callee, _) = &e.kind { callee.span } else { e.span };
            let is_setting = matches!(
                analysis.uses.targets.get(&callee),
                Some(sdfc_lang::uses::Target::Setting(_))
            );
            let drawn = matches!(analysis.uses.types.get(&e.span), Some(Type::Shape(_)));
            let (kind, name) = match is_setting && !drawn {
                true => (SymbolKind::Setting, analysis.slice(callee).to_owned()),
                false => (SymbolKind::Drawn, shortened(analysis, e.span)),
            };
            let detail = String::new();
            Some(Symbol { name, detail, kind, range: range(whole), name_range: range(whole) })
        }
    }
}

fn shortened(analysis: &Analysis, span: Span) -> String {
    let text = crate::declaration::one_line(analysis.slice(span));
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
