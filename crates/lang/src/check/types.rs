//! Types: their names, how messages show them, and how they relate.

use sdfc_diagnostics::{Code, Diagnostic};
use sdfc_graph::Dim;
use sdfc_syntax::ast::{DeclKind, Signature, TypeExpr, TypeExprKind};

use super::{Checker, poison};
use crate::hir::{Expr, Type};
use crate::spelling::meant;

/// The name of a type and its documentation.
pub(crate) struct Word {
    /// The name.
    pub name: &'static str,
    /// Its values, in a sentence or two.
    pub summary: &'static str,
    /// A declaration that uses it.
    pub example: &'static str,
}

macro_rules! words {
    ($($name:literal $summary:literal $example:literal;)*) => {
        &[$(Word { name: $name, summary: $summary, example: $example }),*]
    };
}

/// The names of types.
pub(crate) const WORDS: &[Word] = words! {
    "number" "A number. A parameter without a type is a number." "fn twice(x: number) = 2 * x";
    "length" "A number in scene units. It behaves like `number`; the name tells readers and sliders the unit." "fn half(h: length) = h / 2";
    "int" "A whole number: a whole literal, the result of `len` or `floor`, the variable of `for` over ints, or a sum, difference or product of ints." "fn last(n: int) = n - 1";
    "angle" "An angle, written with a unit: `90deg`, `0.25turn`, `1.57rad`, `x * 1rad`. Where an angle is expected, a plain number other than 0 is an error." "fn back(t: angle) = -t";
    "bool" "`true` or `false`; the result of comparisons, `&&`, `||` and `!`." "fn pick(big: bool) = if big { 2 } else { 1 }";
    "string" "Text between double quotes, for `text(...)`, font names, choices of a param, import paths and messages." "param style: string = \"round\" in [\"round\", \"flat\"]";
    "vec2" "Two numbers, `[x, y]`. Where a vector is expected, one number fills all its components." "fn turned(v: vec2) = [-v.y, v.x]";
    "vec3" "Three numbers, `[x, y, z]`. Letters select components in any order: `v.xz`." "fn flat(v: vec3) = v.xz";
    "vec4" "Four numbers, `[x, y, z, w]`." "fn first(v: vec4) = v.xyz";
    "color" "A colour: linear red, green, blue and alpha. Literals such as `#d94f30` are sRGB and are converted to linear values." "fn dark(c: color) = c * 0.5";
    "range" "A range `lo..hi`, with `.lo` and `.hi`. `for` and slices exclude the upper end; `in` includes it." "fn middle(r: range) = (r.lo + r.hi) / 2";
    "solid" "A 3D shape. Call it with a point, `a(q)`, to get its signed distance there." "fn pair(a: solid) = a | a.translate(x: 2)";
    "region" "A 2D shape. Call it with a vec2, `a(q)`, to get its signed distance there." "fn plate(a: region) = a.extrude(0.1)";
    "shape" "A solid or a region. All parameters of type `shape` of one call have the same dimension." "shape skin(a: shape, wall: length = 0.1) = abs(a(p)) - wall / 2";
    "point" "The type of the points of a shape: vec3 for a solid, vec2 for a region." "solid moved(a: solid, by: fn(point) -> vec3) = a(p - by(p))";
    "material" "A material: colour, roughness, metallic, emission and occlusion." "fn shiny(m: material) = m.with(roughness: 0.1)";
    "blend" "A function that joins two distances, `fn(length, length) -> length`." "fn steep(k: number) -> blend = fn(a, b) = min(a, k * b)";
    "pattern" "A colour at each point, `fn(vec3) -> color`. A single colour is a pattern too." "fn striped() -> pattern = fn(q) = if fract(q.y) < 0.5 { #fff } else { #222 }";
};

/// The type with a name, unless its dimension depends on where it is written.
pub(crate) fn named(word: &str) -> Option<Type> {
    Some(match word {
        "number" | "length" => Type::Number,
        "int" => Type::Int,
        "angle" => Type::Angle,
        "bool" => Type::Bool,
        "string" => Type::Text,
        "vec2" => Type::Vec(2),
        "vec3" => Type::Vec(3),
        "vec4" => Type::Vec(4),
        "color" => Type::Color,
        "range" => Type::Range(Box::new(Type::Number)),
        "solid" => Type::Shape(Dim::Three),
        "region" => Type::Shape(Dim::Two),
        "material" => Type::Material,
        "blend" => blend(),
        "pattern" => pattern(),
        _ => return None,
    })
}

/// The type of `blend`: two distances to one.
pub(crate) fn blend() -> Type {
    Type::Fn(vec![Type::Number, Type::Number], Box::new(Type::Number))
}

/// The type of `pattern`: a point to a colour.
pub(super) fn pattern() -> Type {
    Type::Fn(vec![Type::Vec(3)], Box::new(Type::Color))
}

/// The type of a point.
pub(super) fn point(dim: Dim) -> Type {
    match dim {
        Dim::Two => Type::Vec(2),
        Dim::Three => Type::Vec(3),
    }
}

/// The type of a list.
pub(super) fn list(of: Type) -> Type {
    Type::List(Box::new(of))
}

/// The word for a shape of a dimension.
pub(super) fn shape_word(dim: Dim) -> &'static str {
    match dim {
        Dim::Two => "region",
        Dim::Three => "solid",
    }
}

/// The type as the language writes it.
pub(crate) fn show(ty: &Type) -> String {
    match ty {
        Type::Number => "number".into(),
        Type::Int => "int".into(),
        Type::Angle => "angle".into(),
        Type::Bool => "bool".into(),
        Type::Text => "string".into(),
        Type::Vec(width) => format!("vec{width}"),
        Type::Color => "color".into(),
        Type::Range(of) => match **of {
            Type::Number | Type::Error => "range".into(),
            _ => format!("range of {}s", show(of)),
        },
        Type::List(of) => format!("[{}]", show(of)),
        Type::Fn(parameters, result) => {
            let parameters: Vec<String> = parameters.iter().map(show).collect();
            format!("fn({}) -> {}", parameters.join(", "), show(result))
        }
        Type::Record(fields) => {
            let field = |(name, ty): &(String, Type)| format!("{name}: {}", show(ty));
            format!("({})", fields.iter().map(field).collect::<Vec<_>>().join(", "))
        }
        Type::Shape(dim) => shape_word(*dim).into(),
        Type::Material => "material".into(),
        Type::Shadow => "shadow".into(),
        Type::Error => "unknown".into(),
    }
}

impl std::fmt::Display for Type {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&show(self))
    }
}

/// The type with its article: `a number`, `an angle`.
pub(super) fn describe(ty: &Type) -> String {
    match ty {
        Type::Int | Type::Angle => format!("an {}", show(ty)),
        Type::List(_) => format!("a list, {}", show(ty)),
        Type::Fn(..) => format!("a function, {}", show(ty)),
        Type::Record(_) => format!("a record, {}", show(ty)),
        Type::Shape(Dim::Two) => "a region (2D)".into(),
        Type::Shape(Dim::Three) => "a solid (3D)".into(),
        Type::Error => "unknown".into(),
        Type::Number
        | Type::Bool
        | Type::Text
        | Type::Vec(_)
        | Type::Color
        | Type::Range(_)
        | Type::Material
        | Type::Shadow => format!("a {}", show(ty)),
    }
}

/// The largest nesting depth of a type. The parser limits the depth of declared types; inferred
/// types could grow by one level with each `let`.
const MAX_DEPTH: usize = 256;
/// The largest number of parts of a type. With each `let`, a record could have twice as many.
const MAX_PARTS: usize = 1024;

/// The nesting depth of a type and the number of its parts.
fn extent(ty: &Type) -> (usize, usize) {
    let around = |inner: &mut dyn Iterator<Item = &Type>| {
        let (depth, parts) = inner
            .map(extent)
            .fold((0, 0), |(depth, parts), (of, more)| (usize::max(depth, of), parts + more));
        (1 + depth, 1 + parts)
    };
    match ty {
        Type::Range(of) | Type::List(of) => around(&mut std::iter::once(&**of)),
        Type::Fn(parameters, result) => {
            around(&mut parameters.iter().chain(std::iter::once(&**result)))
        }
        Type::Record(fields) => around(&mut fields.iter().map(|(_, ty)| ty)),
        Type::Number
        | Type::Int
        | Type::Angle
        | Type::Bool
        | Type::Text
        | Type::Vec(_)
        | Type::Color
        | Type::Shape(_)
        | Type::Material
        | Type::Shadow
        | Type::Error => (0, 1),
    }
}

/// True if a type contains an error.
pub(super) fn poisoned(ty: &Type) -> bool {
    match ty {
        Type::Error => true,
        Type::Range(of) | Type::List(of) => poisoned(of),
        Type::Fn(parameters, result) => parameters.iter().any(poisoned) || poisoned(result),
        Type::Record(fields) => fields.iter().any(|(_, ty)| poisoned(ty)),
        Type::Number
        | Type::Int
        | Type::Angle
        | Type::Bool
        | Type::Text
        | Type::Vec(_)
        | Type::Color
        | Type::Shape(_)
        | Type::Material
        | Type::Shadow => false,
    }
}

/// True for numbers, ints and angles.
pub(super) fn is_scalar(ty: &Type) -> bool {
    matches!(ty, Type::Number | Type::Int | Type::Angle)
}

/// True for types that have arithmetic.
pub(super) fn is_numeric(ty: &Type) -> bool {
    is_scalar(ty) || matches!(ty, Type::Vec(_) | Type::Color)
}

/// The number of components of a vector or colour.
pub(super) fn lanes(ty: &Type) -> Option<u8> {
    match ty {
        Type::Vec(width) => Some(*width),
        Type::Color => Some(4),
        Type::Number
        | Type::Int
        | Type::Angle
        | Type::Bool
        | Type::Text
        | Type::Range(_)
        | Type::List(_)
        | Type::Record(_)
        | Type::Fn(..)
        | Type::Shape(_)
        | Type::Material
        | Type::Shadow
        | Type::Error => None,
    }
}

/// The dimension that an argument's type selects for a declaration with two dimensions: that of the
/// shape, of the shapes in a list or record or made by a function, or of the point that a function
/// takes.
pub(super) fn dimension(ty: &Type) -> Option<Dim> {
    match ty {
        Type::Shape(dim) => Some(*dim),
        Type::List(of) => dimension(of),
        Type::Record(fields) => fields.iter().find_map(|(_, ty)| dimension(ty)),
        Type::Fn(parameters, result) => {
            dimension(result).or_else(|| parameters.first().and_then(dimension_of_point))
        }
        Type::Number
        | Type::Int
        | Type::Angle
        | Type::Bool
        | Type::Text
        | Type::Vec(_)
        | Type::Color
        | Type::Range(_)
        | Type::Material
        | Type::Shadow
        | Type::Error => None,
    }
}

/// The dimension of a point of this type.
pub(super) fn dimension_of_point(ty: &Type) -> Option<Dim> {
    match ty {
        Type::Vec(2) => Some(Dim::Two),
        Type::Vec(3) => Some(Dim::Three),
        _ => None,
    }
}

/// True if a value of type `have` is a value of type `want` without conversion. Ints and angles are
/// numbers, also inside lists, records, ranges and functions.
pub(crate) fn same_value(have: &Type, want: &Type) -> bool {
    match (have, want) {
        (Type::Int | Type::Angle, Type::Number) => true,
        (Type::List(a), Type::List(b)) | (Type::Range(a), Type::Range(b)) => same_value(a, b),
        (Type::Fn(a, ra), Type::Fn(b, rb)) => {
            a.len() == b.len()
                && a.iter().zip(b).all(|(have, want)| same_value(want, have))
                && same_value(ra, rb)
        }
        (Type::Record(a), Type::Record(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.0 == b.0 && same_value(&a.1, &b.1))
        }
        _ => have == want,
    }
}

/// The common type of two list elements or two branches. Ints and angles can become numbers; there
/// is no other conversion.
pub(super) fn join(a: &Type, b: &Type) -> Option<Type> {
    if a == b {
        return Some(a.clone());
    }
    if poisoned(a) || poisoned(b) {
        return Some(Type::Error);
    }
    if is_scalar(a) && is_scalar(b) {
        return Some(Type::Number);
    }
    if same_value(a, b) {
        return Some(b.clone());
    }
    if same_value(b, a) {
        return Some(a.clone());
    }
    match (a, b) {
        (Type::List(a), Type::List(b)) => Some(Type::List(Box::new(join(a, b)?))),
        (Type::Range(a), Type::Range(b)) => Some(Type::Range(Box::new(join(a, b)?))),
        (Type::Fn(a, ra), Type::Fn(b, rb)) if a == b => {
            Some(Type::Fn(a.clone(), Box::new(join(ra, rb)?)))
        }
        (Type::Record(a), Type::Record(b)) if a.len() == b.len() => {
            let join_field = |(name, ty): &(String, Type)| {
                let (_, other) = b.iter().find(|(other, _)| other == name)?;
                Some((name.clone(), join(ty, other)?))
            };
            Some(Type::Record(a.iter().map(join_field).collect::<Option<_>>()?))
        }
        _ => None,
    }
}

/// True if a type contains `shape`, or `point` if `with_point` is set.
pub(super) fn mentions_either(ty: &TypeExpr, with_point: bool) -> bool {
    match &ty.kind {
        TypeExprKind::Named(word) => word == "shape" || (with_point && word == "point"),
        TypeExprKind::List(of) => mentions_either(of, with_point),
        TypeExprKind::Fn(parameters, result) => {
            parameters.iter().any(|ty| mentions_either(ty, with_point))
                || mentions_either(result, with_point)
        }
        TypeExprKind::Record(fields) => {
            fields.iter().any(|field| mentions_either(&field.ty, with_point))
        }
    }
}

/// True if a declaration is checked once per dimension: a `shape`, or one with `shape` in its
/// signature. `point` counts in a `fn` only; elsewhere it has the dimension of the formula.
pub(super) fn is_generic(kind: DeclKind, signature: &Signature) -> bool {
    let with_point = match kind {
        DeclKind::Shape => return true,
        DeclKind::Fn => true,
        DeclKind::Solid | DeclKind::Region => false,
    };
    let parms = signature.parms.iter().filter_map(|parm| parm.ty.as_ref());
    parms.chain(&signature.result).any(|ty| mentions_either(ty, with_point))
}

impl Checker<'_> {
    /// Reports a value whose type is nested too deeply or has too many parts.
    pub(super) fn limit_type(&mut self, value: Expr) -> Expr {
        let (depth, parts) = extent(&value.ty);
        if depth <= MAX_DEPTH && parts <= MAX_PARTS {
            return value;
        }
        let message = if depth > MAX_DEPTH {
            format!("this type is nested more than {MAX_DEPTH} levels deep")
        } else {
            format!("this type has more than {MAX_PARTS} parts")
        };
        self.report(Diagnostic::error(Code::NESTING, value.span, message));
        poison(value.span)
    }

    /// The type with a name in the source. Reports unknown names.
    pub(super) fn resolve_type(&mut self, ty: &TypeExpr) -> Type {
        match &ty.kind {
            TypeExprKind::Named(word) => self.resolve_word(word, ty),
            TypeExprKind::List(of) => Type::List(Box::new(self.resolve_type(of))),
            TypeExprKind::Fn(parameters, result) => {
                let parameters = parameters.iter().map(|ty| self.resolve_type(ty)).collect();
                Type::Fn(parameters, Box::new(self.resolve_type(result)))
            }
            TypeExprKind::Record(fields) => self.resolve_record(fields),
        }
    }

    fn resolve_word(&mut self, word: &str, ty: &TypeExpr) -> Type {
        match word {
            "shape" => match self.body.either {
                Some(dim) => Type::Shape(dim),
                None => self.no_dimension(ty, "`shape`", "`solid` or `region`"),
            },
            "point" => match self.body.point.or(self.body.either) {
                Some(dim) => point(dim),
                None => self.no_dimension(ty, "`point`", "`vec2` or `vec3`"),
            },
            _ => named(word).unwrap_or_else(|| self.unknown_word(word, ty)),
        }
    }

    fn no_dimension(&mut self, ty: &TypeExpr, word: &str, instead: &str) -> Type {
        let message = format!("the dimension of {word} is unknown here");
        self.report(
            Diagnostic::error(Code::TYPE_MISMATCH, ty.span, message)
                .help(format!("write {instead}")),
        );
        Type::Error
    }

    fn unknown_word(&mut self, word: &str, ty: &TypeExpr) -> Type {
        let found =
            Diagnostic::error(Code::UNKNOWN_NAME, ty.span, format!("there is no type `{word}`"));
        let found = match meant(word, WORDS.iter().map(|word| word.name)) {
            Some(meant) => meant.add_to(found),
            None => {
                let words: Vec<&str> = WORDS.iter().map(|word| word.name).collect();
                found.help(format!("the types are {}, [T] and fn(A) -> R", words.join(", ")))
            }
        };
        self.report(found);
        Type::Error
    }
}
