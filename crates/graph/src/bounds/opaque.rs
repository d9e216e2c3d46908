//! Formulas without a rule: operators are bounded by their samples, leaves by search.

use super::deriver::{Deriver, Query};
use super::search::{Region, Search};
use super::zone::Zone;
use crate::eval::{Interval, Tape};
use crate::node::{Node, NodeId, ShapeId, Type};
use crate::shape::Shape;
use crate::walk::reachable_where;

/// Operators with more samples than this are not analysed for each sample alone.
const MOST_SINGLE: usize = 4;

/// Margins above the limit that are tried for samples: from `2^-12` to `2^40`, refined to `2^-10`
/// of the margin.
const SMALLEST_MARGIN: i32 = -12;
const LARGEST_MARGIN: i32 = 40;
const REFINEMENTS: usize = 10;

/// An operator's formula as a function of its samples.
struct Operator {
    tape: Tape,
    samples: Vec<NodeId>,
    query: Query,
    limit: Interval,
}

impl Deriver<'_> {
    /// The box of a formula that no rule fits.
    pub(super) fn opaque(&mut self, query: Query) -> Zone {
        let samples = self.samples(query.node);
        if samples.is_empty() {
            return self.searched(query);
        }
        match self.operator(query, samples) {
            Some(operator) => self.by_samples(&operator).loose(),
            None => Zone::everywhere(self.graph).loose(),
        }
    }

    /// The distance that all samples of a shape must exceed for the shape to be positive.
    pub(super) fn reach(&mut self, shape: ShapeId) -> Option<f64> {
        let limit = self.graph.number(0.0);
        let Shape { formula: node, level, dim, .. } = *self.graph.shape(shape);
        let query = Query { node, limit, level, dim, above: false };
        let samples = Some(self.samples(node)).filter(|samples| !samples.is_empty())?;
        let operator = self.operator(query, samples)?;
        self.threshold(&operator, |_| true)
    }

    fn samples(&self, formula: NodeId) -> Vec<NodeId> {
        let graph = &*self.graph;
        let is_sample = |id: NodeId| matches!(graph.node(id), Node::Sample(..));
        let order = reachable_where(graph, &[formula], |id| !is_sample(id));
        order.into_iter().filter(|&id| is_sample(id)).collect()
    }

    fn operator(&mut self, query: Query, samples: Vec<NodeId>) -> Option<Operator> {
        let limit = self.range(query.limit);
        let first = self.ranges.params.len() as u32;
        let tape = Tape::for_operator(self.graph, query.node, &samples, first).ok()?;
        Some(Operator { tape, samples, query, limit })
    }

    /// If the formula exceeds the limit wherever some of its samples exceed a threshold, the box is
    /// where one of those samples does not exceed it. First each sample is tried alone, which finds
    /// intersections, then all together.
    fn by_samples(&mut self, operator: &Operator) -> Zone {
        let mut zone: Option<Zone> = None;
        if operator.samples.len() <= MOST_SINGLE {
            for &sample in &operator.samples {
                let Some(threshold) = self.threshold(operator, |id| id == sample) else { continue };
                let own = self.sample_zone(operator, sample, threshold);
                zone = Some(match zone {
                    Some(zone) => zone.overlap(self.graph, own),
                    None => own,
                });
            }
        }
        if let Some(zone) = zone {
            return zone;
        }
        let Some(threshold) = self.threshold(operator, |_| true) else {
            return Zone::everywhere(self.graph);
        };
        let mut zone = Zone::nowhere(self.graph);
        for &sample in &operator.samples {
            let own = self.sample_zone(operator, sample, threshold);
            zone = zone.hull(self.graph, own);
        }
        zone
    }

    fn sample_zone(&mut self, operator: &Operator, sample: NodeId, threshold: f64) -> Zone {
        let limit = self.graph.number(threshold);
        self.zone(Query { node: sample, limit, above: false, ..operator.query })
    }

    /// The least threshold found such that the formula clears the limit wherever the chosen samples
    /// exceed it.
    fn threshold(&self, operator: &Operator, chosen: impl Fn(NodeId) -> bool) -> Option<f64> {
        let base = if operator.query.above { 0.0 } else { operator.limit.hi() };
        if !base.is_finite() {
            return None;
        }
        let others: Vec<NodeId> =
            operator.samples.iter().copied().filter(|&id| !chosen(id)).collect();
        let clears = |threshold: f64| self.clears(operator, threshold, &others, &mut Vec::new());
        if clears(base) {
            return Some(base);
        }
        // A threshold that clears implies that all higher ones do.
        if !clears(base + 2_f64.powi(LARGEST_MARGIN)) {
            return None;
        }
        let mut margins =
            (SMALLEST_MARGIN..=LARGEST_MARGIN).step_by(4).map(|power| 2_f64.powi(power));
        let mut high = base + margins.find(|margin| clears(base + margin))?;
        let mut low = base;
        for _ in 0..REFINEMENTS {
            let middle = f64::midpoint(low, high);
            if clears(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(high)
    }

    /// True if the formula clears the limit while all samples but the others exceed the threshold.
    /// A blend often depends on which sample is less, so the ranges of the others are split below
    /// the threshold.
    fn clears(
        &self,
        operator: &Operator,
        threshold: f64,
        others: &[NodeId],
        halves: &mut Vec<Interval>,
    ) -> bool {
        if halves.len() < others.len() {
            let middle = threshold / 2.0;
            let parts =
                [Interval::new(f64::NEG_INFINITY, middle), Interval::new(middle, f64::INFINITY)];
            return parts.into_iter().all(|part| {
                halves.push(part);
                let clear = self.clears(operator, threshold, others, halves);
                halves.pop();
                clear
            });
        }
        let mut frame = self.ranges.clone();
        frame.params.extend(operator.samples.iter().map(|sample| {
            let other = others.iter().position(|other| other == sample);
            [other.map_or(Interval::new(threshold, f64::INFINITY), |i| halves[i]); 4]
        }));
        let value = operator.tape.prepare_in(&frame).scalar([Interval::ENTIRE; 3]);
        if operator.query.above {
            value.hi() < operator.limit.lo()
        } else {
            value.lo() > operator.limit.hi()
        }
    }

    /// The box of a formula without samples, by interval exclusion.
    fn searched(&mut self, query: Query) -> Zone {
        let Some(node) = self.flat(query) else { return Zone::everywhere(self.graph).loose() };
        let limit = self.range(query.limit);
        let start = [[f64::NEG_INFINITY, f64::INFINITY]; 3];
        let above = query.above;
        let Some(search) = Search::new(self.graph, node, limit, above, query.dim, self.ranges)
        else {
            return Zone::everywhere(self.graph).loose();
        };
        let found = search.run(start);
        Zone::of_numbers(self.graph, found)
    }

    /// The query's formula over the outermost point. Nothing is known about the points around it.
    fn flat(&mut self, query: Query) -> Option<NodeId> {
        if query.level == 0 {
            return Some(query.node);
        }
        let points = self.points(query.level, query.dim);
        self.memo.expander.node(self.graph, query.node, &points).ok()
    }

    /// The points of levels up to this one: unknown ones, and the outermost point last.
    fn points(&mut self, level: u16, dim: crate::node::Dim) -> Vec<NodeId> {
        // An interval of NaN is everything. Either dimension reads as many lanes as it has.
        let unknown = self.graph.constant(Type::Vec3, &[f64::NAN; 3]);
        let own = self.graph.point(0, dim);
        let mut points = vec![unknown; usize::from(level)];
        points.push(own);
        points
    }

    /// Where a shape's field is not above the limit, found by search within a box that contains
    /// these points.
    pub(super) fn searched_within(&mut self, id: ShapeId, start: Region, limit: NodeId) -> Region {
        let (level, dim) = (self.graph.shape(id).level, self.graph.shape(id).dim);
        let points = self.points(level, dim);
        let (own, outer) = (points[usize::from(level)], &points[..usize::from(level)]);
        let Ok(field) = self.memo.expander.field_under(self.graph, id, outer, own) else {
            return start;
        };
        let limit = self.range(limit);
        match Search::new(self.graph, field, limit, false, dim, self.ranges) {
            Some(search) => search.run(start),
            None => start,
        }
    }
}
