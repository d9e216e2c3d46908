//! Checks derived constants and promises with random formulas and points.
//!
//! A field with the derived constant L must not change by more than L times the distance between
//! two points; the field that rays march must not change by more than that distance. `bound` and
//! `exact` are compared with points of the surface, found by bisection.

#![allow(clippy::expect_used, clippy::panic, reason = "a test stops where it fails")]

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use sdfc::{Compiler, Scene};
use sdfc_analyze::{Lipschitz, Promise, Sides};
use sdfc_graph::eval::{FrameValues, Tape};
use sdfc_graph::{Dim, Expander};

/// Random scenes for each property.
const SCENES: u32 = 256;
/// Rounding error of f64 in the slope between two points at least 1e-4 apart.
const ROUNDING: f64 = 1e-6;

/// Returns a formula of a number that depends on the point, from operations that have a constant.
fn number(depth: u32) -> BoxedStrategy<String> {
    let constant = prop::sample::select(vec!["0.5", "1.5", "-2", "k", "(k - 1)", "time"]);
    if depth == 0 {
        let leaf = ["p.x", "p.z", "length(p)", "sphere(0.7)(p)", "circle(0.5)(p.xz)"];
        return prop::sample::select(leaf.to_vec()).prop_map(str::to_owned).boxed();
    }
    let (a, b) = (number(depth - 1), number(depth - 1));
    let v = vector(depth - 1);
    let two = (a.clone(), b).boxed();
    prop_oneof![
        v.clone().prop_map(|v| format!("length({v})")),
        v.clone().prop_map(|v| format!("length({v}.xxx)")),
        v.clone().prop_map(|v| format!("length({v}.zyz)")),
        v.clone().prop_map(|v| format!("dot({v}, [0.5, -1, k])")),
        v.clone().prop_map(|v| format!("{v}.y")),
        v.clone().prop_map(|v| format!("torus()({v})")),
        v.prop_map(|v| format!("box([1, k, 2])({v})")),
        two.clone().prop_map(|(a, b)| format!("min({a}, {b})")),
        two.clone().prop_map(|(a, b)| format!("max({a}, {b})")),
        two.clone().prop_map(|(a, b)| format!("({a} - {b})")),
        two.clone().prop_map(|(a, b)| format!("smooth(0.4)({a}, {b})")),
        two.clone().prop_map(|(a, b)| format!("chamfer(0.4)({a}, {b})")),
        two.clone().prop_map(|(a, b)| format!("mix({a}, {b}, k)")),
        two.clone().prop_map(|(a, b)| format!("length([{a}, {b}])")),
        two.prop_map(|(a, b)| format!("(if k < 1.1 {{ {a} }} else {{ {b} }})")),
        (a.clone(), constant).prop_map(|(a, c)| format!("({a} * {c})")),
        a.clone().prop_map(|a| format!("({a} / (k + 0.5))")),
        a.clone().prop_map(|a| format!("abs({a})")),
        a.clone().prop_map(|a| format!("sin({a})")),
        a.clone().prop_map(|a| format!("atan({a}) / 1rad")),
        a.clone().prop_map(|a| format!("saturate({a})")),
        a.clone().prop_map(|a| format!("clamp({a}, 1, k)")),
        a.prop_map(|a| format!("length(vec3({a}))")),
    ]
    .boxed()
}

/// Returns a formula of a vector that depends on the point.
fn vector(depth: u32) -> BoxedStrategy<String> {
    if depth == 0 {
        let leaf = ["p", "(p - [1, k, 0])", "p.zxy", "(p * 2)", "[p.x, p.z, -p.y]"];
        return prop::sample::select(leaf.to_vec()).prop_map(str::to_owned).boxed();
    }
    let (v, w, a) = (vector(depth - 1), vector(depth - 1), number(depth - 1));
    prop_oneof![
        v.clone().prop_map(|v| format!("abs({v})")),
        v.clone().prop_map(|v| format!("sin({v})")),
        v.clone().prop_map(|v| format!("{v}.yyz")),
        v.clone().prop_map(|v| format!("({v} * [0.5, k, -2])")),
        v.clone().prop_map(|v| format!("({v} / [k, 0.5, 3])")),
        v.clone().prop_map(|v| format!("cross([1, 0.5, k], {v})")),
        v.clone().prop_map(|v| format!("vec3(spin({v}.xz, k * 1rad), {v}.x)")),
        v.clone().prop_map(|v| format!("clamp({v}, -0.5, k)")),
        (v.clone(), w.clone()).prop_map(|(v, w)| format!("min({v}, {w})")),
        (v.clone(), w.clone()).prop_map(|(v, w)| format!("mix({v}, {w}, k)")),
        (v, w).prop_map(|(v, w)| format!("({v} + {w})")),
        a.clone().prop_map(|a| format!("[{a}, p.y, abs(p.z)]")),
        a.clone().prop_map(|a| format!("[abs(p.x) * 2, {a}, sin(p.x)]")),
        a.prop_map(|a| format!("vec3({a})")),
    ]
    .boxed()
}

fn scene(text: &str) -> Scene {
    let compiled = Compiler::new().compile("random.sdf", text);
    compiled.unwrap_or_else(|errors| panic!("{text}\n{errors}"))
}

fn runner() -> TestRunner {
    let config = Config { cases: SCENES, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

/// Returns the field as it is written, undivided, and the one that rays march.
fn fields(scene: &Scene) -> [Tape; 2] {
    let mut graph = scene.graph().graph.clone();
    let point = graph.point(0, Dim::Three);
    let root = scene.graph().root.expect("something is drawn");
    let plain = Expander::new().field(&mut graph, root, point).expect("it expands");
    let marched = scene.program().distance.expect("something is drawn");
    [(&graph, plain), (&scene.program().graph, marched)]
        .map(|(graph, root)| Tape::new(graph, &[root]).expect("it is flat"))
}

/// Returns the largest slope between pairs of points, near and far.
fn steepest(tape: &Tape, frame: &FrameValues) -> f64 {
    let mut field = tape.prepare::<f64>(frame);
    let mut random = Random(3);
    let mut steepest = 0.0f64;
    for pair in 0..400 {
        let p = random.point([0.1, 1.0, 4.0][pair % 3]);
        let offset = random.point([1e-2, 1.0][pair % 2]);
        let apart = length(offset);
        if apart > 1e-4 {
            let change = field.scalar(p) - field.scalar(plus(p, offset, 1.0));
            steepest = steepest.max(change.abs() / apart);
        }
    }
    steepest
}

#[test]
fn no_random_field_is_steeper_than_its_constant() {
    let formulas = (number(3), 0..3usize);
    let check = |(formula, at): (String, usize)| {
        let text = format!("param k = 1 in 0.25..2\nsolid odd() = {formula}\nodd()");
        let scene = scene(&text);
        let mut frame = FrameValues::defaults(scene.params());
        frame.params[0][0] = [0.25, 1.0, 2.0][at];
        frame.time = 0.7;
        let [plain, marched] = fields(&scene);
        let report = scene.report();
        prop_assert!(report.uncertified.is_empty(), "{text}\n{:?}", report.uncertified);
        let slope = steepest(&marched, &frame);
        prop_assert!(slope <= 1.0 + ROUNDING, "{text}\nmarched slope {slope}");
        if let Some(Lipschitz::Number(constant)) = report.shapes.last().map(|s| &s.lipschitz) {
            let slope = steepest(&plain, &frame);
            prop_assert!(slope <= constant + ROUNDING, "{text}\nslope {slope} above {constant}");
        }
        Ok(())
    };
    if let Err(error) = runner().run(&formulas, check) {
        panic!("{error}");
    }
}

/// Composed shapes with the promises that must be derived, outside and inside.
const COMPOSED: &[(&str, Promise, Promise)] = &[
    ("sphere(0.7).translate(x: 0.4).rotate(z: 30deg)", Promise::Exact, Promise::Exact),
    ("box([1, 0.6, 0.8]).scale(0.7).rotate(x: 20deg, y: 50deg)", Promise::Exact, Promise::Exact),
    ("box([1, 0.6, 0.8]) | sphere(0.5).translate(y: 0.4)", Promise::Exact, Promise::Bound),
    ("box([1, 0.6, 0.8]) & sphere(0.5)", Promise::Bound, Promise::Exact),
    ("box([1, 0.6, 0.8]) - sphere(0.5)", Promise::Bound, Promise::Exact),
    ("torus(major: 0.7, minor: 0.2).round(0.1)", Promise::Exact, Promise::Bound),
    ("(box([1, 0.6, 0.8]) | sphere(0.5)).round(0.1)", Promise::Exact, Promise::Bound),
    (
        "(box([1, 0.6, 0.8]) | sphere(0.5)).round(k - 0.4).round(0.1)",
        Promise::Exact,
        Promise::Bound,
    ),
    ("union(box(0.8), sphere(0.5), blend: smooth(0.3))", Promise::Bound, Promise::Bound),
    ("ellipsoid([0.9, 0.3, 0.5]).rotate(x: 40deg)", Promise::Bound, Promise::Bound),
    ("ellipsoid_fast([0.9, 0.3, 0.5])", Promise::Bound, Promise::Bound),
    ("guess()", Promise::Bound, Promise::None),
    ("hollow(guess())", Promise::None, Promise::Bound),
    ("shrunk(box(1))", Promise::Exact, Promise::Exact),
    ("rect([1, 0.5]).extrude(0.4).translate(y: 0.3)", Promise::Exact, Promise::Exact),
    ("box(1).scale(k)", Promise::Exact, Promise::Exact),
];
/// Definitions of the scenes. A negative factor turns a shape inside out; two of them cancel. The
/// first-order estimate of an ellipsoid is a bound on one side only.
const OWN: &str = "param k = 0.8 in 0.5..1
solid guess(r: vec3 = [0.9, 0.3, 0.5])
  bound outside
  bounds -r..r
  = length(p / r) * (length(p / r) - 1) / length(p / (r * r))
solid hollow(a: solid) = -2 * a(p / -2)
solid shrunk(a: solid) = -0.5 * -a(p / -0.5)
";

#[test]
fn derived_promises_hold() {
    for &(text, outside, inside) in COMPOSED {
        let scene = scene(&format!("{OWN}{text}"));
        let sides = scene.report().shapes.last().expect("a shape").sides;
        assert_eq!(sides, Sides { outside, inside }, "{text}");
        let [plain, _] = fields(&scene);
        let frame = FrameValues::defaults(scene.params());
        let mut field = plain.prepare::<f64>(&frame);
        let mut f = |p| field.scalar(p);
        let surface = surface_points(&mut f);
        assert!(surface.len() > 2_000, "{text}: {} surface points", surface.len());
        let mut random = Random(11);
        let mut astray = 0;
        for _ in 0..400 {
            let p = random.point(1.5);
            let value = f(p);
            let promise = if value > 0.0 { outside } else { inside };
            if promise >= Promise::Bound {
                let to = |s: &[f64; 3]| length(plus(*s, p, -1.0));
                let nearest = surface.iter().map(to).fold(f64::INFINITY, f64::min);
                assert!(value.abs() <= nearest + 1e-6, "{text} at {p:?}: {value}, {nearest} away");
            }
            // The surface lies at the distance down the gradient, except where the gradient is
            // discontinuous.
            if promise == Promise::Exact {
                let foot = plus(p, gradient(&mut f, p), -value);
                astray += u32::from(f(foot).abs() > 1e-4);
            }
        }
        assert!(astray <= 8, "{text}: {astray} of 400 points are not at the distance they state");
    }
}

/// Returns the zeros on random chords of the ball of radius 2.5 about the origin.
fn surface_points(f: &mut impl FnMut([f64; 3]) -> f64) -> Vec<[f64; 3]> {
    let mut random = Random(5);
    let mut points = Vec::new();
    for _ in 0..40_000 {
        let (start, end) = (random.point(2.5), random.point(2.5));
        let at = |t: f64| std::array::from_fn(|i| start[i] + t * (end[i] - start[i]));
        let mut before = f(at(0.0));
        for step in 1..=60 {
            let t = f64::from(step) / 60.0;
            let here = f(at(t));
            if (before > 0.0) != (here > 0.0) {
                points.push(at(bisected(|t| f(at(t)), [t - 1.0 / 60.0, t])));
            }
            before = here;
        }
    }
    points
}

fn bisected(mut f: impl FnMut(f64) -> f64, [mut lo, mut hi]: [f64; 2]) -> f64 {
    let positive = f(lo) > 0.0;
    for _ in 0..40 {
        let middle = (lo + hi) / 2.0;
        if (f(middle) > 0.0) == positive { lo = middle } else { hi = middle }
    }
    (lo + hi) / 2.0
}

fn gradient(f: &mut impl FnMut([f64; 3]) -> f64, p: [f64; 3]) -> [f64; 3] {
    const H: f64 = 1e-6;
    std::array::from_fn(|axis| {
        let mut unit = [0.0; 3];
        unit[axis] = 1.0;
        (f(plus(p, unit, H)) - f(plus(p, unit, -H))) / (2.0 * H)
    })
}

fn plus(p: [f64; 3], q: [f64; 3], factor: f64) -> [f64; 3] {
    std::array::from_fn(|i| p[i] + factor * q[i])
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Xorshift64* (Vigna 2016), for repeatable points.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self, reach: f64) -> [f64; 3] {
        std::array::from_fn(|_| reach * (2.0 * self.unit() - 1.0))
    }
}
