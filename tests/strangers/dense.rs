//! Dense sampling of a field along the rays of a picture, in f64.

use sdfc_render::View;

/// Samples of a ray, over twice the distance from the eye to the origin.
const SAMPLES: usize = 3000;
/// Thirds by which a minimum between samples is approached.
const THIRDS: usize = 40;
/// Halvings of the step in which the sign changes.
const HALVINGS: usize = 50;
/// Neighbours whose depths differ by more than this many widths of a pixel make an edge.
const EDGE_WIDTHS: f64 = 8.0;

/// Where the rays of a picture first enter a solid.
pub struct Dense {
    size: [u32; 2],
    spread: f64,
    depths: Vec<Option<f64>>,
}

impl Dense {
    /// Samples the field at the points of all rays.
    pub fn of(field: fn([f64; 3]) -> f64, view: &View) -> Self {
        let [width, height] = view.size;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let depths = pixels.map(|[x, y]| {
            let [origin, direction] = view.ray(x, y);
            let end = 2.0 * view.eye.length();
            first_root(|t| field((origin + direction * t).to_array()), end)
        });
        let spread = 2.0 * view.right.length() / f64::from(width);
        Self { size: view.size, spread, depths: depths.collect() }
    }

    /// The depth at a pixel; `None` where the ray hits nothing or the pixel lies outside.
    pub fn depth(&self, [x, y]: [u32; 2]) -> Option<f64> {
        let inside = x < self.size[0] && y < self.size[1];
        self.depths.get((y * self.size[0] + x) as usize).copied().flatten().filter(|_| inside)
    }

    /// The width of a pixel at a depth.
    pub fn pixel_width(&self, depth: f64) -> f64 {
        self.spread * depth
    }

    /// The number of pixels that show a surface.
    pub fn hits(&self) -> usize {
        self.depths.iter().flatten().count()
    }
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

/// True if a neighbour shows something else than the pixel does.
pub fn is_edge(dense: &Dense, [x, y]: [u32; 2]) -> bool {
    let own = dense.depth([x, y]);
    let around = [[0, 1], [1, 0], [1, 1], [1, 2], [2, 1], [0, 0], [0, 2], [2, 0], [2, 2]];
    around.into_iter().any(|[right, down]| {
        let (Some(x), Some(y)) = ((x + right).checked_sub(1), (y + down).checked_sub(1)) else {
            return false;
        };
        let is_inside = x < dense.size[0] && y < dense.size[1];
        is_inside
            && match (own, dense.depth([x, y])) {
                (Some(a), Some(b)) => (a - b).abs() > EDGE_WIDTHS * dense.pixel_width(a),
                (None, None) => false,
                (Some(_), None) | (None, Some(_)) => true,
            }
    })
}
