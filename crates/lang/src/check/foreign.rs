//! Calls of functions with the names of Quilez's articles: `sdSphere(p, 1)`, `opRound(a, 0.1)`.

use sdfc_diagnostics::Diagnostic;
use sdfc_graph::Dim;
use sdfc_syntax::ast::{DeclKind, Parm};

use super::Checker;
use super::call::{Callee, Given};
use super::names::{Entry, is_private};
use super::types;
use crate::hir::Expr;
use crate::synonyms::{Quilez, quilez};

impl<'a> Checker<'a> {
    /// Reports a call of an unknown name.
    pub(super) fn unknown_function(&mut self, callee: Callee, mut given: Vec<Given<'a>>) -> Expr {
        self.unknown_name(callee.name, callee.at);
        // The point that such a shape gets is no mistake of its own: the message is about it.
        let is_shape = quilez(callee.name) == Some(Quilez::Shape);
        if is_shape && self.body.point.is_none() && !given.is_empty() {
            given.remove(0);
        }
        self.give_up(given, callee.span)
    }

    /// Adds how to call a shape or an operator of the library, if the unknown name is that of one
    /// of Quilez's functions.
    pub(super) fn call_form(&self, unknown: &str, here: &str, found: Diagnostic) -> Diagnostic {
        let Some(kind) = quilez(unknown) else { return found };
        let Some(Entry::Decls(decls)) = self.library.get(here) else { return found };
        let decls = decls.iter().map(|decl| self.decls[decl.0].ast);
        let Some(decl) = decls.into_iter().find(|decl| decl.kind != DeclKind::Fn) else {
            return found;
        };
        let parms = &decl.signature.parms[..];
        match kind {
            Quilez::Operator => found.help(format!("call it as in `{}`", on_shapes(here, parms))),
            Quilez::Shape if is_private(here) => found,
            Quilez::Shape => {
                let names: Vec<&str> = parms.iter().map(|parm| parm.name.text.as_str()).collect();
                let call = format!("{here}({})", names.join(", "));
                let has_halves = names.iter().any(|name| matches!(*name, "size" | "h" | "width"));
                let sizes = if has_halves { "; sizes are whole, not half" } else { "" };
                let found = found.help(format!("call it without a point: `{call}`{sizes}"));
                match self.body.point {
                    Some(_) => found.help(format!("in a formula, its distance is `{call}(p)`")),
                    None => found,
                }
            }
        }
    }

    /// Adds the way out of a mistake in the body of a `shape` that is right in one dimension alone.
    pub(super) fn advise_dimension(&self, dim: Dim, found: Diagnostic) -> Diagnostic {
        let decl = self.body.decl.map(|decl| self.decls[decl.0].ast);
        let Some(decl) = decl.filter(|decl| decl.kind == DeclKind::Shape) else { return found };
        let (name, word) = (&decl.name.text, types::shape_word(dim));
        found
            .help(format!("`shape {name}` is for solids and regions: `p` is a vec3 or a vec2"))
            .help(format!("for {word}s only, write: {word} {name}(...) = ..."))
    }
}

/// A call of an operator: `union(a, b)`, `a.round(r)`.
fn on_shapes(name: &str, parms: &[Parm]) -> String {
    let takes_shapes = |parm: &&Parm| parm.variadic || matches!(parm.name.text.as_str(), "a" | "b");
    match parms {
        [first, ..] if first.variadic => format!("{name}(a, b)"),
        [_, second, ..] if takes_shapes(&second) => format!("{name}(a, b)"),
        [_, second, ..] => format!("a.{name}({})", second.name.text),
        [_] | [] => format!("a.{name}()"),
    }
}
