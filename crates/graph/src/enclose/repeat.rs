//! Loops and lists.

use super::Enclosing;
use super::extent::{Extent, LARGE, Span};
use super::slope::Known;
use crate::repeat::{Loop, Table};
use crate::{Binary, LoopId, Node, NodeId, Place, Unary};

/// A part of a loop's state: a node of each round, what it is before the first, and after a round.
#[derive(Clone, Copy)]
struct Carried {
    start: NodeId,
    next: NodeId,
}

impl Enclosing<'_> {
    /// What is known of the state after a loop: a loop over the least and the greatest values. Where it cannot be told
    /// whether a round follows, the result is both what the state was and what it becomes.
    pub(super) fn repeat(&mut self, id: LoopId) -> Option<Vec<Known>> {
        let repeated = self.graph.repeated(id).clone();
        let body = self.graph.body(id);
        let mut starts = Vec::new();
        for &part in &repeated.start {
            let known = self.known.get(part)?;
            let slope = self.slope(known);
            starts.push([self.span(known.value), self.span(slope)]);
        }
        let parts = starts.len();
        let ends = if self.direction.is_some() { 4 } else { 2 };
        let variable = |s: &mut Self, position: usize, start: NodeId| {
            let ty = s.graph.ty(start);
            s.graph.variable(repeated.depth, Place::State(position as u16), ty)
        };
        let mut first: Vec<NodeId> = Vec::new();
        for [value, slope] in &starts {
            first.extend([value.lo, value.hi, slope.lo, slope.hi].into_iter().take(ends));
        }
        let variables: Vec<NodeId> =
            (0..).zip(&first).map(|(at, &start)| variable(self, at, start)).collect();
        for (part, own) in (0..).zip(variables.chunks(ends)) {
            let ty = self.graph.ty(own[0]);
            let id = self.graph.variable(repeated.depth, Place::State(part), ty);
            let value = Extent::Span(Span::wild(own[0], own[1]));
            let slope = own.get(2..4).map(|own| Extent::Span(Span::wild(own[0], own[1])));
            self.known.insert(id, Known { value, slope });
        }
        for &node in body.condition.iter().chain(&body.round) {
            self.visit(node)?;
        }
        let mut next = Vec::new();
        for &part in &repeated.next {
            let known = self.known.get(part)?;
            let slope = self.slope(known);
            let (value, slope) = (self.span(known.value), self.span(slope));
            for span in [value, slope].into_iter().take(ends / 2) {
                let Span { lo, hi, .. } = self.cut(span);
                next.extend([lo, hi]);
            }
        }
        let go_on = match repeated.go_on {
            Some(condition) => {
                let condition = self.known.get(condition)?.value;
                Some(self.span(condition))
            }
            None => None,
        };
        let mut carried: Vec<Carried> =
            first.iter().zip(next).map(|(&start, next)| Carried { start, next }).collect();
        if let Some(go_on) = go_on {
            let ended = self.may_have_ended(go_on, &variables, &carried, repeated.depth);
            carried.extend(ended);
        }
        let results = self.graph.repeat(Loop {
            go_on: go_on.map(|go_on| go_on.hi),
            start: carried.iter().map(|part| part.start).collect(),
            next: carried.iter().map(|part| part.next).collect(),
            inert: None,
            ..repeated
        });
        // Another loop of this depth may share the body's nodes, not what is known of them.
        for &node in body.condition.iter().chain(&body.round) {
            *self.known.slot(node) = None;
            if let Node::Loop(within, ..) = self.graph.node(node) {
                self.loops.remove(&within);
            }
        }
        Some(self.after(&results, parts, ends))
    }

    /// For each of the variables what it was in rounds after which the loop may have ended; and last whether any was.
    fn may_have_ended(
        &mut self,
        go_on: Span,
        variables: &[NodeId],
        carried: &[Carried],
        depth: u8,
    ) -> Vec<Carried> {
        let mut ended = Vec::new();
        for (position, (&variable, part)) in variables.iter().zip(carried).enumerate() {
            let low = position % 2 == 0;
            let (op, none) = if low { (Binary::Min, LARGE) } else { (Binary::Max, -LARGE) };
            let start = self.number_like(part.start, none);
            let place = Place::State((carried.len() + position) as u16);
            let before = self.graph.variable(depth, place, self.graph.ty(start));
            let joined = self.graph.binary(op, before, variable);
            let next = self.graph.select(go_on.lo, before, joined);
            ended.push(Carried { start, next });
        }
        let nought = self.graph.number(0.0);
        let one = self.graph.number(1.0);
        let place = Place::State((2 * carried.len()) as u16);
        let before = self.graph.variable(depth, place, crate::Type::Scalar);
        let next = self.graph.select(go_on.lo, before, one);
        ended.push(Carried { start: nought, next });
        ended
    }

    fn after(&mut self, results: &[NodeId], parts: usize, ends: usize) -> Vec<Known> {
        let count = parts * ends;
        let (last, ended) = results.split_at(count.min(results.len()));
        let mut found = Vec::with_capacity(parts);
        for part in 0..parts {
            let mut spans = Vec::new();
            for at in (part * ends..(part + 1) * ends).step_by(2) {
                let mut span = Span::wild(last[at], last[at + 1]);
                if let (Some(&lo), Some(&hi)) = (ended.get(at), ended.get(at + 1)) {
                    span = self.hull(span, Span::wild(lo, hi));
                }
                spans.push(span);
            }
            let slope = spans.get(1).copied().map(|slope| self.unless(ended.get(count), slope));
            let value = spans[0].into();
            found.push(Known { value, slope: slope.map(Extent::Span) });
        }
        found
    }

    /// A slope, or any where the number of rounds is not the same throughout.
    fn unless(&mut self, ended: Option<&NodeId>, slope: Span) -> Span {
        let Some(&ended) = ended else { return slope };
        let margin = self.scaled(ended, LARGE);
        let ty = self.graph.ty(slope.lo);
        let margin = self.graph.splat(ty, margin);
        self.grown(slope, margin)
    }

    /// An element of a list: one while the place is, else between the least and the greatest of all.
    pub(super) fn element(&mut self, table: &Table, at: Known) -> Known {
        if let Extent::Fixed(at) = at.value {
            return Known::fixed(Extent::Fixed(self.graph.element(table.clone(), at)));
        }
        let place = self.unary(Unary::Floor, at.value);
        let place = self.span(place);
        let same = self.graph.binary(Binary::Eq, place.lo, place.hi);
        let one = self.graph.element(table.clone(), place.lo);
        let mut ends = [[f64::INFINITY; 4], [f64::NEG_INFINITY; 4]];
        for element in &table.elements {
            for (lane, value) in element.lanes().into_iter().enumerate() {
                ends[0][lane] = ends[0][lane].min(value);
                ends[1][lane] = ends[1][lane].max(value);
            }
        }
        let [lo, hi] = ends.map(|lanes| self.graph.constant(table.ty, &lanes));
        let value = self.chosen(Span::new(same, same), Span::new(one, one), Span::new(lo, hi));
        let slope = at.slope.map(|_| {
            let jump = self.jump(place);
            self.splat(table.ty, jump)
        });
        Known { value: value.into(), slope }
    }
}
