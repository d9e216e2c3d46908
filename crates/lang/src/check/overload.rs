//! Overload resolution: which declaration a call refers to, and in which dimension.

use sdfc_diagnostics::Span;
use sdfc_graph::Dim;
use sdfc_syntax::ast::{self, DeclKind};

use super::call::{Callee, Given, Value, is_lambda};
use super::coerce::{Role, region_for_solid, solid_for_region};
use super::decl::Target;
use super::kernel::Builtin;
use super::names;
use super::types;
use super::{Checker, DeclIndex, Shared, poison};
use crate::hir::{Element, Expr, ExprKind, Type};

/// Depth of nested lambdas down to which both dimensions are tried. Each level doubles the number
/// of attempts, so deeper lambdas are checked in 3D only.
const MAX_ATTEMPTS: usize = 4;

/// The declaration or kernel function that a call refers to.
enum Picked<'a> {
    Declared(Shared<'a>),
    Kernel(Builtin),
    /// An error was reported.
    Nothing,
}

impl<'a> Checker<'a> {
    /// Checks a call of a declaration.
    pub(super) fn call_decls(
        &mut self,
        decls: &[DeclIndex],
        callee: Callee,
        mut given: Vec<Given<'a>>,
    ) -> Expr {
        match self.pick(decls, callee, &mut given) {
            Picked::Declared(signature) => {
                if self.wants_other_dimension(decls, &signature, callee, &given) {
                    return self.give_up(given, callee.span);
                }
                let arguments = self.arguments(callee, &signature.parameters, given);
                self.make(&signature, arguments, callee)
            }
            Picked::Kernel(builtin) => self.call_builtin(builtin, callee, given),
            Picked::Nothing => self.give_up(given, callee.span),
        }
    }

    /// Reports an argument that only the other dimension of the name has, such as `z` of
    /// `translate`.
    fn wants_other_dimension(
        &mut self,
        decls: &[DeclIndex],
        signature: &Shared<'a>,
        callee: Callee,
        given: &[Given<'a>],
    ) -> bool {
        let others = decls.iter().map(|decl| self.decls[decl.0].ast).filter(|_| decls.len() > 1);
        let elsewhere: Vec<&str> = others
            .flat_map(|decl| decl.signature.parms.iter().map(|parm| parm.name.text.as_str()))
            .filter(|name| signature.parameters.iter().all(|parameter| parameter.name != *name))
            .collect();
        let named = given.iter().filter_map(|given| given.name);
        let Some(name) = named.into_iter().find(|name| elsewhere.contains(&name.text.as_str()))
        else {
            return false;
        };
        let (span, subject) = (given[0].span, format!("{}'s `{}`", callee.name, name.text));
        let found = match signature.result {
            Type::Shape(Dim::Two) => region_for_solid(span, &format!("{subject} needs a solid")),
            Type::Shape(Dim::Three) => solid_for_region(span, &format!("{subject} needs a region")),
            _ => return false,
        };
        self.report(found);
        true
    }

    /// The call with its checked arguments.
    pub(super) fn make(
        &mut self,
        signature: &Shared<'a>,
        arguments: Vec<Option<Expr>>,
        callee: Callee,
    ) -> Expr {
        let ty = signature.result.clone();
        if types::poisoned(&ty) {
            return poison(callee.span);
        }
        self.needs(signature.target.node(), callee.span);
        if let Some(declared) = self.declared_at(signature.target) {
            self.note_declared(callee.at, declared);
        }
        let kind = match signature.target {
            Target::Fn(id) => ExprKind::Call(id, arguments),
            Target::Shape(id) => ExprKind::Build(id, arguments),
        };
        Expr { kind, ty, span: callee.span }
    }

    /// The span of the name of a declaration.
    fn declared_at(&self, target: Target) -> Option<Span> {
        match target {
            Target::Fn(id) => self.program.functions.get(id.0 as usize).map(|it| it.span),
            Target::Shape(id) => self.program.shapes.get(id.0 as usize).map(|it| it.span),
        }
    }

    /// Selects among the declarations of a name by the type of the first argument. In a declaration
    /// that takes shapes or points of either dimension, the first argument for such a parameter
    /// decides.
    fn pick(&mut self, decls: &[DeclIndex], callee: Callee, given: &mut [Given<'a>]) -> Picked<'a> {
        let first = decls[0];
        let info = &self.decls[first.0];
        let kind = info.ast.kind;
        let kernel = match kind {
            DeclKind::Fn => None,
            DeclKind::Solid | DeclKind::Region | DeclKind::Shape => {
                names::kernel_alternative(callee.name)
            }
        };
        if decls.len() == 1 && !info.generic && kernel.is_none() {
            return self.declared(first, None, callee);
        }
        let at = match decls.len() {
            1 => deciding_parameter(info.ast),
            _ => 0,
        };
        let Some(argument) = argument_of(info.ast, at, given) else {
            return self.declared(first, Some(Dim::Three), callee);
        };
        if let Value::Expr(e) = given[argument].value
            && is_lambda(e)
        {
            return self.pick_by_lambda(decls, callee, at, e, &mut given[argument].value);
        }
        let ty = self.look_at(&mut given[argument]);
        if types::poisoned(&ty) {
            return Picked::Nothing;
        }
        let dim = match kind {
            DeclKind::Fn | DeclKind::Shape if kernel.is_none() => types::dimension_of_point(&ty),
            DeclKind::Fn | DeclKind::Shape | DeclKind::Solid | DeclKind::Region => None,
        };
        match (types::dimension(&ty).or(dim), kernel) {
            (None, Some(builtin)) => Picked::Kernel(builtin),
            (dim, _) => {
                let dim = dim.unwrap_or(Dim::Three);
                self.declared(self.for_dimension(decls, dim), Some(dim), callee)
            }
        }
    }

    /// Checks an argument without an expected type and returns its type.
    pub(super) fn look_at(&mut self, given: &mut Given<'a>) -> Type {
        let (element, ty) = match &given.value {
            Value::Expr(e) => {
                let value = self.infer(e);
                let ty = value.ty.clone();
                (Element::One(value), ty)
            }
            Value::Element(element) => self.element(element, None),
            Value::Done(_, ty) => return ty.clone(),
        };
        given.value = Value::Done(element, ty.clone());
        ty
    }

    /// Selects the dimension for a lambda: 3D, or 2D if 3D has errors; 3D if both have errors.
    fn pick_by_lambda(
        &mut self,
        decls: &[DeclIndex],
        callee: Callee,
        at: usize,
        e: &'a ast::Expr,
        value: &mut Value<'a>,
    ) -> Picked<'a> {
        let mut first = None;
        for dim in [Dim::Three, Dim::Two] {
            let decl = self.for_dimension(decls, dim);
            let Picked::Declared(signature) = self.declared(decl, Some(dim), callee) else {
                return Picked::Nothing;
            };
            let Some(parameter) = signature.parameters.get(at) else {
                return Picked::Declared(signature);
            };
            let want = match &parameter.ty {
                Type::List(of) if parameter.variadic => &**of,
                ty => ty,
            };
            self.body.attempts.push(Vec::new());
            let read = self.check_expr(e, want, Role::Argument(callee.name, parameter.name));
            let found = self.body.attempts.pop().unwrap_or_default();
            let failed = found.iter().any(sdfc_diagnostics::Diagnostic::is_error);
            if !failed || self.body.attempts.len() >= MAX_ATTEMPTS {
                return self.settle(signature, read, found, value);
            }
            first = first.or(Some((signature, read, found)));
        }
        match first {
            Some((signature, read, found)) => self.settle(signature, read, found, value),
            None => Picked::Nothing,
        }
    }

    /// Accepts one of the attempts: reports its diagnostics and keeps its value.
    fn settle(
        &mut self,
        signature: Shared<'a>,
        read: Expr,
        found: Vec<sdfc_diagnostics::Diagnostic>,
        value: &mut Value<'a>,
    ) -> Picked<'a> {
        for found in found {
            self.report(found);
        }
        let ty = read.ty.clone();
        *value = Value::Done(Element::One(read), ty);
        Picked::Declared(signature)
    }

    fn declared(&mut self, decl: DeclIndex, dim: Option<Dim>, callee: Callee) -> Picked<'a> {
        let dim = dim.filter(|_| self.decls[decl.0].generic);
        match self.instance(decl, dim, callee.at) {
            Some(signature) => Picked::Declared(signature),
            None => Picked::Nothing,
        }
    }

    /// The declaration whose first parameter has a dimension; the first declaration if none has.
    fn for_dimension(&self, decls: &[DeclIndex], dim: Dim) -> DeclIndex {
        let takes = |decl: &&DeclIndex| names::first_dimension(self.decls[decl.0].ast) == Some(dim);
        *decls.iter().find(takes).unwrap_or(&decls[0])
    }
}

/// The index of the first parameter that takes a shape of either dimension; 0 if none does.
fn deciding_parameter(decl: &ast::Decl) -> usize {
    let with_point = matches!(decl.kind, DeclKind::Fn | DeclKind::Shape);
    let decides = |parm: &ast::Parm| {
        parm.ty.as_ref().is_some_and(|ty| types::mentions_either(ty, with_point))
    };
    decl.signature.parms.iter().position(decides).unwrap_or(0)
}

/// The index of the argument for the parameter at an index.
fn argument_of(decl: &ast::Decl, at: usize, given: &[Given]) -> Option<usize> {
    let parm = decl.signature.parms.get(at)?;
    let by_name =
        given.iter().position(|given| given.name.is_some_and(|name| name.text == parm.name.text));
    let positional = given.iter().take_while(|given| given.name.is_none()).count();
    by_name.or((at < positional).then_some(at))
}
