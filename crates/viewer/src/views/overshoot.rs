//! Rays that went through a surface.

use sdfc_march::PixelBlock;

use crate::views::colors::{ALARM, BACKGROUND, GOOD, NOTICE, dimmed, to_srgb};
use crate::views::input::ViewInput;
use crate::views::legend::{Legend, mix};
use crate::views::view::View;

/// The greatest distance from the surface at which a ray may stop, in pixel widths.
const TOLERANCE: f64 = 0.25;

/// Rays that went through a surface.
pub const VIEW: View = View {
    name: "Overshoot",
    help: "How far from the surface each ray stopped. Pink: more than a quarter of a pixel inside, \
           so the ray went through the surface. Yellow: more than a quarter of a pixel in front of \
           it. A ray that left a thin wall on the far side looks like background.",
    paint,
};

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let fields = input.field_at_hits();
    let classify = |index: usize| {
        let field = fields[index]?;
        let width = f64::from(input.image.pixel_width(input.image.pixels()[index].depth));
        Some(match field.value / width.max(1e-300) {
            pixels if pixels < -TOLERANCE => ALARM,
            pixels if pixels > TOLERANCE => NOTICE,
            _ => GOOD,
        })
    };
    let color = |index: usize, shaded: &PixelBlock| match classify(index) {
        Some(GOOD) => mix(dimmed(to_srgb(shaded)), GOOD, 0.25),
        Some(color) => color,
        None => BACKGROUND,
    };
    let count = |class| (0..fields.len()).filter(|index| classify(*index) == Some(class)).count();
    let keys = vec![
        (ALARM, format!("through the surface: {}", count(ALARM))),
        (NOTICE, format!("in front of the surface: {}", count(NOTICE))),
        (GOOD, "within a quarter of a pixel".to_owned()),
    ];
    (input.map_pixels(color), Legend::Keys(keys))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{BALL, MIDDLE, view_of};

    #[test]
    fn rays_that_stop_inside_or_in_front_are_marked() {
        let (colors, _) = view_of(BALL, ViewMode::Overshoot, |_| {});
        assert!(!colors.contains(&ALARM) && !colors.contains(&NOTICE));
        let (colors, _) = view_of(BALL, ViewMode::Overshoot, |image| {
            image.pixels_mut()[MIDDLE].depth += 0.5;
            image.pixels_mut()[MIDDLE + 1].depth -= 0.5;
        });
        assert_eq!((colors[MIDDLE], colors[MIDDLE + 1]), (ALARM, NOTICE));
    }
}
