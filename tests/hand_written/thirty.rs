//! The seeded scene of 30 leaves, written twice from the same constants: as a scene, and as the WGSL that
//! a careful person writes for it.
//!
//! Constants have two digits, so that both texts hold the same decimal numbers; what a person would work
//! out beforehand (half sizes, the capsule's axis over its squared length) is written with nine.

use std::fmt::Write;

const SEED: u64 = 30;
const LEAVES: usize = 30;

/// One leaf; lengths in hundredths.
enum Leaf {
    Ball { centre: [i64; 3], radius: i64 },
    Block { centre: [i64; 3], half: [i64; 3] },
    Capsule { from: [i64; 3], to: [i64; 3], radius: i64 },
}

/// A leaf and the width of the blend that joins it to those before.
struct Part {
    leaf: Leaf,
    blend: i64,
}

/// The files that hold this scene, from the root of the repository, and their texts.
pub fn files() -> [(&'static str, String); 3] {
    let parts = parts();
    [
        ("examples/bench/thirty.sdf", scene(&parts)),
        ("tests/hand_written/thirty.wgsl", wgsl(&parts, Form::Plain)),
        ("tests/hand_written/tight/thirty.wgsl", wgsl(&parts, Form::Tight)),
    ]
}

/// How the smooth minimum is written: as everybody does, or in the fewest instructions.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Plain,
    Tight,
}

/// SplitMix64 (Steele, Lea, Flood 2014): every platform draws the same numbers.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number from `low` to `high`, never 0: a zero constant would let either side skip work.
    fn within(&mut self, low: i64, high: i64) -> i64 {
        let drawn = low + (self.next() % (high - low + 1) as u64) as i64;
        if drawn == 0 { 1 } else { drawn }
    }

    fn vector(&mut self, low: i64, high: i64) -> [i64; 3] {
        [self.within(low, high), self.within(low, high), self.within(low, high)]
    }
}

fn parts() -> Vec<Part> {
    let mut random = Random(SEED);
    (0..LEAVES)
        .map(|index| {
            let centre = random.vector(-180, 180);
            let leaf = match index % 3 {
                0 => Leaf::Ball { centre, radius: random.within(20, 55) },
                1 => Leaf::Block { centre, half: random.vector(15, 50) },
                _ => {
                    let reach = random.vector(-70, 70);
                    let to = [0, 1, 2].map(|axis| centre[axis] + reach[axis]);
                    Leaf::Capsule { from: centre, to, radius: random.within(8, 25) }
                }
            };
            Part { leaf, blend: random.within(10, 40) }
        })
        .collect()
}

fn decimal(hundredths: i64) -> String {
    format!("{:?}", hundredths as f64 / 100.0)
}

fn triple(hundredths: [i64; 3]) -> String {
    hundredths.map(decimal).join(", ")
}

fn scene(parts: &[Part]) -> String {
    let mut text = String::from(
        "// Thirty leaves joined smoothly one after the other: a measuring scene, written by a seeded generator\n\
         // (tests/hand_written/thirty.rs) with the same constants as tests/hand_written/thirty.wgsl.\n\n",
    );
    for (index, part) in parts.iter().enumerate() {
        let leaf = match &part.leaf {
            Leaf::Ball { centre, radius } => {
                format!("sphere({}).translate([{}])", decimal(*radius), triple(*centre))
            }
            Leaf::Block { centre, half } => {
                let size = half.map(|h| 2 * h);
                format!("box([{}]).translate([{}])", triple(size), triple(*centre))
            }
            Leaf::Capsule { from, to, radius } => {
                format!("capsule([{}], [{}], r: {})", triple(*from), triple(*to), decimal(*radius))
            }
        };
        let _ = writeln!(text, "let part{index} = {leaf}");
        if index > 0 {
            let before = if index == 1 { "part0".into() } else { format!("join{}", index - 1) };
            let blend = decimal(part.blend);
            let _ = writeln!(
                text,
                "let join{index} = union({before}, part{index}, blend: smooth({blend}))"
            );
        }
    }
    let _ = write!(
        text,
        "\njoin{}\n\ncamera(eye: [5, 4, 6], target: [0, 0, 0], fov: 40deg)\nsun(direction: [1, 2, 1])\nambient(strength: 0.2)\n",
        parts.len() - 1
    );
    text
}

const PLAIN_HEAD: &str = "\
// The field of examples/bench/thirty.sdf as a careful person writes it: all constants inlined and worked
// out beforehand, vector code, no work done twice. Written by thirty.rs from the scene's constants.
";

const TIGHT_HEAD: &str = "\
// The field of thirty.wgsl in the fewest arithmetic instructions that were found. README.md one level up
// derives the form; thirty.rs writes it from the scene's constants.
";

const LEAF_FUNCTIONS: &str = "
fn ball(p: vec3f, centre: vec3f, radius: f32) -> f32 {
    return length(p - centre) - radius;
}

fn block(p: vec3f, centre: vec3f, half_size: vec3f) -> f32 {
    let q = abs(p - centre) - half_size;
    return length(max(q, vec3f(0.0))) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// `scaled` is `axis` over its squared length.
fn capsule(p: vec3f, start: vec3f, axis: vec3f, scaled: vec3f, radius: f32) -> f32 {
    let q = p - start;
    return length(q - axis * saturate(dot(q, scaled))) - radius;
}
";

const PLAIN_JOIN: &str = "
// Quadratic smooth minimum of width k; `slope` is 0.25 / k.
fn join(a: f32, b: f32, k: f32, slope: f32) -> f32 {
    let h = max(k - abs(a - b), 0.0);
    return min(a, b) - h * h * slope;
}
";

const TIGHT_JOINS: &str = "
// Quadratic smooth minimum of width k; `slope` is -0.25 / k.
fn join(a: f32, b: f32, k: f32, slope: f32) -> f32 {
    let h = max(k - abs(a - b), 0.0);
    return min(a, b) + h * h * slope;
}

// The same where `raised` is k more than the second distance; `width` is 2 k.
fn join_raised(a: f32, raised: f32, width: f32, slope: f32) -> f32 {
    let nearer = min(a, raised);
    let h = max(nearer - raised + width, 0.0);
    return nearer + h * h * slope;
}
";

const FIELD_HEAD: &str = "
fn field(p: vec3f) -> f32 {
";

const FIELD_TAIL: &str = "    return d;
}

// Keeps `field` alive through the optimiser and adds no arithmetic of its own.
@group(0) @binding(0) var<storage, read_write> sample: vec4f;

@compute @workgroup_size(1)
fn main() {
    sample.w = field(sample.xyz);
}
";

/// One leaf, its distance raised by `raise` hundredths.
fn call(leaf: &Leaf, raise: i64) -> String {
    match leaf {
        Leaf::Ball { centre, radius } => {
            format!("ball(p, vec3f({}), {})", triple(*centre), decimal(radius - raise))
        }
        Leaf::Block { centre, half } => {
            format!("block(p, vec3f({}), vec3f({}))", triple(*centre), triple(*half))
        }
        Leaf::Capsule { from, to, radius } => {
            let axis = [0, 1, 2].map(|i| to[i] - from[i]);
            let squared: i64 = axis.iter().map(|x| x * x).sum();
            let scaled = axis.map(|x| format!("{:.9}", 100.0 * x as f64 / squared as f64));
            format!(
                "capsule(p, vec3f({}), vec3f({}), vec3f({}), {})",
                triple(*from),
                triple(axis),
                scaled.join(", "),
                decimal(radius - raise)
            )
        }
    }
}

fn wgsl(parts: &[Part], form: Form) -> String {
    let (head, joins) = match form {
        Form::Plain => (PLAIN_HEAD, PLAIN_JOIN),
        Form::Tight => (TIGHT_HEAD, TIGHT_JOINS),
    };
    let mut text = [head, LEAF_FUNCTIONS, joins, FIELD_HEAD].concat();
    for (index, Part { leaf, blend }) in parts.iter().enumerate() {
        let slope = 25.0 / *blend as f64;
        let ends_in_a_constant = !matches!(leaf, Leaf::Block { .. });
        let line = match (index, form) {
            (0, _) => format!("var d = {};", call(leaf, 0)),
            (_, Form::Plain) => {
                format!("d = join(d, {}, {}, {slope:.9});", call(leaf, 0), decimal(*blend))
            }
            (_, Form::Tight) if ends_in_a_constant => {
                let width = decimal(2 * blend);
                format!("d = join_raised(d, {}, {width}, -{slope:.9});", call(leaf, *blend))
            }
            (_, Form::Tight) => {
                format!("d = join(d, {}, {}, -{slope:.9});", call(leaf, 0), decimal(*blend))
            }
        };
        let _ = writeln!(text, "    {line}");
    }
    text + FIELD_TAIL
}
