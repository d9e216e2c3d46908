//! Loops and lists: what a shader repeats and looks up instead of writing it out.
//!
//! A loop's body is math over [`Node::Variable`]s, which stand for the round and the parts of the state. The body of a loop
//! that `depth` others are around speaks of variables of that depth; what it does not compute from them, or from those
//! of the loops around it, lies outside it and is computed once. [`Graph::loops`] tells of every node which
//! loops it lies in, so passes that take nodes one by one see no difference, and those that place nodes
//! (tapes, the lowering) ask for [`Graph::body`].

use crate::ids::IdSet;
use crate::{Const, Graph, LoopId, Node, NodeId, Place, Type};

/// Most loops within loops.
pub const MAX_LOOP_DEPTH: u8 = 7;

/// A loop: the state starts as `start`, and each round makes `next` of it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Loop {
    /// How many loops are around it; below [`MAX_LOOP_DEPTH`].
    pub depth: u8,
    /// Most rounds.
    pub cap: u32,
    /// There is a round r only if r is less than this number, which is known per frame.
    pub count: Option<NodeId>,
    /// There is another round only as long as this holds, a truth value over the variables.
    pub go_on: Option<NodeId>,
    /// The parts of the state before the first round.
    pub start: Vec<NodeId>,
    /// The parts after a round, over the variables; types as in `start`.
    pub next: Vec<NodeId>,
    /// When a round may be left out, if that is known.
    pub inert: Option<Inert>,
}

/// A round leaves the whole state as it is wherever `operand` is at least the state's first part, as the round finds it,
/// and `margin` more. Whoever can tell that of a round for a part of space need not run it there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Inert {
    /// A number over the round's variable and what lies outside the loop; it does not depend on the state.
    pub operand: NodeId,
    /// A number of 0 or more, known per frame.
    pub margin: NodeId,
}

impl Loop {
    /// Everything that it mentions: count, condition, start, next, what makes a round inert.
    pub fn arguments(&self) -> impl Iterator<Item = NodeId> {
        (0..).map_while(|position| self.argument(position))
    }

    /// One of them by position.
    pub(crate) fn argument(&self, position: usize) -> Option<NodeId> {
        let head = usize::from(self.count.is_some()) + usize::from(self.go_on.is_some());
        if position < head {
            return if position == 0 { self.count.or(self.go_on) } else { self.go_on };
        }
        let rest = self.start.iter().chain(&self.next).copied();
        let inert = self.inert.into_iter().flat_map(|inert| [inert.operand, inert.margin]);
        rest.chain(inert).nth(position - head)
    }

    /// The same loop over other nodes.
    fn map(&self, mut map: impl FnMut(NodeId) -> NodeId) -> Self {
        Self {
            depth: self.depth,
            cap: self.cap,
            count: self.count.map(&mut map),
            go_on: self.go_on.map(&mut map),
            start: self.start.iter().copied().map(&mut map).collect(),
            next: self.next.iter().copied().map(&mut map).collect(),
            inert: self.inert.map(|Inert { operand, margin }| Inert {
                operand: map(operand),
                margin: map(margin),
            }),
        }
    }

    /// Whether this one carries the state of the other, and more.
    pub(crate) fn extends(&self, other: &Self) -> bool {
        let same = (self.depth, self.cap, self.count, self.go_on, self.inert)
            == (other.depth, other.cap, other.count, other.go_on, other.inert);
        same && self.start.len() > other.start.len()
            && self.start.starts_with(&other.start)
            && self.next.starts_with(&other.next)
    }

    /// The bit of its depth in [`Graph::loops`].
    pub(crate) fn bit(&self) -> u8 {
        1 << self.depth
    }
}

/// A list of constants of one type.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Table {
    /// Type of the elements.
    pub ty: Type,
    /// The elements: at least one.
    pub elements: Vec<Const>,
}

impl Table {
    /// One lane of all elements.
    pub(crate) fn lane(&self, lane: usize) -> Vec<f64> {
        self.elements.iter().map(|element| element.lanes()[lane]).collect()
    }
}

/// The nodes of a loop's body in ascending order, without those of loops within it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoopBody {
    /// What the condition is computed from.
    pub condition: Vec<NodeId>,
    /// What else a round computes.
    pub round: Vec<NodeId>,
}

impl Graph {
    /// A variable of the loop that so many others are around.
    pub fn variable(&mut self, depth: u8, place: Place, ty: Type) -> NodeId {
        self.intern(Node::Variable(depth, place, ty))
    }

    /// The parts of a loop's state after the last round.
    pub fn repeat(&mut self, repeated: Loop) -> Vec<NodeId> {
        let types: Vec<Type> = repeated.start.iter().map(|&id| self.ty(id)).collect();
        let unchanged: Vec<bool> = (0..)
            .zip(repeated.next.iter().zip(&types))
            .map(|(i, (&next, &ty))| {
                self.node(next) == Node::Variable(repeated.depth, Place::State(i), ty)
            })
            .collect();
        if repeated.cap == 0 || unchanged.iter().all(|unchanged| *unchanged) {
            return repeated.start;
        }
        let start = repeated.start.clone();
        let id = self.add_loop(repeated);
        let mut results = Vec::with_capacity(types.len());
        for (position, ty) in (0..).zip(types) {
            results.push(if unchanged[usize::from(position)] {
                start[usize::from(position)]
            } else {
                self.intern(Node::Loop(id, position, ty))
            });
        }
        results
    }

    /// One part of the state after a loop like this one over other nodes.
    pub(crate) fn rebuild_loop(
        &mut self,
        id: LoopId,
        position: u16,
        map: impl FnMut(NodeId) -> NodeId,
    ) -> NodeId {
        let repeated = self.repeated(id).map(map);
        self.repeat(repeated)[usize::from(position)]
    }

    /// The element of a list of constants at a position.
    pub fn element(&mut self, table: Table, at: NodeId) -> NodeId {
        if let Some(at) = self.as_number(at) {
            let last = table.elements.len().saturating_sub(1);
            let element = table.elements[(at.max(0.0) as usize).min(last)];
            return self.constant(element.ty(), &element.lanes());
        }
        let ty = table.ty;
        let id = self.add_table(table);
        self.intern(Node::Element(id, at, ty))
    }

    /// What the value of a node is computed from, in the loops that the node lies in: of a loop what it reads from
    /// outside.
    pub(crate) fn inputs(&self, id: NodeId) -> Vec<NodeId> {
        if let Node::Loop(id, ..) = self.node(id) {
            self.inputs_of_loop(id)
        } else {
            self.arguments(id).collect()
        }
    }

    /// What a loop reads from outside.
    pub fn inputs_of_loop(&self, id: LoopId) -> Vec<NodeId> {
        let repeated = self.repeated(id);
        let bit = repeated.bit();
        let mut inputs: Vec<NodeId> = repeated.count.into_iter().collect();
        inputs.extend(&repeated.start);
        let mut seen = IdSet::default();
        let mut pending: Vec<NodeId> =
            repeated.go_on.into_iter().chain(repeated.next.iter().copied()).collect();
        while let Some(id) = pending.pop() {
            if !seen.insert(id) {
                continue;
            }
            if self.loops(id) & bit == 0 {
                inputs.push(id);
            } else {
                pending.extend(self.inputs(id));
            }
        }
        inputs.sort_unstable();
        inputs.dedup();
        inputs
    }

    /// What each round of a loop computes.
    pub fn body(&self, id: LoopId) -> LoopBody {
        let repeated = self.repeated(id);
        let mut seen = IdSet::default();
        let condition = self.inside(repeated, repeated.go_on.as_slice(), &mut seen);
        let round = self.inside(repeated, &repeated.next, &mut seen);
        LoopBody { condition, round }
    }

    fn inside(&self, repeated: &Loop, roots: &[NodeId], seen: &mut IdSet) -> Vec<NodeId> {
        let bit = repeated.bit();
        let mut found = Vec::new();
        let mut pending = roots.to_vec();
        while let Some(id) = pending.pop() {
            if !seen.insert(id) {
                continue;
            }
            if self.loops(id) & bit != 0 && self.loops(id) < bit << 1 {
                found.push(id);
            }
            // A loop within may read what no other node of this body does.
            pending.extend(self.arguments(id).filter(|&id| self.loops(id) >= bit));
        }
        found.sort_unstable();
        found
    }
}
