//! The loop `iterate`: unrolled if it is short, a loop of the graph if it is long.
//!
//! In materials, short loops with large bodies stay loops, too.
//!
//! A loop of the graph needs a body that is the same in each iteration. The body is elaborated once
//! over variables. If that fails, because it needs constants or builds shapes that differ between
//! iterations, the loop is unrolled. A loop that does not depend on a point is unrolled too: it is
//! computed at compile time or per frame.

use sdfc_diagnostics::{Code as ErrorCode, Diagnostic, Span};
use sdfc_graph::{Const, Loop, LoopVar, MAX_LOOP_DEPTH, Node, NodeId, Stage, Table, reachable};

use super::elaborator::{Elaborator, Env, Outcome, Poison, Within};
use super::limits::{MAX_ITERATIONS, MAX_NESTED_ITERATIONS};
use super::report::show_number;
use super::value::{Closure, Value, node_type};
use crate::hir::{Expr, Type};

/// The largest number of iterations that are unrolled; a driver would unroll them anyway.
const UNROLLED: usize = 16;
/// The same for loops with a condition: a loop can end early, unrolled iterations are all computed.
const UNROLLED_WHILE: usize = 4;
/// The largest number of operations, in all iterations, of a loop that is unrolled in a material.
/// Formulas have no such limit, because a loop has no Lipschitz constant.
const UNROLLED_OPERATIONS: usize = 200;

/// The iterations of a loop.
struct Iterations<'p> {
    items: Vec<Value<'p>>,
    /// The count, if it is not constant: later iterations keep the state.
    limit: Option<NodeId>,
    /// For a count or range, the item of the first iteration.
    first: Option<f64>,
}

/// The functions of a loop.
struct Steps<'p> {
    step: std::rc::Rc<Closure<'p>>,
    with_item: bool,
    condition: Option<std::rc::Rc<Closure<'p>>>,
    span: Span,
}

impl<'p> Elaborator<'p> {
    /// `iterate(over, start, step, while)`: an iteration runs if `while` was true before it and
    /// before all earlier ones.
    pub(super) fn iterate(
        &mut self,
        env: &mut Env<'p>,
        args: &'p [Expr],
        span: Span,
    ) -> Outcome<Value<'p>> {
        let [over, start, step, rest @ ..] = args else {
            return Err(Poison);
        };
        let iterations = self.iterations(env, over)?;
        let state = self.eval(env, start)?;
        let with_item = matches!(&step.ty, Type::Fn(takes, _) if takes.len() == 2);
        let step = self.function(env, step)?;
        let condition = rest.first().map(|expr| self.function(env, expr)).transpose()?;
        let most = if condition.is_some() { UNROLLED_WHILE } else { UNROLLED };
        let steps = Steps { step, with_item, condition, span };
        let is_long = iterations.items.len() > most;
        let least = if is_long { 0 } else { UNROLLED_OPERATIONS };
        if (is_long || self.within == Within::Material && iterations.items.len() > 1)
            && let Some(end) = self.as_graph_loop(&iterations, &state, &steps, least)?
        {
            return Ok(end);
        }
        self.unrolled(iterations, state, &steps)
    }

    /// The state after all iterations, each elaborated separately.
    fn unrolled(
        &mut self,
        iterations: Iterations<'p>,
        mut state: Value<'p>,
        steps: &Steps<'p>,
    ) -> Outcome<Value<'p>> {
        // The condition that the loop is still running; `None` if it certainly is.
        let mut running: Option<NodeId> = None;
        for (index, item) in iterations.items.into_iter().enumerate() {
            if let Some(holds) = self.condition(steps, state.clone())? {
                self.must_stay_constant(holds);
                running = Some(self.both(running, holds));
            }
            let mut active = running;
            if let Some(limit) = iterations.limit {
                let index = self.graph.number(index as f64);
                let within = self.graph.lt(index, limit);
                active = Some(self.both(active, within));
            }
            if active.and_then(|node| self.as_bool(node)) == Some(false) {
                break;
            }
            let next = self.next(steps, state.clone(), item)?;
            state = match active.filter(|&node| self.as_bool(node).is_none()) {
                Some(active) => self.select(active, &next, &state, steps.span)?,
                None => next,
            };
        }
        Ok(state)
    }

    /// The condition for another iteration; `None` without a `while`.
    fn condition(&mut self, steps: &Steps<'p>, state: Value<'p>) -> Outcome<Option<NodeId>> {
        let Some(condition) = &steps.condition else { return Ok(None) };
        match self.apply(condition, vec![state], steps.span)? {
            Value::Node(holds) => Ok(Some(holds)),
            other => Err(self.unexpected(steps.span, "a condition", &other)),
        }
    }

    fn next(&mut self, steps: &Steps<'p>, state: Value<'p>, item: Value<'p>) -> Outcome<Value<'p>> {
        let args = if steps.with_item { vec![state, item] } else { vec![state] };
        self.apply(&steps.step, args, steps.span)
    }

    /// The state after a loop of the graph; `None` if the loop must be unrolled, or if all its
    /// iterations have at most `least` operations.
    fn as_graph_loop(
        &mut self,
        iterations: &Iterations<'p>,
        start: &Value<'p>,
        steps: &Steps<'p>,
        least: usize,
    ) -> Outcome<Option<Value<'p>>> {
        let depth = self.loop_depth;
        let Some(init) = parts(start).filter(|_| depth < MAX_LOOP_DEPTH) else { return Ok(None) };
        let Some(item) = self.item(iterations) else { return Ok(None) };
        let around = self.loop_iterations;
        let nested = around.saturating_mul(iterations.items.len());
        if depth > 0 && nested > MAX_NESTED_ITERATIONS {
            let message = format!(
                "these nested loops have {nested} iterations; the limit is {MAX_NESTED_ITERATIONS}"
            );
            return Err(self.stop(Diagnostic::error(ErrorCode::ITERATIONS, steps.span, message)));
        }
        let before = self.attempt();
        self.loop_depth += 1;
        self.loop_iterations = nested;
        let variables = (0..)
            .zip(&init)
            .map(|(at, &part)| self.graph.variable(depth, LoopVar::State(at), self.graph.ty(part)));
        let state = with_parts(start, &mut variables.collect::<Vec<_>>().into_iter());
        let body = self.condition(steps, state.clone()).and_then(|condition| {
            let next = self.next(steps, state, Value::Node(item))?;
            Ok((condition, parts(&next)))
        });
        self.loop_depth -= 1;
        self.loop_iterations = around;
        let types = |parts: &[NodeId]| -> Vec<_> {
            parts.iter().map(|&part| self.graph.ty(part)).collect()
        };
        let (condition, step) = match body {
            Ok((condition, Some(next))) if types(&next) == types(&init) => (condition, next),
            // A limit that was exceeded would be exceeded again.
            Err(poison) if self.stopped => return Err(poison),
            Ok(_) | Err(_) => {
                self.take_back(before);
                return Ok(None);
            }
        };
        let mut roots = step.clone();
        roots.extend(condition);
        let bit = 1 << depth;
        let differs = |&id: &NodeId| {
            let is_built_here = match self.graph.node(id) {
                Node::Sample(shape, _) => {
                    self.graph.loops_around(self.graph.shape(shape).formula) != 0
                }
                node => matches!(node, Node::MaterialAt(..)),
            };
            is_built_here && self.graph.loops_around(id) & bit != 0
        };
        let nesting = roots.iter().map(|&root| self.graph.loop_nesting(root)).max();
        let is_deep = nesting.is_some_and(|nesting| nesting > MAX_LOOP_DEPTH);
        let nodes = reachable(&self.graph, &roots);
        let is_outside = |&&id: &&NodeId| self.graph.loops_around(id) & bit == 0;
        let operations = nodes.len() - nodes.iter().filter(is_outside).count();
        let mut read = nodes.iter().filter(is_outside).chain(&init);
        let at_points = read.any(|&id| self.graph.stage(id) == Stage::Point);
        let is_small = operations.saturating_mul(iterations.items.len()) <= least;
        if nodes.iter().any(differs) || is_deep || !at_points || is_small {
            self.take_back(before);
            return Ok(None);
        }
        if let Some(limit) = iterations.limit {
            self.must_stay_constant(limit);
        }
        let (max_iterations, count) = (iterations.items.len() as u32, iterations.limit);
        let graph_loop = Loop { depth, max_iterations, count, condition, init, step, skip: None };
        let mut end = self.graph.add_loop(graph_loop).into_iter();
        Ok(Some(with_parts(start, &mut end)))
    }

    /// The item of an iteration: its index, or an element of a list of constants.
    fn item(&mut self, iterations: &Iterations<'p>) -> Option<NodeId> {
        let index = self.graph.variable(self.loop_depth, LoopVar::Index, sdfc_graph::Type::Scalar);
        if let Some(first) = iterations.first {
            let first = self.graph.number(first);
            return Some(self.graph.add(index, first));
        }
        let table = self.table(&iterations.items)?;
        Some(self.graph.element(table, index))
    }

    /// A list of constants of one type.
    pub(super) fn table(&mut self, items: &[Value<'p>]) -> Option<Table> {
        let mut elements: Vec<Const> = Vec::with_capacity(items.len());
        for item in items {
            let Value::Node(node) = item else { return None };
            // A live literal is not a constant, so it must stay a literal.
            self.must_stay_constant(*node);
            elements.push(self.graph.as_const(*node)?);
        }
        let ty = elements.first()?.ty();
        elements.iter().all(|element| element.ty() == ty).then_some(Table { ty, elements })
    }

    fn both(&mut self, a: Option<NodeId>, b: NodeId) -> NodeId {
        match a {
            Some(a) if self.as_bool(a) != Some(true) => {
                self.graph.binary(sdfc_graph::Binary::And, a, b)
            }
            Some(_) | None => b,
        }
    }

    fn iterations(&mut self, env: &mut Env<'p>, over: &'p Expr) -> Outcome<Iterations<'p>> {
        if node_type(&over.ty).is_none() {
            let items = self.sequence(env, over, "the sequence of `iterate`")?;
            // A list was limited when it was made; a range can be long.
            let is_range = matches!(over.ty, Type::Range(_));
            if is_range {
                self.check_iterations(items.len() as f64, over.span)?;
            }
            let first = items.first().filter(|_| is_range).and_then(|item| match item {
                Value::Node(node) => self.graph.as_number(*node),
                _ => None,
            });
            return Ok(Iterations { items, limit: None, first });
        }
        let count = self.number(env, over)?;
        self.must_stay_constant(count);
        let (cap, limit) = match self.graph.as_number(count) {
            Some(count) => (count, None),
            None => (self.highest(count, over.span)?, Some(count)),
        };
        self.check_iterations(cap, over.span)?;
        let numbers = 0..cap.max(0.0) as u32;
        let items = numbers.map(|i| Value::Node(self.graph.number(f64::from(i)))).collect();
        Ok(Iterations { items, limit, first: Some(0.0) })
    }

    /// The largest value of a per-frame count, from the ranges of its params.
    fn highest(&mut self, count: NodeId, span: Span) -> Outcome<f64> {
        let highest = self.graph.range(count).hi;
        if highest.is_finite() && self.graph.stage(count) == Stage::Frame {
            return Ok(highest.floor());
        }
        let what = "the largest number of iterations of `iterate`";
        Err(self.not_constant(span, what, count))
    }

    fn check_iterations(&mut self, count: f64, span: Span) -> Outcome<()> {
        if count <= MAX_ITERATIONS as f64 {
            return Ok(());
        }
        let message = format!(
            "`iterate` has {} iterations; the limit is {MAX_ITERATIONS}",
            show_number(count)
        );
        Err(self.report(Diagnostic::error(ErrorCode::ITERATIONS, span, message)))
    }

    fn function(&mut self, env: &mut Env<'p>, expr: &'p Expr) -> Outcome<std::rc::Rc<Closure<'p>>> {
        match self.eval(env, expr)? {
            Value::Closure(closure) => Ok(closure),
            other => Err(self.unexpected(expr.span, "a function", &other)),
        }
    }
}

/// The nodes of a state, those of a record in order; `None` if it holds anything else.
fn parts(state: &Value<'_>) -> Option<Vec<NodeId>> {
    match state {
        Value::Node(node) => Some(vec![*node]),
        Value::List(fields) => {
            let parts = fields.iter().map(parts).collect::<Option<Vec<_>>>()?;
            Some(parts.concat())
        }
        _ => None,
    }
}

/// A state like this one with other nodes.
fn with_parts<'p>(state: &Value<'p>, nodes: &mut impl Iterator<Item = NodeId>) -> Value<'p> {
    match state {
        Value::List(fields) => {
            Value::List(fields.iter().map(|field| with_parts(field, nodes)).collect())
        }
        Value::Node(_) => nodes.next().map_or_else(|| state.clone(), Value::Node),
        other => other.clone(),
    }
}
