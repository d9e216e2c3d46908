//! The kernel's names, what they take, and what they are for: one row each.

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

/// One name of the kernel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    /// The name.
    pub name: &'static str,
    /// What it means.
    pub(super) builtin: Builtin,
    /// `maths`, `vectors`, ...: where the reference lists it.
    pub topic: &'static str,
    /// How it is written.
    pub signature: &'static str,
    /// What it gives, in a sentence or two.
    pub summary: &'static str,
    /// An expression that uses it.
    pub example: &'static str,
}

macro_rules! rows {
    ($($topic:literal { $($name:literal $builtin:expr, $signature:literal, $summary:literal, $example:literal;)* })*) => {
        &[$($(Row {
            name: $name,
            builtin: $builtin,
            topic: $topic,
            signature: $signature,
            summary: $summary,
            example: $example,
        }),*),*]
    };
}

const fn math(kernel: Kernel, arity: usize, result: MathResult) -> Builtin {
    Builtin::Math(Math { kernel, arity: Some(arity), result })
}

const fn many(kernel: Kernel) -> Builtin {
    Builtin::Math(Math { kernel, arity: None, result: MathResult::Same })
}

use Kernel as K;
use MathResult::{Angle, Mix, Number, Same, Whole};

/// Every name of the kernel.
pub(crate) const ROWS: &[Row] = rows! {
    "constants" {
        "pi" Builtin::Number(std::f64::consts::PI), "pi", "Half the circumference of the unit circle.", "2 * pi";
        "tau" Builtin::Number(std::f64::consts::TAU), "tau", "The circumference of the unit circle.", "tau / 6";
        "inf" Builtin::Number(f64::INFINITY), "inf", "Infinity, for ranges and bounds.", "[-inf, 0, -inf] .. [inf, 1, inf]";
        "time" Builtin::Time, "time", "Seconds since the start: `--time`, or the frame's number divided by `--fps`. It moves without a recompile.", "0.5 + 0.2 * sin(time)";
        "frame" Builtin::Frame, "frame", "The number of the frame, whole, from 0. It moves without a recompile.", "frame % 30";
    }
    "maths" {
        "abs" math(K::Abs, 1, Same), "abs(x)", "x without its sign, component by component.", "abs(-2)";
        "sign" math(K::Sign, 1, Whole), "sign(x)", "-1, 0 or 1, as x is below, at or above 0.", "sign(-2)";
        "floor" math(K::Floor, 1, Whole), "floor(x)", "The greatest whole number not above x.", "floor(1.7)";
        "ceil" math(K::Ceil, 1, Whole), "ceil(x)", "The least whole number not below x.", "ceil(1.2)";
        "round" math(K::Round, 1, Whole), "round(x)", "The nearest whole number, halves to the even one.", "round(2.5)";
        "trunc" math(K::Trunc, 1, Whole), "trunc(x)", "x without its fraction, towards 0.", "trunc(-1.7)";
        "fract" math(K::Fract, 1, Number), "fract(x)", "x - floor(x): from 0 up to 1.", "fract(1.25)";
        "sqrt" math(K::Sqrt, 1, Number), "sqrt(x)", "The square root; x is at least 0.", "sqrt(2)";
        "inverseSqrt" math(K::InverseSqrt, 1, Number), "inverseSqrt(x)", "1 / sqrt(x); x is above 0.", "inverseSqrt(4)";
        "exp" math(K::Exp, 1, Number), "exp(x)", "e to the power of x.", "exp(1)";
        "exp2" math(K::Exp2, 1, Number), "exp2(x)", "2 to the power of x.", "exp2(10)";
        "log" math(K::Log, 1, Number), "log(x)", "The natural logarithm; x is above 0.", "log(2)";
        "log2" math(K::Log2, 1, Number), "log2(x)", "The logarithm to base 2; x is above 0.", "log2(8)";
        "sin" math(K::Sin, 1, Number), "sin(t)", "The sine of an angle, or of a number of radians.", "sin(30deg)";
        "cos" math(K::Cos, 1, Number), "cos(t)", "The cosine of an angle, or of a number of radians.", "cos(60deg)";
        "tan" math(K::Tan, 1, Number), "tan(t)", "The tangent of an angle, or of a number of radians.", "tan(45deg)";
        "asin" math(K::Asin, 1, Angle), "asin(x)", "The angle from -90deg to 90deg whose sine is x.", "asin(0.5)";
        "acos" math(K::Acos, 1, Angle), "acos(x)", "The angle from 0deg to 180deg whose cosine is x.", "acos(0.5)";
        "atan" math(K::Atan, 1, Angle), "atan(x)", "The angle from -90deg to 90deg whose tangent is x.", "atan(1)";
        "sinh" math(K::Sinh, 1, Number), "sinh(x)", "The hyperbolic sine.", "sinh(1)";
        "cosh" math(K::Cosh, 1, Number), "cosh(x)", "The hyperbolic cosine.", "cosh(1)";
        "tanh" math(K::Tanh, 1, Number), "tanh(x)", "The hyperbolic tangent.", "tanh(1)";
        "saturate" math(K::Saturate, 1, Number), "saturate(x)", "x, but at least 0 and at most 1.", "saturate(1.5)";
        "min" many(K::Min), "min(a, b, ...)", "The least of any number of values or lists; of one vector, its least component.", "min(3, 1, 2)";
        "max" many(K::Max), "max(a, b, ...)", "The greatest of any number of values or lists; of one vector, its greatest component.", "max([3, 1, 2])";
        "pow" math(K::Pow, 2, Number), "pow(x, n)", "x to the power of n; x is at least 0.", "pow(2, 0.5)";
        "atan2" math(K::Atan2, 2, Angle), "atan2(y, x)", "The angle of the vector [x, y], from -180deg to 180deg.", "atan2(1, -1)";
        "step" math(K::Step, 2, Number), "step(edge, x)", "0 where x is below the edge, else 1.", "step(0.5, 0.7)";
        "mix" math(K::Mix, 3, Mix), "mix(a, b, t)", "a where t is 0, b where t is 1, and in proportion between.", "mix(1, 3, 0.25)";
        "clamp" math(K::Clamp, 3, Same), "clamp(x, lo, hi)", "x, but at least lo and at most hi.", "clamp(5, 0, 2)";
        "smoothstep" math(K::Smoothstep, 3, Number), "smoothstep(lo, hi, x)", "0 below lo, 1 above hi, and a smooth rise between.", "smoothstep(0, 1, 0.25)";
    }
    "vectors" {
        "vec2" Builtin::Vector(2), "vec2(x, y)", "Two numbers; parts are joined, and one number fills both.", "vec2(1)";
        "vec3" Builtin::Vector(3), "vec3(x, y, z)", "Three numbers; parts are joined, and one number fills all.", "vec3([1, 2], 3)";
        "vec4" Builtin::Vector(4), "vec4(x, y, z, w)", "Four numbers; parts are joined, and one number fills all.", "vec4([1, 2], [3, 4])";
        "length" Builtin::Geometry(K::Length), "length(v)", "The Euclidean length of a vector; of a number, its absolute value.", "length([3, 4])";
        "distance" Builtin::Geometry(K::Distance), "distance(a, b)", "The length of a - b.", "distance([0, 0], [3, 4])";
        "dot" Builtin::Geometry(K::Dot), "dot(a, b)", "The scalar product.", "dot([1, 2, 3], [0, 1, 0])";
        "cross" Builtin::Geometry(K::Cross), "cross(a, b)", "The vector product of two vec3, by the right-hand rule.", "cross([1, 0, 0], [0, 1, 0])";
        "normalize" Builtin::Geometry(K::Normalize), "normalize(v)", "The vector of length 1 in the direction of v, which is not 0.", "normalize([1, 2, 3])";
        "lift" Builtin::Lift, "lift(q)", "A point of the plane as a point of space, [x, y, 0]; a vec3 as it is.", "lift([1, 2])";
    }
    "sequences" {
        "len" Builtin::Len, "len(list)", "How many elements a list, a vector or a range of ints has.", "len([5, 6, 7])";
        "iterate" Builtin::Iterate, "iterate(over, start, step, while: fn(s) = true)", "The one loop: the state begins at `start` and goes through `step`, a fn(state) or fn(state, item), once for each of `over`, an int, a range or a list, as long as `while` holds.", "iterate(5, 1, fn(s) = s * 2)";
        "hash" Builtin::Hash(K::Hash), "hash(a, ...)", "A number from 0 to 1 that looks random, from the whole parts of the arguments; the same on every device.", "hash(7, [1, 2, 3])";
        "hash3" Builtin::Hash(K::Hash3), "hash3(a, ...)", "Three numbers from 0 to 1 that look random, from the whole parts of the arguments.", "hash3(7)";
    }
    "of shapes" {
        "bounds" Builtin::Bounds, "bounds(a)", "The box around a shape: a range of points, with `.lo` and `.hi`; of a function that makes shapes, the box around them all.", "bounds(sphere(2)).hi";
        "gradient" Builtin::AtPoint(K::Gradient), "gradient(a, q)", "The direction in which the field of a shape grows at a point, as long as it grows fast.", "fn(q: vec3) = gradient(sphere(1), q)";
        "material_at" Builtin::AtPoint(K::MaterialAt), "material_at(a, q)", "The material of a shape at a point.", "fn(q: vec3) = material_at(sphere(1), q)";
    }
    "materials and light" {
        "material" Builtin::Material, "material(color: #999, roughness: 0.5, metallic: 0, emission: #000, occlusion: 1)", "A material from its fields: roughness from 0 mirror to 1 matt, metallic from 0 to 1, emission light given off, occlusion from 0 dark to 1 open.", "material(color: #d4af37, roughness: 0.2, metallic: 1)";
        "with" Builtin::With, "m.with(color: c, ...)", "A material with some fields changed.", "material().with(roughness: 0.1)";
        "rgb" Builtin::Color(K::Rgb), "rgb(r, g, b, a: 1)", "A colour from red, green and blue of sRGB, each from 0 to 1.", "rgb(1, 0.5, 0)";
        "hsv" Builtin::Color(K::Hsv), "hsv(h, s, v, a: 1)", "A colour from hue in turns, saturation and value.", "hsv(0.3, 0.8, 1)";
        "oklch" Builtin::Color(K::Oklch), "oklch(l, c, h, a: 1)", "A colour from lightness, chroma and hue, even to the eye (Ottosson 2020); h is an angle.", "oklch(0.7, 0.15, 150deg)";
        "hard" Builtin::Hard, "hard", "A shadow without penumbra, for a light's `shadow`.", "hard";
        "soft" Builtin::Soft, "soft(sharpness)", "A shadow with penumbra, for a light's `shadow`.", "soft(8)";
    }
    "text" {
        "glyph_curves" Builtin::GlyphCurves, "glyph_curves(text, font: \"sans\", align: \"left\", spacing: 0, leading: 1.2)", "The boundary of a text in ems, the first baseline at y = 0: a list of arcs of circles, inside on their left, which keep within 2e-5 ems of the font's quadratic curves. Each is a list of start, the point where the tangents at both ends meet, end, and what a point is whose nearest is the start, the end: 1 outside, -1 inside, 0 what the side tells.", "len(glyph_curves(\"a\"))";
    }
};

/// What a name means to the kernel.
pub(super) fn builtin(name: &str) -> Option<Builtin> {
    ROWS.iter().find(|row| row.name == name).map(|row| row.builtin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        for (at, row) in ROWS.iter().enumerate() {
            assert!(ROWS[..at].iter().all(|other| other.name != row.name), "{}", row.name);
        }
    }
}
