//! The number types in which a graph can be evaluated.

/// A number type: one method for each scalar operation of the closed set.
///
/// Truth values are numbers: 0 is false, 1 is true (an undecided [`Interval`](super::Interval)
/// spans both). Angles are in radians. Partial functions are undefined outside their domain; each
/// number type documents what it returns there. Where WGSL leaves a result open, the rule stated
/// here holds on the CPU.
pub trait Number: Copy {
    /// True if operations consist of vector instructions, which depend on the CPU.
    const HAS_VECTORS: bool = false;

    /// The number nearest to a constant.
    fn constant(value: f64) -> Self;

    /// `-x`
    fn neg(self) -> Self;
    /// `|x|`
    fn abs(self) -> Self;
    /// -1, 0 or 1
    fn sign(self) -> Self;
    /// The greatest whole number that is not above x
    fn floor(self) -> Self;
    /// The least whole number that is not below x
    fn ceil(self) -> Self;
    /// The nearest whole number; halves go to the even one
    fn round(self) -> Self;
    /// x rounded towards 0
    fn trunc(self) -> Self;
    /// `x * x`, for two factors known to be one value
    fn square(self) -> Self;
    /// Square root; undefined below 0
    fn sqrt(self) -> Self;
    /// `1 / sqrt(x)`; undefined at and below 0
    fn inverse_sqrt(self) -> Self;
    /// `e^x`
    fn exp(self) -> Self;
    /// `2^x`
    fn exp2(self) -> Self;
    /// Natural logarithm; undefined at and below 0
    fn log(self) -> Self;
    /// Logarithm to base 2; undefined at and below 0
    fn log2(self) -> Self;
    /// Sine
    fn sin(self) -> Self;
    /// Cosine
    fn cos(self) -> Self;
    /// Tangent; undefined at its poles
    fn tan(self) -> Self;
    /// Arc sine; undefined outside -1..1
    fn asin(self) -> Self;
    /// Arc cosine; undefined outside -1..1
    fn acos(self) -> Self;
    /// Arc tangent
    fn atan(self) -> Self;
    /// Hyperbolic sine
    fn sinh(self) -> Self;
    /// Hyperbolic cosine
    fn cosh(self) -> Self;
    /// Hyperbolic tangent
    fn tanh(self) -> Self;
    /// Logical negation of a truth value
    fn not(self) -> Self;

    /// `x + y`
    fn add(self, y: Self) -> Self;
    /// `x - y`
    fn sub(self, y: Self) -> Self;
    /// `x * y`
    fn mul(self, y: Self) -> Self;
    /// `x / y`; undefined where y is 0
    fn div(self, y: Self) -> Self;
    /// The lesser of x and y; x on a tie
    fn min(self, y: Self) -> Self;
    /// The greater of x and y; x on a tie
    fn max(self, y: Self) -> Self;
    /// `x^y`; undefined where x is negative, or where x is 0 and y is not positive
    fn pow(self, y: Self) -> Self;
    /// Angle of the vector `[x, self]`, from -π to π; undefined at the origin
    fn atan2(self, x: Self) -> Self;
    /// 0 where x is less than this edge, else 1
    fn step(self, x: Self) -> Self;
    /// 24 bits from 24 others and `floor(x)`, as [`hash`](super::hash::hash) mixes them
    fn hash(self, x: Self) -> Self;
    /// A component of a vector, divided by the vector's length; 0 where the length is 0
    fn normalize_lane(self, length: Self) -> Self;
    /// `x < y`
    fn lt(self, y: Self) -> Self;
    /// `x <= y`
    fn le(self, y: Self) -> Self;
    /// `x == y`
    fn eq(self, y: Self) -> Self;
    /// `x != y`
    fn ne(self, y: Self) -> Self;
    /// Logical conjunction
    fn and(self, y: Self) -> Self;
    /// Logical disjunction
    fn or(self, y: Self) -> Self;

    /// `x * (1 - t) + y * t`
    fn mix(self, y: Self, t: Self) -> Self;
    /// `min(max(x, lo), hi)`
    fn clamp(self, lo: Self, hi: Self) -> Self;
    /// Hermite step of x between this lower edge and `hi`; undefined where the edges are equal
    fn smoothstep(self, hi: Self, x: Self) -> Self;
    /// `yes` where this truth value is true, else `no`
    fn select(self, yes: Self, no: Self) -> Self;

    /// True if this truth value is certainly false, so that a loop with this condition ends.
    fn is_definitely_false(self) -> bool;

    /// The derivative of a value that is constant between jumps: 0. Bounds that contain several
    /// values have no bounds of the derivative.
    #[inline(always)]
    fn jump_slope(self) -> Self {
        Self::constant(0.0)
    }

    /// The element of a list at an index, which is rounded down and clamped to the list
    fn element(self, list: &[f64]) -> Self;

    /// `x - floor(x)`
    fn fract(self) -> Self {
        self.fract_with_floor(self.floor())
    }

    /// `x - y * floor(x / y)`; undefined where y is 0
    fn rem(self, y: Self) -> Self {
        self.rem_with_quotient(y, self.div(y).floor())
    }

    /// `x - whole`, where `whole` is known to be `floor(x)`
    fn fract_with_floor(self, whole: Self) -> Self {
        self.sub(whole)
    }

    /// `x - y * whole`, where `whole` is known to be `floor(x / y)`
    fn rem_with_quotient(self, y: Self, whole: Self) -> Self {
        self.sub(y.mul(whole))
    }

    /// `x * y`, where y is known to be `c * (1 - x)`: the correction term of a quadratic blend
    fn x_times_one_minus_x(self, y: Self, c: Self) -> Self {
        let _ = c;
        self.mul(y)
    }

    /// `x - clamp(x, lo, hi)`: how far x lies above the range, or below it as a negative number
    fn clamp_residual(self, lo: Self, hi: Self) -> Self {
        self.sub(self.clamp(lo, hi))
    }

    /// `clamp(x, 0, 1)`
    fn saturate(self) -> Self {
        self.clamp(Self::constant(0.0), Self::constant(1.0))
    }
}
