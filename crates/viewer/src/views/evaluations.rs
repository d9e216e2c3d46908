//! Evaluations of the field.

use sdfc_march::PixelBlock;
use sdfc_render::EvaluationCounts;

use crate::views::input::ViewInput;
use crate::views::legend::{Legend, Ramp};
use crate::views::view::View;

/// Evaluations of the field.
pub const VIEW: View = View {
    name: "Evaluations",
    help: "How often the field was evaluated for each pixel, shadows and reflections included: \
           where drawing is slow.",
    paint,
};

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let most = EvaluationCounts::of(input.image).p99.max(1);
    let color = |index: usize, _: &PixelBlock| {
        let count = input.image.pixels()[index].evaluations;
        Ramp::Heat.color(f64::from(count) / f64::from(most))
    };
    let label = "evaluations per pixel, to the 99th percentile";
    let ends = [0.0, f64::from(most)];
    (input.map_pixels(color), Legend::Scale { label, ends, ramp: Ramp::Heat })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{BALL, view_of};

    #[test]
    fn the_scale_ends_at_the_99th_percentile() {
        let (colors, legend) = view_of(BALL, ViewMode::Evaluations, |image| {
            for (index, pixel) in image.pixels_mut().iter_mut().enumerate() {
                pixel.evaluations = (index % 101) as u32;
            }
        });
        let Legend::Scale { ends, .. } = legend else { panic!("{legend:?}") };
        assert!((98.0..=100.0).contains(&ends[1]), "{ends:?}");
        assert_eq!(colors[0], Ramp::Heat.color(0.0));
        assert_eq!(colors[100], Ramp::Heat.color(1.0));
    }
}
