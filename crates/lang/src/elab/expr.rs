//! Evaluates expressions to values.

use std::rc::Rc;

use sdfc_diagnostics::{Code as ErrorCode, Span};
use sdfc_graph::{Expander, FrameInput, Node, NodeId, ShapeId, Stage, Type};

use super::elaborator::{Elaborator, Env, Outcome, Poison, Within};
use super::kernel::Application;
use super::value::{Closure, Code, Value, highest, node_type};
use crate::hir::{Expr, ExprKind, GlobalId, MaterialField};

/// Bytes of stack below which a new segment is allocated, and its size in bytes. Scenes may chain
/// thousands of operators.
const RED_ZONE: usize = 128 * 1024;
const STACK_SEGMENT: usize = 2 * 1024 * 1024;

/// Lower bound of a coverage that is divided by.
const LEAST_COVERAGE: f64 = 1e-6;

impl<'p> Elaborator<'p> {
    /// The value of an expression.
    pub(super) fn eval(&mut self, env: &mut Env<'p>, expr: &'p Expr) -> Outcome<Value<'p>> {
        self.tick(expr.span)?;
        stacker::maybe_grow(RED_ZONE, STACK_SEGMENT, || self.eval_kind(env, expr))
    }

    fn eval_kind(&mut self, env: &mut Env<'p>, expr: &'p Expr) -> Outcome<Value<'p>> {
        let span = expr.span;
        match &expr.kind {
            ExprKind::Number(value) => Ok(Value::Node(self.graph.number(*value))),
            ExprKind::Color(lanes) => Ok(Value::Node(self.graph.constant(Type::Vec4, lanes))),
            ExprKind::Text(text) => Ok(Value::Text(text.as_str().into())),
            ExprKind::Bool(value) => Ok(Value::Node(self.graph.boolean(*value))),
            ExprKind::Local(local) => env.get(*local),
            ExprKind::Param(id) => self.param_value(id.0 as usize),
            ExprKind::Global(id) => self.global(*id),
            ExprKind::Time => Ok(self.frame_value(FrameInput::Time)),
            ExprKind::SurfaceVector(vector) => {
                self.has_surface_vectors = true;
                Ok(Value::Node(self.graph.surface_vector(*vector)))
            }
            ExprKind::Frame => Ok(self.frame_value(FrameInput::Frame)),
            ExprKind::List(elements) => Ok(Value::List(self.elements(env, elements)?.into())),
            ExprKind::Record(fields) => Ok(Value::List(self.all(env, fields)?.into())),
            ExprKind::Field(record, at) => self.field(env, record, *at),
            ExprKind::Range(lo, hi) => {
                let (lo, hi) = (self.number(env, lo), self.number(env, hi));
                Ok(Value::Range(lo?, hi?))
            }
            ExprKind::Vector(parts) => self.vector(env, parts),
            ExprKind::Swizzle(base, lanes) => {
                let base = self.number(env, base)?;
                Ok(Value::Node(self.graph.swizzle(base, lanes)))
            }
            ExprKind::RangeEnd(range, low) => match self.eval(env, range)? {
                Value::Range(lo, hi) => Ok(Value::Node(if *low { lo } else { hi })),
                other => Err(self.unexpected(span, "a range", &other)),
            },
            ExprKind::Index(base, index) => self.index(env, base, index),
            ExprKind::Slice(base, range) => self.slice(env, base, range),
            ExprKind::Block(lets, result) => {
                for (local, _, value) in lets {
                    // A poisoned variable silences its uses; the rest may still show errors.
                    let value = self.eval(env, value).ok();
                    env.put(local.0 as usize, value);
                }
                self.eval(env, result)
            }
            ExprKind::If(condition, yes, no) => self.branch(env, condition, yes, no, span),
            ExprKind::Lambda(lambda) => {
                let captures = lambda.captures.iter().map(|&local| env.get(local));
                let captures = captures.collect::<Outcome<Vec<_>>>()?;
                Ok(self.closure(Code::Lambda(lambda), captures))
            }
            ExprKind::FnValue(id) => Ok(self.closure(Code::Function(*id), Vec::new())),
            ExprKind::Constant(value) => {
                let value = self.eval(env, value)?;
                Ok(self.closure(Code::Constant, vec![value]))
            }
            ExprKind::Call(id, args) => self.call(env, *id, args, span),
            ExprKind::Build(id, args) => self.build(env, *id, args, span),
            ExprKind::Sample(shape, point) => {
                let (shape, point) = (self.shape(env, shape), self.number(env, point));
                Ok(Value::Node(self.sample(shape?, point?)))
            }
            ExprKind::Apply(function, args) => {
                let function = self.eval(env, function);
                let args = self.all(env, args);
                match function? {
                    Value::Closure(closure) => self.apply(&closure, args?, span),
                    other => Err(self.unexpected(span, "a function", &other)),
                }
            }
            ExprKind::Kernel(op, args) => self.kernel(env, Application { op: *op, args, span }),
            ExprKind::MaterialField(base, field) => self.material_field(env, base, *field),
            ExprKind::With(base, fields) => self.with(env, base, fields),
            ExprKind::Splat(value) => {
                let value = self.number(env, value)?;
                let ty = node_type(&expr.ty).ok_or(Poison)?;
                Ok(Value::Node(self.graph.splat(ty, value)))
            }
            ExprKind::Error => Err(Poison),
        }
    }

    /// A shape's distance at a point. In a clause, at a point that is known at compile time or per
    /// frame, the shape is expanded if possible, since the compiler needs the values of clauses.
    fn sample(&mut self, shape: ShapeId, point: NodeId) -> NodeId {
        if self.within == Within::Clause
            && self.graph.stage(point) < Stage::Point
            && let Ok(value) = Expander::new().field(&mut self.graph, shape, point)
        {
            return value;
        }
        self.graph.sample(shape, point)
    }

    /// Evaluates all expressions and reports the errors of all.
    pub(super) fn all(&mut self, env: &mut Env<'p>, exprs: &'p [Expr]) -> Outcome<Vec<Value<'p>>> {
        let values: Vec<_> = exprs.iter().map(|expr| self.eval(env, expr)).collect();
        values.into_iter().collect()
    }

    /// Evaluates an expression to the node of a number, vector, colour or bool.
    pub(super) fn number(&mut self, env: &mut Env<'p>, expr: &'p Expr) -> Outcome<NodeId> {
        match self.eval(env, expr)? {
            Value::Node(node) | Value::Choice(node, _) => Ok(node),
            other => Err(self.unexpected(expr.span, "a number", &other)),
        }
    }

    /// Evaluates an expression to a shape.
    pub(super) fn shape(
        &mut self,
        env: &mut Env<'p>,
        expr: &'p Expr,
    ) -> Outcome<sdfc_graph::ShapeId> {
        match self.eval(env, expr)? {
            Value::Shape(shape) => Ok(shape),
            other => Err(self.unexpected(expr.span, "a shape", &other)),
        }
    }

    /// Reports a value of the wrong type. The checker guarantees types, so this is a fault of the
    /// checker.
    pub(super) fn unexpected(&mut self, span: Span, wanted: &str, found: &Value<'p>) -> Poison {
        let found = match found {
            Value::Node(_) => "a number",
            Value::Choice(..) | Value::Text(_) => "a string",
            Value::Range(..) => "a range",
            Value::List(_) => "a list",
            Value::Closure(_) => "a function",
            Value::Shape(_) => "a shape",
            Value::Material(_) => "a material",
            Value::Shadow(_) => "a shadow",
        };
        let message = format!("this is {found}, but {wanted} is expected here");
        self.fail(ErrorCode::TYPE_MISMATCH, span, message)
    }

    /// The field of a record with an index.
    fn field(&mut self, env: &mut Env<'p>, record: &'p Expr, at: usize) -> Outcome<Value<'p>> {
        match self.eval(env, record)? {
            Value::List(fields) => fields.get(at).cloned().ok_or(Poison),
            other => Err(self.unexpected(record.span, "a record", &other)),
        }
    }

    /// A function value. Equal functions get equal ids.
    pub(super) fn closure(&mut self, code: Code<'p>, captures: Vec<Value<'p>>) -> Value<'p> {
        let key = (code.key(), captures.iter().map(Value::to_arg).collect());
        let next = self.closures.len() as u32;
        let id = *self.closures.entry(key).or_insert(next);
        let levels = highest(captures.iter().map(|value| value.levels(&self.graph)));
        let moves = captures.iter().any(|value| value.moves(&self.graph));
        Value::Closure(Rc::new(Closure { id, code, captures, levels, moves }))
    }

    fn global(&mut self, id: GlobalId) -> Outcome<Value<'p>> {
        self.globals.get(id.0 as usize).cloned().flatten().ok_or(Poison)
    }

    fn frame_value(&mut self, input: FrameInput) -> Value<'p> {
        Value::Node(self.graph.frame_input(input, Type::Scalar))
    }

    fn vector(&mut self, env: &mut Env<'p>, parts: &'p [Expr]) -> Outcome<Value<'p>> {
        let nodes: Vec<_> = parts.iter().map(|part| self.number(env, part)).collect();
        let mut lanes = Vec::new();
        for node in nodes {
            let node = node?;
            for lane in 0..self.graph.ty(node).width() as u8 {
                lanes.push(self.graph.component(node, lane));
            }
        }
        Ok(Value::Node(self.graph.compose(&lanes)))
    }

    /// A field of a material. The alpha of its colour is the fraction that covers the colour
    /// beneath.
    fn material_field(
        &mut self,
        env: &mut Env<'p>,
        base: &'p Expr,
        field: MaterialField,
    ) -> Outcome<Value<'p>> {
        let material = self.eval(env, base)?;
        let Value::Material([color, coverage, rough, metal, emit, open]) = material else {
            return Err(self.unexpected(base.span, "a material", &material));
        };
        let one = self.graph.number(1.0);
        let mut with_alpha = |color, alpha| {
            let [red, green, blue] = [0, 1, 2].map(|lane| self.graph.component(color, lane));
            self.graph.compose(&[red, green, blue, alpha])
        };
        Ok(Value::Node(match field {
            MaterialField::Color => with_alpha(color, coverage),
            MaterialField::Roughness => rough,
            MaterialField::Metallic => metal,
            MaterialField::Emission => with_alpha(emit, one),
            MaterialField::Occlusion => open,
        }))
    }

    /// `m.with(...)`. A colour's alpha is the fraction that covers the colour beneath.
    fn with(
        &mut self,
        env: &mut Env<'p>,
        base: &'p Expr,
        fields: &'p [(MaterialField, Expr)],
    ) -> Outcome<Value<'p>> {
        let base_value = self.eval(env, base)?;
        let Value::Material([mut color, mut coverage, mut rough, mut metal, mut emit, mut open]) =
            base_value
        else {
            return Err(self.unexpected(base.span, "a material", &base_value));
        };
        for (field, value) in fields {
            let value = self.number(env, value)?;
            match field {
                MaterialField::Color => {
                    let alpha = self.graph.component(value, 3);
                    let over = self.graph.swizzle(value, &[0, 1, 2]);
                    let one = self.graph.number(1.0);
                    coverage = self.mix(coverage, one, alpha);
                    let fraction = self.fraction_of(alpha, coverage);
                    color = self.mix(color, over, fraction);
                }
                MaterialField::Roughness => rough = value,
                MaterialField::Metallic => metal = value,
                MaterialField::Emission => emit = self.graph.swizzle(value, &[0, 1, 2]),
                MaterialField::Occlusion => open = value,
            }
        }
        Ok(Value::Material([color, coverage, rough, metal, emit, open]))
    }

    /// The fraction of a colour in what covers a material, as for the operator `over` of Porter and
    /// Duff: its alpha by the coverage of all colours. A colour over none is all of it.
    fn fraction_of(&mut self, alpha: NodeId, coverage: NodeId) -> NodeId {
        if self.graph.as_number(alpha).is_some_and(|alpha| alpha == 0.0 || alpha == 1.0) {
            return alpha;
        }
        let least = self.graph.number(LEAST_COVERAGE);
        let divisor = self.graph.max(coverage, least);
        self.graph.div(alpha, divisor)
    }

    /// `a + (b - a) * t`; exactly `a` or `b` if t is the constant 0 or 1.
    pub(super) fn mix(&mut self, a: NodeId, b: NodeId, t: NodeId) -> NodeId {
        match self.graph.as_number(t) {
            Some(0.0) => a,
            Some(1.0) => b,
            Some(_) | None => self.graph.ternary(sdfc_graph::Ternary::Mix, a, b, t),
        }
    }

    /// The value of a constant bool node.
    pub(super) fn as_bool(&self, node: NodeId) -> Option<bool> {
        self.as_lanes(node).map(|(lanes, _)| lanes[0] != 0.0)
    }

    /// The components of a constant node and their number.
    pub(super) fn as_lanes(&self, node: NodeId) -> Option<([f64; 4], usize)> {
        if let Node::Const(value) = self.graph.node(node) {
            Some((value.lanes(), value.ty().width()))
        } else {
            None
        }
    }
}
