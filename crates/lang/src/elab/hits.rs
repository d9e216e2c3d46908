//! Where a ray is inside a solid, as its clause `hits` states it.

use rustc_hash::FxHashMap;
use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::{Dim, FAR, Graph, MOST_HITS, NodeId, reachable};

use super::value::Value;
use super::{Elaborator, Env, Outcome};
use crate::hir::ShapeDef;

impl<'p> Elaborator<'p> {
    /// The intervals of a ray whose origin is the point of the level and whose direction is that of the next. Of a
    /// shape that is built anew at each point nothing is asked, nor of more than [`MOST_HITS`].
    pub(super) fn hits(
        &mut self,
        env: &mut Env<'p>,
        definition: &'p ShapeDef,
        level: u16,
    ) -> Outcome<Vec<[NodeId; 2]>> {
        let is_asked = level == 0 && self.hits_asked < MOST_HITS;
        let Some(stated) = definition.hits.as_ref().filter(|_| is_asked) else {
            return Ok(Vec::new());
        };
        self.hits_asked += 1;
        let [origin, direction] = [level, level + 1].map(|l| self.graph.point(l, Dim::Three));
        env.set(stated.origin.0 as usize, Value::Node(origin));
        env.set(stated.direction.0 as usize, Value::Node(direction));
        let span = stated.value.span;
        // Both sides of its choices stand in the shader: a literal in a condition may still move.
        let decisive = self.offer.decisive.clone();
        let value = self.eval(env, &stated.value)?;
        self.offer.decisive = decisive;
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
    let is_finite = |id: &NodeId| {
        graph.as_const(*id).is_none_or(|value| value.lanes().iter().all(|lane| lane.abs() <= FAR))
    };
    if order.iter().all(is_finite) {
        return root;
    }
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
