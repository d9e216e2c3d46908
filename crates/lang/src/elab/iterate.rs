//! `iterate`, the one loop: unrolled.

use sdfc_diagnostics::{Code as ErrorCode, Diagnostic, Span};
use sdfc_graph::{NodeId, Stage};

use super::expr::node_type;
use super::report::show_number;
use super::value::{Closure, Value};
use super::{Elaborator, Env, MAX_ROUNDS, Outcome};
use crate::hir::{Expr, Type};

/// What the rounds run over.
struct Rounds<'p> {
    items: Vec<Value<'p>>,
    /// The count, where it moves: rounds from it on keep the state.
    limit: Option<NodeId>,
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
        let mut state = self.eval(env, start)?;
        let with_item = matches!(&step.ty, Type::Fn(takes, _) if takes.len() == 2);
        let step = self.function(env, step)?;
        let go_on = rest.first().map(|expr| self.function(env, expr)).transpose()?;
        // Whether the loop is still running, where that is not known to be so.
        let mut running: Option<NodeId> = None;
        for (round, item) in rounds.items.into_iter().enumerate() {
            if let Some(go_on) = &go_on {
                let holds = self.apply(go_on, vec![state.clone()], span)?;
                let Value::Node(holds) = holds else {
                    return Err(self.unexpected(span, "a condition", &holds));
                };
                self.decides(holds);
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
            let args = if with_item { vec![state.clone(), item] } else { vec![state.clone()] };
            let next = self.apply(&step, args, span)?;
            state = match active.filter(|&node| self.as_bool(node).is_none()) {
                Some(active) => self.select(active, &next, &state, span)?,
                None => next,
            };
        }
        Ok(state)
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
            if matches!(over.ty, Type::Range(_)) {
                self.check_rounds(items.len() as f64, over.span)?;
            }
            return Ok(Rounds { items, limit: None });
        }
        let count = self.number(env, over)?;
        self.decides(count);
        let (cap, limit) = match self.graph.as_number(count) {
            Some(count) => (count, None),
            None => (self.highest(count, over.span)?, Some(count)),
        };
        self.check_rounds(cap, over.span)?;
        let numbers = 0..cap.max(0.0) as u32;
        let items = numbers.map(|i| Value::Node(self.graph.number(f64::from(i)))).collect();
        Ok(Rounds { items, limit })
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
