//! Operations on possible values: conversion, hull, margins, selection.

use super::encloser::Encloser;
use super::values::{AFFINE, Affine, Interval, LARGE, Values};
use crate::graph::Graph;
use crate::node::{Binary, NodeId, Type, Unary};

impl Encloser<'_> {
    pub(super) fn ty(&self, x: Values) -> Type {
        self.graph.ty(match x {
            Values::Constant(node) | Values::Interval(Interval { lo: node, .. }) => node,
            Values::Affine(Affine { ends: [node, _], .. }) => node,
        })
    }

    /// The smallest interval that contains the values as computed.
    pub(super) fn interval(&mut self, x: Values) -> Interval {
        match x {
            Values::Constant(value) => Interval::new(value, value),
            Values::Affine(Affine { ends: [a, b], magnitude: size }) => {
                let (lo, hi) = (self.graph.min(a, b), self.graph.max(a, b));
                let margin = self.scaled(size, AFFINE);
                self.expand(Interval::new(lo, hi), margin)
            }
            Values::Interval(interval) => interval,
        }
    }

    /// The value as an affine one, if it is affine or constant.
    pub(super) fn affine(&mut self, x: Values) -> Option<Affine> {
        match x {
            Values::Constant(value) => {
                let size = self.graph.abs(value);
                Some(Affine { ends: [value; 2], magnitude: size })
            }
            Values::Affine(affine) => Some(affine),
            Values::Interval(_) => None,
        }
    }

    /// Several values as affine ones, if all are affine or constant.
    pub(super) fn affine_all<const N: usize>(&mut self, all: [Values; N]) -> Option<[Affine; N]> {
        let even = all.iter().all(|x| !matches!(x, Values::Interval(_)));
        if !even {
            return None;
        }
        let zero = self.graph.number(0.0);
        let unused = Affine { ends: [zero; 2], magnitude: zero };
        Some(all.map(|x| self.affine(x).unwrap_or(unused)))
    }

    /// Applies a function that rearranges lanes to all nodes of a value.
    pub(super) fn map_nodes(
        &mut self,
        x: Values,
        mut map: impl FnMut(&mut Graph, NodeId) -> NodeId,
    ) -> Values {
        let mut map = |node| map(self.graph, node);
        match x {
            Values::Constant(value) => Values::Constant(map(value)),
            Values::Affine(Affine { ends, magnitude: size }) => {
                Values::Affine(Affine { ends: ends.map(&mut map), magnitude: map(size) })
            }
            Values::Interval(Interval { lo, hi, may_overflow }) => {
                Values::Interval(Interval { lo: map(lo), hi: map(hi), may_overflow })
            }
        }
    }

    pub(super) fn component(&mut self, x: Values, lane: u8) -> Values {
        self.map_nodes(x, |graph, node| graph.component(node, lane))
    }

    pub(super) fn splat(&mut self, ty: Type, x: Values) -> Values {
        self.map_nodes(x, |graph, node| graph.splat(ty, node))
    }

    pub(super) fn compose(&mut self, parts: &[Values]) -> Values {
        let fixed: Option<Vec<NodeId>> = parts
            .iter()
            .map(|part| if let Values::Constant(value) = part { Some(*value) } else { None })
            .collect();
        if let Some(values) = fixed {
            return Values::Constant(self.graph.compose(&values));
        }
        let affines: Option<Vec<Affine>> = parts.iter().map(|&part| self.affine(part)).collect();
        let graph = &mut *self.graph;
        if let Some(affines) = affines {
            let mut joined = |of: fn(&Affine) -> NodeId| {
                graph.compose(&affines.iter().map(of).collect::<Vec<_>>())
            };
            let ends = [joined(|affine| affine.ends[0]), joined(|affine| affine.ends[1])];
            return Values::Affine(Affine { ends, magnitude: joined(|affine| affine.magnitude) });
        }
        let intervals: Vec<Interval> = parts.iter().map(|&part| self.interval(part)).collect();
        let lo: Vec<NodeId> = intervals.iter().map(|interval| interval.lo).collect();
        let hi: Vec<NodeId> = intervals.iter().map(|interval| interval.hi).collect();
        let whole = Interval::new(self.graph.compose(&lo), self.graph.compose(&hi));
        whole.with(&intervals).into()
    }

    /// Applies a rule for scalars lane by lane.
    pub(super) fn per_lane<const N: usize>(
        &mut self,
        arguments: [Values; N],
        mut rule: impl FnMut(&mut Self, [Values; N]) -> Interval,
    ) -> Values {
        let width = arguments.first().map_or(1, |&x| self.ty(x).width());
        if width == 1 {
            return rule(self, arguments).into();
        }
        let mut lanes = Vec::with_capacity(width);
        for lane in 0..width as u8 {
            let parts = arguments.map(|x| self.component(x, lane));
            lanes.push(Values::Interval(rule(self, parts)));
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
        let zero = self.number_like(node, 0.0);
        self.graph.max(node, zero)
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
    pub(super) fn entire(&mut self, ty: Type) -> Interval {
        let lo = self.graph.constant(ty, &[-LARGE; 4]);
        Interval::overflowing(lo, self.graph.constant(ty, &[LARGE; 4]))
    }

    /// The interval between two numbers.
    pub(super) fn between(&mut self, like: NodeId, lo: f64, hi: f64) -> Interval {
        Interval::new(self.number_like(like, lo), self.number_like(like, hi))
    }

    /// The smallest interval that contains both.
    pub(super) fn hull(&mut self, x: Interval, y: Interval) -> Interval {
        let (lo, hi) = (self.graph.min(x.lo, y.lo), self.graph.max(x.hi, y.hi));
        Interval::new(lo, hi).with(&[x, y])
    }

    /// The smallest interval that contains all of the values.
    pub(super) fn hull_of(&mut self, corners: &[NodeId]) -> Interval {
        let (mut lo, mut hi) = (corners[0], corners[0]);
        for &corner in &corners[1..] {
            lo = self.graph.min(lo, corner);
            hi = self.graph.max(hi, corner);
        }
        Interval::new(lo, hi)
    }

    pub(super) fn clamp(&mut self, x: Interval, lo: f64, hi: f64) -> Interval {
        let ends = [x.lo, x.hi].map(|end| {
            let raised = self.at_least(end, lo);
            self.at_most(raised, hi)
        });
        Interval {
            lo: ends[0],
            hi: ends[1],
            may_overflow: x.may_overflow && (lo <= -LARGE || hi >= LARGE),
        }
    }

    /// Clamps to the numbers that do not count as infinite.
    pub(super) fn clamp_to_large(&mut self, x: Interval) -> Interval {
        Interval { may_overflow: true, ..self.clamp(x, -LARGE, LARGE) }
    }

    /// Widens by a margin on both sides.
    pub(super) fn expand(&mut self, x: Interval, margin: NodeId) -> Interval {
        Interval { lo: self.graph.sub(x.lo, margin), hi: self.graph.add(x.hi, margin), ..x }
    }

    pub(super) fn expand_by(&mut self, x: Interval, margin: f64) -> Interval {
        let margin = self.number_like(x.lo, margin);
        self.expand(x, margin)
    }

    /// The greatest magnitude.
    pub(super) fn magnitude(&mut self, x: Interval) -> NodeId {
        let low = self.graph.neg(x.lo);
        self.graph.max(x.hi, low)
    }

    /// Widens by a fraction of the ends.
    pub(super) fn widen_relative(&mut self, x: Interval, fraction: f64) -> Interval {
        let (less, more) = (1.0 - fraction, 1.0 + fraction);
        if self.graph.range(x.lo).lo >= 0.0 {
            Interval { lo: self.scaled(x.lo, less), hi: self.scaled(x.hi, more), ..x }
        } else if self.graph.range(x.hi).hi <= 0.0 {
            Interval { lo: self.scaled(x.lo, more), hi: self.scaled(x.hi, less), ..x }
        } else {
            let magnitude = self.magnitude(x);
            let margin = self.scaled(magnitude, fraction);
            self.expand(x, margin)
        }
    }

    /// The values of `select(truth, yes, no)`, where `truth.lo` tells whether the condition is
    /// certainly true and `truth.hi` whether it may be.
    pub(super) fn select(&mut self, truth: Interval, yes: Interval, no: Interval) -> Interval {
        if truth.lo == truth.hi {
            let lo = self.graph.select(truth.lo, yes.lo, no.lo);
            let hi = self.graph.select(truth.lo, yes.hi, no.hi);
            return Interval::new(lo, hi).with(&[yes, no]);
        }
        let either = self.hull(yes, no);
        let maybe = [(either.lo, no.lo), (either.hi, no.hi)];
        let [lo, hi] = maybe.map(|(either, no)| self.graph.select(truth.hi, either, no));
        let lo = self.graph.select(truth.lo, yes.lo, lo);
        let hi = self.graph.select(truth.lo, yes.hi, hi);
        Interval::new(lo, hi).with(&[yes, no])
    }

    /// An operation that is increasing in its argument and exact at both ends.
    pub(super) fn monotone(&mut self, op: Unary, x: Interval) -> Interval {
        Interval { lo: self.graph.unary(op, x.lo), hi: self.graph.unary(op, x.hi), ..x }
    }

    /// An operation that is increasing in both arguments and exact at both ends.
    pub(super) fn monotone2(&mut self, op: Binary, x: Interval, y: Interval) -> Interval {
        let lo = self.graph.binary(op, x.lo, y.lo);
        Interval::new(lo, self.graph.binary(op, x.hi, y.hi)).with(&[x, y])
    }
}
