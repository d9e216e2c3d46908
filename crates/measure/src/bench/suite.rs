//! The scenes of `bench --suite`: those of the course, a chain of thirty leaves, and generated
//! scenes that every baseline can express.

use std::fmt::Write;

/// Leaves of the generated scenes: a floor, then pairs, then one more if the number is even.
const LEAVES: [usize; 4] = [3, 33, 100, 300];
/// The seed of the pseudo-random numbers.
const SEED: u64 = 7;

/// Returns names and sources of the suite's scenes.
pub fn suite() -> Vec<(String, String)> {
    let files = sdfc_examples::BENCH.map(|(name, text)| (name.to_owned(), text.to_owned()));
    let generated = LEAVES.map(|leaves| (format!("generated {leaves}"), generated(leaves)));
    files.into_iter().chain(generated).collect()
}

/// Number of trees; the scene has as many blocks as scenes that are used elsewhere to measure
/// pruning.
const TREES: usize = 6;
const BOXES_PER_TREE: usize = 31;
/// Leaves of the scene of many kinds.
const MIXED: usize = 300;
/// Leaves of the large scenes.
const SCATTERED: [usize; 6] = [100, 300, 1000, 3000, 6000, 20_000];
const CHAINED: [usize; 2] = [301, 1001];

/// Returns names and sources of scenes that are too large for interpreters.
pub fn large_suite() -> Vec<(String, String)> {
    let trees = (format!("trees {}", TREES * BOXES_PER_TREE), trees());
    let mixed = (format!("mixed {MIXED}"), mixed(MIXED));
    let chained = CHAINED.map(|leaves| (format!("chain {leaves}"), chained(leaves)));
    let scattered = SCATTERED.map(|leaves| (format!("scattered {leaves}"), scattered(leaves)));
    [trees, mixed].into_iter().chain(chained).chain(scattered).collect()
}

/// Returns trees of rotated boxes, each with a trunk and branches that wind up around it.
fn trees() -> String {
    let mut numbers = Numbers(SEED);
    let mut text = String::new();
    for tree in 0..TREES {
        let [x, z] = [tree % 3, tree / 3]
            .map(|index| 2.6 * (index as f64 - 0.5) + numbers.between(-0.4, 0.4));
        let _ = writeln!(text, "box([0.2, 2.4, 0.2]).translate([{x:.3}, 0, {z:.3}])");
        for branch in 1..BOXES_PER_TREE {
            let fraction = branch as f64 / BOXES_PER_TREE as f64;
            let turn = 137.5 * branch as f64 + numbers.between(-15.0, 15.0);
            let tilt = 55.0 - 50.0 * fraction + numbers.between(-8.0, 8.0);
            let (length, wide) = (1.3 * (1.1 - fraction), 0.1 * (1.2 - fraction));
            let high = 1.8 * fraction - 0.5;
            let _ = writeln!(
                text,
                "box([{length:.3}, {wide:.3}, {wide:.3}]).translate(x: {:.3}).rotate(z: {tilt:.1}deg)\
                 .rotate(y: {turn:.1}deg).translate([{x:.3}, {high:.3}, {z:.3}])",
                0.5 * length
            );
        }
    }
    text + &seen_from(3.0)
}

/// Returns shapes of six kinds, scattered evenly in a cube, one per unit of volume.
fn mixed(leaves: usize) -> String {
    let reach = 0.5 * (leaves as f64).cbrt();
    let mut numbers = Numbers(SEED);
    let mut text = String::new();
    for index in 0..leaves {
        let [x, y, z] = [0.0; 3].map(|_| numbers.between(-reach, reach));
        let [a, b, c] = [0.0; 3].map(|_| numbers.between(0.2, 0.5));
        let shape = match index % 6 {
            0 => format!("sphere({:.3})", 0.6 * a),
            1 => format!("box([{a:.3}, {b:.3}, {c:.3}])"),
            2 => format!("capsule([{a:.3}, {b:.3}, {c:.3}], [0, 0, 0], r: {:.3})", 0.3 * b),
            3 => format!("cylinder({:.3}, {b:.3})", 0.5 * a),
            4 => format!("torus({a:.3}, {:.3})", 0.3 * b),
            _ => format!("octahedron({a:.3})"),
        };
        let _ = writeln!(text, "{shape}.translate([{x:.3}, {y:.3}, {z:.3}])");
    }
    text + &seen_from(reach)
}

/// Returns balls and boxes, scattered evenly in a cube, one per unit of volume.
fn scattered(leaves: usize) -> String {
    let reach = 0.5 * (leaves as f64).cbrt();
    let mut numbers = Numbers(SEED);
    let mut text = String::new();
    for index in 0..leaves {
        let [x, y, z] = [0.0; 3].map(|_| numbers.between(-reach, reach));
        let [a, b, c] = [0.0; 3].map(|_| numbers.between(0.2, 0.5));
        // Writing to a `String` cannot fail.
        let _ = match index % 2 {
            0 => {
                writeln!(text, "box([{a:.3}, {b:.3}, {c:.3}]).translate([{x:.3}, {y:.3}, {z:.3}])")
            }
            _ => writeln!(text, "sphere({:.3}).translate([{x:.3}, {y:.3}, {z:.3}])", 0.6 * a),
        };
    }
    text + &seen_from(reach)
}

/// Returns balls on a winding path, each blended with all before it.
fn chained(leaves: usize) -> String {
    let mut numbers = Numbers(SEED);
    let mut text = "union(\n".to_owned();
    for index in 0..leaves {
        let turn = index as f64 * 0.1;
        let height = 6.0 * (index as f64 / leaves as f64 - 0.5);
        let wide = 1.6 + (0.37 * turn).sin();
        let [x, y, z] = [wide * turn.cos(), height, wide * turn.sin()];
        let [dx, dy, dz] = [0.0; 3].map(|_| numbers.between(-0.1, 0.1));
        let radius = numbers.between(0.08, 0.14);
        let (x, y, z) = (x + dx, y + dy, z + dz);
        let _ = writeln!(text, "  sphere({radius:.3}).translate([{x:.3}, {y:.3}, {z:.3}]),");
    }
    text + "  blend: smooth(0.03))\n" + &seen_from(3.0)
}

fn seen_from(reach: f64) -> String {
    let [x, y, z] = [1.5, 1.2, 2.4].map(|factor| factor * reach);
    format!("camera(eye: [{x:.2}, {y:.2}, {z:.2}], target: 0, fov: 40deg)\n")
        + "march(steps: 255, epsilon: 0.001)\n"
}

/// Returns a floor with a square of pairs on it, each a ball and a box joined by one of four
/// operations.
fn generated(leaves: usize) -> String {
    let pairs = leaves.saturating_sub(1) / 2;
    let side = (1..).find(|side| side * side >= pairs).unwrap_or(1);
    let reach = side as f64;
    let mut numbers = Numbers(SEED);
    // Writing to a `String` cannot fail.
    let mut text = "plane(y: -0.5)\n".to_owned();
    for index in 0..pairs {
        let [column, row] = [index % side, index / side]
            .map(|index| 1.6 * (index as f64 - (reach - 1.0) / 2.0) + numbers.between(-0.1, 0.1));
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

/// The upper bits of Knuth's linear congruential generator.
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
            let scene = sdfc::Compiler::new().compile("generated", &text).unwrap();
            assert_eq!(scene.diagnostics().to_string(), "", "{text}");
            assert_eq!(scene.report().leaves, leaves);
        }
    }
}
