//! Fields that exceed the distance, or jump: `interval`, and `auto` by it, find what the oracle finds where steps as long
//! as the field lead through.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

mod common;

use common::agree;
use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::accuracy_data::chart::Row;
use sdfc::render::{Gpu, testing};
use sdfc::{ChartOptions, OracleOptions, unwatched};

const SIZE: [u32; 2] = [96, 54];
/// Error in depth that 99 of 100 pixels keep, in widths of a pixel.
const DEPTH: f64 = 0.1;

/// Scenes that are uncertified: name and text.
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

fn main() {
    let without_gpu = testing::without_gpu();
    let mut trials = Vec::new();
    for (name, text) in SCENES {
        let right = move || proven_is_right(name, text);
        trials.push(Trial::test(format!("right/{name}"), right).with_ignored_flag(without_gpu));
        let same = move || agree::devices(&agree::scene(name, text)?).map(drop);
        trials.push(Trial::test(format!("same/{name}"), same).with_ignored_flag(without_gpu));
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn proven_is_right(name: &str, text: &str) -> Result<(), Failed> {
    let scene = agree::scene(name, text)?;
    if scene.is_certified() || scene.marched_by("auto") != "interval" {
        return Err("the scene is not one that `auto` leaves to `interval`".into());
    }
    let methods = ["sphere", "interval", "auto"].map(str::to_owned).to_vec();
    let once = ChartOptions { repetitions: 1, defaults_only: true, ..ChartOptions::default() };
    let options = ChartOptions { size: SIZE, methods, ..once };
    let chart =
        scene.chart(name, &Gpu::new()?, &options, OracleOptions::default(), &mut unwatched)?;
    let [sphere, proven @ ..] = &chart.methods[..] else { return Err("no rows".into()) };
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
