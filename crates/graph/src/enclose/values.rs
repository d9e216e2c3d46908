//! The possible values of a node along a segment, and the margins that cover rounding.

use crate::node::NodeId;

/// Stands for infinity, which shaders need not support. Products of two such numbers are still
/// finite.
pub(super) const LARGE: f64 = 1e15;
/// Lower bound of divisors, so that the largest coordinates divided by it are finite.
pub(super) const TINY: f64 = 1e-30;
/// Relative rounding error of one operation and of its constants: two units in the last place of
/// f32.
pub(super) const ROUNDING: f64 = 1.0 / 4_194_304.0;
/// Relative rounding error of a root or a quotient, which devices round less well: four units.
pub(super) const COARSE: f64 = 2.0 * ROUNDING;
/// Rounding error of an affine map, relative to the sum of its terms' magnitudes: eight units.
pub(super) const AFFINE: f64 = 4.0 * ROUNDING;

/// The possible values of a node along a segment.
#[derive(Clone, Copy, Debug)]
pub(super) enum Values {
    /// One value, the same everywhere.
    Constant(NodeId),
    /// A value that changes linearly from one end to the other.
    Affine(Affine),
    /// Any values between two bounds.
    Interval(Interval),
}

/// A value that is affine along the segment: its values at the ends, and a bound on the sum of the
/// magnitudes of its terms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Affine {
    pub(super) ends: [NodeId; 2],
    pub(super) magnitude: NodeId,
}

impl Affine {
    /// True if the value is constant up to rounding.
    pub(super) fn is_constant(self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

/// The least and the greatest value, lane by lane. For a truth value: whether it is certainly true,
/// and whether it may be true.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    pub(super) lo: NodeId,
    pub(super) hi: NodeId,
    /// True if it may reach [`LARGE`], so that products of it must be clamped there.
    pub(super) may_overflow: bool,
}

impl Interval {
    pub(super) fn new(lo: NodeId, hi: NodeId) -> Self {
        Self { lo, hi, may_overflow: false }
    }

    pub(super) fn overflowing(lo: NodeId, hi: NodeId) -> Self {
        Self { lo, hi, may_overflow: true }
    }

    pub(super) fn with(self, others: &[Self]) -> Self {
        Self {
            may_overflow: self.may_overflow || others.iter().any(|other| other.may_overflow),
            ..self
        }
    }
}

impl From<Interval> for Values {
    fn from(interval: Interval) -> Self {
        Self::Interval(interval)
    }
}

/// Bounds of a node's value and slope.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundedValue {
    pub(super) value: Values,
    /// Bounds of its slope; `None` if it is constant.
    pub(super) slope: Option<Values>,
}

impl BoundedValue {
    pub(super) fn fixed(value: Values) -> Self {
        Self { value, slope: None }
    }
}
