//! Evaluation at several points at once.

use super::Number;

/// B numbers that are evaluated together: each instruction is decoded once for all of them, and
/// compiles to vector instructions where the number type allows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Packet<N, const B: usize>(pub [N; B]);

impl<N: Number, const B: usize> Packet<N, B> {
    #[inline(always)]
    fn map(self, op: impl Fn(N) -> N) -> Self {
        Self(std::array::from_fn(|i| op(self.0[i])))
    }

    #[inline(always)]
    fn map2(self, y: Self, op: impl Fn(N, N) -> N) -> Self {
        Self(std::array::from_fn(|i| op(self.0[i], y.0[i])))
    }

    #[inline(always)]
    fn map3(self, y: Self, z: Self, op: impl Fn(N, N, N) -> N) -> Self {
        Self(std::array::from_fn(|i| op(self.0[i], y.0[i], z.0[i])))
    }
}

macro_rules! lanewise {
    (
        unary { $($unary:ident)* }
        binary { $($binary:ident)* }
        ternary { $($ternary:ident)* }
    ) => {
        impl<N: Number, const B: usize> Number for Packet<N, B> {
            const HAS_VECTORS: bool = true;

            #[inline(always)]
            fn constant(value: f64) -> Self {
                Self([N::constant(value); B])
            }
            #[inline(always)]
            fn is_definitely_false(self) -> bool {
                self.0.into_iter().all(N::is_definitely_false)
            }
            #[inline(always)]
            fn element(self, list: &[f64]) -> Self {
                self.map(|at| at.element(list))
            }
            #[inline(always)]
            fn jump_slope(self) -> Self {
                self.map(N::jump_slope)
            }
            $(#[inline(always)] fn $unary(self) -> Self { self.map(N::$unary) })*
            $(#[inline(always)] fn $binary(self, y: Self) -> Self { self.map2(y, N::$binary) })*
            $(#[inline(always)] fn $ternary(self, y: Self, z: Self) -> Self { self.map3(y, z, N::$ternary) })*
        }
    };
}

lanewise! {
    unary {
        neg abs sign floor ceil round trunc fract square sqrt inverse_sqrt exp exp2 log log2
        sin cos tan asin acos atan sinh cosh tanh not saturate
    }
    binary { add sub mul div rem min max pow atan2 step hash normalize_lane fract_with_floor lt le eq ne and or }
    ternary { mix clamp smoothstep select x_times_one_minus_x clamp_residual rem_with_quotient }
}
