//! Colours without light.

use std::collections::BTreeSet;

use sdfc_march::PixelBlock;

use crate::scene::materials::{Material, Materials};
use crate::views::colors::BACKGROUND;
use crate::views::input::ViewInput;
use crate::views::legend::Legend;
use crate::views::view::View;

/// Colours without light.
pub const VIEW: View = View {
    name: "Materials",
    help: "The colour of each surface without light and shadow. The legend lists the materials \
           that cover the most pixels.",
    paint,
};

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let materials = Materials::new(input.scene.drawn());
    let found = materials.at(input.frame, &input.hits(), input.interrupted);
    let kinds: BTreeSet<Material> = found.iter().flatten().copied().collect();
    let kinds: Vec<Material> = kinds.into_iter().collect();
    let numbers: Vec<Option<usize>> =
        found.iter().map(|it| it.and_then(|it| kinds.binary_search(&it).ok())).collect();
    let color = |index: usize, _: &PixelBlock| match found[index] {
        Some(material) => material.color,
        None => BACKGROUND,
    };
    let legend =
        input.legend_of_numbers(&numbers, |kind| kinds[kind].color, |kind| kinds[kind].text());
    (input.map_pixels(color), legend)
}

#[cfg(test)]
mod tests {
    use crate::views::legend::Legend;
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{BALL, MIDDLE, view_of};

    #[test]
    fn a_surface_has_its_colour_without_light() {
        let scene = BALL.replace("sphere(1)", "sphere(1).color(#d94f30)");
        let (colors, legend) = view_of(&scene, ViewMode::Materials, |_| {});
        assert_eq!(colors[MIDDLE], [0xd9, 0x4f, 0x30]);
        let Legend::Keys(keys) = legend else { panic!("{legend:?}") };
        assert_eq!(keys, [([0xd9, 0x4f, 0x30], "#d94f30, roughness 0.5".to_owned())]);
    }
}
