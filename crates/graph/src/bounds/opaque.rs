//! Formulas without a rule: operators by their samples, leaves by search.

use super::Deriver;
use super::level_set::Question;
use super::search::{Region, Search};
use super::zone::Zone;
use crate::eval::{Interval, Tape};
use crate::{Node, NodeId, Shape, ShapeId, Type, reachable_where};

/// An operator of more samples is not asked about each of them.
const MOST_SINGLE: usize = 4;

/// How far above the limit a sample may have to be: from `2^-12` to `2^40`, found to `2^-10` of that.
const SMALLEST_MARGIN: i32 = -12;
const LARGEST_MARGIN: i32 = 40;
const REFINEMENTS: usize = 10;

/// An operator's formula as a function of what it samples.
struct Operator {
    tape: Tape,
    samples: Vec<NodeId>,
    question: Question,
    limit: Interval,
}

impl Deriver<'_> {
    /// The zone of a formula that no rule fits.
    pub(super) fn opaque(&mut self, question: Question) -> Zone {
        let samples = self.samples(question.node);
        if samples.is_empty() {
            return self.searched(question);
        }
        match self.operator(question, samples) {
            Some(operator) => self.by_samples(&operator).loose(),
            None => Zone::everywhere(self.graph).loose(),
        }
    }

    /// The distance which all that a shape samples must exceed for the shape to be positive.
    pub(super) fn reach(&mut self, shape: ShapeId) -> Option<f64> {
        let limit = self.graph.number(0.0);
        let Shape { formula: node, level, dim, .. } = *self.graph.shape(shape);
        let question = Question { node, limit, level, dim, above: false };
        let samples = Some(self.samples(node)).filter(|samples| !samples.is_empty())?;
        self.threshold(&self.operator(question, samples)?, |_| true)
    }

    fn samples(&self, formula: NodeId) -> Vec<NodeId> {
        let graph = &*self.graph;
        let is_sample = |id: NodeId| matches!(graph.node(id), Node::Sample(..));
        let order = reachable_where(graph, &[formula], |id| !is_sample(id));
        order.into_iter().filter(|&id| is_sample(id)).collect()
    }

    fn operator(&self, question: Question, samples: Vec<NodeId>) -> Option<Operator> {
        let limit = self.range(question.limit);
        let first = self.ranges.params.len() as u32;
        let tape = Tape::of_operator(self.graph, question.node, &samples, first).ok()?;
        Some(Operator { tape, samples, question, limit })
    }

    /// If the formula exceeds the limit wherever some of its samples exceed a threshold, the zone lies
    /// where one of those does not. First each sample alone is tried, as of an intersection, then all.
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
        self.zone(Question { node: sample, limit, above: false, ..operator.question })
    }

    /// The least threshold found above which the chosen samples keep the formula from the limit.
    fn threshold(&self, operator: &Operator, chosen: impl Fn(NodeId) -> bool) -> Option<f64> {
        let base = if operator.question.above { 0.0 } else { operator.limit.hi() };
        if !base.is_finite() {
            return None;
        }
        let others: Vec<NodeId> =
            operator.samples.iter().copied().filter(|&id| !chosen(id)).collect();
        let clears = |threshold: f64| self.clears(operator, threshold, &others, &mut Vec::new());
        if clears(base) {
            return Some(base);
        }
        // What holds above one threshold holds above all higher ones.
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

    /// Whether the formula keeps from the limit while all samples but the others exceed the threshold. What
    /// a blend does often depends on which sample is less, so the others are split below the threshold.
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
        if operator.question.above {
            value.hi() < operator.limit.lo()
        } else {
            value.lo() > operator.limit.hi()
        }
    }

    /// The zone of a formula without samples, by interval exclusion.
    fn searched(&mut self, question: Question) -> Zone {
        let Some(node) = self.flat(question) else { return Zone::everywhere(self.graph).loose() };
        let limit = self.range(question.limit);
        let start = [[f64::NEG_INFINITY, f64::INFINITY]; 3];
        let above = question.above;
        let Some(search) = Search::new(self.graph, node, limit, above, question.dim, self.ranges)
        else {
            return Zone::everywhere(self.graph).loose();
        };
        let found = search.run(start);
        Zone::of_numbers(self.graph, found)
    }

    /// The question's formula in the outermost point. Nothing is known of the points around it.
    fn flat(&mut self, question: Question) -> Option<NodeId> {
        if question.level == 0 {
            return Some(question.node);
        }
        let points = self.points(question.level, question.dim);
        self.memo.expander.node(self.graph, question.node, &points).ok()
    }

    /// The points of levels up to this one: unknown, and the outermost point last.
    fn points(&mut self, level: u16, dim: crate::Dim) -> Vec<NodeId> {
        // An interval of NaN is everything. Either dimension reads as many lanes as it has.
        let unknown = self.graph.constant(Type::Vec3, &[f64::NAN; 3]);
        let own = self.graph.point(0, dim);
        let mut points = vec![unknown; usize::from(level)];
        points.push(own);
        points
    }

    /// A shape's bounds found by search, within a box that holds it.
    pub(super) fn searched_within(&mut self, id: ShapeId, start: Region) -> Region {
        let (level, dim) = (self.graph.shape(id).level, self.graph.shape(id).dim);
        let points = self.points(level, dim);
        let (own, outer) = (points[usize::from(level)], &points[..usize::from(level)]);
        let Ok(field) = self.memo.expander.field_under(self.graph, id, outer, own) else {
            return start;
        };
        let limit = Interval::new(0.0, 0.0);
        match Search::new(self.graph, field, limit, false, dim, self.ranges) {
            Some(search) => search.run(start),
            None => start,
        }
    }
}
