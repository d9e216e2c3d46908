//! Rays that ran out of steps.

use sdfc_march::PixelBlock;
use sdfc_render::{CAPPED, is_finite};

use crate::views::colors::{ALARM, NOT_FINITE, dimmed, to_srgb};
use crate::views::input::ViewInput;
use crate::views::legend::Legend;
use crate::views::view::View;

/// Rays that ran out of steps.
pub const VIEW: View = View {
    name: "Out of steps",
    help: "Rays that ran out of steps before they hit anything, and pixels whose colour is not \
           finite.",
    paint,
};

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let color = |index: usize, shaded: &PixelBlock| {
        let pixel = &input.image.pixels()[index];
        match pixel.status {
            _ if !is_finite(pixel) => NOT_FINITE,
            CAPPED => ALARM,
            _ => dimmed(to_srgb(shaded)),
        }
    };
    let counts = input.image.counts();
    let keys = vec![
        (ALARM, format!("out of steps: {}", counts.capped)),
        (NOT_FINITE, format!("not finite: {}", counts.nan)),
    ];
    (input.map_pixels(color), Legend::Keys(keys))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{BALL, view_of};

    #[test]
    fn capped_and_non_finite_pixels_are_marked_and_counted() {
        let (colors, legend) = view_of(BALL, ViewMode::OutOfSteps, |image| {
            image.pixels_mut()[0].status = CAPPED;
            image.pixels_mut()[1].color[1] = f32::NAN;
        });
        assert_eq!((colors[0], colors[1]), (ALARM, NOT_FINITE));
        assert!(colors.iter().skip(2).all(|color| ![ALARM, NOT_FINITE].contains(color)));
        let Legend::Keys(keys) = legend else { panic!("{legend:?}") };
        assert!(keys.iter().all(|(_, text)| text.ends_with(": 1")), "{keys:?}");
    }
}
