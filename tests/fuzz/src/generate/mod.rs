//! Random programs that the checker accepts.
//!
//! A program is generated from types: every part is asked for a value of a type, at an evaluation
//! rate, within a range. So it has no error that can be seen without computing values. What
//! depends on values, such as `require` of the library, is repaired afterwards ([`crate::repair`]).

mod numbers;
mod shapes;
mod statements;
mod vectors;

use fastrand::Rng;

use crate::catalogue::{Callable, Catalogue};
use crate::tree::{Layout, Program, Tree};
use crate::types::Ty;

/// The most shapes that a program asks for. Comprehensions make more of them.
const MOST_SHAPES: f64 = 300.0;
/// The number of levels that calculations nest.
const DEPTH: usize = 3;

/// The rate at which a value is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rate {
    /// When the scene compiles.
    Const,
    /// Once per frame.
    Frame,
    /// At every point.
    Point,
}

/// A name that a value can use.
#[derive(Clone, Debug)]
struct Variable {
    name: String,
    ty: Ty,
    rate: Rate,
    /// The least and the greatest value, if known; in degrees for an angle.
    range: Option<[f64; 2]>,
    /// The values of a string.
    texts: Vec<String>,
}

/// The demands of a place on its value.
#[derive(Clone, Copy, Debug)]
struct Want {
    /// The value is computed at this rate or an earlier one.
    rate: Rate,
    /// The least and the greatest value; in degrees for an angle.
    range: Option<[f64; 2]>,
    /// About how many shapes it has.
    shapes: usize,
    /// The number of levels that it may nest calculations.
    depth: usize,
}

impl Want {
    fn new(rate: Rate, shapes: usize) -> Self {
        Self { rate, range: None, shapes, depth: DEPTH }
    }

    fn within(self, range: Option<[f64; 2]>) -> Self {
        Self { range, ..self }
    }

    /// The same for a part of a calculation.
    fn deeper(self) -> Self {
        Self { range: None, depth: self.depth.saturating_sub(1), ..self }
    }

    fn shapes(self, shapes: usize) -> Self {
        Self { shapes, ..self }
    }
}

/// Generates the program of a seed.
pub fn generate(catalogue: &Catalogue, seed: u64) -> Program {
    let rng = Rng::with_seed(seed);
    let mut generator =
        Generator { catalogue, rng, declared: Vec::new(), scope: Vec::new(), names: 0 };
    generator.program()
}

/// The state while one program is generated.
struct Generator<'c> {
    catalogue: &'c Catalogue,
    rng: Rng,
    /// The functions and shapes that the program declares.
    declared: Vec<Callable>,
    /// The names that are visible.
    scope: Vec<Variable>,
    /// The number of names that were made.
    names: usize,
}

impl Generator<'_> {
    fn program(&mut self) -> Program {
        // Half of the programs ask for at most four shapes: small programs are judged quickly.
        let shapes = MOST_SHAPES.powf(self.rng.f64().powi(2)).round() as usize;
        Program { statements: self.statements(shapes) }
    }

    /// Returns true in some of a hundred cases.
    fn chance(&mut self, percent: u8) -> bool {
        self.rng.u8(0..100) < percent
    }

    fn pick<'t, T>(&mut self, from: &'t [T]) -> Option<&'t T> {
        if from.is_empty() { None } else { from.get(self.rng.usize(0..from.len())) }
    }

    fn fresh(&mut self, start: &str) -> String {
        self.names += 1;
        format!("{start}{}", self.names)
    }

    fn layout(&mut self) -> Layout {
        match self.rng.u8(0..40) {
            0 => Layout::Comments,
            1 | 2 => Layout::Lines,
            _ => Layout::Line,
        }
    }

    /// Generates with more names in scope.
    fn with_names<T>(&mut self, names: Vec<Variable>, make: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.scope.len();
        self.scope.extend(names);
        let made = make(self);
        self.scope.truncate(before);
        made
    }

    /// Returns a name of a type that is known early enough and lies in the range.
    fn variable(&mut self, ty: &Ty, want: Want) -> Option<Tree> {
        let fits = |variable: &&Variable| {
            variable.ty == *ty
                && variable.rate <= want.rate
                && is_within(variable.range, want.range)
        };
        let fitting: Vec<String> =
            self.scope.iter().filter(fits).map(|variable| variable.name.clone()).collect();
        self.pick(&fitting).map(|name| Tree::text(ty.clone(), name))
    }

    /// Returns the callables that fit.
    fn callables(&self, fits: impl Fn(&Callable) -> bool) -> Vec<Callable> {
        let all = self.catalogue.functions.iter().chain(&self.declared);
        all.filter(|callable| fits(callable)).cloned().collect()
    }

    /// Generates a value of a type.
    fn value(&mut self, ty: &Ty, want: Want) -> Tree {
        match ty {
            Ty::Number => self.number(want),
            Ty::Int => self.int(want),
            Ty::Angle => self.angle(want),
            Ty::Bool => self.bool(want),
            Ty::Vec(width) => self.vector(*width, want),
            Ty::Color => self.color(want),
            Ty::Solid | Ty::Region => self.shape(ty, want),
            Ty::Material => self.material(want),
            Ty::List(of) => self.list(of, want),
            Ty::Fn(parameters, result) => self.function(ty, parameters, result, want),
            Ty::Shadow => self.shadow(),
            // A string is chosen by the name of its parameter, and a statement has no value.
            Ty::Text | Ty::Statement => Tree::text(ty.clone(), "\"sans\""),
        }
    }
}

/// Returns true if all values of one range are in another. No range at all holds everything.
fn is_within(inner: Option<[f64; 2]>, outer: Option<[f64; 2]>) -> bool {
    match (inner, outer) {
        (_, None) => true,
        (None, Some(_)) => false,
        (Some([lo, hi]), Some([least, most])) => least <= lo && hi <= most,
    }
}
