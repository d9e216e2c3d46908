//! Each scalar operation: values found by hand, derivatives compared with differences, f32 compared
//! with f64 within the accuracy that WGSL requires of a device, and intervals in difficult cases.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LN_2, PI};

use sdfc_graph::eval::{Dual, FrameValues, Interval, Number, Tape};
use sdfc_graph::{Dim, Graph, NodeId, Type, Unary};

type One<N> = fn(N) -> N;
type Two<N> = fn(N, N) -> N;
type Three<N> = fn(N, N, N) -> N;

/// Operation in f64 and in f32, arguments, result.
type OneRow = (&'static str, One<f64>, One<f32>, f64, f64);
type TwoRow = (&'static str, Two<f64>, Two<f32>, [f64; 2], f64);
type ThreeRow = (&'static str, Three<f64>, Three<f32>, [f64; 3], f64);
type AccuracyRow = (&'static str, One<f32>, One<f64>, [f64; 2], Accuracy);

const INF: f64 = f64::INFINITY;

/// Cases whose results are exact in f32 too.
const ONE: &[OneRow] = &[
    ("neg", Number::neg, Number::neg, 2.5, -2.5),
    ("abs", Number::abs, Number::abs, -2.5, 2.5),
    ("sign", Number::sign, Number::sign, -0.25, -1.0),
    ("sign", Number::sign, Number::sign, 0.0, 0.0),
    ("sign", Number::sign, Number::sign, 7.0, 1.0),
    ("floor", Number::floor, Number::floor, -1.5, -2.0),
    ("ceil", Number::ceil, Number::ceil, -1.5, -1.0),
    ("round", Number::round, Number::round, 0.5, 0.0),
    ("round", Number::round, Number::round, 1.5, 2.0),
    ("round", Number::round, Number::round, 2.5, 2.0),
    ("round", Number::round, Number::round, -2.5, -2.0),
    ("trunc", Number::trunc, Number::trunc, -1.5, -1.0),
    ("fract", Number::fract, Number::fract, -1.25, 0.75),
    ("square", Number::square, Number::square, -3.0, 9.0),
    ("sqrt", Number::sqrt, Number::sqrt, 6.25, 2.5),
    ("sqrt", Number::sqrt, Number::sqrt, -1.0, f64::NAN),
    ("inverse_sqrt", Number::inverse_sqrt, Number::inverse_sqrt, 4.0, 0.5),
    ("exp", Number::exp, Number::exp, 0.0, 1.0),
    ("exp2", Number::exp2, Number::exp2, -3.0, 0.125),
    ("log", Number::log, Number::log, 1.0, 0.0),
    ("log", Number::log, Number::log, 0.0, -INF),
    ("log2", Number::log2, Number::log2, 8.0, 3.0),
    ("log2", Number::log2, Number::log2, -8.0, f64::NAN),
    ("sin", Number::sin, Number::sin, 0.0, 0.0),
    ("cos", Number::cos, Number::cos, 0.0, 1.0),
    ("tan", Number::tan, Number::tan, 0.0, 0.0),
    ("asin", Number::asin, Number::asin, 1.5, f64::NAN),
    ("acos", Number::acos, Number::acos, 1.0, 0.0),
    ("acos", Number::acos, Number::acos, -1.5, f64::NAN),
    ("atan", Number::atan, Number::atan, 0.0, 0.0),
    ("sinh", Number::sinh, Number::sinh, 0.0, 0.0),
    ("cosh", Number::cosh, Number::cosh, 0.0, 1.0),
    ("tanh", Number::tanh, Number::tanh, 40.0, 1.0),
    ("saturate", Number::saturate, Number::saturate, -0.5, 0.0),
    ("saturate", Number::saturate, Number::saturate, 0.5, 0.5),
    ("saturate", Number::saturate, Number::saturate, 1.5, 1.0),
    ("not", Number::not, Number::not, 0.0, 1.0),
    ("not", Number::not, Number::not, 1.0, 0.0),
];

const TWO: &[TwoRow] = &[
    ("add", Number::add, Number::add, [1.5, 2.0], 3.5),
    ("sub", Number::sub, Number::sub, [1.5, 2.0], -0.5),
    ("mul", Number::mul, Number::mul, [1.5, -2.0], -3.0),
    ("div", Number::div, Number::div, [1.5, -2.0], -0.75),
    ("rem", Number::rem, Number::rem, [5.5, 2.0], 1.5),
    ("rem", Number::rem, Number::rem, [-0.5, 2.0], 1.5),
    ("rem", Number::rem, Number::rem, [0.5, -2.0], -1.5),
    ("rem", Number::rem, Number::rem, [-5.5, -2.0], -1.5),
    ("rem", Number::rem, Number::rem, [-4.0, 2.0], 0.0),
    ("min", Number::min, Number::min, [1.0, 2.0], 1.0),
    ("min", Number::min, Number::min, [1.0, f64::NAN], 1.0),
    ("max", Number::max, Number::max, [1.0, 2.0], 2.0),
    ("max", Number::max, Number::max, [1.0, -INF], 1.0),
    ("pow", Number::pow, Number::pow, [4.0, 1.5], 8.0),
    ("pow", Number::pow, Number::pow, [4.0, -0.5], 0.5),
    ("pow", Number::pow, Number::pow, [-2.0, 2.0], f64::NAN),
    ("pow", Number::pow, Number::pow, [0.0, 2.0], 0.0),
    ("pow", Number::pow, Number::pow, [-0.0, -1.0], INF),
    ("atan2", Number::atan2, Number::atan2, [0.0, 2.0], 0.0),
    ("atan2", Number::atan2, Number::atan2, [-0.0, -0.0], 0.0),
    ("step", Number::step, Number::step, [1.0, 0.5], 0.0),
    ("step", Number::step, Number::step, [1.0, 1.0], 1.0),
    // Computed by a separate program.
    ("hash", Number::hash, Number::hash, [0.0, 0.0], 506_671.0),
    ("hash", Number::hash, Number::hash, [0.0, 0.9], 506_671.0),
    ("hash", Number::hash, Number::hash, [0.0, -0.5], 15_084_105.0),
    ("hash", Number::hash, Number::hash, [16777215.0, 7.0], 13_429_413.0),
    ("hash", Number::hash, Number::hash, [3.0, -1e30], 14_048_042.0),
    ("hash", Number::hash, Number::hash, [3.0, 1e30], 7_598.0),
    ("hash", Number::hash, Number::hash, [3.0, 2_147_483_520.0], 7_598.0),
    ("normalize_lane", Number::normalize_lane, Number::normalize_lane, [3.0, 4.0], 0.75),
    ("normalize_lane", Number::normalize_lane, Number::normalize_lane, [0.0, 0.0], 0.0),
    ("lt", Number::lt, Number::lt, [1.0, 1.0], 0.0),
    ("lt", Number::lt, Number::lt, [1.0, 2.0], 1.0),
    ("le", Number::le, Number::le, [1.0, 1.0], 1.0),
    ("le", Number::le, Number::le, [2.0, 1.0], 0.0),
    ("eq", Number::eq, Number::eq, [1.0, 1.0], 1.0),
    ("eq", Number::eq, Number::eq, [1.0, 2.0], 0.0),
    ("ne", Number::ne, Number::ne, [1.0, 1.0], 0.0),
    ("ne", Number::ne, Number::ne, [1.0, 2.0], 1.0),
    ("and", Number::and, Number::and, [1.0, 0.0], 0.0),
    ("and", Number::and, Number::and, [1.0, 1.0], 1.0),
    ("or", Number::or, Number::or, [0.0, 1.0], 1.0),
    ("or", Number::or, Number::or, [0.0, 0.0], 0.0),
];

const THREE: &[ThreeRow] = &[
    ("mix", Number::mix, Number::mix, [2.0, 6.0, 0.25], 3.0),
    ("mix", Number::mix, Number::mix, [2.0, 6.0, 1.0], 6.0),
    ("clamp", Number::clamp, Number::clamp, [-3.0, -1.0, 2.0], -1.0),
    ("clamp", Number::clamp, Number::clamp, [3.0, -1.0, 2.0], 2.0),
    ("smoothstep", Number::smoothstep, Number::smoothstep, [1.0, 3.0, 2.0], 0.5),
    ("smoothstep", Number::smoothstep, Number::smoothstep, [1.0, 3.0, 1.5], 0.15625),
    ("smoothstep", Number::smoothstep, Number::smoothstep, [1.0, 1.0, 0.0], 0.0),
    ("smoothstep", Number::smoothstep, Number::smoothstep, [1.0, 1.0, 2.0], 1.0),
    ("select", Number::select, Number::select, [1.0, 5.0, 6.0], 5.0),
    ("select", Number::select, Number::select, [0.0, 5.0, 6.0], 6.0),
];

#[track_caller]
fn assert_same(name: &str, arguments: &[f64], found: [f64; 2], expected: f64) {
    for found in found {
        let same = found == expected || (found.is_nan() && expected.is_nan());
        assert!(same, "{name} of {arguments:?} is {found}, expected {expected}");
    }
}

#[test]
fn operations_have_the_values_found_by_hand() {
    for &(name, wide, narrow, x, expected) in ONE {
        let found = [wide(x), f64::from(narrow(x as f32))];
        assert_same(name, &[x], found, expected);
    }
    for &(name, wide, narrow, [x, y], expected) in TWO {
        let found = [wide(x, y), f64::from(narrow(x as f32, y as f32))];
        assert_same(name, &[x, y], found, expected);
    }
    for &(name, wide, narrow, [x, y, z], expected) in THREE {
        let found = [wide(x, y, z), f64::from(narrow(x as f32, y as f32, z as f32))];
        assert_same(name, &[x, y, z], found, expected);
    }
}

#[test]
fn angles_and_logarithms_have_their_known_values() {
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 1e-15, "{found}, expected {expected}");
    };
    near(Number::sin(FRAC_PI_2), 1.0);
    near(Number::cos(PI), -1.0);
    near(Number::tan(FRAC_PI_4), 1.0);
    near(Number::asin(1.0), FRAC_PI_2);
    near(Number::acos(-1.0), PI);
    near(Number::atan(1.0), FRAC_PI_4);
    near(Number::atan2(1.0, -1.0), 3.0 * FRAC_PI_4);
    near(Number::atan2(-1.0, -1.0), -3.0 * FRAC_PI_4);
    near(Number::atan2(-0.0, -1.0), PI);
    near(Number::log(2.0), LN_2);
    near(Number::exp(LN_2), 2.0);
    near(Number::sinh(LN_2), 0.75);
    near(Number::cosh(LN_2), 1.25);
    near(Number::tanh(LN_2), 0.6);
}

fn variable(value: f64) -> Dual {
    Dual { value, partials: [1.0, 0.0, 0.0] }
}

/// The derivative of `f` by central differences. At x of size 1, `h = 1e-6` leaves about `1e-10` of
/// truncation and of rounding error.
fn difference(f: impl Fn(f64) -> f64, x: f64) -> f64 {
    let h = 1e-6;
    (f(x + h) - f(x - h)) / (2.0 * h)
}

#[track_caller]
fn assert_slope(name: &str, x: f64, dual: Dual, value: f64, slope: f64) {
    assert_eq!(dual.value, value, "{name} at {x}");
    let found = dual.partials[0];
    let error = (found - slope).abs();
    assert!(error <= 1e-7 * slope.abs().max(1.0), "{name}' at {x} is {found}, expected {slope}");
}

#[test]
fn derivatives_agree_with_differences_away_from_kinks() {
    let one: &[(&str, One<Dual>, One<f64>)] = &[
        ("neg", Number::neg, Number::neg),
        ("abs", Number::abs, Number::abs),
        ("sign", Number::sign, Number::sign),
        ("floor", Number::floor, Number::floor),
        ("ceil", Number::ceil, Number::ceil),
        ("round", Number::round, Number::round),
        ("trunc", Number::trunc, Number::trunc),
        ("fract", Number::fract, Number::fract),
        ("square", Number::square, Number::square),
        ("sqrt", Number::sqrt, Number::sqrt),
        ("inverse_sqrt", Number::inverse_sqrt, Number::inverse_sqrt),
        ("exp", Number::exp, Number::exp),
        ("exp2", Number::exp2, Number::exp2),
        ("log", Number::log, Number::log),
        ("log2", Number::log2, Number::log2),
        ("sin", Number::sin, Number::sin),
        ("cos", Number::cos, Number::cos),
        ("tan", Number::tan, Number::tan),
        ("asin", Number::asin, Number::asin),
        ("acos", Number::acos, Number::acos),
        ("atan", Number::atan, Number::atan),
        ("sinh", Number::sinh, Number::sinh),
        ("cosh", Number::cosh, Number::cosh),
        ("tanh", Number::tanh, Number::tanh),
    ];
    for &(name, dual, plain) in one {
        for x in [-0.7, 0.3, 0.6, 0.85] {
            if plain(x).is_finite() {
                assert_slope(name, x, dual(variable(x)), plain(x), difference(plain, x));
            }
        }
    }
    let two: &[(&str, Two<Dual>, Two<f64>)] = &[
        ("add", Number::add, Number::add),
        ("sub", Number::sub, Number::sub),
        ("mul", Number::mul, Number::mul),
        ("div", Number::div, Number::div),
        ("rem", Number::rem, Number::rem),
        ("min", Number::min, Number::min),
        ("max", Number::max, Number::max),
        ("pow", Number::pow, Number::pow),
        ("atan2", Number::atan2, Number::atan2),
        ("step", Number::step, Number::step),
        ("normalize_lane", Number::normalize_lane, Number::normalize_lane),
    ];
    for &(name, dual, plain) in two {
        for (x, y) in [(0.7, 1.3), (2.3, 0.4), (0.2, -0.9)] {
            // Both arguments vary, the second at twice the speed.
            let along = |t: f64| plain(x + t, y + 2.0 * t);
            let second = Dual { value: y, partials: [2.0, 0.0, 0.0] };
            assert_slope(name, x, dual(variable(x), second), plain(x, y), difference(along, 0.0));
        }
    }
    let three: &[(&str, Three<Dual>, Three<f64>)] = &[
        ("mix", Number::mix, Number::mix),
        ("clamp", Number::clamp, Number::clamp),
        ("smoothstep", Number::smoothstep, Number::smoothstep),
    ];
    for &(name, dual, plain) in three {
        for (x, y, z) in [(0.2, 1.1, 0.6), (-0.5, 0.4, 0.1), (0.3, 2.0, 0.9)] {
            let along = |t: f64| plain(x + t, y + 2.0 * t, z - t);
            let part = |value: f64, speed: f64| Dual { value, partials: [speed, 0.0, 0.0] };
            let found = dual(part(x, 1.0), part(y, 2.0), part(z, -1.0));
            assert_slope(name, x, found, plain(x, y, z), difference(along, 0.0));
        }
    }
}

#[test]
fn derivatives_at_kinks_follow_the_documented_rules() {
    let at = |value: f64, speed: f64| Dual { value, partials: [speed, 0.0, 0.0] };
    let zero = at(0.0, 0.0);
    assert_eq!(at(0.0, 1.0).abs().partials[0], 1.0);
    assert_eq!(at(0.0, 1.0).sqrt().partials[0], 0.0);
    assert_eq!(at(1.0, 3.0).min(at(1.0, 5.0)).partials[0], 3.0);
    assert_eq!(at(1.0, 3.0).max(at(1.0, 5.0)).partials[0], 3.0);
    assert_eq!(at(0.0, 3.0).saturate().partials[0], 3.0);
    assert_eq!(at(2.0, 1.0).floor().partials[0], 0.0);
    assert_eq!(at(0.0, 1.0).atan2(zero).partials[0], 0.0);
    assert_eq!(at(0.0, 1.0).normalize_lane(zero).partials[0], 0.0);
    assert_eq!(at(1.0, 0.0).asin().partials[0], 0.0, "an infinite slope of what stands still");
}

#[test]
fn the_zero_vector_has_direction_zero() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let (length, unit) = (graph.length(p), graph.unary(Unary::Normalize, p));
    let tape = Tape::new(&graph, &[length, unit]).unwrap();
    let frame = FrameValues::default();
    let values = tape.prepare::<Dual>(&frame).eval(Dual::point([0.0; 3])).to_vec();
    assert!(values.iter().flatten().all(|lane| *lane == Dual::constant(0.0)), "{values:?}");
    let side = tape.prepare::<f64>(&frame).eval([3.0, 0.0, 4.0]).to_vec();
    assert_eq!(side, [[5.0, 0.0, 0.0, 0.0], [0.6, 0.0, 0.8, 0.0]]);
}

/// Allowed error of f32: units in the last place, and an absolute error.
/// <https://www.w3.org/TR/WGSL/#concrete-float-accuracy>
#[derive(Clone, Copy)]
struct Accuracy {
    ulps: fn(f64) -> f64,
    absolute: f64,
}

const EXACT: Accuracy = Accuracy { ulps: |_| 0.0, absolute: 0.0 };

const fn ulps(ulps: fn(f64) -> f64) -> Accuracy {
    Accuracy { ulps, absolute: 0.0 }
}

const fn absolute(absolute: f64) -> Accuracy {
    Accuracy { ulps: |_| 0.0, absolute }
}

#[test]
fn f32_is_as_accurate_as_wgsl_requires() {
    let table: &[AccuracyRow] = &[
        ("floor", Number::floor, Number::floor, [-1e3, 1e3], EXACT),
        ("ceil", Number::ceil, Number::ceil, [-1e3, 1e3], EXACT),
        ("round", Number::round, Number::round, [-1e3, 1e3], EXACT),
        ("trunc", Number::trunc, Number::trunc, [-1e3, 1e3], EXACT),
        ("fract", Number::fract, Number::fract, [-1e3, 1e3], ulps(|_| 1.0)),
        ("square", Number::square, Number::square, [-1e3, 1e3], ulps(|_| 0.5)),
        ("sqrt", Number::sqrt, Number::sqrt, [0.0, 1e6], ulps(|_| 4.5)), // 1 / inverseSqrt
        ("inverse_sqrt", Number::inverse_sqrt, Number::inverse_sqrt, [1e-6, 1e6], ulps(|_| 2.0)),
        ("exp", Number::exp, Number::exp, [-80.0, 80.0], ulps(|x| 3.0 + 2.0 * x.abs())),
        ("exp2", Number::exp2, Number::exp2, [-120.0, 120.0], ulps(|x| 3.0 + 2.0 * x.abs())),
        ("log", Number::log, Number::log, [2.0, 1e6], ulps(|_| 3.0)),
        ("log near 1", Number::log, Number::log, [0.5, 2.0], absolute(4.8e-7)), // 2^-21
        ("log2", Number::log2, Number::log2, [2.0, 1e6], ulps(|_| 3.0)),
        ("sin", Number::sin, Number::sin, [-PI, PI], absolute(4.9e-4)), // 2^-11
        ("cos", Number::cos, Number::cos, [-PI, PI], absolute(4.9e-4)),
        ("asin", Number::asin, Number::asin, [-1.0, 1.0], ulps(|_| 4096.0)),
        ("acos", Number::acos, Number::acos, [-1.0, 0.99], ulps(|_| 4096.0)),
        ("atan", Number::atan, Number::atan, [-1e3, 1e3], ulps(|_| 4096.0)),
        ("tanh", Number::tanh, Number::tanh, [-9.0, 9.0], absolute(1e-5)),
    ];
    for &(name, narrow, wide, [lo, hi], accuracy) in table {
        for i in 0..=1000 {
            let x = (lo + (hi - lo) * f64::from(i) / 1000.0) as f32;
            let (found, expected) = (f64::from(narrow(x)), wide(f64::from(x)));
            let unit =
                f64::from((expected as f32).abs().next_up()) - f64::from((expected as f32).abs());
            let allowed = (accuracy.ulps)(f64::from(x)) * unit + accuracy.absolute;
            let error = (found - expected).abs();
            assert!(error <= allowed, "{name}({x}) is {found}, {error} from {expected}");
        }
    }
}

#[track_caller]
fn assert_range(found: Interval, [lo, hi]: [f64; 2]) {
    let near = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-12;
    let holds = found.lo() <= lo && found.hi() >= hi;
    assert!(holds && near(found.lo(), lo) && near(found.hi(), hi), "{found:?}, not {lo}..{hi}");
}

#[test]
fn intervals_are_tight_in_difficult_cases() {
    let range = Interval::new;
    assert_range(range(-2.0, 3.0).square(), [0.0, 9.0]);
    assert_range(range(-2.0, 3.0).mul(range(-1.0, 4.0)), [-8.0, 12.0]);
    assert_range(range(1.0, 2.0).div(range(0.0, 4.0)), [0.25, INF]);
    assert_range(range(1.0, 2.0).div(range(-4.0, 0.0)), [-INF, -0.25]);
    assert_range(range(1.0, 2.0).div(range(-1.0, 1.0)), [-INF, INF]);
    assert_range(range(-4.0, 9.0).sqrt(), [0.0, 3.0]);
    assert_range(range(-4.0, -1.0).sqrt(), [-INF, INF]);
    assert_range(range(-1.0, 1.0).log(), [-INF, 0.0]);
    assert_range(range(0.5, 3.0).acos(), [0.0, PI / 3.0]);
    assert_range(range(0.1, 1.0).sin(), [0.1_f64.sin(), 1.0_f64.sin()]);
    assert_range(range(1.0, 2.0).sin(), [1.0_f64.sin(), 1.0]);
    assert_range(range(3.0, 10.0).cos(), [-1.0, 1.0]);
    assert_range(range(1.5, 1.6).tan(), [-INF, INF]);
    assert_range(range(5.25, 5.5).rem(range(2.0, 2.0)), [1.25, 1.5]);
    assert_range(range(5.0, 7.0).rem(range(2.0, 2.0)), [0.0, 2.0]);
    assert_range(range(1.25, 1.5).fract(), [0.25, 0.5]);
    assert_range(range(0.75, 1.25).fract(), [0.0, 1.0]);
    assert_range(range(-1.0, 1.0).atan2(range(1.0, 2.0)), [-FRAC_PI_4, FRAC_PI_4]);
    assert_range(range(-1.0, 1.0).atan2(range(-2.0, -1.0)), [-PI, PI]);
    assert_range(range(-2.0, 4.0).pow(range(0.5, 2.0)), [0.0, 16.0]);
    assert_range(range(1.0, 3.0).mix(range(2.0, 7.0), range(0.0, 0.5)), [1.0, 5.0]);
    assert_range(range(2.0, INF).mix(range(3.0, INF), range(0.0, 1.0)), [2.0, INF]);
    assert_range(range(0.0, 1.0).lt(range(1.0, 2.0)), [0.0, 1.0]);
    assert_range(range(0.0, 1.0).le(range(1.0, 2.0)), [1.0, 1.0]);
    let undecided = range(0.0, 1.0);
    assert_range(undecided.select(range(1.0, 2.0), range(5.0, 6.0)), [1.0, 6.0]);
    assert_range(undecided.not().not(), [0.0, 1.0]);
}

fn evaluate(graph: &Graph, root: NodeId, region: [Interval; 3]) -> Interval {
    let tape = Tape::new(graph, &[root]);
    tape.map_or(Interval::ENTIRE, |tape| tape.prepare(&FrameValues::default()).scalar(region))
}

#[test]
fn lengths_and_repeated_factors_are_bounded_as_one_value() {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let x = graph.component(p, 0);
    let (square, length, dot) = (graph.mul(x, x), graph.length(p), graph.dot(p, p));
    let unit = graph.unary(Unary::Normalize, p);
    let unit = graph.component(unit, 0);
    let region = [Interval::new(-3.0, 1.0), Interval::new(-4.0, 0.0), Interval::new(0.0, 0.0)];
    assert_range(evaluate(&graph, square, region), [0.0, 9.0]);
    assert_range(evaluate(&graph, length, region), [0.0, 5.0]);
    assert_range(evaluate(&graph, dot, region), [0.0, 25.0]);
    let (one, k) = (graph.number(1.0), graph.number(0.4));
    let rest = graph.sub(one, x);
    let scaled = graph.mul(k, x);
    let dip = graph.mul(scaled, rest);
    let third = [Interval::new(0.0, 1.0); 3];
    assert_range(evaluate(&graph, dip, third), [0.0, 0.1]);
    assert_range(evaluate(&graph, dip, region), [-4.8, 0.1]);
    let unit = evaluate(&graph, unit, region);
    assert!(unit.lo() >= -1.5 && unit.hi() <= 1.5, "{unit:?}");
}

#[test]
fn per_frame_values_are_rounded_once_for_f32() {
    // A third of a param: the shader gets the rounded quotient, not the quotient of the rounded
    // param.
    let mut graph = Graph::new();
    let param = graph.frame_input(sdfc_graph::FrameInput::Param(0), Type::Scalar);
    let p = graph.point(0, Dim::Three);
    let (x, three) = (graph.component(p, 0), graph.number(3.0));
    let third = graph.div(param, three);
    let sum = graph.add(x, third);
    let tape = Tape::new(&graph, &[sum]).unwrap();
    assert_eq!(tape.operations(), 1);
    let value = 0.1 + 1e-9;
    let frame = FrameValues { params: vec![[value; 4]], ..FrameValues::default() };
    assert_eq!(tape.prepare::<f32>(&frame).scalar([0.0; 3]), (value / 3.0) as f32);
}
