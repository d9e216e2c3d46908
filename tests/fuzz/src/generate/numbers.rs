//! Numbers, ints, angles and bools.

use super::{Generator, Rate, Variable, Want};
use crate::catalogue::Callable;
use crate::tree::{Layout, Tree};
use crate::types::Ty;

/// The greatest size of a literal without a range, in scene units.
const REACH: f64 = 1.5;
/// The least size of a literal that must not be negative, and is not 0.
const SMALL: f64 = 0.03;

impl Generator<'_> {
    pub(super) fn number(&mut self, want: Want) -> Tree {
        if want.depth == 0 || self.chance(60) {
            return self.simple_number(want);
        }
        let computed = self.computed_number(want.deeper());
        let Some(range) = want.range else { return computed };
        let [lo, hi] = finite(range);
        let from = lo + (hi - lo) * 0.3 * self.rng.f64();
        let to = from + (hi - from) * (0.2 + 0.8 * self.rng.f64());
        let ends = [round(from.max(lo)), round(to.min(hi))];
        let [from, to] = ends.map(|end| literal(Ty::Number, end, ""));
        Tree::new(Ty::Number, "clamp({}, {}, {})", [computed, from, to])
    }

    fn simple_number(&mut self, want: Want) -> Tree {
        if self.chance(35)
            && let Some(variable) = self.variable(&Ty::Number, want)
        {
            return variable;
        }
        literal(Ty::Number, self.random(want.range), "")
    }

    /// Returns a random number in a range, or around 0 without one.
    pub(super) fn random(&mut self, range: Option<[f64; 2]>) -> f64 {
        let Some(range) = range else {
            return round(REACH * (2.0 * self.rng.f64() - 1.0));
        };
        let [lo, hi] = finite(range);
        let value = match range {
            [0.0, f64::INFINITY] if self.chance(2) => 0.0,
            [0.0, f64::INFINITY] => SMALL * (REACH / SMALL).powf(self.rng.f64()),
            _ => lo + (hi - lo) * self.rng.f64(),
        };
        round(value).clamp(lo, hi)
    }

    fn computed_number(&mut self, want: Want) -> Tree {
        let ty = Ty::Number;
        match self.rng.u8(0..20) {
            0..4 => {
                let operator = self.pick(&["+", "-", "*"]).copied().unwrap_or("+");
                let parts = [self.number(want), self.number(want)];
                Tree::new(ty, &format!("({{}} {operator} {{}})"), parts)
            }
            4 => {
                let operator = self.pick(&["/", "%"]).copied().unwrap_or("/");
                let divisor = Some([0.1, 3.0]);
                let parts = [self.number(want), self.number(want.within(divisor))];
                Tree::new(ty, &format!("({{}} {operator} {{}})"), parts)
            }
            5 => Tree::new(ty, "-{}", [self.simple_number(want)]),
            6 => {
                let vector = self.vector(3, want);
                let component = self.pick(&["x", "y", "z", "r"]).copied().unwrap_or("x");
                Tree::new(ty, &format!("({{}}).{component}"), [vector])
            }
            7 => self.conditional(&ty, want),
            8 => self.block(&ty, want),
            9 => self.iterate(&ty, want),
            10 => {
                let at = self.rng.usize(0..5);
                let list = self.list(&ty, want);
                Tree::new(ty, &format!("{{}}[{at}]"), [list])
            }
            11 if want.rate == Rate::Point => self.sample(want),
            12 if want.rate >= Rate::Frame => {
                let wave = ["sin(time)", "0.1 * time", "fract(0.3 * time)", "0.01 * frame"];
                Tree::text(ty, self.pick(&wave).copied().unwrap_or("time"))
            }
            13 => {
                let box_of = self.shape(&Ty::Solid, Want::new(Rate::Const, 1));
                let ends = ["lo.x", "hi.y", "hi.z"];
                let end = self.pick(&ends).copied().unwrap_or("lo.x");
                Tree::new(ty, &format!("clamp(bounds({{}}).{end}, -2, 2)"), [box_of])
            }
            14 => {
                let parts = [self.angle(want), self.angle(want.within(Some([10.0, 90.0])))];
                Tree::new(ty, "({} / {})", parts)
            }
            15 => self.int(want),
            _ => self.call_for(&ty, want),
        }
    }

    /// Calls a function with this result.
    pub(super) fn call_for(&mut self, ty: &Ty, want: Want) -> Tree {
        let makes_no_shape = |callable: &Callable| {
            callable.result == *ty && !callable.parameters.iter().any(|it| it.ty.is_shape())
        };
        let fitting = self.callables(|callable| {
            makes_no_shape(callable) || (callable.result == *ty && want.rate == Rate::Point)
        });
        match self.pick(&fitting) {
            Some(callable) => self.call(callable, want.shapes(1)),
            None => self.value(ty, Want { depth: 0, ..want }),
        }
    }

    /// The distance of a shape at a point.
    fn sample(&mut self, want: Want) -> Tree {
        let dimensions = self.rng.u8(2..4);
        let shape = self.shape(&Ty::shape(dimensions), Want::new(Rate::Frame, 1));
        Tree::new(Ty::Number, "{}({})", [shape, self.vector(dimensions, want)])
    }

    /// `if c { a } else { b }`
    pub(super) fn conditional(&mut self, ty: &Ty, want: Want) -> Tree {
        let condition = self.bool(want.deeper());
        let half = want.shapes(want.shapes / 2).deeper();
        let parts = [condition, self.value(ty, half), self.value(ty, half)];
        Tree::new(ty.clone(), "(if {} { {} } else { {} })", parts)
    }

    /// `{ let a = ...; value }`
    pub(super) fn block(&mut self, ty: &Ty, want: Want) -> Tree {
        let inner = [Ty::Number, Ty::Vec(3), Ty::Vec(2), Ty::Color, Ty::Bool];
        let inner = self.pick(&inner).cloned().unwrap_or(Ty::Number);
        let name = self.fresh("local");
        let value = self.value(&inner, want.deeper());
        let local = Variable {
            name: name.clone(),
            ty: inner,
            rate: want.rate,
            range: None,
            texts: Vec::new(),
        };
        let result = self.with_names(vec![local], |this| this.value(ty, want.deeper()));
        Tree::new(ty.clone(), &format!("{{ let {name} = {{}}; {{}} }}"), [value, result])
    }

    /// A loop whose state has a type.
    pub(super) fn iterate(&mut self, ty: &Ty, want: Want) -> Tree {
        let count = self.rng.u8(1..24);
        let name = self.fresh("s");
        let state = Variable {
            name: name.clone(),
            ty: ty.clone(),
            rate: Rate::Point,
            range: None,
            texts: Vec::new(),
        };
        let start = self.value(ty, want.deeper());
        let step = self.with_names(vec![state], |this| {
            this.value(ty, Want { rate: Rate::Point.min(want.rate), ..want.deeper() })
        });
        let keep = if *ty == Ty::Number && self.chance(30) {
            format!(", while: fn({name}) = {name} < 3")
        } else {
            String::new()
        };
        // The mean with the state keeps it from growing without limit.
        let format = format!("iterate({count}, {{}}, fn({name}) = 0.5 * ({name} + {{}}){keep})");
        Tree::new(ty.clone(), &format, [start, step])
    }

    pub(super) fn int(&mut self, want: Want) -> Tree {
        let simple = want.depth == 0 || self.chance(60);
        if (simple && self.chance(40))
            && let Some(variable) = self.variable(&Ty::Int, want)
        {
            return variable;
        }
        let [lo, hi] = want.range.unwrap_or([0.0, 6.0]);
        let [lo, hi] = [lo.ceil(), hi.min(lo + 5.0).floor()];
        if simple {
            return literal(Ty::Int, (lo + (hi - lo) * self.rng.f64()).round(), "");
        }
        if want.range.is_some() {
            let computed = self.int(want.deeper());
            return Tree::new(Ty::Int, &format!("clamp({{}}, {lo}, {hi})"), [computed]);
        }
        let want = want.deeper();
        match self.rng.u8(0..4) {
            0 => Tree::new(Ty::Int, "({} + {})", [self.int(want), self.int(want)]),
            1 => Tree::new(Ty::Int, "({} % 3)", [self.int(want)]),
            2 => Tree::new(Ty::Int, "({} * {})", [self.int(want), self.int(want)]),
            _ => self.call_for(&Ty::Int, want),
        }
    }

    pub(super) fn angle(&mut self, want: Want) -> Tree {
        if self.chance(30)
            && let Some(variable) = self.variable(&Ty::Angle, want)
        {
            return variable;
        }
        if want.range.is_some() || want.depth == 0 || self.chance(70) {
            let degrees = self.random(Some(want.range.unwrap_or([-180.0, 180.0])));
            return match self.rng.u8(0..4) {
                0 => literal(Ty::Angle, round(degrees.round() / 360.0), "turn"),
                1 if want.range.is_none() => literal(Ty::Angle, round(degrees.to_radians()), "rad"),
                _ => literal(Ty::Angle, degrees.round(), "deg"),
            };
        }
        let want = want.deeper();
        match self.rng.u8(0..5) {
            0 => Tree::new(Ty::Angle, "({} + {})", [self.angle(want), self.angle(want)]),
            1 => Tree::new(Ty::Angle, "({} * {})", [self.angle(want), self.number(want)]),
            2 => Tree::new(Ty::Angle, "({} * 1rad)", [self.number(want)]),
            3 => Tree::text(Ty::Angle, self.pick(&["pi", "(tau / 6)"]).copied().unwrap_or("pi")),
            _ => self.call_for(&Ty::Angle, want),
        }
    }

    pub(super) fn bool(&mut self, want: Want) -> Tree {
        if self.chance(25)
            && let Some(variable) = self.variable(&Ty::Bool, want)
        {
            return variable;
        }
        if self.chance(10)
            && let Some(comparison) = self.text_comparison(want)
        {
            return comparison;
        }
        if want.depth == 0 {
            return Tree::text(Ty::Bool, if self.rng.bool() { "true" } else { "false" });
        }
        let want = want.deeper();
        match self.rng.u8(0..8) {
            0 => Tree::new(Ty::Bool, "({} && {})", [self.bool(want), self.bool(want)]),
            1 => Tree::new(Ty::Bool, "({} || {})", [self.bool(want), self.bool(want)]),
            2 => Tree::new(Ty::Bool, "!({})", [self.bool(want)]),
            3 => Tree::new(Ty::Bool, "({} % 2 == 0)", [self.int(want)]),
            _ => {
                let sign = self.pick(&["<", "<=", ">", ">=", "!="]).copied().unwrap_or("<");
                let parts = [self.number(want), self.number(want)];
                Tree::new(Ty::Bool, &format!("({{}} {sign} {{}})"), parts)
            }
        }
    }

    /// Compares a string that a user chooses with one of its values.
    fn text_comparison(&mut self, want: Want) -> Option<Tree> {
        let known = |variable: &&Variable| !variable.texts.is_empty() && variable.rate <= want.rate;
        let choices: Vec<Variable> = self.scope.iter().filter(known).cloned().collect();
        let variable = self.pick(&choices)?;
        let text = self.pick(&variable.texts)?;
        Some(Tree::text(Ty::Bool, format!("({} == \"{text}\")", variable.name)))
    }

    /// A list of a type. Fewer than five numbers would be a vector.
    pub(super) fn list(&mut self, of: &Ty, want: Want) -> Tree {
        let ty = Ty::List(Box::new(of.clone()));
        let want = want.deeper();
        if self.chance(25) {
            let (name, count) = (self.fresh("i"), self.rng.u8(5..9));
            let index = Variable {
                name: name.clone(),
                ty: Ty::Int,
                rate: Rate::Const,
                range: Some([0.0, f64::from(count) - 1.0]),
                texts: Vec::new(),
            };
            let item = self.with_names(vec![index], |this| this.value(of, want));
            return Tree::new(ty, &format!("[for {name} in 0..{count}: {{}}]"), [item]);
        }
        let count = self.rng.usize(5..8);
        let elements = (0..count).map(|_| {
            let value = self.value(of, want);
            crate::tree::Element { label: String::new(), optional: true, value }
        });
        let elements = elements.collect();
        Tree::list(ty, "[", Layout::Line, elements, "]")
    }
}

/// A literal with a unit.
pub(super) fn literal(ty: Ty, value: f64, unit: &str) -> Tree {
    Tree::text(ty, format!("{value}{unit}"))
}

/// Returns a range with both ends finite.
pub(super) fn finite([lo, hi]: [f64; 2]) -> [f64; 2] {
    match [lo.is_finite(), hi.is_finite()] {
        [true, false] => [lo, (2.0 * lo).max(lo + REACH)],
        [false, true] => [hi - REACH, hi],
        [true, true] => [lo, hi],
        [false, false] => [-REACH, REACH],
    }
}

/// Returns a number with three digits behind the point.
pub(super) fn round(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}
