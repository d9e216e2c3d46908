//! Upper bounds of a formula's slope within a box, operation by operation.
//!
//! Intervals of the partial derivatives lose that the derivatives are those of one vector: around
//! the origin they give `length(p)` the slope sqrt(3) or more. Here each node has the norm of its
//! derivative, from the norms of its arguments and the intervals of their values, for example
//! |a b|' <= |a|' |b| + |a| |b|'. The intervals of the derivatives give another bound for each
//! node, and the lesser one counts.

use rustc_hash::FxHashMap;
use sdfc_graph::eval::{Dual, Evaluator, FrameValues, Interval, Number, Tape};
use sdfc_graph::{Graph, NodeId, Range, reachable};

use crate::certify::affine::largest_singular_value;
use crate::certify::box_rules::{Rule, Rules};
use crate::certify::lipschitz::steepest_slope;

/// Formulas of more nodes get no such bounds.
const MAX_NODES: usize = 4096;
/// The cost of one operation on an interval with its derivatives, in operations on intervals.
const DUAL_OPERATION: usize = 8;

type Lanes = [Dual<Interval>; 4];

/// The operations of a formula, ready to be evaluated.
pub(super) struct BoxNorms {
    rules: Vec<Rule>,
    widths: Vec<usize>,
    tape: Tape,
}

impl BoxNorms {
    /// The operations of a flat field over the outermost point; `None` if there are too many.
    pub(super) fn new(graph: &mut Graph, field: NodeId) -> Option<Self> {
        let mut nodes = reachable(graph, &[field]);
        nodes.retain(|&node| graph.loops_around(node) == 0);
        if nodes.len() > MAX_NODES || nodes.last() != Some(&field) {
            return None;
        }
        let tape = Tape::new(graph, &nodes).ok()?;
        let indices: FxHashMap<NodeId, usize> = nodes.iter().copied().zip(0..).collect();
        let mut rules = Rules::new(&nodes, indices);
        let widths = nodes.iter().map(|&node| graph.ty(node).width()).collect();
        let rules = nodes.iter().map(|&node| rules.rule(graph, node)).collect();
        Some(Self { rules, widths, tape })
    }

    /// The cost of one evaluation, in operations on intervals.
    pub(super) fn cost(&self) -> usize {
        self.tape.operations().saturating_add(self.rules.len()).saturating_mul(DUAL_OPERATION)
    }

    /// An evaluator for all values of the params in these ranges.
    pub(super) fn prepare(&self, ranges: &FrameValues<Interval>) -> Evaluator<'_, Dual<Interval>> {
        let flat = |value| Dual { value, ..Dual::constant(0.0) };
        self.tape.prepare_in(&FrameValues {
            params: ranges.params.iter().map(|lanes| lanes.map(flat)).collect(),
            time: flat(ranges.time),
            frame: flat(ranges.frame),
        })
    }

    /// An upper bound of the slope of the field in a box in which it does not jump.
    pub(super) fn slope(
        &self,
        evaluator: &mut Evaluator<'_, Dual<Interval>>,
        at: [Interval; 3],
    ) -> f64 {
        let lanes = evaluator.eval(Dual::point(at));
        let mut known = Known { lanes, widths: &self.widths, norms: Vec::new() };
        for (index, rule) in self.rules.iter().enumerate() {
            let norm = known.by_rule(rule).min(known.by_intervals(index));
            known.norms.push(if norm.is_nan() { f64::INFINITY } else { norm });
        }
        // The factor covers the rounding of sums and products.
        known.norms.last().map_or(f64::INFINITY, |norm| norm * (1.0 + 1e-12))
    }
}

/// The values, derivatives and norms of the nodes in one box.
struct Known<'a> {
    lanes: &'a [Lanes],
    widths: &'a [usize],
    norms: Vec<f64>,
}

impl Known<'_> {
    fn norm(&self, index: usize) -> f64 {
        self.norms[index]
    }

    fn values(&self, index: usize) -> impl Iterator<Item = Interval> {
        self.lanes[index][..self.widths[index]].iter().map(|lane| lane.value)
    }

    /// The largest absolute value of a lane.
    fn largest(&self, index: usize) -> f64 {
        self.values(index).map(Interval::magnitude).fold(0.0, f64::max)
    }

    /// The largest length of the vector.
    fn longest(&self, index: usize) -> f64 {
        self.values(index).map(Interval::magnitude).map(|x| x * x).sum::<f64>().sqrt()
    }

    /// The range of all lanes.
    fn range(&self, index: usize) -> Range {
        let hull = self.values(index).reduce(Interval::hull).unwrap_or(Interval::ENTIRE);
        Range::new(hull.lo(), hull.hi())
    }

    /// A bound from the norms of the arguments; infinite if there is none.
    fn by_rule(&self, rule: &Rule) -> f64 {
        match rule {
            Rule::Constant => 0.0,
            Rule::Point => 1.0,
            Rule::Unknown => f64::INFINITY,
            &Rule::Scaled(factor, a) => factor * self.norm(a),
            &Rule::Lanewise(op, a) => {
                let steepest = steepest_slope(op, self.range(a)).unwrap_or(f64::INFINITY);
                product(steepest, self.norm(a))
            }
            &Rule::Normalize(a) => {
                let nearest = |x: Interval| x.lo().max(-x.hi()).max(0.0);
                let shortest = self.values(a).map(nearest).map(|x| x * x).sum::<f64>().sqrt();
                self.norm(a) / shortest
            }
            Rule::Sum(terms) => self.sum(terms),
            &Rule::Product { a, b, is_disjoint } => {
                let parts = [
                    product(self.norm(a), self.largest(b)),
                    product(self.norm(b), self.largest(a)),
                ];
                if is_disjoint { parts[0].hypot(parts[1]) } else { parts[0] + parts[1] }
            }
            &Rule::Quotient(a, b) => {
                let nearest = self.range(b).nearest_to_zero();
                self.norm(a) / nearest
                    + product(self.largest(a), self.norm(b)) / (nearest * nearest)
            }
            &Rule::Dot(a, b) => {
                product(self.norm(a), self.longest(b)) + product(self.norm(b), self.longest(a))
            }
            &Rule::Mix(a, b, t) => {
                let (from, to, share) = (self.range(a), self.range(b), self.range(t));
                let apart = (to.hi - from.lo).max(from.hi - to.lo);
                let moved = self.norm(a).max(self.norm(b)) + product(apart, self.norm(t));
                if share.is_fraction() { moved } else { f64::INFINITY }
            }
            Rule::Largest(all) => all.iter().map(|&a| self.norm(a)).fold(0.0, f64::max),
            Rule::Hypotenuse(all) => {
                all.iter().map(|&a| self.norm(a)).map(|x| x * x).sum::<f64>().sqrt()
            }
            Rule::Claimed { rule, lipschitz, arguments } => {
                let largest = arguments.iter().map(|&a| self.norm(a)).fold(0.0, f64::max);
                self.by_rule(rule).min(product(*lipschitz, largest))
            }
        }
    }

    /// The slope of a sum of scalars: the sum of the norms of the terms whose intervals say less,
    /// and the length of the sum of the other terms' derivatives.
    fn sum(&self, terms: &[(usize, f64)]) -> f64 {
        let mut norms = 0.0;
        let mut partials = [Interval::constant(0.0); 3];
        for &(term, sign) in terms {
            let own = self.lanes[term][0].partials;
            if self.norm(term) < length(own) * (1.0 - 1e-9) {
                norms += self.norm(term);
            } else {
                let signed = own.map(|partial| partial.mul(Interval::constant(sign)));
                partials = std::array::from_fn(|axis| partials[axis].add(signed[axis]));
            }
        }
        let sum = norms + length(partials);
        sum.min(terms.iter().map(|&(term, _)| self.norm(term)).sum())
    }

    /// A bound of the operator norm of the intervals of the partial derivatives: that of their
    /// middles and that of their radii, or that of their largest absolute values.
    fn by_intervals(&self, index: usize) -> f64 {
        let rows = self.lanes[index].map(|lane| lane.partials);
        let rows = &rows[..self.widths[index]];
        if rows.as_flattened().iter().any(|x| !x.magnitude().is_finite()) {
            return f64::INFINITY;
        }
        if let [row] = rows {
            return length(*row);
        }
        let norm = |of: fn(Interval) -> f64| {
            let rows: Vec<[f64; 3]> = rows.iter().map(|row| row.map(of)).collect();
            largest_singular_value(&rows) * (1.0 + 1e-12)
        };
        let middles = norm(|x| 0.5 * (x.lo() + x.hi()));
        let radii = norm(|x| 0.5 * (x.hi() - x.lo()));
        norm(Interval::magnitude).min((middles + radii) * (1.0 + 1e-12))
    }
}

/// The largest length of a vector in a box.
fn length(partials: [Interval; 3]) -> f64 {
    partials.map(Interval::magnitude).map(|x| x * x).iter().sum::<f64>().sqrt() * (1.0 + 1e-12)
}

/// The product of two bounds. A slope of 0 stays 0 where the other factor is not limited.
fn product(x: f64, y: f64) -> f64 {
    if x == 0.0 || y == 0.0 { 0.0 } else { x * y }
}
