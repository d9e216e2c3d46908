//! Facts about shapes, which the caller gets from the compiler.

use std::ops::Range;

use sdfc_diagnostics::Span;
use sdfc_lang::hir::Type;
use sdfc_syntax::ast::{Expr, ExprKind, Item};

use crate::analysis::{Analysis, Referent};
use crate::declaration::{Declared, declared};
use crate::edit::range;
use crate::tree::{Node, path};

/// Facts about the shapes that one call in a scene made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShapeFacts {
    /// The promises of the field, and its Lipschitz constant.
    pub quality: String,
    /// Its operations, and their share of the scene.
    pub cost: String,
}

/// Returns the facts about the shapes that a call made; `None` if it made none that is drawn. The
/// argument is the byte range of the whole call. The scene is compiled when it is asked.
pub type Facts<'f> = dyn FnMut(Range<usize>) -> Option<ShapeFacts> + 'f;

/// A line of text above a part of the code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lens {
    /// The part of the code.
    pub range: Range<usize>,
    /// The text.
    pub label: String,
}

/// The most shapes that have lenses. Editors ask for lenses after each edit, and compiling a scene
/// with more shapes takes too long for that.
const MAX_LENSES: usize = 400;

/// Returns the cost of each shape that the scene draws; nothing if these are more than 400.
pub fn lenses(analysis: &Analysis, facts: &mut Facts<'_>) -> Vec<Lens> {
    let mut drawn = Vec::new();
    for item in &analysis.tree.items {
        let Item::Expr(e) = item else { continue };
        let call = made_by(analysis, e).filter(|call| is_shape(analysis, *call));
        drawn.extend(call.map(|call| (range(e.span), range(call))));
    }
    if drawn.len() > MAX_LENSES {
        return Vec::new();
    }
    let lens = |(range, call)| Some(Lens { range, label: facts(call)?.cost });
    drawn.into_iter().filter_map(lens).collect()
}

/// Returns the facts about the shape that the name at a byte offset stands for: that of a `let`,
/// or that of the call or the operator.
pub fn facts_at(analysis: &Analysis, offset: usize, facts: &mut Facts<'_>) -> Option<ShapeFacts> {
    let at = analysis.occurrence(offset)?;
    let call = of_let(analysis, &at.referent).or_else(|| {
        let around = path(&analysis.tree, at.span.start as usize).into_iter().rev();
        around.filter_map(Node::expr).find(|e| head(e) == Some(at.span)).map(|e| e.span)
    });
    let call = call.filter(|call| is_shape(analysis, *call))?;
    facts(range(call))
}

fn is_shape(analysis: &Analysis, e: Span) -> bool {
    matches!(analysis.uses.types.get(&e), Some(Type::Shape(_)))
}

/// The name or the operator of a call.
fn head(e: &Expr) -> Option<Span> {
    if let ExprKind::Binary(_, operator, ..) = &e.kind {
        return Some(*operator);
    }
    let ExprKind::Call(callee, _) = &e.kind else { return None };
    Some(if let ExprKind::Field(_, name) = &callee.kind { name.span } else { callee.span })
}

/// The call behind the name of a `let` of the scene.
fn of_let(analysis: &Analysis, referent: &Referent) -> Option<Span> {
    let Referent::Declared(name) = referent else { return None };
    if name.file != analysis.file {
        return None;
    }
    let Some(Declared::Let(it)) = declared(analysis, *name) else { return None };
    made_by(analysis, &it.value)
}

/// The most names of `let`s that are followed to a call.
const MAX_NAMES: usize = 64;

/// The call that an expression stands for, through parentheses and names of `let`s.
fn made_by(analysis: &Analysis, e: &Expr) -> Option<Span> {
    let mut e = e;
    for _ in 0..MAX_NAMES {
        if let ExprKind::Paren(inner) = &e.kind {
            e = inner;
        } else if let ExprKind::Name(_) = &e.kind {
            let at = analysis.occurrence(e.span.start as usize)?;
            let Referent::Declared(name) = &at.referent else { return None };
            let Some(Declared::Let(it)) = declared(analysis, *name) else { return None };
            e = &it.value;
        } else {
            return (e.span.file == analysis.file).then_some(e.span);
        }
    }
    None
}
