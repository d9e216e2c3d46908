//! Loops and lists.

use naga::{
    BinaryOperator, Expression, MathFunction, ScalarKind, Statement, SwizzleComponent,
    UnaryOperator, VectorSize,
};
use sdfc_graph::{LoopId, LoopVar, Node, NodeId, SkipCondition, TableId, Type};

use super::body::{Body, Value};
use super::iteration::Iteration;
use super::lowering::{Branches, Lowering, POINT, hint};
use super::types;
use crate::error::Error;

/// The largest number of iterations that drivers may know. Fewer take them little time, and a
/// hidden limit takes a register.
const MAX_KNOWN: u32 = 8;

/// The listed iterations of a loop: the index of the first one's number, and the end index.
struct Listed {
    first: Value,
    end: Value,
}

impl Lowering<'_> {
    /// An element of the state after a loop. The loop is written where the first element is needed.
    pub(super) fn after_loop(&mut self, id: LoopId, position: u16) -> Result<Value, Error> {
        if !self.loops.contains_key(&id) {
            let results = self.repeat(id)?;
            self.loops.insert(id, results);
        }
        Ok(self.loops[&id][usize::from(position)])
    }

    /// The value of a loop variable in the current iteration.
    pub(super) fn variable(
        &self,
        id: NodeId,
        depth: u8,
        variable: LoopVar,
    ) -> Result<Value, Error> {
        let iteration = self.iterations.get(usize::from(depth)).and_then(Option::as_ref);
        let iteration = iteration.ok_or(Error::NotFlat(id))?;
        match variable {
            LoopVar::Index => Ok(iteration.number),
            LoopVar::State(position) => {
                iteration.state.get(usize::from(position)).copied().ok_or(Error::NotFlat(id))
            }
        }
    }

    /// Writes a loop. Its state is in variables, which each iteration reads first and sets last.
    fn repeat(&mut self, id: LoopId) -> Result<Vec<Value>, Error> {
        let graph = &self.program.graph;
        let (looped, body) = (graph.loop_at(id).clone(), graph.loop_body(id));
        let listed = self.listed(looped.skip);
        let (first, limit, ty, name) = match &listed {
            Some(listed) => {
                (listed.first, listed.end, types::words(self.types, Type::Scalar), "at")
            }
            None => {
                let limit = self.limit(looped.max_iterations, looped.count)?;
                (self.body.literal(0.0), limit, types::value(self.types, Type::Scalar), "i")
            }
        };
        let counter = self.body.variable("iteration", ty);
        self.body.store(counter, first);
        let state = self.state(&looped.init)?;

        self.body.open_block();
        let matrices = self.matrices.clone();
        let counted = self.body.load(counter, name);
        let past = self.body.binary(BinaryOperator::GreaterEqual, counted, limit);
        self.body.break_if(past);
        let is_listed = listed.is_some();
        let listed = listed.and_then(|_| self.listed_iteration(counted));
        let number = listed.map_or(counted, |(number, _)| number);
        let listed = listed.map(|(_, word)| (word, looped.max_iterations));
        let read = state.iter().map(|&(variable, name)| self.body.load(variable, name)).collect();
        let depth = usize::from(looped.depth);
        self.iterations.resize_with(self.iterations.len().max(depth + 1), || None);
        self.iterations[depth] = Some(Iteration { number, listed, state: read });
        // The rest of the iteration may read what is computed for the condition, so no branch does.
        let needed = self.needed(&body.condition);
        self.visit_with(&Branches::default(), looped.condition.as_slice(), &needed)?;
        if let Some(condition) = looped.condition {
            let condition = self.value(condition)?;
            let not = Expression::Unary { op: UnaryOperator::LogicalNot, expr: condition };
            let ends = self.body.compute(not, &[condition]);
            self.body.break_if(ends);
        }
        let needed = self.needed(&body.step);
        self.visit(&looped.step, &needed)?;
        let next = looped.step.iter().map(|&part| self.value(part));
        let next: Vec<Value> = next.collect::<Result<_, _>>()?;
        for (&(variable, _), next) in state.iter().zip(next) {
            self.body.store(variable, next);
        }
        let one = if is_listed { self.body.word(1) } else { self.body.literal(1.0) };
        let following = self.body.binary(BinaryOperator::Add, counted, one);
        self.body.store(counter, following);
        self.body.close_loop();

        self.iterations[depth] = None;
        self.matrices = matrices;
        self.forget(body.condition.iter().chain(&body.step));
        Ok(state.into_iter().map(|(variable, name)| self.body.load(variable, name)).collect())
    }

    /// The distance, or the lower bound on what the lists leave out if that is smaller.
    pub(super) fn with_inactive_distance(&mut self, distance: Value) -> Value {
        let at = self.inputs.active_lists.as_ref().and_then(|lists| lists.by_point);
        let Some((_, free)) = at.filter(|_| self.uses_lists) else { return distance };
        let pointer = self.body.declare(Expression::GlobalVariable(free));
        let free = self.body.load(pointer, "free");
        self.body.call2(MathFunction::Min, distance, free)
    }

    /// Where the active iterations are listed, if they are. Lists depend on the point, so a
    /// function of a ray or of a segment, whose first argument is its start, runs all iterations.
    fn listed(&mut self, skip: Option<SkipCondition>) -> Option<Listed> {
        let is_of_a_point = self.arguments.first() == Some(&POINT);
        let lists = self.inputs.active_lists.as_ref().filter(|_| is_of_a_point)?;
        let (spans, number, listed) = (lists.spans, lists.index_of(skip)?, lists.counter);
        let is_first = !self.uses_lists;
        self.uses_lists = true;
        if let Some((function, _)) = lists.by_point.filter(|_| is_first) {
            let point = self.body.declare(Expression::FunctionArgument(self.first_point));
            let (arguments, result) = (vec![point], None);
            self.body.push(Statement::Call { function, arguments, result });
        }
        let base = self.body.declare(Expression::GlobalVariable(spans));
        let element = Expression::AccessIndex { base, index: number };
        let pointer = self.body.compute(element, &[base]);
        let span = self.body.load(pointer, "span");
        let part = |body: &mut Body, index| {
            body.compute(Expression::AccessIndex { base: span, index }, &[span])
        };
        let (count, first) = (part(&mut self.body, 0), part(&mut self.body, 1));
        if let Some(listed) = listed {
            let pointer = self.body.declare(Expression::GlobalVariable(listed));
            let before = self.body.load(pointer, "before");
            let after = self.body.binary(BinaryOperator::Add, before, count);
            self.body.store(pointer, after);
        }
        let end = self.body.binary(BinaryOperator::Add, first, count);
        self.body.name(end, "end");
        Some(Listed { first, end })
    }

    /// Reads the iteration's number at an index of the list, as a float and as a word.
    fn listed_iteration(&mut self, index: Value) -> Option<(Value, Value)> {
        let base =
            self.body.declare(Expression::GlobalVariable(self.inputs.active_lists.as_ref()?.lists));
        let pointer = self.body.compute(Expression::Access { base, index }, &[base, index]);
        let word = self.body.load(pointer, "listed");
        let iteration = self.body.cast(word, ScalarKind::Float, Some(4));
        self.body.name(iteration, "iteration");
        Some((iteration, word))
    }

    /// Variables that hold the initial state, and names for the values read from them.
    fn state(&mut self, start: &[NodeId]) -> Result<Vec<(Value, &'static str)>, Error> {
        let mut state = Vec::with_capacity(start.len());
        for &part in start {
            let ty = self.program.graph.ty(part);
            let ty_handle = types::value(self.types, ty);
            let variable = self.body.variable("state", ty_handle);
            let start = self.value(part)?;
            self.body.store(variable, start);
            state.push((variable, hint(ty)));
        }
        Ok(state)
    }

    /// Forgets the values that were computed in a loop's body, which are out of scope after it.
    pub(super) fn forget<'b>(&mut self, nodes: impl Iterator<Item = &'b NodeId>) {
        for id in nodes {
            self.values.remove(*id);
            self.words.remove(id);
            if let Node::Loop(within, ..) = self.program.graph.node(*id) {
                self.loops.remove(&within);
            }
        }
    }

    fn needed(&self, nodes: &[NodeId]) -> Vec<NodeId> {
        nodes.iter().copied().filter(|&id| self.uses.contains(id)).collect()
    }

    /// The number of iterations, at most `cap`.
    fn limit(&mut self, cap: u32, count: Option<NodeId>) -> Result<Value, Error> {
        let hidden = self.inputs.loop_limit.filter(|_| cap > MAX_KNOWN);
        let cap = self.body.literal(cap as f32);
        let count = match (count, hidden) {
            (Some(count), _) => self.value(count)?,
            (None, Some(unreached)) => {
                let pointer = self.body.declare(Expression::GlobalVariable(unreached));
                self.body.load(pointer, "unreached")
            }
            (None, None) => return Ok(cap),
        };
        let limit = self.body.call2(MathFunction::Min, count, cap);
        self.body.name(limit, "iterations");
        Ok(limit)
    }

    /// An element of a list.
    pub(super) fn element(&mut self, id: TableId, at: NodeId, ty: Type) -> Result<Value, Error> {
        let list = self.inputs.tables.get(id).ok_or(Error::NotFlat(at))?;
        let mut index = match self.word_of_iteration(at, list.last) {
            Some(word) => word,
            None => {
                let at = self.value(at)?;
                let (zero, last) = (self.body.literal(0.0), self.body.literal(list.last as f32));
                let raised = self.body.call2(MathFunction::Max, at, zero);
                let clamped = self.body.call2(MathFunction::Min, raised, last);
                self.body.cast(clamped, ScalarKind::Uint, Some(4))
            }
        };
        if let Some(first @ 1..) = list.first {
            let first = self.body.word(first);
            index = self.body.binary(BinaryOperator::Add, first, index);
        }
        let base = self.body.declare(Expression::GlobalVariable(list.variable));
        let pointer = self.body.compute(Expression::Access { base, index }, &[base, index]);
        let value = self.body.load(pointer, hint(ty));
        Ok(if list.first.is_some() { self.narrowed(value, ty) } else { value })
    }

    /// The current iteration's number as a word, if the node is that number and it is at most
    /// `last`.
    fn word_of_iteration(&self, at: NodeId, last: u32) -> Option<Value> {
        let Node::Variable(depth, LoopVar::Index, _) = self.program.graph.node(at) else {
            return None;
        };
        let iteration = self.iterations.get(usize::from(depth))?.as_ref()?;
        iteration.listed.filter(|&(_, cap)| cap <= last + 1).map(|(word, _)| word)
    }

    /// The first of four lanes, as a value of a type.
    fn narrowed(&mut self, vector: Value, ty: Type) -> Value {
        let pattern = SwizzleComponent::XYZW;
        let cut = |size| Expression::Swizzle { size, vector, pattern };
        let first = Expression::AccessIndex { base: vector, index: 0 };
        match ty {
            Type::Bool => {
                let number = self.body.compute(first, &[vector]);
                let zero = self.body.literal(0.0);
                self.body.binary(BinaryOperator::NotEqual, number, zero)
            }
            Type::Scalar => self.body.compute(first, &[vector]),
            Type::Vec2 => self.body.compute(cut(VectorSize::Bi), &[vector]),
            Type::Vec3 => self.body.compute(cut(VectorSize::Tri), &[vector]),
            Type::Vec4 => vector,
        }
    }
}
