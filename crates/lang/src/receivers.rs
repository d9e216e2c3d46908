//! Tells which functions and shapes are methods of a value, for completion.

use sdfc_syntax::ast::{Parm, TypeExpr, TypeExprKind};

use crate::check::builtins::FIELDS;
pub use crate::check::kernel::takes_first as kernel_takes;
use crate::check::types::{blend, named, same_value};
use crate::hir::Type;

/// Returns the fields of a material, with their types.
pub fn material_fields() -> [(&'static str, Type); 5] {
    FIELDS.map(|(name, _, ty)| (name, ty))
}

/// Returns true if a value of a type can be the argument of a parameter.
pub fn takes(parm: &Parm, ty: &Type) -> bool {
    match (&parm.ty, ty) {
        (None, _) => same_value(ty, &Type::Number),
        (Some(written), Type::List(of)) if parm.variadic => {
            takes_type(written, ty) || takes_type(written, of)
        }
        (Some(written), _) => takes_type(written, ty),
    }
}

fn takes_type(written: &TypeExpr, ty: &Type) -> bool {
    match (&written.kind, ty) {
        (TypeExprKind::Named(word), _) => match &word[..] {
            "shape" => matches!(ty, Type::Shape(_)),
            "point" => matches!(ty, Type::Vec(2 | 3)),
            _ => named(word).is_some_and(|want| is_value_of(ty, &want)),
        },
        (TypeExprKind::List(of), Type::List(ty)) => takes_type(of, ty),
        (TypeExprKind::List(_), _) => false,
        (TypeExprKind::Record(fields), Type::Record(of)) => {
            fields.len() == of.len()
                && fields.iter().all(|field| {
                    let same_name = |(name, _): &&(String, Type)| *name == field.name.text;
                    of.iter().find(same_name).is_some_and(|(_, ty)| takes_type(&field.ty, ty))
                })
        }
        (TypeExprKind::Record(_), _) => false,
        (TypeExprKind::Fn(parameters, result), Type::Fn(types, ty)) => {
            parameters.len() == types.len() && takes_type(result, ty)
        }
        (TypeExprKind::Fn(..), _) => false,
    }
}

/// True if a value is wanted there, or one that is the same at each point, such as a colour where a
/// pattern is wanted.
fn is_value_of(ty: &Type, want: &Type) -> bool {
    let is_constant = if let Type::Fn(_, result) = want {
        *want != blend() && same_value(ty, result)
    } else {
        false
    };
    is_constant || same_value(ty, want)
}
