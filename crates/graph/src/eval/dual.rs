//! Forward-mode differentiation.

use super::Number;

/// A number and its partial derivatives with respect to the coordinates of the point. `N` is `f64`,
/// a packet of them for several points at once, or an interval for a box of points.
///
/// At kinks the derivative is the derivative of one branch: of the first argument for `min`, `max`
/// and `clamp` on a tie, and +1 for `abs` at 0. `sqrt` and `length` have the derivative 0 at 0,
/// operations that jump (`floor`, `sign`, comparisons) everywhere. A partial derivative that is 0
/// stays 0 even where the outer derivative is infinite.
///
/// In intervals, the partial derivatives are bounds of all of them in a region, those of both sides
/// of a kink included. They are unbounded where the value may jump. So a function is monotone along
/// a segment if its derivative along the segment is bounded and has one sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<N = f64> {
    /// The value.
    pub value: N,
    /// Its partial derivatives with respect to x, y, z.
    pub partials: [N; 3],
}

impl<N: Number> Dual<N> {
    /// The coordinates of a point, as the independent variables.
    #[inline(always)]
    pub fn point([x, y, z]: [N; 3]) -> [Self; 3] {
        let [zero, one] = [0.0, 1.0].map(N::constant);
        [
            Self { value: x, partials: [one, zero, zero] },
            Self { value: y, partials: [zero, one, zero] },
            Self { value: z, partials: [zero, zero, one] },
        ]
    }

    #[inline(always)]
    fn constant_dual(value: N) -> Self {
        Self { value, partials: [N::constant(0.0); 3] }
    }

    /// A function of this number, given its value and derivative.
    #[inline(always)]
    fn chain(self, value: N, slope: N) -> Self {
        Self { value, partials: self.partials.map(|partial| scaled(partial, slope)) }
    }

    /// A function of two numbers, given its value and partial derivatives.
    #[inline(always)]
    fn chain2(self, y: Self, value: N, slopes: [N; 2]) -> Self {
        let [by_x, by_y] = slopes;
        let partials = std::array::from_fn(|i| {
            scaled(self.partials[i], by_x).add(scaled(y.partials[i], by_y))
        });
        Self { value, partials }
    }

    /// A value that is constant between its jumps.
    #[inline(always)]
    fn stepped(value: N) -> Self {
        Self { value, partials: [value.jump_slope(); 3] }
    }

    /// The number with unbounded derivatives where a truth value may change.
    #[inline(always)]
    fn with_jump(self, truth: N) -> Self {
        let jump = truth.jump_slope();
        Self { value: self.value, partials: self.partials.map(|partial| partial.add(jump)) }
    }

    /// A value with the derivatives of this number if a condition is true, else with those of
    /// another one.
    #[inline(always)]
    fn chosen(self, condition: N, other: Self, value: N) -> Self {
        let partials =
            std::array::from_fn(|i| condition.select(self.partials[i], other.partials[i]));
        Self { value, partials }
    }
}

/// The product; 0 where the partial derivative is 0, even if the slope is infinite.
#[inline(always)]
fn scaled<N: Number>(partial: N, slope: N) -> N {
    let zero = N::constant(0.0);
    partial.eq(zero).select(zero, partial.mul(slope))
}

/// The slope, or 0 where the number is 0.
#[inline(always)]
fn unless_zero<N: Number>(number: N, slope: N) -> N {
    let zero = N::constant(0.0);
    number.eq(zero).select(zero, slope)
}

impl<N: Number> Number for Dual<N> {
    const HAS_VECTORS: bool = N::HAS_VECTORS;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::constant_dual(N::constant(value))
    }

    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(self.value.neg(), N::constant(-1.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let [minus, plus] = [-1.0, 1.0].map(N::constant);
        self.chain(self.value.abs(), self.value.lt(N::constant(0.0)).select(minus, plus))
    }
    #[inline(always)]
    fn sign(self) -> Self {
        Self::stepped(self.value.sign())
    }
    #[inline(always)]
    fn floor(self) -> Self {
        Self::stepped(self.value.floor())
    }
    #[inline(always)]
    fn ceil(self) -> Self {
        Self::stepped(self.value.ceil())
    }
    #[inline(always)]
    fn round(self) -> Self {
        Self::stepped(self.value.round())
    }
    #[inline(always)]
    fn trunc(self) -> Self {
        Self::stepped(self.value.trunc())
    }
    #[inline(always)]
    fn square(self) -> Self {
        self.chain(self.value.square(), N::constant(2.0).mul(self.value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, unless_zero(self.value, N::constant(0.5).div(root)))
    }
    #[inline(always)]
    fn inverse_sqrt(self) -> Self {
        let value = self.value.inverse_sqrt();
        self.chain(value, N::constant(-0.5).mul(value).div(self.value))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }
    #[inline(always)]
    fn exp2(self) -> Self {
        let value = self.value.exp2();
        self.chain(value, value.mul(N::constant(std::f64::consts::LN_2)))
    }
    #[inline(always)]
    fn log(self) -> Self {
        self.chain(self.value.log(), N::constant(1.0).div(self.value))
    }
    #[inline(always)]
    fn log2(self) -> Self {
        self.chain(self.value.log2(), N::constant(std::f64::consts::LOG2_E).div(self.value))
    }
    #[inline(always)]
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.chain(self.value.cos(), self.value.sin().neg())
    }
    #[inline(always)]
    fn tan(self) -> Self {
        let value = self.value.tan();
        self.chain(value, N::constant(1.0).add(value.square()))
    }
    #[inline(always)]
    fn asin(self) -> Self {
        self.chain(self.value.asin(), complement_of_square(self.value).inverse_sqrt())
    }
    #[inline(always)]
    fn acos(self) -> Self {
        self.chain(self.value.acos(), complement_of_square(self.value).inverse_sqrt().neg())
    }
    #[inline(always)]
    fn atan(self) -> Self {
        let one = N::constant(1.0);
        self.chain(self.value.atan(), one.div(one.add(self.value.square())))
    }
    #[inline(always)]
    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }
    #[inline(always)]
    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.chain(value, complement_of_square(value))
    }
    #[inline(always)]
    fn not(self) -> Self {
        Self::stepped(self.value.not())
    }

    #[inline(always)]
    fn add(self, y: Self) -> Self {
        let partials = std::array::from_fn(|i| self.partials[i].add(y.partials[i]));
        Self { value: self.value.add(y.value), partials }
    }
    #[inline(always)]
    fn sub(self, y: Self) -> Self {
        let partials = std::array::from_fn(|i| self.partials[i].sub(y.partials[i]));
        Self { value: self.value.sub(y.value), partials }
    }
    #[inline(always)]
    fn mul(self, y: Self) -> Self {
        self.chain2(y, self.value.mul(y.value), [y.value, self.value])
    }
    #[inline(always)]
    fn div(self, y: Self) -> Self {
        let value = self.value.div(y.value);
        self.chain2(y, value, [N::constant(1.0).div(y.value), value.neg().div(y.value)])
    }
    #[inline(always)]
    fn min(self, y: Self) -> Self {
        y.chosen(y.value.lt(self.value), self, self.value.min(y.value))
    }
    #[inline(always)]
    fn max(self, y: Self) -> Self {
        y.chosen(self.value.lt(y.value), self, self.value.max(y.value))
    }
    #[inline(always)]
    fn pow(self, y: Self) -> Self {
        let value = self.value.pow(y.value);
        let by_base = y.value.mul(self.value.pow(y.value.sub(N::constant(1.0))));
        // x^y ln x tends to 0 with x for positive y, the only ones defined at 0.
        let by_power = unless_zero(self.value, value.mul(self.value.log()));
        // 0^y jumps from 1 to 0 where y leaves 0.
        let zero = N::constant(0.0);
        let may_jump = self.value.eq(zero).and(y.value.eq(zero));
        self.chain2(y, value, [by_base, by_power]).with_jump(may_jump)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let (along, across, zero) = (x.value, self.value, N::constant(0.0));
        let norm = across.square().add(along.square());
        let slopes = [along, across.neg()].map(|part| unless_zero(norm, part.div(norm)));
        let angle = self.chain2(x, across.atan2(along), slopes);
        // The angle jumps where y is 0 and x is negative.
        angle.with_jump(across.eq(zero).and(along.le(zero)))
    }
    #[inline(always)]
    fn step(self, x: Self) -> Self {
        Self::stepped(self.value.step(x.value))
    }
    #[inline(always)]
    fn hash(self, x: Self) -> Self {
        Self::stepped(self.value.hash(x.value))
    }
    #[inline(always)]
    fn normalize_lane(self, length: Self) -> Self {
        let (zero, is_zero) = (Self::constant(0.0), length.value.eq(N::constant(0.0)));
        let value = self.value.normalize_lane(length.value);
        zero.chosen(is_zero, self.div(length), value).with_jump(is_zero)
    }
    #[inline(always)]
    fn lt(self, y: Self) -> Self {
        Self::stepped(self.value.lt(y.value))
    }
    #[inline(always)]
    fn le(self, y: Self) -> Self {
        Self::stepped(self.value.le(y.value))
    }
    #[inline(always)]
    fn eq(self, y: Self) -> Self {
        Self::stepped(self.value.eq(y.value))
    }
    #[inline(always)]
    fn ne(self, y: Self) -> Self {
        Self::stepped(self.value.ne(y.value))
    }
    #[inline(always)]
    fn and(self, y: Self) -> Self {
        Self::stepped(self.value.and(y.value))
    }
    #[inline(always)]
    fn or(self, y: Self) -> Self {
        Self::stepped(self.value.or(y.value))
    }

    #[inline(always)]
    fn is_definitely_false(self) -> bool {
        self.value.is_definitely_false()
    }
    fn element(self, list: &[f64]) -> Self {
        Self::stepped(self.value.element(list))
    }

    #[inline(always)]
    fn mix(self, y: Self, t: Self) -> Self {
        let by_t = t.chain(N::constant(0.0), y.value.sub(self.value));
        let weights = [N::constant(1.0).sub(t.value), t.value];
        let Self { partials, .. } = self.chain2(y, N::constant(0.0), weights).add(by_t);
        Self { value: self.value.mix(y.value, t.value), partials }
    }
    #[inline(always)]
    fn clamp(self, lo: Self, hi: Self) -> Self {
        self.max(lo).min(hi)
    }
    #[inline(always)]
    fn smoothstep(self, hi: Self, x: Self) -> Self {
        let value = self.value.smoothstep(hi.value, x.value);
        let t = x.sub(self).div(hi.sub(self)).saturate();
        let slope = N::constant(6.0).mul(t.value.mul(N::constant(1.0).sub(t.value)));
        // Where the edges meet, the step is a jump.
        t.chain(value, slope).with_jump(self.value.eq(hi.value))
    }
    #[inline(always)]
    fn select(self, yes: Self, no: Self) -> Self {
        let value = self.value.select(yes.value, no.value);
        yes.chosen(self.value, no, value).with_jump(self.value)
    }

    #[inline(always)]
    fn fract_with_floor(self, whole: Self) -> Self {
        Self { value: self.value.fract_with_floor(whole.value), ..self.sub(whole) }
    }
    #[inline(always)]
    fn rem_with_quotient(self, y: Self, whole: Self) -> Self {
        let value = self.value.rem_with_quotient(y.value, whole.value);
        Self { value, ..self.sub(y.mul(whole)) }
    }
    #[inline(always)]
    fn x_times_one_minus_x(self, y: Self, c: Self) -> Self {
        // c x (1 - x)
        let (x, one) = (self.value, N::constant(1.0));
        let by_x = c.value.mul(one.sub(x.add(x)));
        let value = x.x_times_one_minus_x(y.value, c.value);
        self.chain2(c, value, [by_x, x.mul(one.sub(x))])
    }
    #[inline(always)]
    fn clamp_residual(self, lo: Self, hi: Self) -> Self {
        // Where lo > hi, clamp is hi.
        let Self { partials, .. } = Self::constant(0.0).min(self.sub(lo)).max(self.sub(hi));
        Self { value: self.value.clamp_residual(lo.value, hi.value), partials }
    }
}

/// `1 - x²`
#[inline(always)]
fn complement_of_square<N: Number>(x: N) -> N {
    N::constant(1.0).sub(x.square())
}
