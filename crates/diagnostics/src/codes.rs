//! The table of codes: one row each, never renumbered, never reused.

/// What a diagnostic is about: `E0201`, `W0601`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Code(pub &'static str);

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0)
    }
}

/// One row of the table.
#[derive(Clone, Copy, Debug)]
pub struct CodeInfo {
    /// The code.
    pub code: Code,
    /// What it means, in a few words.
    pub title: &'static str,
    /// Why it is so and how to mend it, for the code's page.
    pub page: &'static str,
    /// How to mend it, where the finding itself does not say.
    pub mend: &'static str,
}

macro_rules! codes {
    ($($name:ident $code:literal $title:literal $page:literal $mend:literal;)*) => {
        impl Code {
            $(#[doc = $title] pub const $name: Code = Code($code);)*
        }
        /// Every code, in order.
        pub const ALL_CODES: &[CodeInfo] =
            &[$(CodeInfo { code: Code::$name, title: $title, page: $page, mend: $mend }),*];
    };
}

codes! {
    UNKNOWN_CHARACTER "E0101" "A character that starts no token"
        "Outside comments and strings a scene is written in ASCII. Often the character was pasted from a text with typographic quotes or dashes."
        "remove it; outside strings and comments a scene is written in ASCII";
    BAD_STRING "E0102" "A string that does not end, or an unknown escape"
        "A string ends on the line where it starts. Escapes are `\\\"`, `\\\\`, `\\n` and `\\u{...}`."
        "close it with a quote on its line; the escapes are \\\", \\\\, \\n and \\u{...}";
    BAD_COLOUR "E0103" "A colour with the wrong number of digits"
        "Colours are `#rgb`, `#rgba`, `#rrggbb` or `#rrggbbaa` in hexadecimal digits."
        "write 3, 4, 6 or 8 hexadecimal digits: #f80, #ff8800";
    EXPECTED "E0104" "Something else was expected here"
        "The parser names what it could have gone on with. Two shapes on one line are joined with `|`, or stand on lines of their own."
        "write what is named here, or start a new line";
    BAD_NUMBER "E0105" "A number that is not written as numbers are"
        "A decimal point has a digit on both sides, so that `0..8` reads as a range: write `0.5` and `1.0`. The units are `deg`, `turn` and `rad`, joined on."
        "write a digit on both sides of the point, and the unit right behind";
    UNCLOSED "E0106" "A bracket that is never closed"
        "The message points at the opening bracket. Brackets close in the order in which they opened."
        "close the bracket there, or remove it";
    NESTING "E0107" "Nesting deeper than 256 levels"
        "Brackets, blocks and conditions may be nested 256 deep. Name the inner parts with `let`."
        "name the inner parts with `let`";
    TOO_LARGE "E0108" "A file that is too large"
        "A scene file has at most 4 MiB. Larger scenes are written with comprehensions, functions and imports."
        "write repeated parts with `for`, functions and imports";
    DOES_NOT_CHAIN "E0109" "Comparisons and ranges do not chain"
        "`a < b < c` would compare a truth value with a number. Write `a < b && b < c`."
        "join two comparisons with `&&`";
    RESERVED "E0110" "A reserved word used as a name"
        "The reserved words are let, param, fn, solid, region, shape, import, if, else, for, in, true and false; `p` is reserved in a shape's formula."
        "choose another name";

    UNKNOWN_NAME "E0201" "A name that nothing has"
        "Names are looked up from the block outwards: block, parameters, file, imports, library, kernel. `let` and `param` are visible only after their line."
        "declare it, or look it up with `sdfc doc`";
    DECLARED_TWICE "E0202" "The same name declared twice in one file"
        "At top level of a file a name has one meaning, except that one shape name may be declared once for solids and once for regions."
        "rename one of them";
    SETTING_TWICE "E0203" "A setting that can stand only once stands twice"
        "camera, ambient, sky, fog, background, ambient_occlusion, reflections, antialias and march stand at most once."
        "keep one of them";
    MISPLACED_SETTING "E0204" "A setting that is not at top level"
        "Settings such as `camera(...)` give no value; they are lines of their own in the scene."
        "write it on a line of its own, outside of brackets and without `let`";
    WRONG_CALL "E0205" "A call of something that takes other arguments"
        "A shape without arguments in brackets is a shape already: calling it samples its distance at a point."
        "write it without brackets, or call what takes these arguments";
    ARGUMENTS "E0206" "Arguments that do not fit the parameters"
        "Positional arguments come first, then named ones, each parameter once. Parameters after a variadic one are named only."
        "`sdfc doc NAME` says what the entries of the library take";
    UNUSED_VALUE "E0207" "A value at top level that nothing uses"
        "Only solids and settings stand alone at top level. Name other values with `let`."
        "name it with `let`, or remove it";
    NO_FIELD "E0208" "A field or swizzle that the value does not have"
        "Vectors have `xyzw` and `rgba`, as far as they are long; ranges have `lo` and `hi`."
        "vectors have x, y, z, w as far as they are long, ranges lo and hi";
    IMPORT "E0209" "An import that cannot be followed"
        "Imports are paths relative to the file, with `/`, inside the folder of the scene that was opened."
        "paths are relative to the file, with `/`, inside the folder of the scene";
    MISPLACED_CLAUSE "E0210" "A clause, default or result type that does not belong here"
        "`exact`, `bound`, `bounds` and `material` are for shapes; `fn` and lambdas have only `lipschitz` and `require`. Each clause but `exact`, `bound` and `require` stands once."
        "remove it here";
    CLOCK "E0211" "A param that has the clock's name"
        "Pages, players and programs hand a scene its clock by the names `time` and `frame`, as they set a param by its own. A scene uses both without declaring them."
        "use the clock as it is, without `param`, or choose another name";

    REGION_FOR_SOLID "E0301" "A region (2D) where a solid (3D) is wanted"
        "Regions become solids by `.extrude(h)` or `.revolve()`."
        ".extrude(0.2) or .revolve()";
    SOLID_FOR_REGION "E0302" "A solid (3D) where a region (2D) is wanted"
        "Regions are made by `circle`, `rect` and the other 2D entries of the library."
        "regions are made by circle, rect and the other 2D entries of the library";
    TYPE_MISMATCH "E0303" "A value of the wrong type"
        "The message names both types. The coercions are: int and angle to number, a number to a vector of equal parts, a value to a constant function."
        "write a value of the type that is wanted here";
    NOT_AN_ANGLE "E0304" "A plain number where an angle is wanted"
        "Angles carry their unit: `90deg`, `0.25turn`, `1.57rad`; a computed number becomes one by `* 1rad`."
        "write a unit: 90deg, 0.25turn, or x * 1rad";
    BRANCH_TYPES "E0305" "The two branches of an `if` have different types"
        "Both branches give one type in every case, whether or not the condition is known at compile time."
        "make both branches give values of one type";
    BAD_OPERAND "E0307" "An operator on something it does not take"
        "`+ - * /` and comparisons are for numbers, vectors and angles; `|`, `&`, `-` join shapes; `a.scale(2)` resizes one."
        "`sdfc doc` lists the functions that take such values";
    NEEDS_RESULT_TYPE "E0308" "A recursive function without a result type"
        "Result types are inferred from the body; a function that calls itself must say `-> T`."
        "write the result type: `-> number`, `-> solid`";
    OUT_OF_RANGE "E0309" "An argument outside its parameter's range"
        "A parameter's `in lo..hi` says which values make sense; both ends are included."
        "choose a value within the range; both its ends are allowed";
    REQUIREMENT "E0310" "A `require` of the library or the file does not hold"
        "The message is the one that the entry's author wrote."
        "change the arguments so that it holds";
    NOT_FINITE "E0311" "A constant that is not a finite number"
        "Division by a constant zero, the root of a negative constant and overflow have no value that a shader could hold."
        "keep divisors away from 0, roots from negative numbers, and powers small";
    DEGENERATE "E0312" "An index, slice or list that does not exist"
        "Lists are indexed from 0 with constants; a list has one type and some functions want it not empty."
        "the first element has index 0, the last one less than the length";

    NOT_COMPILE_TIME "E0402" "Something that must be known at compile time is not"
        "The sequence of `for`, list indices, strings and the condition around a recursive call are fixed when the scene compiles; a param moves without a recompile."
        "write the value here, or make it a `let`";
    RECURSION "E0405" "Recursion deeper than 64 levels"
        "Functions are inlined at each call, so recursion must end at compile time."
        "end the recursion by an `if` whose condition is known at compile time";
    TOO_MANY_NODES "E0406" "More than a million graph nodes"
        "Everything is inlined; a comprehension inside a comprehension multiplies. Use repetition (`repeat`) for copies."
        "use repetition for copies, or draw less";
    SHAPE_NESTING "E0407" "Shapes nested too deep"
        "A shape may contain shapes 1,024 levels deep. Join many shapes in one `union(...)` instead of one by one."
        "join many shapes in one `union(...)` instead of one by one";
    NO_POINT "E0408" "`p` outside a shape's formula"
        "An argument cannot mention the point; pass a function of it: `fn(q) = q.y`."
        "pass a function of the point: fn(q) = q.y";
    SELF_CALL "E0409" "A shape that calls itself"
        "Shapes do not recurse; a `fn` that returns a shape may."
        "write a `fn` that returns a shape; it may call itself";
    ITERATIONS "E0410" "`iterate` with too many rounds"
        "A loop known at compile time runs at most 4,096 rounds."
        "go through fewer rounds";

    NOT_YET "E0411" "A ray method that this version does not have"
        "The specification has it, this version of the compiler does not; nothing is drawn in its place."
        "remove it; nothing is drawn in its place";
    TOO_MANY_LIGHTS "E0412" "More lights than are drawn"
        "A scene has at most 8 lights, those of all kinds counted: each is asked for at every point that is seen."
        "remove one, or let `ambient` stand for the weakest";
    TEXT "E0413" "A text whose letters cannot be drawn"
        "Letters are the outlines of a font: the one called `sans`, which comes with sdfc, or a TrueType or OpenType file in the folder of the scene. Each character must be in the font, and all outlines of one text together have at most 4,096 curves."
        "write letters that the font has, or name a font file that has them";

    PROMISE_BROKEN "E0502" "A promise that sampling refutes"
        "`sdfc check` holds the clauses of the scene's own shapes against a fixed number of samples: `exact` and `bound` against the surface, `lipschitz` against pairs of points within the bounds, `bounds` against points outside them, `intersect` against the field along rays, `copies` against balls about points; and `lipschitz` of its functions against pairs of points where they are called; with the params at their defaults and at both ends of their ranges. The message gives a point where the clause fails. A clause is held to what it says given children that keep the same promise: `exact` of an operator says nothing where a child is only a bound."
        "state what holds, or drop the clause";

    NOT_EXACT "W0601" "An operator that wants an exact distance has only a bound"
        "`round`, `shell` and every other formula `a(p) - r` or `abs(a(p)) - w` use the value of the distance, not only its sign; of a bound the result is a surface too, but at a distance that varies. The note says where the field stops being the distance: a smooth blend, an intersection (outside), a union (inside). Round the parts instead of the whole, or leave it as it is if it looks right."
        "do this to the parts before they are joined, or leave it if it looks right";
    UNCERTIFIED "W0602" "No Lipschitz constant could be derived"
        "Steps as long as the distance may lead through this part; `auto` proves stretches of rays free instead (`interval`), unless that does not end within a ray's steps. A formula whose slope depends on the point has a constant within finite bounds: cut the shape, or state `bounds`. Else state a constant with `lipschitz`, or use an operator whose constant is known. A shape bent or twisted without bounds (a plane) has none: cut it first."
        "state what holds with `lipschitz` and `bounds`";
    UNUSED "W0603" "A private name, a local `let` or an import that nothing uses"
        "Remove it, or use it. Names with a leading `_` are private to their file."
        "remove it, or use it";
    NOTHING_DRAWN "W0604" "A file that draws nothing"
        "It can be imported, not rendered. Every solid that stands alone at top level is drawn."
        "write a solid on a line of its own; to be imported, a file need not draw";
    SOFT_SHADOW "W0605" "Soft shadows of a field that is not the distance"
        "A soft shadow is made of the distances by which rays to the lamp pass what throws it. Where the field is less than the distance, edges are wider and darker than `soft(...)` says; where nothing is known of the field they may be anything. The note says where the field stops being the distance: a smooth blend, an intersection, a shape bent or stretched. Outside a hard union of exact shapes the field is the distance."
        "`shadow: hard` needs no distances; or leave it if it looks right";
    IDLE_CLAUSE "W0606" "A clause `copies` that does nothing"
        "`auto` meets copies in closed form where the formula is a minimum of samples and of values without samples: each sample at a map of p that is rigid while `round`, `floor` and `sign` keep their values, by itself or cut by a box, and one value at least that says how near others are. A minimum under an `if` that a param decides is none."
        "bring the formula into that form, or drop the clause";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_in_order_within_their_letter() {
        for pair in ALL_CODES.windows(2) {
            let (a, b) = (pair[0].code.0, pair[1].code.0);
            assert!(a[..1] != b[..1] || a < b, "{a} before {b}");
        }
    }
}
