//! Shapes, and calls of everything in the catalogue.

use std::ops::Range;

use super::{Generator, Rate, Variable, Want};
use crate::catalogue::{Callable, Parameter};
use crate::kernel::{CONSTANT, RIVAL_PARAMETERS, TEXTS};
use crate::tree::{Element, Tree};
use crate::types::Ty;

/// The numbers of copies that a comprehension makes: a few, or enough for a loop in the shader.
const COPIES: [Range<u8>; 2] = [2..6, 16..24];
/// The comprehensions that make many copies, in percent.
const MANY: u8 = 15;

impl Generator<'_> {
    /// Generates a solid or a region with about as many shapes as are wanted.
    pub(super) fn shape(&mut self, ty: &Ty, want: Want) -> Tree {
        let want = Want { depth: want.depth.max(2), ..want };
        if want.shapes <= 1 {
            return self.leaf(ty, want);
        }
        match self.rng.u8(0..20) {
            0..6 => self.operator(ty, want),
            6 => self.conditional(ty, Want { rate: want.rate.min(Rate::Frame), ..want }),
            7 => self.shape_block(ty, want),
            _ => {
                let fitting = self.callables(|it| it.result == *ty && takes_shapes(it));
                match self.pick(&fitting) {
                    Some(callable) => self.call(callable, want),
                    None => self.operator(ty, want),
                }
            }
        }
    }

    fn leaf(&mut self, ty: &Ty, want: Want) -> Tree {
        if self.chance(15)
            && let Some(variable) = self.variable(ty, want)
        {
            return variable;
        }
        let fitting = self.callables(|it| it.result == *ty && !takes_shapes(it));
        match self.pick(&fitting) {
            Some(callable) => self.call(callable, want),
            None => Tree::text(ty.clone(), ty.simplest().unwrap_or_default()),
        }
    }

    /// `a | b`, `a - b` or `a & b`
    fn operator(&mut self, ty: &Ty, want: Want) -> Tree {
        let operator = self.pick(&["|", "|", "|", "-", "-", "&"]).copied().unwrap_or("|");
        let first = self.rng.usize(1..want.shapes.max(2));
        let parts = [first, want.shapes.saturating_sub(first)];
        let parts = parts.map(|shapes| self.shape(ty, want.shapes(shapes)));
        Tree::new(ty.clone(), &format!("({{}} {operator} {{}})"), parts)
    }

    /// `({ let a = ...; a | ... })`
    fn shape_block(&mut self, ty: &Ty, want: Want) -> Tree {
        let name = self.fresh("part");
        let half = want.shapes(want.shapes / 2);
        let value = self.shape(ty, half);
        let local = Variable {
            name: name.clone(),
            ty: ty.clone(),
            rate: want.rate,
            range: None,
            texts: Vec::new(),
        };
        let result = self.with_names(vec![local], |this| this.shape(ty, half));
        let format = format!("({{ let {name} = {{}}; {name} | {{}} }})");
        Tree::new(ty.clone(), &format, [value, result])
    }

    /// Calls something, with random arguments in random order of writing.
    pub(super) fn call(&mut self, callable: &Callable, want: Want) -> Tree {
        let shapes = callable.parameters.iter().filter(|it| is_shape_like(&it.ty)).count();
        let share = want.shapes.saturating_sub(1) / shapes.max(1);
        let mut elements: Vec<Element> = Vec::new();
        let mut named = false;
        // Names before any number of positional arguments are an error.
        let may_name = !callable.positional && !callable.parameters.iter().any(|it| it.variadic);
        for (at, parameter) in callable.parameters.iter().enumerate() {
            let rival =
                RIVAL_PARAMETERS.iter().find(|pair| pair.contains(&parameter.name.as_str()));
            let is_taken = rival.is_some_and(|pair| {
                elements.iter().any(|it| pair.iter().any(|name| it.label == format!("{name}: ")))
            });
            if parameter.optional && (is_taken || self.chance(50)) {
                named = true;
                continue;
            }
            if parameter.variadic {
                elements.extend(self.variadic(parameter, want.shapes(share)));
                named = true;
                continue;
            }
            let value = self.argument(parameter, want.shapes(share));
            named |= may_name && (rival.is_some() || self.chance(25));
            named |= is_component(&callable.parameters[..=at]);
            let label = if named { format!("{}: ", parameter.name) } else { String::new() };
            elements.push(Element { label, optional: parameter.optional, value });
        }
        self.written(callable, elements)
    }

    /// Writes a call as `f(a, b)` or `a.f(b)`.
    fn written(&mut self, callable: &Callable, mut elements: Vec<Element>) -> Tree {
        let name = &callable.name;
        let layout = self.layout();
        let is_receiver = |element: &Element| {
            let ty = &element.value.ty;
            element.label.is_empty() && (ty.is_shape() || *ty == Ty::Material)
        };
        if elements.first().is_some_and(is_receiver) && (name == "with" || self.chance(70)) {
            let receiver = elements.remove(0).value;
            let mut call =
                Tree::list(callable.result.clone(), &format!(".{name}("), layout, elements, ")");
            call.pieces.insert(0, crate::tree::Piece::Part(receiver));
            return call;
        }
        Tree::list(callable.result.clone(), &format!("{name}("), layout, elements, ")")
    }

    fn variadic(&mut self, parameter: &Parameter, want: Want) -> Vec<Element> {
        let count = self.rng.usize(1..4).min(want.shapes.max(1));
        let each = want.shapes(want.shapes / count);
        let mut elements = Vec::new();
        for at in 0..count {
            let loops = want.shapes > 2 && self.chance(20);
            let (label, value) = if loops {
                self.copies(&parameter.ty, each)
            } else {
                (String::new(), self.argument(parameter, each))
            };
            elements.push(Element { label, optional: at > 0, value });
        }
        elements
    }

    /// `for i in 0..4: shape`
    fn copies(&mut self, ty: &Ty, want: Want) -> (String, Tree) {
        let many = self.chance(MANY);
        let (name, count) = (self.fresh("i"), self.rng.u8(COPIES[usize::from(many)].clone()));
        let (over, kind, most) = match self.rng.u8(0..3) {
            0 if !many => ("[0.1, 0.4, 0.7, 0.2, 1]".to_owned(), Ty::Number, 1.0),
            _ => (format!("0..{count}"), Ty::Int, f64::from(count) - 1.0),
        };
        let condition = if self.chance(20) { format!(" if {name} != 1") } else { String::new() };
        let index = Variable {
            name: name.clone(),
            ty: kind,
            rate: Rate::Const,
            range: Some([0.0, most]),
            texts: Vec::new(),
        };
        let each = want.shapes(want.shapes / usize::from(count));
        let value = self.with_names(vec![index], |this| {
            let moved = this.shape(ty, each);
            let width = if *ty == Ty::Region { 2 } else { 3 };
            let by = this.vector(width, Want::new(Rate::Const, 0));
            let format = format!("{{}}.translate({name} * {{}})");
            Tree::new(ty.clone(), &format, [moved, by])
        });
        (format!("for {name} in {over}{condition}: "), value)
    }

    fn argument(&mut self, parameter: &Parameter, want: Want) -> Tree {
        let ty = &parameter.ty;
        if *ty == Ty::Text {
            let texts = TEXTS.iter().find(|row| row.0 == parameter.name);
            let texts = texts.map_or(&[][..], |row| row.1);
            let text = self.pick(texts).copied().unwrap_or("sans");
            if parameter.name == "words" && self.chance(20) {
                let number = self.int(Want::new(Rate::Const, 0));
                return Tree::new(Ty::Text, &format!("str(\"{text}\", {{}})"), [number]);
            }
            return Tree::text(Ty::Text, format!("\"{text}\""));
        }
        let constant = CONSTANT.contains(&parameter.name.as_str());
        let frame_only = is_shape_like(ty) || constant;
        let rate = match (constant, frame_only) {
            (true, _) => Rate::Const,
            (false, true) => want.rate.min(Rate::Frame),
            (false, false) => want.rate,
        };
        let depth = want.depth.saturating_sub(1);
        // A number stands for a vector with equal components.
        if matches!(ty, Ty::Vec(_)) && parameter.range.is_some() && self.chance(30) {
            let number = self.number(Want { rate, range: parameter.range, depth: 0, ..want });
            return Tree { ty: ty.clone(), ..number };
        }
        self.value(ty, Want { rate, range: parameter.range, depth, ..want })
    }
}

/// Returns true for shapes and functions that make them.
fn is_shape_like(ty: &Ty) -> bool {
    let made = if let Ty::Fn(_, result) = ty { result } else { ty };
    made.is_shape()
}

fn takes_shapes(callable: &Callable) -> bool {
    callable.parameters.iter().any(|parameter| is_shape_like(&parameter.ty))
}

/// True if the last parameter is `x` behind a vector, as in `translate(by, x, y, z)`: it needs its
/// name.
fn is_component(parameters: &[Parameter]) -> bool {
    matches!(parameters, [.., vector, x] if matches!(vector.ty, Ty::Vec(_)) && x.name == "x")
}
