//! How far a picture is from the truth.

use rayon::prelude::*;
use sdfc_graph::eval::FrameValues;

use crate::edges::Kind;
use crate::normals::{Normal, normal_error};
use crate::oracle::{Oracle, Prober, Verdict};
use crate::truth::Truth;

/// Part of a pixel by which a ray must lead past a surface, or into it, before a wrong verdict at an
/// edge is the method's fault and not the pixel's.
const CLEARANCE: f64 = 0.25;
/// Samples along a ray by which the depth of what it crossed is judged.
const CROSSING: u32 = 64;

/// How a method's ray ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// At a surface.
    Hit,
    /// At its end.
    Miss,
    /// Out of steps.
    Capped,
}

/// What a method says of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelSample {
    /// How its ray ended.
    pub status: Status,
    /// Where, in scene units along the ray.
    pub t: f64,
    /// Evaluations of the field for the ray from the eye.
    pub evaluations: u32,
    /// Of what was hit; `None` where the picture does not tell.
    pub normal: Option<Normal>,
}

/// Of a sorted list: the middle, the 99th of 100, the last. Of an empty one they say nothing, and are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Quantiles {
    /// How many there are.
    pub n: u64,
    /// The middle.
    pub p50: f64,
    /// 99 of 100 are at most this.
    pub p99: f64,
    /// The greatest.
    pub max: f64,
}

/// Evaluations per pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Evaluations {
    /// Of all pixels.
    pub mean: f64,
    /// 99 of 100 pixels take at most so many.
    pub p99: u32,
    /// The most that one took.
    pub max: u32,
}

/// Errors in depth, over plain pixels that both hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Depth {
    /// In widths of a pixel there.
    pub pixels: Quantiles,
    /// In parts of the distance.
    pub relative: Quantiles,
}

/// A picture against the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Metrics {
    /// Rays that led through a surface; at an edge only by more than a quarter of a pixel.
    pub missed: u64,
    /// Rays that ended where no surface is; at an edge only farther than a quarter of a pixel from one.
    pub false_hits: u64,
    /// Errors in depth.
    pub depth: Depth,
    /// Angle in degrees between the picture's normal and the field's gradient in f64 where the picture takes it, over plain
    /// pixels where the surface is smooth.
    pub normal: Quantiles,
    /// What is hit in the picture or in truth but not in both, as a part of what is hit in either.
    pub silhouette: f64,
    /// Rays out of steps.
    pub capped: u64,
    /// Rays that ended nowhere.
    pub nan: u64,
    /// Evaluations per pixel.
    pub evaluations: Evaluations,
}

/// Compares a picture, row by row, with the truth. Pixels beyond the shorter of both are ignored.
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

/// What becomes of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Judgement {
    /// A hit where one is, off by so much.
    Right {
        pixels: f64,
        relative: f64,
    },
    Missed,
    False,
    Nan,
    /// Rightly nothing, or at an edge, or not known.
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

/// By how much the normal of a plain pixel's hit is off. A ray that starts inside is at its hit at once, and meets no
/// surface.
fn angle(prober: &mut Prober<'_>, truth: &Truth, pixel: usize, seen: PixelSample) -> Option<f64> {
    let is_plain = truth.kinds[pixel] == Kind::Plain && seen.status == Status::Hit && seen.t > 0.0;
    let is_hit = matches!(truth.verdicts[pixel], Verdict::Hit(_)) && is_plain;
    let normal = seen.normal.filter(|_| is_hit)?;
    normal_error(prober, truth.camera.pixel_width(seen.t), normal)
}

/// 1 - the intersection over the union of what is hit in truth and in the picture.
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

/// Of a ray that ended at a distance where the truth has no surface.
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

/// Of a ray that went on past a surface.
fn led_through(
    prober: &mut Prober<'_>,
    truth: &Truth,
    pixel: usize,
    [from, to]: [f64; 2],
    edge: bool,
) -> Judgement {
    let ray = truth.camera.ray(pixel);
    let excused = CLEARANCE * truth.camera.pixel_width(from);
    // Past a surface no deeper than that, the ray is out again within the reach of a pixel or, on a
    // flank, of many: looked at in steps that grow.
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

/// The value that a part of a sorted list does not exceed (nearest rank); the default for an empty one.
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
