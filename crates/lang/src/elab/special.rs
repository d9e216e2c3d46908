//! The kernel's operations on shapes, lists and materials, and `hash`.

use sdfc_diagnostics::{Code as ErrorCode, Diagnostic, Span};
use sdfc_graph::{Bounds, Dim, MaterialField, NodeId, ShapeId, Ternary, Type};

use super::kernel::{Application, name};
use super::value::Value;
use super::{Elaborator, Env, Outcome, Poison};
use crate::hir;

/// The largest whole number up to which 32-bit floats hold every one.
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

    /// `bounds(a)`: what the graph knows of where the shape lies; of a function that gives shapes, where any of
    /// them lies.
    pub(super) fn bounds(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        self.asked_bounds = true;
        let over = at.args.first().ok_or(Poison)?;
        let mut value = self.eval(env, over)?;
        if let (Value::Closure(closure), hir::Type::Fn(takes, _)) = (&value, &over.ty) {
            let anything = takes.iter().map(|ty| Value::Node(self.anything(ty))).collect();
            value = self.apply(closure, anything, at.span)?;
        }
        match value {
            Value::Shape(shape) => {
                let [lo, hi] = self.shape_bounds(shape);
                Ok(Value::Range(lo, hi))
            }
            other => Err(self.unexpected(at.span, "a shape", &other)),
        }
    }

    /// A number or vector that can have any value: a shape made of it stands for all such shapes. Indices beyond
    /// what 32-bit floats count exactly are left out, since no remainder of those is known.
    fn anything(&mut self, ty: &hir::Type) -> NodeId {
        let any = match ty {
            hir::Type::Vec(2) => self.graph.point(0, Dim::Two),
            _ => self.graph.point(0, Dim::Three),
        };
        let [lo, hi] = [-MAX_INDEX, MAX_INDEX].map(|end| self.graph.number(end));
        let any = self.graph.ternary(Ternary::Clamp, any, lo, hi);
        match ty {
            hir::Type::Vec(_) => any,
            _ => self.graph.component(any, 0),
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

    /// `hash(...)` of constants.
    pub(super) fn hash(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let words = self.words(env, at)?;
        Ok(Value::Node(self.graph.number(hash_words(0, &words))))
    }

    /// `hash3(...)` of constants.
    pub(super) fn hash3(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let words = self.words(env, at)?;
        let lanes = [0, 1, 2].map(|seed| hash_words(seed, &words));
        Ok(Value::Node(self.graph.constant(Type::Vec3, &lanes)))
    }

    /// The whole parts of all arguments' lanes.
    fn words(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Vec<u32>> {
        let mut words = Vec::new();
        for arg in at.args {
            let node = self.number(env, arg)?;
            let Some((lanes, width)) = self.as_lanes(node) else {
                self.decides(node);
                let what = format!("`{}` of a value that is not constant", name(at.op));
                return Err(self.not_yet(arg.span, &what));
            };
            words.extend(lanes[..width].iter().map(|&lane| lane.floor() as i64 as u32));
        }
        Ok(words)
    }

    /// Refuses what the specification has and this version has not.
    pub(super) fn not_yet(&mut self, span: Span, what: &str) -> Poison {
        let message = format!("{what} is not in this version");
        self.report(Diagnostic::error(ErrorCode::NOT_YET, span, message))
    }
}

/// A number in 0..1 from whole numbers: each word is mixed in by one round of PCG
/// (Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020); 24 bits survive, which f32 holds.
fn hash_words(seed: u32, words: &[u32]) -> f64 {
    let mixed = words.iter().fold(seed, |state, &word| pcg(state ^ pcg(word)));
    f64::from(pcg(mixed) >> 8) / f64::from(1 << 24)
}

fn pcg(word: u32) -> u32 {
    let state = word.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}
