//! The shape that each pixel belongs to.

use crate::views::input::ViewInput;
use crate::views::legend::Legend;
use crate::views::view::View;

/// The shape that each pixel belongs to.
pub const VIEW: View = View {
    name: "Shapes",
    help: "Each shape in a colour of its own. In a blend, the colour of the shape with the greater \
           weight.",
    paint,
};

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let classifier = input.shapes.leaves(input.scene);
    let numbers = classifier.at(input.frame, &input.hits(), input.interrupted);
    let label = |number: usize| input.shapes.label(input.scene, classifier.shapes()[number]);
    let legend = input.legend_of_numbers(&numbers, color, label);
    (input.color_by_number(&numbers, color), legend)
}

/// The colour of a number. Consecutive numbers have hues the golden angle apart.
fn color(number: usize) -> [u8; 3] {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let hue = (number as f64 * GOLDEN).fract() * 6.0;
    let value = if number.is_multiple_of(2) { 250.0 } else { 205.0 };
    [0.0, 4.0, 2.0].map(|shift| {
        let lane = ((hue + shift) % 6.0 - 3.0).abs() - 1.0;
        (value * (0.3 + 0.7 * lane.clamp(0.0, 1.0))) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::views::colors::BACKGROUND;
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{LEFT, RIGHT, TWO_SHAPES, view_of};

    #[test]
    fn each_shape_has_a_colour_and_a_legend_line() {
        let (colors, legend) = view_of(TWO_SHAPES, ViewMode::Shapes, |_| {});
        assert!(colors[LEFT] != colors[RIGHT] && colors[0] == BACKGROUND);
        let Legend::Keys(keys) = legend else { panic!("{legend:?}") };
        assert_eq!(keys.len(), 2);
    }
}
