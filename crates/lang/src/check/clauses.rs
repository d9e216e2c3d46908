//! The clauses of declarations: `exact`, `bound`, `lipschitz`, `bounds`, `material`, `intersect`,
//! `copies` and `require`.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::Dim;
use sdfc_syntax::ast::{self, ClauseKind, DeclKind, Side};

use super::coerce::Role;
use super::{Checker, types};
use crate::hir::{Expr, Intersect, Promise, Require, Type};

/// The checked clauses of a shape or function.
#[derive(Default)]
pub(super) struct Clauses {
    pub requires: Vec<Require>,
    pub promises: Vec<Promise>,
    pub lipschitz: Option<Expr>,
    pub everywhere: bool,
    pub bounds: Option<Expr>,
    pub material: Option<Expr>,
    pub intersect: Option<Intersect>,
    pub copies: Option<Span>,
}

impl<'a> Checker<'a> {
    /// `material e`: a material, or a number made of samples.
    pub(super) fn check_material(&mut self, e: &'a ast::Expr) -> Expr {
        let value = self.infer(e);
        match value.ty {
            Type::Material | Type::Error => value,
            _ if types::is_scalar(&value.ty) => value,
            _ => self.coerce(value, &Type::Material, Role::The("the value of `material`")),
        }
    }

    /// `intersect e`: an interval `[enter, exit]` or a list of intervals, in terms of the ray's
    /// origin `o` and direction `d`.
    fn check_intersect(&mut self, kind: DeclKind, e: &'a ast::Expr) -> Intersect {
        if kind != DeclKind::Solid {
            self.report_rays("intersect", e.span);
        }
        let mark = self.body.enter();
        let space = types::point(Dim::Three);
        let [origin, direction] = [self.body.fresh(), self.body.fresh()];
        self.body.declare_implicit(origin, "o", space.clone(), e.span);
        self.body.declare_implicit(direction, "d", space, e.span);
        let value = self.infer(e);
        let interval = Type::Vec(2);
        let intervals = Type::List(Box::new(interval.clone()));
        let value = if value.ty == intervals {
            value
        } else {
            self.coerce(value, &interval, Role::The("the value of `intersect`"))
        };
        self.body.leave(mark);
        Intersect { origin, direction, value }
    }

    /// Reports a clause about 3D rays on a declaration that is not a solid.
    fn report_rays(&mut self, clause: &str, span: Span) {
        let message = format!("only a `solid` can have the clause `{clause}`: it is about 3D rays");
        self.report(Diagnostic::error(Code::MISPLACED_CLAUSE, span, message));
    }

    /// Checks the clauses of a declaration, except `material`, which can use `p`.
    pub(super) fn check_clauses(&mut self, decl: &'a ast::Decl) -> Clauses {
        let mut clauses = Clauses::default();
        let mut material = false;
        for clause in &decl.signature.clauses {
            // The parser has already reported clauses of shapes on a `fn`.
            if self.body.point.is_none() && !belongs_to_functions(&clause.kind) {
                continue;
            }
            let twice = match &clause.kind {
                ClauseKind::Exact(side, condition) => {
                    let promise = self.check_promise(true, *side, condition.as_ref(), clause.span);
                    clauses.promises.push(promise);
                    false
                }
                ClauseKind::Bound(side, condition) => {
                    let promise = self.check_promise(false, *side, condition.as_ref(), clause.span);
                    clauses.promises.push(promise);
                    false
                }
                ClauseKind::Lipschitz(e, everywhere) => {
                    clauses.everywhere = *everywhere;
                    let role = Role::The("the Lipschitz constant");
                    clauses.lipschitz.replace(self.check_expr(e, &Type::Number, role)).is_some()
                }
                ClauseKind::Bounds(e) => {
                    let dim = self.body.point.unwrap_or(Dim::Three);
                    let ty = Type::Range(Box::new(types::point(dim)));
                    let bounds = self.check_expr(e, &ty, Role::The("the value of `bounds`"));
                    clauses.bounds.replace(bounds).is_some()
                }
                ClauseKind::Material(_) => std::mem::replace(&mut material, true),
                ClauseKind::Intersect(e) => {
                    let intersect = self.check_intersect(decl.kind, e);
                    clauses.intersect.replace(intersect).is_some()
                }
                ClauseKind::Copies => {
                    if decl.kind != DeclKind::Solid {
                        self.report_rays("copies", clause.span);
                    }
                    clauses.copies.replace(clause.span).is_some()
                }
                ClauseKind::Require(condition, message) => {
                    clauses.requires.push(self.check_require(condition, message, clause.span));
                    false
                }
            };
            if twice {
                let message = "this clause appears twice";
                self.report(Diagnostic::error(Code::MISPLACED_CLAUSE, clause.span, message));
            }
        }
        clauses
    }

    /// `require condition, "message"`
    pub(super) fn check_require(
        &mut self,
        condition: &'a ast::Expr,
        message: &ast::Name,
        span: Span,
    ) -> Require {
        let role = Role::The("the condition of `require`");
        let condition = self.check_expr(condition, &Type::Bool, role);
        Require { condition, message: message.text.clone(), span }
    }

    fn check_promise(
        &mut self,
        exact: bool,
        side: Option<Side>,
        condition: Option<&'a ast::Expr>,
        span: Span,
    ) -> Promise {
        let role = Role::The("the condition of this clause");
        Promise {
            exact,
            outside: side != Some(Side::Inside),
            inside: side != Some(Side::Outside),
            condition: condition.map(|e| self.check_expr(e, &Type::Bool, role)),
            span,
        }
    }
}

/// True for clauses that a `fn` can have.
fn belongs_to_functions(clause: &ClauseKind) -> bool {
    match clause {
        ClauseKind::Lipschitz(..) | ClauseKind::Require(..) => true,
        ClauseKind::Exact(..)
        | ClauseKind::Bound(..)
        | ClauseKind::Bounds(_)
        | ClauseKind::Material(_)
        | ClauseKind::Intersect(_)
        | ClauseKind::Copies => false,
    }
}
