//! The formulas, as scenes and in Rust.

/// A formula of x, y and z.
pub struct Formula {
    /// Its name.
    pub name: &'static str,
    /// The formula, as in a scene.
    text: &'static str,
    /// Distance of the eye from the origin.
    eye: f64,
    /// The same formula in Rust.
    pub field: fn([f64; 3]) -> f64,
}

impl Formula {
    /// A scene that draws the formula.
    pub fn scene(&self) -> String {
        let [x, y, z] = [0.5, 0.35, 0.79].map(|part| part * self.eye);
        format!(
            "solid thing() = {{\nlet x = p.x\nlet y = p.y\nlet z = p.z\n{}\n}}\nthing()\n\
             camera(eye: [{x}, {y}, {z}], target: [0, 0, 0], fov: 32deg)\n",
            self.text
        )
    }
}

const fn formula(
    name: &'static str,
    eye: f64,
    text: &'static str,
    field: fn([f64; 3]) -> f64,
) -> Formula {
    Formula { name, text, eye, field }
}

fn square(x: f64) -> f64 {
    x * x
}

fn ball([x, y, z]: [f64; 3], r: f64) -> f64 {
    (x * x + y * y + z * z).sqrt() - r
}

/// Two balls, for blends.
fn two([x, y, z]: [f64; 3]) -> [f64; 2] {
    [ball([x, y, z], 0.7), ball([x - 0.8, y - 0.4, z], 0.5)]
}

const PHI2: f64 = 2.618_033_988_749_895;

/// All formulas. A `max` with a ball ends surfaces that go on for ever.
pub static FORMULAS: [Formula; 47] = [
    formula("sphere as a polynomial", 5.0, "x * x + y * y + z * z - 1", |[x, y, z]| {
        x * x + y * y + z * z - 1.0
    }),
    formula(
        "tanglecube",
        10.0,
        "x * x * x * x - 5 * x * x + y * y * y * y - 5 * y * y + z * z * z * z - 5 * z * z + 11.8",
        |p| p.iter().map(|x| x.powi(4) - 5.0 * x * x).sum::<f64>() + 11.8,
    ),
    formula(
        "Goursat's surface",
        6.0,
        "pow(x, 4) + pow(y, 4) + pow(z, 4) - 1.5 * (x * x + y * y + z * z) + 1",
        |p| p.iter().map(|x| x.powi(4) - 1.5 * x * x).sum::<f64>() + 1.0,
    ),
    formula(
        "Barth's sextic",
        6.0,
        "let a = 2.618033988749895
         let w = x * x + y * y + z * z - 1
         max(4 * (a * x * x - y * y) * (a * y * y - z * z) * (a * z * z - x * x)
           - 4.23606797749979 * w * w, length(p) - 1.6)",
        |[x, y, z]| {
            let w = x * x + y * y + z * z - 1.0;
            let (x, y, z) = (x * x, y * y, z * z);
            let sextic = 4.0 * (PHI2 * x - y) * (PHI2 * y - z) * (PHI2 * z - x);
            (sextic - 4.236_067_977_499_79 * w * w).max((x + y + z).sqrt() - 1.6)
        },
    ),
    formula(
        "heart",
        5.0,
        "let a = x * x + 2.25 * z * z + y * y - 1
         a * a * a - x * x * y * y * y - 0.1125 * z * z * y * y * y",
        |[x, y, z]| {
            let a = x * x + 2.25 * z * z + y * y - 1.0;
            a.powi(3) - x * x * y.powi(3) - 0.1125 * z * z * y.powi(3)
        },
    ),
    formula(
        "torus as a quartic",
        6.0,
        "let a = x * x + y * y + z * z + 1 - 0.16
         a * a - 4 * (x * x + z * z)",
        |[x, y, z]| square(x * x + y * y + z * z + 0.84) - 4.0 * (x * x + z * z),
    ),
    formula(
        "chair",
        28.0,
        "let a = x * x + y * y + z * z - 0.95 * 25
         a * a - 0.8 * ((z - 5) * (z - 5) - 2 * x * x) * ((z + 5) * (z + 5) - 2 * y * y)",
        |[x, y, z]| {
            let b = (square(z - 5.0) - 2.0 * x * x) * (square(z + 5.0) - 2.0 * y * y);
            square(x * x + y * y + z * z - 0.95 * 25.0) - 0.8 * b
        },
    ),
    formula(
        "Cayley's cubic",
        5.0,
        "max(4 * (x * x + y * y + z * z) + 16 * x * y * z - 1, length(p) - 1.2)",
        |[x, y, z]| {
            let cubic = 4.0 * (x * x + y * y + z * z) + 16.0 * x * y * z - 1.0;
            cubic.max(ball([x, y, z], 1.2))
        },
    ),
    formula(
        "ding-dong",
        6.0,
        "max(x * x + z * z - (1 - y) * y * y, length(p) - 1.5)",
        |[x, y, z]| (x * x + z * z - (1.0 - y) * y * y).max(ball([x, y, z], 1.5)),
    ),
    formula(
        "decocube",
        6.0,
        "let a = (x * x + y * y - 0.64) * (x * x + y * y - 0.64) + (z * z - 1) * (z * z - 1)
         let b = (y * y + z * z - 0.64) * (y * y + z * z - 0.64) + (x * x - 1) * (x * x - 1)
         let c = (z * z + x * x - 0.64) * (z * z + x * x - 0.64) + (y * y - 1) * (y * y - 1)
         a * b * c - 0.02",
        |[x, y, z]| {
            let part = |x: f64, y: f64, z: f64| square(x * x + y * y - 0.64) + square(z * z - 1.0);
            part(x, y, z) * part(y, z, x) * part(z, x, y) - 0.02
        },
    ),
    formula("tooth", 5.0, "pow(x, 4) + pow(y, 4) + pow(z, 4) - x * x - y * y - z * z", |p| {
        p.iter().map(|x| x.powi(4) - x * x).sum()
    }),
    formula(
        "Hunt's surface",
        16.0,
        "let a = x * x + y * y + z * z - 13
         let b = 3 * x * x + y * y - 4 * z * z - 12
         4 * a * a * a + 27 * b * b",
        |[x, y, z]| {
            let a = x * x + y * y + z * z - 13.0;
            4.0 * a.powi(3) + 27.0 * square(3.0 * x * x + y * y - 4.0 * z * z - 12.0)
        },
    ),
    formula("Whitney's umbrella", 6.0, "max(x * x - z * z * y, length(p) - 1.5)", |[x, y, z]| {
        (x * x - z * z * y).max(ball([x, y, z], 1.5))
    }),
    formula(
        "Steiner's Roman surface",
        3.0,
        "x * x * y * y + y * y * z * z + z * z * x * x - x * y * z",
        |[x, y, z]| square(x * y) + square(y * z) + square(z * x) - x * y * z,
    ),
    formula(
        "product of distances",
        6.0,
        "length(p) * length(p - [1, 0, 0]) * length(p - [0, 1, 0.5]) - 0.4",
        |[x, y, z]| {
            let length = |x: f64, y: f64, z: f64| ball([x, y, z], 0.0);
            length(x, y, z) * length(x - 1.0, y, z) * length(x, y - 1.0, z - 0.5) - 0.4
        },
    ),
    formula(
        "blobs by exp",
        5.0,
        "1 - exp(1 - 3 * dot(p, p)) - exp(1 - 4 * dot(p - [0.8, 0.3, 0], p - [0.8, 0.3, 0]))
           - exp(1 - 5 * dot(p + [0.5, 0.6, 0.2], p + [0.5, 0.6, 0.2]))",
        |[x, y, z]| {
            let a = (1.0 - 3.0 * (x * x + y * y + z * z)).exp();
            let b = (1.0 - 4.0 * (square(x - 0.8) + square(y - 0.3) + z * z)).exp();
            let c = 1.0 - 5.0 * (square(x + 0.5) + square(y + 0.6) + square(z + 0.2));
            1.0 - a - b - c.exp()
        },
    ),
    formula(
        "metaballs by inverse squares",
        5.0,
        "1 - 0.3 / (dot(p, p) + 0.01) - 0.2 / (dot(p - [0.9, 0.2, 0], p - [0.9, 0.2, 0]) + 0.01)",
        |[x, y, z]| {
            let b = square(x - 0.9) + square(y - 0.2) + z * z + 0.01;
            1.0 - 0.3 / (x * x + y * y + z * z + 0.01) - 0.2 / b
        },
    ),
    formula(
        "superquadric",
        5.0,
        "pow(abs(x), 2.5) + pow(abs(y), 2.5) + pow(abs(z), 2.5) - 1",
        |p| p.iter().map(|x| x.abs().powf(2.5)).sum::<f64>() - 1.0,
    ),
    formula(
        "superquadric with edges",
        5.0,
        "pow(abs(x), 1.2) + pow(abs(y), 1.2) + pow(abs(z), 1.2) - 1",
        |p| p.iter().map(|x| x.abs().powf(1.2)).sum::<f64>() - 1.0,
    ),
    formula(
        "norm of order eight",
        5.0,
        "pow(pow(abs(x), 8) + pow(abs(y), 8) + pow(abs(z), 8), 1 / 8) - 0.8",
        |p| p.iter().map(|x| x.powi(8)).sum::<f64>().powf(0.125) - 0.8,
    ),
    formula(
        "R-function of a union",
        6.0,
        "let a = length(p) - 0.7
         let b = length(p - [0.8, 0.4, 0]) - 0.5
         a + b - sqrt(a * a + b * b)",
        |p| {
            let [a, b] = two(p);
            a + b - (a * a + b * b).sqrt()
        },
    ),
    formula(
        "R-function of an intersection",
        4.0,
        "let a = length(p) - 0.7
         let b = length(p - [0.8, 0.4, 0]) - 0.5
         a + b + sqrt(a * a + b * b)",
        |p| {
            let [a, b] = two(p);
            a + b + (a * a + b * b).sqrt()
        },
    ),
    formula(
        "soft minimum by log and exp",
        6.0,
        "let a = length(p) - 0.7
         let b = length(p - [0.8, 0.4, 0]) - 0.5
         log(exp(-8 * a) + exp(-8 * b)) / -8",
        |p| {
            let [a, b] = two(p);
            -((-8.0 * a).exp() + (-8.0 * b).exp()).ln() / 8.0
        },
    ),
    formula(
        "steep soft minimum of three",
        6.0,
        "let a = length(p) - 0.7
         let b = length(p - [0.8, 0.4, 0]) - 0.5
         let c = abs(y + 0.3) - 0.05
         max(log(exp(-40 * a) + exp(-40 * b) + exp(-40 * c)) / -40, length(p) - 1.5)",
        |p| {
            let [a, b] = two(p);
            let c = (p[1] + 0.3).abs() - 0.05;
            let least = a.min(b).min(c);
            let sum: f64 = [a, b, c].iter().map(|d| (-40.0 * (d - least)).exp()).sum();
            (least - sum.ln() / 40.0).max(ball(p, 1.5))
        },
    ),
    formula(
        "soft maximum by log2 and exp2",
        4.0,
        "log2(exp2(6 * (length(p) - 0.9)) + exp2(6 * (0.5 - length(p - [0.8, 0.4, 0.3])))) / 6",
        |[x, y, z]| {
            let hole = 0.5 - ball([x - 0.8, y - 0.4, z - 0.3], 0.0);
            ((6.0 * ball([x, y, z], 0.9)).exp2() + (6.0 * hole).exp2()).log2() / 6.0
        },
    ),
    formula(
        "quadratic soft minimum",
        6.0,
        "let a = length(p) - 0.7
         let b = length(p - [0.8, 0.4, 0]) - 0.5
         let h = max(0.3 - abs(a - b), 0) / 0.3
         min(a, b) - h * h * 0.3 / 4",
        |p| {
            let [a, b] = two(p);
            let h = (0.3 - (a - b).abs()).max(0.0) / 0.3;
            a.min(b) - h * h * 0.3 / 4.0
        },
    ),
    formula(
        "soft minimum by mix",
        6.0,
        "let a = length(p) - 0.7
         let b = length(p - [0.8, 0.4, 0]) - 0.5
         let h = clamp(0.5 + 0.5 * (b - a) / 0.3, 0, 1)
         mix(b, a, h) - 0.3 * h * (1 - h)",
        |p| {
            let [a, b] = two(p);
            let h = (0.5 + 0.5 * (b - a) / 0.3).clamp(0.0, 1.0);
            b * (1.0 - h) + a * h - 0.3 * h * (1.0 - h)
        },
    ),
    formula(
        "box of a shader",
        5.0,
        "let q = abs(p) - [0.8, 0.5, 0.6]
         length(max(q, 0)) + min(max(q.x, max(q.y, q.z)), 0) - 0.05",
        |[x, y, z]| {
            let q = [x.abs() - 0.8, y.abs() - 0.5, z.abs() - 0.6];
            let outside = q.iter().map(|x| square(x.max(0.0))).sum::<f64>().sqrt();
            outside + q[0].max(q[1]).max(q[2]).min(0.0) - 0.05
        },
    ),
    formula(
        "twisted box",
        6.0,
        "let c = cos(2 * y)
         let s = sin(2 * y)
         let q = abs([c * x - s * z, y, s * x + c * z]) - [0.6, 1, 0.2]
         max(q.x, q.y, q.z)",
        |[x, y, z]| {
            let (s, c) = (2.0 * y).sin_cos();
            let across = ((c * x - s * z).abs() - 0.6).max((s * x + c * z).abs() - 0.2);
            across.max(y.abs() - 1.0)
        },
    ),
    formula(
        "displaced ball",
        6.0,
        "length(p) - 1 + 0.1 * sin(10 * x) * sin(10 * y) * sin(10 * z)",
        |[x, y, z]| {
            let bumps = (10.0 * x).sin() * (10.0 * y).sin() * (10.0 * z).sin();
            ball([x, y, z], 1.0) + 0.1 * bumps
        },
    ),
    formula(
        "shell of a gyroid",
        6.0,
        "let g = sin(4 * x) * cos(4 * y) + sin(4 * y) * cos(4 * z) + sin(4 * z) * cos(4 * x)
         max(abs(g) - 0.4, length(p) - 1.3)",
        |p| {
            let [x, y, z] = p.map(|x| 4.0 * x);
            let g = x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos();
            (g.abs() - 0.4).max(ball(p, 1.3))
        },
    ),
    formula(
        "Schwarz's P surface",
        6.0,
        "max(cos(4 * x) + cos(4 * y) + cos(4 * z), length(p) - 1.3)",
        |p| p.iter().map(|x| (4.0 * x).cos()).sum::<f64>().max(ball(p, 1.3)),
    ),
    formula("scaled ball, not divided", 5.0, "length(p * [1, 2, 4]) - 1", |[x, y, z]| {
        ball([x, 2.0 * y, 4.0 * z], 1.0)
    }),
    formula(
        "ellipsoid by a sum of squares",
        5.0,
        "sqrt(x * x + 4 * y * y + 9 * z * z) - 1",
        |[x, y, z]| ball([x, 2.0 * y, 3.0 * z], 1.0),
    ),
    formula(
        "trefoil by an angle",
        6.0,
        "let a = 1.5 * atan2(z, x)
         let q = [length(p.xz) - 1, y]
         let r = [cos(a) * q.x - sin(a) * q.y, sin(a) * q.x + cos(a) * q.y]
         length([abs(r.x) - 0.35, r.y]) - 0.15",
        |[x, y, z]| {
            let (s, c) = (1.5 * z.atan2(x)).sin_cos();
            let (u, v) = ((x * x + z * z).sqrt() - 1.0, y);
            (square((c * u - s * v).abs() - 0.35) + square(s * u + c * v)).sqrt() - 0.15
        },
    ),
    formula("balls by fract", 7.0, "max(length(fract(p) - 0.5) - 0.35, length(p) - 1.6)", |p| {
        ball(p.map(|x| x - x.floor() - 0.5), 0.35).max(ball(p, 1.6))
    }),
    formula("octahedron of a sum", 5.0, "abs(x) + abs(y) + abs(z) - 1", |p| {
        p.iter().map(|x| x.abs()).sum::<f64>() - 1.0
    }),
    formula(
        "cube less a cross",
        5.0,
        "let q = abs(p)
         let cross = min(max(q.x, q.y), max(q.y, q.z), max(q.z, q.x)) - 0.3
         max(q.x - 0.8, q.y - 0.8, q.z - 0.8, -cross)",
        |p| {
            let [x, y, z] = p.map(f64::abs);
            let cross = x.max(y).min(y.max(z)).min(z.max(x)) - 0.3;
            (x.max(y).max(z) - 0.8).max(-cross)
        },
    ),
    formula(
        "height field",
        6.0,
        "max(y - 0.3 * sin(4 * x) * cos(4 * z), length(p) - 1.3)",
        |[x, y, z]| (y - 0.3 * (4.0 * x).sin() * (4.0 * z).cos()).max(ball([x, y, z], 1.3)),
    ),
    formula(
        "cylinder by a root",
        5.0,
        "max(sqrt(x * x + z * z) - 0.6, abs(y) - 0.8)",
        |[x, y, z]| ((x * x + z * z).sqrt() - 0.6).max(y.abs() - 0.8),
    ),
    formula(
        "torus by roots",
        5.0,
        "let q = sqrt(x * x + z * z) - 0.8
         sqrt(q * q + y * y) - 0.25",
        |[x, y, z]| (square((x * x + z * z).sqrt() - 0.8) + y * y).sqrt() - 0.25,
    ),
    formula(
        "rounded maximum by a root",
        5.0,
        "let a = abs(x) - 0.6
         let b = abs(y) - 0.6
         max(0.5 * (a + b + sqrt((a - b) * (a - b) + 0.04)), abs(z) - 0.5)",
        |[x, y, z]| {
            let (a, b) = (x.abs() - 0.6, y.abs() - 0.6);
            (0.5 * (a + b + (square(a - b) + 0.04).sqrt())).max(z.abs() - 0.5)
        },
    ),
    formula(
        "folded lattice",
        7.0,
        "let q = abs(fract(2 * p) - 0.5)
         max(min(length(q.xy), length(q.yz), length(q.xz)) - 0.12, length(p) - 1.4)",
        |p| {
            let [x, y, z] = p.map(|x| (2.0 * x - (2.0 * x).floor() - 0.5).abs());
            let bars = (x * x + y * y).min(y * y + z * z).min(x * x + z * z).sqrt() - 0.12;
            bars.max(ball(p, 1.4))
        },
    ),
    formula(
        "Kummer's quartic",
        6.0,
        "let w = x * x + y * y + z * z - 1.69
         let s = 1.4142135623730951
         let planes = (1 - z - s * x) * (1 - z + s * x) * (1 + z + s * y) * (1 + z - s * y)
         max(w * w - 3.1 * planes, length(p) - 1.8)",
        |[x, y, z]| {
            let s = 2.0_f64.sqrt();
            let planes = (square(1.0 - z) - square(s * x)) * (square(1.0 + z) - square(s * y));
            let quartic = square(x * x + y * y + z * z - 1.69) - 3.1 * planes;
            quartic.max(ball([x, y, z], 1.8))
        },
    ),
    formula(
        "surface of genus two",
        6.0,
        "let threefold = 2 * y * (y * y - 3 * x * x) * (1 - z * z)
         let r = x * x + y * y
         max(threefold + r * r - (9 * z * z - 1) * (1 - z * z), length(p) - 2)",
        |[x, y, z]| {
            let threefold = 2.0 * y * (y * y - 3.0 * x * x) * (1.0 - z * z);
            let quartic = threefold + square(x * x + y * y) - (9.0 * z * z - 1.0) * (1.0 - z * z);
            quartic.max(ball([x, y, z], 2.0))
        },
    ),
    // Nothing bounds its slope near the axis, and nothing its extent.
    formula(
        "knot of two strands",
        5.0,
        "let q = vec2(length(p.xz) - 1, y)
         let r = spin(q, 1.5 * atan2(z, x))
         length(vec2(abs(r.x) - 0.3, r.y)) - 0.15",
        |[x, y, z]| {
            let (u, (sin, cos)) = (x.hypot(z) - 1.0, (1.5 * z.atan2(x)).sin_cos());
            let [s, t] = [u * cos - y * sin, u * sin + y * cos];
            (s.abs() - 0.3).hypot(t) - 0.15
        },
    ),
    // Beyond a height of 1 the mitre is a line without an inside, of which a pixel may show some.
    formula(
        "mitre in a ball",
        5.0,
        "max(4 * x * x * (x * x + y * y + z * z) - y * y * (1 - y * y - z * z), length(p) - 0.95)",
        |[x, y, z]| {
            let mitre = 4.0 * x * x * (x * x + y * y + z * z) - y * y * (1.0 - y * y - z * z);
            mitre.max(ball([x, y, z], 0.95))
        },
    ),
];
