//! Names as values, and the values of `let` and `param`.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_syntax::ast;

use super::body::Body;
use super::call::{Callee, Given};
use super::coerce::Role;
use super::decl::Target;
use super::kernel::{self, Builtin};
use super::names::Found;
use super::order::Node;
use super::{Checker, DeclIndex, LetIndex, ParamIndex, State, poison, types};
use crate::hir::{Expr, ExprKind, Global, GlobalId, Kernel, Lambda, Param, ParamId, Type};

impl<'a> Checker<'a> {
    /// Checks a name that is not called.
    pub(super) fn infer_name(&mut self, name: &str, span: Span) -> Expr {
        let Some(found) = self.look_up(name) else {
            self.unknown_name(name, span);
            return poison(span);
        };
        self.note_use(span, name, &found);
        self.value_of(&found, name, span)
    }

    /// Checks a name where a function with these parameters is expected. Declarations and kernel
    /// functions are wrapped in a lambda with these parameters.
    pub(super) fn name_as_function(&mut self, name: &str, want: &[Type], span: Span) -> Expr {
        let Some(found) = self.look_up(name) else {
            self.unknown_name(name, span);
            return poison(span);
        };
        self.note_use(span, name, &found);
        match found {
            Found::Decls(decls) => self.declared_function(&decls, name, want, span),
            Found::Builtin(builtin) if constant(builtin).is_none() => {
                let callee = Callee { name, at: span, span };
                self.wrap(want, span, |checker, given| checker.call_builtin(builtin, callee, given))
            }
            found => self.value_of(&found, name, span),
        }
    }

    /// The value of a name.
    pub(super) fn value_of(&mut self, found: &Found, name: &str, span: Span) -> Expr {
        match found {
            Found::Local(index) => self.body.mention(*index, span).unwrap_or_else(|| poison(span)),
            Found::Let(index) => self.let_value(*index, span),
            Found::Param(index) => self.param_value(*index, span),
            Found::Decls(decls) => self.function_value(decls, name, span),
            Found::Builtin(builtin) => match (constant(*builtin), builtin) {
                (Some((kind, ty)), _) => Expr { kind, ty, span },
                (None, Builtin::Math(_)) => self.no_single_type(name, span),
                (None, _) => self.not_called(name, span),
            },
            Found::Setting(_) => {
                self.misplaced_setting(name, span);
                poison(span)
            }
            Found::Poisoned => poison(span),
        }
    }

    fn declared_function(
        &mut self,
        decls: &[DeclIndex],
        name: &str,
        want: &[Type],
        span: Span,
    ) -> Expr {
        if let [only] = *decls
            && !self.decls[only.0].generic
            && let Some(signature) = self.instance(only, None, span)
            && let Target::Fn(id) = signature.target
            && signature.parameters.len() == want.len()
            && signature.parameters.iter().zip(want).all(|(parameter, want)| {
                !parameter.variadic && types::same_value(want, &parameter.ty)
            })
        {
            self.needs(Node::Fn(id.0), span);
            let parameters =
                signature.parameters.iter().map(|parameter| parameter.ty.clone()).collect();
            let ty = Type::Fn(parameters, Box::new(signature.result.clone()));
            return Expr { kind: ExprKind::FnValue(id), ty, span };
        }
        let callee = Callee { name, at: span, span };
        self.body.attempts.push(Vec::new());
        let wrapped =
            self.wrap(want, span, |checker, given| checker.call_decls(decls, callee, given));
        let found = self.body.attempts.pop().unwrap_or_default();
        if !sdfc_diagnostics::has_errors(&found) {
            return wrapped;
        }
        self.function_value(decls, name, span)
    }

    /// A declaration as a function value.
    fn function_value(&mut self, decls: &[DeclIndex], name: &str, span: Span) -> Expr {
        let [only] = *decls else { return self.no_single_type(name, span) };
        if self.decls[only.0].generic {
            return self.no_single_type(name, span);
        }
        let Some(signature) = self.instance(only, None, span) else { return poison(span) };
        if signature.parameters.iter().any(|parameter| parameter.variadic) {
            return self.no_single_type(name, span);
        }
        if types::poisoned(&signature.result) {
            return poison(span);
        }
        let parameters: Vec<Type> =
            signature.parameters.iter().map(|parameter| parameter.ty.clone()).collect();
        match signature.target {
            Target::Fn(id) => {
                self.needs(Node::Fn(id.0), span);
                let ty = Type::Fn(parameters, Box::new(signature.result.clone()));
                self.limit_type(Expr { kind: ExprKind::FnValue(id), ty, span })
            }
            Target::Shape(_) => {
                let callee = Callee { name, at: span, span };
                self.wrap(&parameters, span, |checker, given| {
                    checker.call_decls(&[only], callee, given)
                })
            }
        }
    }

    fn no_single_type(&mut self, name: &str, span: Span) -> Expr {
        let message =
            format!("`{name}` accepts arguments of several types, so it needs a type as a value");
        self.report(
            Diagnostic::error(Code::TYPE_MISMATCH, span, message)
                .help(format!("call it, or wrap it: fn(a: number, b: number) = {name}(a, b)")),
        );
        poison(span)
    }

    /// Reports a kernel function that can only be called.
    fn not_called(&mut self, name: &str, span: Span) -> Expr {
        let message = format!("`{name}` is not a value: it needs its arguments");
        let found = Diagnostic::error(Code::TYPE_MISMATCH, span, message);
        self.report(match kernel::ROWS.iter().find(|row| row.name == name) {
            Some(row) => found.help(format!("call it: {}", row.example)),
            None => found,
        });
        poison(span)
    }

    /// `fn(x0, x1, ...) = call(x0, x1, ...)`
    fn wrap(
        &mut self,
        parameters: &[Type],
        span: Span,
        call: impl FnOnce(&mut Self, Vec<Given<'a>>) -> Expr,
    ) -> Expr {
        self.body.frames.push(Default::default());
        let given: Vec<Given> = parameters
            .iter()
            .map(|ty| {
                let kind = ExprKind::Local(self.body.fresh());
                Given::done(Expr { kind, ty: ty.clone(), span })
            })
            .collect();
        let body = call(self, given);
        let locals = self.body.frames.pop().map_or(0, |frame| frame.locals);
        if types::poisoned(&body.ty) {
            return poison(span);
        }
        let ty = Type::Fn(parameters.to_vec(), Box::new(body.ty.clone()));
        let names = (0..parameters.len()).map(|at| format!("x{at}")).collect();
        let parameters = parameters.to_vec();
        let lambda = Lambda {
            captures: Vec::new(),
            parameters,
            names,
            locals,
            lipschitz: None,
            requires: Vec::new(),
            body,
        };
        self.limit_type(Expr { kind: ExprKind::Lambda(Box::new(lambda)), ty, span })
    }

    fn let_value(&mut self, index: LetIndex, span: Span) -> Expr {
        if matches!(self.lets[index.0].state, State::Unseen) {
            self.with_stack(|checker| checker.check_let(index));
        }
        match self.lets[index.0].state.clone() {
            State::Done(id, ty) => {
                self.needs(Node::of_let(index), span);
                Expr { kind: ExprKind::Global(id), ty, span }
            }
            State::Unseen | State::Failed => poison(span),
            State::Open => {
                let name = &self.lets[index.0].ast.name;
                let message = format!("`{}` is used in its own definition", name.text);
                self.report(
                    Diagnostic::error(Code::UNKNOWN_NAME, span, message)
                        .note_at(name.span, "it has a value only after this `let`"),
                );
                poison(span)
            }
        }
    }

    /// Checks a file-level `let` and everything that its value depends on. So lets are numbered in
    /// an order in which each depends only on earlier ones.
    pub(super) fn check_let(&mut self, index: LetIndex) {
        let (item, module) = (self.lets[index.0].ast, self.lets[index.0].module);
        if !matches!(self.lets[index.0].state, State::Unseen) {
            return;
        }
        self.lets[index.0].state = State::Open;
        let mut body = Body::new(module, item.span.start);
        body.node = Some(Node::of_let(index));
        let outer = std::mem::replace(&mut self.body, body);
        let value = self.infer(&item.value);
        self.note_variable(item.name.span, &value.ty);
        let body = std::mem::replace(&mut self.body, outer);
        self.drain();
        let locals = body.frames.first().map_or(0, |frame| frame.locals);
        self.lets[index.0].state = if types::poisoned(&value.ty) {
            State::Failed
        } else {
            State::Done(GlobalId(self.program.globals.len() as u32), value.ty.clone())
        };
        let (name, span) = (item.name.text.clone(), item.name.span);
        if !types::poisoned(&value.ty) {
            self.program.globals.push(Global { name, value, locals, span });
        }
    }

    fn param_value(&mut self, index: ParamIndex, span: Span) -> Expr {
        if matches!(self.params[index.0].state, State::Unseen) {
            self.with_stack(|checker| checker.check_param(index));
        }
        match &self.params[index.0].state {
            State::Done(id, ty) => Expr { kind: ExprKind::Param(*id), ty: ty.clone(), span },
            State::Unseen | State::Open | State::Failed => poison(span),
        }
    }

    /// Checks a param.
    pub(super) fn check_param(&mut self, index: ParamIndex) {
        let (item, module) = (self.params[index.0].ast, self.params[index.0].module);
        if !matches!(self.params[index.0].state, State::Unseen) {
            return;
        }
        self.params[index.0].state = State::Open;
        let outer = std::mem::replace(&mut self.body, Body::new(module, item.span.start));
        let param = self.param(item);
        self.note_variable(item.name.span, &param.ty);
        self.leave_top_level(outer);
        self.params[index.0].state = match types::poisoned(&param.ty) {
            true => State::Failed,
            false => State::Done(ParamId(index.0 as u32), param.ty.clone()),
        };
        self.params[index.0].checked = Some(param);
    }

    fn param(&mut self, item: &'a ast::Param) -> Param {
        let name = item.name.text.as_str();
        let what = format!("the default of `{name}`");
        let (ty, default) = match &item.ty {
            Some(ty) => {
                let ty = self.resolve_type(ty);
                let default = self.check_expr(&item.default, &ty, Role::The(&what));
                (ty, default)
            }
            None => {
                let mut default = self.infer(&item.default);
                if default.ty == Type::Int {
                    default.ty = Type::Number;
                }
                (default.ty.clone(), default)
            }
        };
        let (mut range, mut choices) = (None, Vec::new());
        match (&ty, &item.range) {
            (Type::Text, Some(list)) => choices = self.choices(list, &default),
            (Type::Text, None) => {
                let message = format!("the string param `{name}` needs its choices");
                let found = Diagnostic::error(Code::TYPE_MISMATCH, item.default.span, message);
                self.report(found.help("list them: in [\"round\", \"flat\"]"));
            }
            (_, Some(values)) => range = self.check_values(values, &ty, name),
            (_, None) => {}
        }
        if !matches!(
            ty,
            Type::Number
                | Type::Int
                | Type::Angle
                | Type::Bool
                | Type::Color
                | Type::Text
                | Type::Error
        ) {
            let message = format!(
                "a param can be a number, int, angle, bool, color or string; this is {}",
                types::describe(&ty)
            );
            self.report(Diagnostic::error(Code::TYPE_MISMATCH, item.default.span, message));
        }
        let name = match self.modules[self.body.module].param_prefix.as_str() {
            "" => name.to_owned(),
            prefix => format!("{prefix}.{name}"),
        };
        let (span, docs) = (item.name.span, item.docs.lines.clone());
        Param { name, ty, default, range, choices, span, docs }
    }

    /// Checks the choices of a string param, `in ["round", "flat"]`. The default must be one of
    /// them.
    fn choices(&mut self, list: &'a ast::Expr, default: &Expr) -> Vec<String> {
        let want = Type::List(Box::new(Type::Text));
        let checked = self.check_expr(list, &want, Role::The("the list of choices"));
        let ExprKind::List(elements) = checked.kind else { return Vec::new() };
        let text = |value: &Expr| match &value.kind {
            ExprKind::Text(text) => Some(text.clone()),
            _ => None,
        };
        let choices: Option<Vec<String>> = elements
            .iter()
            .map(|element| match element {
                crate::hir::Element::One(value) => text(value),
                crate::hir::Element::Spread(_) | crate::hir::Element::For(_) => None,
            })
            .collect();
        let Some(choices) = choices else {
            let message = "the choices of a param must be string literals";
            self.report(Diagnostic::error(Code::NOT_COMPILE_TIME, list.span, message));
            return Vec::new();
        };
        if let Some(default) = text(default).filter(|text| !choices.contains(text)) {
            let message = format!("the default \"{default}\" is not one of the choices");
            self.report(Diagnostic::error(Code::OUT_OF_RANGE, list.span, message));
        }
        choices
    }
}

/// The value of a kernel name that is a value and not a function.
fn constant(builtin: Builtin) -> Option<(ExprKind, Type)> {
    match builtin {
        Builtin::Number(value) => Some((ExprKind::Number(value), Type::Number)),
        Builtin::Angle(value) => Some((ExprKind::Number(value), Type::Angle)),
        Builtin::Time => Some((ExprKind::Time, Type::Number)),
        Builtin::Frame => Some((ExprKind::Frame, Type::Int)),
        Builtin::SurfaceVector(vector) => Some((ExprKind::SurfaceVector(vector), Type::Vec(3))),
        Builtin::Hard => Some((ExprKind::Kernel(Kernel::Hard, Vec::new()), Type::Shadow)),
        Builtin::Math(_)
        | Builtin::Vector(_)
        | Builtin::Geometry(_)
        | Builtin::Lift
        | Builtin::Hash(_)
        | Builtin::Len
        | Builtin::Str
        | Builtin::Iterate
        | Builtin::Bounds
        | Builtin::AtPoint(_)
        | Builtin::Material
        | Builtin::With
        | Builtin::Color(_)
        | Builtin::Soft
        | Builtin::GlyphCurves
        | Builtin::PolygonEdges
        | Builtin::OutlineCells
        | Builtin::Alternative => None,
    }
}
