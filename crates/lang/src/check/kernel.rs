//! The names that the compiler itself knows (the kernel), with their arguments and documentation.

use sdfc_graph::SurfaceVector;

use super::types::{is_numeric, is_scalar, list};
use crate::hir::{Kernel, Type};

/// The meaning of a name of the kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Builtin {
    /// `inf`
    Number(f64),
    /// `pi`, `tau`, in radians
    Angle(f64),
    /// `time`, in seconds
    Time,
    /// `frame`, a whole number
    Frame,
    /// `normal`, `view`
    SurfaceVector(SurfaceVector),
    /// `hard`, the shadow without penumbra
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
    /// `str`
    Str,
    /// `len`
    Len,
    /// `iterate`
    Iterate,
    /// `bounds`
    Bounds,
    /// `gradient`, `material_at`
    AtPoint(Kernel),
    /// `material`
    Material,
    /// `with`
    With,
    /// `rgb`, `linear_rgb`, `hsv`, `hsl`, `oklch`
    Color(Kernel),
    /// `soft`
    Soft,
    /// `glyph_curves`
    GlyphCurves,
    /// `polygon_edges`
    PolygonEdges,
    /// `outline_cells`
    OutlineCells,
    /// `alternative`
    Alternative,
}

/// A componentwise function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Math {
    pub kernel: Kernel,
    /// The number of arguments; `None` for any number of values or lists.
    pub arity: Option<usize>,
    pub result: MathResult,
}

/// The result type of a componentwise function for numbers; vectors give vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MathResult {
    /// A number.
    Number,
    /// An int.
    Whole,
    /// An angle.
    Angle,
    /// The type of the arguments: ints give an int, angles an angle.
    Same,
    /// The type of the first two arguments; the third is a number.
    Mix,
}

/// A name of the kernel and its documentation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    /// The name.
    pub name: &'static str,
    /// Its meaning.
    pub(super) builtin: Builtin,
    /// The section of the reference that lists it, such as `maths`.
    pub topic: &'static str,
    /// Its name and parameters.
    pub signature: &'static str,
    /// Its value, in a sentence or two.
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
        "pi" Builtin::Angle(std::f64::consts::PI), "pi", "Half the circumference of the unit circle: a number, and the angle of half a turn.", "2 * pi";
        "tau" Builtin::Angle(std::f64::consts::TAU), "tau", "The circumference of the unit circle: a number, and the angle of a turn.", "tau / 6";
        "inf" Builtin::Number(f64::INFINITY), "inf", "Infinity, for ranges and bounds.", "[-inf, 0, -inf] .. [inf, 1, inf]";
        "time" Builtin::Time, "time", "The time in seconds: `--time`, or the frame number divided by `--fps`. It changes without a recompile.", "0.5 + 0.2 * sin(time)";
        "frame" Builtin::Frame, "frame", "The frame number, a whole number that counts from 0. It changes without a recompile.", "frame % 30";
    }
    "maths" {
        "abs" math(K::Abs, 1, Same), "abs(x)", "The absolute value of x, for each component.", "abs(-2)";
        "sign" math(K::Sign, 1, Whole), "sign(x)", "-1 if x is below 0, 0 if it is 0, 1 if it is above 0.", "sign(-2)";
        "floor" math(K::Floor, 1, Whole), "floor(x)", "The greatest whole number not above x.", "floor(1.7)";
        "ceil" math(K::Ceil, 1, Whole), "ceil(x)", "The least whole number not below x.", "ceil(1.2)";
        "round" math(K::Round, 1, Whole), "round(x)", "The nearest whole number; halves are rounded to the even one.", "round(2.5)";
        "trunc" math(K::Trunc, 1, Whole), "trunc(x)", "x without its fractional digits, rounded towards 0.", "trunc(-1.7)";
        "fract" math(K::Fract, 1, Number), "fract(x)", "The fractional part x - floor(x): 0 or above, and below 1.", "fract(1.25)";
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
        "saturate" math(K::Saturate, 1, Number), "saturate(x)", "x clamped to the range from 0 to 1.", "saturate(1.5)";
        "min" many(K::Min), "min(a, b, ...)", "The smallest of any number of values or lists. For one vector: its smallest component.", "min(3, 1, 2)";
        "max" many(K::Max), "max(a, b, ...)", "The largest of any number of values or lists. For one vector: its largest component.", "max([3, 1, 2])";
        "sum" many(K::Sum), "sum(a, b, ...)", "The sum of any number of values or lists. For one vector: the sum of its components. The sum of an empty list is 0.", "sum([for i in 1..5: i * i])";
        "pow" math(K::Pow, 2, Number), "pow(x, n)", "x to the power of n; x is at least 0.", "pow(2, 0.5)";
        "atan2" math(K::Atan2, 2, Angle), "atan2(y, x)", "The angle of the vector [x, y], from -180deg to 180deg.", "atan2(1, -1)";
        "step" math(K::Step, 2, Number), "step(edge, x)", "0 if x is below the edge, 1 otherwise.", "step(0.5, 0.7)";
        "mix" math(K::Mix, 3, Mix), "mix(a, b, t)", "Linear interpolation: a if t is 0, b if t is 1, and a + (b - a) * t in general.", "mix(1, 3, 0.25)";
        "clamp" math(K::Clamp, 3, Same), "clamp(x, lo, hi)", "x clamped to the range from lo to hi.", "clamp(5, 0, 2)";
        "smoothstep" math(K::Smoothstep, 3, Number), "smoothstep(lo, hi, x)", "0 if x is below lo, 1 if it is above hi, and a smooth transition between.", "smoothstep(0, 1, 0.25)";
    }
    "vectors" {
        "vec2" Builtin::Vector(2), "vec2(x, y)", "A vector of two numbers. Smaller vectors and numbers are joined; one number fills both components.", "vec2(1)";
        "vec3" Builtin::Vector(3), "vec3(x, y, z)", "A vector of three numbers. Smaller vectors and numbers are joined; one number fills all components.", "vec3([1, 2], 3)";
        "vec4" Builtin::Vector(4), "vec4(x, y, z, w)", "A vector of four numbers. Smaller vectors and numbers are joined; one number fills all components.", "vec4([1, 2], [3, 4])";
        "length" Builtin::Geometry(K::Length), "length(v)", "The Euclidean length of a vector, or the absolute value of a number.", "length([3, 4])";
        "distance" Builtin::Geometry(K::Distance), "distance(a, b)", "The length of a - b.", "distance([0, 0], [3, 4])";
        "dot" Builtin::Geometry(K::Dot), "dot(a, b)", "The dot product of two vectors.", "dot([1, 2, 3], [0, 1, 0])";
        "cross" Builtin::Geometry(K::Cross), "cross(a, b)", "The cross product of two vec3, by the right-hand rule.", "cross([1, 0, 0], [0, 1, 0])";
        "normalize" Builtin::Geometry(K::Normalize), "normalize(v)", "The vector of length 1 in the direction of v; v must not be 0.", "normalize([1, 2, 3])";
        "lift" Builtin::Lift, "lift(q)", "A 2D point as a 3D point, [x, y, 0]; a vec3 is returned unchanged.", "lift([1, 2])";
    }
    "sequences" {
        "len" Builtin::Len, "len(list)", "The number of elements of a list, a vector or a range of ints.", "len([5, 6, 7])";
        "iterate" Builtin::Iterate, "iterate(over, start, step, while: fn(s) = true)", "A loop, the only one of the language. The state starts as `start`: a number, a bool, a vector, or a record of these. Each iteration replaces it by `step(state)` or `step(state, item)`. There is one iteration for each item of `over`, which is a count, a range or a list; the loop ends early when `while` is false.", "iterate(5, 1, fn(s) = s * 2)";
        "hash" Builtin::Hash(K::Hash), "hash(a, ...)", "A pseudorandom number from 0 to 1, computed from the arguments rounded down; the same on every device.", "hash(7, [1, 2, 3])";
        "hash3" Builtin::Hash(K::Hash3), "hash3(a, ...)", "Three pseudorandom numbers from 0 to 1, computed from the arguments rounded down.", "hash3(7)";
    }
    "of shapes" {
        "bounds" Builtin::Bounds, "bounds(a)", "The bounding box of a shape: a range of points, with `.lo` and `.hi`. For a function that makes shapes: the box around all of them.", "bounds(sphere(2)).hi";
        "gradient" Builtin::AtPoint(K::Gradient), "gradient(a, q)", "The gradient of a shape's distance at a point: it points away from the shape, and its length is the slope.", "fn(q: vec3) = gradient(sphere(1), q)";
        "material_at" Builtin::AtPoint(K::MaterialAt), "material_at(a, q)", "The material of a shape at a point.", "fn(q: vec3) = material_at(sphere(1), q)";
    }
    "materials and light" {
        "material" Builtin::Material, "material(color: #999, roughness: 0.5, metallic: 0, emission: #000, occlusion: 1)", "A material. `color` is the base colour, `roughness` goes from 0 (mirror) to 1 (matt), `metallic` from 0 to 1, `emission` is light that the surface gives off, `occlusion` goes from 1 (all light) over 0 (no ambient light) to -1 (no light at all).", "material(color: #d4af37, roughness: 0.2, metallic: 1)";
        "with" Builtin::With, "m.with(color: c, ...)", "A copy of a material, or of a record, with some fields changed.", "material().with(roughness: 0.1)";
        "normal" Builtin::SurfaceVector(SurfaceVector::Normal), "normal", "In a material: the unit vector that points out of the surface, in the coordinates of the scene.", "fn(q: vec3) = mix(#7a6a58, #ffffff, saturate(4 * normal.y - 2))";
        "view" Builtin::SurfaceVector(SurfaceVector::View), "view", "In a material: the unit vector from the surface to the eye, in the coordinates of the scene. In a reflection it points back along the reflected ray. Meshes and fields have no eye: there it is `normal`.", "fn(q: vec3) = mix(#203040, #ffffff, pow(1 - saturate(dot(normal, view)), 3))";
        "rgb" Builtin::Color(K::Rgb), "rgb(r, g, b, a: 1)", "A colour from sRGB red, green and blue, each from 0 to 1, as in colour literals. A vec3 can stand for the three.", "rgb(1, 0.5, 0)";
        "linear_rgb" Builtin::Color(K::LinearRgb), "linear_rgb(r, g, b, a: 1)", "A colour from amounts of light, as in `.rgb` of a colour. They can be above 1. A vec3 can stand for the three.", "linear_rgb(#ffb347.rgb * 2)";
        "hsv" Builtin::Color(K::Hsv), "hsv(h, s, v, a: 1)", "A colour from hue, saturation and value. The hue is a number of turns or an angle: 0 is red.", "hsv(0.3, 0.8, 1)";
        "hsl" Builtin::Color(K::Hsl), "hsl(h, s, l, a: 1)", "A colour from hue, saturation and lightness, as in CSS. The hue is a number of turns or an angle: 0 is red.", "hsl(210deg, 0.6, 0.5)";
        "oklch" Builtin::Color(K::Oklch), "oklch(l, c, h, a: 1)", "A colour from perceptual lightness, chroma and hue (Oklch, Ottosson 2020); h is an angle.", "oklch(0.7, 0.15, 150deg)";
        "hard" Builtin::Hard, "hard", "A hard shadow, for a light's `shadow`.", "hard";
        "soft" Builtin::Soft, "soft(sharpness)", "A soft shadow, for a light's `shadow`: the penumbra is 1 / sharpness of the distance to the occluder wide. Beside a shape whose field is less than the distance, such as a blend, it is wider.", "soft(8)";
    }
    "text and outlines" {
        "str" Builtin::Str, "str(a, ...)", "Strings and numbers, joined to one string. Numbers have at most six digits after the decimal point. All must be known when the scene compiles.", "str(\"No. \", 7)";
        "glyph_curves" Builtin::GlyphCurves, "glyph_curves(text, font: \"sans\", align: \"left\", spacing: 0, leading: 1.2)", "The outline of a text as circular arcs, for the library's `text`: in ems, with the first baseline at y = 0 and the inside on the left, within 2e-5 ems of the font's curves. Each arc is [start, tangent point, end, [s, e]]; the tangents at both ends meet in the tangent point. s and e tell the side of points whose nearest point is that end: 1 outside, -1 inside, 0 that of the arc.", "len(glyph_curves(\"a\"))";
        "polygon_edges" Builtin::PolygonEdges, "polygon_edges(points)", "The boundary of the area that a closed polygon fills by the even-odd rule, for the library's `polygon`, in the form of `glyph_curves`: [start, middle, end, [s, e]], with the inside on the left. It is empty if a corner depends on a param, or if there are more than 4,096 corners.", "len(polygon_edges([[0, 0], [1, 0], [0, 1]]))";
        "outline_cells" Builtin::OutlineCells, "outline_cells(pieces, corner, side, counts)", "Which pieces of an outline, in the form of `glyph_curves`, may be nearest in the cells of a grid, for the library. counts[0] columns and counts[1] rows begin at the corner. The result is [starts, items, [most]]: cell k has the pieces items[starts[k]] to items[starts[k + 1] - 1].", "len(outline_cells(glyph_curves(\"a\"), [0, 0], 0.1, [5, 6]))";
        "alternative" Builtin::Alternative, "alternative(short, bounded)", "Two formulas of one number, for the library: shaders compute the first, everything else the second, whose bounds over a box should be closer. Nothing checks that both are equal.", "alternative(1, 1)";
    }
};

/// The meaning of a name in the kernel, if it has one.
pub(super) fn builtin(name: &str) -> Option<Builtin> {
    ROWS.iter().find(|row| row.name == name).map(|row| row.builtin)
}

/// Returns true if a value of a type can be the first argument of a function of the kernel.
pub fn takes_first(name: &str, ty: &Type) -> bool {
    let Some(builtin) = builtin(name) else { return false };
    match builtin {
        Builtin::Number(_) | Builtin::Angle(_) => false,
        Builtin::Time | Builtin::Frame | Builtin::SurfaceVector(_) | Builtin::Hard => false,
        Builtin::Soft | Builtin::Material => false,
        Builtin::Math(_) | Builtin::Hash(_) => is_numeric(ty),
        Builtin::Vector(_) => is_numeric(ty) && !matches!(ty, Type::Color),
        Builtin::Geometry(_) | Builtin::Lift => matches!(ty, Type::Vec(_)),
        Builtin::Len => matches!(ty, Type::List(_) | Type::Range(_) | Type::Vec(_)),
        Builtin::Iterate => matches!(ty, Type::List(_) | Type::Range(_) | Type::Int),
        Builtin::Bounds | Builtin::AtPoint(_) => matches!(ty, Type::Shape(_)),
        Builtin::With => matches!(ty, Type::Material | Type::Record(_)),
        Builtin::Color(_) => matches!(ty, Type::Number | Type::Int | Type::Vec(3)),
        Builtin::GlyphCurves => *ty == Type::Text,
        Builtin::PolygonEdges => *ty == list(Type::Vec(2)),
        Builtin::OutlineCells => *ty == list(list(Type::Vec(2))),
        Builtin::Alternative => *ty == Type::Number,
        Builtin::Str => *ty == Type::Text || is_scalar(ty),
    }
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
