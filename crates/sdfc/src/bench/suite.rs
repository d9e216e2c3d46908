//! The scenes of `bench --suite`: the course's, a chain of thirty leaves, and generated ones that every baseline
//! can express.

use std::fmt::Write;

/// Leaves of the generated scenes: a floor, then pairs, then one more if the number is even.
const LEAVES: [usize; 4] = [3, 33, 100, 300];
/// Where the generator of pseudo-random numbers starts.
const SEED: u64 = 7;

/// Names and texts of the suite's scenes.
pub fn suite() -> Vec<(String, String)> {
    let files = [
        ("course/union.sdf", include_str!("../../../../examples/course/union.sdf")),
        ("course/subtraction.sdf", include_str!("../../../../examples/course/subtraction.sdf")),
        ("course/intersection.sdf", include_str!("../../../../examples/course/intersection.sdf")),
        ("course/blend.sdf", include_str!("../../../../examples/course/blend.sdf")),
        ("bench/thirty.sdf", include_str!("../../../../examples/bench/thirty.sdf")),
    ];
    let files = files.map(|(name, text)| (name.to_owned(), text.to_owned()));
    let generated = LEAVES.map(|leaves| (format!("generated {leaves}"), generated(leaves)));
    files.into_iter().chain(generated).collect()
}

/// A floor with a square of pairs on it, each a ball and a block under one of four operations.
fn generated(leaves: usize) -> String {
    let pairs = leaves.saturating_sub(1) / 2;
    let side = (1..).find(|side| side * side >= pairs).unwrap_or(1);
    let reach = side as f64;
    let mut numbers = Numbers(SEED);
    // Writing to a String cannot fail.
    let mut text = "plane(y: -0.5)\n".to_owned();
    for index in 0..pairs {
        let [column, row] = [index % side, index / side]
            .map(|place| 1.6 * (place as f64 - (reach - 1.0) / 2.0) + numbers.between(-0.1, 0.1));
        let radius = numbers.between(0.35, 0.5);
        let [x, y, z] = [0.0; 3].map(|_| numbers.between(0.5, 0.9));
        let [dx, dy, dz] = [0.0; 3].map(|_| numbers.between(0.15, 0.35));
        let (bx, by, bz) = (column + dx, dy, row + dz);
        let ball = format!("sphere({radius:.3}).translate([{column:.3}, 0, {row:.3}])");
        let block = format!("box([{x:.3}, {y:.3}, {z:.3}]).translate([{bx:.3}, {by:.3}, {bz:.3}])");
        let width = numbers.between(0.1, 0.3);
        let _ = match index % 4 {
            0 => writeln!(text, "union({ball}, {block}, blend: smooth({width:.3}))"),
            1 => writeln!(text, "difference({block}, {ball})"),
            2 => writeln!(text, "intersection({ball}, {block})"),
            _ => writeln!(text, "union({ball}, {block})"),
        };
    }
    if leaves.is_multiple_of(2) {
        let _ = writeln!(text, "sphere(0.3).translate(y: 1.2)");
    }
    let [far, high] = [2.0 + 1.3 * reach, 1.5 + reach];
    let _ = writeln!(text, "camera(eye: [{far:.2}, {high:.2}, {far:.2}], target: 0, fov: 40deg)");
    text + "sun(direction: [1, 2, 1], shadow: hard)\nambient(strength: 0.15)\n\
            march(steps: 255, epsilon: 0.001, distance: 40)\n"
}

/// Knuth's linear congruential generator; its upper bits.
struct Numbers(u64);

impl Numbers {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        low + (high - low) * (self.0 >> 40) as f64 / (1u64 << 24) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generated_scenes_have_the_leaves_that_they_say() {
        for leaves in LEAVES {
            let text = generated(leaves);
            let compiled = crate::compile("generated", &text);
            assert_eq!(compiled.diagnostics_text(false), "", "{text}");
            assert_eq!(compiled.scene.unwrap().report().leaves, leaves);
        }
    }
}
