//! `auto` against the oracle, on every certified scene under `examples`.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

mod common;

use common::examples::scene_files;
use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::accuracy_data::chart::Row;
use sdfc::render::{Gpu, testing};
use sdfc::{ChartOptions, OracleOptions, unwatched};

const SIZE: [u32; 2] = [96, 54];
/// Most of a picture's pixels that the oracle may leave undecided.
const UNDECIDED: f64 = 1e-3;
/// Error in depth that 99 of 100 pixels keep, in widths of a pixel.
const DEPTH: f64 = 0.1;
/// Error of normals that 99 of 100 pixels of smooth surfaces keep, in degrees.
const NORMAL: f64 = 1e-3;
/// Of a scene whose curvature has no limit: that of an involute grows without end towards its base circle, where roundings of
/// the point turn its normal more the nearer it lies.
const INVOLUTE: (&str, f64) = ("examples/gear", 5e-3);

fn main() {
    let without_gpu = testing::without_gpu();
    let trial = |(name, text): (String, String)| {
        // Of fields that may lie the test `lying` has its own.
        let uncertified = sdfc::compile(&name, &text).scene.is_some_and(|s| !s.is_certified());
        let title = name.clone();
        Trial::test(title, move || auto_is_right(&name, &text))
            .with_ignored_flag(without_gpu || uncertified)
    };
    let trials = scene_files().into_iter().map(trial).collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn auto_is_right(name: &str, text: &str) -> Result<(), Failed> {
    let scene = sdfc::compile(name, text).scene.ok_or("the scene does not compile")?;
    let gpu = Gpu::new()?;
    let methods = vec!["auto".to_owned()];
    let once = ChartOptions { repetitions: 1, defaults_only: true, ..ChartOptions::default() };
    let options = ChartOptions { size: SIZE, methods, ..once };
    let chart = scene.chart(name, &gpu, &options, OracleOptions::default(), &mut unwatched)?;
    let undecided = chart.oracle.undecided as f64 / f64::from(SIZE[0] * SIZE[1]);
    if undecided > UNDECIDED {
        return Err(format!("the oracle leaves {undecided:.4} of the pixels undecided").into());
    }
    let row = chart.methods.first().ok_or("no row for `auto`")?;
    let Row { missed, false_hits, nan, depth_px, normal_deg, .. } = row;
    let wrong = [("missed", missed), ("false", false_hits), ("NaN", nan)];
    if let Some((what, count)) = wrong.into_iter().find(|(_, count)| **count > 0) {
        return Err(format!("{count} pixels are {what}").into());
    }
    if depth_px.p99 > DEPTH {
        return Err(format!("depths are off by {:.4} of a pixel (p99)", depth_px.p99).into());
    }
    let normal = if name == INVOLUTE.0 { INVOLUTE.1 } else { NORMAL };
    if normal_deg.p99 > normal {
        return Err(format!("normals are off by {:.5} degrees (p99)", normal_deg.p99).into());
    }
    Ok(())
}
