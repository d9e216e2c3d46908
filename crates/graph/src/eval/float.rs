//! Floating point: `f64` is the reference, `f32` computes what the shader computes.
//!
//! Both follow WGSL, so that `f32` differs from a device only by the accuracy that WGSL allows:
//! `round` goes to even, `pow`, `atan2` and `smoothstep` with equal edges ignore negative zeros,
//! `sign(0)` is 0, `pow` of a negative base is NaN. An undefined result is NaN or infinite. `min`
//! and `max` return a NaN only if it is their first argument; WGSL leaves this open.

use super::Number;
use super::hash::hash;

macro_rules! float {
    ($float:ident, pow: $pow:path, atan2: $atan2:path, $($name:ident: $unary:path),* $(,)?) => {
        impl Number for $float {
            #[inline(always)]
            fn constant(value: f64) -> Self {
                value as Self
            }

            #[inline(always)]
            fn neg(self) -> Self {
                -self
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }
            #[inline(always)]
            fn sign(self) -> Self {
                if self > 0.0 {
                    1.0
                } else if self < 0.0 {
                    -1.0
                } else {
                    self * 0.0
                }
            }
            #[inline(always)]
            fn floor(self) -> Self {
                self.floor()
            }
            #[inline(always)]
            fn ceil(self) -> Self {
                self.ceil()
            }
            #[inline(always)]
            fn round(self) -> Self {
                self.round_ties_even()
            }
            #[inline(always)]
            fn trunc(self) -> Self {
                self.trunc()
            }
            #[inline(always)]
            fn square(self) -> Self {
                self * self
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn inverse_sqrt(self) -> Self {
                1.0 / self.sqrt()
            }
            $(
                #[inline(always)]
                fn $name(self) -> Self {
                    $unary(self)
                }
            )*
            #[inline(always)]
            fn not(self) -> Self {
                1.0 - self
            }

            #[inline(always)]
            fn add(self, y: Self) -> Self {
                self + y
            }
            #[inline(always)]
            fn sub(self, y: Self) -> Self {
                self - y
            }
            #[inline(always)]
            fn mul(self, y: Self) -> Self {
                self * y
            }
            #[inline(always)]
            fn div(self, y: Self) -> Self {
                self / y
            }
            #[inline(always)]
            fn min(self, y: Self) -> Self {
                if y < self { y } else { self }
            }
            #[inline(always)]
            fn max(self, y: Self) -> Self {
                if y > self { y } else { self }
            }
            #[inline(always)]
            fn pow(self, y: Self) -> Self {
                if self < 0.0 { Self::NAN } else { $pow(self + 0.0, y) }
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                $atan2(self + 0.0, x + 0.0) // turns -0 into 0
            }
            #[inline(always)]
            fn step(self, x: Self) -> Self {
                truth(x >= self)
            }
            #[inline(always)]
            fn hash(self, x: Self) -> Self {
                hash(self.into(), x.into()) as Self
            }
            #[inline(always)]
            fn normalize_lane(self, length: Self) -> Self {
                if length == 0.0 { 0.0 } else { self / length }
            }
            #[inline(always)]
            fn lt(self, y: Self) -> Self {
                truth(self < y)
            }
            #[inline(always)]
            fn le(self, y: Self) -> Self {
                truth(self <= y)
            }
            #[inline(always)]
            fn eq(self, y: Self) -> Self {
                truth(self == y)
            }
            #[inline(always)]
            fn ne(self, y: Self) -> Self {
                truth(self != y)
            }
            #[inline(always)]
            fn and(self, y: Self) -> Self {
                self * y
            }
            #[inline(always)]
            fn or(self, y: Self) -> Self {
                Number::max(self, y)
            }

            #[inline(always)]
            fn is_definitely_false(self) -> bool {
                self == 0.0
            }
            #[inline(always)]
            fn element(self, list: &[f64]) -> Self {
                let last = list.len().saturating_sub(1);
                let at = (self.max(0.0) as usize).min(last);
                list.get(at).map_or(Self::NAN, |&value| value as Self)
            }
            #[inline(always)]
            fn mix(self, y: Self, t: Self) -> Self {
                self * (1.0 - t) + y * t
            }
            #[inline(always)]
            fn clamp(self, lo: Self, hi: Self) -> Self {
                Number::min(Number::max(self, lo), hi)
            }
            #[inline(always)]
            fn smoothstep(self, hi: Self, x: Self) -> Self {
                let t = ((x - self) / (hi - self + 0.0)).saturate();
                t * t * (3.0 - 2.0 * t)
            }
            #[inline(always)]
            fn select(self, yes: Self, no: Self) -> Self {
                if self != 0.0 { yes } else { no }
            }
        }
    };
}

float!(
    f32,
    pow: f32::powf,
    atan2: f32::atan2,
    exp: f32::exp,
    exp2: f32::exp2,
    log: f32::ln,
    log2: f32::log2,
    sin: f32::sin,
    cos: f32::cos,
    tan: f32::tan,
    asin: f32::asin,
    acos: f32::acos,
    atan: f32::atan,
    sinh: f32::sinh,
    cosh: f32::cosh,
    tanh: f32::tanh,
);

// The math functions of different systems' libraries differ in the last bit. Constants are folded
// and bounds are found by libm, so that a scene compiles to the same shader on every system.
float!(
    f64,
    pow: libm::pow,
    atan2: libm::atan2,
    exp: libm::exp,
    exp2: libm::exp2,
    log: libm::log,
    log2: libm::log2,
    sin: libm::sin,
    cos: libm::cos,
    tan: libm::tan,
    asin: libm::asin,
    acos: libm::acos,
    atan: libm::atan,
    sinh: libm::sinh,
    cosh: libm::cosh,
    tanh: libm::tanh,
);

/// 1 for true, 0 for false.
#[inline(always)]
fn truth<F: From<bool>>(holds: bool) -> F {
    F::from(holds)
}
