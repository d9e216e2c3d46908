//! Forward-mode differentiation.

use super::Number;

/// A number and its partial derivatives with respect to the coordinates of the point. `N` is `f64`,
/// or a packet of them for several points at once.
///
/// At kinks the derivative is the derivative of one branch: of the first argument for `min`, `max`
/// and `clamp` on a tie, and +1 for `abs` at 0. `sqrt` and `length` have the derivative 0 at 0,
/// operations that jump (`floor`, `sign`, comparisons) everywhere. A partial derivative that is 0
/// stays 0 even where the outer derivative is infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<N = f64> {
    /// The value.
    pub value: N,
    /// Its partial derivatives with respect to x, y, z.
    pub partials: [N; 3],
}

impl<N: Number> Dual<N> {
    /// The coordinates of a point, as the independent variables.
    pub fn point(point: [N; 3]) -> [Self; 3] {
        std::array::from_fn(|axis| {
            let partial = |of: usize| N::constant(if of == axis { 1.0 } else { 0.0 });
            Self { value: point[axis], partials: std::array::from_fn(partial) }
        })
    }

    /// A value whose derivative is 0, or counts as 0.
    #[inline(always)]
    fn flat(value: N) -> Self {
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
        let partial =
            |i: usize| scaled(self.partials[i], slopes[0]).add(scaled(y.partials[i], slopes[1]));
        Self { value, partials: std::array::from_fn(partial) }
    }

    /// `yes` where a truth value is true, else `no`.
    #[inline(always)]
    fn choose(truth: N, yes: Self, no: Self) -> Self {
        let partial = |i: usize| truth.select(yes.partials[i], no.partials[i]);
        Self { value: truth.select(yes.value, no.value), partials: std::array::from_fn(partial) }
    }
}

/// The product; 0 where the partial derivative is 0, even if the slope is infinite.
#[inline(always)]
fn scaled<N: Number>(partial: N, slope: N) -> N {
    unless_zero(partial, partial.mul(slope))
}

/// The result, or 0 where the number is 0.
#[inline(always)]
fn unless_zero<N: Number>(number: N, result: N) -> N {
    let zero = N::constant(0.0);
    number.eq(zero).select(zero, result)
}

impl<N: Number> Number for Dual<N> {
    #[inline]
    fn constant(value: f64) -> Self {
        Self::flat(N::constant(value))
    }

    #[inline]
    fn neg(self) -> Self {
        self.chain(self.value.neg(), N::constant(-1.0))
    }
    #[inline]
    fn abs(self) -> Self {
        let slope = self.value.lt(N::constant(0.0)).select(N::constant(-1.0), N::constant(1.0));
        self.chain(self.value.abs(), slope)
    }
    #[inline]
    fn sign(self) -> Self {
        Self::flat(self.value.sign())
    }
    #[inline]
    fn floor(self) -> Self {
        Self::flat(self.value.floor())
    }
    #[inline]
    fn ceil(self) -> Self {
        Self::flat(self.value.ceil())
    }
    #[inline]
    fn round(self) -> Self {
        Self::flat(self.value.round())
    }
    #[inline]
    fn trunc(self) -> Self {
        Self::flat(self.value.trunc())
    }
    #[inline]
    fn square(self) -> Self {
        self.chain(self.value.square(), N::constant(2.0).mul(self.value))
    }
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, unless_zero(self.value, N::constant(0.5).div(root)))
    }
    #[inline]
    fn inverse_sqrt(self) -> Self {
        let value = self.value.inverse_sqrt();
        self.chain(value, N::constant(-0.5).mul(value).div(self.value))
    }
    #[inline]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }
    #[inline]
    fn exp2(self) -> Self {
        let value = self.value.exp2();
        self.chain(value, value.mul(N::constant(std::f64::consts::LN_2)))
    }
    #[inline]
    fn log(self) -> Self {
        self.chain(self.value.log(), N::constant(1.0).div(self.value))
    }
    #[inline]
    fn log2(self) -> Self {
        self.chain(self.value.log2(), N::constant(std::f64::consts::LOG2_E).div(self.value))
    }
    #[inline]
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }
    #[inline]
    fn cos(self) -> Self {
        self.chain(self.value.cos(), self.value.sin().neg())
    }
    #[inline]
    fn tan(self) -> Self {
        let value = self.value.tan();
        self.chain(value, N::constant(1.0).add(value.square()))
    }
    #[inline]
    fn asin(self) -> Self {
        self.chain(self.value.asin(), inverse_cosine(self.value))
    }
    #[inline]
    fn acos(self) -> Self {
        self.chain(self.value.acos(), inverse_cosine(self.value).neg())
    }
    #[inline]
    fn atan(self) -> Self {
        let one = N::constant(1.0);
        self.chain(self.value.atan(), one.div(one.add(self.value.square())))
    }
    #[inline]
    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }
    #[inline]
    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }
    #[inline]
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.chain(value, N::constant(1.0).sub(value.square()))
    }
    #[inline]
    fn not(self) -> Self {
        Self::flat(self.value.not())
    }

    #[inline]
    fn add(self, y: Self) -> Self {
        self.chain2(y, self.value.add(y.value), [N::constant(1.0); 2])
    }
    #[inline]
    fn sub(self, y: Self) -> Self {
        self.chain2(y, self.value.sub(y.value), [1.0, -1.0].map(N::constant))
    }
    #[inline]
    fn mul(self, y: Self) -> Self {
        self.chain2(y, self.value.mul(y.value), [y.value, self.value])
    }
    #[inline]
    fn div(self, y: Self) -> Self {
        let value = self.value.div(y.value);
        let slopes = [N::constant(1.0).div(y.value), value.neg().div(y.value)];
        self.chain2(y, value, slopes)
    }
    #[inline]
    fn min(self, y: Self) -> Self {
        Self::choose(y.value.lt(self.value), y, self)
    }
    #[inline]
    fn max(self, y: Self) -> Self {
        Self::choose(self.value.lt(y.value), y, self)
    }
    #[inline]
    fn pow(self, y: Self) -> Self {
        let value = self.value.pow(y.value);
        let by_base = y.value.mul(self.value.pow(y.value.sub(N::constant(1.0))));
        // x^y ln x tends to 0 with x for positive y, the only ones defined at 0.
        let by_power = unless_zero(self.value, value.mul(self.value.log()));
        self.chain2(y, value, [by_base, by_power])
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let norm = self.value.square().add(x.value.square());
        let slopes = [x.value, self.value.neg()].map(|side| unless_zero(norm, side.div(norm)));
        self.chain2(x, self.value.atan2(x.value), slopes)
    }
    #[inline]
    fn step(self, x: Self) -> Self {
        Self::flat(self.value.step(x.value))
    }
    #[inline]
    fn hash(self, x: Self) -> Self {
        Self::flat(self.value.hash(x.value))
    }
    #[inline]
    fn normalize_lane(self, length: Self) -> Self {
        let Self { partials, .. } = self.div(length);
        let partials = partials.map(|partial| unless_zero(length.value, partial));
        Self { value: self.value.normalize_lane(length.value), partials }
    }
    #[inline]
    fn lt(self, y: Self) -> Self {
        Self::flat(self.value.lt(y.value))
    }
    #[inline]
    fn le(self, y: Self) -> Self {
        Self::flat(self.value.le(y.value))
    }
    #[inline]
    fn eq(self, y: Self) -> Self {
        Self::flat(self.value.eq(y.value))
    }
    #[inline]
    fn ne(self, y: Self) -> Self {
        Self::flat(self.value.ne(y.value))
    }
    #[inline]
    fn and(self, y: Self) -> Self {
        Self::flat(self.value.and(y.value))
    }
    #[inline]
    fn or(self, y: Self) -> Self {
        Self::flat(self.value.or(y.value))
    }

    #[inline]
    fn is_definitely_false(self) -> bool {
        self.value.is_definitely_false()
    }
    #[inline]
    fn element(self, list: &[f64]) -> Self {
        Self::flat(self.value.element(list))
    }

    #[inline]
    fn mix(self, y: Self, t: Self) -> Self {
        let by_t = t.chain(N::constant(0.0), y.value.sub(self.value));
        let slopes = [N::constant(1.0).sub(t.value), t.value];
        let Self { partials, .. } = self.chain2(y, N::constant(0.0), slopes).add(by_t);
        Self { value: self.value.mix(y.value, t.value), partials }
    }
    #[inline]
    fn clamp(self, lo: Self, hi: Self) -> Self {
        self.max(lo).min(hi)
    }
    #[inline]
    fn smoothstep(self, hi: Self, x: Self) -> Self {
        let t = x.sub(self).div(hi.sub(self)).saturate();
        t.square().mul(Self::constant(3.0).sub(t.add(t)))
    }
    #[inline]
    fn select(self, yes: Self, no: Self) -> Self {
        Self::choose(self.value, yes, no)
    }
}

/// `1 / sqrt(1 - x²)`, the derivative of the arc sine.
#[inline(always)]
fn inverse_cosine<N: Number>(x: N) -> N {
    N::constant(1.0).sub(x.square()).inverse_sqrt()
}
