//! Bounds of the directions that a field's gradient has in a box.

use sdfc_graph::eval::{Dual, Evaluator, Interval, Number};

use crate::vector::{Vec3, tangents};

/// A convex cone of gradients around an axis or its opposite.
///
/// Sums of vectors of a convex cone, and their products with numbers that are not negative, stay
/// in the cone. So at a sharp edge, where the gradient jumps and where the derivative of a square
/// root has no bound, its direction still has one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cone {
    /// The tangent of the greatest angle to the axis; infinite if there is no bound.
    along: f64,
    /// The same for the opposite of the axis.
    against: f64,
}

impl Cone {
    /// The gradient is 0, which is in every cone.
    const ZERO: Self = Self { along: 0.0, against: 0.0 };
    const UNBOUNDED: Self = Self { along: f64::INFINITY, against: f64::INFINITY };

    fn flipped(self) -> Self {
        Self { along: self.against, against: self.along }
    }

    /// Returns the smallest cone that contains both.
    fn joined(self, other: Self) -> Self {
        let Self { along, against } = other;
        Self { along: self.along.max(along), against: self.against.max(against) }
    }

    /// Returns the gradients times numbers from an interval.
    fn scaled(self, by: Interval) -> Self {
        if by.lo() == 0.0 && by.hi() == 0.0 {
            Self::ZERO
        } else if by.lo() >= 0.0 {
            self
        } else if by.hi() <= 0.0 {
            self.flipped()
        } else {
            self.joined(self.flipped())
        }
    }

    /// Returns what bounds of the partial derivatives along the axis and across it say.
    fn of([axis, u, v]: [Interval; 3]) -> Self {
        let across = u.magnitude().hypot(v.magnitude());
        if across == 0.0 && axis.magnitude() == 0.0 {
            return Self::ZERO;
        }
        // The part covers the rounding of the directions and of this line.
        let tangent = |least: f64| across / least * (1.0 + 1e-12) + 1e-12;
        let limit = |least: f64| if least > 0.0 { tangent(least) } else { f64::INFINITY };
        Self { along: limit(axis.lo()), against: limit(-axis.hi()) }
    }
}

/// A number over a box, with bounds of its gradient: those of the partial derivatives along an axis
/// and across it, and a cone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sloped {
    dual: Dual<Interval>,
    cone: Cone,
}

impl Sloped {
    /// Makes a number, with the smaller of both cones.
    fn new(dual: Dual<Interval>, cone: Cone) -> Self {
        let other = Cone::of(dual.partials);
        // The lesser one of a number and NaN is the number.
        let along = cone.along.min(other.along);
        Self { dual, cone: Cone { along, against: cone.against.min(other.against) } }
    }

    fn only(dual: Dual<Interval>) -> Self {
        Self::new(dual, Cone::UNBOUNDED)
    }

    fn value(self) -> Interval {
        self.dual.value
    }

    /// Returns the number with another dual of the same function.
    fn with(self, dual: Dual<Interval>) -> Self {
        Self::new(dual, self.cone)
    }
}

/// Returns a bound of the angles between an axis and the gradients in a box, as a tangent; infinite
/// if there is none that is less than a right angle. Gradients of 0 are left out.
pub(crate) fn spread(field: &mut Evaluator<'_, Sloped>, [lo, hi]: [Vec3; 2], axis: Vec3) -> f64 {
    let [u, v] = tangents(axis);
    let coordinate = |i: usize| {
        let partials = [axis[i], u[i], v[i]].map(Interval::constant);
        Sloped::only(Dual { value: Interval::new(lo[i], hi[i]), partials })
    };
    field.scalar([0, 1, 2].map(coordinate)).cone.along
}

/// True if two truth values or numbers are certainly in this order.
fn is_below(x: Interval, y: Interval) -> bool {
    x.hi() < y.lo()
}

impl Number for Sloped {
    fn constant(value: f64) -> Self {
        Self { dual: Dual::constant(value), cone: Cone::ZERO }
    }

    fn neg(self) -> Self {
        Self::new(self.dual.neg(), self.cone.flipped())
    }
    fn abs(self) -> Self {
        Self::new(self.dual.abs(), self.cone.scaled(self.value()))
    }
    fn sign(self) -> Self {
        Self::only(self.dual.sign())
    }
    fn floor(self) -> Self {
        Self::only(self.dual.floor())
    }
    fn ceil(self) -> Self {
        Self::only(self.dual.ceil())
    }
    fn round(self) -> Self {
        Self::only(self.dual.round())
    }
    fn trunc(self) -> Self {
        Self::only(self.dual.trunc())
    }
    fn square(self) -> Self {
        Self::new(self.dual.square(), self.cone.scaled(self.value()))
    }
    fn sqrt(self) -> Self {
        self.with(self.dual.sqrt())
    }
    fn inverse_sqrt(self) -> Self {
        Self::new(self.dual.inverse_sqrt(), self.cone.flipped())
    }
    fn exp(self) -> Self {
        self.with(self.dual.exp())
    }
    fn exp2(self) -> Self {
        self.with(self.dual.exp2())
    }
    fn log(self) -> Self {
        self.with(self.dual.log())
    }
    fn log2(self) -> Self {
        self.with(self.dual.log2())
    }
    fn sin(self) -> Self {
        Self::new(self.dual.sin(), self.cone.scaled(self.value().cos()))
    }
    fn cos(self) -> Self {
        Self::new(self.dual.cos(), self.cone.scaled(self.value().sin().neg()))
    }
    fn tan(self) -> Self {
        self.with(self.dual.tan())
    }
    fn asin(self) -> Self {
        self.with(self.dual.asin())
    }
    fn acos(self) -> Self {
        Self::new(self.dual.acos(), self.cone.flipped())
    }
    fn atan(self) -> Self {
        self.with(self.dual.atan())
    }
    fn sinh(self) -> Self {
        self.with(self.dual.sinh())
    }
    fn cosh(self) -> Self {
        Self::new(self.dual.cosh(), self.cone.scaled(self.value()))
    }
    fn tanh(self) -> Self {
        self.with(self.dual.tanh())
    }
    fn not(self) -> Self {
        Self::only(self.dual.not())
    }

    fn add(self, y: Self) -> Self {
        Self::new(self.dual.add(y.dual), self.cone.joined(y.cone))
    }
    fn sub(self, y: Self) -> Self {
        Self::new(self.dual.sub(y.dual), self.cone.joined(y.cone.flipped()))
    }
    fn mul(self, y: Self) -> Self {
        let cone = self.cone.scaled(y.value()).joined(y.cone.scaled(self.value()));
        Self::new(self.dual.mul(y.dual), cone)
    }
    fn div(self, y: Self) -> Self {
        // ∇(x / y) = ∇x / y - x ∇y / y²
        let cone = self.cone.scaled(y.value()).joined(y.cone.scaled(self.value().neg()));
        Self::new(self.dual.div(y.dual), cone)
    }
    fn min(self, y: Self) -> Self {
        let cone = match [is_below(self.value(), y.value()), is_below(y.value(), self.value())] {
            [true, _] => self.cone,
            [_, true] => y.cone,
            [false, false] => self.cone.joined(y.cone),
        };
        Self::new(self.dual.min(y.dual), cone)
    }
    fn max(self, y: Self) -> Self {
        let cone = match [is_below(self.value(), y.value()), is_below(y.value(), self.value())] {
            [true, _] => y.cone,
            [_, true] => self.cone,
            [false, false] => self.cone.joined(y.cone),
        };
        Self::new(self.dual.max(y.dual), cone)
    }
    fn pow(self, y: Self) -> Self {
        let (x, power) = (self.value(), y.value());
        let may_jump = x.contains(0.0) && power.contains(0.0);
        let cone = match x.lo() >= 0.0 && !may_jump {
            true => self.cone.scaled(power).joined(y.cone.scaled(x.log())),
            false => Cone::UNBOUNDED,
        };
        Self::new(self.dual.pow(y.dual), cone)
    }
    fn atan2(self, x: Self) -> Self {
        let (across, along) = (self.value(), x.value());
        let may_jump = across.contains(0.0) && along.lo() <= 0.0;
        let cone = match may_jump {
            true => Cone::UNBOUNDED,
            false => self.cone.scaled(along).joined(x.cone.scaled(across.neg())),
        };
        Self::new(self.dual.atan2(x.dual), cone)
    }
    fn step(self, x: Self) -> Self {
        Self::only(self.dual.step(x.dual))
    }
    fn hash(self, x: Self) -> Self {
        Self::only(self.dual.hash(x.dual))
    }
    fn normalize_lane(self, length: Self) -> Self {
        let dual = self.dual.normalize_lane(length.dual);
        match length.value().contains(0.0) {
            true => Self::only(dual),
            false => self.div(length).with(dual),
        }
    }
    fn lt(self, y: Self) -> Self {
        Self::only(self.dual.lt(y.dual))
    }
    fn le(self, y: Self) -> Self {
        Self::only(self.dual.le(y.dual))
    }
    fn eq(self, y: Self) -> Self {
        Self::only(self.dual.eq(y.dual))
    }
    fn ne(self, y: Self) -> Self {
        Self::only(self.dual.ne(y.dual))
    }
    fn and(self, y: Self) -> Self {
        Self::only(self.dual.and(y.dual))
    }
    fn or(self, y: Self) -> Self {
        Self::only(self.dual.or(y.dual))
    }

    fn mix(self, y: Self, t: Self) -> Self {
        // ∇ = (1 - t) ∇x + t ∇y + (y - x) ∇t
        let rest = Interval::constant(1.0).sub(t.value());
        let by_t = t.cone.scaled(y.value().sub(self.value()));
        let cone = self.cone.scaled(rest).joined(y.cone.scaled(t.value())).joined(by_t);
        Self::new(self.dual.mix(y.dual, t.dual), cone)
    }
    fn clamp(self, lo: Self, hi: Self) -> Self {
        self.max(lo).min(hi).with(self.dual.clamp(lo.dual, hi.dual))
    }
    fn smoothstep(self, hi: Self, x: Self) -> Self {
        Self::only(self.dual.smoothstep(hi.dual, x.dual))
    }
    fn select(self, yes: Self, no: Self) -> Self {
        let dual = self.dual.select(yes.dual, no.dual);
        match self.value() {
            truth if !truth.contains(0.0) => yes.with(dual),
            truth if truth.magnitude() == 0.0 => no.with(dual),
            _ => Self::only(dual),
        }
    }

    fn is_definitely_false(self) -> bool {
        self.dual.is_definitely_false()
    }
    fn element(self, list: &[f64]) -> Self {
        Self::only(self.dual.element(list))
    }
    fn fract_with_floor(self, whole: Self) -> Self {
        self.sub(whole).with(self.dual.fract_with_floor(whole.dual))
    }
    fn rem_with_quotient(self, y: Self, whole: Self) -> Self {
        self.sub(y.mul(whole)).with(self.dual.rem_with_quotient(y.dual, whole.dual))
    }
    fn x_times_one_minus_x(self, y: Self, c: Self) -> Self {
        // c x (1 - x), with the derivative c (1 - 2 x) for x.
        let (x, one) = (self.value(), Interval::constant(1.0));
        let by_x = self.cone.scaled(c.value().mul(one.sub(x.add(x))));
        let cone = by_x.joined(c.cone.scaled(x.mul(one.sub(x))));
        Self::new(self.dual.x_times_one_minus_x(y.dual, c.dual), cone)
    }
    fn clamp_residual(self, lo: Self, hi: Self) -> Self {
        let dual = self.dual.clamp_residual(lo.dual, hi.dual);
        Self::constant(0.0).min(self.sub(lo)).max(self.sub(hi)).with(dual)
    }
}
