//! Forward-mode differentiation.

use super::Number;

/// A number and its partial derivatives with respect to the coordinates of the point, in f64.
///
/// At kinks the derivative is the derivative of one branch: of the first argument for `min`, `max`
/// and `clamp` on a tie, and +1 for `abs` at 0. `sqrt` and `length` have the derivative 0 at 0,
/// operations that jump (`floor`, `sign`, comparisons) everywhere. A partial derivative that is 0
/// stays 0 even where the outer derivative is infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The value.
    pub value: f64,
    /// Its partial derivatives with respect to x, y, z.
    pub partials: [f64; 3],
}

impl Dual {
    /// The coordinates of a point, as the independent variables.
    pub fn point([x, y, z]: [f64; 3]) -> [Self; 3] {
        [
            Self { value: x, partials: [1.0, 0.0, 0.0] },
            Self { value: y, partials: [0.0, 1.0, 0.0] },
            Self { value: z, partials: [0.0, 0.0, 1.0] },
        ]
    }

    fn constant_dual(value: f64) -> Self {
        Self { value, partials: [0.0; 3] }
    }

    /// A function of this number, given its value and derivative.
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, partials: self.partials.map(|partial| scaled(partial, slope)) }
    }

    /// A function of two numbers, given its value and partial derivatives.
    fn chain2(self, y: Self, value: f64, slopes: [f64; 2]) -> Self {
        let partial =
            |i: usize| scaled(self.partials[i], slopes[0]) + scaled(y.partials[i], slopes[1]);
        Self { value, partials: [partial(0), partial(1), partial(2)] }
    }
}

/// The product; 0 where the partial derivative is 0, even if the slope is infinite.
fn scaled(partial: f64, slope: f64) -> f64 {
    if partial == 0.0 { 0.0 } else { partial * slope }
}

impl Number for Dual {
    fn constant(value: f64) -> Self {
        Self::constant_dual(value)
    }

    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
    fn abs(self) -> Self {
        self.chain(self.value.abs(), if self.value < 0.0 { -1.0 } else { 1.0 })
    }
    fn sign(self) -> Self {
        Self::constant_dual(Number::sign(self.value))
    }
    fn floor(self) -> Self {
        Self::constant_dual(self.value.floor())
    }
    fn ceil(self) -> Self {
        Self::constant_dual(self.value.ceil())
    }
    fn round(self) -> Self {
        Self::constant_dual(Number::round(self.value))
    }
    fn trunc(self) -> Self {
        Self::constant_dual(self.value.trunc())
    }
    fn square(self) -> Self {
        self.chain(self.value * self.value, 2.0 * self.value)
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, if self.value == 0.0 { 0.0 } else { 0.5 / root })
    }
    fn inverse_sqrt(self) -> Self {
        let value = self.value.inverse_sqrt();
        self.chain(value, -0.5 * value / self.value)
    }
    fn exp(self) -> Self {
        let value = libm::exp(self.value);
        self.chain(value, value)
    }
    fn exp2(self) -> Self {
        let value = libm::exp2(self.value);
        self.chain(value, value * std::f64::consts::LN_2)
    }
    fn log(self) -> Self {
        self.chain(libm::log(self.value), 1.0 / self.value)
    }
    fn log2(self) -> Self {
        self.chain(libm::log2(self.value), std::f64::consts::LOG2_E / self.value)
    }
    fn sin(self) -> Self {
        self.chain(libm::sin(self.value), libm::cos(self.value))
    }
    fn cos(self) -> Self {
        self.chain(libm::cos(self.value), -libm::sin(self.value))
    }
    fn tan(self) -> Self {
        let value = libm::tan(self.value);
        self.chain(value, 1.0 + value * value)
    }
    fn asin(self) -> Self {
        self.chain(libm::asin(self.value), (1.0 - self.value * self.value).inverse_sqrt())
    }
    fn acos(self) -> Self {
        self.chain(libm::acos(self.value), -(1.0 - self.value * self.value).inverse_sqrt())
    }
    fn atan(self) -> Self {
        self.chain(libm::atan(self.value), 1.0 / (1.0 + self.value * self.value))
    }
    fn sinh(self) -> Self {
        self.chain(libm::sinh(self.value), libm::cosh(self.value))
    }
    fn cosh(self) -> Self {
        self.chain(libm::cosh(self.value), libm::sinh(self.value))
    }
    fn tanh(self) -> Self {
        let value = libm::tanh(self.value);
        self.chain(value, 1.0 - value * value)
    }
    fn not(self) -> Self {
        Self::constant_dual(self.value.not())
    }

    fn add(self, y: Self) -> Self {
        self.chain2(y, self.value + y.value, [1.0, 1.0])
    }
    fn sub(self, y: Self) -> Self {
        self.chain2(y, self.value - y.value, [1.0, -1.0])
    }
    fn mul(self, y: Self) -> Self {
        self.chain2(y, self.value * y.value, [y.value, self.value])
    }
    fn div(self, y: Self) -> Self {
        let value = self.value / y.value;
        self.chain2(y, value, [1.0 / y.value, -value / y.value])
    }
    fn min(self, y: Self) -> Self {
        if y.value < self.value { y } else { self }
    }
    fn max(self, y: Self) -> Self {
        if y.value > self.value { y } else { self }
    }
    fn pow(self, y: Self) -> Self {
        let value = self.value.pow(y.value);
        let by_base = y.value * self.value.pow(y.value - 1.0);
        // x^y ln x tends to 0 with x for positive y, the only ones defined at 0.
        let by_power = if self.value == 0.0 { 0.0 } else { value * libm::log(self.value) };
        self.chain2(y, value, [by_base, by_power])
    }
    fn atan2(self, x: Self) -> Self {
        let norm = self.value * self.value + x.value * x.value;
        let slopes = if norm == 0.0 { [0.0; 2] } else { [x.value / norm, -self.value / norm] };
        self.chain2(x, libm::atan2(self.value, x.value), slopes)
    }
    fn step(self, x: Self) -> Self {
        Self::constant_dual(self.value.step(x.value))
    }
    fn hash(self, x: Self) -> Self {
        Self::constant_dual(self.value.hash(x.value))
    }
    fn normalize_lane(self, length: Self) -> Self {
        if length.value == 0.0 { Self::constant_dual(0.0) } else { self.div(length) }
    }
    fn lt(self, y: Self) -> Self {
        Self::constant_dual(Number::lt(self.value, y.value))
    }
    fn le(self, y: Self) -> Self {
        Self::constant_dual(Number::le(self.value, y.value))
    }
    fn eq(self, y: Self) -> Self {
        Self::constant_dual(Number::eq(self.value, y.value))
    }
    fn ne(self, y: Self) -> Self {
        Self::constant_dual(Number::ne(self.value, y.value))
    }
    fn and(self, y: Self) -> Self {
        Self::constant_dual(self.value.and(y.value))
    }
    fn or(self, y: Self) -> Self {
        Self::constant_dual(self.value.or(y.value))
    }

    fn is_definitely_false(self) -> bool {
        self.value == 0.0
    }
    fn element(self, list: &[f64]) -> Self {
        Self::constant_dual(self.value.element(list))
    }

    fn mix(self, y: Self, t: Self) -> Self {
        let by_t = t.chain(0.0, y.value - self.value);
        let Self { partials, .. } = self.chain2(y, 0.0, [1.0 - t.value, t.value]).add(by_t);
        Self { value: self.value.mix(y.value, t.value), partials }
    }
    fn clamp(self, lo: Self, hi: Self) -> Self {
        self.max(lo).min(hi)
    }
    fn smoothstep(self, hi: Self, x: Self) -> Self {
        let t = x.sub(self).div(hi.sub(self)).saturate();
        t.square().mul(Self::constant_dual(3.0).sub(t.add(t)))
    }
    fn select(self, yes: Self, no: Self) -> Self {
        if self.value != 0.0 { yes } else { no }
    }
}
