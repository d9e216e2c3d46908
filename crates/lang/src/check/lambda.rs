//! Lambdas: `fn(a, b) = body` with the variables that it captures.

use rustc_hash::FxHashSet;
use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_syntax::ast::{self, Arg, ClauseKind, ExprKind as Ast};

use super::coerce::Role;
use super::types;
use super::{Checker, poison};
use crate::hir::{Expr, ExprKind, Lambda, LocalId, Require, Type};

/// Parameter types and result type of the expected function.
pub(super) type Expected<'t> = Option<(&'t [Type], &'t Type)>;

/// No expected type.
pub(super) const NOTHING_EXPECTED: Expected<'static> = None;

impl<'a> Checker<'a> {
    /// Checks a lambda. A parameter without a type has the expected type, or `number`. The result
    /// is coerced to the declared type, or to the expected one.
    pub(super) fn lambda(
        &mut self,
        signature: &'a ast::Signature,
        body: &'a ast::Expr,
        span: Span,
        expected: Expected,
    ) -> Expr {
        let expected = expected.filter(|(types, _)| types.len() == signature.parms.len());
        let parameters = self.lambda_parameters(signature, expected.map(|(types, _)| types));
        let result = match &signature.result {
            Some(ty) => Some(self.resolve_type(ty)),
            None => expected.map(|(_, result)| result.clone()),
        };
        let captures = self.enter_lambda(signature, body);
        for (parm, ty) in signature.parms.iter().zip(&parameters) {
            self.note_variable(parm.name.span, ty);
            self.body.declare(&parm.name.text, ty.clone(), parm.name.span);
        }
        let (lipschitz, requires) = self.lambda_clauses(signature);
        let body = match &result {
            Some(want) => self.check_expr(body, want, Role::LambdaResult),
            None => self.infer(body),
        };
        let locals = self.leave_lambda(&captures);
        if types::poisoned(&body.ty) {
            return poison(span);
        }
        let ty = Type::Fn(parameters.clone(), Box::new(body.ty.clone()));
        let names = signature.parms.iter().map(|parm| parm.name.text.clone()).collect();
        let lambda = Lambda { captures, parameters, names, locals, lipschitz, requires, body };
        self.limit_type(Expr { kind: ExprKind::Lambda(Box::new(lambda)), ty, span })
    }

    fn lambda_parameters(
        &mut self,
        signature: &'a ast::Signature,
        expected: Option<&[Type]>,
    ) -> Vec<Type> {
        let mut types = Vec::with_capacity(signature.parms.len());
        for (at, parm) in signature.parms.iter().enumerate() {
            if parm.default.is_some() || parm.range.is_some() || parm.variadic {
                let message = "a parameter of a lambda cannot have a default, `in` or `...`";
                self.report(
                    Diagnostic::error(Code::MISPLACED_CLAUSE, parm.span, message)
                        .help("declare a function with a name: fn name(...) = ..."),
                );
            }
            types.push(match (&parm.ty, expected) {
                (Some(ty), _) => self.resolve_type(ty),
                (None, Some(expected)) => expected[at].clone(),
                (None, None) => Type::Number,
            });
        }
        types
    }

    /// Opens a frame whose first variables are those that the lambda captures.
    fn enter_lambda(&mut self, signature: &'a ast::Signature, body: &'a ast::Expr) -> Vec<LocalId> {
        let mut names = Names::default();
        names.signature(signature);
        names.expr(body);
        let mut captures = Vec::new();
        let mut inner = super::body::Frame::default();
        for name in names.in_order {
            if let Some(variable) = self.body.find(name).and_then(|at| self.body.variable(at)) {
                captures.push(variable.id);
                inner.capture(variable);
            }
        }
        self.body.frames.push(inner);
        captures
    }

    /// Closes the frame, marks captured variables as used, and returns the number of locals.
    fn leave_lambda(&mut self, captures: &[LocalId]) -> u32 {
        let Some(inner) = self.body.frames.pop() else { return 0 };
        if let Some(outer) = self.body.frames.last_mut() {
            outer.use_captured(captures, &inner);
        }
        inner.locals
    }

    fn lambda_clauses(&mut self, signature: &'a ast::Signature) -> (Option<Expr>, Vec<Require>) {
        let (mut lipschitz, mut requires) = (None, Vec::new());
        for clause in &signature.clauses {
            match &clause.kind {
                ClauseKind::Lipschitz(e, _) => {
                    let role = Role::The("the Lipschitz constant");
                    lipschitz = Some(self.check_expr(e, &Type::Number, role));
                }
                ClauseKind::Require(condition, message) => {
                    requires.push(self.check_require(condition, message, clause.span));
                }
                ClauseKind::Exact(..)
                | ClauseKind::Bound(..)
                | ClauseKind::Bounds(_)
                | ClauseKind::Material(_)
                | ClauseKind::Intersect(_)
                | ClauseKind::Copies => {} // reported by the parser
            }
        }
        (lipschitz, requires)
    }

    /// The number of parameters of a lambda or named function; `None` for other expressions.
    pub(super) fn arity(&mut self, e: &'a ast::Expr) -> Option<usize> {
        match &e.kind {
            Ast::Lambda(signature, _) => Some(signature.parms.len()),
            Ast::Paren(inner) | Ast::Block(_, inner) | Ast::If(_, inner, _) => self.arity(inner),
            Ast::Name(name) => match self.look_up(name)? {
                super::names::Found::Builtin(super::kernel::Builtin::Math(math)) => {
                    Some(math.arity.unwrap_or(2))
                }
                super::names::Found::Decls(decls) => {
                    Some(self.decls[decls.first()?.0].ast.signature.parms.len())
                }
                found => arity_of(&self.value_of(&found, name, e.span).ty),
            },
            _ => None,
        }
    }
}

/// The number of parameters of a function type.
pub(super) fn arity_of(ty: &Type) -> Option<usize> {
    match ty {
        Type::Fn(parameters, _) => Some(parameters.len()),
        _ => None,
    }
}

/// All names that occur in a syntax tree, each once, in order.
#[derive(Default)]
struct Names<'a> {
    in_order: Vec<&'a str>,
    seen: FxHashSet<&'a str>,
}

impl<'a> Names<'a> {
    fn name(&mut self, name: &'a str) {
        if self.seen.insert(name) {
            self.in_order.push(name);
        }
    }

    fn signature(&mut self, signature: &'a ast::Signature) {
        for clause in &signature.clauses {
            match &clause.kind {
                ClauseKind::Lipschitz(e, _) | ClauseKind::Require(e, _) => self.expr(e),
                ClauseKind::Exact(..)
                | ClauseKind::Bound(..)
                | ClauseKind::Bounds(_)
                | ClauseKind::Material(_)
                | ClauseKind::Intersect(_)
                | ClauseKind::Copies => {}
            }
        }
    }

    fn expr(&mut self, e: &'a ast::Expr) {
        stacker::maybe_grow(64 * 1024, 1024 * 1024, || match &e.kind {
            Ast::Number { .. } | Ast::Color(_) | Ast::Text(_) | Ast::Bool(_) | Ast::Error => {}
            Ast::Name(name) => self.name(name),
            Ast::Paren(inner) | Ast::Unary(_, inner) => self.expr(inner),
            Ast::Block(lets, result) => {
                lets.iter().for_each(|item| self.expr(&item.value));
                self.expr(result);
            }
            Ast::If(a, b, c) => [a, b, c].into_iter().for_each(|e| self.expr(e)),
            Ast::Lambda(signature, body) => {
                self.signature(signature);
                self.expr(body);
            }
            Ast::List(elements) => elements.iter().for_each(|element| self.element(element)),
            Ast::Record(fields) => fields.iter().for_each(|field| self.expr(&field.value)),
            Ast::Call(callee, args) => {
                self.expr(callee);
                args.iter().for_each(|Arg { value, .. }| self.element(value));
            }
            // In `x.f(...)`, `f` is looked up like any other name.
            Ast::Field(base, name) => {
                self.expr(base);
                self.name(&name.text);
            }
            Ast::Index(a, b) | Ast::Binary(_, _, a, b) => {
                self.expr(a);
                self.expr(b);
            }
        });
    }

    fn element(&mut self, element: &'a ast::Element) {
        match element {
            ast::Element::Expr(e) => self.expr(e),
            ast::Element::For(each) => {
                self.expr(&each.over);
                each.condition.iter().for_each(|e| self.expr(e));
                self.element(&each.body);
            }
        }
    }
}
