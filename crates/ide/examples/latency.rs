//! Times how long the diagnostics and the completion of a keystroke take, in scenes of 1, 30 and
//! 300 leaves, while a word at the end of the scene is typed and deleted.
#![allow(missing_docs, clippy::print_stdout, reason = "it is a benchmark")]

use std::time::{Duration, Instant};

use sdfc_ide::{Analysis, NoFiles, complete, diagnostics};

/// A union of moved shapes of three kinds.
fn scene(leaves: usize) -> String {
    let leaf = |at: usize| {
        let shape =
            ["sphere(0.3)", "box([0.3, 0.2, 0.1])", "torus(major: 0.3, minor: 0.1)"][at % 3];
        let (x, z) = (at % 20, at / 20);
        format!("let part{at} = {shape}.translate([{x}, 0, {z}]).rotate(y: {at}deg)\npart{at}\n")
    };
    (0..leaves).map(leaf).collect()
}

fn percentile(times: &mut [Duration], part: usize) -> f64 {
    times.sort();
    let at = (times.len() * part / 100).min(times.len().saturating_sub(1));
    times.get(at).map_or(0.0, Duration::as_secs_f64) * 1e3
}

fn main() {
    println!("leaves | diagnostics p50, p99 | completion p50, p99 (ms)");
    for leaves in [1, 30, 300, 3000] {
        let start = scene(leaves);
        let (mut checks, mut completions) = (Vec::new(), Vec::new());
        for at in 0..60 {
            let word = "sphere(1).translate(x: 1)";
            let typed = &word[..1 + at % word.len()];
            let text = format!("{start}{typed}");
            let before = Instant::now();
            let found = diagnostics(&Analysis::new("scene.sdf", &text, &NoFiles), false);
            checks.push(before.elapsed());
            let before = Instant::now();
            let list = complete("scene.sdf", &text, text.len(), &NoFiles, &[]);
            completions.push(before.elapsed());
            std::hint::black_box((found, list));
        }
        let [a, b] = [50, 99].map(|part| percentile(&mut checks, part));
        let [c, d] = [50, 99].map(|part| percentile(&mut completions, part));
        println!("{leaves:6} | {a:6.2} {b:6.2} | {c:6.2} {d:6.2}");
    }
}
