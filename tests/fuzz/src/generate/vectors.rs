//! Vectors, colours, materials, shadows and functions.

use super::numbers::{finite, round};
use super::{Generator, Rate, Variable, Want};
use crate::tree::{Element, Layout, Tree};
use crate::types::Ty;

/// The patterns that depend on the angle between the surface and the eye, in percent.
const RIM: u8 = 12;

impl Generator<'_> {
    pub(super) fn vector(&mut self, width: u8, want: Want) -> Tree {
        let ty = Ty::Vec(width);
        if want.range.is_none() {
            if self.chance(35)
                && let Some(variable) = self.variable(&ty, want)
            {
                return variable;
            }
            if want.depth > 0 && self.chance(25) {
                return self.computed_vector(width, want.deeper());
            }
        }
        if let Some(range) = want.range
            && want.depth > 0
            && self.chance(15)
        {
            let [lo, hi] = finite(range);
            let least = round(lo + 0.1 * (hi - lo));
            let computed = self.computed_vector(width, want.deeper());
            return Tree::new(ty, &format!("clamp({{}}, {least}, {hi})"), [computed]);
        }
        let part = Want { depth: want.depth.saturating_sub(2), ..want };
        let parts = (0..width).map(|_| {
            let value = self.number(part);
            Element { label: String::new(), optional: false, value }
        });
        let parts = parts.collect();
        Tree::list(ty, "[", Layout::Line, parts, "]")
    }

    fn computed_vector(&mut self, width: u8, want: Want) -> Tree {
        let ty = Ty::Vec(width);
        // One shape alone takes vectors of four numbers, so these are rare.
        if width == 4 {
            return self.call_for(&ty, want);
        }
        match self.rng.u8(0..11) {
            0 | 1 => {
                let operator = self.pick(&["+", "-", "*"]).copied().unwrap_or("+");
                let parts = [self.vector(width, want), self.vector(width, want)];
                Tree::new(ty, &format!("({{}} {operator} {{}})"), parts)
            }
            2 => Tree::new(ty, "({} * {})", [self.number(want), self.vector(width, want)]),
            3 => {
                let letters: String =
                    (0..width).map(|_| char::from(b'x' + self.rng.u8(0..3))).collect();
                Tree::new(ty, &format!("({{}}).{letters}"), [self.vector(3, want)])
            }
            4 => self.conditional(&ty, want),
            5 => self.block(&ty, want),
            6 => self.iterate(&ty, want),
            7 => {
                // The sum is not 0, so it has a direction.
                let x = self.number(want.within(Some([1.0, 2.0])));
                let rest = (1..width).map(|_| self.number(want.within(Some([0.0, 1.0]))));
                let parts: Vec<Tree> = std::iter::once(x).chain(rest).collect();
                let holes = vec!["{}"; parts.len()].join(", ");
                Tree::new(ty, &format!("normalize([{holes}])"), parts)
            }
            _ => self.call_for(&ty, want),
        }
    }

    pub(super) fn color(&mut self, want: Want) -> Tree {
        let ty = Ty::Color;
        if self.chance(20)
            && let Some(variable) = self.variable(&ty, want)
        {
            return variable;
        }
        if want.depth == 0 || self.chance(60) {
            let digits = match self.rng.u8(0..8) {
                0 => format!("{:03x}", self.rng.u16(0..0x1000)),
                1 => format!("{:08X}", self.rng.u32(..)),
                2 => format!("{:04x}", self.rng.u16(..)),
                _ => format!("{:06x}", self.rng.u32(0..0x100_0000)),
            };
            return Tree::text(ty, format!("#{digits}"));
        }
        let want = want.deeper();
        match self.rng.u8(0..6) {
            0 => Tree::new(
                ty,
                "({} * {})",
                [self.color(want), self.number(want.within(Some([0.0, 1.0])))],
            ),
            1 => self.conditional(&ty, want),
            2 => self.block(&ty, want),
            _ => self.call_for(&ty, want),
        }
    }

    pub(super) fn material(&mut self, want: Want) -> Tree {
        if self.chance(20)
            && let Some(variable) = self.variable(&Ty::Material, want)
        {
            return variable;
        }
        if want.depth == 0 {
            Tree::text(Ty::Material, "material()")
        } else {
            self.call_for(&Ty::Material, want.deeper())
        }
    }

    pub(super) fn shadow(&mut self) -> Tree {
        if self.rng.bool() {
            return Tree::text(Ty::Shadow, "hard");
        }
        let sharpness = self.number(Want::new(Rate::Const, 0).within(Some([2.0, 20.0])));
        Tree::new(Ty::Shadow, "soft({})", [sharpness])
    }

    /// A function: a name, a call that gives one, or a lambda.
    pub(super) fn function(&mut self, ty: &Ty, parameters: &[Ty], result: &Ty, want: Want) -> Tree {
        if self.chance(20)
            && let Some(variable) = self.variable(ty, want)
        {
            return variable;
        }
        if result.is_shape() && self.chance(70) {
            // A shape stands for a function that ignores its argument.
            return Tree { ty: ty.clone(), ..self.shape(result, want) };
        }
        if *ty == Ty::blend() && self.chance(15) {
            return Tree::text(ty.clone(), "min");
        }
        if *result == Ty::Color && self.chance(30) {
            return Tree { ty: ty.clone(), ..self.color(want) };
        }
        if !self.callables(|callable| callable.result == *ty).is_empty() && self.chance(75) {
            return self.call_for(ty, want);
        }
        self.lambda(ty, parameters, result, want)
    }

    fn lambda(&mut self, ty: &Ty, parameters: &[Ty], result: &Ty, want: Want) -> Tree {
        let names: Vec<String> = parameters.iter().map(|_| self.fresh("q")).collect();
        let variable = |(name, ty): (&str, &Ty)| Variable {
            name: name.to_owned(),
            ty: ty.clone(),
            rate: Rate::Point,
            range: None,
            texts: Vec::new(),
        };
        let own = names.iter().map(String::as_str).zip(parameters);
        // Only materials can read these, and only they have patterns.
        let surface = ["normal", "view"].map(|name| (name, &const { Ty::Vec(3) }));
        let surface = surface.into_iter().filter(|_| *ty == Ty::pattern());
        let variables = own.chain(surface).map(variable);
        let rate = if result.is_shape() { want.rate } else { Rate::Point };
        let inner = Want { rate, ..want.deeper() };
        let body = self.with_names(variables.collect(), |this| match (parameters, result) {
            ([a, b], Ty::Number) if *a == Ty::Number && *b == Ty::Number => {
                let [a, b] = [0, 1].map(|at| Tree::text(Ty::Number, names[at].clone()));
                let third = this.number(inner);
                Tree::new(
                    Ty::Number,
                    "min({}, {}, 0.5 * ({} + {}) + abs({}))",
                    [a.clone(), b.clone(), a, b, third],
                )
            }
            ([point], result) if *point == *result => {
                let point = Tree::text(point.clone(), names[0].clone());
                let moved = this.value(result, inner);
                Tree::new(result.clone(), "({} + 0.1 * {})", [point, moved])
            }
            (_, Ty::Number) => Tree::new(Ty::Number, "(0.1 * {})", [this.number(inner)]),
            (_, Ty::Color) if *ty == Ty::pattern() && this.chance(RIM) => {
                let colors = [this.color(inner), this.color(inner)];
                Tree::new(Ty::Color, "mix({}, {}, abs(dot(normal, view)))", colors)
            }
            _ => this.value(result, inner),
        });
        let typed = self.rng.bool();
        let list = names.iter().zip(parameters).map(|(name, ty)| match ty.word() {
            Some(word) if typed => format!("{name}: {word}"),
            _ => name.clone(),
        });
        let list: Vec<String> = list.collect();
        Tree::new(ty.clone(), &format!("fn({}) = {{}}", list.join(", ")), [body])
    }
}
