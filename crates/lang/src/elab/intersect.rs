//! The clause `intersect`: the intervals of a ray that are inside a solid.

use rustc_hash::FxHashMap;
use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::{Dim, FAR, Graph, NodeId, ShapeId, reachable};

use super::elaborator::{Elaborator, Env, Outcome, PendingIntersection};
use super::value::Value;
use crate::hir::{Intersect, ShapeDefId};

/// The largest number of instances of one definition that are intersected analytically. With more,
/// marching costs a ray less than testing each.
const MOST_INSTANCES: usize = 512;

impl<'p> Elaborator<'p> {
    /// Queues an instance until the number of instances is known. A shape that is built in each
    /// iteration of a loop is not intersected analytically.
    pub(super) fn queue_intersection(&mut self, id: ShapeDefId, shape: ShapeId, env: Env<'p>) {
        let definition = self.program.shapes.get(id.0 as usize);
        let Some(stated) = definition.and_then(|definition| definition.intersect.as_ref()) else {
            return;
        };
        if self.loop_depth > 0 {
            return;
        }
        let pending = self.intersections.entry(id).or_insert_with(|| Some(Vec::new()));
        pending.take_if(|instances| instances.len() == MOST_INSTANCES);
        if let Some(instances) = pending {
            instances.push(PendingIntersection { shape, stated, env, frames: self.frames.clone() });
        }
    }

    /// Evaluates the clauses of all queued instances.
    pub(super) fn add_intersections(&mut self) {
        for instance in std::mem::take(&mut self.intersections).into_values().flatten().flatten() {
            let PendingIntersection { shape, stated, mut env, frames } = instance;
            let outer = std::mem::replace(&mut self.frames, frames);
            // Errors have been reported.
            let level = self.graph.shape(shape).level;
            if let Ok(intervals) = self.intervals(&mut env, stated, level) {
                self.graph.set_intersect(shape, intervals);
            }
            self.frames = outer;
        }
    }

    /// The intervals of a ray. Its origin is the point of a level, its direction that of the next.
    fn intervals(
        &mut self,
        env: &mut Env<'p>,
        stated: &'p Intersect,
        level: u16,
    ) -> Outcome<Vec<[NodeId; 2]>> {
        let [origin, direction] =
            [level, level + 1].map(|level| self.graph.point(level, Dim::Three));
        env.set(stated.origin.0 as usize, Value::Node(origin));
        env.set(stated.direction.0 as usize, Value::Node(direction));
        let span = stated.value.span;
        // The shader contains both branches of a condition, so literals in it can stay live.
        let fixed = self.literals.fixed.clone();
        let value = self.eval(env, &stated.value)?;
        self.literals.fixed = fixed;
        match value {
            Value::Node(interval) => Ok(vec![self.interval(interval, span)?]),
            Value::List(intervals) => {
                let ends = intervals.iter().map(|interval| match interval {
                    Value::Node(interval) => self.interval(*interval, span),
                    other => Err(self.unexpected(span, "an interval", other)),
                });
                ends.collect()
            }
            other => Err(self.unexpected(span, "an interval or a list of intervals", &other)),
        }
    }

    /// Both ends of an interval; infinite numbers are replaced by large ones.
    fn interval(&mut self, interval: NodeId, span: Span) -> Outcome<[NodeId; 2]> {
        let finite = without_infinity(&mut self.graph, interval);
        let ends = [0, 1].map(|lane| self.graph.component(finite, lane));
        let undefined =
            |id: &NodeId| self.graph.as_const(*id).is_some_and(|c| c.lanes()[0].is_nan());
        if ends.iter().any(undefined) {
            let message = "this interval has an undefined end";
            let help = "`inf - inf` is undefined";
            return Err(self.report(Diagnostic::error(Code::NOT_FINITE, span, message).help(help)));
        }
        Ok(ends)
    }
}

/// The node with all infinite constants replaced by large ones.
fn without_infinity(graph: &mut Graph, root: NodeId) -> NodeId {
    let order = reachable(graph, &[root]);
    let mut finite: FxHashMap<NodeId, NodeId> = FxHashMap::default();
    for id in order {
        let new = match graph.as_const(id) {
            Some(value) => {
                let lanes = value.lanes().map(|lane| lane.clamp(-FAR, FAR));
                graph.constant(value.ty(), &lanes)
            }
            None => graph.rebuild(id, |old| finite.get(&old).copied().unwrap_or(old)),
        };
        finite.insert(id, new);
    }
    finite.get(&root).copied().unwrap_or(root)
}
