//! `iterate`, the one loop: written out where that is short, a loop of the graph where it is long.
//!
//! A loop needs a body that is the same in each round. It is elaborated once over variables; where that
//! fails, because the body builds or samples shapes that differ from round to round or wants constants, the rounds
//! are written out as if nothing had been tried. So are those that no point takes part in: they are computed here.

use sdfc_diagnostics::{Code as ErrorCode, Diagnostic, Span};
use sdfc_graph::{Const, Loop, LoopVar, MAX_LOOP_DEPTH, Node, NodeId, Stage, Table, reachable};

use super::expr::node_type;
use super::report::show_number;
use super::value::{Closure, Value};
use super::{Elaborator, Env, MAX_NESTED_ROUNDS, MAX_ROUNDS, Outcome};
use crate::hir::{Expr, Type};

/// Rounds up to this many are written out: what a driver would do anyway.
const WRITTEN_OUT: usize = 16;
/// As many if any of them may be the last: a loop ends there, what is written out is computed.
const WRITTEN_OUT_WHILE: usize = 4;

/// What the rounds run over.
struct Rounds<'p> {
    items: Vec<Value<'p>>,
    /// The count, where it moves: rounds from it on keep the state.
    limit: Option<NodeId>,
    /// Of a count or range, the number of the first round.
    first: Option<f64>,
}

/// The functions of a loop.
struct Steps<'p> {
    step: std::rc::Rc<Closure<'p>>,
    with_item: bool,
    go_on: Option<std::rc::Rc<Closure<'p>>>,
    span: Span,
}

impl<'p> Elaborator<'p> {
    /// `iterate(over, start, step, while)`: a round runs as long as every `while` before it held.
    pub(super) fn iterate(
        &mut self,
        env: &mut Env<'p>,
        args: &'p [Expr],
        span: Span,
    ) -> Outcome<Value<'p>> {
        let [over, start, step, rest @ ..] = args else {
            return Err(super::Poison);
        };
        let rounds = self.rounds(env, over)?;
        let state = self.eval(env, start)?;
        let with_item = matches!(&step.ty, Type::Fn(takes, _) if takes.len() == 2);
        let step = self.function(env, step)?;
        let go_on = rest.first().map(|expr| self.function(env, expr)).transpose()?;
        let most = if go_on.is_some() { WRITTEN_OUT_WHILE } else { WRITTEN_OUT };
        let steps = Steps { step, with_item, go_on, span };
        if rounds.items.len() > most
            && let Value::Node(start) = state
            && let Some(end) = self.in_a_loop(&rounds, start, &steps)?
        {
            return Ok(Value::Node(end));
        }
        self.written_out(rounds, state, &steps)
    }

    /// The state after all rounds, each elaborated by itself.
    fn written_out(
        &mut self,
        rounds: Rounds<'p>,
        mut state: Value<'p>,
        steps: &Steps<'p>,
    ) -> Outcome<Value<'p>> {
        // Whether the loop is still running, where that is not known to be so.
        let mut running: Option<NodeId> = None;
        for (round, item) in rounds.items.into_iter().enumerate() {
            if let Some(holds) = self.goes_on(steps, state.clone())? {
                self.must_stay_constant(holds);
                running = Some(self.both(running, holds));
            }
            let mut active = running;
            if let Some(limit) = rounds.limit {
                let round = self.graph.number(round as f64);
                let within = self.graph.lt(round, limit);
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

    /// Whether there is another round, as a node; `None` without a `while`.
    fn goes_on(&mut self, steps: &Steps<'p>, state: Value<'p>) -> Outcome<Option<NodeId>> {
        let Some(go_on) = &steps.go_on else { return Ok(None) };
        match self.apply(go_on, vec![state], steps.span)? {
            Value::Node(holds) => Ok(Some(holds)),
            other => Err(self.unexpected(steps.span, "a condition", &other)),
        }
    }

    fn next(&mut self, steps: &Steps<'p>, state: Value<'p>, item: Value<'p>) -> Outcome<Value<'p>> {
        let args = if steps.with_item { vec![state, item] } else { vec![state] };
        self.apply(&steps.step, args, steps.span)
    }

    /// The state after a loop of the graph; `None` where the rounds must be written out.
    fn in_a_loop(
        &mut self,
        rounds: &Rounds<'p>,
        start: NodeId,
        steps: &Steps<'p>,
    ) -> Outcome<Option<NodeId>> {
        let depth = self.loop_depth;
        if depth >= MAX_LOOP_DEPTH {
            return Ok(None);
        }
        let Some(item) = self.item(rounds) else { return Ok(None) };
        let around = self.loop_rounds;
        let nested = around.saturating_mul(rounds.items.len());
        if depth > 0 && nested > MAX_NESTED_ROUNDS {
            let message = format!(
                "the loops around this and it run {nested} rounds; at most {MAX_NESTED_ROUNDS} are possible"
            );
            return Err(self.stop(Diagnostic::error(ErrorCode::ITERATIONS, steps.span, message)));
        }
        let before = self.attempt();
        self.loop_depth += 1;
        self.loop_rounds = nested;
        let ty = self.graph.ty(start);
        let state = self.graph.variable(depth, LoopVar::State(0), ty);
        let body = self.goes_on(steps, Value::Node(state)).and_then(|go_on| {
            let next = self.next(steps, Value::Node(state), Value::Node(item))?;
            Ok((go_on, next))
        });
        self.loop_depth -= 1;
        self.loop_rounds = around;
        let (go_on, next) = match body {
            Ok((go_on, Value::Node(next))) if self.graph.ty(next) == ty => (go_on, next),
            // A limit that was reached would be reached again.
            Err(poison) if self.stopped => return Err(poison),
            Ok(_) | Err(_) => {
                self.take_back(before);
                return Ok(None);
            }
        };
        let mut roots = vec![next];
        roots.extend(go_on);
        let bit = 1 << depth;
        let differs = |&id: &NodeId| {
            let is_shape = matches!(self.graph.node(id), Node::Sample(..) | Node::MaterialAt(..));
            is_shape && self.graph.loops_around(id) & bit != 0
        };
        let nodes = reachable(&self.graph, &roots);
        let outside = nodes.iter().filter(|&&id| self.graph.loops_around(id) & bit == 0);
        let mut read = outside.chain([&start]);
        let at_points = read.any(|&id| self.graph.stage(id) == Stage::Point);
        if nodes.iter().any(differs) || !at_points {
            self.take_back(before);
            return Ok(None);
        }
        if let Some(limit) = rounds.limit {
            self.must_stay_constant(limit);
        }
        let (cap, count) = (rounds.items.len() as u32, rounds.limit);
        let (start, next) = (vec![start], vec![next]);
        let repeated = Loop {
            depth,
            max_iterations: cap,
            count,
            condition: go_on,
            init: start,
            step: next,
            skip: None,
        };
        Ok(self.graph.add_loop(repeated).first().copied())
    }

    /// What a round of a loop is given: its number, or an element of a list of constants.
    fn item(&mut self, rounds: &Rounds<'p>) -> Option<NodeId> {
        let round = self.graph.variable(self.loop_depth, LoopVar::Index, sdfc_graph::Type::Scalar);
        if let Some(first) = rounds.first {
            let first = self.graph.number(first);
            return Some(self.graph.add(round, first));
        }
        let table = self.table(&rounds.items)?;
        Some(self.graph.element(table, round))
    }

    /// A list of constants of one type.
    pub(super) fn table(&mut self, items: &[Value<'p>]) -> Option<Table> {
        let mut elements: Vec<Const> = Vec::with_capacity(items.len());
        for item in items {
            let Value::Node(node) = item else { return None };
            // A literal that moves is none: it is left as it is.
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

    fn rounds(&mut self, env: &mut Env<'p>, over: &'p Expr) -> Outcome<Rounds<'p>> {
        if node_type(&over.ty).is_none() {
            let items = self.sequence(env, over, "what `iterate` runs over")?;
            // The elements of a list were made one by one; a range can be long in few words.
            let is_range = matches!(over.ty, Type::Range(_));
            if is_range {
                self.check_rounds(items.len() as f64, over.span)?;
            }
            let first = items.first().filter(|_| is_range).and_then(|item| match item {
                Value::Node(node) => self.graph.as_number(*node),
                _ => None,
            });
            return Ok(Rounds { items, limit: None, first });
        }
        let count = self.number(env, over)?;
        self.must_stay_constant(count);
        let (cap, limit) = match self.graph.as_number(count) {
            Some(count) => (count, None),
            None => (self.highest(count, over.span)?, Some(count)),
        };
        self.check_rounds(cap, over.span)?;
        let numbers = 0..cap.max(0.0) as u32;
        let items = numbers.map(|i| Value::Node(self.graph.number(f64::from(i)))).collect();
        Ok(Rounds { items, limit, first: Some(0.0) })
    }

    /// The most that a moving count can be, by the ranges of the params in it.
    fn highest(&mut self, count: NodeId, span: Span) -> Outcome<f64> {
        let highest = self.graph.range(count).hi;
        if highest.is_finite() && self.graph.stage(count) == Stage::Frame {
            return Ok(highest.floor());
        }
        let what = "the most rounds that `iterate` may run";
        Err(self.not_constant(span, what, count))
    }

    fn check_rounds(&mut self, count: f64, span: Span) -> Outcome<()> {
        if count <= MAX_ROUNDS as f64 {
            return Ok(());
        }
        let message = format!(
            "`iterate` runs {} rounds; at most {MAX_ROUNDS} are possible",
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
