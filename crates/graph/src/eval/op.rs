//! The scalar operations that tapes are made of.

use super::Number;

/// Passes all operations to a macro, each with the method of [`Number`] that computes it.
macro_rules! operations {
    ($receiver:ident) => {
        $receiver! {
            unary {
                Neg = neg,
                Abs = abs,
                Sign = sign,
                Floor = floor,
                Ceil = ceil,
                Round = round,
                Trunc = trunc,
                Fract = fract,
                Square = square,
                Sqrt = sqrt,
                InverseSqrt = inverse_sqrt,
                Exp = exp,
                Exp2 = exp2,
                Log = log,
                Log2 = log2,
                Sin = sin,
                Cos = cos,
                Tan = tan,
                Asin = asin,
                Acos = acos,
                Atan = atan,
                Sinh = sinh,
                Cosh = cosh,
                Tanh = tanh,
                Saturate = saturate,
                Not = not,
            }
            binary {
                Add = add,
                Sub = sub,
                Mul = mul,
                Div = div,
                Rem = rem,
                Min = min,
                Max = max,
                Pow = pow,
                Atan2 = atan2,
                Step = step,
                Hash = hash,
                NormalizeLane = normalize_lane,
                FractWithFloor = fract_with_floor,
                Lt = lt,
                Le = le,
                Eq = eq,
                Ne = ne,
                And = and,
                Or = or,
            }
            ternary {
                Mix = mix,
                Clamp = clamp,
                Smoothstep = smoothstep,
                Select = select,
                XTimesOneMinusX = x_times_one_minus_x,
                ClampResidual = clamp_residual,
                RemWithQuotient = rem_with_quotient,
            }
        }
    };
}
pub(super) use operations;

macro_rules! define_op {
    (
        unary { $($unary:ident = $unary_method:ident,)* }
        binary { $($binary:ident = $binary_method:ident,)* }
        ternary { $($ternary:ident = $ternary_method:ident,)* }
    ) => {
        /// An operation on scalars; each is a method of [`Number`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub(crate) enum Op { $($unary,)* $($binary,)* $($ternary,)* }

        impl Op {
            /// Number of arguments, 1 to 3.
            pub(crate) fn arity(self) -> usize {
                match self {
                    $(Self::$unary)|* => 1,
                    $(Self::$binary)|* => 2,
                    $(Self::$ternary)|* => 3,
                }
            }

            /// The result. `argument` gives the arguments by position.
            #[inline]
            pub(crate) fn apply<N: Number>(self, argument: impl Fn(usize) -> N) -> N {
                match self {
                    $(Self::$unary => argument(0).$unary_method(),)*
                    $(Self::$binary => argument(0).$binary_method(argument(1)),)*
                    $(Self::$ternary => argument(0).$ternary_method(argument(1), argument(2)),)*
                }
            }

            /// Applies the operation `count` times: to the numbers from the indices `arguments` on,
            /// with the results from `result` on.
            #[inline(always)]
            pub(crate) fn apply_all<N: Number>(
                self,
                numbers: &mut [N],
                result: usize,
                [a, b, c]: [usize; 3],
                count: usize,
            ) {
                match self {
                    $(Self::$unary => for k in 0..count {
                        numbers[result + k] = numbers[a + k].$unary_method();
                    })*
                    $(Self::$binary => for k in 0..count {
                        numbers[result + k] = numbers[a + k].$binary_method(numbers[b + k]);
                    })*
                    $(Self::$ternary => for k in 0..count {
                        let (x, y, z) = (numbers[a + k], numbers[b + k], numbers[c + k]);
                        numbers[result + k] = x.$ternary_method(y, z);
                    })*
                }
            }
        }
    };
}

operations!(define_op);

impl Op {
    /// True if the result can jump where the arguments do not. A tracer sees these operations.
    pub(crate) fn jumps(self) -> bool {
        self.is_whole() || matches!(self, Self::Atan2 | Self::NormalizeLane | Self::Select)
    }

    /// True if the result is a whole number or a truth value.
    pub(crate) fn is_whole(self) -> bool {
        use Op::{Ceil, Eq, Floor, Le, Lt, Ne, Round, Sign, Step, Trunc};
        matches!(self, Floor | Ceil | Round | Trunc | Sign | Step | Lt | Le | Eq | Ne)
    }
}
