//! Bounds of loops and tables.

use super::encloser::Encloser;
use super::values::{BoundedValue, Interval, LARGE, Values};
use crate::loops::{Loop, Table};
use crate::node::{Binary, LoopId, LoopVar, Node, NodeId, Unary};

/// A part of a loop's state: its value before the first iteration and after an iteration.
#[derive(Clone, Copy)]
struct Carried {
    init: NodeId,
    step: NodeId,
}

impl Encloser<'_> {
    /// Bounds the state after a loop by a loop over the least and the greatest values. Where it
    /// cannot be decided whether an iteration follows, the result covers both the old and the new
    /// state.
    pub(super) fn bound_loop(&mut self, id: LoopId) -> Option<Vec<BoundedValue>> {
        let loop_ = self.graph.loop_at(id).clone();
        let body = self.graph.loop_body(id);
        let mut inits = Vec::new();
        for &part in &loop_.init {
            let known = self.known.get(part)?;
            let slope = self.slope(known);
            inits.push([self.interval(known.value), self.interval(slope)]);
        }
        let parts = inits.len();
        let ends = if self.direction.is_some() { 4 } else { 2 };
        let variable = |s: &mut Self, position: usize, start: NodeId| {
            let ty = s.graph.ty(start);
            s.graph.variable(loop_.depth, LoopVar::State(position as u16), ty)
        };
        let mut first: Vec<NodeId> = Vec::new();
        for [value, slope] in &inits {
            first.extend([value.lo, value.hi, slope.lo, slope.hi].into_iter().take(ends));
        }
        let variables: Vec<NodeId> =
            (0..).zip(&first).map(|(at, &start)| variable(self, at, start)).collect();
        for (part, own) in (0..).zip(variables.chunks(ends)) {
            let ty = self.graph.ty(own[0]);
            let id = self.graph.variable(loop_.depth, LoopVar::State(part), ty);
            let value = Values::Interval(Interval::overflowing(own[0], own[1]));
            let slope =
                own.get(2..4).map(|own| Values::Interval(Interval::overflowing(own[0], own[1])));
            self.known.insert(id, BoundedValue { value, slope });
        }
        for &node in body.condition.iter().chain(&body.step) {
            self.bound_node(node)?;
        }
        let mut steps = Vec::new();
        for &part in &loop_.step {
            let known = self.known.get(part)?;
            let slope = self.slope(known);
            let (value, slope) = (self.interval(known.value), self.interval(slope));
            for interval in [value, slope].into_iter().take(ends / 2) {
                let Interval { lo, hi, .. } = self.clamp_to_large(interval);
                steps.extend([lo, hi]);
            }
        }
        let condition = match loop_.condition {
            Some(condition) => {
                let condition = self.known.get(condition)?.value;
                Some(self.interval(condition))
            }
            None => None,
        };
        let mut carried: Vec<Carried> =
            first.iter().zip(steps).map(|(&init, step)| Carried { init, step }).collect();
        if let Some(condition) = condition {
            let ended = self.may_have_ended(condition, &variables, &carried, loop_.depth);
            carried.extend(ended);
        }
        let results = self.graph.add_loop(Loop {
            condition: condition.map(|condition| condition.hi),
            init: carried.iter().map(|part| part.init).collect(),
            step: carried.iter().map(|part| part.step).collect(),
            skip: None,
            ..loop_
        });
        // Another loop of this depth may share the body's nodes, but not their bounds.
        for &node in body.condition.iter().chain(&body.step) {
            *self.known.entry(node) = None;
            if let Node::Loop(nested, ..) = self.graph.node(node) {
                self.loops.remove(&nested);
            }
        }
        Some(self.after(&results, parts, ends))
    }

    /// For each variable, the hull of its values at iterations after which the loop may have ended;
    /// and last a flag whether there was any.
    fn may_have_ended(
        &mut self,
        condition: Interval,
        variables: &[NodeId],
        carried: &[Carried],
        depth: u8,
    ) -> Vec<Carried> {
        let mut ended = Vec::new();
        for (position, (&variable, part)) in variables.iter().zip(carried).enumerate() {
            let low = position % 2 == 0;
            let (op, none) = if low { (Binary::Min, LARGE) } else { (Binary::Max, -LARGE) };
            let init = self.number_like(part.init, none);
            let var = LoopVar::State((carried.len() + position) as u16);
            let before = self.graph.variable(depth, var, self.graph.ty(init));
            let joined = self.graph.binary(op, before, variable);
            let step = self.graph.select(condition.lo, before, joined);
            ended.push(Carried { init, step });
        }
        let zero = self.graph.number(0.0);
        let one = self.graph.number(1.0);
        let var = LoopVar::State((2 * carried.len()) as u16);
        let before = self.graph.variable(depth, var, crate::node::Type::Scalar);
        let step = self.graph.select(condition.lo, before, one);
        ended.push(Carried { init: zero, step });
        ended
    }

    fn after(&mut self, results: &[NodeId], parts: usize, ends: usize) -> Vec<BoundedValue> {
        let count = parts * ends;
        let (last, ended) = results.split_at(count.min(results.len()));
        let mut found = Vec::with_capacity(parts);
        for part in 0..parts {
            let mut intervals = Vec::new();
            for at in (part * ends..(part + 1) * ends).step_by(2) {
                let mut interval = Interval::overflowing(last[at], last[at + 1]);
                if let (Some(&lo), Some(&hi)) = (ended.get(at), ended.get(at + 1)) {
                    interval = self.hull(interval, Interval::overflowing(lo, hi));
                }
                intervals.push(interval);
            }
            let slope =
                intervals.get(1).copied().map(|slope| self.unbounded_if(ended.get(count), slope));
            let value = intervals[0].into();
            found.push(BoundedValue { value, slope: slope.map(Values::Interval) });
        }
        found
    }

    /// The slope, or an unbounded one where the number of iterations may vary along the segment.
    fn unbounded_if(&mut self, ended: Option<&NodeId>, slope: Interval) -> Interval {
        let Some(&ended) = ended else { return slope };
        let margin = self.scaled(ended, LARGE);
        let ty = self.graph.ty(slope.lo);
        let margin = self.graph.splat(ty, margin);
        self.expand(slope, margin)
    }

    /// An element of a table: one element while the index is constant, else the hull of all.
    pub(super) fn element(&mut self, table: &Table, at: BoundedValue) -> BoundedValue {
        if let Values::Constant(at) = at.value {
            return BoundedValue::fixed(Values::Constant(self.graph.element(table.clone(), at)));
        }
        let index = self.unary(Unary::Floor, at.value);
        let index = self.interval(index);
        let same = self.graph.binary(Binary::Eq, index.lo, index.hi);
        let one = self.graph.element(table.clone(), index.lo);
        let mut ends = [[f64::INFINITY; 4], [f64::NEG_INFINITY; 4]];
        for element in &table.elements {
            for (lane, value) in element.lanes().into_iter().enumerate() {
                ends[0][lane] = ends[0][lane].min(value);
                ends[1][lane] = ends[1][lane].max(value);
            }
        }
        let [lo, hi] = ends.map(|lanes| self.graph.constant(table.ty, &lanes));
        let value =
            self.select(Interval::new(same, same), Interval::new(one, one), Interval::new(lo, hi));
        let slope = at.slope.map(|_| {
            let jump = self.jump(index);
            self.splat(table.ty, jump)
        });
        BoundedValue { value: value.into(), slope }
    }
}
