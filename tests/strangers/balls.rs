//! Balls in a smooth union by `log` of a sum of `exp`, clipped by a box, as other programs write
//! it: a flat formula without a known constant.

use std::fmt::Write;

use fastrand::Rng;

/// Sharpness of the union.
const SHARPNESS: f64 = 12.0;
/// Half the side of the box.
const HALF: f64 = 1.1;

/// Balls in a smooth union: middles and radii.
pub struct Balls(Vec<([f64; 3], f64)>);

impl Balls {
    /// This number of balls.
    pub fn new(count: u32) -> Self {
        let mut random = Rng::with_seed(7);
        // Short decimal numbers are the same numbers in the scene and here.
        let mut between = |lo: f64, hi: f64| (1e3 * (lo + (hi - lo) * random.f64())).round() / 1e3;
        let ball = |_| ([0; 3].map(|_| between(-1.0, 1.0)), between(0.1, 0.35));
        Self((0..count).map(ball).collect())
    }

    /// The scene.
    pub fn scene(&self) -> String {
        let mut text = "solid balls() = {\n".to_owned();
        let mut all = String::new();
        for (index, ([x, y, z], radius)) in self.0.iter().enumerate() {
            let square = |axis: char, at: f64| format!("(p.{axis} - {at}) * (p.{axis} - {at})");
            let [x, y, z] = [square('x', *x), square('y', *y), square('z', *z)];
            let ball = format!("sqrt({x} + {y} + {z}) - {radius}");
            all = if index == 0 {
                ball
            } else {
                // Writing to a string does not fail.
                let _ = writeln!(text, "let a{index} = {all}\nlet b{index} = {ball}");
                let [a, b] = ['a', 'b'].map(|name| format!("exp(-{SHARPNESS} * {name}{index})"));
                format!("log({a} + {b}) / -{SHARPNESS}")
            };
        }
        let _ = writeln!(text, "{all}\n}}\nballs() & box({})", 2.0 * HALF);
        text + "camera(eye: [2.5, 2, 3], target: [0, 0, 0], fov: 40deg)\n\
                sun(direction: [1, 2, 3])\nambient(strength: 0.3)\n"
    }

    /// The value of the formula at a point.
    pub fn at(&self, p: [f64; 3]) -> f64 {
        let distances = self.0.iter().map(|(middle, radius)| {
            let square = |axis: usize| (p[axis] - middle[axis]).powi(2);
            (square(0) + square(1) + square(2)).sqrt() - radius
        });
        // The same sum in another order, so that none of its terms overflows.
        let distances: Vec<f64> = distances.collect();
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        let sum: f64 = distances.iter().map(|d| (-SHARPNESS * (d - least)).exp()).sum();
        let union = least - sum.ln() / SHARPNESS;
        let outside = p.map(|x| x.abs() - HALF);
        union.max(outside.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }
}
