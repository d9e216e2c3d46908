//! Vectors and lists in brackets, and the elements made by `for`.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_syntax::ast::{self, ExprKind as Ast};

use super::coerce::Role;
use super::types::{self, describe};
use super::{Checker, poison};
use crate::hir::{Comprehension, Element, Expr, ExprKind, Type};

/// The expected type of each element of a list.
type Want<'w> = Option<(&'w Type, Role<'w>)>;

impl<'a> Checker<'a> {
    /// Checks `[...]`: two to four numbers are a vector, everything else is a list.
    pub(super) fn infer_brackets(&mut self, elements: &'a [ast::Element], span: Span) -> Expr {
        let plain = elements.iter().all(|element| matches!(element, ast::Element::Expr(_)));
        if !plain || !(2..=4).contains(&elements.len()) {
            return self.infer_list(elements, span);
        }
        let elements: Vec<(Element, Type)> =
            elements.iter().map(|element| self.element(element, None)).collect();
        if !elements.iter().all(|(_, ty)| types::is_scalar(ty) || types::poisoned(ty)) {
            return self.list_of(elements, span);
        }
        if elements.iter().any(|(_, ty)| types::poisoned(ty)) {
            return poison(span);
        }
        let ty = Type::Vec(elements.len() as u8);
        let parts = elements.into_iter().filter_map(|(element, _)| match element {
            Element::One(mut part) => {
                part.ty = Type::Number;
                Some(part)
            }
            Element::Spread(_) | Element::For(_) => None,
        });
        Expr { kind: ExprKind::Vector(parts.collect()), ty, span }
    }

    /// Checks `[...]` as a list, also if it contains two to four numbers.
    pub(super) fn infer_list(&mut self, elements: &'a [ast::Element], span: Span) -> Expr {
        let elements = elements.iter().map(|element| self.element(element, None)).collect();
        self.list_of(elements, span)
    }

    /// Checks `[...]` as a list of elements of type `want`.
    pub(super) fn check_list(
        &mut self,
        elements: &'a [ast::Element],
        want: &Type,
        span: Span,
        role: Role,
    ) -> Expr {
        let role = match role {
            Role::Argument(..) | Role::Untyped(..) | Role::Positional(_) => role,
            Role::Result(_) | Role::Formula(_) | Role::LambdaResult | Role::The(_) => {
                Role::The("this element")
            }
        };
        let elements: Vec<Element> =
            elements.iter().map(|element| self.element(element, Some((want, role))).0).collect();
        list(elements, want.clone(), span)
    }

    /// A list of checked elements of one type.
    fn list_of(&mut self, elements: Vec<(Element, Type)>, span: Span) -> Expr {
        let Some((_, first)) = elements.first() else {
            let message = "the type of this empty list is unknown";
            self.report(
                Diagnostic::error(Code::DEGENERATE, span, message)
                    .help("pass it to a parameter with a list type, such as `points: [vec2]`"),
            );
            return poison(span);
        };
        let mut ty = first.clone();
        for (element, other) in &elements[1..] {
            match types::join(&ty, other) {
                Some(joined) => ty = joined,
                None => {
                    let found = one_type(element_span(element), &ty, other);
                    self.report(found);
                    return poison(span);
                }
            }
        }
        if types::poisoned(&ty) {
            return poison(span);
        }
        let role = Role::The("this element");
        let elements = elements
            .into_iter()
            .map(|(element, _)| self.coerce_element(element, &ty, role))
            .collect();
        self.limit_type(list(elements, ty, span))
    }

    /// Checks an element, against the type in `want` if there is one. Returns its type too.
    pub(super) fn element(&mut self, element: &'a ast::Element, want: Want) -> (Element, Type) {
        self.with_stack(|checker| match element {
            ast::Element::Expr(e) => {
                let value = match want {
                    Some((want, role)) => checker.check_expr(e, want, role),
                    None => checker.infer(e),
                };
                let ty = value.ty.clone();
                (Element::One(value), ty)
            }
            ast::Element::For(each) => checker.comprehension(each, want),
        })
    }

    fn comprehension(&mut self, each: &'a ast::Comprehension, want: Want) -> (Element, Type) {
        let over = self.sequence(&each.over);
        let item = self.item_type(&over);
        let mark = self.body.enter();
        self.note_variable(each.name.span, &item);
        let local = self.body.declare(&each.name.text, item, each.name.span);
        let condition = each.condition.as_ref();
        let condition = condition.map(|e| self.check_condition(e, "the condition of `for`"));
        let (body, ty) = self.element(&each.body, want);
        self.body.leave(mark);
        (
            Element::For(Box::new(Comprehension { local, over, condition, body, span: each.span })),
            ty,
        )
    }

    /// Checks the sequence of `for` or `iterate`. Numbers in brackets are a list here.
    pub(super) fn sequence(&mut self, over: &'a ast::Expr) -> Expr {
        match &over.kind {
            Ast::Paren(inner) => self.sequence(inner),
            Ast::List(elements) => self.infer_list(elements, over.span),
            _ => self.infer(over),
        }
    }

    /// The type of the elements of a sequence.
    fn item_type(&mut self, over: &Expr) -> Type {
        match &over.ty {
            Type::List(of) => (**of).clone(),
            Type::Vec(_) => Type::Number,
            Type::Range(of) if **of == Type::Int => Type::Int,
            Type::Range(of) if **of == Type::Number => match &over.kind {
                ExprKind::Range(lo, _) => lo.ty.clone(),
                _ => Type::Number,
            },
            Type::Error => Type::Error,
            other => {
                let message =
                    format!("`for` takes a list, a range or a vector; this is {}", describe(other));
                let found = Diagnostic::error(Code::TYPE_MISMATCH, over.span, message);
                let found = match other {
                    Type::Int | Type::Number => found.help("count up to it: 0..n"),
                    _ => found,
                };
                self.report(found);
                Type::Error
            }
        }
    }

    /// Coerces a checked element to type `want`.
    pub(super) fn coerce_element(&mut self, element: Element, want: &Type, role: Role) -> Element {
        match element {
            Element::One(value) => Element::One(self.coerce(value, want, role)),
            Element::Spread(value) => {
                let want = Type::List(Box::new(want.clone()));
                Element::Spread(self.coerce(value, &want, role))
            }
            Element::For(mut each) => {
                let body = std::mem::replace(&mut each.body, Element::One(poison(each.span)));
                each.body = self.with_stack(|checker| checker.coerce_element(body, want, role));
                Element::For(each)
            }
        }
    }
}

fn list(elements: Vec<Element>, of: Type, span: Span) -> Expr {
    Expr { kind: ExprKind::List(elements), ty: Type::List(Box::new(of)), span }
}

fn element_span(element: &Element) -> Span {
    match element {
        Element::One(value) | Element::Spread(value) => value.span,
        Element::For(each) => each.span,
    }
}

fn one_type(span: Span, ty: &Type, other: &Type) -> Diagnostic {
    let message = format!(
        "all elements of a list must have the same type: this is {}, the ones before it are {}",
        describe(other),
        describe(ty)
    );
    let found = Diagnostic::error(Code::TYPE_MISMATCH, span, message);
    match (ty, other) {
        (Type::Vec(width), other) | (other, Type::Vec(width))
            if types::is_scalar(other) && *width < 4 =>
        {
            found.help(format!("to join vectors and numbers, write vec{}(v, z)", width + 1))
        }
        _ => found,
    }
}
