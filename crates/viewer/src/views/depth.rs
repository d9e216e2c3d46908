//! Lengths of the rays.

use sdfc_march::PixelBlock;
use sdfc_render::HIT;

use crate::views::colors::BACKGROUND;
use crate::views::input::ViewInput;
use crate::views::legend::{Legend, Ramp};
use crate::views::view::View;

/// The darkest grey is at this quantile of the depths. A floor reaches so far that everything that
/// stands on it would be one grey if the scale ended at the greatest depth.
const FAR_QUANTILE: f64 = 0.9;

/// Lengths of the rays.
pub const VIEW: View = View {
    name: "Depth",
    help: "The length of each ray in scene units. The scale ends at the 90th percentile.",
    paint,
};

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let hits = input.image.pixels().iter().filter(|it| it.status == HIT);
    let mut depths: Vec<f32> = hits.map(|it| it.depth).collect();
    depths.sort_by(f32::total_cmp);
    let at = |quantile: f64| depths.get((depths.len() as f64 * quantile) as usize).copied();
    let [near, far] = [0.0, FAR_QUANTILE].map(|it| f64::from(at(it).unwrap_or_default()));
    let color = |index: usize, _: &PixelBlock| match input.image.pixels()[index] {
        PixelBlock { status: HIT, depth, .. } => {
            Ramp::Grey.color((f64::from(depth) - near) / (far - near).max(1e-12))
        }
        _ => BACKGROUND,
    };
    let label = "ray length in scene units, to the 90th percentile";
    (input.map_pixels(color), Legend::Scale { label, ends: [near, far], ramp: Ramp::Grey })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{BALL, MIDDLE, view_of};

    #[test]
    fn the_nearest_pixel_is_the_lightest() {
        let (colors, legend) = view_of(BALL, ViewMode::Depth, |_| {});
        assert!(colors[MIDDLE][0] > 240);
        let Legend::Scale { ends: [near, far], .. } = legend else { panic!("{legend:?}") };
        assert!((near - 4.0).abs() < 0.05 && far > 4.2 && far < 5.0, "{near} {far}");
    }
}
