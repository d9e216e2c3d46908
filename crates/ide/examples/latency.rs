//! Times how long the answers to a keystroke take, in scenes of 1, 30, 300 and 3,000 leaves, while
//! a call at the end of the scene is typed: the diagnostics, those that elaboration adds, and the
//! completion.
#![allow(missing_docs, clippy::print_stdout, reason = "it is a benchmark")]

use std::time::{Duration, Instant};

use sdfc_ide::{Analysis, NoFiles, complete, diagnostics, late_diagnostics};

/// The text that is typed, one character after the other.
const TYPED: &str = "sphere(1).translate(x: 1)";

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
    println!(
        "| leaves | bytes | diagnostics, p50 | p99 | late, p50 | p99 | completion, p50 | p99 |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for leaves in [1, 30, 300, 3000] {
        let start = scene(leaves);
        let whole = Analysis::new("scene.sdf", &start, &NoFiles);
        assert!(diagnostics(&whole, false).is_empty(), "the scene has errors");
        let (mut quick, mut late, mut completions) = (Vec::new(), Vec::new(), Vec::new());
        // The first round fills caches.
        for round in 0..5 {
            for end in 1..=TYPED.len() {
                let text = format!("{start}{}", &TYPED[..end]);
                let before = Instant::now();
                let scene = Analysis::new("scene.sdf", &text, &NoFiles);
                let found = diagnostics(&scene, false);
                let checked = before.elapsed();
                let before = Instant::now();
                let more = late_diagnostics(&scene, &NoFiles);
                let elaborated = before.elapsed();
                let before = Instant::now();
                let list = complete("scene.sdf", &text, text.len(), &NoFiles, &[]);
                let completed = before.elapsed();
                std::hint::black_box((&found, more, list));
                if round > 0 {
                    quick.push(checked);
                    completions.push(completed);
                    // A text with errors is not elaborated.
                    late.extend(found.is_empty().then_some(elaborated));
                }
            }
        }
        let columns = [&mut quick, &mut late, &mut completions]
            .map(|times| format!("{:.1} | {:.1}", percentile(times, 50), percentile(times, 99)));
        println!("| {leaves} | {} | {} |", start.len(), columns.join(" | "));
    }
}
