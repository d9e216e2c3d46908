//! Programs built by hand.

#![allow(dead_code, clippy::expect_used, clippy::panic)]

use std::io::Write;
use std::process::{Command, Stdio};

use sdfc_graph::{
    Camera, Dim, Fog, FrameInput, Graph, Lens, Light, LightSource, MaterialField, NodeId,
    Occlusion, Param, ParamKind, Program, Reflections, Settings, Shadow, Sky, Ternary, Type, Unary,
};

pub fn point(graph: &mut Graph) -> NodeId {
    graph.point(0, Dim::Three)
}

/// `length(p - centre) - radius`
pub fn ball(graph: &mut Graph, centre: [f64; 3], radius: f64) -> NodeId {
    let p = point(graph);
    let centre = graph.constant(Type::Vec3, &centre);
    let offset = graph.sub(p, centre);
    let length = graph.length(offset);
    let radius = graph.number(radius);
    graph.sub(length, radius)
}

/// The exact box of these half extents around the origin.
pub fn block(graph: &mut Graph, half: [f64; 3]) -> NodeId {
    let p = point(graph);
    let (half, zero) = (graph.constant(Type::Vec3, &half), graph.number(0.0));
    let folded = graph.abs(p);
    let q = graph.sub(folded, half);
    let positive = graph.max(q, zero);
    let outside = graph.length(positive);
    let [x, y, z] = [0, 1, 2].map(|lane| graph.component(q, lane));
    let yz = graph.max(y, z);
    let largest = graph.max(x, yz);
    let inside = graph.min(largest, zero);
    graph.add(outside, inside)
}

/// `p.y - height`
pub fn floor(graph: &mut Graph, height: f64) -> NodeId {
    let p = point(graph);
    let (y, height) = (graph.component(p, 1), graph.number(height));
    graph.sub(y, height)
}

/// The quadratic smooth minimum `min(a, b) - max(k - |a - b|, 0)^2 / (4 k)`.
pub fn smooth(graph: &mut Graph, a: NodeId, b: NodeId, k: NodeId) -> NodeId {
    let (zero, four) = (graph.number(0.0), graph.number(4.0));
    let difference = graph.sub(a, b);
    let apart = graph.abs(difference);
    let overlap = graph.sub(k, apart);
    let overlap = graph.max(overlap, zero);
    let square = graph.mul(overlap, overlap);
    let scale = graph.mul(k, four);
    let dent = graph.div(square, scale);
    let least = graph.min(a, b);
    graph.sub(least, dent)
}

/// A program of a distance and its gradient.
pub fn program(mut graph: Graph, distance: NodeId) -> Program {
    let p = point(&mut graph);
    let gradient = Some(sdfc_graph::gradient(&mut graph, distance, p));
    Program { graph, distance: Some(distance), gradient, ..Program::default() }
}

pub fn sphere() -> Program {
    let mut graph = Graph::new();
    let distance = ball(&mut graph, [0.0, 1.0, 0.0], 0.75);
    program(graph, distance)
}

/// A smooth union of a sphere and a box, over a plane. The smoothness is the param `k`; a quarter
/// of it is a per-frame value.
pub fn blend() -> Program {
    let mut graph = Graph::new();
    let k = graph.frame_input(FrameInput::Param(0), Type::Scalar);
    let ball = ball(&mut graph, [0.4, 0.7, 0.4], 0.8);
    let block = block(&mut graph, [0.8, 0.5, 0.8]);
    let floor = floor(&mut graph, -0.5);
    let joined = smooth(&mut graph, ball, block, k);
    let distance = graph.min(joined, floor);
    let four = graph.number(4.0);
    let scale = graph.mul(k, four);
    let mut program = program(graph, distance);
    program.params.push(number_param("k", 0.4));
    program.names.insert(ball, "ball".to_owned());
    program.names.insert(block, "block".to_owned());
    program.names.insert(scale, "scale".to_owned());
    program.uniforms = vec![k, scale];
    program
}

pub fn number_param(name: &str, default: f64) -> Param {
    Param {
        name: name.to_owned(),
        kind: ParamKind::Number,
        ty: Type::Scalar,
        default: [default, 0.0, 0.0, 0.0],
        fixed: None,
        range: None,
        choices: Vec::new(),
        summary: String::new(),
    }
}

/// A sphere, red above and white below.
pub fn with_material() -> Program {
    let mut program = sphere();
    let graph = &mut program.graph;
    let p = point(graph);
    let (y, zero) = (graph.component(p, 1), graph.number(0.0));
    let below = graph.lt(y, zero);
    let red = graph.constant(Type::Vec3, &[0.8, 0.1, 0.1]);
    let white = graph.constant(Type::Vec3, &[0.9, 0.9, 0.9]);
    let color = graph.select(below, white, red);
    program.material = Some(MaterialField::ALL.map(|field| match field {
        MaterialField::Color => color,
        MaterialField::Emission => graph.constant(Type::Vec3, &[0.0; 3]),
        MaterialField::Roughness => graph.number(0.5),
        MaterialField::Metallic => zero,
        MaterialField::Coverage | MaterialField::Occlusion => graph.number(1.0),
    }));
    program
}

/// A box twisted around y by an angle of `rate` per unit of height, divided by a constant.
pub fn twisted() -> Program {
    let mut graph = Graph::new();
    let p = point(&mut graph);
    let rate = graph.number(2.0);
    let height = graph.component(p, 1);
    let angle = graph.mul(height, rate);
    let (sin, cos) = (graph.unary(Unary::Sin, angle), graph.unary(Unary::Cos, angle));
    let (zero, one) = (graph.number(0.0), graph.number(1.0));
    let minus = graph.neg(sin);
    let columns =
        [[cos, zero, minus], [zero, one, zero], [sin, zero, cos]].map(|c| graph.compose(&c));
    let turned = graph.transform(columns, p);
    let half = graph.constant(Type::Vec3, &[0.5, 1.0, 0.2]);
    let folded = graph.abs(turned);
    let q = graph.sub(folded, half);
    let outside = graph.max(q, zero);
    let distance = graph.length(outside);
    let slower = graph.number(0.4);
    let distance = graph.mul(distance, slower);
    program(graph, distance)
}

/// A left-deep chain of smooth unions of spheres.
pub fn chain(leaves: usize) -> Program {
    let mut graph = Graph::new();
    let k = graph.number(0.1);
    let mut distance = ball(&mut graph, [0.0; 3], 0.5);
    for i in 1..leaves {
        let t = i as f64;
        let leaf = ball(&mut graph, [(t * 0.7).sin() * 3.0, t * 0.01, t.cos() * 3.0], 0.25);
        distance = smooth_folded(&mut graph, distance, leaf, k);
    }
    program(graph, distance)
}

/// `mix(b, a, h) - k h (1 - h)` with `h = saturate(0.5 + (b - a) / (2 k))`, for a constant k.
fn smooth_folded(graph: &mut Graph, a: NodeId, b: NodeId, k: NodeId) -> NodeId {
    let (half, one) = (graph.number(0.5), graph.number(1.0));
    let slope = graph.number(0.5 / graph.as_number(k).expect("a constant"));
    let difference = graph.sub(b, a);
    let scaled = graph.mul(difference, slope);
    let raised = graph.add(scaled, half);
    let h = graph.unary(Unary::Saturate, raised);
    let mixed = graph.ternary(Ternary::Mix, b, a, h);
    let rest = graph.sub(one, h);
    let product = graph.mul(h, rest);
    let dent = graph.mul(product, k);
    graph.sub(mixed, dent)
}

pub fn lit(mut program: Program, shadow: Shadow) -> Program {
    let graph = &mut program.graph;
    let direction = graph.constant(Type::Vec3, &[0.0, 1.0, 0.0]);
    let color = graph.constant(Type::Vec3, &[1.0; 3]);
    let source = LightSource::Sun { direction };
    program.settings.lights.push(Light { source, color, shadow });
    program
}

/// The number of features that a picture can have besides its material.
pub const FEATURES: usize = 8;

/// The program with the features whose bits are set.
pub fn featured(mut program: Program, bits: u32) -> Program {
    let has = |index: u32| bits & (1 << index) != 0;
    let graph = &mut program.graph;
    let (number, vector) = (graph.number(0.5), graph.constant(Type::Vec3, &[0.3, 0.2, 0.1]));
    let shadow = match (has(0), has(1)) {
        (_, true) => Shadow::Soft(number),
        (true, false) => Shadow::Hard,
        (false, false) => Shadow::Off,
    };
    let source = match (has(2), has(3)) {
        (_, true) => LightSource::Spot { position: vector, target: vector, angle: number },
        (true, false) => LightSource::Point { position: vector },
        (false, false) => LightSource::Sun { direction: vector },
    };
    program.settings = Settings {
        lights: vec![Light { source, color: vector, shadow }],
        reflections: has(4).then_some(Reflections { count: 1, strength: number }),
        occlusion: has(5).then_some(Occlusion { radius: Some(number), strength: number }),
        sky: has(6).then_some(Sky { zenith: vector, horizon: vector, ground: None }),
        fog: has(7).then_some(Fog { density: number, color: has(6).then_some(vector) }),
        camera: has(4).then_some(Camera {
            eye: vector,
            target: vector,
            up: vector,
            lens: if has(7) { Lens::Height(number) } else { Lens::Fov(number) },
        }),
        ..Settings::default()
    };
    program
}

pub fn mirrored(mut program: Program) -> Program {
    let strength = program.graph.number(0.3);
    program.settings.reflections = Some(Reflections { count: 2, strength });
    program
}

/// Reads WGSL again and validates it.
pub fn check(text: &str) {
    let module = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{}\n{text}", error.emit_to_string(text)));
    let capabilities = naga::valid::Capabilities::default();
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), capabilities)
        .validate(&module)
        .unwrap_or_else(|error| panic!("{}\n{text}", error.emit_to_string(text)));
}

/// Validates the words with `spirv-val` of SPIRV-Tools, if it is installed.
pub fn check_spirv(words: &[u32], environment: &str) {
    let child = Command::new("spirv-val")
        .args(["--target-env", environment, "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let Ok(mut child) = child else { return };
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let mut input = child.stdin.take().expect("is piped");
    input.write_all(&bytes).expect("spirv-val reads its input");
    drop(input);
    let output = child.wait_with_output().expect("spirv-val ends");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
