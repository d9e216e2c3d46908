//! The kernel's operations on shapes, lists and materials, and `hash`.

use sdfc_diagnostics::{Code as ErrorCode, Span};
use sdfc_graph::eval::HASH_COUNT;
use sdfc_graph::{
    Binary, Bounds, Dim, Expander, MaterialField, Node, NodeId, ShapeId, Ternary, Type, Unary,
    best_gradient, gradient, reachable,
};

use super::elaborator::{Elaborator, Env, Outcome, Poison, Within};
use super::kernel::Application;
use super::value::{Closure, Value};
use crate::hir;

/// 2^24: 32-bit floats represent all whole numbers up to this one.
const MAX_INDEX: f64 = 16_777_216.0;

impl<'p> Elaborator<'p> {
    /// `[x, y]` to `[x, y, 0]`.
    pub(super) fn lift(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let [point] = self.numbers(env, at.args)?;
        if self.graph.ty(point).width() == 3 {
            return Ok(Value::Node(point));
        }
        let (x, y) = (self.graph.component(point, 0), self.graph.component(point, 1));
        let zero = self.graph.number(0.0);
        Ok(Value::Node(self.graph.compose(&[x, y, zero])))
    }

    /// `len(x)` of a list, a range of whole numbers or a vector.
    pub(super) fn len(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let over = at.args.first().ok_or(Poison)?;
        let length = match self.eval(env, over)? {
            Value::List(items) => items.len() as f64,
            Value::Node(vector) => self.graph.ty(vector).width() as f64,
            Value::Range(lo, hi) => {
                let (lo, hi) =
                    (self.whole(lo, over.span, "`len`")?, self.whole(hi, over.span, "`len`")?);
                (hi - lo).max(0.0)
            }
            other => return Err(self.unexpected(at.span, "a list, range or vector", &other)),
        };
        Ok(Value::Node(self.graph.number(length)))
    }

    /// Runs a step. Returns the last value of `bounds(a)` in it too, if there was one.
    pub(super) fn with_bounds<T>(
        &mut self,
        step: impl FnOnce(&mut Self) -> Outcome<T>,
    ) -> Outcome<(T, Option<[NodeId; 2]>)> {
        let outer = self.last_bounds.take();
        let result = step(self);
        let bounds = self.last_bounds;
        self.last_bounds = bounds.or(outer);
        Ok((result?, bounds))
    }

    /// `bounds(a)`: the bounds that the graph knows for a shape, or for all shapes that a function
    /// makes.
    pub(super) fn bounds(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let over = at.args.first().ok_or(Poison)?;
        match self.eval(env, over)? {
            Value::Shape(shape) => Ok(self.known_bounds(shape)),
            Value::Closure(closure) => self.bounds_of_all(&closure, at),
            other => Err(self.unexpected(at.span, "a shape", &other)),
        }
    }

    /// The box around all shapes that a function makes.
    fn bounds_of_all(&mut self, closure: &Closure<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let takes = match at.args.first().map(|arg| &arg.ty) {
            Some(hir::Type::Fn(takes, _)) => takes.clone(),
            _ => return Err(Poison),
        };
        // If a shape's arguments depend on an outer point, its bounds hold for all arguments.
        let before = self.attempt();
        let mut anything = Vec::with_capacity(takes.len());
        for ty in &takes {
            anything.push(self.anything(ty, closure.levels, at.span)?);
        }
        let shape = self.apply(closure, anything, at.span)?;
        self.take_back(before);
        let Value::Shape(shape) = shape else {
            return Err(self.unexpected(at.span, "a shape", &shape));
        };
        Ok(self.known_bounds(shape))
    }

    fn known_bounds(&mut self, shape: ShapeId) -> Value<'p> {
        let [lo, hi] = self.shape_bounds(shape);
        self.last_bounds = Some([lo, hi]);
        Value::Range(lo, hi)
    }

    /// An unknown value of a type, computed from a new outer point: a shape made with it represents
    /// all such shapes. Values are limited to [`MAX_INDEX`], since nothing is known about
    /// remainders of larger ones.
    fn anything(&mut self, ty: &hir::Type, level: u16, span: Span) -> Outcome<Value<'p>> {
        let point = self.graph.point(level, Dim::Three);
        let [lo, hi] = [-MAX_INDEX, MAX_INDEX].map(|end| self.graph.number(end));
        let point = self.graph.ternary(Ternary::Clamp, point, lo, hi);
        let node = match ty {
            hir::Type::Number | hir::Type::Angle => self.graph.component(point, 0),
            hir::Type::Int => {
                let number = self.graph.component(point, 0);
                self.graph.unary(Unary::Floor, number)
            }
            hir::Type::Vec(width @ 2..=3) => {
                let lanes: Vec<u8> = (0..*width).collect();
                self.graph.swizzle(point, &lanes)
            }
            _ => {
                let message = "`bounds` needs a function of numbers or points";
                return Err(self.fail(ErrorCode::TYPE_MISMATCH, span, message));
            }
        };
        Ok(Value::Node(node))
    }

    /// `gradient(shape, point)`: expands the shape's formula and differentiates it.
    pub(super) fn gradient(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
    ) -> Outcome<Value<'p>> {
        let [shape, position] = at.args else { return Err(Poison) };
        let (shape, position) = (self.shape(env, shape), self.number(env, position));
        let (shape, position) = (shape?, position?);
        let (level, dim) = (self.graph.shape(shape).level, self.graph.shape(shape).dim);
        // Points of outer formulas stay; the shape's own point is replaced at the end.
        let mut points: Vec<NodeId> =
            (0..level).map(|outer| self.outer_point(shape, outer)).collect();
        let own = self.graph.point(level, dim);
        let mut expander = Expander::new();
        let gradient =
            expander.field_under(&mut self.graph, shape, &points, own).and_then(|field| {
                let gradient = self.derivative(field, own);
                points.push(position);
                expander.node(&mut self.graph, gradient, &points)
            });
        gradient.map(Value::Node).map_err(|error| {
            self.fail(ErrorCode::TOO_MANY_NODES, at.span, format!("`gradient`: {error}"))
        })
    }

    /// The gradient of a field. In a material it is the one that keeps the fewest values alive: a
    /// ray needs it once, but its registers are taken from the whole shader.
    fn derivative(&mut self, field: NodeId, point: NodeId) -> NodeId {
        if self.within == Within::Material {
            best_gradient(&mut self.graph, field, point).0
        } else {
            gradient(&mut self.graph, field, point)
        }
    }

    /// The node of an outer formula's point in the formulas of a shape.
    fn outer_point(&mut self, shape: ShapeId, level: u16) -> NodeId {
        let mut pending = vec![shape];
        let mut seen = rustc_hash::FxHashSet::default();
        while let Some(shape) = pending.pop() {
            if !seen.insert(shape) {
                continue;
            }
            for id in reachable(&self.graph, &[self.graph.shape(shape).formula]) {
                if matches!(self.graph.node(id), Node::Point(at, _) if at == level) {
                    return id;
                }
            }
            pending.extend(self.graph.shape(shape).children.iter().copied());
        }
        self.graph.point(level, Dim::Three) // no formula uses it
    }

    /// The bounds of a shape, derived once per shape. All params are known by then.
    fn shape_bounds(&mut self, shape: ShapeId) -> [NodeId; 2] {
        let bounds = self.bounds.get_or_insert_with(|| Bounds::new(&self.params));
        bounds.of(&mut self.graph, shape)
    }

    /// `material(...)`. The colour's alpha is the coverage.
    pub(super) fn new_material(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
    ) -> Outcome<Value<'p>> {
        let [color, roughness, metallic, emission, occlusion] = self.numbers(env, at.args)?;
        let coverage = self.graph.component(color, 3);
        let color = self.graph.swizzle(color, &[0, 1, 2]);
        let emission = self.graph.swizzle(emission, &[0, 1, 2]);
        Ok(Value::Material([color, coverage, roughness, metallic, emission, occlusion]))
    }

    /// `material_at(shape, point)`.
    pub(super) fn material_at(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
    ) -> Outcome<Value<'p>> {
        let [shape, point] = at.args else { return Err(Poison) };
        let (shape, point) = (self.shape(env, shape), self.number(env, point));
        let (shape, point) = (shape?, point?);
        let fields = MaterialField::ALL.map(|field| self.graph.material_at(shape, point, field));
        Ok(Value::Material(fields))
    }

    /// `hash(...)`: a number in 0..1.
    pub(super) fn hash(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let start = self.graph.number(HASH_STARTS[0]);
        self.hashed(env, at, start)
    }

    /// `hash3(...)`: three numbers in 0..1.
    pub(super) fn hash3(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let start = self.graph.constant(Type::Vec3, &HASH_STARTS);
        self.hashed(env, at, start)
    }

    /// Hashes the components of all arguments in order.
    fn hashed(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
        mut state: NodeId,
    ) -> Outcome<Value<'p>> {
        for value in self.all(env, at.args)? {
            let Value::Node(node) = value else {
                return Err(self.unexpected(at.span, "a number", &value));
            };
            for lane in 0..self.graph.ty(node).width() as u8 {
                let part = self.graph.component(node, lane);
                state = self.graph.binary(Binary::Hash, state, part);
            }
        }
        let scale = self.graph.number(1.0 / HASH_COUNT);
        Ok(Value::Node(self.graph.mul(state, scale)))
    }
}

/// The start values of the three numbers of `hash3`. They are far apart, since a start value and a
/// coordinate are added.
const HASH_STARTS: [f64; 3] = [0.0, 10_368_889.0, 4_370_562.0];
