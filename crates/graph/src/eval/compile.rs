//! From nodes to a tape.

use rustc_hash::FxHashMap;

use super::record::Recorder;
use super::scalarise::{Lanes, scalarise};
use super::tape::{Tape, TapeError};
use crate::formulas::{FormulaChoice, reachable_by};
use crate::graph::Graph;
use crate::ids::IdSet;
use crate::node::{Binary, LoopId, LoopVar, Node, NodeId};
use crate::walk::visited;

impl Tape {
    /// The tape that computes the roots, in their order.
    ///
    /// Fails if a root depends on anything but operations, per-frame inputs and the outermost
    /// point.
    pub fn new(graph: &Graph, roots: &[NodeId]) -> Result<Self, TapeError> {
        Self::record(graph, Recorder::default(), &evaluated(graph, roots), roots)
    }

    /// The tape that computes functions of a ray: the outermost point is its origin, the point of
    /// level 1 its direction.
    ///
    /// Fails if a root depends on anything but operations, per-frame inputs and these points.
    pub fn for_rays(graph: &Graph, roots: &[NodeId]) -> Result<Self, TapeError> {
        Self::record(graph, Recorder::of_levels(2), &evaluated(graph, roots), roots)
    }

    /// The tape that computes functions of a surface: the outermost point is that of the surface,
    /// the point of level 1 its normal, that of level 2 the direction to the eye.
    ///
    /// Fails if a root depends on anything but operations, per-frame inputs and these points.
    pub fn for_surfaces(graph: &Graph, roots: &[NodeId]) -> Result<Self, TapeError> {
        Self::record(graph, Recorder::of_levels(3), &evaluated(graph, roots), roots)
    }

    /// The tape of an operator as a function of its samples, independent of the point.
    ///
    /// The samples are read as params; `first` is the index of the first of them. Points are NaN,
    /// which intervals take for any number.
    ///
    /// Never fails in practice: every input has a meaning here.
    pub fn for_operator(
        graph: &Graph,
        root: NodeId,
        samples: &[NodeId],
        first: u32,
    ) -> Result<Self, TapeError> {
        let params = samples.iter().zip(first..).map(|(&id, param)| (graph.node(id), param));
        let recorder = Recorder::for_operator(params.collect());
        let inputs: IdSet = samples.iter().copied().collect();
        let order = visited(&[root], |id, pending| {
            if !inputs.contains(id) {
                pending.extend(graph.evaluated_arguments(id));
            }
        });
        Self::record(graph, recorder, &order, &[root])
    }

    fn record(
        graph: &Graph,
        mut recorder: Recorder,
        order: &[NodeId],
        roots: &[NodeId],
    ) -> Result<Self, TapeError> {
        let outside = order.iter().copied().filter(|&id| graph.loops_around(id) == 0);
        let mut recording = Recording::new(graph, &mut recorder);
        recording.nodes(outside)?;
        let outputs = roots.iter().map(|root| recording.lanes[root]).collect();
        Ok(recorder.finish(outputs))
    }
}

fn evaluated(graph: &Graph, roots: &[NodeId]) -> Vec<NodeId> {
    reachable_by(graph, roots, FormulaChoice::Bounded)
}

/// Nodes that are being recorded.
struct Recording<'a> {
    graph: &'a Graph,
    recorder: &'a mut Recorder,
    lanes: FxHashMap<NodeId, Lanes<u32>>,
    /// The final states of the loops recorded so far.
    loops: FxHashMap<LoopId, Vec<Lanes<u32>>>,
}

impl<'a> Recording<'a> {
    fn new(graph: &'a Graph, recorder: &'a mut Recorder) -> Self {
        Self { graph, recorder, lanes: FxHashMap::default(), loops: FxHashMap::default() }
    }

    fn nodes(&mut self, order: impl Iterator<Item = NodeId>) -> Result<(), TapeError> {
        for id in order {
            let node = self.graph.node(id);
            let value = match node {
                Node::Loop(loop_, position, _) => {
                    self.record_loop(loop_)?;
                    self.loops[&loop_][usize::from(position)]
                }
                Node::Element(table, at, ty) => {
                    let (at, table) = (self.lanes[&at].get(0), self.graph.table(table));
                    Lanes::new(ty.width(), |lane| self.recorder.lookup(table.lane(lane), at))
                }
                Node::Binary(Binary::Alternative, _, bounded) => self.lanes[&bounded],
                Node::Variable(..) => continue, // defined when its loop was entered
                Node::Const(_)
                | Node::Point(..)
                | Node::Frame(..)
                | Node::Unary(..)
                | Node::Binary(..)
                | Node::Ternary(..)
                | Node::Splat(..)
                | Node::Compose(..)
                | Node::Swizzle(..)
                | Node::Transform(..)
                | Node::Sample(..)
                | Node::MaterialAt(..) => {
                    let lanes = &self.lanes;
                    scalarise(self.recorder, &node, |argument| lanes[&argument])
                        .ok_or_else(|| unavailable(id, &node))?
                }
            };
            self.lanes.insert(id, value);
        }
        Ok(())
    }

    /// Records a loop, unless it was recorded before. Loops nest at most
    /// [`MAX_LOOP_DEPTH`](crate::MAX_LOOP_DEPTH) deep.
    fn record_loop(&mut self, id: LoopId) -> Result<(), TapeError> {
        if self.loops.contains_key(&id) {
            return Ok(());
        }
        let (loop_, body) = (self.graph.loop_at(id), self.graph.loop_body(id));
        let inits: Vec<Lanes<u32>> = loop_.init.iter().map(|id| self.lanes[id]).collect();
        let count = loop_.count.map(|count| self.lanes[&count].get(0));
        let entered = self.recorder.enter(loop_.max_iterations, count, &inits);
        for &id in body.condition.iter().chain(&body.step) {
            if let Node::Variable(_, var, _) = self.graph.node(id) {
                self.lanes.insert(
                    id,
                    match var {
                        LoopVar::Index => Lanes::scalar(entered.index),
                        LoopVar::State(position) => entered.state[usize::from(position)],
                    },
                );
            }
        }
        self.nodes(body.condition.iter().copied())?;
        if let Some(condition) = loop_.condition {
            self.recorder.test(entered.id, self.lanes[&condition].get(0));
        }
        self.nodes(body.step.iter().copied())?;
        let step: Vec<Lanes<u32>> = loop_.step.iter().map(|id| self.lanes[id]).collect();
        self.recorder.leave(entered.id, &step);
        // Another loop of this depth may share the body's nodes, but not their values.
        let inside = body.condition.iter().chain(&body.step);
        for id in inside {
            self.lanes.remove(id);
            if let Node::Loop(nested, ..) = self.graph.node(*id) {
                self.loops.remove(&nested);
            }
        }
        self.loops.insert(id, entered.results);
        Ok(())
    }
}

fn unavailable(id: NodeId, node: &Node) -> TapeError {
    if matches!(node, Node::Point(..)) {
        TapeError::InnerPoint(id)
    } else {
        TapeError::Unexpanded(id)
    }
}
