//! Fields that exceed the distance, or jump. If the compiler knows that, `interval`, and so `auto`,
//! finds what the oracle finds although steps as long as the field pass through the surface. If a
//! scene hides it from the compiler, the chart shows the errors.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Method, Scene};
use sdfc_measure::chart::Row;
use sdfc_measure::{ChartOptions, OracleOptions, chart};
use sdfc_render::{Gpu, no_progress, testing};
use sdfc_tests::agree;

const SIZE: [u32; 2] = [96, 54];
/// Largest error in depth (99th percentile), in widths of a pixel.
const DEPTH: f64 = 0.1;

/// Uncertified scenes: name and text.
const SCENES: [(&str, &str); 3] = [
    (
        "thin walls, the steeper the farther out",
        "solid fin() = max(abs(p.y) - 1, (abs(p.z) - 0.03) * (3 + dot(p, p)))
         fin().rotate(y: 30deg)
         fin().rotate(y: 80deg).translate(x: 0.4, z: -1)
         camera(eye: [0.5, 1, 4], target: [0, 0, 0], fov: 40deg)",
    ),
    (
        "pebbles that know only their own cell",
        "solid pebbles() = {
           let cell = floor(p.xz)
           let shift = 0.3 * sin(cell.x * 12.9 + cell.y * 78.2)
           let q = [p.x - cell.x - 0.5 - shift, p.y, p.z - cell.y - 0.5 + shift]
           max(length(q) - 0.18, abs(p.x) - 3, abs(p.z) - 3)
         }
         pebbles()
         camera(eye: [3, 2, 5], target: [0, 0, 0], fov: 40deg)
         march(steps: 512) // each wall of a cell takes a dozen stretches",
    ),
    (
        "a power that grows faster than its distance",
        "solid flower() = pow(length(p), 3) - 0.5 - 0.45 * sin(3 * atan2(p.z, p.x)) * pow(length(p.xz), 2)
         flower()
         camera(eye: [1, 2, 3], target: [0, 0, 0], fov: 40deg)",
    ),
];

/// Scenes that are certified because of false clauses.
const FALSE_CLAUSES: [(&str, &str); 2] = [
    (
        "a function that understates its slope",
        "fn steep(t) lipschitz 1 = if t > 0 { 4 * t } else { t }
         solid a() = steep(length(p) - 0.5)
         a()",
    ),
    (
        "a spike far thinner than samples lie apart",
        "solid a() lipschitz 1 bounds -1..1 =
           if abs(p.x) < 0.002 { 30 * (length(p) - 0.5) } else { length(p) - 0.5 }
         a()
         camera(eye: [0, 0, 3], target: 0, fov: 1deg)",
    ),
];

fn main() {
    let without_gpu = testing::without_gpu();
    let mut trials = Vec::new();
    for (name, text) in SCENES {
        let right = move || proven_is_right(name, text);
        trials.push(Trial::test(format!("right/{name}"), right).with_ignored_flag(without_gpu));
        let same = move || Ok(agree::devices(&agree::scene(name, text)?).map(drop)?);
        trials.push(Trial::test(format!("same/{name}"), same).with_ignored_flag(without_gpu));
    }
    for (name, text) in FALSE_CLAUSES {
        let seen = move || chart_shows(name, text);
        trials.push(Trial::test(format!("seen/{name}"), seen).with_ignored_flag(without_gpu));
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn proven_is_right(name: &str, text: &str) -> Result<(), Failed> {
    let scene = agree::scene(name, text)?;
    if scene.is_certified() || scene.marched_by(Method::Auto) != Method::Interval {
        return Err("the scene is not one that `auto` leaves to `interval`".into());
    }
    let rows = rows(&scene, name, &[Method::Sphere, Method::Interval, Method::Auto])?;
    let [sphere, proven @ ..] = &rows[..] else { return Err("no rows".into()) };
    if sphere.missed == 0 {
        return Err("steps as long as the field miss nothing: the scene tests nothing".into());
    }
    for Row { method, missed, false_hits, nan, capped, depth_px, .. } in proven {
        let wrong = [("missed", missed), ("false", false_hits), ("NaN", nan), ("capped", capped)];
        if let Some((what, count)) = wrong.into_iter().find(|(_, count)| **count > 0) {
            return Err(format!("{method}: {count} pixels are {what}").into());
        }
        if depth_px.p99 > DEPTH {
            return Err(format!("{method}: depths are off by {:.4} px (p99)", depth_px.p99).into());
        }
    }
    Ok(())
}

/// Steps as long as the field pass through the surface; the chart of a scene that counts as
/// certified shows it.
fn chart_shows(name: &str, text: &str) -> Result<(), Failed> {
    let scene = agree::scene(name, text)?;
    if !scene.is_certified() {
        return Err("the compiler knows that the clause is false".into());
    }
    let rows = rows(&scene, name, &[Method::Sphere])?;
    let [Row { missed, false_hits, depth_px, .. }] = &rows[..] else { return Err("no row".into()) };
    if missed + false_hits == 0 && depth_px.p99 <= 1.0 {
        return Err("`sphere` draws it right".into());
    }
    Ok(())
}

/// Returns the rows of these methods in the scene's chart.
fn rows(scene: &Scene, name: &str, methods: &[Method]) -> Result<Vec<Row>, Failed> {
    let methods = methods.to_vec();
    let once = ChartOptions::new().repetitions(1).defaults_only(true);
    let options = once.size(SIZE).methods(methods);
    let oracle = OracleOptions::default();
    Ok(chart(scene, name, &Gpu::new()?, &options, oracle, &mut no_progress)?.methods)
}
