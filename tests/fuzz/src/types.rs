//! The types of the language, as far as the generator uses them.

use sdfc_lang::hir;
use sdfc_syntax::ast::{TypeExpr, TypeExprKind};

/// A type. Shapes and points have a fixed dimension.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ty {
    /// A line of a program: it has no value.
    Statement,
    /// A number or a length.
    Number,
    /// A whole number.
    Int,
    /// An angle.
    Angle,
    /// A bool.
    Bool,
    /// A string.
    Text,
    /// A vector of two to four numbers.
    Vec(u8),
    /// A colour.
    Color,
    /// A solid.
    Solid,
    /// A region.
    Region,
    /// A material.
    Material,
    /// The shadow of a light.
    Shadow,
    /// A list.
    List(Box<Ty>),
    /// A function.
    Fn(Vec<Ty>, Box<Ty>),
}

impl Ty {
    /// The shapes with this number of dimensions.
    pub fn shape(dimensions: u8) -> Self {
        if dimensions == 2 { Self::Region } else { Self::Solid }
    }

    /// The type of blends.
    pub fn blend() -> Self {
        Self::Fn(vec![Self::Number, Self::Number], Box::new(Self::Number))
    }

    /// The type of patterns.
    pub fn pattern() -> Self {
        Self::Fn(vec![Self::Vec(3)], Box::new(Self::Color))
    }

    /// Returns true for a shape.
    pub fn is_shape(&self) -> bool {
        matches!(self, Self::Solid | Self::Region)
    }

    /// Returns the type that is written, where `shape` and `point` have some dimensions.
    ///
    /// # Errors
    ///
    /// The name of a type that is not known here.
    pub fn written(expr: &TypeExpr, dimensions: u8) -> Result<Self, String> {
        match &expr.kind {
            TypeExprKind::Named(name) => Self::named(name, dimensions),
            TypeExprKind::List(of) => Ok(Self::List(Box::new(Self::written(of, dimensions)?))),
            TypeExprKind::Fn(parameters, result) => {
                let parameters = parameters.iter().map(|ty| Self::written(ty, dimensions));
                let result = Self::written(result, dimensions)?;
                Ok(Self::Fn(parameters.collect::<Result<_, _>>()?, Box::new(result)))
            }
            TypeExprKind::Record(_) => Err("the generator does not know records".to_owned()),
        }
    }

    fn named(name: &str, dimensions: u8) -> Result<Self, String> {
        Ok(match name {
            "number" | "length" => Self::Number,
            "int" => Self::Int,
            "angle" => Self::Angle,
            "bool" => Self::Bool,
            "string" => Self::Text,
            "vec2" => Self::Vec(2),
            "vec3" => Self::Vec(3),
            "vec4" => Self::Vec(4),
            "color" => Self::Color,
            "solid" => Self::Solid,
            "region" => Self::Region,
            "shape" => Self::shape(dimensions),
            "point" => Self::Vec(dimensions),
            "material" => Self::Material,
            "blend" => Self::blend(),
            "pattern" => Self::pattern(),
            _ => return Err(format!("the generator does not know the type `{name}`")),
        })
    }

    /// Returns the type of a setting's parameter.
    ///
    /// # Errors
    ///
    /// A type that no setting had when this was written.
    pub fn of_setting(ty: &hir::Type) -> Result<Self, String> {
        Ok(match ty {
            hir::Type::Number => Self::Number,
            hir::Type::Int => Self::Int,
            hir::Type::Angle => Self::Angle,
            hir::Type::Text => Self::Text,
            hir::Type::Color => Self::Color,
            hir::Type::Vec(width) => Self::Vec(*width),
            hir::Type::Shadow => Self::Shadow,
            hir::Type::Bool
            | hir::Type::Range(_)
            | hir::Type::List(_)
            | hir::Type::Record(_)
            | hir::Type::Fn(..)
            | hir::Type::Shape(_)
            | hir::Type::Material
            | hir::Type::Error => {
                return Err(format!("the generator does not know settings of {ty:?}"));
            }
        })
    }

    /// Returns the type as a program writes it; `None` if no word stands for it.
    pub fn word(&self) -> Option<&'static str> {
        Some(match self {
            Self::Number => "number",
            Self::Int => "int",
            Self::Angle => "angle",
            Self::Bool => "bool",
            Self::Vec(2) => "vec2",
            Self::Vec(3) => "vec3",
            Self::Vec(_) => "vec4",
            Self::Color => "color",
            Self::Solid => "solid",
            Self::Region => "region",
            Self::Material => "material",
            ty if *ty == Self::blend() => "blend",
            ty if *ty == Self::pattern() => "pattern",
            Self::Statement | Self::Text | Self::Shadow | Self::List(_) | Self::Fn(..) => {
                return None;
            }
        })
    }

    /// Returns the simplest value, to which programs are shrunk; `None` if the type has none that
    /// fits everywhere.
    pub fn simplest(&self) -> Option<&'static str> {
        Some(match self {
            Self::Number | Self::Int => "1",
            Self::Angle => "30deg",
            Self::Bool => "true",
            Self::Vec(2) => "[1, 2]",
            Self::Vec(3) => "[1, 2, 3]",
            Self::Vec(_) => "[1, 2, 3, 4]",
            Self::Color => "#888",
            Self::Solid => "sphere()",
            Self::Region => "circle()",
            Self::Material => "material()",
            Self::Shadow => "hard",
            ty if *ty == Self::blend() => "min",
            Self::Fn(parameters, result) if parameters[..] == [(**result).clone()] => "fn(q) = q",
            // A value stands for a constant function.
            Self::Fn(_, result) => return result.simplest(),
            Self::Statement | Self::Text | Self::List(_) => return None,
        })
    }
}
