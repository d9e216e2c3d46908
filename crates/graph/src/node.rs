//! The closed set of operations. A new one does not compile until every evaluator, the
//! derivative and the lowering have it: none of them has a wildcard arm.

/// A node of the arena. Arguments always have smaller ids than what uses them, so
/// walking ids upwards visits arguments first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    /// Position in the arena.
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
    /// Type of a point of that dimension.
    pub fn point_type(self) -> Type {
        match self {
            Self::Two => Type::Vec2,
            Self::Three => Type::Vec3,
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
    /// How many numbers (1 for a truth value).
    pub fn width(self) -> usize {
        match self {
            Self::Bool | Self::Scalar => 1,
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 => 4,
        }
    }

    /// The number or vector type of a width from 1 to 4.
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

/// A constant: f64 lanes compared by their bits; unused lanes are zero. A truth value is 0 or 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Const {
    ty: Type,
    bits: [u64; 4],
}

impl Const {
    /// A constant of a type; lanes beyond the type's width are ignored, -0 becomes 0.
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

    /// Its lanes; those beyond the width are 0.
    pub fn lanes(&self) -> [f64; 4] {
        self.bits.map(f64::from_bits)
    }

    /// The number, if it is one number.
    pub fn scalar(&self) -> Option<f64> {
        (self.ty == Type::Scalar).then(|| self.lanes()[0])
    }
}

/// Something known once a frame starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FrameInput {
    /// A param of the scene, by position.
    Param(u32),
    /// Seconds.
    Time,
    /// Whole number of the frame.
    Frame,
}

/// When a node's value is known; a node's stage is the latest of its arguments'.
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
    /// -1, 0 or 1.
    Sign,
    Floor,
    Ceil,
    /// Halves to even.
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
    /// A vector divided by its length; 0 stays 0.
    Normalize,
    /// Of a truth value.
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
    /// Floored: `x - y * floor(x / y)`.
    Rem,
    /// On a tie the first argument (matters to derivatives and materials).
    Min,
    /// On a tie the first argument.
    Max,
    Pow,
    /// `atan2(y, x)`
    Atan2,
    /// `step(edge, x)`: 0 where `x < edge`, else 1.
    Step,
    /// `hash(state, x)`: a whole number of 24 bits from another and the whole part of x. Jumps.
    Hash,
    /// Scalar product of two vectors.
    Dot,
    /// Of two 3-vectors.
    Cross,
    /// Comparisons are of two scalars (or truth values for `Eq`, `Ne`) and give a truth value.
    Lt,
    Le,
    Eq,
    Ne,
    And,
    Or,
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
    /// `select(condition, yes, no)`: the condition is one truth value, first.
    Select,
}

/// What can be asked of a material. `Color`, `Emission` are 3-vectors, the others scalars.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MaterialField {
    /// Linear base colour.
    Color,
    /// 0 unpainted to 1 painted.
    Coverage,
    /// 0 mirror to 1 matt.
    Roughness,
    /// 0 dielectric to 1 metal.
    Metallic,
    /// Light given off.
    Emission,
    /// 0 dark to 1 open.
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

    /// Position in [`MaterialField::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// Its value where nothing is painted: light grey, half rough, no metal, no light of its own.
    pub fn unpainted(self) -> [f64; 4] {
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

/// A shape instance of the arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ShapeId(pub(crate) u32);

impl ShapeId {
    /// Position in the arena.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A loop of the arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LoopId(pub(crate) u32);

/// A list of constants of the arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TableId(pub(crate) u32);

impl TableId {
    /// Position in the arena.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a variable of a loop's body stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Place {
    /// The number of the round, from 0.
    Round,
    /// A part of the state as the round finds it, by position.
    State(u16),
}

/// One node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A constant.
    Const(Const),
    /// The point of a formula. A shape built inside another's formula has the next level.
    Point(u16, Dim),
    /// A per-frame input and its type.
    Frame(FrameInput, Type),
    /// An operation on one argument.
    Unary(Unary, NodeId),
    /// An operation on two arguments.
    Binary(Binary, NodeId, NodeId),
    /// An operation on three arguments.
    Ternary(Ternary, [NodeId; 3]),
    /// A vector of equal parts.
    Splat(Type, NodeId),
    /// A vector from its scalar parts; unused places repeat the first.
    Compose(Type, [NodeId; 4]),
    /// Components of a vector by index; a scalar for one. Unused places are 0.
    Swizzle(Type, NodeId, [u8; 4]),
    /// `c0 * v.x + c1 * v.y + c2 * v.z` for 3-vectors: columns, then `v`.
    Transform([NodeId; 3], NodeId),
    /// A variable in the body of a loop that so many others are around.
    Variable(u8, Place, Type),
    /// A part of a loop's state after its last round, by position.
    Loop(LoopId, u16, Type),
    /// The element of a list at a position, rounded down; before the first the first, past the last the last.
    Element(TableId, NodeId, Type),
    /// Distance of a shape at a point; gone after expansion.
    Sample(ShapeId, NodeId),
    /// Material of a shape at a point; gone after expansion.
    MaterialAt(ShapeId, NodeId, MaterialField),
}

impl Node {
    /// Its arguments in order; those of a loop are the loop's ([`crate::Graph::arguments`]).
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
