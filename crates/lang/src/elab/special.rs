//! The kernel's operations on shapes, lists and materials, and `hash`.

use sdfc_diagnostics::{Code as ErrorCode, Diagnostic, Span};
use sdfc_graph::eval::HASHES;
use sdfc_graph::{Binary, Bounds, MaterialField, NodeId, ShapeId, Type};

use super::kernel::Application;
use super::value::Value;
use super::{Elaborator, Env, Outcome, Poison};

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

    /// `len(x)` of a list, range of whole numbers or vector.
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

    /// `bounds(a)`: what the graph knows of where the shape lies.
    pub(super) fn bounds(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        match self.eval(env, at.args.first().ok_or(Poison)?)? {
            Value::Shape(shape) => {
                let [lo, hi] = self.shape_bounds(shape);
                Ok(Value::Range(lo, hi))
            }
            Value::Closure(_) => {
                Err(self.not_yet(at.span, "`bounds` of a function that gives shapes"))
            }
            other => Err(self.unexpected(at.span, "a shape", &other)),
        }
    }

    /// Derived once per shape. All params are known by then: only they stand before shapes.
    fn shape_bounds(&mut self, shape: ShapeId) -> [NodeId; 2] {
        let bounds = self.bounds.get_or_insert_with(|| Bounds::new(&self.params));
        bounds.of(&mut self.graph, shape)
    }

    /// `material(...)`: the colour's alpha is the coverage.
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

    /// `material_at(shape, point)`
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

    /// The lanes of all arguments, hashed one after the other.
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
        let scale = self.graph.number(1.0 / HASHES);
        Ok(Value::Node(self.graph.mul(state, scale)))
    }

    /// Refuses what the specification has and this version has not.
    pub(super) fn not_yet(&mut self, span: Span, what: &str) -> Poison {
        let message = format!("{what} is not in this version");
        self.report(Diagnostic::error(ErrorCode::NOT_YET, span, message))
    }
}

/// Where the three numbers of `hash3` start: far apart, since a start and a coordinate are added.
const HASH_STARTS: [f64; 3] = [0.0, 10_368_889.0, 4_370_562.0];
