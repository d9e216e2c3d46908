//! The kernel's operations and the fields of materials.

/// A field of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MaterialField {
    /// Base colour; its alpha is the fraction that covers the colour beneath.
    Color,
    /// From 0 (mirror) to 1 (matt).
    Roughness,
    /// From 0 (dielectric) to 1 (metal).
    Metallic,
    /// Light that the surface gives off, linear.
    Emission,
    /// From 1 (all light) over 0 (no ambient light) to -1 (no light).
    Occlusion,
}

/// The operations of the kernel. The arguments of a componentwise operation have the type of its
/// result, a number or vector, unless stated otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Kernel {
    // operators
    Neg,
    Add,
    Sub,
    Mul,
    Div,
    /// Floored: the result has the divisor's sign.
    Rem,
    /// For numbers, bools or strings; gives a bool.
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    Not,
    And,
    Or,
    // componentwise, one argument
    Abs,
    Sign,
    Floor,
    Ceil,
    /// To the nearest whole number, halves to even, as in WGSL.
    Round,
    Trunc,
    Fract,
    Sqrt,
    InverseSqrt,
    Exp,
    Exp2,
    Log,
    Log2,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Saturate,
    // componentwise, more arguments
    /// Any number of arguments, or one list: the smallest of its elements.
    Min,
    Max,
    Pow,
    Atan2,
    Step,
    Mix,
    Clamp,
    Smoothstep,
    // vectors
    Length,
    Distance,
    Dot,
    Cross,
    Normalize,
    // the rest
    /// `[x, y]` to `[x, y, 0]`, `vec3` as it is.
    Lift,
    /// Arguments: numbers or vectors. Gives a number in 0..1.
    Hash,
    /// Like `Hash`, but gives a vec3.
    Hash3,
    /// Length of a list, range of ints or vector; an int.
    /// The sum of values or lists.
    Sum,
    Len,
    /// Strings and numbers, joined to one string.
    Str,
    /// Arguments: `over` (int, range or list), `start`, `step` (function of the state, or of the
    /// state and the item), `while` (function of the state; optional).
    Iterate,
    /// The bounds of a shape, a range of points. For a function that makes shapes: the bounds over
    /// all arguments.
    Bounds,
    /// Arguments: shape, point.
    Gradient,
    /// Arguments: colour, roughness, metallic, emission, occlusion, all present.
    Material,
    /// Arguments: shape, point.
    MaterialAt,
    /// Numbers to a colour.
    Rgb,
    LinearRgb,
    Hsv,
    Hsl,
    Oklch,
    /// A shadow without penumbra.
    Hard,
    /// Arguments: text, font, alignment, spacing, leading. Gives a list of arcs, each a list of
    /// four vectors.
    GlyphCurves,
    /// Argument: the corners of a polygon, a list of vectors. Gives a list of edges in the form of
    /// `GlyphCurves`.
    PolygonEdges,
    /// Arguments: pieces in the form of `GlyphCurves`, the corner of the box around them, the side
    /// of a cell, and the numbers of columns and rows. Gives two lists of numbers.
    OutlineCells,
    /// Arguments: two formulas of one number.
    Alternative,
    /// Argument: sharpness.
    Soft,
}
