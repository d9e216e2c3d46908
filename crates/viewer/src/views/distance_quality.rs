//! The field's guarantees about the distance.

use sdfc_graph::ShapeId;

use crate::scene::distance_quality::DistanceQuality;
use crate::views::colors::{ALARM, GOOD, NOTICE, OUTSIDE};
use crate::views::input::ViewInput;
use crate::views::legend::Legend;
use crate::views::view::View;

/// The field's guarantees about the distance.
pub const VIEW: View = View {
    name: "Distance quality",
    help: "What the field of each part guarantees outside it: the exact distance, a lower bound, \
           or a lower bound after division by a constant. Rays may step through uncertified parts.",
    paint,
};

/// By [`DistanceQuality`], from best to worst.
const COLORS: [[u8; 3]; 4] = [GOOD, OUTSIDE, NOTICE, ALARM];
const LABELS: [&str; 4] =
    ["exact distance", "lower bound", "lower bound, divided by a constant", "uncertified"];

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let classifier = input.shapes.operands(input.scene);
    let parts = classifier.at(input.frame, &input.hits(), input.interrupted);
    let quality = |part: &ShapeId| DistanceQuality::of(input.scene, *part) as usize;
    let qualities: Vec<usize> = classifier.shapes().iter().map(quality).collect();
    let numbers: Vec<_> = parts.iter().map(|part| part.map(|part| qualities[part])).collect();
    let color = |number: usize| COLORS[number];
    let legend = input.legend_of_numbers(&numbers, color, |number| LABELS[number].to_owned());
    (input.color_by_number(&numbers, color), legend)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{TWO_SHAPES, view_of};

    #[test]
    fn a_sphere_is_exact_and_a_twist_is_scaled() {
        let (_, legend) = view_of(TWO_SHAPES, ViewMode::DistanceQuality, |_| {});
        let Legend::Keys(mut keys) = legend else { panic!("{legend:?}") };
        keys.sort();
        let keys: Vec<_> = keys.iter().map(|(color, label)| (*color, label.as_str())).collect();
        assert_eq!(keys, [(GOOD, LABELS[0]), (NOTICE, LABELS[2])]);
    }
}
