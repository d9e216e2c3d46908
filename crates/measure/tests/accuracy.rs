//! Compares `auto` with the oracle and with other methods, on every scene under `examples`. All
//! certified scenes have the same bounds. The other scenes are listed, each with a reason and its
//! own bounds.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::Method;
use sdfc_measure::chart::Row;
use sdfc_measure::{ChartOptions, OracleOptions, chart};
use sdfc_render::{Gpu, no_progress, testing};
use sdfc_test_support::example_sources;

/// Limits for a scene, drawn at a size. In all scenes no pixel is missed, false, out of steps or
/// NaN.
struct Bound {
    size: [u32; 2],
    /// Largest fraction of the pixels that the oracle may leave undecided.
    undecided: f64,
}

const CERTIFIED: Bound = Bound { size: [64, 36], undecided: 1e-3 };

/// Largest error of normals on smooth surfaces (99th percentile), in degrees.
const NORMAL: f64 = 1e-3;

/// Largest error in depth (99th percentile), in widths of a pixel: for scenes of a few leaves, and
/// of more.
const DEPTH: [f64; 2] = [0.05, 0.1];
const FEW_LEAVES: usize = 30;

/// `auto` and the methods that it is compared with: none of them takes fewer operations with
/// smaller errors.
const METHODS: [Method; 6] = [
    Method::Auto,
    Method::Sphere,
    Method::SphereCone,
    Method::Relaxed,
    Method::Accelerated,
    Method::AutoRelaxed,
];

/// Largest number of evaluations per pixel, relative to `sphere-cone`.
const EVALUATIONS: f64 = 0.5;

/// Scenes that take more, each with the reason and its limit.
const EXPENSIVE: &[(&str, &str, f64)] = &[
    ("terrain.sdf", "hills of noise: nothing is analytic, and every ray grazes it", 0.8),
    ("bench/thirty.sdf", "one chain of blends without a floor: nothing is analytic", 0.8),
    (
        "pawn.sdf",
        "the board is a rounded box, cheaper to march than to intersect analytically",
        0.55,
    ),
];

/// A scene of hundreds of leaves, unlike any example. Drivers take long for its shaders, so only
/// `auto` is drawn.
const MANY: &str = "three hundred leaves";

/// Scenes with weaker limits, each with the reason.
const EXCEPTIONS: &[(&str, &str, Bound)] = &[(
    "mandelbulb.sdf",
    "its field is an estimate without a constant, and intervals over its rounds prove misses alone",
    Bound { size: [8, 5], undecided: 0.4 },
)];

fn main() {
    let without_gpu = testing::without_gpu();
    let trial = |(name, text): (String, String)| {
        let title = name.clone();
        Trial::test(title, move || auto_is_right(&name, &text)).with_ignored_flag(without_gpu)
    };
    let mut files = example_sources().expect("the examples can be read");
    files.push((MANY.to_owned(), many()));
    let listed = EXCEPTIONS.iter().map(|it| it.0).chain(EXPENSIVE.iter().map(|it| it.0));
    for listed in listed {
        assert!(files.iter().any(|(name, _)| *name == listed), "there is no {listed}");
    }
    let trials = files.into_iter().map(trial).collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// Returns pairs of a ball and a ring at positions far from each other.
fn many() -> String {
    let pair = |index: i32| {
        let position = [0.819_172_5, 0.671_043_6, 0.549_700_5]
            .map(|step: f64| 8.0 * (step * f64::from(index)).fract() - 4.0);
        format!("union(sphere(0.3), torus(0.4, 0.1), blend: smooth(0.1)).translate({position:?})\n")
    };
    let parts: String = (0..150).map(pair).collect();
    parts + "camera(eye: [5, 4, 8], target: 0, fov: 40deg)\n"
}

fn auto_is_right(name: &str, text: &str) -> Result<(), Failed> {
    let scene = sdfc::Compiler::new().compile(name, text)?;
    let exception = EXCEPTIONS.iter().find(|(listed, ..)| *listed == name);
    if !scene.is_certified() && exception.is_none() {
        return Err("the scene is not certified, and not on the list of those that are not".into());
    }
    let Bound { size, undecided } = exception.map_or(&CERTIFIED, |(.., bound)| bound);
    let pixels = f64::from(size[0] * size[1]);
    let gpu = Gpu::new()?;
    let is_alone = exception.is_some() || name == MANY;
    let methods = if is_alone { METHODS[..1].to_vec() } else { METHODS.to_vec() };
    let once = ChartOptions::new().repetitions(1).defaults_only(true);
    let options = once.size(*size).methods(methods);
    let chart = chart(&scene, name, &gpu, &options, OracleOptions::default(), &mut no_progress);
    if scene.is_planar() {
        // Regions have no rays, and a chart of them is refused.
        return match chart {
            Err(sdfc::Error::Planar(_)) => Ok(()),
            other => Err(format!("a chart of regions: {:?}", other.map(drop)).into()),
        };
    }
    let chart = chart?;
    let open = chart.oracle.undecided as f64 / pixels;
    if open > *undecided {
        return Err(format!("the oracle leaves {open:.4} of the pixels undecided").into());
    }
    let row = chart.methods.first().ok_or("no row for `auto`")?;
    let Row { missed, false_hits, capped, nan, depth_px, normal_deg, .. } = row;
    let wrong = [("missed", missed), ("false", false_hits), ("out of steps", capped), ("NaN", nan)];
    if let Some((what, count)) = wrong.into_iter().find(|(_, count)| **count > 0) {
        return Err(format!("{count} pixels are {what}").into());
    }
    if depth_px.p99 > DEPTH[usize::from(chart.leaves > FEW_LEAVES)] {
        return Err(format!("depths are off by {:.4} of a pixel (p99)", depth_px.p99).into());
    }
    if normal_deg.p99 > NORMAL {
        return Err(format!("normals are off by {:.5} degrees (p99)", normal_deg.p99).into());
    }
    if let Some(other) = chart.outdoing("auto").first() {
        return Err(format!("`{}` is cheaper and nearer", other.method).into());
    }
    if let Some(cone) = chart.methods.iter().find(|row| row.method == "sphere-cone") {
        let fraction = row.evals_per_pixel.mean / cone.evals_per_pixel.mean;
        let expensive = EXPENSIVE.iter().find(|(listed, ..)| *listed == name);
        if fraction > expensive.map_or(EVALUATIONS, |it| it.2)
            || row.depth_px.p99 > cone.depth_px.p99
        {
            return Err(format!("{fraction:.2} of the evaluations of `sphere-cone`").into());
        }
    }
    Ok(())
}
