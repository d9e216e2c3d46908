//! The kernel's names and what they take.

use crate::hir::Kernel;

/// A name of the kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Builtin {
    /// `pi`, `tau`, `inf`
    Number(f64),
    /// Seconds.
    Time,
    /// A whole number.
    Frame,
    /// The shadow without penumbra.
    Hard,
    /// Componentwise mathematics.
    Math(Math),
    /// `vec2`, `vec3`, `vec4`
    Vector(u8),
    /// `length`, `distance`, `dot`, `cross`, `normalize`
    Geometry(Kernel),
    /// `lift`
    Lift,
    /// `hash`, `hash3`
    Hash(Kernel),
    /// `len`
    Len,
    /// `iterate`
    Iterate,
    /// `bounds`
    Bounds,
    /// `gradient`, `material_at`: of a shape at a point
    AtPoint(Kernel),
    /// `material`
    Material,
    /// `with`
    With,
    /// `rgb`, `hsv`, `oklch`
    Color(Kernel),
    /// `soft`
    Soft,
    /// `glyph_curves`
    GlyphCurves,
}

/// A componentwise function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Math {
    pub kernel: Kernel,
    /// How many arguments; `None` is any number of values or lists.
    pub arity: Option<usize>,
    pub result: MathResult,
}

/// What a componentwise function gives for plain numbers; vectors give vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MathResult {
    /// A number.
    Number,
    /// An int.
    Whole,
    /// An angle.
    Angle,
    /// What it is given: ints give an int, angles an angle.
    Same,
    /// As `Same` of the first two; the third is a number.
    Mix,
}

/// Every name of the kernel, for suggestions.
pub(super) const NAMES: &[&str] = &[
    "pi",
    "tau",
    "inf",
    "time",
    "frame",
    "hard",
    "soft",
    "abs",
    "sign",
    "floor",
    "ceil",
    "round",
    "trunc",
    "fract",
    "sqrt",
    "inverseSqrt",
    "exp",
    "exp2",
    "log",
    "log2",
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "sinh",
    "cosh",
    "tanh",
    "saturate",
    "min",
    "max",
    "pow",
    "atan2",
    "step",
    "mix",
    "clamp",
    "smoothstep",
    "length",
    "distance",
    "dot",
    "cross",
    "normalize",
    "vec2",
    "vec3",
    "vec4",
    "lift",
    "hash",
    "hash3",
    "len",
    "iterate",
    "bounds",
    "gradient",
    "material",
    "material_at",
    "with",
    "rgb",
    "hsv",
    "oklch",
    "glyph_curves",
];

/// What a name means to the kernel.
pub(super) fn builtin(name: &str) -> Option<Builtin> {
    use Kernel as K;
    use MathResult::{Angle, Mix, Number, Same, Whole};
    let math =
        |kernel, arity, result| Some(Builtin::Math(Math { kernel, arity: Some(arity), result }));
    let many = |kernel| Some(Builtin::Math(Math { kernel, arity: None, result: Same }));
    match name {
        "pi" => Some(Builtin::Number(std::f64::consts::PI)),
        "tau" => Some(Builtin::Number(std::f64::consts::TAU)),
        "inf" => Some(Builtin::Number(f64::INFINITY)),
        "time" => Some(Builtin::Time),
        "frame" => Some(Builtin::Frame),
        "hard" => Some(Builtin::Hard),
        "soft" => Some(Builtin::Soft),
        "abs" => math(K::Abs, 1, Same),
        "sign" => math(K::Sign, 1, Whole),
        "floor" => math(K::Floor, 1, Whole),
        "ceil" => math(K::Ceil, 1, Whole),
        "round" => math(K::Round, 1, Whole),
        "trunc" => math(K::Trunc, 1, Whole),
        "fract" => math(K::Fract, 1, Number),
        "sqrt" => math(K::Sqrt, 1, Number),
        "inverseSqrt" => math(K::InverseSqrt, 1, Number),
        "exp" => math(K::Exp, 1, Number),
        "exp2" => math(K::Exp2, 1, Number),
        "log" => math(K::Log, 1, Number),
        "log2" => math(K::Log2, 1, Number),
        "sin" => math(K::Sin, 1, Number),
        "cos" => math(K::Cos, 1, Number),
        "tan" => math(K::Tan, 1, Number),
        "asin" => math(K::Asin, 1, Angle),
        "acos" => math(K::Acos, 1, Angle),
        "atan" => math(K::Atan, 1, Angle),
        "sinh" => math(K::Sinh, 1, Number),
        "cosh" => math(K::Cosh, 1, Number),
        "tanh" => math(K::Tanh, 1, Number),
        "saturate" => math(K::Saturate, 1, Number),
        "min" => many(K::Min),
        "max" => many(K::Max),
        "pow" => math(K::Pow, 2, Number),
        "atan2" => math(K::Atan2, 2, Angle),
        "step" => math(K::Step, 2, Number),
        "mix" => math(K::Mix, 3, Mix),
        "clamp" => math(K::Clamp, 3, Same),
        "smoothstep" => math(K::Smoothstep, 3, Number),
        "length" => Some(Builtin::Geometry(K::Length)),
        "distance" => Some(Builtin::Geometry(K::Distance)),
        "dot" => Some(Builtin::Geometry(K::Dot)),
        "cross" => Some(Builtin::Geometry(K::Cross)),
        "normalize" => Some(Builtin::Geometry(K::Normalize)),
        "vec2" => Some(Builtin::Vector(2)),
        "vec3" => Some(Builtin::Vector(3)),
        "vec4" => Some(Builtin::Vector(4)),
        "lift" => Some(Builtin::Lift),
        "hash" => Some(Builtin::Hash(K::Hash)),
        "hash3" => Some(Builtin::Hash(K::Hash3)),
        "len" => Some(Builtin::Len),
        "iterate" => Some(Builtin::Iterate),
        "bounds" => Some(Builtin::Bounds),
        "gradient" => Some(Builtin::AtPoint(K::Gradient)),
        "material_at" => Some(Builtin::AtPoint(K::MaterialAt)),
        "material" => Some(Builtin::Material),
        "with" => Some(Builtin::With),
        "rgb" => Some(Builtin::Color(K::Rgb)),
        "hsv" => Some(Builtin::Color(K::Hsv)),
        "oklch" => Some(Builtin::Color(K::Oklch)),
        "glyph_curves" => Some(Builtin::GlyphCurves),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_name_means_something() {
        for name in NAMES {
            assert!(builtin(name).is_some(), "{name}");
        }
    }
}
