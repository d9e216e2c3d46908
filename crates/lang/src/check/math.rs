//! Componentwise functions of the kernel.

use sdfc_diagnostics::{Code, Diagnostic, Span};

use super::builtins::kernel;
use super::call::{Callee, Given, Value};
use super::coerce::{Role, bind, has_no_need_of_a_unit, literal, not_an_angle};
use super::kernel::{Math, MathResult};
use super::operators::as_type;
use super::types::{self, describe, is_numeric, is_scalar, lanes};
use super::{Checker, poison};
use crate::hir::{Element, Expr, ExprKind, Kernel, Type};

impl<'a> Checker<'a> {
    /// Checks a call of a componentwise function. A number beside a vector fills all components.
    pub(super) fn math(&mut self, math: Math, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let Some(arity) = math.arity else { return self.extreme(math, callee, given) };
        let Some(values) = self.positional(callee, given, arity, arity) else {
            return poison(callee.span);
        };
        if matches!(math.kernel, Kernel::Sin | Kernel::Cos | Kernel::Tan)
            && let [value] = &values[..]
            && matches!(value.ty, Type::Number | Type::Int)
            && literal(value).is_some_and(|value| value != 0.0)
        {
            self.report(not_an_angle(value, &format!("the argument of `{}`", callee.name)));
            return poison(callee.span);
        }
        let decide = if math.result == MathResult::Mix { 2 } else { arity };
        let Some(ty) = self.common(callee, values.iter().map(|value| (value, &value.ty))) else {
            return poison(callee.span);
        };
        let ty = match lanes(&ty) {
            Some(_) => ty,
            None => scalar_result(math.result, &values[..decide]),
        };
        let of_arguments = match (math.result, &ty) {
            (MathResult::Same | MathResult::Mix, _) | (_, Type::Vec(_) | Type::Color) => &ty,
            _ => &Type::Number,
        };
        let arguments = values.into_iter().map(|value| as_type(value, of_arguments)).collect();
        kernel(math.kernel, arguments, ty, callee.span)
    }

    /// Checks `min` and `max`: of any number of values or lists, or of one vector's components.
    fn extreme(&mut self, math: Math, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        if given.is_empty() {
            let message = format!("`{}` takes at least 1 argument", callee.name);
            self.report(Diagnostic::error(Code::ARGUMENTS, callee.at, message));
            return poison(callee.span);
        }
        let mut elements = Vec::with_capacity(given.len());
        for given in given {
            self.unnamed(callee, &given);
            elements.push(self.any_element(given));
        }
        if elements.iter().any(|(_, ty)| types::poisoned(ty)) {
            return poison(callee.span);
        }
        if let [(Element::One(_), Type::Vec(width))] = &elements[..] {
            let width = *width;
            let Some((Element::One(value), _)) = elements.pop() else { return poison(callee.span) };
            return self.extreme_component(math.kernel, value, width, callee.span);
        }
        let unknown = poison(callee.span);
        let shown = elements.iter().map(|(element, ty)| match element {
            Element::One(value) | Element::Spread(value) => (value, ty),
            Element::For(_) => (&unknown, ty),
        });
        let Some(ty) = self.common(callee, shown) else { return poison(callee.span) };
        let plain: Option<Vec<&Expr>> = elements
            .iter()
            .map(|(element, _)| match element {
                Element::One(value) => Some(value),
                Element::Spread(_) | Element::For(_) => None,
            })
            .collect();
        let ty = match (&plain, lanes(&ty)) {
            (_, Some(_)) => ty,
            (Some(values), None) => {
                let values: Vec<Expr> = values.iter().map(|value| (*value).clone()).collect();
                scalar_result(math.result, &values)
            }
            (None, None) => one_kind(elements.iter().map(|(_, ty)| ty)),
        };
        if plain.is_some() {
            let arguments = elements.into_iter().filter_map(|(element, _)| match element {
                Element::One(value) => Some(as_type(value, &ty)),
                Element::Spread(_) | Element::For(_) => None,
            });
            return kernel(math.kernel, arguments.collect(), ty, callee.span);
        }
        let role = Role::The("this element");
        let elements: Vec<Element> = elements
            .into_iter()
            .map(|(element, _)| self.coerce_element(element, &ty, role))
            .collect();
        let list = match <[Element; 1]>::try_from(elements) {
            Ok([Element::Spread(list)]) => list,
            Ok([element]) => list_of(vec![element], &ty, callee.span),
            Err(elements) => list_of(elements, &ty, callee.span),
        };
        kernel(math.kernel, vec![list], ty, callee.span)
    }

    /// Checks an argument as an element; a list is spread. Returns the type of its values too.
    fn any_element(&mut self, given: Given<'a>) -> (Element, Type) {
        let (element, ty) = match given.value {
            Value::Expr(e) => {
                let value = self.infer(e);
                let ty = value.ty.clone();
                (Element::One(value), ty)
            }
            Value::Element(element) => self.element(element, None),
            Value::Done(element, ty) => (element, ty),
        };
        match (element, ty) {
            (Element::One(value), Type::List(of)) => (Element::Spread(value), *of),
            other => other,
        }
    }

    fn extreme_component(&mut self, function: Kernel, vector: Expr, width: u8, span: Span) -> Expr {
        let (local, mention) = self.name_value(&vector);
        let components = (0..width).map(|at| {
            let kind = ExprKind::Swizzle(Box::new(mention.clone()), vec![at]);
            Expr { kind, ty: Type::Number, span }
        });
        let result = kernel(function, components.collect(), Type::Number, span);
        Expr { span, ..bind(local, "v", vector, result) }
    }

    /// The common type of some values: the vector type among them, or `number` for scalars.
    pub(super) fn common<'e>(
        &mut self,
        callee: Callee,
        values: impl Iterator<Item = (&'e Expr, &'e Type)>,
    ) -> Option<Type> {
        let mut common = Type::Number;
        for (value, ty) in values {
            if !is_numeric(ty) {
                let shown = Expr { kind: ExprKind::Error, ty: ty.clone(), span: value.span };
                self.wrong_argument(callee, &shown, "numbers and vectors");
                return None;
            }
            if is_scalar(ty) || *ty == common {
                continue;
            }
            if common != Type::Number {
                let message = format!(
                    "`{}` needs vectors of the same size; these are {} and {}",
                    callee.name,
                    describe(&common),
                    describe(ty)
                );
                self.report(Diagnostic::error(Code::TYPE_MISMATCH, value.span, message));
                return None;
            }
            common = ty.clone();
        }
        Some(common)
    }
}

fn list_of(elements: Vec<Element>, ty: &Type, span: Span) -> Expr {
    Expr { kind: ExprKind::List(elements), ty: Type::List(Box::new(ty.clone())), span }
}

/// The result type of a componentwise function for scalars.
fn scalar_result(result: MathResult, values: &[Expr]) -> Type {
    match result {
        MathResult::Number => Type::Number,
        MathResult::Whole => Type::Int,
        MathResult::Angle => Type::Angle,
        MathResult::Same | MathResult::Mix => {
            let with_unit = values.iter().filter(|value| !has_no_need_of_a_unit(value));
            match one_kind(with_unit.map(|value| &value.ty)) {
                Type::Int if result == MathResult::Mix => Type::Number,
                Type::Number => one_kind(values.iter().map(|value| &value.ty)),
                ty => ty,
            }
        }
    }
}

/// The common type of scalars if all have the same type, otherwise `number`.
fn one_kind<'t>(mut types: impl Iterator<Item = &'t Type>) -> Type {
    let Some(first) = types.next() else { return Type::Number };
    if types.all(|ty| ty == first) { first.clone() } else { Type::Number }
}
