//! Each operation on each type that it takes validates, is written, and reads as expected.

#![allow(clippy::expect_used)]

mod common;

use std::fmt::Write;

use common::program;
use sdfc_codegen::{Error, FieldOptions, field_module};
use sdfc_graph::{Binary, FrameInput, Graph, NodeId, Ternary, Type, Unary};

const NUMBERS: [Type; 4] = [Type::Scalar, Type::Vec2, Type::Vec3, Type::Vec4];
const VECTORS: [Type; 3] = [Type::Vec2, Type::Vec3, Type::Vec4];

const COMPONENTWISE: &[Unary] = &[
    Unary::Neg,
    Unary::Abs,
    Unary::Sign,
    Unary::Floor,
    Unary::Ceil,
    Unary::Round,
    Unary::Trunc,
    Unary::Fract,
    Unary::Sqrt,
    Unary::InverseSqrt,
    Unary::Exp,
    Unary::Exp2,
    Unary::Log,
    Unary::Log2,
    Unary::Sin,
    Unary::Cos,
    Unary::Tan,
    Unary::Asin,
    Unary::Acos,
    Unary::Atan,
    Unary::Sinh,
    Unary::Cosh,
    Unary::Tanh,
    Unary::Saturate,
];

const ARITHMETIC: &[Binary] = &[
    Binary::Add,
    Binary::Sub,
    Binary::Mul,
    Binary::Div,
    Binary::Rem,
    Binary::Min,
    Binary::Max,
    Binary::Pow,
    Binary::Atan2,
    Binary::Step,
    Binary::Hash,
];

/// A value of a type that depends on the point, different for each seed.
fn value(graph: &mut Graph, ty: Type, seed: u8) -> NodeId {
    let p = common::point(graph);
    let lanes = [seed, seed + 1, seed + 2].map(|lane| graph.component(p, lane % 3));
    match ty {
        Type::Bool => {
            let limit = graph.number(0.5);
            graph.lt(lanes[0], limit)
        }
        Type::Scalar => lanes[0],
        Type::Vec2 => graph.compose(&lanes[..2]),
        Type::Vec3 => graph.compose(&lanes),
        Type::Vec4 => graph.compose(&[lanes[0], lanes[1], lanes[2], lanes[0]]),
    }
}

/// A scalar that depends on all lanes of a value.
fn measured(graph: &mut Graph, value: NodeId) -> NodeId {
    match graph.ty(value) {
        Type::Bool => {
            let (one, zero) = (graph.number(1.0), graph.number(0.0));
            graph.select(value, one, zero)
        }
        Type::Scalar => value,
        ty @ (Type::Vec2 | Type::Vec3 | Type::Vec4) => {
            // A condition that the graph cannot fold.
            let least = graph.constant(ty, &[0.1, 0.2, 0.3, 0.4]);
            let raised = graph.max(value, least);
            graph.length(raised)
        }
    }
}

/// Lowers, validates, writes, parses and validates again; returns the statements of the distance.
fn written(build: impl FnOnce(&mut Graph) -> NodeId) -> Result<String, Error> {
    let mut graph = Graph::new();
    let result = build(&mut graph);
    let distance = measured(&mut graph, result);
    let program = program(graph, distance);
    let options = FieldOptions { gradient: false, ..FieldOptions::default() };
    let shader = field_module(&program, &options)?;
    let text = shader.wgsl()?;
    common::check(&text);
    common::check_spirv(&shader.spirv()?, "spv1.3");
    let body = text.split_once("f32 {\n").map_or("", |(_, body)| body);
    Ok(body.trim_end_matches(['}', '\n']).trim().to_owned())
}

fn line(out: &mut String, label: String, text: Result<String, Error>) {
    let text = text.unwrap_or_else(|error| error.to_string());
    writeln!(out, "{label}: {}", text.replace("\n    ", " ")).expect("strings grow");
}

#[test]
fn operations_on_one_argument() {
    let mut out = String::new();
    for &op in COMPONENTWISE {
        for ty in NUMBERS {
            let text = written(|graph| {
                let a = value(graph, ty, 0);
                graph.unary(op, a)
            });
            line(&mut out, format!("{op:?} {ty:?}"), text);
        }
    }
    for op in [Unary::Length, Unary::Normalize] {
        for ty in NUMBERS {
            let text = written(|graph| {
                let a = value(graph, ty, 0);
                graph.unary(op, a)
            });
            line(&mut out, format!("{op:?} {ty:?}"), text);
        }
    }
    let not = written(|graph| {
        let a = value(graph, Type::Bool, 0);
        graph.unary(Unary::Not, a)
    });
    line(&mut out, "Not Bool".to_owned(), not);
    insta::assert_snapshot!(out);
}

#[test]
fn operations_on_two_arguments() {
    let mut cases = Vec::new();
    for &op in ARITHMETIC {
        cases.extend(NUMBERS.map(|ty| (op, ty)));
    }
    cases.extend(VECTORS.map(|ty| (Binary::Dot, ty)));
    cases.push((Binary::Cross, Type::Vec3));
    cases.extend([Binary::Lt, Binary::Le].map(|op| (op, Type::Scalar)));
    for ty in [Type::Scalar, Type::Bool] {
        cases.extend([Binary::Eq, Binary::Ne].map(|op| (op, ty)));
    }
    cases.extend([Binary::And, Binary::Or].map(|op| (op, Type::Bool)));

    let mut out = String::new();
    for (op, ty) in cases {
        let text = written(|graph| {
            let (a, b) = (value(graph, ty, 0), value(graph, ty, 1));
            graph.binary(op, a, b)
        });
        line(&mut out, format!("{op:?} {ty:?}"), text);
    }
    insta::assert_snapshot!(out);
}

#[test]
fn operations_on_three_arguments() {
    let mut out = String::new();
    for op in [Ternary::Mix, Ternary::Clamp, Ternary::Smoothstep] {
        for ty in NUMBERS {
            let text = written(|graph| {
                let [a, b, c] = [0, 1, 2].map(|seed| value(graph, ty, seed));
                graph.ternary(op, a, b, c)
            });
            line(&mut out, format!("{op:?} {ty:?}"), text);
        }
    }
    for ty in [Type::Bool, Type::Scalar, Type::Vec2, Type::Vec3, Type::Vec4] {
        let text = written(|graph| {
            let condition = value(graph, Type::Bool, 2);
            let (yes, no) = (value(graph, ty, 0), value(graph, ty, 1));
            graph.select(condition, yes, no)
        });
        line(&mut out, format!("Select {ty:?}"), text);
    }
    insta::assert_snapshot!(out);
}

#[test]
fn vectors_are_built_cut_and_turned() {
    let mut out = String::new();
    type Build = fn(&mut Graph) -> NodeId;
    let cases: [(&str, Build); 8] = [
        ("splat", |graph| {
            let x = value(graph, Type::Scalar, 0);
            graph.splat(Type::Vec3, x)
        }),
        ("product with a splat", |graph| {
            let (v, x) = (value(graph, Type::Vec3, 0), value(graph, Type::Scalar, 0));
            graph.mul(v, x)
        }),
        ("product with a constant splat", |graph| {
            let (v, two) = (value(graph, Type::Vec3, 0), graph.number(2.5));
            graph.mul(two, v)
        }),
        ("swizzle", |graph| {
            let p = common::point(graph);
            graph.swizzle(p, &[2, 0])
        }),
        ("one component of a named value, often", |graph| {
            let p = common::point(graph);
            let q = graph.mul(p, p);
            let y = graph.component(q, 1);
            let twice = graph.mul(y, y);
            graph.add(twice, y)
        }),
        ("constant matrix", |graph| {
            let p = common::point(graph);
            let columns = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
            let columns = columns.map(|column| graph.constant(Type::Vec3, &column));
            graph.transform(columns, p)
        }),
        ("one matrix, two vectors", |graph| {
            let p = common::point(graph);
            let q = graph.abs(p);
            let columns = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
            let columns = columns.map(|column| graph.constant(Type::Vec3, &column));
            let (a, b) = (graph.transform(columns, p), graph.transform(columns, q));
            graph.max(a, b)
        }),
        ("inputs", |graph| {
            let time = graph.frame_input(FrameInput::Time, Type::Scalar);
            let frame = graph.frame_input(FrameInput::Frame, Type::Scalar);
            graph.add(time, frame)
        }),
    ];
    for (label, build) in cases {
        line(&mut out, label.to_owned(), written(build));
    }
    insta::assert_snapshot!(out);
}

#[test]
fn constant_limits_out_of_order() {
    let limits = [("ascending", 1.0, 2.0), ("equal", 1.0, 1.0), ("descending", 2.0, 1.0)];
    let mut out = String::new();
    for (label, low, high) in limits {
        for ty in [Type::Scalar, Type::Vec2] {
            let text = written(|graph| {
                let x = value(graph, ty, 0);
                let (low, high) = (graph.number(low), graph.number(high));
                graph.ternary(Ternary::Clamp, x, low, high)
            });
            line(&mut out, format!("clamp {label} {ty:?}"), text);
            let text = written(|graph| {
                let x = value(graph, ty, 0);
                let (low, high) = (graph.number(low), graph.number(high));
                graph.ternary(Ternary::Smoothstep, low, high, x)
            });
            line(&mut out, format!("smoothstep {label} {ty:?}"), text);
        }
    }
    let mixed = written(|graph| {
        let x = value(graph, Type::Vec2, 0);
        let low = graph.constant(Type::Vec2, &[0.0, 1.0]);
        let high = graph.constant(Type::Vec2, &[1.0, 0.0]);
        graph.ternary(Ternary::Smoothstep, low, high, x)
    });
    line(&mut out, "smoothstep mixed".to_owned(), mixed);
    insta::assert_snapshot!(out);
}
