//! The kernel's operations on numbers, as graph nodes.

use sdfc_diagnostics::{Code as ErrorCode, Span};
use sdfc_graph::eval::{FrameValues, evaluate_frame};
use sdfc_graph::{Binary, NodeId, Shadow, Stage, Ternary, Unary};

use super::elaborator::{Elaborator, Env, Outcome, Poison, Within};
use super::report::show_lanes;
use super::value::{Value, node_type};
use crate::hir::{Expr, Kernel, Type};

/// An operation with its arguments and its span.
#[derive(Clone, Copy)]
pub(super) struct Application<'p> {
    pub op: Kernel,
    pub args: &'p [Expr],
    pub span: Span,
}

/// Says if the arguments are swapped: `a > b` is `b < a`.
#[derive(Clone, Copy)]
enum Swapped {
    No,
    Yes,
}

impl<'p> Elaborator<'p> {
    /// Evaluates an operation.
    pub(super) fn kernel(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        match at.op {
            Kernel::Neg => self.unary(env, at, Unary::Neg),
            Kernel::Not => self.unary(env, at, Unary::Not),
            Kernel::Abs => self.unary(env, at, Unary::Abs),
            Kernel::Sign => self.unary(env, at, Unary::Sign),
            Kernel::Floor => self.unary(env, at, Unary::Floor),
            Kernel::Ceil => self.unary(env, at, Unary::Ceil),
            Kernel::Round => self.unary(env, at, Unary::Round),
            Kernel::Trunc => self.unary(env, at, Unary::Trunc),
            Kernel::Fract => self.unary(env, at, Unary::Fract),
            Kernel::Sqrt => self.unary(env, at, Unary::Sqrt),
            Kernel::InverseSqrt => self.unary(env, at, Unary::InverseSqrt),
            Kernel::Exp => self.unary(env, at, Unary::Exp),
            Kernel::Exp2 => self.unary(env, at, Unary::Exp2),
            Kernel::Log => self.unary(env, at, Unary::Log),
            Kernel::Log2 => self.unary(env, at, Unary::Log2),
            Kernel::Sin => self.unary(env, at, Unary::Sin),
            Kernel::Cos => self.unary(env, at, Unary::Cos),
            Kernel::Tan => self.unary(env, at, Unary::Tan),
            Kernel::Asin => self.unary(env, at, Unary::Asin),
            Kernel::Acos => self.unary(env, at, Unary::Acos),
            Kernel::Atan => self.unary(env, at, Unary::Atan),
            Kernel::Sinh => self.unary(env, at, Unary::Sinh),
            Kernel::Cosh => self.unary(env, at, Unary::Cosh),
            Kernel::Tanh => self.unary(env, at, Unary::Tanh),
            Kernel::Saturate => self.unary(env, at, Unary::Saturate),
            Kernel::Length => self.unary(env, at, Unary::Length),
            Kernel::Normalize => self.unary(env, at, Unary::Normalize),
            Kernel::Add => self.binary(env, at, Binary::Add, Swapped::No),
            Kernel::Sub => self.binary(env, at, Binary::Sub, Swapped::No),
            Kernel::Mul => self.binary(env, at, Binary::Mul, Swapped::No),
            Kernel::Div => self.binary(env, at, Binary::Div, Swapped::No),
            Kernel::Rem => self.binary(env, at, Binary::Rem, Swapped::No),
            Kernel::Lt => self.binary(env, at, Binary::Lt, Swapped::No),
            Kernel::Le => self.binary(env, at, Binary::Le, Swapped::No),
            Kernel::Gt => self.binary(env, at, Binary::Lt, Swapped::Yes),
            Kernel::Ge => self.binary(env, at, Binary::Le, Swapped::Yes),
            Kernel::Pow => self.binary(env, at, Binary::Pow, Swapped::No),
            Kernel::Atan2 => self.binary(env, at, Binary::Atan2, Swapped::No),
            Kernel::Step => self.binary(env, at, Binary::Step, Swapped::No),
            Kernel::Dot => self.binary(env, at, Binary::Dot, Swapped::No),
            Kernel::Cross => self.binary(env, at, Binary::Cross, Swapped::No),
            Kernel::Mix => self.ternary(env, at, Ternary::Mix),
            Kernel::Clamp => self.ternary(env, at, Ternary::Clamp),
            Kernel::Smoothstep => self.ternary(env, at, Ternary::Smoothstep),
            Kernel::Min => self.extreme(env, at, Binary::Min),
            Kernel::Max => self.extreme(env, at, Binary::Max),
            Kernel::Distance => {
                let [a, b] = self.numbers(env, at.args)?;
                let between = self.graph.sub(a, b);
                let distance = self.graph.length(between);
                self.checked(at, &[a, b], distance)
            }
            Kernel::Eq => self.equal(env, at),
            Kernel::Ne => {
                let equal = self.equal(env, at)?;
                let Value::Node(equal) = equal else { return Err(Poison) };
                Ok(Value::Node(self.graph.unary(Unary::Not, equal)))
            }
            Kernel::And => self.logic(env, at, Binary::And),
            Kernel::Or => self.logic(env, at, Binary::Or),
            Kernel::Lift => self.lift(env, at),
            Kernel::Hash => self.hash(env, at),
            Kernel::Hash3 => self.hash3(env, at),
            Kernel::Sum => self.extreme(env, at, Binary::Add),
            Kernel::Len => self.len(env, at),
            Kernel::Str => self.string(env, at),
            Kernel::Iterate => self.iterate(env, at.args, at.span),
            Kernel::Bounds => self.bounds(env, at),
            Kernel::Gradient => self.gradient(env, at),
            Kernel::Material => self.new_material(env, at),
            Kernel::MaterialAt => self.material_at(env, at),
            Kernel::Rgb => self.rgb(env, at),
            Kernel::LinearRgb => self.linear_rgb(env, at),
            Kernel::Hsv => self.hsv(env, at),
            Kernel::Hsl => self.hsl(env, at),
            Kernel::Oklch => self.oklch(env, at),
            Kernel::Hard => Ok(Value::Shadow(Shadow::Hard)),
            Kernel::GlyphCurves => self.glyph_curves(env, at),
            Kernel::PolygonEdges => self.polygon_edges(env, at),
            Kernel::OutlineCells => self.outline_cells(env, at),
            Kernel::Alternative => self.binary(env, at, Binary::Alternative, Swapped::No),
            Kernel::Soft => {
                let [sharpness] = self.numbers(env, at.args)?;
                Ok(Value::Shadow(Shadow::Soft(sharpness)))
            }
        }
    }

    /// Evaluates exactly `N` arguments to nodes and reports the errors of all.
    pub(super) fn numbers<const N: usize>(
        &mut self,
        env: &mut Env<'p>,
        args: &'p [Expr],
    ) -> Outcome<[NodeId; N]> {
        let mut are_known = args.len() == N;
        let nodes = std::array::from_fn(|i| {
            let node = args.get(i).and_then(|arg| self.number(env, arg).ok());
            are_known &= node.is_some();
            node.unwrap_or_else(|| self.graph.number(0.0))
        });
        are_known.then_some(nodes).ok_or(Poison)
    }

    fn unary(&mut self, env: &mut Env<'p>, at: Application<'p>, op: Unary) -> Outcome<Value<'p>> {
        let [a] = self.numbers(env, at.args)?;
        let result = self.graph.unary(op, a);
        self.checked(at, &[a], result)
    }

    fn binary(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
        op: Binary,
        swapped: Swapped,
    ) -> Outcome<Value<'p>> {
        let [a, b] = self.numbers(env, at.args)?;
        if op == Binary::Pow {
            // A power whose exponent is not constant has no value for a negative base.
            self.must_stay_constant(b);
        }
        let result = match swapped {
            Swapped::No => self.graph.binary(op, a, b),
            Swapped::Yes => self.graph.binary(op, b, a),
        };
        self.checked(at, &[a, b], result)
    }

    fn ternary(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
        op: Ternary,
    ) -> Outcome<Value<'p>> {
        let [a, b, c] = self.numbers(env, at.args)?;
        let result = self.graph.ternary(op, a, b, c);
        self.checked(at, &[a, b, c], result)
    }

    /// Reports a result that is not finite. It is allowed if an argument is infinite (`inf + 1`),
    /// since ranges need that, and in clauses, where infinite means unbounded.
    pub(super) fn checked(
        &mut self,
        at: Application<'p>,
        args: &[NodeId],
        result: NodeId,
    ) -> Outcome<Value<'p>> {
        let result = self.settled(result);
        let Some((lanes, width)) = self.as_lanes(result) else { return Ok(Value::Node(result)) };
        let lanes = &lanes[..width];
        let infinite = |node: &NodeId| {
            self.as_lanes(*node).is_some_and(|(lanes, _)| lanes.iter().any(|v| v.is_infinite()))
        };
        let inherited = args.iter().any(infinite) && !lanes.iter().any(|lane| lane.is_nan());
        if inherited || self.within == Within::Clause || lanes.iter().all(|lane| lane.is_finite()) {
            return Ok(Value::Node(result));
        }
        let (name, value) = (name(at.op), show_lanes(lanes));
        let message = format!("the result of `{name}` is {value}, but shaders need finite numbers");
        Err(self.fail(ErrorCode::NOT_FINITE, at.span, message))
    }

    /// Folds a constant node to a literal, also if it is not finite; the graph folds finite results
    /// only. Other nodes do not change.
    pub(super) fn settled(&mut self, node: NodeId) -> NodeId {
        if self.graph.stage(node) != Stage::Const || self.as_lanes(node).is_some() {
            return node;
        }
        let ty = self.graph.ty(node);
        let lanes = evaluate_frame(&self.graph, &[node], &FrameValues::default());
        let lanes = lanes.first().map_or(vec![f64::NAN], |lanes| lanes[..ty.width()].to_vec());
        self.graph.constant(ty, &lanes)
    }

    /// `==` for numbers, bools and strings.
    fn equal(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let values = self.all(env, at.args)?;
        let [a, b] = &values[..] else { return Err(Poison) };
        let equal = match (a, b) {
            (Value::Node(a), Value::Node(b)) => Some(self.graph.binary(Binary::Eq, *a, *b)),
            _ => self.texts_equal(a, b),
        };
        let Some(equal) = equal else {
            return Err(self.unexpected(at.span, "two values that can be compared", a));
        };
        Ok(Value::Node(equal))
    }

    /// `&&` and `||`. The right side is evaluated only if the left one does not decide.
    fn logic(&mut self, env: &mut Env<'p>, at: Application<'p>, op: Binary) -> Outcome<Value<'p>> {
        let [a, b] = at.args else { return Err(Poison) };
        let a = self.number(env, a)?;
        let deciding = op == Binary::Or;
        match self.as_bool(a) {
            Some(value) if value == deciding => Ok(Value::Node(a)),
            Some(_) => Ok(Value::Node(self.number(env, b)?)),
            None => {
                self.must_stay_constant(a);
                self.conditions.push(a);
                let b = self.number(env, b);
                self.conditions.pop();
                let b = b?;
                Ok(Value::Node(self.graph.binary(op, a, b)))
            }
        }
    }

    /// `min`, `max` and `sum` of any number of values, or of a list.
    fn extreme(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
        op: Binary,
    ) -> Outcome<Value<'p>> {
        let mut nodes = Vec::with_capacity(at.args.len());
        for (value, arg) in self.all(env, at.args)?.into_iter().zip(at.args) {
            let items = if let Value::List(items) = value { items } else { [value].into() };
            for item in items.iter() {
                let Value::Node(node) = item else {
                    return Err(self.unexpected(arg.span, "a number", item));
                };
                nodes.push(*node);
            }
        }
        let mut rest = nodes.into_iter();
        let Some(mut result) = rest.next() else {
            if let (Binary::Add, Some(ty)) = (op, at.args.first().and_then(element_type)) {
                return Ok(Value::Node(self.graph.constant(ty, &[0.0; 4])));
            }
            let message = format!("`{}` needs at least one value; this list is empty", name(at.op));
            return Err(self.fail(ErrorCode::DEGENERATE, at.span, message));
        };
        for node in rest {
            self.tick(at.span)?;
            result = self.graph.binary(op, result, node);
        }
        Ok(Value::Node(result))
    }
}

/// The type of the numbers or vectors in a list.
fn element_type(list: &Expr) -> Option<sdfc_graph::Type> {
    match &list.ty {
        Type::List(of) => node_type(of),
        _ => None,
    }
}

/// The name or symbol of an operation in the language.
pub(super) fn name(op: Kernel) -> String {
    let symbols = [
        (Kernel::Neg, "-"),
        (Kernel::Add, "+"),
        (Kernel::Sub, "-"),
        (Kernel::Mul, "*"),
        (Kernel::Div, "/"),
        (Kernel::Rem, "%"),
    ];
    if let Some((_, symbol)) = symbols.iter().find(|(other, _)| *other == op) {
        return (*symbol).to_owned();
    }
    // The variants are named after the functions: `InverseSqrt` for `inverseSqrt`.
    let name = format!("{op:?}");
    let (first, rest) = name.split_at(1);
    format!("{}{rest}", first.to_lowercase())
}
