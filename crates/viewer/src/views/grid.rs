//! Lines of equal coordinates on surfaces.

use glam::DVec3;
use sdfc_march::PixelBlock;
use sdfc_render::HIT;

use crate::scene::number_text::display_text;
use crate::views::colors::to_srgb;
use crate::views::input::ViewInput;
use crate::views::legend::{Legend, mix};
use crate::views::view::View;

/// Lines of equal coordinates on surfaces.
pub const VIEW: View = View {
    name: "Grid",
    help: "Lines on surfaces at equal x (red), y (green) and z (blue), to measure positions and \
           sizes. The legend gives the distance from line to line.",
    paint,
};

/// The colours of lines of equal x, y and z.
const COLORS: [[u8; 3]; 3] = [[230, 60, 50], [70, 170, 50], [60, 110, 240]];
/// The picture's height at the median depth is at least this many times the spacing of lines.
const LINES_PER_HEIGHT: f64 = 12.0;
/// Neighbouring pixels that are further apart than this many pixel widths are on different surfaces
/// or on one that is seen at a grazing angle; no line is drawn between them.
const MAX_STEP: f64 = 12.0;
/// The least change of a coordinate from pixel to pixel, as a fraction of the distance between
/// their points. Below it the surface is nearly perpendicular to the axis, and a line would be
/// noise.
const MIN_SLOPE: f64 = 0.1;

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let hits = input.hits();
    let spacing = spacing(input);
    let columns = input.image.size()[0] as usize;
    let origin = DVec3::from(input.origin);
    let line = |index: usize| -> Option<usize> {
        let point = DVec3::from(hits[index]?);
        let width = f64::from(input.image.pixel_width(input.image.pixels()[index].depth));
        let right = (index % columns + 1 < columns).then_some(index + 1);
        let below = (index + columns < hits.len()).then_some(index + columns);
        let neighbours = right.into_iter().chain(below).filter_map(|it| hits[it]);
        let cell = |point: DVec3| ((point + origin) / spacing).floor();
        neighbours.map(DVec3::from).find_map(|neighbour| {
            let step = neighbour - point;
            let (from, to, length) = (cell(point), cell(neighbour), step.length());
            let is_crossed =
                |axis: &usize| from[*axis] != to[*axis] && step[*axis].abs() > MIN_SLOPE * length;
            (0..3).find(is_crossed).filter(|_| length < MAX_STEP * width)
        })
    };
    let color = |index: usize, shaded: &PixelBlock| match line(index) {
        Some(axis) => mix(to_srgb(shaded), COLORS[axis], 0.8),
        None => to_srgb(shaded),
    };
    let key = |(color, axis)| (color, format!("{axis} every {} units", display_text(spacing)));
    let keys = COLORS.into_iter().zip(["x", "y", "z"]).map(key).collect();
    (input.map_pixels(color), Legend::Keys(keys))
}

/// The distance from line to line in scene units: 1, 2 or 5 times a power of ten.
fn spacing(input: &ViewInput<'_>) -> f64 {
    let hits = input.image.pixels().iter().filter(|it| it.status == HIT && it.depth.is_finite());
    let mut depths: Vec<f32> = hits.map(|it| it.depth).collect();
    depths.sort_by(f32::total_cmp);
    let Some(median) = depths.get(depths.len() / 2) else { return 1.0 };
    let rows = f64::from(input.image.size()[1]);
    let least = f64::from(input.image.pixel_width(*median)) * rows / LINES_PER_HEIGHT;
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|it| it * power).into_iter().find(|it| *it >= least).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{BALL, MIDDLE, view_of};

    #[test]
    fn lines_are_at_multiples_of_the_spacing() {
        let (shaded, _) = view_of(BALL, ViewMode::Shaded, |_| {});
        let (colors, legend) = view_of(BALL, ViewMode::Grid, |_| {});
        let Legend::Keys(keys) = legend else { panic!("{legend:?}") };
        // The picture is 3 units high at the surface.
        assert_eq!(keys[0].1, "x every 0.5 units");
        // The planes x = 0 and y = 0 cross the middle of the picture.
        let is_red = |[r, g, b]: [u8; 3]| r > 120 && g < 110 && b < 110;
        let is_green = |[r, g, b]: [u8; 3]| g > 120 && r < 110 && b < 110;
        assert!(is_red(colors[MIDDLE - 32 * 2 - 1]), "{:?}", colors[MIDDLE - 32 * 2 - 1]);
        assert!(is_green(colors[MIDDLE - 32 + 2]), "{:?}", colors[MIDDLE - 32 + 2]);
        // The background is unchanged.
        assert_eq!(colors[0], shaded[0]);
    }
}
