//! The nodes of the graph: a closed set of operations on typed values.
//!
//! No match over the operations has a wildcard arm, so a new operation does not compile until every
//! evaluator, the derivative and the lowering handle it.

/// A handle to a node of the arena. Arguments always have smaller ids than the nodes that use them,
/// so a loop over ascending ids visits arguments first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    /// Index in the arena.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Dimension of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Dim {
    /// A region: a function of `[x, y]`.
    Two,
    /// A solid: a function of `[x, y, z]`.
    Three,
}

impl Dim {
    /// The type of a point of this dimension.
    pub fn point_type(self) -> Type {
        match self {
            Self::Two => Type::Vec2,
            Self::Three => Type::Vec3,
        }
    }
}

/// A direction at a point of a surface, which materials can read. Both are unit vectors in scene
/// coordinates.
///
/// In the formulas of materials it is a point of a level that no shape has. It is the same for all
/// shapes, so expansion keeps it; the passes after it give it a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SurfaceVector {
    /// The outward normal.
    Normal,
    /// The direction to the eye, or back along the reflected ray that meets the surface.
    View,
}

impl SurfaceVector {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Normal, Self::View];

    /// The level of its point.
    pub const fn level(self) -> u16 {
        match self {
            Self::Normal => u16::MAX - 1,
            Self::View => u16::MAX,
        }
    }

    /// The direction whose point has a level.
    pub fn of_level(level: u16) -> Option<Self> {
        Self::ALL.into_iter().find(|vector| vector.level() == level)
    }

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::View => "view",
        }
    }
}

/// Type of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Type {
    /// A truth value.
    Bool,
    /// A number.
    Scalar,
    /// Two numbers.
    Vec2,
    /// Three numbers.
    Vec3,
    /// Four numbers.
    Vec4,
}

impl Type {
    /// Number of lanes (1 for a truth value).
    pub fn width(self) -> usize {
        match self {
            Self::Bool | Self::Scalar => 1,
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 => 4,
        }
    }

    /// The scalar or vector type of a width from 1 to 4.
    pub fn of_width(width: usize) -> Option<Self> {
        match width {
            1 => Some(Self::Scalar),
            2 => Some(Self::Vec2),
            3 => Some(Self::Vec3),
            4 => Some(Self::Vec4),
            _ => None,
        }
    }
}

/// A constant: f64 lanes, compared by their bits. Unused lanes are zero. A truth value is 0 or 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Const {
    ty: Type,
    bits: [u64; 4],
}

impl Const {
    /// A constant of a type. Lanes beyond the type's width are ignored, and -0 becomes 0.
    pub fn new(ty: Type, lanes: &[f64]) -> Self {
        let mut bits = [0; 4];
        for (bit, lane) in bits.iter_mut().zip(lanes).take(ty.width()) {
            *bit = (lane + 0.0).to_bits();
        }
        Self { ty, bits }
    }

    /// Its type.
    pub fn ty(&self) -> Type {
        self.ty
    }

    /// Its lanes; lanes beyond the width are 0.
    pub fn lanes(&self) -> [f64; 4] {
        self.bits.map(f64::from_bits)
    }

    /// The number, if the constant is a scalar.
    pub fn scalar(&self) -> Option<f64> {
        (self.ty == Type::Scalar).then(|| self.lanes()[0])
    }
}

/// An input whose value is known once a frame starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FrameInput {
    /// A param of the scene, by index.
    Param(u32),
    /// Seconds.
    Time,
    /// Number of the frame, a whole number.
    Frame,
}

/// The evaluation rate of a node (its binding time): when its value is known. A node's stage is the
/// latest stage of its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Stage {
    /// When the scene compiles.
    Const,
    /// When a frame starts.
    Frame,
    /// At each point.
    Point,
}

/// Operations on one argument. Componentwise unless stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Unary {
    Neg,
    Abs,
    /// -1, 0 or 1
    Sign,
    Floor,
    Ceil,
    /// To the nearest whole number, halves to even
    Round,
    Trunc,
    /// `x - floor(x)`
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
    /// `clamp(x, 0, 1)`
    Saturate,
    /// Euclidean length of a vector; a scalar. Its derivative at 0 is 0.
    Length,
    /// A vector divided by its length; the zero vector stays zero.
    Normalize,
    /// Logical negation of a truth value.
    Not,
}

/// Operations on two arguments of one type. Componentwise unless stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    /// The remainder of a floored division: `x - y * floor(x / y)`.
    Rem,
    /// The first argument on a tie, which matters to derivatives and materials.
    Min,
    /// The first argument on a tie.
    Max,
    Pow,
    /// `atan2(y, x)`
    Atan2,
    /// `step(edge, x)`: 0 where `x < edge`, else 1.
    Step,
    /// `hash(state, x)`: a whole number of 24 bits, from another one and `floor(x)`. See
    /// [`crate::eval::hash`].
    Hash,
    /// Scalar product of two vectors.
    Dot,
    /// Vector product of two 3-vectors.
    Cross,
    /// Comparisons of two scalars (`Eq` and `Ne` also of two truth values) give a truth value.
    Lt,
    Le,
    Eq,
    Ne,
    And,
    Or,
    /// Two formulas of one value, equal up to rounding. Shaders compute the first, which is shorter
    /// at a point; everything else takes the second, whose bounds over a box are closer. See
    /// [`Graph::choose_formulas`](crate::Graph::choose_formulas).
    Alternative,
}

/// Operations on three arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Ternary {
    /// `x * (1 - t) + y * t`, all of one type, componentwise.
    Mix,
    /// `clamp(x, lo, hi)`, componentwise.
    Clamp,
    /// `smoothstep(lo, hi, x)`, componentwise.
    Smoothstep,
    /// `select(condition, yes, no)`; the condition is a single truth value.
    Select,
}

/// The properties of a material. `Color` and `Emission` are 3-vectors, the others scalars.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MaterialField {
    /// Base colour, linear.
    Color,
    /// Coverage of the material, from 0 (the default material) to 1.
    Coverage,
    /// From 0 (mirror) to 1 (matt).
    Roughness,
    /// From 0 (dielectric) to 1 (metal).
    Metallic,
    /// Emitted light, linear.
    Emission,
    /// From 1 (all light reaches the surface) over 0 (no ambient light does) to -1 (no light).
    Occlusion,
}

impl MaterialField {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Color,
        Self::Coverage,
        Self::Roughness,
        Self::Metallic,
        Self::Emission,
        Self::Occlusion,
    ];

    /// Index in [`MaterialField::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// The value in the default material: light grey, half rough, not metallic, not emissive.
    pub fn default_value(self) -> [f64; 4] {
        match self {
            Self::Color => [0.8, 0.8, 0.8, 0.0],
            Self::Coverage | Self::Metallic | Self::Emission => [0.0; 4],
            Self::Roughness => [0.5, 0.0, 0.0, 0.0],
            Self::Occlusion => [1.0, 0.0, 0.0, 0.0],
        }
    }

    /// Its type.
    pub fn ty(self) -> Type {
        match self {
            Self::Color | Self::Emission => Type::Vec3,
            Self::Coverage | Self::Roughness | Self::Metallic | Self::Occlusion => Type::Scalar,
        }
    }
}

/// A handle to a shape instance of the arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ShapeId(pub(crate) u32);

impl ShapeId {
    /// Index in the arena.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A handle to a loop of the arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LoopId(pub(crate) u32);

/// A handle to a table of constants of the arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TableId(pub(crate) u32);

impl TableId {
    /// Index in the arena.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The meaning of a variable in a loop's body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LoopVar {
    /// The iteration index, from 0.
    Index,
    /// A part of the state before the iteration, by index.
    State(u16),
}

/// One node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A constant.
    Const(Const),
    /// The point of a formula at a level. A shape that is built inside another shape's formula has
    /// the next level. The levels of [`SurfaceVector`] stand for directions.
    Point(u16, Dim),
    /// A per-frame input and its type.
    Frame(FrameInput, Type),
    /// An operation on one argument.
    Unary(Unary, NodeId),
    /// An operation on two arguments.
    Binary(Binary, NodeId, NodeId),
    /// An operation on three arguments.
    Ternary(Ternary, [NodeId; 3]),
    /// A vector whose lanes are all equal to one scalar.
    Splat(Type, NodeId),
    /// A vector composed of scalars; unused entries repeat the first.
    Compose(Type, [NodeId; 4]),
    /// Components of a vector by index; a single component is a scalar. Unused entries are 0.
    Swizzle(Type, NodeId, [u8; 4]),
    /// `c0 * v.x + c1 * v.y + c2 * v.z` for 3-vectors: the columns of a matrix, then `v`.
    Transform([NodeId; 3], NodeId),
    /// A variable in the body of the loop that is nested in this many others.
    Variable(u8, LoopVar, Type),
    /// A part of a loop's state after its last iteration, by index.
    Loop(LoopId, u16, Type),
    /// The element of a table at an index, which is rounded down and clamped to the table.
    Element(TableId, NodeId, Type),
    /// Distance of a shape at a point. Expansion removes it.
    Sample(ShapeId, NodeId),
    /// A material property of a shape at a point. Expansion removes it.
    MaterialAt(ShapeId, NodeId, MaterialField),
}

impl Node {
    /// The arguments that the node stores itself, in order. A loop's arguments are stored with the
    /// loop: see [`crate::Graph::arguments`].
    pub(crate) fn own_arguments(&self) -> std::iter::Take<std::array::IntoIter<NodeId, 4>> {
        let unused = NodeId(0);
        let (list, count) = match *self {
            Self::Const(_)
            | Self::Point(..)
            | Self::Frame(..)
            | Self::Variable(..)
            | Self::Loop(..) => ([unused; 4], 0),
            Self::Unary(_, a)
            | Self::Splat(_, a)
            | Self::Swizzle(_, a, _)
            | Self::Element(_, a, _)
            | Self::Sample(_, a)
            | Self::MaterialAt(_, a, _) => ([a; 4], 1),
            Self::Binary(_, a, b) => ([a, b, unused, unused], 2),
            Self::Ternary(_, [a, b, c]) => ([a, b, c, unused], 3),
            Self::Compose(ty, parts) => (parts, ty.width()),
            Self::Transform([a, b, c], v) => ([a, b, c, v], 4),
        };
        list.into_iter().take(count)
    }
}
