//! Measures how long each stage takes from a scene's source to a validated module, as medians of
//! repeated runs in one process. Run it with `cargo bench -p sdfc --bench compile`.
//!
//! The row `library read` is a single sphere before anything else was compiled. Its difference to
//! `one sphere` is the time of reading the library, and of everything else that a process does only
//! once. Other work on the machine counts in all columns but the last.

use cpu_time::ProcessTime;
use sdfc::{Compiler, Method};

/// Runs of each scene, plus a first run, which reads the library and is not counted.
const RUNS: usize = 21;
/// The same for scenes of ten thousand leaves.
const FEW_RUNS: usize = 6;

/// Rotated leaves.
const ROTATED: &str = "box([0.2, 0.3, 0.1]).rotate(x: i * 1deg, y: i * 2deg, z: i * 3deg).round(";

fn main() {
    // `cargo test --benches` passes no `--bench`: then nothing is measured.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let first = times("one sphere", "sphere(1)\n");
    let scenes = [
        ("one sphere", "sphere(1)\n".to_owned()),
        ("course/blend", include_str!("../../../examples/course/blend.sdf").to_owned()),
        ("bench/thirty", include_str!("../../../examples/bench/thirty.sdf").to_owned()),
        ("100 hard", many(100, "min")),
        ("1000 hard", many(1000, "min")),
        ("1000 smooth", many(1000, "smooth(0.05)")),
        ("1000 rotated", many(1000, "smooth(0.05)").replace("sphere(", ROTATED)),
        ("10000 hard", many(10_000, "min")),
        ("10000 smooth", many(10_000, "smooth(0.05)")),
    ];
    let mut table = String::from(
        "scene           front  analyze    lower  validate    total  processor  (ms, median)\n",
    );
    table.push_str(&row("library read", first));
    for (name, text) in &scenes {
        table.push_str(&row(name, median_times(name, text)));
    }
    // A benchmark is a program; it may print.
    #[allow(clippy::print_stdout)]
    {
        print!("{table}");
    }
}

fn row(name: &str, times: [f64; 5]) -> String {
    let [front, analyze, lower, validate, processor] = times;
    let total = front + analyze + lower + validate;
    format!(
        "{name:<13} {front:>7.2}  {analyze:>7.2}  {lower:>7.2}  {validate:>8.2}  {total:>7.2}  {processor:>9.2}\n"
    )
}

/// Returns a scene with this number of leaves, moved and rotated, joined by a blend.
fn many(leaves: usize, blend: &str) -> String {
    format!(
        "union(for i in 0..{leaves}: sphere(0.1 + 0.05 * sin(7 * i)).translate([3 * sin(i * 12.9898), \
         3 * sin(i * 78.233), 3 * sin(i * 37.719)]), blend: {blend})\n"
    )
}

fn median_times(name: &str, text: &str) -> [f64; 5] {
    let count = if name.starts_with("10000") { FEW_RUNS } else { RUNS };
    let mut runs: Vec<[f64; 5]> = (0..count).map(|_| times(name, text)).skip(1).collect();
    std::array::from_fn(|stage| {
        runs.sort_by(|a, b| a[stage].total_cmp(&b[stage]));
        runs[runs.len() / 2][stage]
    })
}

fn times(name: &str, text: &str) -> [f64; 5] {
    let processor = ProcessTime::now();
    let Ok(scene) = Compiler::new().compile(name, text) else {
        return [f64::NAN; 5];
    };
    let start = std::time::Instant::now();
    let Ok(shader) = scene.picture_shader(Method::Auto) else {
        return [f64::NAN; 5];
    };
    let linked = start.elapsed().as_secs_f64() * 1e3;
    let processor = processor.elapsed().as_secs_f64() * 1e3;
    let validate = shader.validation_time().as_secs_f64() * 1e3;
    let front = scene.times();
    [front.front, front.analyze, linked - validate, validate, processor]
}
