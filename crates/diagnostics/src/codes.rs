//! The table of diagnostic codes. A code is never renumbered and never reused.
//!
//! Retired: W0605 warned about soft shadows of blends and other inexact fields, also if they looked
//! right.

/// Identifies a kind of diagnostic: `E0201`, `W0601`.
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
    /// The meaning in a few words: the title of the code's page.
    pub title: &'static str,
    /// The explanation on the code's page: why it is reported and how to fix it.
    pub page: &'static str,
    /// The suggestion for diagnostics that have none of their own.
    pub suggestion: &'static str,
}

macro_rules! codes {
    ($($name:ident $code:literal $title:literal $page:literal $suggestion:literal;)*) => {
        impl Code {
            $(#[doc = $title] pub const $name: Code = Code($code);)*
        }
        /// All codes, in order.
        pub const ALL_CODES: &[CodeInfo] = &[
            $(CodeInfo {
                code: Code::$name,
                title: $title,
                page: $page,
                suggestion: $suggestion,
            }),*
        ];
    };
}

codes! {
    UNKNOWN_CHARACTER "E0101" "Unexpected character"
        "Outside comments and strings a scene is written in ASCII. Often the character was pasted \
         from a text with typographic quotes or dashes."
        "remove it; outside strings and comments a scene is written in ASCII";
    BAD_STRING "E0102" "Unterminated string or unknown escape"
        "A string ends on the line where it starts. The escapes are `\\\"`, `\\\\`, `\\n` and \
         `\\u{...}`."
        "close it with a quote on its line; the escapes are \\\", \\\\, \\n and \\u{...}";
    BAD_COLOUR "E0103" "Colour with the wrong number of digits"
        "Colours are written `#rgb`, `#rgba`, `#rrggbb` or `#rrggbbaa` in hexadecimal digits."
        "write 3, 4, 6 or 8 hexadecimal digits: #f80, #ff8800";
    EXPECTED "E0104" "Syntax error"
        "The message says what may stand at this position. Join two shapes on one line with `|`, \
         or write each on a line of its own."
        "write one of the things that the message names, or start a new line";
    BAD_NUMBER "E0105" "Malformed number"
        "A decimal point has a digit on both sides, so that `0..8` reads as a range: write `0.5` \
         and `1.0`. The units `deg`, `turn` and `rad` follow the number without a space."
        "write a digit on both sides of the point, and the unit right behind";
    UNCLOSED "E0106" "Unclosed bracket"
        "The message points at the opening bracket. Close the last opened bracket first."
        "close the bracket there, or remove it";
    NESTING "E0107" "Nesting deeper than 256 levels"
        "Brackets, blocks and conditions may be nested 256 levels deep. Name the inner parts with \
         `let`."
        "name the inner parts with `let`";
    TOO_LARGE "E0108" "File too large"
        "A scene file may have at most 4 MiB. Write larger scenes with comprehensions, functions \
         and imports."
        "write repeated parts with `for`, functions and imports";
    DOES_NOT_CHAIN "E0109" "Chained comparison or range"
        "`a < b < c` would compare a truth value with a number. Write `a < b && b < c`."
        "join two comparisons with `&&`";
    RESERVED "E0110" "Reserved word used as a name"
        "The reserved words are let, param, fn, solid, region, shape, import, if, else, for, in, \
         true and false; `p` is reserved in a shape's formula."
        "choose another name";

    UNKNOWN_NAME "E0201" "Unknown name"
        "Names are looked up from the inside outwards: block, parameters, file, imports, library, \
         kernel. `let` and `param` are visible only after their line."
        "declare it, or search with `sdfc doc`";
    DECLARED_TWICE "E0202" "Name declared twice in one file"
        "At the top level of a file a name has one meaning. One exception: a shape name may be \
         declared once for solids and once for regions."
        "rename one of them";
    SETTING_TWICE "E0203" "Setting given twice"
        "These settings may be given at most once: camera, ambient, sky, fog, background, \
         ambient_occlusion, reflections, exposure, antialias, isolines and march."
        "keep one of them";
    MISPLACED_SETTING "E0204" "Setting outside the top level"
        "Settings such as `camera(...)` have no value. Write each on a line of its own at the top \
         level of the scene."
        "write it on a line of its own, outside of brackets and without `let`";
    WRONG_CALL "E0205" "Call of something that cannot be called like this"
        "A shape without arguments in brackets is already a shape. Calling it samples its distance \
         at a point, so its argument is a point."
        "write it without brackets, or call something that takes these arguments";
    ARGUMENTS "E0206" "Arguments do not match the parameters"
        "Positional arguments come first, then named ones, each parameter once. Parameters after a \
         variadic one must be named."
        "`sdfc doc NAME` shows the parameters of a library entry";
    UNUSED_VALUE "E0207" "Unused value at top level"
        "Only shapes and settings may stand alone at the top level. Name other values with `let`."
        "name it with `let`, or remove it";
    NO_FIELD "E0208" "Unknown field or swizzle"
        "A vector has as many of the components `xyzw` (or `rgba`) as its length; a range has `lo` \
         and `hi`."
        "a vector has x, y, z, w up to its length; a range has lo and hi";
    IMPORT "E0209" "Import not found or not allowed"
        "An import path is relative to the importing file, uses `/`, and stays inside the folder \
         of the scene that was opened."
        "paths are relative to the file, with `/`, inside the folder of the scene";
    MISPLACED_CLAUSE "E0210" "Clause, default or result type not allowed here"
        "`exact`, `bound`, `bounds` and `material` belong to shapes; `fn` and lambdas have only \
         `lipschitz` and `require`. Each clause except `exact`, `bound` and `require` may be \
         given once."
        "remove it here";
    CLOCK "E0211" "Param named `time` or `frame`"
        "`time` and `frame` are the scene's clock. Programs and pages that show the scene set them \
         by these names, as they set a param by its name. A scene uses both without declaring them."
        "use the clock without declaring a `param`, or choose another name";

    REGION_FOR_SOLID "E0301" "Region (2D) where a solid (3D) is expected"
        "`.extrude(h)` or `.revolve()` makes a solid of a region. A scene draws regions, as a \
         planar picture, or solids, but not both."
        ".extrude(0.2) or .revolve()";
    SOLID_FOR_REGION "E0302" "Solid (3D) where a region (2D) is expected"
        "Regions come from `circle`, `rect` and the other 2D entries of the library."
        "use circle, rect or another 2D entry of the library";
    TYPE_MISMATCH "E0303" "Value of the wrong type"
        "The message names both types. These conversions happen by themselves: int or angle to \
         number, a number to a vector of equal components, a value to a constant function."
        "write a value of the expected type";
    NOT_AN_ANGLE "E0304" "Plain number where an angle is expected"
        "Angles have a unit: `90deg`, `0.25turn`, `1.57rad`. To make an angle of a computed \
         number, multiply it by `1rad`."
        "write a unit: 90deg, 0.25turn, or x * 1rad";
    BRANCH_TYPES "E0305" "Branches of an `if` have different types"
        "Both branches must have one type, whether or not the condition is known at compile time."
        "make both branches give values of one type";
    BAD_OPERAND "E0307" "Operator on an unsupported operand"
        "`+ - * /` and comparisons are for numbers, vectors and angles; `|`, `&`, `-` join shapes; \
         `a.scale(2)` resizes one."
        "`sdfc doc` lists the functions that take such values";
    NEEDS_RESULT_TYPE "E0308" "Recursive function without a result type"
        "Result types are inferred from the body. A function that calls itself must declare its \
         result type with `-> T`."
        "write the result type: `-> number`, `-> solid`";
    OUT_OF_RANGE "E0309" "Argument outside its parameter's range"
        "The range `in lo..hi` of a parameter includes both ends."
        "choose a value within the range, which includes both ends";
    REQUIREMENT "E0310" "A `require` does not hold"
        "An entry of the library or of the file states a condition on its arguments. The message \
         is the one that the author of the entry wrote."
        "change the arguments so that it holds";
    NOT_FINITE "E0311" "Constant that is not a finite number"
        "Division by a constant zero, the root of a negative constant and overflow have no value \
         that a shader could use."
        "keep divisors away from 0, roots from negative numbers, and powers small";
    DEGENERATE "E0312" "Index out of range, empty slice or empty list"
        "List indices are constants and start at 0. All elements of a list have one type. Some \
         functions need a list with at least one element."
        "the first element has index 0, the last one less than the length";

    NOT_COMPILE_TIME "E0402" "Value not known at compile time"
        "These must be known when the scene compiles: the sequence of a `for`, list indices, \
         strings, and the condition around a recursive call. `time` and the point are not known \
         then. A param is: another value compiles the scene again."
        "write the value here, or make it a `let`";
    RECURSION "E0405" "Recursion deeper than 64 levels"
        "Functions are inlined at each call, so recursion must end at compile time."
        "end the recursion by an `if` whose condition is known at compile time";
    TOO_MANY_NODES "E0406" "More than a million graph nodes"
        "All calls are inlined, and nested comprehensions multiply. Use `repeat` for many copies \
         of one shape."
        "use `repeat` for copies, or draw less";
    SHAPE_NESTING "E0407" "Shapes nested too deep"
        "Shapes may be nested 1,024 levels deep. Join many shapes in one `union(...)` instead of \
         one by one."
        "join many shapes in one `union(...)` instead of one by one";
    NO_POINT "E0408" "`p` outside a shape's formula"
        "The point `p` exists only in the formula of a shape. Where an argument depends on the \
         point, pass a function: `fn(q) = q.y`."
        "pass a function of the point: fn(q) = q.y";
    SELF_CALL "E0409" "Shape that calls itself"
        "Shapes cannot recurse; a `fn` that returns a shape can."
        "write a `fn` that returns a shape; it may call itself";
    ITERATIONS "E0410" "Too many iterations of `iterate`"
        "A loop whose count is known at compile time runs at most 4,096 iterations."
        "use fewer iterations";

    NOT_YET "E0411" "Ray method not available in this version"
        "The specification describes this ray method, but this version of the compiler does not \
         have it. No other method is used in its place."
        "remove it; no other method is used in its place";
    TOO_MANY_LIGHTS "E0412" "Too many lights"
        "A scene has at most 8 lights of all kinds together, because every visible point is lit by \
         each of them."
        "remove one, or replace the weakest by `ambient`";
    TEXT "E0413" "Text that cannot be drawn"
        "Letters are outlines of a font: the font `sans`, which comes with sdfc, or a TrueType or \
         OpenType file in the folder of the scene. The font must have every character, and the \
         outlines of one text may have at most 4,096 curves together."
        "write letters that the font has, or name a font file that has them";
    NOT_IN_MATERIAL "E0414" "`normal` or `view` outside a material"
        "The normal of a surface and the direction to the eye are known where a ray meets the \
         surface. So colours and the other properties of materials can read them, but no formula \
         of a shape, no argument that moves a shape, and no setting."
        "read them in a colour, a roughness or another property of a material";
    IMAGE "E0415" "Picture of the surroundings that cannot be used"
        "`sky(image: ...)` reads a Radiance picture (`.hdr`, format `32-bit_rle_rgbe`) from the \
         folder of the scene. It shows all directions by longitude and latitude, so it is twice as \
         wide as it is high; 8192 by 4096 pixels are the most. Programs without access to files, \
         such as the playground, cannot read it."
        "name a picture in the folder of the scene, or write a gradient: sky()";

    PROMISE_BROKEN "E0502" "Violated clause"
        "Every command tests the clauses of the scene's own shapes and functions at a fixed number \
         of samples: `exact` and `bound` against the surface, `lipschitz` against pairs of points \
         within the bounds, `bounds` against points outside them, `intersect` against the field \
         along rays, `copies` against balls around points, and `lipschitz` of a function against \
         pairs of points where it is called. Params are at their defaults and at both ends of their \
         ranges. The message gives a point where the clause fails. A clause has to hold only for \
         children that satisfy the same clause: `exact` on an operator claims nothing where a \
         child is only a bound."
        "state what holds, or remove the clause";

    NOT_EXACT "W0601" "Operator on a bound where it expects an exact distance"
        "`round`, `shell` and every other formula `a(p) - r` or `abs(a(p)) - w` use the value of \
         the distance, not only its sign. Applied to a bound they still give a surface, but at a \
         varying distance. The note says where the field stops being the exact distance: at a \
         smooth blend, outside an intersection, inside a union. Round the parts instead of the \
         whole, or leave it as it is if it looks right."
        "do this to the parts before they are joined, or leave it if it looks right";
    UNCERTIFIED "W0602" "No Lipschitz constant could be derived"
        "A ray may step through this shape when its step is as long as the field's value. `auto` \
         therefore falls back to interval tracing, which is slower; what that cannot prove it \
         samples at short steps, and reports as unproven. Where the slope of a formula depends on the point, a \
         constant exists within finite bounds: intersect the shape with something, or state \
         `bounds`. Otherwise state a constant with `lipschitz`, or use an operator whose constant \
         is known. A shape without bounds, such as a plane, has no constant once it is bent or \
         twisted: intersect it first."
        "state what holds with `lipschitz` and `bounds`";
    UNUSED "W0603" "Unused private name, local `let` or import"
        "Remove it, or use it. Names with a leading `_` are private to their file."
        "remove it, or use it";
    NOTHING_DRAWN "W0604" "File that draws nothing"
        "The file can be imported, but not rendered. Every shape that stands alone at the top \
         level is drawn."
        "write a shape on a line of its own; a file that is only imported need not draw";
    IDLE_CLAUSE "W0606" "Clause `copies` without effect"
        "`auto` intersects copies analytically if the formula is `min(sample, ..., limit)`. Every \
         sample is a rigid transform of `p` between jumps of `round`, `floor` and `sign`, \
         optionally intersected with a box. At least one term is a limit: a value without samples \
         that bounds the distance to all other copies. A `min` inside an `if` on a param does not \
         count."
        "bring the formula into that form, or remove the clause";
    IDLE_SETTING "W0607" "Setting without effect"
        "A scene of regions is drawn as a planar picture, in the colours that it states. Lights, \
         sky, fog and the ray method change only pictures of solids, and `isolines` only pictures \
         of regions. \
         `.extrude(0.2)` makes a solid of a region."
        "remove it, or draw shapes of the other kind";
    BRIGHT_COLOUR "W0608" "Colour component above 1"
        "The components of `rgb` are sRGB values from 0 to 1. For values from 0 to 255, divide by \
         255 or write hexadecimal digits: `rgb(1, 0.5, 0)` is `#ff8000`. Light that is brighter \
         than white, for `emission` or a sky, is written with `linear_rgb`."
        "divide by 255, or write `linear_rgb` for amounts of light";
    FILM "W0609" "Film without thickness"
        "A cut that ends exactly in the face that it cuts leaves a film: the distance is 0 there \
         and positive on both sides. Rays hit it or miss it by their rounding errors, so it looks \
         like dust, and a mesh cannot be proven there. Let the shape that cuts reach beyond the \
         face. Two pockets that touch leave such a film between them, and solids that touch leave \
         one when they are intersected: let them overlap. Films that are small beside the parts \
         that make them are not found."
        "let the shape that cuts reach beyond the face";
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
