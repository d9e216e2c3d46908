//! Directions of the surface.

use glam::DVec3;
use sdfc_march::PixelBlock;

use crate::views::colors::BACKGROUND;
use crate::views::input::ViewInput;
use crate::views::legend::Legend;
use crate::views::view::View;

/// Directions of the surface.
pub const VIEW: View = View {
    name: "Normals",
    help: "The direction of the surface: x, y, z as red, green, blue; -1 is dark, 0 is medium, \
           1 is bright.",
    paint,
};

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let fields = input.field_at_hits();
    let color = |index: usize, _: &PixelBlock| match fields[index] {
        Some(field) => {
            let normal = DVec3::from(field.partials).normalize_or_zero();
            normal.to_array().map(|lane| ((lane * 0.5 + 0.5) * 255.0).round() as u8)
        }
        None => BACKGROUND,
    };
    (input.map_pixels(color), Legend::None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{BALL, MIDDLE, view_of};

    #[test]
    fn the_normal_in_the_middle_of_a_ball_points_at_the_camera() {
        let (colors, _) = view_of(BALL, ViewMode::Normals, |_| {});
        let [red, green, blue] = colors[MIDDLE];
        assert!(red.abs_diff(128) < 12 && green.abs_diff(128) < 12 && blue > 250, "{red} {green}");
        assert_eq!(colors[0], BACKGROUND);
    }
}
