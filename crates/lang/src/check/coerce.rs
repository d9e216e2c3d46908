//! All coercions between types, and the diagnostics for values that cannot be coerced.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::Dim;

use super::types::{self, describe, is_scalar, poisoned, same_value};
use super::{Checker, poison};
use crate::hir::{Comprehension, Element, Expr, ExprKind, Kernel, Lambda, LocalId, Type};
use crate::synonyms;

/// The purpose of a value: the subject of the message if its type is wrong.
#[derive(Clone, Copy, Debug)]
pub(super) enum Role<'r> {
    /// A parameter of a declaration, setting or kernel function.
    Argument(&'r str, &'r str),
    /// A parameter without a type.
    Untyped(&'r str, &'r str),
    /// An argument of a function value, counted from 1.
    Positional(usize),
    /// The result of a function.
    Result(&'r str),
    /// The formula of a shape.
    Formula(&'r str),
    /// The result of a lambda.
    LambdaResult,
    /// Any other value, described as in `the condition of if`.
    The(&'r str),
}

impl Role<'_> {
    /// The role as a subject: ``rotate's `y` ``.
    pub(super) fn subject(self) -> String {
        match self {
            Self::Argument(callee, parameter) | Self::Untyped(callee, parameter) => {
                format!("{callee}'s `{parameter}`")
            }
            Self::Positional(at) => format!("argument {at} of this function"),
            Self::Result(name) => format!("the result of `{name}`"),
            Self::Formula(name) => format!("the formula of `{name}`"),
            Self::LambdaResult => "the result of this function".into(),
            Self::The(what) => what.into(),
        }
    }
}

impl Checker<'_> {
    /// Coerces a value to type `want`. If that is impossible, reports it and returns a poisoned
    /// value.
    pub(super) fn coerce(&mut self, value: Expr, want: &Type, role: Role) -> Expr {
        match self.try_coerce(value, want) {
            Ok(value) => value,
            Err(value) => {
                let found = self.mismatch(&value, want, role);
                self.report(found);
                poison(value.span)
            }
        }
    }

    /// The diagnostic for a value of the wrong type.
    pub(super) fn mismatch(&self, value: &Expr, want: &Type, role: Role) -> Diagnostic {
        let found = mismatch(value, want, role);
        let ExprKind::Local(id) = value.kind else { return found };
        let Some(parameter) = self.body.variables().find(|it| it.id == id && it.untyped) else {
            return found;
        };
        let (name, ty) = (parameter.name, types::show(value_type(want)));
        let help = format!("`{name}` has no type, so it is a number: write {name}: {ty}");
        let fix = format!("write the type of `{name}`");
        let found = Diagnostic { help: Vec::new(), fixes: Vec::new(), ..found };
        found.help(help).fix(fix, parameter.span.after(), format!(": {ty}"))
    }

    /// Coerces a value to type `want`, or returns the value itself as an error.
    pub(super) fn try_coerce(&mut self, mut value: Expr, want: &Type) -> Result<Expr, Expr> {
        if poisoned(&value.ty) || poisoned(want) {
            return Ok(poison(value.span));
        }
        if same_value(&value.ty, want) || (*want == Type::Angle && has_no_need_of_a_unit(&value)) {
            value.ty = want.clone();
            return Ok(value);
        }
        match (value.ty.clone(), want) {
            (have, Type::Vec(_)) if is_scalar(&have) => Ok(splat(value, want)),
            (Type::Range(_), Type::Range(want)) => self.coerce_range(value, want),
            (Type::List(have), Type::List(want)) => self.coerce_list(value, &have, want),
            (Type::Record(have), Type::Record(want)) => self.coerce_record(value, &have, want),
            (Type::Fn(parameters, result), Type::Fn(want, want_result)) => {
                self.coerce_function(value, (&parameters, &result), (want, want_result))
            }
            // A constant blend would ignore both distances; the author meant its width.
            (_, Type::Fn(..)) if *want == types::blend() => Err(value),
            (_, Type::Fn(_, result)) => {
                let span = value.span;
                let value = Box::new(self.try_coerce(value, result)?);
                Ok(Expr { kind: ExprKind::Constant(value), ty: want.clone(), span })
            }
            _ => Err(value),
        }
    }

    fn coerce_range(&mut self, value: Expr, want: &Type) -> Result<Expr, Expr> {
        let (ty, span) = (Type::Range(Box::new(want.clone())), value.span);
        if let ExprKind::Range(lo, hi) = value.kind {
            let original = value.ty;
            return match (self.try_coerce(*lo.clone(), want), self.try_coerce(*hi.clone(), want)) {
                (Ok(lo), Ok(hi)) => {
                    Ok(Expr { kind: ExprKind::Range(Box::new(lo), Box::new(hi)), ty, span })
                }
                _ => Err(Expr { kind: ExprKind::Range(lo, hi), ty: original, span }),
            };
        }
        let Type::Range(of) = value.ty.clone() else { return Err(value) };
        let (local, mention) = self.name_value(&value);
        let end = |checker: &mut Self, low| {
            let kind = ExprKind::RangeEnd(Box::new(mention.clone()), low);
            checker.try_coerce(Expr { kind, ty: (*of).clone(), span }, want)
        };
        match (end(self, true), end(self, false)) {
            (Ok(lo), Ok(hi)) => {
                let kind = ExprKind::Range(Box::new(lo), Box::new(hi));
                let range = Expr { kind, ty: ty.clone(), span };
                Ok(bind(local, "range", value, range))
            }
            _ => Err(value),
        }
    }

    fn coerce_list(&mut self, value: Expr, have: &Type, want: &Type) -> Result<Expr, Expr> {
        let (ty, span) = (Type::List(Box::new(want.clone())), value.span);
        let local = self.body.fresh();
        let item = Expr { kind: ExprKind::Local(local), ty: have.clone(), span };
        let Ok(item) = self.try_coerce(item, want) else { return Err(value) };
        let body = Element::One(item);
        let each = Comprehension { local, over: value, condition: None, body, span };
        Ok(Expr { kind: ExprKind::List(vec![Element::For(Box::new(each))]), ty, span })
    }

    /// Wraps a function in a lambda that coerces its arguments and its result.
    fn coerce_function(
        &mut self,
        value: Expr,
        (have, have_result): (&[Type], &Type),
        (want, want_result): (&[Type], &Type),
    ) -> Result<Expr, Expr> {
        if have.len() != want.len() {
            return Err(value);
        }
        let (local, mention) = self.name_value(&value);
        let ExprKind::Local(captured) = mention.kind else { return Err(value) };
        let span = value.span;
        self.body.frames.push(Default::default());
        let function = self.body.fresh();
        let arguments: Result<Vec<Expr>, Expr> = (want.iter().zip(have))
            .map(|(want, have)| {
                let kind = ExprKind::Local(self.body.fresh());
                self.try_coerce(Expr { kind, ty: want.clone(), span }, have)
            })
            .collect();
        let body = arguments.and_then(|arguments| {
            let kind = ExprKind::Local(function);
            let function = Box::new(Expr { kind, ty: value.ty.clone(), span });
            let kind = ExprKind::Apply(function, arguments);
            self.try_coerce(Expr { kind, ty: have_result.clone(), span }, want_result)
        });
        let locals = self.body.frames.pop().map_or(0, |frame| frame.locals);
        let Ok(body) = body else { return Err(value) };
        let lambda = Lambda {
            captures: vec![captured],
            parameters: want.to_vec(),
            names: (0..want.len()).map(|at| format!("x{at}")).collect(),
            locals,
            lipschitz: None,
            requires: Vec::new(),
            body,
        };
        let ty = Type::Fn(want.to_vec(), Box::new(want_result.clone()));
        let lambda = Expr { kind: ExprKind::Lambda(Box::new(lambda)), ty, span };
        Ok(bind(local, "f", value, lambda))
    }

    /// A fresh variable for a value that is used more than once, and an expression that reads it.
    pub(super) fn name_value(&mut self, value: &Expr) -> (LocalId, Expr) {
        let local = self.body.fresh();
        let mention = Expr { kind: ExprKind::Local(local), ty: value.ty.clone(), span: value.span };
        (local, mention)
    }
}

/// `{ let name = value; result }`
pub(super) fn bind(local: LocalId, name: &str, value: Expr, result: Expr) -> Expr {
    let (ty, span) = (result.ty.clone(), value.span);
    let kind = ExprKind::Block(vec![(local, name.to_owned(), value)], Box::new(result));
    Expr { kind, ty, span }
}

/// A number, int or angle as a vector or colour with equal components.
pub(super) fn splat(mut value: Expr, ty: &Type) -> Expr {
    value.ty = Type::Number;
    let span = value.span;
    Expr { kind: ExprKind::Splat(Box::new(value)), ty: ty.clone(), span }
}

/// True for zero and infinity, which are the same in every unit.
pub(super) fn has_no_need_of_a_unit(value: &Expr) -> bool {
    match &value.kind {
        ExprKind::Number(value) => *value == 0.0 || value.is_infinite(),
        ExprKind::Kernel(Kernel::Neg, arguments) => arguments.iter().all(has_no_need_of_a_unit),
        _ => false,
    }
}

/// The diagnostic for a value of the wrong type.
pub(super) fn mismatch(value: &Expr, want: &Type, role: Role) -> Diagnostic {
    let subject = role.subject();
    let want = if matches!(value.ty, Type::Fn(..)) { want } else { value_type(want) };
    match (&value.ty, want) {
        (Type::Number | Type::Int, Type::Angle) => not_an_angle(value, &subject),
        (Type::Shape(Dim::Two), Type::Shape(Dim::Three)) => {
            region_for_solid(value.span, &format!("{subject} is a solid"))
        }
        (Type::Shape(Dim::Three), Type::Shape(Dim::Two)) => {
            solid_for_region(value.span, &format!("{subject} is a region"))
        }
        _ => {
            let message =
                format!("{subject} is {}; this is {}", describe(want), describe(&value.ty));
            let found = Diagnostic::error(Code::TYPE_MISMATCH, value.span, message);
            ways_out(value, want, role).into_iter().fold(found, Diagnostic::help)
        }
    }
}

/// The type of a value that can be used where a type is expected: a value can be a constant
/// function, so for a function it is the type of its result.
fn value_type(want: &Type) -> &Type {
    match want {
        Type::Fn(_, result) if !matches!(**result, Type::Fn(..)) && *want != types::blend() => {
            result
        }
        _ => want,
    }
}

/// The diagnostic for a region where a solid is expected.
pub(super) fn region_for_solid(span: Span, wanted: &str) -> Diagnostic {
    let message = format!("this is a region (2D); {wanted}");
    Diagnostic::error(Code::REGION_FOR_SOLID, span, message)
        .help("make it a solid: .extrude(0.2) or .revolve()")
}

/// The diagnostic for a solid where a region is expected.
pub(super) fn solid_for_region(span: Span, wanted: &str) -> Diagnostic {
    let message = format!("this is a solid (3D); {wanted}");
    Diagnostic::error(Code::SOLID_FOR_REGION, span, message)
        .help("use a 2D shape of the library, such as circle or rect")
}

pub(super) fn not_an_angle(value: &Expr, subject: &str) -> Diagnostic {
    let (literal, value_span) = (literal(value), value.span);
    let what = literal.map_or("this number".to_owned(), |value| format!("`{value}`"));
    let message = format!("{subject} is an angle; {what} has no unit");
    let found = Diagnostic::error(Code::NOT_AN_ANGLE, value.span, message);
    match literal {
        Some(value) => {
            let turn = match value / 360.0 {
                short if (short * 1000.0).fract() == 0.0 => format!(" {short}turn,"),
                _ => String::new(),
            };
            found
                .help(format!("write {value}deg,{turn} or {value} * 1rad"))
                .fix("add the unit `deg`", value_span.after(), "deg")
                .fix("add the unit `rad`", value_span.after(), "rad")
        }
        None => found.help("multiply it by a unit: `* 1deg`, `* 1turn` or `* 1rad`"),
    }
}

/// The value of a literal, including its sign.
pub(super) fn literal(value: &Expr) -> Option<f64> {
    match &value.kind {
        ExprKind::Number(value) => Some(*value),
        ExprKind::Kernel(Kernel::Neg, arguments) => Some(-literal(arguments.first()?)?),
        _ => None,
    }
}

/// Suggestions for a value of the wrong type, best first.
fn ways_out(value: &Expr, want: &Type, role: Role) -> Vec<String> {
    let have = &value.ty;
    match (role, have, want, way_out(have, want)) {
        (Role::Formula(name), Type::Shape(_), _, sampled) => {
            let made = format!("to combine shapes, declare a function: fn {name}(...) = ...");
            std::iter::once(made).chain(sampled).collect()
        }
        (Role::Argument(callee, _), Type::Record(fields), ..)
            if fields.iter().any(|(name, _)| name == callee) =>
        {
            vec![format!("to call the field `{callee}`, write (a.{callee})(...)")]
        }
        (Role::Untyped(callee, parameter), ..) => {
            let ty = types::show(have);
            vec![format!(
                "`{parameter}` has no type, so it is a number: write its type where `{callee}` is \
                 declared, {parameter}: {ty}"
            )]
        }
        (Role::Argument(callee, _), _, Type::Shape(_), None) => {
            vec![format!("pass the shape first: {callee}(a, ...) or a.{callee}(...)")]
        }
        (_, Type::Number | Type::Int, Type::Fn(..), None) if *want == types::blend() => {
            let width = literal(value).map_or("x".to_owned(), |width| width.to_string());
            vec![format!("write a blend of that width: {}", synonyms::blend_of_width(&width))]
        }
        (_, _, _, way) => way.into_iter().collect(),
    }
}

/// A suggestion to convert one type to another.
fn way_out(have: &Type, want: &Type) -> Option<String> {
    match (have, want) {
        (Type::Number | Type::Angle, Type::Int) => Some("round it to a whole number: round(x) or floor(x); a param that counts has a type: param n: int = 10".into()),
        (Type::Vec(_) | Type::List(_), Type::Angle) => Some(
            "give each axis by name: rotate(x: 10deg, y: 45deg)".into(),
        ),
        (Type::Shape(_), Type::Number) => {
            Some("to get a shape's distance, call it with a point: a(p)".into())
        }
        (Type::Fn(_, result), _) if **result == *want => {
            Some("call it, with its arguments in parentheses".into())
        }
        (Type::Fn(have, _), Type::Fn(want, _)) if have.len() != want.len() => {
            Some(format!("write a function of {} here: fn({}) = ...", count(want.len()), letters(want.len())))
        }
        (Type::Vec(_), Type::Number) => Some("take one component, such as `.x`, or its `length(...)`".into()),
        (Type::Vec(width), Type::Vec(want)) if width > want => {
            Some(format!("select components: .{}", &"xyzw"[..usize::from(*want).min(4)]))
        }
        (Type::Vec(width), Type::Vec(want)) if width < want => {
            Some(format!("add the missing components: vec{want}(v, 0)"))
        }
        (Type::Vec(3), Type::Color) => Some("write rgb(v) for sRGB values, or linear_rgb(v) for amounts of light".into()),
        (Type::Number | Type::Int | Type::Text, Type::Color) => Some("write a colour as #d94f30, or with rgb, hsl, hsv or oklch".into()),
        (Type::Color, Type::Vec(3)) => Some("take its components: .rgb".into()),
        (Type::Color | Type::Text, Type::Material) => {
            Some("make a material from a colour: material(color: #d94f30)".into())
        }
        (_, Type::Shadow) => Some("write hard or soft(8); without it, there is no shadow".into()),
        (Type::Number | Type::Int, Type::Bool) => Some("compare it: x > 0".into()),
        (Type::List(of), Type::Number | Type::Shape(Dim::Three)) if **of == Type::Vec(3) => {
            Some("along points, write a sweep: sweep(circle(0.1), points)".into())
        }
        (Type::Vec(_), Type::List(_)) => Some("two to four numbers in brackets are a vector; make a list of its components with `for`: [for c in v: c]".into()),
        _ => None,
    }
}

fn count(arguments: usize) -> String {
    match arguments {
        1 => "one argument".into(),
        n => format!("{n} arguments"),
    }
}

fn letters(arguments: usize) -> String {
    let letters = ["a", "b", "c", "d", "e", "f"];
    letters.into_iter().cycle().take(arguments).collect::<Vec<_>>().join(", ")
}
