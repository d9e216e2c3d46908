//! The domains in which a graph can be evaluated.

/// A domain of values: one method for each scalar operation of the closed set.
///
/// Truth values are numbers: 0 is false, 1 is true (an undecided [`Interval`](super::Interval) spans
/// both). Angles are in radians. Functions of a partial domain are undefined outside it, each domain says how.
/// Wherever WGSL leaves a result open, the rule stated here holds on the CPU.
pub trait Number: Copy {
    /// The number nearest to a constant.
    fn constant(value: f64) -> Self;

    /// `-x`
    fn neg(self) -> Self;
    /// `|x|`
    fn abs(self) -> Self;
    /// -1, 0 or 1
    fn sign(self) -> Self;
    /// The next whole number below
    fn floor(self) -> Self;
    /// The next whole number above
    fn ceil(self) -> Self;
    /// The nearest whole number; halves go to the even one
    fn round(self) -> Self;
    /// The next whole number towards 0
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
    /// Of a truth value
    fn not(self) -> Self;

    /// `x + y`
    fn add(self, y: Self) -> Self;
    /// `x - y`
    fn sub(self, y: Self) -> Self;
    /// `x * y`
    fn mul(self, y: Self) -> Self;
    /// `x / y`; undefined where y is 0
    fn div(self, y: Self) -> Self;
    /// The lesser; x on a tie
    fn min(self, y: Self) -> Self;
    /// The greater; x on a tie
    fn max(self, y: Self) -> Self;
    /// `x^y`; undefined where x is negative, or where x is 0 and y is not positive
    fn pow(self, y: Self) -> Self;
    /// Angle of the vector `[x, self]`, from -π to π; undefined at the origin
    fn atan2(self, x: Self) -> Self;
    /// 0 where x is less than this edge, else 1
    fn step(self, x: Self) -> Self;
    /// 24 bits from 24 others and the whole part of x, as [`hash`](super::hash::hash) mixes them
    fn hash(self, x: Self) -> Self;
    /// A component of a vector of the given length, divided by that length; 0 where the length is 0
    fn direction(self, length: Self) -> Self;
    /// `x < y`
    fn lt(self, y: Self) -> Self;
    /// `x <= y`
    fn le(self, y: Self) -> Self;
    /// `x == y`
    fn eq(self, y: Self) -> Self;
    /// `x != y`
    fn ne(self, y: Self) -> Self;
    /// Both of two truth values
    fn and(self, y: Self) -> Self;
    /// Either of two truth values
    fn or(self, y: Self) -> Self;

    /// `x * (1 - t) + y * t`
    fn mix(self, y: Self, t: Self) -> Self;
    /// `min(max(x, lo), hi)`
    fn clamp(self, lo: Self, hi: Self) -> Self;
    /// Hermite step of x, this being the lower edge; undefined where the edges are equal
    fn smoothstep(self, hi: Self, x: Self) -> Self;
    /// `yes` where this truth value holds, else `no`
    fn select(self, yes: Self, no: Self) -> Self;

    /// Whether this truth value is false for certain: a loop that it keeps running ends
    fn is_never(self) -> bool;

    /// The element of a list at a position, rounded down; the first before the first, the last past the last
    fn element(self, list: &[f64]) -> Self;

    /// `x - floor(x)`
    fn fract(self) -> Self {
        self.beyond(self.floor())
    }

    /// `x - y * floor(x / y)`; undefined where y is 0
    fn rem(self, y: Self) -> Self {
        self.left(y, self.div(y).floor())
    }

    /// `x - whole` for the whole number known to be `floor(x)`
    fn beyond(self, whole: Self) -> Self {
        self.sub(whole)
    }

    /// `x - y * whole` for the whole number known to be `floor(x / y)`
    fn left(self, y: Self, whole: Self) -> Self {
        self.sub(y.mul(whole))
    }

    /// `x * y` for a y known to be `c * (1 - x)`: the dip of a quadratic blend
    fn parabola(self, y: Self, c: Self) -> Self {
        let _ = c;
        self.mul(y)
    }

    /// `x - clamp(x, lo, hi)`: how far x lies above the range, or below it as a negative number
    fn excess(self, lo: Self, hi: Self) -> Self {
        self.sub(self.clamp(lo, hi))
    }

    /// `clamp(x, 0, 1)`
    fn saturate(self) -> Self {
        self.clamp(Self::constant(0.0), Self::constant(1.0))
    }
}
