//! Operators: arithmetic, union, intersection and difference of shapes, comparisons, ranges.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::Dim;
use sdfc_syntax::ast::{self, BinaryOp, ExprKind as Ast, UnaryOp};

use super::call::{Callee, Given};
use super::coerce::{has_no_need_of_a_unit, region_for_solid, splat};
use super::names::Found;
use super::types::{self, describe, is_numeric, is_scalar, show};
use super::{Checker, poison};
use crate::hir::{Element, Expr, ExprKind, Kernel, Type};

impl<'a> Checker<'a> {
    pub(super) fn infer_unary(&mut self, op: UnaryOp, operand: &'a ast::Expr, span: Span) -> Expr {
        let operand = self.infer(operand);
        let (kernel, fits) = match op {
            UnaryOp::Neg => (Kernel::Neg, is_numeric(&operand.ty)),
            UnaryOp::Not => (Kernel::Not, operand.ty == Type::Bool),
        };
        if types::poisoned(&operand.ty) {
            return poison(span);
        }
        if !fits {
            let (sign, wants) = match op {
                UnaryOp::Neg => ("-", "a number, angle or vector"),
                UnaryOp::Not => ("!", "a bool"),
            };
            let message = format!("`{sign}` needs {wants}; this is {}", describe(&operand.ty));
            let found = Diagnostic::error(Code::BAD_OPERAND, operand.span, message);
            let found = match operand.ty {
                Type::Shape(_) => found.help("`a - b` subtracts b from a"),
                _ => found,
            };
            self.report(found);
            return poison(span);
        }
        let ty = operand.ty.clone();
        Expr { kind: ExprKind::Kernel(kernel, vec![operand]), ty, span }
    }

    pub(super) fn infer_binary(
        &mut self,
        op: BinaryOp,
        at: Span,
        left: &'a ast::Expr,
        right: &'a ast::Expr,
        span: Span,
    ) -> Expr {
        let (a, b) = (self.infer(left), self.infer(right));
        if types::poisoned(&a.ty) || types::poisoned(&b.ty) {
            return poison(span);
        }
        match op {
            BinaryOp::Union | BinaryOp::Intersect => self.shapes(op, at, left, a, b, span),
            BinaryOp::Sub if is_shape(&a) && is_shape(&b) => self.shapes(op, at, left, a, b, span),
            BinaryOp::Mul | BinaryOp::Div | BinaryOp::Rem | BinaryOp::Add | BinaryOp::Sub => {
                self.arithmetic(op, at, a, b, span)
            }
            BinaryOp::Range => self.range(at, a, b, span),
            BinaryOp::Eq
            | BinaryOp::Ne
            | BinaryOp::Lt
            | BinaryOp::Le
            | BinaryOp::Gt
            | BinaryOp::Ge => self.comparison(op, at, a, b, span),
            BinaryOp::And | BinaryOp::Or => self.logic(op, at, a, b, span),
        }
    }

    /// `| & -` on shapes: the library's union, intersection and difference, even if the scene
    /// declares these names. A chain of one operator becomes one call with many arguments.
    fn shapes(
        &mut self,
        op: BinaryOp,
        at: Span,
        left: &'a ast::Expr,
        mut a: Expr,
        b: Expr,
        span: Span,
    ) -> Expr {
        let (Type::Shape(dim), Type::Shape(other)) = (&a.ty, &b.ty) else {
            return self.bad_operands(op, at, &a, &b, span);
        };
        if dim != other {
            let region = if *dim == Dim::Two { &a } else { &b };
            let wanted = format!("`{}` combines it with a solid (3D)", sign(op));
            let found = region_for_solid(region.span, &wanted);
            self.report(found);
            return poison(span);
        }
        if let Some(parts) = chain(op, left, &mut a) {
            parts.push(Element::One(b));
            return Expr { span, ..a };
        }
        let name = match op {
            BinaryOp::Union => "union",
            BinaryOp::Intersect => "intersection",
            _ => "difference",
        };
        let Some(Found::Decls(decls)) = self.look_up_library(name) else {
            let message = format!("`{}` needs `{name}`, which the library lacks", sign(op));
            self.report(Diagnostic::error(Code::UNKNOWN_NAME, at, message));
            return poison(span);
        };
        let given = vec![Given::done(a), Given::done(b)];
        self.call_decls(&decls, Callee { name, at, span }, given)
    }

    fn arithmetic(&mut self, op: BinaryOp, at: Span, a: Expr, b: Expr, span: Span) -> Expr {
        let Some(ty) = arithmetic_type(op, &a, &b) else {
            return self.bad_operands(op, at, &a, &b, span);
        };
        let kernel = match op {
            BinaryOp::Mul => Kernel::Mul,
            BinaryOp::Div => Kernel::Div,
            BinaryOp::Rem => Kernel::Rem,
            BinaryOp::Add => Kernel::Add,
            _ => Kernel::Sub,
        };
        let arguments = vec![operand(a, &ty, op), operand(b, &ty, op)];
        Expr { kind: ExprKind::Kernel(kernel, arguments), ty, span }
    }

    fn range(&mut self, at: Span, a: Expr, b: Expr, span: Span) -> Expr {
        let ty = match (&a.ty, &b.ty) {
            (Type::Color, _) | (_, Type::Color) => None,
            _ => arithmetic_type(BinaryOp::Add, &a, &b),
        };
        let Some(ty) = ty else { return self.bad_operands(BinaryOp::Range, at, &a, &b, span) };
        let (a, b) = (as_type(a, &ty), as_type(b, &ty));
        let kind = ExprKind::Range(Box::new(a), Box::new(b));
        Expr { kind, ty: Type::Range(Box::new(ty)), span }
    }

    fn comparison(&mut self, op: BinaryOp, at: Span, a: Expr, b: Expr, span: Span) -> Expr {
        let numbers = is_scalar(&a.ty) && is_scalar(&b.ty);
        let equality = matches!(op, BinaryOp::Eq | BinaryOp::Ne)
            && a.ty == b.ty
            && matches!(a.ty, Type::Bool | Type::Text);
        if !numbers && !equality {
            return self.bad_operands(op, at, &a, &b, span);
        }
        let kernel = match op {
            BinaryOp::Eq => Kernel::Eq,
            BinaryOp::Ne => Kernel::Ne,
            BinaryOp::Lt => Kernel::Lt,
            BinaryOp::Le => Kernel::Le,
            BinaryOp::Gt => Kernel::Gt,
            _ => Kernel::Ge,
        };
        let arguments = if numbers {
            vec![as_type(a, &Type::Number), as_type(b, &Type::Number)]
        } else {
            vec![a, b]
        };
        Expr { kind: ExprKind::Kernel(kernel, arguments), ty: Type::Bool, span }
    }

    fn logic(&mut self, op: BinaryOp, at: Span, a: Expr, b: Expr, span: Span) -> Expr {
        if a.ty != Type::Bool || b.ty != Type::Bool {
            return self.bad_operands(op, at, &a, &b, span);
        }
        let kernel = if op == BinaryOp::And { Kernel::And } else { Kernel::Or };
        Expr { kind: ExprKind::Kernel(kernel, vec![a, b]), ty: Type::Bool, span }
    }

    fn bad_operands(&mut self, op: BinaryOp, at: Span, a: &Expr, b: &Expr, span: Span) -> Expr {
        let message = format!("`{}` {}; {}", sign(op), purpose(op), these(&a.ty, &b.ty));
        let found = Diagnostic::error(Code::BAD_OPERAND, at, message);
        let found = match operand_help(op, &a.ty, &b.ty) {
            Some(help) => found.help(help),
            None => found,
        };
        self.report(found);
        poison(span)
    }
}

/// The operands of `a | b`, if that is the left operand of another `|`.
fn chain<'e>(op: BinaryOp, left: &ast::Expr, a: &'e mut Expr) -> Option<&'e mut Vec<Element>> {
    if !matches!(&left.kind, Ast::Binary(before, ..) if *before == op) {
        return None;
    }
    let ExprKind::Build(_, arguments) = &mut a.kind else { return None };
    arguments.iter_mut().flatten().find_map(|argument| match &mut argument.kind {
        ExprKind::List(parts) => Some(parts),
        _ => None,
    })
}

fn is_shape(e: &Expr) -> bool {
    matches!(e.ty, Type::Shape(_))
}

/// The type of a sum, product or remainder; `None` if the operands do not match.
fn arithmetic_type(op: BinaryOp, a: &Expr, b: &Expr) -> Option<Type> {
    match (&a.ty, &b.ty) {
        (x, y) if is_scalar(x) && is_scalar(y) => Some(scalar_type(op, a, b)),
        (Type::Vec(width), other) | (other, Type::Vec(width))
            if is_scalar(other) || *other == Type::Vec(*width) =>
        {
            Some(Type::Vec(*width))
        }
        (Type::Color, other) | (other, Type::Color)
            if is_scalar(other) || *other == Type::Color =>
        {
            Some(Type::Color)
        }
        _ => None,
    }
}

/// The type of an operation on scalars. Ints give an int, except for `/`. Angles can be added,
/// multiplied by numbers, and divided by each other.
fn scalar_type(op: BinaryOp, a: &Expr, b: &Expr) -> Type {
    use Type::{Angle, Int, Number};
    match (op, &a.ty, &b.ty) {
        (BinaryOp::Div, Int, Int) => Number,
        (_, Int, Int) => Int,
        (BinaryOp::Div, Angle, Angle) => Number,
        (BinaryOp::Mul, Angle, Angle) => Number,
        (_, Angle, Angle) => Angle,
        (BinaryOp::Mul | BinaryOp::Div, Angle, _) => Angle,
        (BinaryOp::Mul, _, Angle) => Angle,
        (BinaryOp::Add | BinaryOp::Sub, Angle, _) if has_no_need_of_a_unit(b) => Angle,
        (BinaryOp::Add | BinaryOp::Sub, _, Angle) if has_no_need_of_a_unit(a) => Angle,
        _ => Number,
    }
}

/// An operand with the width of the result. A number beside a colour does not change its alpha.
fn operand(value: Expr, ty: &Type, op: BinaryOp) -> Expr {
    if *ty != Type::Color || !is_scalar(&value.ty) {
        return as_type(value, ty);
    }
    let neutral = match op {
        BinaryOp::Mul | BinaryOp::Div => 1.0,
        _ => 0.0,
    };
    let span = value.span;
    let rgb = splat(value, &Type::Vec(3));
    let alpha = Expr { kind: ExprKind::Number(neutral), ty: Type::Number, span };
    Expr { kind: ExprKind::Vector(vec![rgb, alpha]), ty: Type::Color, span }
}

/// A numeric value with the width of a type.
pub(super) fn as_type(mut value: Expr, ty: &Type) -> Expr {
    if is_scalar(&value.ty) && !is_scalar(ty) {
        return splat(value, ty);
    }
    value.ty = ty.clone();
    value
}

/// The operator's symbol.
fn sign(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Mul => "*",
        BinaryOp::Div => "/",
        BinaryOp::Rem => "%",
        BinaryOp::Add => "+",
        BinaryOp::Sub => "-",
        BinaryOp::Union => "|",
        BinaryOp::Intersect => "&",
        BinaryOp::Range => "..",
        BinaryOp::Eq => "==",
        BinaryOp::Ne => "!=",
        BinaryOp::Lt => "<",
        BinaryOp::Le => "<=",
        BinaryOp::Gt => ">",
        BinaryOp::Ge => ">=",
        BinaryOp::And => "&&",
        BinaryOp::Or => "||",
    }
}

/// The operator's purpose, for messages.
fn purpose(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Mul => "multiplies numbers",
        BinaryOp::Div => "divides numbers",
        BinaryOp::Rem => "takes the remainder of numbers",
        BinaryOp::Add => "adds numbers",
        BinaryOp::Sub => "subtracts numbers or shapes",
        BinaryOp::Union => "joins shapes",
        BinaryOp::Intersect => "intersects shapes",
        BinaryOp::Range => "makes a range of two numbers or vectors",
        BinaryOp::Eq | BinaryOp::Ne => "compares numbers, bools or strings",
        BinaryOp::Lt | BinaryOp::Le | BinaryOp::Gt | BinaryOp::Ge => "compares numbers",
        BinaryOp::And | BinaryOp::Or => "combines bools",
    }
}

fn these(a: &Type, b: &Type) -> String {
    if a == b {
        return match a {
            Type::List(_) => "these are lists".into(),
            Type::Fn(..) => "these are functions".into(),
            Type::Record(_) => "these are records".into(),
            _ => format!("these are {}s", show(a)),
        };
    }
    format!("these are {} and {}", describe(a), describe(b))
}

fn operand_help(op: BinaryOp, a: &Type, b: &Type) -> Option<&'static str> {
    let both = |test: fn(&Type) -> bool| test(a) && test(b);
    let shape = |ty: &Type| matches!(ty, Type::Shape(_));
    match op {
        BinaryOp::Add if both(shape) => Some("`a | b` is their union"),
        BinaryOp::Add if both(|ty| matches!(ty, Type::List(_))) => {
            Some("to join lists, write [for x in a: x, for x in b: x]")
        }
        BinaryOp::Add if matches!(a, Type::List(of) if types::same_value(b, of)) => {
            Some("to append to a list, write [for x in a: x, b]")
        }
        BinaryOp::Add if *a == Type::Text || *b == Type::Text => {
            Some("strings and numbers are joined by str(a, b)")
        }
        BinaryOp::Mul if both(shape) => Some("`a & b` is their intersection"),
        BinaryOp::And if both(shape) => Some("`a & b` is their intersection"),
        BinaryOp::Or if both(shape) => Some("`a | b` is their union"),
        BinaryOp::Mul | BinaryOp::Div if shape(a) || shape(b) => Some("a.scale(2) resizes a shape"),
        BinaryOp::Add | BinaryOp::Sub if shape(a) && is_scalar(b) => {
            Some("a.round(0.1) grows a shape; a.translate([1, 0, 0]) moves it")
        }
        BinaryOp::Add | BinaryOp::Sub if shape(a) || shape(b) => {
            Some("a.translate([1, 0, 0]) moves a shape")
        }
        BinaryOp::Union | BinaryOp::Intersect if both(|ty| *ty == Type::Bool) => {
            Some("use `||` and `&&` for bools")
        }
        BinaryOp::Eq | BinaryOp::Ne | BinaryOp::Lt | BinaryOp::Le | BinaryOp::Gt | BinaryOp::Ge
            if matches!(a, Type::Vec(_)) || matches!(b, Type::Vec(_)) =>
        {
            Some("compare components, or compare length(a - b) with a number")
        }
        BinaryOp::Mul
        | BinaryOp::Div
        | BinaryOp::Rem
        | BinaryOp::Add
        | BinaryOp::Sub
        | BinaryOp::Range
            if matches!((a, b), (Type::Color, Type::Vec(_)) | (Type::Vec(_), Type::Color)) =>
        {
            Some("select the colour's components: .rgb")
        }
        BinaryOp::Mul | BinaryOp::Div | BinaryOp::Rem | BinaryOp::Add | BinaryOp::Sub
            if matches!((a, b), (Type::Vec(_), Type::Vec(_))) =>
        {
            Some("both vectors need the same size: select components, such as `.xy`")
        }
        BinaryOp::Mul
        | BinaryOp::Div
        | BinaryOp::Rem
        | BinaryOp::Add
        | BinaryOp::Sub
        | BinaryOp::Union
        | BinaryOp::Intersect
        | BinaryOp::Range
        | BinaryOp::Eq
        | BinaryOp::Ne
        | BinaryOp::Lt
        | BinaryOp::Le
        | BinaryOp::Gt
        | BinaryOp::Ge
        | BinaryOp::And
        | BinaryOp::Or => None,
    }
}
