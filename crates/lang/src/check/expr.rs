//! Expressions: `infer` finds the type of an expression, `check_expr` checks it against one.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::Dim;
use sdfc_syntax::ast::{self, ExprKind as Ast, Name, Unit};

use super::builtins::FIELDS;
use super::coerce::Role;
use super::records::fields_of;
use super::types::{self, describe, lanes};
use super::{Checker, lambda, poison};
use crate::hir::{Expr, ExprKind, Type};

impl<'a> Checker<'a> {
    /// Checks an expression without an expected type.
    pub(super) fn infer(&mut self, e: &'a ast::Expr) -> Expr {
        let value = self.with_stack(|checker| checker.infer_inner(e));
        self.note_type(e.span, &value.ty);
        value
    }

    fn infer_inner(&mut self, e: &'a ast::Expr) -> Expr {
        let span = e.span;
        match &e.kind {
            Ast::Number { value, unit, whole } => number(*value, *unit, *whole, span),
            Ast::Color(bytes) => {
                Expr { kind: ExprKind::Color(linear(*bytes)), ty: Type::Color, span }
            }
            Ast::Text(text) => Expr { kind: ExprKind::Text(text.clone()), ty: Type::Text, span },
            Ast::Bool(value) => Expr { kind: ExprKind::Bool(*value), ty: Type::Bool, span },
            Ast::Name(name) => self.infer_name(name, span),
            Ast::Paren(inner) => self.infer(inner),
            Ast::Block(lets, result) => self.infer_block(lets, result, span),
            Ast::If(condition, yes, no) => self.infer_if(condition, yes, no, span),
            Ast::Lambda(signature, body) => self.infer_lambda(signature, body, span),
            Ast::List(elements) => self.infer_brackets(elements, span),
            Ast::Record(fields) => self.infer_record(fields, span),
            Ast::Call(callee, args) => self.infer_call(callee, args, span),
            Ast::Field(base, name) => self.infer_field(base, name, span),
            Ast::Index(base, index) => self.infer_index(base, index, span),
            Ast::Unary(op, operand) => self.infer_unary(*op, operand, span),
            Ast::Binary(op, at, a, b) => self.infer_binary(*op, *at, a, b, span),
            Ast::Error => poison(span),
        }
    }

    /// Checks an expression against type `want`. The type is passed into parentheses, lists,
    /// blocks, branches and lambdas, so that messages point there.
    pub(super) fn check_expr(&mut self, e: &'a ast::Expr, want: &Type, role: Role) -> Expr {
        if let Ast::Name(name) = &e.kind {
            self.note_expected(name, want);
        }
        let value = self.with_stack(|checker| checker.check_inner(e, want, role));
        let passes_type_on = matches!(
            e.kind,
            Ast::Block(..) | Ast::If(..) | Ast::Lambda(..) | Ast::List(_) | Ast::Record(_)
        );
        if passes_type_on {
            self.note_type(e.span, &value.ty);
        }
        value
    }

    fn check_inner(&mut self, e: &'a ast::Expr, want: &Type, role: Role) -> Expr {
        let span = e.span;
        match (&e.kind, want) {
            (Ast::Paren(inner), _) => self.check_expr(inner, want, role),
            (Ast::Block(lets, result), _) => {
                self.block(lets, span, |checker| checker.check_expr(result, want, role))
            }
            (Ast::If(condition, yes, no), _) => {
                let condition = self.check_condition(condition, "the condition of `if`");
                let yes = self.check_expr(yes, want, role);
                let no = self.check_expr(no, want, role);
                if types::poisoned(&yes.ty) || types::poisoned(&no.ty) {
                    return poison(span);
                }
                branch(condition, yes, no, span)
            }
            (Ast::Lambda(signature, body), Type::Fn(parameters, result)) => {
                let expected = Some((&parameters[..], &**result));
                let lambda = self.lambda(signature, body, span, expected);
                self.coerce(lambda, want, role)
            }
            (Ast::Name(name), Type::Fn(parameters, _)) => {
                let value = self.name_as_function(name, parameters, span);
                self.coerce(value, want, role)
            }
            (Ast::List(elements), Type::List(of)) => self.check_list(elements, of, span, role),
            (Ast::Record(fields), Type::Record(want)) => {
                self.check_record(fields, want, span, role)
            }
            (Ast::List(elements), Type::Fn(..)) => {
                let value = self.infer_brackets(elements, span);
                self.coerce(value, want, role)
            }
            _ => {
                let value = self.infer(e);
                self.coerce(value, want, role)
            }
        }
    }

    /// Checks a condition.
    pub(super) fn check_condition(&mut self, e: &'a ast::Expr, what: &str) -> Expr {
        self.check_expr(e, &Type::Bool, Role::The(what))
    }

    fn infer_if(
        &mut self,
        condition: &'a ast::Expr,
        yes: &'a ast::Expr,
        no: &'a ast::Expr,
        span: Span,
    ) -> Expr {
        let condition = self.check_condition(condition, "the condition of `if`");
        let (yes, no) = (self.infer(yes), self.infer(no));
        let Some(ty) = types::join(&yes.ty, &no.ty) else {
            let message =
                format!("one branch is {}, the other is {}", describe(&yes.ty), describe(&no.ty));
            self.report(
                Diagnostic::error(Code::BRANCH_TYPES, no.span, message)
                    .note_at(yes.span, format!("this is {}", describe(&yes.ty)))
                    .help("both branches of an `if` must have the same type"),
            );
            return poison(span);
        };
        if types::poisoned(&ty) {
            return poison(span);
        }
        let role = Role::The("this branch");
        let yes = self.coerce(yes, &ty, role);
        let no = self.coerce(no, &ty, role);
        branch(condition, yes, no, span)
    }

    /// Checks `base.name` without a call: a swizzle, a field of a record or material, or an end of
    /// a range.
    fn infer_field(&mut self, base: &'a ast::Expr, name: &'a Name, span: Span) -> Expr {
        let base = self.infer(base);
        if types::poisoned(&base.ty) {
            return poison(span);
        }
        if let Type::Record(of) = &base.ty {
            let of = of.clone();
            return self.field(base, &of, name, span);
        }
        if let (Type::Material, Some((_, field, ty))) =
            (&base.ty, FIELDS.into_iter().find(|(field, ..)| *field == name.text))
        {
            return Expr { kind: ExprKind::MaterialField(Box::new(base), field), ty, span };
        }
        if let (Type::Range(of), "lo" | "hi") = (&base.ty, name.text.as_str()) {
            let ty = (**of).clone();
            let kind = ExprKind::RangeEnd(Box::new(base), name.text == "lo");
            return Expr { kind, ty, span };
        }
        let picked = lanes(&base.ty).and_then(|lanes| swizzle(&name.text, lanes));
        let Some(picked) = picked else { return self.no_field(&base.ty, name, span) };
        let ty = match picked.len() {
            1 => Type::Number,
            width => Type::Vec(width as u8),
        };
        Expr { kind: ExprKind::Swizzle(Box::new(base), picked), ty, span }
    }

    fn no_field(&mut self, ty: &Type, name: &'a Name, span: Span) -> Expr {
        let message = format!("{} has no `.{}`", describe(ty), name.text);
        let found = Diagnostic::error(Code::NO_FIELD, name.span, message);
        let found = match (self.look_up(&name.text), ty) {
            (Some(_), _) if !is_swizzle_word(&name.text) => {
                found.help(format!("call it: .{}(...)", name.text))
            }
            (_, Type::Vec(_) | Type::Color) => found.help(format!(
                "select one to four components of {} or {}",
                &"xyzw"[..usize::from(lanes(ty).unwrap_or(4)).min(4)],
                &"rgba"[..usize::from(lanes(ty).unwrap_or(4)).min(4)]
            )),
            (_, Type::Range(_)) => found.help("a range has .lo and .hi"),
            (_, Type::Material) => fields_of(FIELDS.iter().map(|(name, ..)| *name), name, found),
            (_, _) => found,
        };
        let needs_space = *ty == Type::Vec(2) && swizzle(&name.text, 3).is_some();
        let is_plane = needs_space && self.body.point == Some(Dim::Two);
        self.report(if is_plane { self.advise_dimension(Dim::Three, found) } else { found });
        poison(span)
    }

    /// `base[index]`, or a slice.
    fn infer_index(&mut self, base: &'a ast::Expr, index: &'a ast::Expr, span: Span) -> Expr {
        let base = self.infer(base);
        let index = self.infer(index);
        if types::poisoned(&base.ty) || types::poisoned(&index.ty) {
            return poison(span);
        }
        let ty = match (&base.ty, &index.ty) {
            (Type::List(_), Type::Range(_)) => {
                let want = Type::Range(Box::new(Type::Int));
                let index = self.coerce(index, &want, Role::The("the range of a slice"));
                let ty = base.ty.clone();
                return Expr { kind: ExprKind::Slice(Box::new(base), Box::new(index)), ty, span };
            }
            (Type::List(of), _) => (**of).clone(),
            (Type::Vec(_) | Type::Color, _) => Type::Number,
            (other, _) => {
                let message = format!("{} cannot be indexed", describe(other));
                let found = Diagnostic::error(Code::BAD_OPERAND, base.span, message);
                self.report(match other {
                    Type::Text => found.help("write a list of strings: [\"A\", \"B\", \"C\"]"),
                    _ => found,
                });
                return poison(span);
            }
        };
        let index = self.coerce(index, &Type::Int, Role::The("an index"));
        Expr { kind: ExprKind::Index(Box::new(base), Box::new(index)), ty, span }
    }

    /// Checks a lambda without an expected type.
    fn infer_lambda(
        &mut self,
        signature: &'a ast::Signature,
        body: &'a ast::Expr,
        span: Span,
    ) -> Expr {
        self.lambda(signature, body, span, lambda::NOTHING_EXPECTED)
    }
}

/// An `if` whose branches have the same type.
fn branch(condition: Expr, yes: Expr, no: Expr, span: Span) -> Expr {
    let ty = yes.ty.clone();
    let kind = ExprKind::If(Box::new(condition), Box::new(yes), Box::new(no));
    Expr { kind, ty, span }
}

fn number(value: f64, unit: Option<Unit>, whole: bool, span: Span) -> Expr {
    use std::f64::consts::{PI, TAU};
    let (value, ty) = match unit {
        Some(Unit::Deg) => (value * PI / 180.0, Type::Angle),
        Some(Unit::Turn) => (value * TAU, Type::Angle),
        Some(Unit::Rad) => (value, Type::Angle),
        None if whole => (value, Type::Int),
        None => (value, Type::Number),
    };
    Expr { kind: ExprKind::Number(value), ty, span }
}

/// Decodes sRGB bytes to linear values (IEC 61966-2-1); alpha is already linear.
fn linear(bytes: [u8; 4]) -> [f64; 4] {
    let decode = |byte: u8| {
        let value = f64::from(byte) / 255.0;
        if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
    };
    let [r, g, b, a] = bytes;
    [decode(r), decode(g), decode(b), f64::from(a) / 255.0]
}

fn is_swizzle_word(name: &str) -> bool {
    name.chars().all(|c| "xyzw".contains(c)) || name.chars().all(|c| "rgba".contains(c))
}

/// The indices of the letters in `xyzw` or `rgba`, if the vector has these components.
fn swizzle(name: &str, lanes: u8) -> Option<Vec<u8>> {
    if name.is_empty() || name.len() > 4 {
        return None;
    }
    let positions = |letters: &str| -> Option<Vec<u8>> {
        let at = |c| letters.find(c).map(|at| at as u8).filter(|at| *at < lanes);
        name.chars().map(at).collect()
    };
    positions("xyzw").or_else(|| positions("rgba"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_decoded_from_srgb() {
        let [r, g, b, a] = linear([0, 255, 188, 128]);
        assert_eq!((r, g), (0.0, 1.0));
        assert!((b - 0.502_886).abs() < 1e-6, "{b}");
        assert!((a - 128.0 / 255.0).abs() < 1e-15);
    }

    #[test]
    fn swizzles_stay_within_one_alphabet_and_the_width() {
        assert_eq!(swizzle("zxx", 3), Some(vec![2, 0, 0]));
        assert_eq!(swizzle("rgb", 3), Some(vec![0, 1, 2]));
        assert_eq!(swizzle("xg", 3), None);
        assert_eq!(swizzle("z", 2), None);
        assert_eq!(swizzle("xyzwx", 4), None);
    }
}
