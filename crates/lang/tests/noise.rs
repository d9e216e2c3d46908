//! Noises keep their ranges and Lipschitz constants, also across the walls of cells.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use support::Field;

/// A generator of numbers in 0..1 (Steele and others, "SplitMix").
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

struct Noise {
    function: &'static str,
    range: [f64; 2],
    lipschitz: f64,
}

const NOISES: [Noise; 7] = [
    Noise { function: "value_noise", range: [-1.0, 1.0], lipschitz: 3.75 },
    Noise { function: "gradient_noise", range: [-1.0, 1.0], lipschitz: 3.2243 },
    Noise { function: "simplex_noise", range: [-1.0, 1.0], lipschitz: 7.81 },
    Noise { function: "voronoi", range: [0.0, 1.0], lipschitz: 1.0 },
    Noise { function: "voronoi_walls", range: [0.0, 1.0], lipschitz: 2.0 },
    // Five octaves whose weights sum to 1, each as steep as the first.
    Noise { function: "fbm", range: [-1.0, 1.0], lipschitz: 8.321 },
    Noise { function: "turbulence", range: [0.0, 1.0], lipschitz: 8.321 },
];

/// Pairs of near points detect jumps at the walls of cells as well as slopes.
#[test]
fn noises_keep_their_ranges_and_lipschitz_constants() {
    let cases = NOISES.iter().flat_map(|noise| [(noise, "p"), (noise, "p.xz")]);
    for (&Noise { function, range, lipschitz }, point) in cases {
        let formula = format!("{function}({point})");
        let field = Field::drawn(&format!("solid it() = {formula}\nit()"));
        let mut value = field.evaluator();
        let mut random = Random(7);
        let mut steepest = 0.0f64;
        for _ in 0..30_000 {
            let a = [0; 3].map(|_| 40.0 * (random.next() - 0.5));
            let step = [0; 3].map(|_| random.next() - 0.5);
            let length = step.iter().map(|x| x * x).sum::<f64>().sqrt();
            let distance = 1e-3 * random.next() + 1e-6;
            let b = [0, 1, 2].map(|i| a[i] + step[i] / length * distance);
            let (x, y) = (value.scalar(a), value.scalar(b));
            assert!((range[0]..=range[1]).contains(&x), "{formula} is {x} at {a:?}");
            steepest = steepest.max((x - y).abs() / distance);
        }
        assert!(steepest <= lipschitz * (1.0 + 1e-6), "{formula} has a slope of {steepest}");
    }
}

#[test]
fn a_constant_coordinate_halves_the_number_of_corners() {
    let nodes = |formula: &str| {
        let scene = support::elaborated(&format!("solid it() = {formula}\nit()")).scene;
        sdfc_graph::operation_count(&scene.graph, &[support::root(&scene).formula])
    };
    let (flat, full) = (nodes("gradient_noise([p.x, p.z, 0])"), nodes("gradient_noise(p)"));
    assert!(flat * 3 < full * 2, "{flat} of {full}");
}

/// A vec2 is a point of the plane z = 0.
#[test]
fn noises_of_a_plane_are_those_of_space() {
    for noise in ["value_noise", "gradient_noise", "simplex_noise"] {
        let field = Field::drawn(&format!("solid it() = {noise}(p.xy)\nit()"));
        let in_space = Field::drawn(&format!("solid it() = {noise}(vec3(p.xy, 0))\nit()"));
        for p in [[0.3, 0.8, 0.4], [-5.1, 2.25, 9.0]] {
            assert_eq!(field.at(p).to_bits(), in_space.at(p).to_bits(), "{noise} at {p:?}");
        }
    }
}
