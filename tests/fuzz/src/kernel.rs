//! What the reference says only in words: the types of the kernel's functions, the values of
//! settings, and what excludes what. A test checks that programs use every name of the reference.

/// Functions of the kernel, with types that they take. The ranges keep arguments where the function
/// has a value.
pub const SIGNATURES: &[&str] = &[
    "abs(x: number) -> number",
    "abs(v: vec3) -> vec3",
    "abs(n: int) -> int",
    "sign(x: number) -> number",
    "floor(x: number) -> int",
    "ceil(x: number) -> int",
    "round(x: number) -> int",
    "trunc(x: number) -> int",
    "round(v: vec3) -> vec3",
    "fract(x: number) -> number",
    "fract(v: vec2) -> vec2",
    "sqrt(x: number in 0..4) -> number",
    "inverseSqrt(x: number in 0.1..4) -> number",
    "exp(x: number in -3..2) -> number",
    "exp2(x: number in -3..3) -> number",
    "log(x: number in 0.1..9) -> number",
    "log2(x: number in 0.1..9) -> number",
    "sin(t: angle) -> number",
    "cos(t: angle) -> number",
    "tan(t: angle in -60..60) -> number",
    "sin(v: vec3) -> vec3",
    "asin(x: number in -1..1) -> angle",
    "acos(x: number in -1..1) -> angle",
    "atan(x: number) -> angle",
    "sinh(x: number in -2..2) -> number",
    "cosh(x: number in -2..2) -> number",
    "tanh(x: number) -> number",
    "saturate(x: number) -> number",
    "min(a: number, b: number, c: number) -> number",
    "min(v: vec3) -> number",
    "min(a: vec2, b: vec2) -> vec2",
    "max(a: number, b: number) -> number",
    "max(list: [number]) -> number",
    "max(a: vec3, b: number) -> vec3",
    "sum(a: number, b: number) -> number",
    "sum(list: [number]) -> number",
    "sum(v: vec3) -> number",
    "pow(x: number in 0..3, n: number in 0..4) -> number",
    "atan2(y: number, x: number) -> angle",
    "step(edge: number, x: number) -> number",
    "mix(a: number, b: number, t: number) -> number",
    "mix(a: color, b: color, t: number in 0..1) -> color",
    "mix(a: vec3, b: vec3, t: number) -> vec3",
    "clamp(x: number, lo: number in -2..-0.1, hi: number in 0.1..2) -> number",
    "smoothstep(lo: number in -2..0, hi: number in 0.1..2, x: number) -> number",
    "vec2(x: number) -> vec2",
    "vec2(x: number, y: number) -> vec2",
    "vec3(v: vec2, z: number) -> vec3",
    "vec3(x: number) -> vec3",
    "vec4(a: vec2, b: vec2) -> vec4",
    "length(v: vec3) -> number",
    "length(v: vec2) -> number",
    "length(x: number) -> number",
    "distance(a: vec3, b: vec3) -> number",
    "distance(a: vec2, b: vec2) -> number",
    "dot(a: vec3, b: vec3) -> number",
    "dot(a: vec2, b: vec2) -> number",
    "cross(a: vec3, b: vec3) -> vec3",
    "lift(q: vec2) -> vec3",
    "len(list: [number]) -> int",
    "len(v: vec3) -> int",
    "hash(a: number, b: vec3) -> number",
    "hash(a: int) -> number",
    "hash3(a: vec2) -> vec3",
    "hash3(a: int, b: int) -> vec3",
    "gradient(a: solid, q: vec3) -> vec3",
    "gradient(a: region, q: vec2) -> vec2",
    "material(color: color = #999, roughness: number = 0.5 in 0..1, metallic: number = 0 in 0..1, emission: color = #000, occlusion: number = 1 in 0..1) -> material",
    "with(material: material, color: color = #999, roughness: number = 0.5 in 0..1, metallic: number = 0 in 0..1, emission: color = #000, occlusion: number = 1 in 0..1) -> material",
    "rgb(r: number in 0..1, g: number in 0..1, b: number in 0..1, a: number = 1 in 0..1) -> color",
    "linear_rgb(r: number in 0..4, g: number in 0..4, b: number in 0..4, a: number = 1 in 0..1) -> color",
    "hsl(h: number in 0..1, s: number in 0..1, l: number in 0..1, a: number = 1 in 0..1) -> color",
    "hsv(h: number in 0..1, s: number in 0..1, v: number in 0..1, a: number = 1 in 0..1) -> color",
    "oklch(l: number in 0..1, c: number in 0..0.3, h: angle, a: number = 1 in 0..1) -> color",
];

/// Names that the generator leaves out.
pub const LEFT_OUT: [(&str, &str); 4] = [
    ("glyph_curves", "only `text` of the library uses it"),
    ("polygon_edges", "only `polygon` of the library uses it"),
    ("outline_cells", "only `text` and `polygon` of the library use it"),
    ("alternative", "both formulas must have the same value"),
];

/// Returns true if the arguments of a kernel function have names.
pub fn is_named(function: &str) -> bool {
    ["material", "with", "rgb", "linear_rgb", "hsl", "hsv", "oklch"].contains(&function)
}

/// The values that the parameters of settings can have, with the setting. The elaborator refuses
/// others, and the reference has them in words only.
pub const SETTING_RANGES: &[(&str, &str, [f64; 2])] = &[
    ("ambient", "strength", [0.0, 1.0]),
    ("ambient_occlusion", "radius", [0.05, 1.0]),
    ("ambient_occlusion", "strength", [0.0, 1.0]),
    ("antialias", "samples", [1.0, 4.0]),
    ("camera", "fov", [10.0, 100.0]),
    ("camera", "height", [0.5, 8.0]),
    ("exposure", "stops", [-2.0, 2.0]),
    ("fog", "density", [0.0, 0.3]),
    ("march", "distance", [20.0, 100.0]),
    ("march", "epsilon", [1e-3, 1e-2]),
    ("march", "steps", [64.0, 512.0]),
    ("march", "tolerance", [0.1, 1.0]),
    ("point_light", "strength", [0.0, 9.0]),
    ("reflections", "count", [0.0, 2.0]),
    ("reflections", "strength", [0.0, 1.0]),
    ("spot_light", "angle", [5.0, 80.0]),
    ("spot_light", "strength", [0.0, 9.0]),
    ("sun", "strength", [0.0, 3.0]),
];

/// Parameters of settings that need a picture beside the scene. Programs have no files.
pub const OF_PICTURES: [[&str; 2]; 3] = [["sky", "image"], ["sky", "turn"], ["sky", "strength"]];

/// Pairs of settings of which a scene can have one.
pub const RIVAL_SETTINGS: [[&str; 2]; 1] = [["sky", "background"]];

/// Pairs of parameters of which a call can have one.
pub const RIVAL_PARAMETERS: [[&str; 2]; 1] = [["fov", "height"]];

/// Parameters of settings whose values must be known when the scene compiles.
pub const CONSTANT: [&str; 7] =
    ["count", "samples", "steps", "epsilon", "distance", "method", "tolerance"];

/// The strings that a parameter can have, by its name.
pub const TEXTS: [(&str, &[&str]); 5] = [
    ("words", &["a", "Hi", "sdf", "Vg\\nq", "\\u{e9}t"]),
    ("font", &["sans"]),
    ("align", &["left", "center", "right"]),
    ("method", &sdfc_lang::settings::RAY_METHODS),
    ("tone", &["neutral", "film", "clip"]),
];
