//! Lists, comprehensions, indices, slices and conditions.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::{Arg, Binary, Contract, MaterialRule, NodeId, Shape, ShapeId};

use super::elaborator::{Elaborator, Env, Outcome, Poison};
use super::limits::MAX_NODES;
use super::report::show_number;
use super::value::Value;
use crate::hir::{Comprehension, Element, Expr};

/// The largest list whose elements are selected by comparisons; larger ones become tables.
const SELECTED: usize = 4;

impl<'p> Elaborator<'p> {
    /// Evaluates the elements of a list; comprehensions are unrolled.
    pub(super) fn elements(
        &mut self,
        env: &mut Env<'p>,
        elements: &'p [Element],
    ) -> Outcome<Vec<Value<'p>>> {
        let mut values = Vec::with_capacity(elements.len());
        let outcomes: Vec<_> =
            elements.iter().map(|element| self.element(env, element, &mut values)).collect();
        outcomes.into_iter().collect::<Outcome<()>>()?;
        Ok(values)
    }

    fn element(
        &mut self,
        env: &mut Env<'p>,
        element: &'p Element,
        out: &mut Vec<Value<'p>>,
    ) -> Outcome<()> {
        match element {
            Element::One(expr) => out.push(self.eval(env, expr)?),
            Element::Spread(expr) => match self.eval(env, expr)? {
                Value::List(items) => out.extend(items.iter().cloned()),
                other => return Err(self.unexpected(expr.span, "a list", &other)),
            },
            Element::For(comprehension) => self.comprehension(env, comprehension, out)?,
        }
        Ok(())
    }

    fn comprehension(
        &mut self,
        env: &mut Env<'p>,
        comprehension: &'p Comprehension,
        out: &mut Vec<Value<'p>>,
    ) -> Outcome<()> {
        let Comprehension { local, over, condition, body, .. } = comprehension;
        for item in self.sequence(env, over, "the sequence of `for`")? {
            self.tick(comprehension.span)?;
            env.set(local.0 as usize, item);
            if let Some(condition) = condition {
                let keep = self.number(env, condition)?;
                match self.as_bool(keep) {
                    Some(true) => {}
                    Some(false) => continue,
                    None => {
                        let what = "the condition of `for`";
                        return Err(self.not_constant(condition.span, what, keep));
                    }
                }
            }
            self.element(env, body, out)?;
        }
        Ok(())
    }

    /// Evaluates a sequence: a list, a vector or a half-open range.
    pub(super) fn sequence(
        &mut self,
        env: &mut Env<'p>,
        over: &'p Expr,
        what: &str,
    ) -> Outcome<Vec<Value<'p>>> {
        match self.eval(env, over)? {
            Value::List(items) => Ok(items.to_vec()),
            Value::Range(lo, hi) => {
                let (lo, hi) = (self.whole(lo, over.span, what)?, self.whole(hi, over.span, what)?);
                self.count((hi - lo).max(0.0), over.span)?;
                let numbers = lo as i64..hi as i64;
                Ok(numbers.map(|i| Value::Node(self.graph.number(i as f64))).collect())
            }
            Value::Node(vector) => {
                let lanes = 0..self.graph.ty(vector).width() as u8;
                Ok(lanes.map(|lane| Value::Node(self.graph.component(vector, lane))).collect())
            }
            other => Err(self.unexpected(over.span, "a list, range or vector", &other)),
        }
    }

    /// Reports a sequence that alone exceeds the limit of graph nodes.
    fn count(&mut self, count: f64, span: Span) -> Outcome<()> {
        if count <= MAX_NODES as f64 {
            return Ok(());
        }
        let message =
            format!("this sequence has {} values; the limit is {MAX_NODES}", show_number(count));
        Err(self.stop(Diagnostic::error(Code::TOO_MANY_NODES, span, message)))
    }

    /// A number that must be constant and whole.
    pub(super) fn whole(&mut self, node: NodeId, span: Span, what: &str) -> Outcome<f64> {
        let Some(value) = self.graph.as_number(node) else {
            return Err(self.not_constant(span, what, node));
        };
        if value.fract() == 0.0 && value.abs() <= 2f64.powi(53) {
            return Ok(value);
        }
        let message = format!("{what} needs whole numbers; this is {}", show_number(value));
        let help = "round it with `floor`, `round` or `ceil`";
        Err(self.report(Diagnostic::error(Code::DEGENERATE, span, message).help(help)))
    }

    /// `list[i]`, `vector[i]`.
    pub(super) fn index(
        &mut self,
        env: &mut Env<'p>,
        base: &'p Expr,
        index: &'p Expr,
    ) -> Outcome<Value<'p>> {
        let (items, at) = (self.sequence(env, base, "a list"), self.number(env, index));
        let (items, at) = (items?, at?);
        if self.as_lanes(at).is_none() {
            self.must_stay_constant(at);
            return self.select_index(&items, at, index.span);
        }
        let position = self.whole(at, index.span, "an index")?;
        let found = (position >= 0.0).then(|| items.get(position as usize)).flatten();
        found.cloned().ok_or_else(|| self.no_such_index(position, items.len(), index.span))
    }

    fn no_such_index(&mut self, position: f64, length: usize, span: Span) -> Poison {
        let message = if length == 0 {
            "this list is empty and cannot be indexed".to_owned()
        } else {
            let last = length - 1;
            format!(
                "index {} is outside 0 to {last}: the list has {length} elements",
                show_number(position)
            )
        };
        self.fail(Code::DEGENERATE, span, message)
    }

    /// Selects an element by an index that is not constant. The elements must be numbers. An index
    /// below 0 gives the first element, one past the end the last.
    fn select_index(&mut self, items: &[Value<'p>], at: NodeId, span: Span) -> Outcome<Value<'p>> {
        let mut nodes = Vec::with_capacity(items.len());
        for item in items {
            let Value::Node(node) = item else {
                return Err(self.not_constant(
                    span,
                    "an index of a list of shapes or functions",
                    at,
                ));
            };
            nodes.push(*node);
        }
        if items.len() > SELECTED
            && let Some(table) = self.table(items)
        {
            return Ok(Value::Node(self.graph.element(table, at)));
        }
        let Some(mut result) = nodes.pop() else {
            return Err(self.no_such_index(0.0, 0, span));
        };
        for (position, &node) in nodes.iter().enumerate().rev() {
            self.tick(span)?;
            let next = self.graph.number(position as f64 + 1.0);
            let before = self.graph.lt(at, next);
            result = self.graph.select(before, node, result);
        }
        Ok(Value::Node(result))
    }

    /// `list[a..b]`.
    pub(super) fn slice(
        &mut self,
        env: &mut Env<'p>,
        base: &'p Expr,
        range: &'p Expr,
    ) -> Outcome<Value<'p>> {
        let (items, ends) = (self.sequence(env, base, "a list"), self.eval(env, range));
        let (items, ends) = (items?, ends?);
        let Value::Range(lo, hi) = ends else {
            return Err(self.unexpected(range.span, "a range", &ends));
        };
        let lo = self.whole(lo, range.span, "a slice")?;
        let hi = self.whole(hi, range.span, "a slice")?;
        let within = lo >= 0.0 && lo <= hi && hi <= items.len() as f64;
        // Copying counts as work: repeated slices take quadratic time.
        self.steps += items.len() as u64;
        if let Some(part) = within.then(|| items.get(lo as usize..hi as usize)).flatten() {
            return Ok(Value::List(part.into()));
        }
        let message =
            format!("slice {}..{} is outside 0..{}", show_number(lo), show_number(hi), items.len());
        Err(self.fail(Code::DEGENERATE, range.span, message))
    }

    /// `if`: one branch if the condition is constant, otherwise a selection of both.
    pub(super) fn branch(
        &mut self,
        env: &mut Env<'p>,
        condition: &'p Expr,
        yes: &'p Expr,
        no: &'p Expr,
        span: Span,
    ) -> Outcome<Value<'p>> {
        let chosen = self.number(env, condition)?;
        match self.as_bool(chosen) {
            Some(true) => self.eval(env, yes),
            Some(false) => self.eval(env, no),
            None => {
                self.must_stay_constant(chosen);
                self.conditions.push(chosen);
                let (yes, no) = (self.eval(env, yes), self.eval(env, no));
                self.conditions.pop();
                self.select(chosen, &yes?, &no?, span)
            }
        }
    }

    /// Selects `yes` if the condition is true, otherwise `no`, for every type that allows it.
    pub(super) fn select(
        &mut self,
        condition: NodeId,
        yes: &Value<'p>,
        no: &Value<'p>,
        span: Span,
    ) -> Outcome<Value<'p>> {
        match (yes, no) {
            (Value::Node(yes), Value::Node(no)) => {
                Ok(Value::Node(self.graph.select(condition, *yes, *no)))
            }
            (Value::Material(yes), Value::Material(no)) => {
                let mut fields = *yes;
                for (field, &other) in fields.iter_mut().zip(no) {
                    *field = self.graph.select(condition, *field, other);
                }
                Ok(Value::Material(fields))
            }
            (Value::Range(lo, hi), Value::Range(other_lo, other_hi)) => {
                let lo = self.graph.select(condition, *lo, *other_lo);
                Ok(Value::Range(lo, self.graph.select(condition, *hi, *other_hi)))
            }
            (Value::List(yes), Value::List(no)) if yes.len() == no.len() => {
                let pairs = yes.iter().zip(no.iter());
                let items = pairs.map(|(yes, no)| self.select(condition, yes, no, span));
                Ok(Value::List(items.collect::<Outcome<_>>()?))
            }
            (Value::Shape(yes), Value::Shape(no)) => self.select_shape(condition, *yes, *no, span),
            _ => Err(self.not_constant(
                span,
                "a condition that selects functions, strings or lists of different lengths",
                condition,
            )),
        }
    }

    /// A shape that is one of two shapes by a condition.
    fn select_shape(
        &mut self,
        condition: NodeId,
        yes: ShapeId,
        no: ShapeId,
        span: Span,
    ) -> Outcome<Value<'p>> {
        let args = vec![Arg::Node(condition), Arg::Shape(yes), Arg::Shape(no)];
        let dim = self.graph.shape(yes).dim;
        let of = |shape| self.graph.shape(shape).level;
        let level = self.graph.levels(condition).max(of(yes)).max(of(no));
        let point = self.graph.point(level, dim);
        let (yes, no) = (self.graph.sample(yes, point), self.graph.sample(no, point));
        let formula = self.graph.select(condition, yes, no);
        let shape = Shape {
            definition: "if".to_owned(),
            dim,
            level,
            args,
            formula,
            contract: Contract::default(),
            intersect: Vec::new(),
            material: MaterialRule::Weighted(formula),
            children: Vec::new(),
            depth: 1,
            name: None,
        };
        self.add_shape(shape, span)
    }

    /// Compares two strings, or a string with a string param.
    pub(super) fn texts_equal(&mut self, a: &Value<'p>, b: &Value<'p>) -> Option<NodeId> {
        match (a, b) {
            (Value::Text(a), Value::Text(b)) => Some(self.graph.boolean(a == b)),
            (Value::Choice(node, param), Value::Text(text))
            | (Value::Text(text), Value::Choice(node, param)) => {
                let choices = &self.params.get(*param)?.choices;
                match choices.iter().position(|choice| choice.as_str() == &**text) {
                    Some(index) => {
                        let index = self.graph.number(index as f64);
                        Some(self.graph.binary(Binary::Eq, *node, index))
                    }
                    None => Some(self.graph.boolean(false)),
                }
            }
            (Value::Choice(a, first), Value::Choice(b, second)) => {
                (first == second).then(|| self.graph.binary(Binary::Eq, *a, *b))
            }
            _ => None,
        }
    }
}
