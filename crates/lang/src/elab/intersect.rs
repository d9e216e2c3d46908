//! Where a ray is inside a solid, as its clause `intersect` states it.

use rustc_hash::FxHashMap;
use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::{Dim, FAR, Graph, NodeId, ShapeId, reachable};

use super::report::Frame;
use super::value::Value;
use super::{Elaborator, Env, Outcome};
use crate::hir::{Intersect, ShapeDefId};

/// Instances of one definition that are asked for their `intersect` at most: among more, marching costs a ray less than
/// meeting each.
const MOST_INSTANCES: usize = 512;

/// Instances of one definition that may be asked where rays meet them; `None` if there are too many.
pub(super) type Waiting<'p> = Option<Vec<Unasked<'p>>>;

/// An instance, with its clause, what that may name and the calls that built it.
pub(super) struct Unasked<'p> {
    shape: ShapeId,
    stated: &'p Intersect,
    env: Env<'p>,
    frames: Vec<Frame<'p>>,
}

impl<'p> Elaborator<'p> {
    /// Lets an instance wait until it is known how many there are. Of a shape that is built in each round of a loop nothing is
    /// asked.
    pub(super) fn may_be_hit(&mut self, id: ShapeDefId, shape: ShapeId, env: Env<'p>) {
        let definition = self.program.shapes.get(id.0 as usize);
        let Some(stated) = definition.and_then(|definition| definition.intersect.as_ref()) else {
            return;
        };
        if self.loop_depth > 0 {
            return;
        }
        let waiting = self.waiting.entry(id).or_insert_with(|| Some(Vec::new()));
        waiting.take_if(|instances| instances.len() == MOST_INSTANCES);
        if let Some(instances) = waiting {
            instances.push(Unasked { shape, stated, env, frames: self.frames.clone() });
        }
    }

    /// Asks all that wait.
    pub(super) fn add_intersections(&mut self) {
        for instance in std::mem::take(&mut self.waiting).into_values().flatten().flatten() {
            let Unasked { shape, stated, mut env, frames } = instance;
            let outer = std::mem::replace(&mut self.frames, frames);
            // What is wrong has been said.
            let level = self.graph.shape(shape).level;
            if let Ok(intervals) = self.intervals(&mut env, stated, level) {
                self.graph.set_intersect(shape, intervals);
            }
            self.frames = outer;
        }
    }

    /// The intervals of a ray whose origin is the point of a level and whose direction is that of the next.
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
        // Both sides of its choices stand in the shader: a literal in a condition may still move.
        let decisive = self.literals.fixed.clone();
        let value = self.eval(env, &stated.value)?;
        self.literals.fixed = decisive;
        match value {
            Value::Node(interval) => Ok(vec![self.interval(interval, span)?]),
            Value::List(intervals) => {
                let ends = intervals.iter().map(|interval| match interval {
                    Value::Node(interval) => self.interval(*interval, span),
                    other => Err(self.unexpected(span, "an interval", other)),
                });
                ends.collect()
            }
            other => Err(self.unexpected(span, "an interval, or a list of such", &other)),
        }
    }

    /// Both ends of an interval, infinite numbers replaced by far ones.
    fn interval(&mut self, interval: NodeId, span: Span) -> Outcome<[NodeId; 2]> {
        let finite = without_infinity(&mut self.graph, interval);
        let ends = [0, 1].map(|lane| self.graph.component(finite, lane));
        let undefined =
            |id: &NodeId| self.graph.as_const(*id).is_some_and(|c| c.lanes()[0].is_nan());
        if ends.iter().any(undefined) {
            let message = "this interval has an end without a value here";
            let help = "the compiler reckons with `inf` and `-inf`, but not with their difference";
            return Err(self.report(Diagnostic::error(Code::NOT_FINITE, span, message).help(help)));
        }
        Ok(ends)
    }
}

/// A node in which no constant is infinite.
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
