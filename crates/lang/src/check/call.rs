//! Calls: looks up the name that is called, applies function values and samples shapes.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::Dim;
use sdfc_syntax::ast::{self, ExprKind as Ast, Name};

use super::coerce::Role;
use super::names::Found;
use super::types::{self, describe, show};
use super::{Checker, poison};
use crate::hir::{Element, Expr, ExprKind, Type};

/// An argument of a call.
#[derive(Clone, Debug)]
pub(super) struct Given<'a> {
    pub name: Option<&'a Name>,
    pub value: Value<'a>,
    pub span: Span,
}

/// The value of an argument, checked or not.
#[derive(Clone, Debug)]
pub(super) enum Value<'a> {
    /// An expression that is not checked yet.
    Expr(&'a ast::Expr),
    /// A `for` that is not checked yet.
    Element(&'a ast::Element),
    /// A value that was checked without an expected type, and its type.
    Done(Element, Type),
}

impl<'a> Given<'a> {
    /// An expression without a name.
    pub(super) fn plain(e: &'a ast::Expr) -> Self {
        Self { name: None, value: Value::Expr(e), span: e.span }
    }

    /// A value that is already checked.
    pub(super) fn done(value: Expr) -> Self {
        let (ty, span) = (value.ty.clone(), value.span);
        Self { name: None, value: Value::Done(Element::One(value), ty), span }
    }

    /// The type of a value that is already checked.
    pub(super) fn done_type(&self) -> Option<&Type> {
        match &self.value {
            Value::Done(_, ty) => Some(ty),
            Value::Expr(_) | Value::Element(_) => None,
        }
    }

    pub(super) fn of(arg: &'a ast::Arg) -> Self {
        let (value, span) = match &arg.value {
            ast::Element::Expr(e) => (Value::Expr(e), e.span),
            ast::Element::For(each) => (Value::Element(&arg.value), each.span),
        };
        Self { name: arg.name.as_ref(), value, span }
    }
}

/// The name that is called and its position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Callee<'s> {
    pub name: &'s str,
    /// The span of the name.
    pub at: Span,
    /// The span of the whole call.
    pub span: Span,
}

impl<'a> Checker<'a> {
    /// `callee(args)`; `x.f(args)` is `f(x, args)`.
    pub(super) fn infer_call(
        &mut self,
        callee: &'a ast::Expr,
        args: &'a [ast::Arg],
        span: Span,
    ) -> Expr {
        let given = args.iter().map(Given::of);
        match &callee.kind {
            Ast::Name(name) => {
                self.call_name(Callee { name, at: callee.span, span }, given.collect())
            }
            Ast::Field(base, name) => {
                let callee = Callee { name: &name.text, at: name.span, span };
                let mut given: Vec<_> = std::iter::once(Given::plain(base)).chain(given).collect();
                if let Some(found) = self.no_operator(callee, &mut given[0]) {
                    self.report(found);
                    return self.give_up(given, span);
                }
                match self.look_up(callee.name) {
                    Some(_) => self.call_name(callee, given),
                    None => self.unknown_method(callee, given),
                }
            }
            _ => {
                let function = self.infer(callee);
                self.apply(function, None, given.collect(), span)
            }
        }
    }

    /// Reports `x.f(...)` if nothing is called f. It may be a field of the record x.
    fn unknown_method(&mut self, callee: Callee, mut given: Vec<Given<'a>>) -> Expr {
        let base = given[0].span;
        let ty = self.look_at(&mut given[0]);
        let is_field = matches!(&ty, Type::Record(fields)
            if fields.iter().any(|(name, _)| name == callee.name));
        if is_field {
            let message = format!("`{}` is a field of this record, not a function", callee.name);
            let found = Diagnostic::error(Code::WRONG_CALL, callee.at, message);
            let help = format!("to call the value of the field, write (a.{})(...)", callee.name);
            let (before, after) = (base.before(), callee.at.after());
            let edits = vec![(before, "(".to_owned()), (after, ")".to_owned())];
            self.report(found.help(help).fix_all("put the field in brackets", edits));
        } else {
            self.unknown_name(callee.name, callee.at);
        }
        self.give_up(given, callee.span)
    }

    fn call_name(&mut self, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let Some(found) = self.look_up(callee.name) else {
            return self.unknown_function(callee, given);
        };
        self.note_use(callee.at, callee.name, &found);
        match found {
            Found::Local(_) | Found::Let(_) | Found::Param(_) => {
                let value = self.value_of(&found, callee.name, callee.at);
                self.apply(value, Some((callee, &found)), given, callee.span)
            }
            Found::Decls(decls) => self.call_decls(&decls, callee, given),
            Found::Builtin(builtin) => self.call_builtin(builtin, callee, given),
            Found::Setting(_) => {
                self.misplaced_setting(callee.name, callee.at);
                self.give_up(given, callee.span)
            }
            Found::Poisoned => self.give_up(given, callee.span),
        }
    }

    /// Checks the arguments of a failed call for errors inside them. Lambdas are skipped: the types
    /// of their parameters are unknown.
    pub(super) fn give_up(&mut self, given: Vec<Given<'a>>, span: Span) -> Expr {
        for given in given {
            match given.value {
                Value::Expr(e) if !is_lambda(e) => {
                    self.infer(e);
                }
                Value::Element(element) => {
                    self.element(element, None);
                }
                Value::Expr(_) | Value::Done(..) => {}
            }
        }
        poison(span)
    }

    pub(super) fn misplaced_setting(&mut self, name: &str, at: Span) {
        let message = format!("`{name}` is a setting, not a value");
        self.report(
            Diagnostic::error(Code::MISPLACED_SETTING, at, message)
                .help("write it on a line of its own, at the top level of the scene")
                .help("a loop makes no settings: write each of them on a line of its own"),
        );
    }

    /// Calls a value: a function with its arguments, or a shape with a point.
    pub(super) fn apply(
        &mut self,
        function: Expr,
        called: Option<(Callee, &Found)>,
        given: Vec<Given<'a>>,
        span: Span,
    ) -> Expr {
        match function.ty.clone() {
            _ if types::poisoned(&function.ty) => self.give_up(given, span),
            Type::Fn(parameters, result) => {
                self.apply_function(function, &parameters, *result, given, span)
            }
            Type::Shape(dim) => self.sample(function, dim, called, given, span),
            other => {
                let what = called.map_or("this".into(), |(callee, _)| format!("`{}`", callee.name));
                let message = format!("{what} is {} and takes no arguments", describe(&other));
                let at = called.map_or(function.span, |(callee, _)| callee.at);
                let found = Diagnostic::error(Code::WRONG_CALL, at, message);
                let found = found.help("write it without parentheses").fix(
                    "remove the parentheses",
                    Span { start: at.end, ..span },
                    "",
                );
                let found = self.note_hidden(found, called);
                self.report(found);
                self.give_up(given, span)
            }
        }
    }

    fn apply_function(
        &mut self,
        function: Expr,
        parameters: &[Type],
        result: Type,
        given: Vec<Given<'a>>,
        span: Span,
    ) -> Expr {
        if given.len() != parameters.len() {
            let message = format!(
                "this function takes {}, but {} given",
                count(parameters.len(), "argument"),
                match given.len() {
                    1 => "1 is".into(),
                    n => format!("{n} are"),
                }
            );
            let note = format!("its type is {}", show(&function.ty));
            self.report(Diagnostic::error(Code::ARGUMENTS, span, message).note(note));
            return self.give_up(given, span);
        }
        let mut arguments = Vec::with_capacity(given.len());
        for (at, (given, want)) in given.into_iter().zip(parameters).enumerate() {
            if let Some(name) = given.name {
                let message = "arguments of a function value cannot be named";
                self.report(Diagnostic::error(Code::ARGUMENTS, name.span, message));
            }
            let argument = self.one_argument(given, want, Role::Positional(at + 1));
            arguments.push(argument);
        }
        Expr { kind: ExprKind::Apply(Box::new(function), arguments), ty: result, span }
    }

    /// Calls a shape with a point, for its distance there.
    fn sample(
        &mut self,
        shape: Expr,
        dim: Dim,
        called: Option<(Callee, &Found)>,
        mut given: Vec<Given<'a>>,
        span: Span,
    ) -> Expr {
        let want = types::point(dim);
        let single = given.len() == 1 && given[0].name.is_none();
        let value = match given.pop() {
            Some(Given { value: Value::Expr(e), .. }) if single => self.infer(e),
            Some(Given { value: Value::Done(Element::One(value), _), .. }) if single => value,
            last => {
                given.extend(last);
                self.report_sample(dim, called, shape.span, None);
                return self.give_up(given, span);
            }
        };
        if types::poisoned(&value.ty) {
            return poison(span);
        }
        if value.ty != want {
            self.report_sample(dim, called, shape.span, Some(&value.ty));
            return poison(span);
        }
        let kind = ExprKind::Sample(Box::new(shape), Box::new(value));
        Expr { kind, ty: Type::Number, span }
    }

    fn report_sample(
        &mut self,
        dim: Dim,
        called: Option<(Callee, &Found)>,
        span: Span,
        given: Option<&Type>,
    ) {
        let what = called.map_or("this".into(), |(callee, _)| format!("`{}`", callee.name));
        let at = called.map_or(span, |(callee, _)| callee.at);
        let (word, point) = (types::shape_word(dim), show(&types::point(dim)));
        let message = match given {
            Some(Type::Vec(_)) | None => {
                format!("{what} is a {word} here and takes one point, a {point}")
            }
            Some(_) => format!("{what} is a {word} here and takes a point"),
        };
        let found = Diagnostic::error(Code::WRONG_CALL, at, message);
        let found = self.note_hidden(found, called);
        let own_point = self.body.point.map(types::point);
        let is_own_point = own_point.is_some() && own_point.as_ref() == given;
        let found = if is_own_point { self.advise_dimension(dim, found) } else { found };
        self.report(found);
    }

    /// Adds a note if a name of the scene hides the one that was probably meant.
    fn note_hidden(&mut self, found: Diagnostic, called: Option<(Callee, &Found)>) -> Diagnostic {
        let Some((callee, hiding)) = called else { return found };
        let (span, word) = match hiding {
            Found::Local(index) => match self.body.variable(*index) {
                Some(variable) => (variable.span, ""),
                None => return found,
            },
            Found::Let(index) => (self.lets[index.0].ast.name.span, "let "),
            Found::Param(index) => (self.params[index.0].ast.name.span, "param "),
            Found::Decls(_) | Found::Builtin(_) | Found::Setting(_) | Found::Poisoned => {
                return found;
            }
        };
        let name = callee.name;
        let owner = match self.look_up_library(name) {
            Some(Found::Decls(_)) => "library",
            Some(Found::Builtin(_) | Found::Setting(_)) => "built-in",
            _ => return found,
        };
        let owner = if owner == "library" { "library's" } else { owner };
        found.note_at(span, format!("`{word}{name}` hides the {owner} `{name}`; rename it"))
    }
}

/// True if the expression is a lambda, or a block or `if` that gives one.
pub(super) fn is_lambda(e: &ast::Expr) -> bool {
    let mut e = e;
    loop {
        e = match &e.kind {
            Ast::Lambda(..) => return true,
            Ast::Paren(inner) | Ast::Block(_, inner) | Ast::If(_, inner, _) => inner,
            _ => return false,
        }
    }
}

/// `n things`
pub(super) fn count(n: usize, thing: &str) -> String {
    match n {
        0 => format!("no {thing}s"),
        1 => format!("1 {thing}"),
        n => format!("{n} {thing}s"),
    }
}
