//! Finds the pixels at silhouettes.

use crate::camera::Camera;
use crate::oracle::Verdict;

/// The kind of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Its ray and those of all its neighbours hit one surface, or nothing.
    Plain,
    /// Within a pixel of a silhouette.
    Edge,
    /// The oracle proved nothing.
    Undecided,
}

/// A step in depth is a silhouette if it is this many times what the slopes of both surfaces
/// explain.
const UNEXPLAINED: f64 = 2.0;

/// Returns the kind of each pixel. It is an edge if one of its eight neighbours shows something
/// else, or its depth differs by more than the slopes of both surfaces explain.
pub(crate) fn edges(camera: &Camera, verdicts: &[Verdict], gradients: &[[f64; 3]]) -> Vec<Kind> {
    let [width, height] = camera.size.map(|side| side as usize);
    let steepness: Vec<f64> =
        (0..verdicts.len()).map(|pixel| steepness(camera, pixel, &gradients[pixel])).collect();
    let differs = |a: usize, b: usize| match (verdicts[a], verdicts[b]) {
        (Verdict::Hit(t), Verdict::Hit(u)) => {
            let explained = camera.pixel_width(t.min(u)) * (steepness[a] + steepness[b]);
            // Without gradients this is NaN, and no step counts.
            (t - u).abs() > UNEXPLAINED * explained
        }
        (Verdict::Miss, Verdict::Miss) => false,
        (Verdict::Undecided(_), _) | (_, Verdict::Undecided(_)) => false,
        (Verdict::Hit(_), Verdict::Miss) | (Verdict::Miss, Verdict::Hit(_)) => true,
    };
    (0..verdicts.len())
        .map(|pixel| {
            let (x, y) = (pixel % width, pixel / width);
            let columns = x.saturating_sub(1)..(x + 2).min(width);
            let rows = y.saturating_sub(1)..(y + 2).min(height);
            let mut around = rows.flat_map(|y| columns.clone().map(move |x| y * width + x));
            match verdicts[pixel] {
                Verdict::Undecided(_) => Kind::Undecided,
                Verdict::Hit(_) | Verdict::Miss if around.any(|other| differs(pixel, other)) => {
                    Kind::Edge
                }
                Verdict::Hit(_) | Verdict::Miss => Kind::Plain,
            }
        })
        .collect()
}

/// Returns how much the depth of a surface changes to a diagonal neighbour, in widths of a pixel:
/// the tangent of the angle of incidence, plus one for curvature.
fn steepness(camera: &Camera, pixel: usize, gradient: &[f64; 3]) -> f64 {
    let direction = camera.ray(pixel).direction;
    let dot: f64 = gradient.iter().zip(&direction).map(|(a, b)| a * b).sum();
    let square: f64 = gradient.iter().map(|part| part * part).sum();
    let cosine = (dot * dot / square).min(1.0);
    1.0 + (2.0 * (1.0 - cosine) / cosine).sqrt()
}
