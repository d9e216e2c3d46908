//! What a node may be along a stretch, and how rounding is covered.

use super::Enclosing;
use crate::{Binary, NodeId, Type, Unary};

/// Stands for infinity: shaders need not have one, and products of two such numbers are still finite.
pub(super) const LARGE: f64 = 1e15;
/// No divisor is less: the largest coordinates by it are finite.
pub(super) const TINY: f64 = 1e-30;
/// Rounding of one operation and of the constants in it, relative: two units in the last place of f32.
pub(super) const ROUNDING: f64 = 1.0 / 4_194_304.0;
/// Of a root or a quotient, which devices round less well: four units.
pub(super) const COARSE: f64 = 2.0 * ROUNDING;
/// Of an affine map's value, relative to the sum of its terms' magnitudes: eight units.
pub(super) const AFFINE: f64 = 4.0 * ROUNDING;

/// The values of a node along a stretch.
#[derive(Clone, Copy, Debug)]
pub(super) enum Extent {
    /// One value.
    Fixed(NodeId),
    /// A value that changes evenly from one end to the other.
    Line(Line),
    /// Any values between two.
    Span(Span),
}

/// The values at the ends, and a bound of the magnitudes of all terms that they are sums of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) ends: [NodeId; 2],
    pub(super) size: NodeId,
}

impl Line {
    /// Whether it is one value, known but for rounding.
    pub(super) fn is_level(self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

/// The least and the greatest value, each lane for itself. Of a truth value: whether it holds for certain, and
/// whether it may hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) lo: NodeId,
    pub(super) hi: NodeId,
    /// Whether it may reach [`LARGE`], so that products of it must be cut off there.
    pub(super) wild: bool,
}

impl Span {
    pub(super) fn new(lo: NodeId, hi: NodeId) -> Self {
        Self { lo, hi, wild: false }
    }

    pub(super) fn wild(lo: NodeId, hi: NodeId) -> Self {
        Self { lo, hi, wild: true }
    }

    fn with(self, others: &[Self]) -> Self {
        Self { wild: self.wild || others.iter().any(|other| other.wild), ..self }
    }
}

impl From<Span> for Extent {
    fn from(span: Span) -> Self {
        Self::Span(span)
    }
}

impl Enclosing<'_> {
    pub(super) fn ty(&self, x: Extent) -> Type {
        self.graph.ty(match x {
            Extent::Fixed(node) | Extent::Span(Span { lo: node, .. }) => node,
            Extent::Line(Line { ends: [node, _], .. }) => node,
        })
    }

    /// The least interval that holds it, as computed.
    pub(super) fn span(&mut self, x: Extent) -> Span {
        match x {
            Extent::Fixed(value) => Span::new(value, value),
            Extent::Line(Line { ends: [a, b], size }) => {
                let (lo, hi) = (self.graph.min(a, b), self.graph.max(a, b));
                let margin = self.scaled(size, AFFINE);
                self.grown(Span::new(lo, hi), margin)
            }
            Extent::Span(span) => span,
        }
    }

    /// As values at the ends, if it changes evenly.
    pub(super) fn line(&mut self, x: Extent) -> Option<Line> {
        match x {
            Extent::Fixed(value) => {
                let size = self.graph.abs(value);
                Some(Line { ends: [value; 2], size })
            }
            Extent::Line(line) => Some(line),
            Extent::Span(_) => None,
        }
    }

    /// Several as values at the ends, if all change evenly.
    pub(super) fn lines<const N: usize>(&mut self, all: [Extent; N]) -> Option<[Line; N]> {
        let even = all.iter().all(|x| !matches!(x, Extent::Span(_)));
        if !even {
            return None;
        }
        let nothing = self.graph.number(0.0);
        let unused = Line { ends: [nothing; 2], size: nothing };
        Some(all.map(|x| self.line(x).unwrap_or(unused)))
    }

    /// The same numbers in other places.
    pub(super) fn moved(
        &mut self,
        x: Extent,
        mut place: impl FnMut(&mut crate::Graph, NodeId) -> NodeId,
    ) -> Extent {
        let mut place = |node| place(self.graph, node);
        match x {
            Extent::Fixed(value) => Extent::Fixed(place(value)),
            Extent::Line(Line { ends, size }) => {
                Extent::Line(Line { ends: ends.map(&mut place), size: place(size) })
            }
            Extent::Span(Span { lo, hi, wild }) => {
                Extent::Span(Span { lo: place(lo), hi: place(hi), wild })
            }
        }
    }

    pub(super) fn component(&mut self, x: Extent, lane: u8) -> Extent {
        self.moved(x, |graph, node| graph.component(node, lane))
    }

    pub(super) fn splat(&mut self, ty: Type, x: Extent) -> Extent {
        self.moved(x, |graph, node| graph.splat(ty, node))
    }

    pub(super) fn compose(&mut self, parts: &[Extent]) -> Extent {
        let fixed: Option<Vec<NodeId>> = parts
            .iter()
            .map(|part| if let Extent::Fixed(value) = part { Some(*value) } else { None })
            .collect();
        if let Some(values) = fixed {
            return Extent::Fixed(self.graph.compose(&values));
        }
        let lines: Option<Vec<Line>> = parts.iter().map(|&part| self.line(part)).collect();
        let graph = &mut *self.graph;
        if let Some(lines) = lines {
            let mut joined =
                |of: fn(&Line) -> NodeId| graph.compose(&lines.iter().map(of).collect::<Vec<_>>());
            let ends = [joined(|line| line.ends[0]), joined(|line| line.ends[1])];
            return Extent::Line(Line { ends, size: joined(|line| line.size) });
        }
        let spans: Vec<Span> = parts.iter().map(|&part| self.span(part)).collect();
        let lo: Vec<NodeId> = spans.iter().map(|span| span.lo).collect();
        let hi: Vec<NodeId> = spans.iter().map(|span| span.hi).collect();
        let whole = Span::new(self.graph.compose(&lo), self.graph.compose(&hi));
        whole.with(&spans).into()
    }

    /// A rule of numbers, lane by lane.
    pub(super) fn by_lane<const N: usize>(
        &mut self,
        arguments: [Extent; N],
        mut rule: impl FnMut(&mut Self, [Extent; N]) -> Span,
    ) -> Extent {
        let width = arguments.first().map_or(1, |&x| self.ty(x).width());
        if width == 1 {
            return rule(self, arguments).into();
        }
        let mut lanes = Vec::with_capacity(width);
        for lane in 0..width as u8 {
            let parts = arguments.map(|x| self.component(x, lane));
            lanes.push(Extent::Span(rule(self, parts)));
        }
        self.compose(&lanes)
    }

    pub(super) fn number_like(&mut self, node: NodeId, value: f64) -> NodeId {
        let ty = self.graph.ty(node);
        self.graph.constant(ty, &[value; 4])
    }

    pub(super) fn scaled(&mut self, node: NodeId, factor: f64) -> NodeId {
        let factor = self.number_like(node, factor);
        self.graph.mul(node, factor)
    }

    pub(super) fn offset(&mut self, node: NodeId, by: f64) -> NodeId {
        let by = self.number_like(node, by);
        self.graph.add(node, by)
    }

    pub(super) fn above_zero(&mut self, node: NodeId) -> NodeId {
        let nought = self.number_like(node, 0.0);
        self.graph.max(node, nought)
    }

    pub(super) fn at_least(&mut self, node: NodeId, value: f64) -> NodeId {
        let value = self.number_like(node, value);
        self.graph.max(node, value)
    }

    pub(super) fn at_most(&mut self, node: NodeId, value: f64) -> NodeId {
        let value = self.number_like(node, value);
        self.graph.min(node, value)
    }

    /// All numbers.
    pub(super) fn entire(&mut self, ty: Type) -> Span {
        let lo = self.graph.constant(ty, &[-LARGE; 4]);
        Span::wild(lo, self.graph.constant(ty, &[LARGE; 4]))
    }

    /// Numbers between two.
    pub(super) fn between(&mut self, like: NodeId, lo: f64, hi: f64) -> Span {
        Span::new(self.number_like(like, lo), self.number_like(like, hi))
    }

    /// What lies in either.
    pub(super) fn hull(&mut self, x: Span, y: Span) -> Span {
        let (lo, hi) = (self.graph.min(x.lo, y.lo), self.graph.max(x.hi, y.hi));
        Span::new(lo, hi).with(&[x, y])
    }

    /// Between the least and the greatest of some values.
    pub(super) fn around(&mut self, corners: &[NodeId]) -> Span {
        let (mut lo, mut hi) = (corners[0], corners[0]);
        for &corner in &corners[1..] {
            lo = self.graph.min(lo, corner);
            hi = self.graph.max(hi, corner);
        }
        Span::new(lo, hi)
    }

    pub(super) fn clipped(&mut self, x: Span, lo: f64, hi: f64) -> Span {
        let ends = [x.lo, x.hi].map(|end| {
            let raised = self.at_least(end, lo);
            self.at_most(raised, hi)
        });
        Span { lo: ends[0], hi: ends[1], wild: x.wild && (lo <= -LARGE || hi >= LARGE) }
    }

    /// Cut off where numbers count as infinite.
    pub(super) fn cut(&mut self, x: Span) -> Span {
        Span { wild: true, ..self.clipped(x, -LARGE, LARGE) }
    }

    /// Wider by a margin on both sides.
    pub(super) fn grown(&mut self, x: Span, margin: NodeId) -> Span {
        Span { lo: self.graph.sub(x.lo, margin), hi: self.graph.add(x.hi, margin), ..x }
    }

    pub(super) fn grown_by(&mut self, x: Span, margin: f64) -> Span {
        let margin = self.number_like(x.lo, margin);
        self.grown(x, margin)
    }

    /// The greatest magnitude.
    pub(super) fn magnitude(&mut self, x: Span) -> NodeId {
        let low = self.graph.neg(x.lo);
        self.graph.max(x.hi, low)
    }

    /// Wider by a part of its numbers.
    pub(super) fn widened(&mut self, x: Span, part: f64) -> Span {
        let (less, more) = (1.0 - part, 1.0 + part);
        if self.graph.range(x.lo).lo >= 0.0 {
            Span { lo: self.scaled(x.lo, less), hi: self.scaled(x.hi, more), ..x }
        } else if self.graph.range(x.hi).hi <= 0.0 {
            Span { lo: self.scaled(x.lo, more), hi: self.scaled(x.hi, less), ..x }
        } else {
            let magnitude = self.magnitude(x);
            let margin = self.scaled(magnitude, part);
            self.grown(x, margin)
        }
    }

    /// Of two truth values at scalars, or lanes 0 and 1: whether the first is chosen for certain, and whether it may be.
    pub(super) fn chosen(&mut self, truth: Span, yes: Span, no: Span) -> Span {
        if truth.lo == truth.hi {
            let lo = self.graph.select(truth.lo, yes.lo, no.lo);
            let hi = self.graph.select(truth.lo, yes.hi, no.hi);
            return Span::new(lo, hi).with(&[yes, no]);
        }
        let either = self.hull(yes, no);
        let maybe = [(either.lo, no.lo), (either.hi, no.hi)];
        let [lo, hi] = maybe.map(|(either, no)| self.graph.select(truth.hi, either, no));
        let lo = self.graph.select(truth.lo, yes.lo, lo);
        let hi = self.graph.select(truth.lo, yes.hi, hi);
        Span::new(lo, hi).with(&[yes, no])
    }

    /// An operation that rises with its argument, exact at both ends.
    pub(super) fn monotone(&mut self, op: Unary, x: Span) -> Span {
        Span { lo: self.graph.unary(op, x.lo), hi: self.graph.unary(op, x.hi), ..x }
    }

    /// An operation that rises with both arguments, exact at both ends.
    pub(super) fn monotone2(&mut self, op: Binary, x: Span, y: Span) -> Span {
        let lo = self.graph.binary(op, x.lo, y.lo);
        Span::new(lo, self.graph.binary(op, x.hi, y.hi)).with(&[x, y])
    }
}
