//! The loop `iterate(over, start, step, while)`.

use sdfc_diagnostics::{Code, Diagnostic};

use super::builtins::{kernel, parameter};
use super::call::{Callee, Given, Value, is_lambda};
use super::coerce::Role;
use super::lambda::arity_of;
use super::types::{self, describe, is_scalar};
use super::{Checker, poison};
use crate::hir::{Element, Expr, Kernel, Type};

impl<'a> Checker<'a> {
    /// Checks `iterate(over, start, step, while)`. `step` takes the state, and optionally the item.
    pub(super) fn iterate(&mut self, callee: Callee, mut given: Vec<Given<'a>>) -> Expr {
        // The first two arguments determine the types of the others, so they are checked here.
        for given in given.iter_mut().filter(|given| given.name.is_none()).take(1) {
            self.read_sequence(given);
        }
        for given in given.iter_mut().filter(|g| g.name.is_some_and(|n| n.text == "over")) {
            self.read_sequence(given);
        }
        let index_of = |name: &str, at: usize, given: &[Given]| {
            let named = given.iter().position(|g| g.name.is_some_and(|n| n.text == name));
            let positional = given.iter().take_while(|g| g.name.is_none()).count();
            named.or((at < positional).then_some(at))
        };
        let over = index_of("over", 0, &given).and_then(|at| given[at].done_type().cloned());
        let state = index_of("start", 1, &given).map(|at| {
            let value = self.one_value(given[at].clone());
            let value = self.as_state(value, callee);
            let ty = value.ty.clone();
            given[at].value = Value::Done(Element::One(value), ty.clone());
            ty
        });
        let item = match over {
            Some(Type::Int) => Type::Int,
            Some(Type::Range(of)) if is_scalar(&of) => *of,
            Some(Type::List(of)) => *of,
            Some(other) if !types::poisoned(&other) => {
                let message = format!(
                    "`iterate` needs a count, a range or a list; this is {}",
                    describe(&other)
                );
                self.report(Diagnostic::error(Code::TYPE_MISMATCH, callee.at, message));
                return self.give_up(given, callee.span);
            }
            _ => Type::Error,
        };
        let state = state.unwrap_or(Type::Error);
        let arity = index_of("step", 2, &given).and_then(|at| self.step_arity(&mut given[at]));
        let takes = match arity {
            Some(2) => vec![state.clone(), item],
            _ => vec![state.clone()],
        };
        let step = Type::Fn(takes, Box::new(state.clone()));
        let goes_on = Type::Fn(vec![state.clone()], Box::new(Type::Bool));
        let over = over_type(&given, index_of("over", 0, &given));
        let parameters = [
            parameter("over", over, false),
            parameter("start", state.clone(), false),
            parameter("step", step, false),
            parameter("while", goes_on, true),
        ];
        let arguments = self.arguments(callee, &parameters, given);
        if arguments[..3].iter().any(|value| value.as_ref().is_none_or(|v| types::poisoned(&v.ty)))
        {
            return poison(callee.span);
        }
        kernel(Kernel::Iterate, arguments.into_iter().flatten().collect(), state, callee.span)
    }

    /// The number of parameters of the step. A step that is neither a lambda nor a name is checked
    /// here.
    fn step_arity(&mut self, given: &mut Given<'a>) -> Option<usize> {
        let Value::Expr(e) = given.value else { return None };
        if let Some(arity) = self.arity(e) {
            return Some(arity);
        }
        if is_lambda(e) {
            return None;
        }
        let value = self.infer(e);
        let ty = value.ty.clone();
        given.value = Value::Done(Element::One(value), ty.clone());
        arity_of(&ty)
    }

    fn read_sequence(&mut self, given: &mut Given<'a>) {
        if let Value::Expr(e) = given.value {
            let value = self.sequence(e);
            let ty = value.ty.clone();
            given.value = Value::Done(Element::One(value), ty);
        }
    }

    /// Checks the state of a loop: a number, a bool, a vector, or a record of these.
    fn as_state(&mut self, value: Expr, callee: Callee) -> Expr {
        match state_of(&value.ty) {
            Some(ty) => self.coerce(value, &ty, Role::The("the state")),
            None => {
                let message = format!(
                    "the state of `{}` must be a number, bool, vector or record of these; this is {}",
                    callee.name,
                    describe(&value.ty)
                );
                self.report(Diagnostic::error(Code::TYPE_MISMATCH, value.span, message));
                poison(value.span)
            }
        }
    }
}

/// The type of a loop's state that starts with a value of this type. Numbers can change to any
/// other number.
fn state_of(start: &Type) -> Option<Type> {
    match start {
        Type::Number | Type::Int | Type::Angle => Some(Type::Number),
        Type::Bool | Type::Vec(_) | Type::Color | Type::Error => Some(start.clone()),
        Type::Record(fields) => {
            let field = |(name, ty): &(String, Type)| Some((name.clone(), state_of(ty)?));
            Some(Type::Record(fields.iter().map(field).collect::<Option<_>>()?))
        }
        Type::Text
        | Type::Range(_)
        | Type::List(_)
        | Type::Fn(..)
        | Type::Shape(_)
        | Type::Material
        | Type::Shadow => None,
    }
}

fn over_type(given: &[Given], at: Option<usize>) -> Type {
    at.and_then(|at| given[at].done_type().cloned()).unwrap_or(Type::Error)
}
