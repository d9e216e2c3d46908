//! Calls of kernel functions.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph as graph;

use super::call::{Callee, Given, Value, count};
use super::coerce::bind;
use super::decl::ParameterSignature;
use super::kernel::Builtin;
use super::operators::as_type;
use super::types::{self, describe, is_scalar, lanes, list};
use super::{Checker, poison};
use crate::hir::{Expr, ExprKind, Kernel, LocalId, MaterialField, Type};

/// The fields of a material by name.
pub(crate) const FIELDS: [(&str, MaterialField, Type); 5] = [
    ("color", MaterialField::Color, Type::Color),
    ("roughness", MaterialField::Roughness, Type::Number),
    ("metallic", MaterialField::Metallic, Type::Number),
    ("emission", MaterialField::Emission, Type::Color),
    ("occlusion", MaterialField::Occlusion, Type::Number),
];

/// A parameter of a kernel function.
pub(super) fn parameter(name: &str, ty: Type, optional: bool) -> ParameterSignature<'_> {
    ParameterSignature { name, ty, variadic: false, optional, untyped: false, default: None }
}

/// An operation of the kernel.
pub(super) fn kernel(kernel: Kernel, arguments: Vec<Expr>, ty: Type, span: Span) -> Expr {
    Expr { kind: ExprKind::Kernel(kernel, arguments), ty, span }
}

fn color(value: [f64; 4], span: Span) -> Expr {
    Expr { kind: ExprKind::Color(value), ty: Type::Color, span }
}

fn number(value: f64, span: Span) -> Expr {
    Expr { kind: ExprKind::Number(value), ty: Type::Number, span }
}

/// The default of a material's field, which is also the value for shapes without a material.
fn default_of(field: MaterialField, span: Span) -> Expr {
    let [x, y, z, _] = match field {
        MaterialField::Color => graph::MaterialField::Color,
        MaterialField::Roughness => graph::MaterialField::Roughness,
        MaterialField::Metallic => graph::MaterialField::Metallic,
        MaterialField::Emission => graph::MaterialField::Emission,
        MaterialField::Occlusion => graph::MaterialField::Occlusion,
    }
    .default_value();
    match field {
        MaterialField::Color | MaterialField::Emission => color([x, y, z, 1.0], span),
        MaterialField::Roughness | MaterialField::Metallic | MaterialField::Occlusion => {
            number(x, span)
        }
    }
}

impl<'a> Checker<'a> {
    /// Checks a call of a kernel function.
    pub(super) fn call_builtin(
        &mut self,
        builtin: Builtin,
        callee: Callee,
        given: Vec<Given<'a>>,
    ) -> Expr {
        match builtin {
            Builtin::Number(_)
            | Builtin::Angle(_)
            | Builtin::Time
            | Builtin::Frame
            | Builtin::SurfaceVector(_)
            | Builtin::Hard => {
                let message = format!("`{}` is a value, not a function", callee.name);
                self.report(Diagnostic::error(Code::WRONG_CALL, callee.at, message));
                self.give_up(given, callee.span)
            }
            Builtin::Math(math) => self.math(math, callee, given),
            Builtin::Vector(width) => self.vector(width, callee, given),
            Builtin::Geometry(kernel) => self.geometry(kernel, callee, given),
            Builtin::Lift => self.lift(callee, given),
            Builtin::Hash(kernel) => self.hash(kernel, callee, given),
            Builtin::Len => self.len(callee, given),
            Builtin::Str => self.str(callee, given),
            Builtin::Iterate => self.iterate(callee, given),
            Builtin::Bounds => self.bounds(callee, given),
            Builtin::AtPoint(kernel) => self.at_point(kernel, callee, given),
            Builtin::Material => self.material(callee, given),
            Builtin::With => self.with(callee, given),
            Builtin::Color(kernel) => self.color(kernel, callee, given),
            Builtin::Soft => {
                let parameters = [parameter("sharpness", Type::Number, false)];
                let arguments = self.all_arguments(callee, &parameters, given);
                kernel(Kernel::Soft, arguments, Type::Shadow, callee.span)
            }
            Builtin::GlyphCurves => self.glyph_curves(callee, given),
            Builtin::PolygonEdges => {
                let parameters = [parameter("points", list(Type::Vec(2)), false)];
                let arguments = self.all_arguments(callee, &parameters, given);
                let pieces = list(list(Type::Vec(2)));
                kernel(Kernel::PolygonEdges, arguments, pieces, callee.span)
            }
            Builtin::OutlineCells => {
                let parameters = [
                    parameter("pieces", list(list(Type::Vec(2))), false),
                    parameter("corner", Type::Vec(2), false),
                    parameter("side", Type::Number, false),
                    parameter("counts", Type::Vec(2), false),
                ];
                let arguments = self.all_arguments(callee, &parameters, given);
                kernel(Kernel::OutlineCells, arguments, list(list(Type::Int)), callee.span)
            }
            Builtin::Alternative => {
                let parameters = [
                    parameter("short", Type::Number, false),
                    parameter("bounded", Type::Number, false),
                ];
                let arguments = self.all_arguments(callee, &parameters, given);
                kernel(Kernel::Alternative, arguments, Type::Number, callee.span)
            }
        }
    }

    /// `glyph_curves(text, font: "sans", align: "left", spacing: 0, leading: 1.2)`
    fn glyph_curves(&mut self, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let span = callee.span;
        let text =
            |value: &str| Expr { kind: ExprKind::Text(value.to_owned()), ty: Type::Text, span };
        let parameters = [
            parameter("text", Type::Text, false),
            parameter("font", Type::Text, true),
            parameter("align", Type::Text, true),
            parameter("spacing", Type::Number, true),
            parameter("leading", Type::Number, true),
        ];
        let defaults =
            [poison(span), text("sans"), text("left"), number(0.0, span), number(1.2, span)];
        let arguments = self.arguments(callee, &parameters, given);
        let arguments = arguments.into_iter().zip(defaults);
        let arguments = arguments.map(|(value, default)| value.unwrap_or(default)).collect();
        kernel(Kernel::GlyphCurves, arguments, list(list(Type::Vec(2))), span)
    }

    /// Checks arguments that are all required; missing ones are reported elsewhere.
    fn all_arguments(
        &mut self,
        callee: Callee,
        parameters: &[ParameterSignature<'a>],
        given: Vec<Given<'a>>,
    ) -> Vec<Expr> {
        let arguments = self.arguments(callee, parameters, given);
        arguments.into_iter().map(|value| value.unwrap_or_else(|| poison(callee.span))).collect()
    }

    /// Checks a number of positional arguments of any type; `None` if one is wrong.
    pub(super) fn positional(
        &mut self,
        callee: Callee,
        given: Vec<Given<'a>>,
        least: usize,
        most: usize,
    ) -> Option<Vec<Expr>> {
        let fits = (least..=most).contains(&given.len());
        if !fits {
            let wants = match (least, most) {
                (least, usize::MAX) => format!("at least {}", count(least, "argument")),
                (least, most) if least == most => count(least, "argument"),
                (least, most) => format!("{least} to {most} arguments"),
            };
            let are = if given.len() == 1 { "is" } else { "are" };
            let message = format!("`{}` takes {wants}; {} {are} given", callee.name, given.len());
            let found = Diagnostic::error(Code::ARGUMENTS, callee.at, message);
            self.report(match (callee.name, given.len()) {
                ("atan", 2) => found.help("of two numbers, write atan2(y, x)"),
                _ => found,
            });
            self.give_up(given, callee.span);
            return None;
        }
        let mut values = Vec::with_capacity(given.len());
        for given in given {
            self.unnamed(callee, &given);
            values.push(self.one_value(given));
        }
        (!values.iter().any(|value| types::poisoned(&value.ty))).then_some(values)
    }

    pub(super) fn unnamed(&mut self, callee: Callee, given: &Given) {
        if let Some(name) = given.name {
            let message = format!("the arguments of `{}` cannot be named", callee.name);
            self.report(Diagnostic::error(Code::ARGUMENTS, name.span, message));
        }
    }

    pub(super) fn wrong_argument(&mut self, callee: Callee, value: &Expr, wants: &str) -> Expr {
        let message = format!("`{}` takes {wants}; this is {}", callee.name, describe(&value.ty));
        let found = Diagnostic::error(Code::TYPE_MISMATCH, value.span, message);
        let is_local = matches!(value.kind, ExprKind::Local(_)) && value.ty == Type::Number;
        self.report(match is_local && wants.contains("vec") {
            true => found.help(
                "a parameter without a type is a number; a vector's has one: fn f(q: vec3) = \
                 length(q)",
            ),
            false => found,
        });
        poison(callee.span)
    }

    /// Checks `vec3(v.xy, z)`: joins its arguments in order; one number fills all components.
    fn vector(&mut self, width: u8, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let ty = Type::Vec(width);
        let Some(parts) = self.positional(callee, given, 1, 4) else { return poison(callee.span) };
        let mut total = 0;
        for part in &parts {
            match lanes(&part.ty) {
                Some(lanes) => total += lanes,
                None if is_scalar(&part.ty) => total += 1,
                None => return self.wrong_argument(callee, part, "numbers and vectors"),
            }
        }
        if let [part] = &parts[..]
            && is_scalar(&part.ty)
        {
            return as_type(part.clone(), &ty);
        }
        if total != width {
            let message = format!("`{}` needs {width} numbers; these are {total}", callee.name);
            self.report(Diagnostic::error(Code::ARGUMENTS, callee.at, message));
            return poison(callee.span);
        }
        let parts = parts.into_iter().map(|part| match lanes(&part.ty) {
            Some(lanes) => as_type(part, &Type::Vec(lanes)),
            None => as_type(part, &Type::Number),
        });
        Expr { kind: ExprKind::Vector(parts.collect()), ty, span: callee.span }
    }

    fn geometry(&mut self, function: Kernel, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let arity = match function {
            Kernel::Length | Kernel::Normalize => 1,
            _ => 2,
        };
        let Some(values) = self.positional(callee, given, arity, arity) else {
            return poison(callee.span);
        };
        let Some(ty) = self.common(callee, values.iter().map(|value| (value, &value.ty))) else {
            return poison(callee.span);
        };
        let span = callee.span;
        let mut values: Vec<Expr> = values.into_iter().map(|value| as_type(value, &ty)).collect();
        match (function, &ty) {
            (Kernel::Cross, Type::Vec(3)) | (Kernel::Normalize, Type::Vec(_)) => {
                kernel(function, values, ty, span)
            }
            (Kernel::Length | Kernel::Distance | Kernel::Dot, Type::Vec(_)) => {
                kernel(function, values, Type::Number, span)
            }
            // A number counts as a vector with one component.
            (Kernel::Length, Type::Number) => kernel(Kernel::Abs, values, ty, span),
            (Kernel::Dot, Type::Number) => kernel(Kernel::Mul, values, ty, span),
            (Kernel::Distance, Type::Number) => {
                let difference = kernel(Kernel::Sub, values, Type::Number, span);
                kernel(Kernel::Abs, vec![difference], ty, span)
            }
            _ => {
                let wants = if function == Kernel::Cross { "two vec3" } else { "vectors" };
                let value = Expr { ty, ..values.swap_remove(0) };
                self.wrong_argument(callee, &value, wants)
            }
        }
    }

    fn lift(&mut self, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let Some(values) = self.positional(callee, given, 1, 1) else { return poison(callee.span) };
        match values[0].ty {
            Type::Vec(2 | 3) => kernel(Kernel::Lift, values, Type::Vec(3), callee.span),
            _ => self.wrong_argument(callee, &values[0], "a point, vec2 or vec3"),
        }
    }

    fn hash(&mut self, function: Kernel, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let Some(values) = self.positional(callee, given, 1, usize::MAX) else {
            return poison(callee.span);
        };
        let numeric = |ty: &Type| is_scalar(ty) || matches!(ty, Type::Vec(_));
        if let Some(wrong) = values.iter().find(|value| !numeric(&value.ty)) {
            return self.wrong_argument(callee, wrong, "numbers and vectors");
        }
        let ty = if function == Kernel::Hash { Type::Number } else { Type::Vec(3) };
        kernel(function, values, ty, callee.span)
    }

    fn len(&mut self, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let Some(values) = self.positional(callee, given, 1, 1) else { return poison(callee.span) };
        match &values[0].ty {
            Type::List(_) | Type::Vec(_) => kernel(Kernel::Len, values, Type::Int, callee.span),
            Type::Range(of) if is_scalar(of) => kernel(Kernel::Len, values, Type::Int, callee.span),
            _ => self.wrong_argument(callee, &values[0], "a list, a range of ints or a vector"),
        }
    }

    /// Checks `str(a, ...)` of strings and numbers.
    fn str(&mut self, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let Some(values) = self.positional(callee, given, 1, usize::MAX) else {
            return poison(callee.span);
        };
        let is_joined = |ty: &Type| matches!(ty, Type::Text | Type::Number | Type::Int);
        match values.iter().find(|value| !is_joined(&value.ty)) {
            Some(other) => self.wrong_argument(callee, other, "strings and numbers"),
            None => kernel(Kernel::Str, values, Type::Text, callee.span),
        }
    }

    /// Checks `bounds(a)` of a shape, or of a function that makes shapes.
    fn bounds(&mut self, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let Some(values) = self.positional(callee, given, 1, 1) else { return poison(callee.span) };
        let dim = match &values[0].ty {
            Type::Shape(dim) => Some(*dim),
            Type::Fn(_, result) => match **result {
                Type::Shape(dim) => Some(dim),
                _ => None,
            },
            _ => None,
        };
        match dim {
            Some(dim) => {
                let ty = Type::Range(Box::new(types::point(dim)));
                kernel(Kernel::Bounds, values, ty, callee.span)
            }
            None => self.wrong_argument(callee, &values[0], "a shape"),
        }
    }

    /// Checks `gradient(a, q)` and `material_at(a, q)`.
    fn at_point(&mut self, function: Kernel, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let Some(values) = self.positional(callee, given, 2, 2) else { return poison(callee.span) };
        let Type::Shape(dim) = values[0].ty else {
            return self.wrong_argument(callee, &values[0], "a shape and a point");
        };
        let point = types::point(dim);
        if values[1].ty != point {
            let wants =
                format!("a {} and its point, a {}", types::shape_word(dim), types::show(&point));
            return self.wrong_argument(callee, &values[1], &wants);
        }
        let ty = if function == Kernel::Gradient { point } else { Type::Material };
        kernel(function, values, ty, callee.span)
    }

    /// Checks `material(color: ..., roughness: ...)`; every field is optional.
    fn material(&mut self, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        let parameters = FIELDS.map(|(name, _, ty)| parameter(name, ty, true));
        let span = callee.span;
        let arguments = self.arguments(callee, &parameters, given);
        let fields = arguments
            .into_iter()
            .zip(FIELDS)
            .map(|(value, (_, field, _))| value.unwrap_or_else(|| default_of(field, span)));
        kernel(Kernel::Material, fields.collect(), Type::Material, span)
    }

    /// Checks `m.with(color: c)` of a material, or `r.with(name: a)` of a record.
    fn with(&mut self, callee: Callee, mut given: Vec<Given<'a>>) -> Expr {
        let first = given.first_mut().filter(|given| given.name.is_none());
        if let Some(Type::Record(fields)) = first.map(|first| self.look_at(first)) {
            return self.changed(callee, &fields, given);
        }
        let mut parameters = vec![parameter("material", Type::Material, false)];
        parameters.extend(FIELDS.map(|(name, _, ty)| parameter(name, ty, true)));
        let mut arguments = self.arguments(callee, &parameters, given).into_iter();
        let Some(base) = arguments.next().flatten() else { return poison(callee.span) };
        let changes: Vec<(MaterialField, Expr)> = arguments
            .zip(FIELDS)
            .filter_map(|(value, (_, field, _))| Some((field, value?)))
            .collect();
        let kind = ExprKind::With(Box::new(base), changes);
        Expr { kind, ty: Type::Material, span: callee.span }
    }

    /// Checks `rgb(r, g, b)` and its kin; alpha is optional. A vec3 can stand for the first three
    /// arguments, except of `oklch`. The hue of `hsv` and `hsl` is a number of turns or an angle.
    fn color(&mut self, function: Kernel, callee: Callee, given: Vec<Given<'a>>) -> Expr {
        use Type::{Angle, Number};
        let names = match function {
            Kernel::Hsv => [("h", Number), ("s", Number), ("v", Number)],
            Kernel::Hsl => [("h", Number), ("s", Number), ("l", Number)],
            Kernel::Oklch => [("l", Number), ("c", Number), ("h", Angle)],
            _ => [("r", Number), ("g", Number), ("b", Number)],
        };
        let mut parameters = names.map(|(name, ty)| parameter(name, ty, false)).to_vec();
        parameters.push(parameter("a", Number, true));
        let span = callee.span;
        let (joined, given) = self.color_arguments(function, given);
        let arguments = self.arguments(callee, &parameters, given);
        let opaque = |value: Option<Expr>| value.unwrap_or_else(|| number(1.0, span));
        let arguments = arguments.into_iter().map(opaque).collect();
        let color = kernel(function, arguments, Type::Color, span);
        match joined {
            Some((local, value)) => Expr { span, ..bind(local, "v", value, color) },
            None => color,
        }
    }

    /// The arguments of a function that makes a colour, with a vec3 taken apart and an angle of a
    /// hue in turns. The vec3 is the value of a variable, which is returned too.
    fn color_arguments(
        &mut self,
        function: Kernel,
        mut given: Vec<Given<'a>>,
    ) -> (Option<(LocalId, Expr)>, Vec<Given<'a>>) {
        if function == Kernel::Oklch {
            return (None, given);
        }
        let is_first = |given: &Given| given.name.is_none_or(|name| name.text == "h");
        let Some(at) = given.iter().position(is_first) else { return (None, given) };
        let (Value::Expr(e), name) = (given[at].value.clone(), given[at].name) else {
            return (None, given);
        };
        let value = self.infer(e);
        if value.ty == Type::Vec(3) && name.is_none() {
            let (local, mention) = self.name_value(&value);
            let component = |at| {
                let kind = ExprKind::Swizzle(Box::new(mention.clone()), vec![at]);
                Given::done(Expr { kind, ty: Type::Number, span: value.span })
            };
            given.splice(at..=at, [0, 1, 2].map(component));
            return (Some((local, value)), given);
        }
        let value = if value.ty == Type::Angle && matches!(function, Kernel::Hsv | Kernel::Hsl) {
            let span = value.span;
            let turn = number(std::f64::consts::TAU, span);
            kernel(Kernel::Div, vec![as_type(value, &Type::Number), turn], Type::Number, span)
        } else {
            value
        };
        given[at] = Given { name, ..Given::done(value) };
        (None, given)
    }
}
