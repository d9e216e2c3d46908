//! Function calls: arguments, defaults, ranges, requirements and recursion.

use sdfc_diagnostics::{Code as ErrorCode, Diagnostic, Span};
use sdfc_graph::{LipschitzClaim, NodeId, Stage};

use super::elaborator::{CallFrame, Elaborator, Env, Outcome, Poison, Within};
use super::limits::MAX_RECURSION;
use super::output::Claimed;
use super::report::{show_lanes, show_number};
use super::value::{Closure, Code, Value};
use crate::hir::{Expr, FnId, Lambda, Parameter, Require};

/// The value and span of an argument; `None` for a default.
pub(super) type Given<'p> = Option<(Value<'p>, Span)>;

impl<'p> Elaborator<'p> {
    /// Elaborates a call of a declared function.
    pub(super) fn call(
        &mut self,
        env: &mut Env<'p>,
        id: FnId,
        args: &'p [Option<Expr>],
        span: Span,
    ) -> Outcome<Value<'p>> {
        let given = self.given(env, args)?;
        self.call_function(id, given, span)
    }

    /// Evaluates the arguments of a call.
    pub(super) fn given(
        &mut self,
        env: &mut Env<'p>,
        args: &'p [Option<Expr>],
    ) -> Outcome<Vec<Given<'p>>> {
        let mut evaluate = |arg: &'p Option<Expr>| {
            let given = arg.as_ref().map(|expr| Ok((self.eval(env, expr)?, expr.span)));
            given.transpose()
        };
        let values: Vec<Outcome<Given<'p>>> = args.iter().map(&mut evaluate).collect();
        values.into_iter().collect()
    }

    fn call_function(&mut self, id: FnId, given: Vec<Given<'p>>, span: Span) -> Outcome<Value<'p>> {
        let program = self.program;
        let index = id.0 as usize;
        let function = program.functions.get(index).ok_or(Poison)?;
        if self.active[index] >= MAX_RECURSION {
            return Err(self.too_deep(&function.name, &given, span));
        }
        self.active[index] += 1;
        self.frames.push(CallFrame { name: &function.name, span });
        let mut env = Env::new(function.locals);
        let result = self
            .bind(&mut env, &function.parameters, given, span)
            .and_then(|()| self.requirements(&mut env, &function.requires))
            .and_then(|()| {
                let arguments = env.locals[..function.parameters.len()].to_vec();
                let value = self.eval(&mut env, &function.body)?;
                self.claim(&mut env, function.lipschitz.as_ref(), arguments, &value)?;
                Ok(value)
            });
        self.frames.pop();
        self.active[index] -= 1;
        result
    }

    fn too_deep(&mut self, name: &str, given: &[Given<'p>], span: Span) -> Poison {
        let args: Vec<String> =
            given.iter().flatten().map(|(value, _)| self.show_value(value)).collect();
        let message =
            format!("more than {MAX_RECURSION} levels of recursion: {name}({})", args.join(", "));
        let help = "end the recursion with an `if` whose condition is known at compile time";
        self.stop(Diagnostic::error(ErrorCode::RECURSION, span, message).help(help))
    }

    fn show_value(&self, value: &Value<'p>) -> String {
        let lanes = if let Value::Node(node) = value { self.as_lanes(*node) } else { None };
        lanes.map_or("…".to_owned(), |(lanes, width)| show_lanes(&lanes[..width]))
    }

    /// Calls a function value.
    pub(super) fn apply(
        &mut self,
        closure: &Closure<'p>,
        args: Vec<Value<'p>>,
        span: Span,
    ) -> Outcome<Value<'p>> {
        self.tick(span)?;
        match closure.code {
            Code::Constant => closure.captures.first().cloned().ok_or(Poison),
            Code::Function(id) => {
                let given = args.into_iter().map(|value| Some((value, span))).collect();
                self.call_function(id, given, span)
            }
            Code::Lambda(lambda) => self.apply_lambda(lambda, closure, args, span),
        }
    }

    fn apply_lambda(
        &mut self,
        lambda: &'p Lambda,
        closure: &Closure<'p>,
        args: Vec<Value<'p>>,
        span: Span,
    ) -> Outcome<Value<'p>> {
        let mut env = Env::new(lambda.locals);
        for (local, value) in closure.captures.iter().cloned().chain(args).enumerate() {
            env.set(local, value);
        }
        let varying = env.locals[..lambda.captures.len() + lambda.parameters.len()].to_vec();
        self.frames.push(CallFrame { name: "this function", span });
        let result = self
            .requirements(&mut env, &lambda.requires)
            .and_then(|()| self.eval(&mut env, &lambda.body))
            .and_then(|value| {
                self.claim(&mut env, lambda.lipschitz.as_ref(), varying, &value)?;
                Ok(value)
            });
        self.frames.pop();
        result
    }

    /// Records a stated Lipschitz constant with the result of the call. The clause is about numbers
    /// and vectors, so it is ignored if a shape or function among the arguments and captures
    /// depends on the point.
    fn claim(
        &mut self,
        env: &mut Env<'p>,
        stated: Option<&'p Expr>,
        arguments: Vec<Option<Value<'p>>>,
        value: &Value<'p>,
    ) -> Outcome<()> {
        let (Some(stated), Value::Node(value)) = (stated, value) else { return Ok(()) };
        let mut varying = Vec::with_capacity(arguments.len());
        for argument in arguments.into_iter().flatten() {
            match argument {
                Value::Node(node) if self.graph.stage(node) < Stage::Point => {}
                Value::Node(node) => varying.push(node),
                other if other.moves(&self.graph) => return Ok(()),
                _ => {}
            }
        }
        let outer = std::mem::replace(&mut self.within, Within::Clause);
        let constant = self.stated_constant(env, stated);
        self.within = outer;
        let constant = constant?;
        let known = match self.graph.stage(constant) {
            Stage::Const => self.graph.as_number(constant).is_some_and(f64::is_finite),
            Stage::Frame => true,
            Stage::Point => false,
        };
        if known && self.graph.stage(*value) == Stage::Point && !varying.contains(value) {
            let claim = LipschitzClaim { arguments: varying, lipschitz: constant };
            if !self.program.library.contains(&stated.span.file) {
                let claimed = Claimed { span: stated.span, value: *value, claim: claim.clone() };
                self.claims.push(claimed);
            }
            self.graph.claim_lipschitz(*value, claim);
        }
        Ok(())
    }

    /// Binds each parameter to its argument or default and checks its range. Reports all errors.
    pub(super) fn bind(
        &mut self,
        env: &mut Env<'p>,
        parameters: &'p [Parameter],
        given: Vec<Given<'p>>,
        call: Span,
    ) -> Outcome<()> {
        let mut outcome = Ok(());
        let mut given = given.into_iter();
        for (local, parameter) in parameters.iter().enumerate() {
            let bound = match (given.next().flatten(), &parameter.default) {
                (Some((value, span)), _) => Ok((value, span)),
                (None, Some(default)) => self.eval(env, default).map(|value| (value, call)),
                // The checker has reported a missing argument.
                (None, None) => Err(Poison),
            };
            let bound = bound.and_then(|(value, span)| {
                env.set(local, value.clone());
                self.check_range(env, parameter, &value, span)
            });
            outcome = outcome.and(bound);
        }
        outcome
    }

    fn check_range(
        &mut self,
        env: &mut Env<'p>,
        parameter: &'p Parameter,
        value: &Value<'p>,
        span: Span,
    ) -> Outcome<()> {
        let (Some(range), Value::Node(value)) = (&parameter.range, value) else {
            return Ok(());
        };
        let Value::Range(lo, hi) = self.eval(env, range)? else {
            return Ok(());
        };
        self.lies_within(*value, [lo, hi]);
        let (above, below) = (self.not_above(lo, *value), self.not_above(*value, hi));
        for holds in above.into_iter().chain(below) {
            if let Some(found) = self.refute(holds) {
                return Err(self.out_of_range(parameter, *value, [lo, hi], &found, span));
            }
        }
        Ok(())
    }

    /// The conditions `a <= b`, one for each component.
    fn not_above(&mut self, a: NodeId, b: NodeId) -> Vec<NodeId> {
        let width = self.graph.ty(a).width().max(self.graph.ty(b).width()) as u8;
        let compare = |lane| {
            let (a, b) = (self.graph.component(a, lane), self.graph.component(b, lane));
            self.graph.le(a, b)
        };
        (0..width).map(compare).collect()
    }

    fn out_of_range(
        &mut self,
        parameter: &Parameter,
        value: NodeId,
        range: [NodeId; 2],
        found: &super::probe::Refutation,
        span: Span,
    ) -> Poison {
        let show = |node| self.value_at(node, found).map_or("…".to_owned(), |v| show_lanes(&v));
        // A range whose ends are numbers was widened to the vector's type.
        let end = |node| match self.value_at(node, found).as_deref() {
            Some([first, rest @ ..]) if rest.iter().all(|lane| lane == first) => {
                show_number(*first)
            }
            Some(lanes) => show_lanes(lanes),
            None => "…".to_owned(),
        };
        let (value, lo, hi) = (show(value), end(range[0]), end(range[1]));
        let name = &parameter.name;
        let message = if found.causes.is_empty() {
            format!("argument `{name}` is {value}, outside its range {lo}..{hi}")
        } else {
            format!("argument `{name}` can be {value}, outside its range {lo}..{hi}")
        };
        let mut error = Diagnostic::error(ErrorCode::OUT_OF_RANGE, span, message);
        error = found.causes.iter().fold(error, Diagnostic::note);
        if !found.causes.is_empty() {
            error = error.help("give the param a range that fits, or `clamp` the value");
        }
        self.report(error.note_at(parameter.span, "the range is declared here"))
    }

    /// Checks requirements and reports the first that is false.
    pub(super) fn requirements(
        &mut self,
        env: &mut Env<'p>,
        requires: &'p [Require],
    ) -> Outcome<()> {
        for require in requires {
            let (condition, bounds) = self.with_bounds(|it| it.number(env, &require.condition))?;
            self.constrains(condition);
            let Some(found) = self.refute(condition) else {
                continue;
            };
            let at = self.frames.last().map_or(require.span, |frame| frame.span);
            let mut error = Diagnostic::error(ErrorCode::REQUIREMENT, at, &require.message);
            error = found.causes.iter().fold(error, Diagnostic::note);
            if let Some(bounds) = bounds {
                error = error.note(self.show_bounds(bounds, &found));
            }
            return Err(self.report(error.note_at(require.span, "required here")));
        }
        Ok(())
    }

    /// A note with the bounds that a requirement is about.
    fn show_bounds(&self, bounds: [NodeId; 2], found: &super::probe::Refutation) -> String {
        let [lo, hi] = bounds.map(|end| self.value_at(end, found).unwrap_or_default());
        let is_known = |end: &[f64]| !end.is_empty() && end.iter().all(|lane| lane.is_finite());
        let shown = format!("{} .. {}", show_lanes(&lo), show_lanes(&hi));
        if is_known(&lo) && is_known(&hi) {
            format!("its bounds are {shown}")
        } else {
            format!("its bounds are not known on all sides: {shown}; state them with `bounds`")
        }
    }

    /// A counterexample to a condition: it is false always, or for some values of the params.
    /// Conditions that depend on the point are not tested.
    pub(super) fn refute(&self, holds: NodeId) -> Option<super::probe::Refutation> {
        match self.graph.stage(holds) {
            Stage::Const | Stage::Frame => self.probe(holds),
            Stage::Point => None,
        }
    }
}
