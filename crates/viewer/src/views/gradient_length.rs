//! Length of the field's gradient.

use glam::DVec3;
use sdfc_march::PixelBlock;

use crate::views::colors::BACKGROUND;
use crate::views::input::ViewInput;
use crate::views::legend::{Legend, Ramp};
use crate::views::view::View;

/// Length of the field's gradient.
pub const VIEW: View = View {
    name: "Gradient length",
    help: "The length of the field's gradient where each ray stopped: 1 for a distance. Above 1 \
           the field grows faster than the distance, and rays may step through the surface.",
    paint,
};

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let fields = input.field_at_hits();
    let color = |index: usize, _: &PixelBlock| match fields[index] {
        Some(field) => Ramp::Diverging.color(DVec3::from(field.partials).length() / 2.0),
        None => BACKGROUND,
    };
    let label = "length of the gradient (1 for a distance)";
    (input.map_pixels(color), Legend::Scale { label, ends: [0.0, 2.0], ramp: Ramp::Diverging })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{BALL, MIDDLE, view_of};

    #[test]
    fn the_gradient_of_a_distance_has_length_1() {
        let (colors, _) = view_of(BALL, ViewMode::GradientLength, |_| {});
        assert_eq!(colors[MIDDLE], Ramp::Diverging.color(0.5));
    }
}
