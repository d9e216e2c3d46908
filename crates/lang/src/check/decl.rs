//! Declarations. A signature is checked when it is first mentioned, a body later.

use std::rc::Rc;

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::Dim;
use sdfc_syntax::ast::{self, ClauseKind, DeclKind, Parm};

use super::body::Body;
use super::clauses::Clauses;
use super::coerce::Role;
use super::order::Node;
use super::{Checker, DeclIndex, Shared, poison, types};
use crate::hir::{Expr, FnId, Function, LocalId, Parameter, ShapeDef, ShapeDefId, Type};

/// A parameter, as calls see it.
#[derive(Clone, Debug)]
pub(super) struct ParameterSignature<'a> {
    pub name: &'a str,
    /// The type; a list for a variadic parameter.
    pub ty: Type,
    pub variadic: bool,
    pub optional: bool,
    /// True if neither a type nor a default is written, so that it is a number.
    pub untyped: bool,
    /// The default's source; kernel functions and settings have none.
    pub default: Option<&'a ast::Expr>,
}

/// The declaration that a call refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    Fn(FnId),
    Shape(ShapeDefId),
}

impl Target {
    /// Its node in the dependency graph.
    pub(super) fn node(self) -> Node {
        match self {
            Self::Fn(id) => Node::Fn(id.0),
            Self::Shape(id) => Node::Shape(id.0),
        }
    }
}

/// A declaration in one dimension, as calls see it.
#[derive(Clone, Debug)]
pub(super) struct Signature<'a> {
    pub target: Target,
    pub name: &'a str,
    pub parameters: Vec<ParameterSignature<'a>>,
    pub result: Type,
}

/// The progress of checking a declaration in one dimension.
#[derive(Debug)]
pub(super) enum Instance<'a> {
    /// Its parameters are being checked.
    Opening,
    /// Its result type is being inferred from its body; it is unknown in the signature.
    Inferring(Shared<'a>),
    /// Its signature is known.
    Known(Shared<'a>),
}

/// A body to be checked, with its parameters in scope.
#[derive(Debug)]
pub(super) struct Pending<'a> {
    decl: &'a ast::Decl,
    signature: Shared<'a>,
    parameters: Vec<Parameter>,
    body: Body<'a>,
}

impl<'a> Checker<'a> {
    /// Checks every declaration of a file, in both dimensions where it has two.
    pub(super) fn check_declarations(&mut self, module: usize) {
        for index in (0..self.decls.len()).map(DeclIndex) {
            let info = &self.decls[index.0];
            if info.module != module {
                continue;
            }
            let span = info.ast.name.span;
            let dims: &[_] =
                if info.generic { &[Some(Dim::Three), Some(Dim::Two)] } else { &[None] };
            for dim in dims {
                self.instance(index, *dim, span);
            }
        }
        self.drain();
    }

    /// Checks all pending bodies.
    pub(super) fn drain(&mut self) {
        while let Some(pending) = self.pending.pop() {
            self.with_stack(|checker| checker.check_pending(pending));
        }
    }

    /// The signature of a declaration in a dimension; `None` after an error.
    pub(super) fn instance(
        &mut self,
        index: DeclIndex,
        either: Option<Dim>,
        at: Span,
    ) -> Option<Shared<'a>> {
        let name = &self.decls[index.0].ast.name;
        match self.instances.get(&(index, either)) {
            Some(Instance::Known(signature)) => Some(signature.clone()),
            Some(Instance::Inferring(signature)) => {
                let signature = signature.clone();
                let message = format!("`{}` calls itself, so it needs a result type", name.text);
                self.diagnostics.push(
                    Diagnostic::error(Code::NEEDS_RESULT_TYPE, name.span, message)
                        .note_at(at, "its result type is needed here")
                        .help("write the type after its parameters: `-> number`, `-> solid`"),
                );
                Some(signature)
            }
            Some(Instance::Opening) => {
                let message = format!("a default value of `{}` uses `{}`", name.text, name.text);
                self.report(Diagnostic::error(Code::NEEDS_RESULT_TYPE, at, message));
                None
            }
            None => Some(self.with_stack(|checker| checker.open(index, either))),
        }
    }

    fn open(&mut self, index: DeclIndex, either: Option<Dim>) -> Shared<'a> {
        let (decl, module) = (self.decls[index.0].ast, self.decls[index.0].module);
        self.instances.insert((index, either), Instance::Opening);
        let mut body = Body::new(module, decl.span.start);
        body.either = either;
        body.decl = Some(index);
        body.point = match decl.kind {
            DeclKind::Fn => None,
            DeclKind::Solid => Some(Dim::Three),
            DeclKind::Region => Some(Dim::Two),
            DeclKind::Shape => either,
        };
        let target = self.reserve(decl, body.point);
        body.node = Some(target.node());
        let outer = std::mem::replace(&mut self.body, body);
        let (checked, parameters) = self.check_parameters(decl);
        let result = self.declared_result(decl);
        let known = result.is_some();
        let mut signature = Signature {
            target,
            name: &decl.name.text,
            parameters,
            result: result.unwrap_or(Type::Error),
        };
        let shared = Rc::new(signature.clone());
        let body = std::mem::replace(&mut self.body, outer);
        let pending = Pending { decl, signature: shared.clone(), parameters: checked, body };
        if known {
            self.instances.insert((index, either), Instance::Known(shared.clone()));
            self.pending.push(pending);
            return shared;
        }
        self.instances.insert((index, either), Instance::Inferring(shared));
        signature.result = self.check_pending(pending);
        let shared = Rc::new(signature);
        self.instances.insert((index, either), Instance::Known(shared.clone()));
        shared
    }

    /// Reserves an id in the program; its item is filled in when the body is checked.
    fn reserve(&mut self, decl: &ast::Decl, point: Option<Dim>) -> Target {
        let (name, file, span) = (decl.name.text.clone(), decl.name.span.file, decl.name.span);
        let (parameters, requires, docs) = (Vec::new(), Vec::new(), decl.docs.lines.clone());
        let body = poison(span);
        let lipschitz = None;
        match point {
            None => {
                let locals = 0;
                let function = Function {
                    name,
                    file,
                    span,
                    parameters,
                    locals,
                    requires,
                    lipschitz,
                    body,
                    docs,
                };
                self.program.functions.push(function);
                Target::Fn(FnId(self.program.functions.len() as u32 - 1))
            }
            Some(dim) => {
                self.program.shapes.push(ShapeDef {
                    name,
                    dim,
                    file,
                    span,
                    parameters,
                    locals: 0,
                    requires,
                    promises: Vec::new(),
                    lipschitz,
                    everywhere: false,
                    bounds: None,
                    material: None,
                    intersect: None,
                    copies: None,
                    body,
                    docs,
                });
                Target::Shape(ShapeDefId(self.program.shapes.len() as u32 - 1))
            }
        }
    }

    fn declared_result(&mut self, decl: &ast::Decl) -> Option<Type> {
        let written = decl.signature.result.as_ref().map(|ty| (ty.span, self.resolve_type(ty)));
        match (self.body.point, written) {
            (None, written) => written.map(|(_, ty)| ty),
            (Some(dim), None) => Some(Type::Shape(dim)),
            (Some(dim), Some((span, _))) => {
                let word = types::shape_word(dim);
                let message = format!("a {word} has no result type: its formula gives a length");
                self.report(Diagnostic::error(Code::MISPLACED_CLAUSE, span, message));
                Some(Type::Shape(dim))
            }
        }
    }

    /// Checks the parameters in order; each can use those to its left.
    fn check_parameters(
        &mut self,
        decl: &'a ast::Decl,
    ) -> (Vec<Parameter>, Vec<ParameterSignature<'a>>) {
        let parms = &decl.signature.parms;
        let point = usize::from(self.body.point.is_some());
        if let Some(frame) = self.body.frames.last_mut() {
            frame.locals = (parms.len() + point) as u32;
        }
        let (mut parameters, mut signatures) = (Vec::<Parameter>::new(), Vec::new());
        for (at, parm) in parms.iter().enumerate() {
            let name = parm.name.text.as_str();
            if let Some(first) = parameters.iter().find(|other| other.name == name) {
                let message = format!("two parameters are called `{name}`");
                let found = Diagnostic::error(Code::DECLARED_TWICE, parm.name.span, message)
                    .note_at(first.span, "the first one");
                self.report(found);
            }
            if parm.variadic {
                self.check_variadic(parm, &parameters);
            }
            let parameter = self.check_parameter(parm);
            self.note_variable(parm.name.span, &parameter.ty);
            let (id, untyped) = (LocalId(at as u32), parm.ty.is_none() && parm.default.is_none());
            match untyped {
                true => self.body.declare_untyped(id, name, parm.name.span),
                false => self.body.declare_as(id, name, parameter.ty.clone(), parm.name.span),
            }
            signatures.push(ParameterSignature {
                name,
                ty: parameter.ty.clone(),
                variadic: parm.variadic,
                optional: parameter.default.is_some(),
                untyped,
                default: parm.default.as_ref(),
            });
            parameters.push(parameter);
        }
        (parameters, signatures)
    }

    fn check_variadic(&mut self, parm: &Parm, before: &[Parameter]) {
        let message = match (&parm.default, before.iter().any(|other| other.variadic)) {
            (_, true) => "only one parameter can take any number of arguments",
            (Some(_), false) => "a parameter that takes any number of arguments has no default",
            (None, false) => return,
        };
        self.report(Diagnostic::error(Code::MISPLACED_CLAUSE, parm.span, message));
    }

    fn check_parameter(&mut self, parm: &'a Parm) -> Parameter {
        let name = parm.name.text.as_str();
        let what = format!("the default of `{name}`");
        let (ty, default) = match (&parm.ty, &parm.default) {
            (Some(ty), default) => {
                let ty = self.resolve_type(ty);
                let ty = if parm.variadic { Type::List(Box::new(ty)) } else { ty };
                let default = default.as_ref().map(|e| self.check_expr(e, &ty, Role::The(&what)));
                (ty, default)
            }
            (None, Some(default)) => {
                let mut default = self.infer(default);
                if default.ty == Type::Int {
                    default.ty = Type::Number;
                }
                (default.ty.clone(), Some(default))
            }
            (None, None) => (Type::Number, None),
        };
        let range = parm.range.as_ref().and_then(|range| self.check_values(range, &ty, name));
        let (name, span) = (name.to_owned(), parm.name.span);
        Parameter { name, ty, variadic: parm.variadic, default, range, span }
    }

    /// Checks `in lo..hi` of a parameter or param.
    pub(super) fn check_values(
        &mut self,
        range: &'a ast::Expr,
        ty: &Type,
        name: &str,
    ) -> Option<Expr> {
        let ends = match ty {
            Type::Int | Type::Number => Type::Number,
            Type::Angle | Type::Vec(_) => ty.clone(),
            Type::Error => return None,
            _ => {
                let message = format!("`in` is for numbers; `{name}` is {}", types::describe(ty));
                self.report(Diagnostic::error(Code::TYPE_MISMATCH, range.span, message));
                return None;
            }
        };
        let ty = Type::Range(Box::new(ends));
        Some(self.check_expr(range, &ty, Role::The(&format!("the range of `{name}`"))))
    }

    /// Checks a body, puts it into the program and returns its type.
    fn check_pending(&mut self, pending: Pending<'a>) -> Type {
        let Pending { decl, signature, parameters, body } = pending;
        let outer = std::mem::replace(&mut self.body, body);
        let mut clauses = self.check_clauses(decl);
        let formula = self.check_formula(decl, &signature, &mut clauses);
        let ty = formula.ty.clone();
        let body = std::mem::replace(&mut self.body, outer);
        let locals = body.frames.first().map_or(0, |frame| frame.locals);
        let Clauses {
            requires,
            promises,
            lipschitz,
            everywhere,
            bounds,
            material,
            intersect,
            copies,
        } = clauses;
        match signature.target {
            Target::Fn(FnId(id)) => {
                if let Some(function) = self.program.functions.get_mut(id as usize) {
                    function.parameters = parameters;
                    function.locals = locals;
                    function.requires = requires;
                    function.lipschitz = lipschitz;
                    function.body = formula;
                }
            }
            Target::Shape(ShapeDefId(id)) => {
                if let Some(shape) = self.program.shapes.get_mut(id as usize) {
                    shape.parameters = parameters;
                    shape.locals = locals;
                    shape.requires = requires;
                    shape.promises = promises;
                    shape.lipschitz = lipschitz;
                    shape.everywhere = everywhere;
                    shape.bounds = bounds;
                    shape.material = material;
                    shape.intersect = intersect;
                    shape.copies = copies;
                    shape.body = formula;
                }
            }
        }
        ty
    }

    /// Checks the body, and for a shape the material rule. Only these can use `p`.
    fn check_formula(
        &mut self,
        decl: &'a ast::Decl,
        signature: &Shared<'a>,
        clauses: &mut Clauses,
    ) -> Expr {
        let Some(dim) = self.body.point else {
            return match decl.signature.result {
                None => self.infer(&decl.body),
                Some(_) => {
                    self.check_expr(&decl.body, &signature.result, Role::Result(signature.name))
                }
            };
        };
        let mark = self.body.enter();
        let point = LocalId(decl.signature.parms.len() as u32);
        self.body.declare_implicit(point, "p", types::point(dim), decl.name.span);
        let mut written = decl.signature.clauses.iter().filter_map(|clause| match &clause.kind {
            ClauseKind::Material(e) => Some(e),
            _ => None,
        });
        clauses.material = written.next().map(|e| self.check_material(e));
        let role = Role::Formula(signature.name);
        let body = self.check_expr(&decl.body, &Type::Number, role);
        self.body.leave(mark);
        body
    }
}
