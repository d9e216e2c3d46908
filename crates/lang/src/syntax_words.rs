//! The words of the syntax, for the reference: declarations, expressions and clauses.

/// A word of the syntax.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SyntaxWord {
    /// The word.
    pub name: &'static str,
    /// Its form.
    pub signature: &'static str,
    /// Its meaning, in a sentence or two.
    pub summary: &'static str,
    /// A scene that uses it.
    pub example: &'static str,
}

macro_rules! words {
    ($($name:literal $signature:literal, $summary:literal, $example:literal;)*) => {
        &[$(SyntaxWord {
            name: $name,
            signature: $signature,
            summary: $summary,
            example: $example,
        }),*]
    };
}

/// All words, declarations first and clauses last.
pub(crate) const WORDS: &[SyntaxWord] = words! {
    "let" "let name = value", "Names a value. It is visible on the lines below, in this file or block.", "let r = 0.5; sphere(r)";
    "param" "param name: type = default in lo..hi", "Declares a value that a user can change, with `--set` or a slider: a number, int, angle, bool, colour, or a choice of strings.", "param r = 0.5 in 0..1; sphere(r)";
    "fn" "fn name(x: type = default) -> type = value", "Declares a function. `fn(x) = value` without a name is a value: a pattern, a blend or a field.", "fn twice(x) = 2 * x; sphere(twice(0.3))";
    "solid" "solid name(x: type = default) = distance", "Declares a shape in space by its signed distance at the point `p`.", "solid ball(r: length = 1 in 0..inf) = length(p) - r; ball()";
    "region" "region name(x: type = default) = distance", "Declares a shape in the plane by its signed distance at the point `p`.", "region dot(r: length = 1 in 0..inf) = length(p) - r; dot().extrude(0.2)";
    "shape" "shape name(a: shape) = distance", "Declares an operator for solids and for regions; `a(q)` is the distance of `a` at the point q.", "shape skin(a: shape, wall: length = 0.1 in 0..inf) = abs(a(p)) - wall / 2; sphere(1).skin()";
    "if" "if condition { a } else { b }", "Gives one of two values. Both have the same type, and `else` is needed.", "let big = true; sphere(if big { 1 } else { 0.5 })";
    "for" "[for x in sequence: value]", "Makes a list: one value for each item of a range `0..n`, where n is left out, or of a list. As an argument of `union` it needs no brackets.", "union(for i in 0..5: sphere(0.3).translate(x: i))";
    "record" "(name: value, other: value)", "A value of several parts, each with a name: `r.name` is one of them, and `r.with(name: value)` a copy in which it differs. The type is written in the same way, with a type after each name. `iterate` can have a record as its state.", "let record = (size: 0.4, at: [1, 0, 0]); sphere(record.size).translate(record.at)";
    "import" "import name, other as alias from \"file.sdf\"", "Makes declarations of another file visible here. It is written once for each file, at the top level.", "sphere(1) \x2f/ import spur from \"gear.sdf\"";
    "require" "require condition, \"message\"", "A clause: the arguments for which a declaration makes sense. The message is the error of a call with others.", "solid ball(r) require r > 0, \"a ball needs a radius\" = length(p) - r; ball(1)";
    "exact" "exact", "A clause: the distance is exact. `exact outside` and `exact inside` state one side, and `if` limits the promise.", "solid ball(r: length = 1 in 0..inf) exact = length(p) - r; ball()";
    "bound" "bound", "A clause: the distance is never above the true one. Not to be confused with `bounds`, a box.", "solid half(r: length = 1 in 0..inf) bound = (length(p) - r) / 2; half()";
    "lipschitz" "lipschitz L", "A clause: the distance changes by at most L per unit of length, as a factor of what it samples. It holds within the `bounds`, or anywhere with `lipschitz L everywhere`. Rays step by the distance divided by L.", "solid wavy() lipschitz 1.5 everywhere = length(p) - 1 + 0.05 * sin(10 * p.x); wavy()";
    "bounds" "bounds lo .. hi", "A clause: a box that contains the inside and the surface.", "solid ball() bounds -1 .. 1 = length(p) - 1; ball()";
    "material" "material m", "A clause: the material of a shape, or of an operator's result.", "solid gold(a: solid) material material(color: #d4af37, metallic: 1) = a(p); sphere(1).gold()";
    "intersect" "intersect [enter, exit]", "A clause for authors of libraries: where a ray from o in the direction d is inside. Rays then need no steps.", "sphere(1) \x2f/ sphere has the clause intersect";
    "copies" "copies", "A clause for authors of libraries: an operator that samples a few of many copies, such as `repeat`, states that every other copy is at least as far away as its formula says.", "sphere(0.2).repeat(spacing: 1) & box(3) \x2f/ repeat has the clause copies";
};
