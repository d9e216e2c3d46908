//! Metrics of a picture: how far it is from the oracle's verdict.

use rayon::prelude::*;
use sdfc_graph::eval::FrameValues;

use crate::edges::Kind;
use crate::normals::{Normal, normal_error};
use crate::oracle::{Oracle, Prober, Verdict};
use crate::truth::Truth;

/// Fraction of a pixel's width by which a ray must pass or enter a surface before a wrong result at
/// an edge counts as an error of the method.
const CLEARANCE: f64 = 0.25;
/// Number of samples along a ray that measure how deep a missed surface is.
const CROSSING: u32 = 64;

/// How a method's ray ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// At a surface.
    Hit,
    /// At its end, without a hit.
    Miss,
    /// Out of steps (capped).
    Capped,
}

/// The result of a ray method for one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelSample {
    /// How its ray ended.
    pub status: Status,
    /// Distance along the ray at which it ended, in scene units.
    pub t: f64,
    /// Number of field evaluations for the primary ray.
    pub evaluations: u32,
    /// Normal at the hit; `None` if the picture does not store normals.
    pub normal: Option<Normal>,
}

/// Quantiles of a list of errors; all 0 if the list is empty.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Quantiles {
    /// Number of values.
    pub n: u64,
    /// Median.
    pub p50: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Maximum.
    pub max: f64,
}

/// Field evaluations per pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Evaluations {
    /// Mean over all pixels.
    pub mean: f64,
    /// 99th percentile.
    pub p99: u32,
    /// Maximum.
    pub max: u32,
}

/// Errors in depth, over plain pixels that are hit in the picture and by the oracle.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Depth {
    /// In widths of a pixel at the hit.
    pub pixels: Quantiles,
    /// Relative to the distance.
    pub relative: Quantiles,
}

/// The errors and the cost of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Metrics {
    /// Rays that passed through a surface; at an edge only by more than a quarter of a pixel.
    pub missed: u64,
    /// Rays that ended where there is no surface; at an edge only if farther than a quarter of a
    /// pixel from one.
    pub false_hits: u64,
    /// Errors in depth.
    pub depth: Depth,
    /// Angle in degrees between the picture's normal and the field's gradient in f64 at the same
    /// point, over plain pixels where the surface is smooth.
    pub normal: Quantiles,
    /// Pixels hit in the picture or by the oracle but not in both, as a fraction of those hit in
    /// either.
    pub silhouette: f64,
    /// Rays out of steps.
    pub capped: u64,
    /// Rays whose end is NaN.
    pub nan: u64,
    /// Field evaluations per pixel.
    pub evaluations: Evaluations,
}

/// Compares a picture, given row by row, with the oracle's verdict. If one is shorter, the rest of
/// the other is ignored.
pub fn compare(
    oracle: &Oracle,
    frame: &FrameValues,
    truth: &Truth,
    picture: &[PixelSample],
) -> Metrics {
    let count = truth.verdicts.len().min(picture.len());
    let judged: Vec<(Judgement, Option<f64>)> = (0..count)
        .into_par_iter()
        .map_init(
            || oracle.prober(frame),
            |prober, pixel| {
                let angle = angle(prober, truth, pixel, picture[pixel]);
                (judge(prober, truth, pixel, picture[pixel]), angle)
            },
        )
        .collect();
    let (judged, angles): (Vec<Judgement>, Vec<Option<f64>>) = judged.into_iter().unzip();
    let number = |judgement: Judgement| {
        judged
            .iter()
            .filter(|found| std::mem::discriminant(*found) == std::mem::discriminant(&judgement))
            .count() as u64
    };
    let errors = |pick: fn(f64, f64) -> f64| {
        let of = |found: &Judgement| match *found {
            Judgement::Right { pixels, relative } => Some(pick(pixels, relative)),
            Judgement::Missed | Judgement::False | Judgement::Nan | Judgement::Apart => None,
        };
        quantiles(judged.iter().filter_map(of).collect())
    };
    Metrics {
        missed: number(Judgement::Missed),
        false_hits: number(Judgement::False),
        depth: Depth {
            pixels: errors(|pixels, _| pixels),
            relative: errors(|_, relative| relative),
        },
        normal: quantiles(angles.into_iter().flatten().collect()),
        silhouette: silhouette(truth, picture),
        capped: picture.iter().filter(|pixel| pixel.status == Status::Capped).count() as u64,
        nan: number(Judgement::Nan),
        evaluations: evaluations(picture),
    }
}

/// The comparison of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Judgement {
    /// A hit where there is one, with its errors in depth.
    Right {
        pixels: f64,
        relative: f64,
    },
    Missed,
    False,
    Nan,
    /// A correct miss, an edge, or undecided.
    Apart,
}

fn judge(prober: &mut Prober<'_>, truth: &Truth, pixel: usize, seen: PixelSample) -> Judgement {
    if seen.t.is_nan() {
        return Judgement::Nan;
    }
    let edge = match truth.kinds[pixel] {
        Kind::Undecided => return Judgement::Apart,
        Kind::Edge => true,
        Kind::Plain => false,
    };
    match (truth.verdicts[pixel], seen.status) {
        (Verdict::Miss | Verdict::Undecided(_), Status::Miss | Status::Capped) => Judgement::Apart,
        (Verdict::Miss | Verdict::Undecided(_), Status::Hit) => {
            far_from_surface(prober, truth, pixel, seen.t, edge)
        }
        (Verdict::Hit(t), Status::Miss | Status::Capped) => {
            let ends = if seen.status == Status::Miss { truth.camera.t_max } else { seen.t };
            if ends < t {
                return Judgement::Apart;
            }
            led_through(prober, truth, pixel, [t, ends], edge)
        }
        (Verdict::Hit(t), Status::Hit) => {
            let error = seen.t - t;
            let width = truth.camera.pixel_width(t);
            if !edge {
                return Judgement::Right {
                    pixels: error.abs() / width.max(f64::MIN_POSITIVE),
                    relative: error.abs() / t.max(f64::MIN_POSITIVE),
                };
            }
            if error.abs() <= width {
                Judgement::Apart
            } else if error < 0.0 {
                far_from_surface(prober, truth, pixel, seen.t, edge)
            } else {
                led_through(prober, truth, pixel, [t, seen.t], edge)
            }
        }
    }
}

/// Returns the error of the normal at a plain pixel's hit. `None` for a ray that starts inside: it
/// has no surface.
fn angle(prober: &mut Prober<'_>, truth: &Truth, pixel: usize, seen: PixelSample) -> Option<f64> {
    let is_plain = truth.kinds[pixel] == Kind::Plain && seen.status == Status::Hit && seen.t > 0.0;
    let is_hit = matches!(truth.verdicts[pixel], Verdict::Hit(_)) && is_plain;
    let normal = seen.normal.filter(|_| is_hit)?;
    normal_error(prober, truth.camera.pixel_width(seen.t), normal)
}

/// Returns 1 - intersection over union of the pixels hit by the oracle and in the picture.
fn silhouette(truth: &Truth, picture: &[PixelSample]) -> f64 {
    let known = truth.verdicts.iter().zip(picture);
    let hits = known.filter_map(|(verdict, seen)| match verdict {
        Verdict::Hit(_) => Some([true, seen.status == Status::Hit]),
        Verdict::Miss => Some([false, seen.status == Status::Hit]),
        Verdict::Undecided(_) => None,
    });
    let (mut either, mut both) = (0u64, 0u64);
    for [real, seen] in hits {
        either += u64::from(real || seen);
        both += u64::from(real && seen);
    }
    if either == 0 { 0.0 } else { (either - both) as f64 / either as f64 }
}

/// Judges a ray that ended where the oracle found no surface.
fn far_from_surface(
    prober: &mut Prober<'_>,
    truth: &Truth,
    pixel: usize,
    t: f64,
    edge: bool,
) -> Judgement {
    let clearance = prober.distance(truth.camera.ray(pixel).at(t)).abs();
    let excused = edge && clearance <= CLEARANCE * truth.camera.pixel_width(t);
    if excused { Judgement::Apart } else { Judgement::False }
}

/// Judges a ray that passed a surface.
fn led_through(
    prober: &mut Prober<'_>,
    truth: &Truth,
    pixel: usize,
    [from, to]: [f64; 2],
    edge: bool,
) -> Judgement {
    let ray = truth.camera.ray(pixel);
    let excused = CLEARANCE * truth.camera.pixel_width(from);
    // A ray that is no deeper than this inside leaves the surface again within one pixel or, on a
    // grazed flank, within many. The samples are therefore spaced with growing steps.
    let depth = (0..CROSSING)
        .map(|step| from + excused * 1.25f64.powi(step as i32))
        .take_while(|t| *t < to)
        .map(|t| -prober.distance(ray.at(t)))
        .fold(0.0, f64::max);
    if edge && depth <= excused { Judgement::Apart } else { Judgement::Missed }
}

fn quantiles(mut values: Vec<f64>) -> Quantiles {
    values.sort_by(f64::total_cmp);
    let [p50, p99, max] = [0.5, 0.99, 1.0].map(|part| rank(&values, part));
    Quantiles { n: values.len() as u64, p50, p99, max }
}

/// Returns a quantile of a sorted list by nearest rank; the default for an empty list.
fn rank<T: Copy + Default>(values: &[T], part: f64) -> T {
    let index = (part * values.len() as f64).ceil() as usize;
    values.get(index.saturating_sub(1)).copied().unwrap_or_default()
}

fn evaluations(picture: &[PixelSample]) -> Evaluations {
    let mut counts: Vec<u32> = picture.iter().map(|pixel| pixel.evaluations).collect();
    counts.sort_unstable();
    let sum: u64 = counts.iter().map(|count| u64::from(*count)).sum();
    Evaluations {
        mean: sum as f64 / counts.len().max(1) as f64,
        p99: rank(&counts, 0.99),
        max: rank(&counts, 1.0),
    }
}
