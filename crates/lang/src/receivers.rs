//! Which functions and shapes can be called as methods of a value, for completion.

use sdfc_graph::Dim;
use sdfc_syntax::ast::{Parm, TypeExpr, TypeExprKind};

use crate::check::kernel::takes_first;
use crate::hir::Type;

/// Returns true if a value of a type can be the argument of a parameter.
pub fn takes(parm: &Parm, ty: &Type) -> bool {
    match (&parm.ty, ty) {
        (None, _) => fits("number", ty),
        (Some(written), Type::List(of)) if parm.variadic => {
            takes_type(written, ty) || takes_type(written, of)
        }
        (Some(written), _) => takes_type(written, ty),
    }
}

/// Returns true if a value of a type can be the first argument of a function of the kernel.
pub fn kernel_takes(name: &str, ty: &Type) -> bool {
    takes_first(name, ty)
}

fn takes_type(written: &TypeExpr, ty: &Type) -> bool {
    match (&written.kind, ty) {
        (TypeExprKind::Named(word), _) => fits(word, ty),
        (TypeExprKind::List(of), Type::List(ty)) => takes_type(of, ty),
        (TypeExprKind::List(_), _) => false,
        (TypeExprKind::Fn(parameters, result), Type::Fn(types, ty)) => {
            parameters.len() == types.len() && takes_type(result, ty)
        }
        (TypeExprKind::Fn(..), _) => false,
    }
}

fn fits(word: &str, ty: &Type) -> bool {
    match ty {
        Type::Number => matches!(word, "number" | "length"),
        Type::Int => matches!(word, "number" | "length" | "int"),
        Type::Angle => word == "angle",
        Type::Bool => word == "bool",
        Type::Text => word == "string",
        Type::Vec(2) => matches!(word, "vec2" | "point"),
        Type::Vec(3) => matches!(word, "vec3" | "point"),
        Type::Vec(_) => word == "vec4",
        Type::Color => matches!(word, "color" | "pattern"),
        Type::Range(_) => word == "range",
        Type::Fn(parameters, result) => match (&parameters[..], &**result) {
            ([Type::Number, Type::Number], Type::Number) => word == "blend",
            ([Type::Vec(3)], Type::Color) => word == "pattern",
            ([..], _) => false,
        },
        Type::Shape(Dim::Three) => matches!(word, "solid" | "shape"),
        Type::Shape(Dim::Two) => matches!(word, "region" | "shape"),
        Type::Material => word == "material",
        Type::List(_) | Type::Shadow | Type::Error => false,
    }
}
