//! Dense sampling of a field along the rays of a picture, in f64.

use sdfc_render::{HIT, Image, MISS, RenderError, View};

/// Samples of a ray, over twice the distance from the eye to the origin.
const SAMPLES: usize = 3000;
/// Thirds by which a minimum between samples is approached.
const THIRDS: usize = 40;
/// Halvings of the step in which the sign changes.
const HALVINGS: usize = 50;

/// Draws where the rays of a picture first enter a solid: status and depth, no colours.
pub fn dense(field: impl Fn([f64; 3]) -> f64, view: &View) -> Result<Image, RenderError> {
    let mut image = Image::new(view.size, view.footprint())?;
    let width = view.size[0];
    for (index, pixel) in (0..).zip(image.pixels_mut()) {
        let [origin, direction] = view.ray(index % width, index / width);
        let end = 2.0 * view.eye.length();
        let root = first_root(|t| field((origin + direction * t).to_array()), end);
        pixel.status = if root.is_some() { HIT } else { MISS };
        pixel.depth = root.unwrap_or(end) as f32;
    }
    Ok(image)
}

/// The first position at which a function is negative.
fn first_root(f: impl Fn(f64) -> f64, end: f64) -> Option<f64> {
    let at = |index: usize| end * index as f64 / SAMPLES as f64;
    let values: Vec<f64> = (0..=SAMPLES).map(|index| f(at(index))).collect();
    if values[0] < 0.0 {
        return Some(0.0);
    }
    let [mut outside, mut inside] = (1..=SAMPLES).find_map(|index| {
        if values[index] < 0.0 {
            return Some([at(index - 1), at(index)]);
        }
        // A wall thinner than the step may lie about a minimum.
        let next = values.get(index + 1).copied().unwrap_or(f64::INFINITY);
        let dips = values[index] <= values[index - 1] && values[index] <= next;
        let lowest = dips.then(|| lowest(&f, at(index - 1), at(index + 1)))?;
        (f(lowest) < 0.0).then_some([at(index - 1), lowest])
    })?;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (outside + inside);
        if f(middle) < 0.0 { inside = middle } else { outside = middle }
    }
    Some(inside)
}

/// Where a function with one minimum between two positions is least.
fn lowest(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let (mut from, mut to) = (from, to);
    for _ in 0..THIRDS {
        let third = (to - from) / 3.0;
        if f(from + third) < f(to - third) { to -= third } else { from += third }
    }
    0.5 * (from + to)
}
