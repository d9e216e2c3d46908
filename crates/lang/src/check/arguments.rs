//! Assigns arguments to parameters.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_syntax::ast::{self, Name};

use super::advice::{signature, too_many};
use super::call::{Callee, Given, Value, is_lambda};
use super::coerce::Role;
use super::decl::ParameterSignature;
use super::types;
use super::written::written;
use super::{Checker, poison};
use crate::hir::{Element, Expr, ExprKind, Type};
use crate::spelling::{ask, nearest};
use crate::synonyms;

impl<'a> Checker<'a> {
    /// The arguments in the order of the parameters; `None` means the default. Reports arguments
    /// that do not fit.
    pub(super) fn arguments(
        &mut self,
        callee: Callee,
        parameters: &[ParameterSignature],
        given: Vec<Given<'a>>,
    ) -> Vec<Option<Expr>> {
        let bound = self.bind(callee, parameters, given);
        self.note_call(callee.at, parameters, &bound);
        let free: Vec<&ParameterSignature> = parameters
            .iter()
            .zip(&bound)
            .filter(|(_, given)| given.is_empty())
            .map(|it| it.0)
            .collect();
        parameters
            .iter()
            .enumerate()
            .zip(bound)
            .map(|((at, parameter), mut given)| {
                let role = match parameter.untyped {
                    true => Role::Untyped(callee.name, parameter.name),
                    false => Role::Argument(callee.name, parameter.name),
                };
                if parameter.variadic && given.first().is_none_or(|given| given.name.is_none()) {
                    return Some(self.variadic(&parameters[at..], given, role, callee.span));
                }
                let given = given.pop()?;
                Some(match given.value {
                    Value::Expr(e) if given.name.is_none() && is_literal(e) => {
                        self.literal(e, &parameter.ty, role, &free)
                    }
                    _ => self.one_argument(given, &parameter.ty, role),
                })
            })
            .collect()
    }

    /// The arguments of each parameter.
    fn bind(
        &mut self,
        callee: Callee,
        parameters: &[ParameterSignature],
        given: Vec<Given<'a>>,
    ) -> Vec<Vec<Given<'a>>> {
        let mut bound: Vec<Vec<Given>> = vec![Vec::new(); parameters.len()];
        let (mut next, mut named, mut excess) = (0, false, Vec::new());
        let unnamed = unnamed(parameters);
        for mut given in given {
            if given.name.is_none()
                && let Some(found) = self.parameter_for_value(callee, parameters, &given)
            {
                self.report(found);
                given = Given::done(poison(given.span));
            }
            let index = match given.name {
                None if named => {
                    let message = "positional arguments come before named ones";
                    self.report(Diagnostic::error(Code::ARGUMENTS, given.span, message));
                    None
                }
                None => {
                    let index = (next < unnamed).then_some(next);
                    next += usize::from(
                        parameters.get(next).is_some_and(|parameter| !parameter.variadic),
                    );
                    index
                }
                Some(name) => {
                    named = true;
                    self.index_of_named(callee, parameters, name, &bound)
                }
            };
            match index {
                Some(index) => {
                    if let Some(found) = self.word_without_quotes(&parameters[index], &given) {
                        self.report(found);
                        given = Given::done(poison(given.span));
                    }
                    bound[index].push(given);
                }
                None => excess.push(given),
            }
        }
        if let Some(first) = excess.first()
            && first.name.is_none()
            && !named
        {
            let mut found = too_many(callee, parameters, unnamed, first.span);
            found.help.extend(bracketed(callee, parameters, &bound, &excess));
            self.report(found);
        }
        self.give_up(excess, callee.span);
        self.report_missing(callee, parameters, &bound);
        bound
    }

    fn index_of_named(
        &mut self,
        callee: Callee,
        parameters: &[ParameterSignature],
        name: &Name,
        bound: &[Vec<Given<'a>>],
    ) -> Option<usize> {
        let Some(index) = parameters.iter().position(|parameter| parameter.name == name.text)
        else {
            let message = format!("`{}` has no parameter `{}`", callee.name, name.text);
            let found = Diagnostic::error(Code::ARGUMENTS, name.span, message);
            let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name).collect();
            let near = synonyms::parameter(&name.text, &names)
                .or_else(|| nearest(&name.text, names.into_iter()));
            let is_diameter = matches!(&name.text[..], "d" | "diameter") && near == Some("r");
            let found = match near {
                Some(_) if is_diameter => found.help("`r` is the radius, half of the diameter"),
                Some(near) => ask(near).add_to(found),
                None => self.elsewhere(
                    callee.name,
                    &name.text,
                    found.help(signature(callee.name, parameters)),
                ),
            };
            self.report(found);
            return None;
        };
        if let Some(first) = bound[index].first() {
            let message = format!("`{}` is given twice", name.text);
            let note = match first.name {
                Some(_) => "the first one".to_owned(),
                None => format!("without a name, this is `{}`", name.text),
            };
            let found =
                Diagnostic::error(Code::ARGUMENTS, name.span, message).note_at(first.span, note);
            self.report(found);
            return None;
        }
        Some(index)
    }

    /// Checks a literal without a name. If it does not fit but fits one of the `free` parameters,
    /// the diagnostic suggests that one.
    fn literal(
        &mut self,
        e: &'a ast::Expr,
        want: &Type,
        role: Role,
        free: &[&ParameterSignature],
    ) -> Expr {
        let value = self.infer(e);
        let value = match self.try_coerce(value, want) {
            Ok(value) => return value,
            Err(value) => value,
        };
        let found = self.mismatch(&value, want, role);
        let fits = |parameter: &&&ParameterSignature| {
            types::same_value(&value.ty, &parameter.ty)
                || (value.ty == Type::Int && parameter.ty == Type::Number)
        };
        let found = match free.iter().find(fits) {
            Some(parameter) => {
                let help = format!("or name the parameter: {}: {}", parameter.name, written(e));
                name_argument(found.help(help), parameter, e)
            }
            None => found,
        };
        self.report(found);
        poison(e.span)
    }

    fn report_missing(
        &mut self,
        callee: Callee,
        parameters: &[ParameterSignature],
        bound: &[Vec<Given<'a>>],
    ) {
        let missing: Vec<String> = parameters
            .iter()
            .zip(bound)
            .filter(|(parameter, given)| {
                given.is_empty() && !parameter.optional && !parameter.variadic
            })
            .map(|(parameter, _)| format!("`{}`", parameter.name))
            .collect();
        if !missing.is_empty() {
            let message = format!("`{}` needs {}", callee.name, missing.join(" and "));
            self.report(
                Diagnostic::error(Code::ARGUMENTS, callee.at, message)
                    .help(signature(callee.name, parameters)),
            );
        }
    }

    /// The arguments of a variadic parameter, the first of `parameters`: values, lists and `for`.
    fn variadic(
        &mut self,
        parameters: &[ParameterSignature],
        given: Vec<Given<'a>>,
        role: Role,
        span: Span,
    ) -> Expr {
        let [parameter, later @ ..] = parameters else { return poison(span) };
        let Type::List(want) = &parameter.ty else { return poison(span) };
        let mut elements = Vec::with_capacity(given.len());
        for given in given {
            let element = match given.value {
                Value::Expr(e) if is_lambda(e) => Element::One(self.check_expr(e, want, role)),
                Value::Expr(e) => {
                    let value = self.infer(e);
                    let is_width =
                        |it: &&ParameterSignature| is_width_of_blend(&value.ty, it, want);
                    if let Some(later) = later.iter().find(|it| meant_for(&value.ty, it, want)) {
                        Element::One(self.needs_name(e, parameter, later))
                    } else if let Some(blend) = later.iter().find(is_width) {
                        Element::One(self.needs_blend(e, parameter, blend))
                    } else {
                        self.spread(Element::One(value), want, role)
                    }
                }
                Value::Element(element) => self.element(element, Some((want, role))).0,
                Value::Done(element, _) => self.spread(element, want, role),
            };
            elements.push(element);
        }
        Expr { kind: ExprKind::List(elements), ty: parameter.ty.clone(), span }
    }

    /// Reports an argument for a parameter after the variadic one: it needs a name.
    fn needs_name(
        &mut self,
        given: &ast::Expr,
        parameter: &ParameterSignature,
        later: &ParameterSignature,
    ) -> Expr {
        let message = format!("parameters after `{}` must be named", parameter.name);
        let found = Diagnostic::error(Code::ARGUMENTS, given.span, message);
        let help = format!("write {}: {}", later.name, written(given));
        self.report(name_argument(found.help(help), later, given));
        poison(given.span)
    }

    /// Reports the width of a blend without the blend.
    fn needs_blend(
        &mut self,
        given: &ast::Expr,
        parameter: &ParameterSignature,
        blend: &ParameterSignature,
    ) -> Expr {
        let message = format!("`{}` takes shapes; this is a number", parameter.name);
        let found = Diagnostic::error(Code::TYPE_MISMATCH, given.span, message);
        self.report(found.help(format!(
            "to blend them, write {}: {}",
            blend.name,
            synonyms::blend_of_width(&written(given))
        )));
        poison(given.span)
    }

    /// Spreads a list among the arguments of a variadic parameter into its elements.
    fn spread(&mut self, element: Element, want: &Type, role: Role) -> Element {
        let element = match element {
            Element::One(value)
                if matches!(value.ty, Type::List(_)) && !matches!(want, Type::List(_)) =>
            {
                Element::Spread(value)
            }
            other => other,
        };
        self.coerce_element(element, want, role)
    }

    /// Checks an argument that must be one value.
    pub(super) fn one_argument(&mut self, given: Given<'a>, want: &Type, role: Role) -> Expr {
        match given.value {
            Value::Expr(e) => self.check_expr(e, want, role),
            Value::Done(Element::One(value), _) => self.coerce(value, want, role),
            Value::Done(..) | Value::Element(_) => self.not_one_value(given.span),
        }
    }

    /// Checks an argument that must be one value of any type.
    pub(super) fn one_value(&mut self, given: Given<'a>) -> Expr {
        match given.value {
            Value::Expr(e) => self.infer(e),
            Value::Done(Element::One(value), _) => value,
            Value::Done(..) | Value::Element(_) => self.not_one_value(given.span),
        }
    }

    fn not_one_value(&mut self, span: Span) -> Expr {
        let message = "`for` makes many values; this parameter takes one";
        self.report(
            Diagnostic::error(Code::ARGUMENTS, span, message)
                .help("make a list: [for x in list: ...]"),
        );
        poison(span)
    }
}

/// The number of parameters that arguments without a name can set. The components after a vector,
/// as in `translate(by, x, y, z)`, need their names: a row of numbers looks like the vector.
fn unnamed(parameters: &[ParameterSignature]) -> usize {
    let is_component = |of: &ParameterSignature, name| of.optional && of.name == name;
    let are_components = |of: &[ParameterSignature]| {
        matches!(of[0].ty, Type::Vec(_)) && is_component(&of[1], "x") && is_component(&of[2], "y")
    };
    parameters.windows(3).position(are_components).map_or(parameters.len(), |vector| vector + 1)
}

/// The values in brackets, as in `box([1, 2, 3])`, if the first parameter, or that after the
/// receiver, is a list or a vector of as many components as there are values.
fn bracketed(
    callee: Callee,
    parameters: &[ParameterSignature],
    bound: &[Vec<Given>],
    excess: &[Given],
) -> Option<String> {
    let first = usize::from(matches!(parameters.first()?.ty, Type::Shape(_)));
    let width = match parameters.get(first)?.ty {
        Type::Vec(width) => Some(usize::from(width)),
        Type::List(_) => None,
        _ => return None,
    };
    let given: Vec<String> = bound
        .iter()
        .skip(first)
        .flatten()
        .chain(excess)
        .map(|given| match given.value {
            Value::Expr(e) if given.name.is_none() => Some(written(e)),
            Value::Expr(_) | Value::Element(_) | Value::Done(..) => None,
        })
        .collect::<Option<_>>()?;
    let values = given.join(", ");
    let fits = width.is_none_or(|width| given.len() == width);
    fits.then(|| match (first, width) {
        (0, _) => format!("write {}([{values}])", callee.name),
        (_, Some(_)) => format!("write the vector in brackets: [{values}]"),
        (_, None) => format!("write the list in brackets: [{values}]"),
    })
}

/// Adds the change that names the parameter of an argument.
fn name_argument(found: Diagnostic, parameter: &ParameterSignature, e: &ast::Expr) -> Diagnostic {
    let name = parameter.name;
    found.fix(format!("name the parameter `{name}`"), e.span.before(), format!("{name}: "))
}

/// True for a literal: a number, colour, string or bool.
fn is_literal(e: &ast::Expr) -> bool {
    use ast::ExprKind::{Bool, Color, Number, Text};
    matches!(e.kind, Number { .. } | Color(_) | Text(_) | Bool(_))
}

/// True if a value does not have type `want` but fits a later parameter, which must be named.
fn meant_for(ty: &Type, later: &ParameterSignature, want: &Type) -> bool {
    !types::poisoned(ty) && !types::same_value(ty, want) && types::same_value(ty, &later.ty)
}

/// True if a number stands where a shape is wanted, and a later parameter is a blend, whose width
/// it probably is.
fn is_width_of_blend(ty: &Type, later: &ParameterSignature, want: &Type) -> bool {
    let is_number = matches!(ty, Type::Number | Type::Int);
    is_number && matches!(want, Type::Shape(_)) && later.ty == types::blend()
}
