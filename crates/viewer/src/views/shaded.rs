//! Light and materials.

use crate::views::colors::to_srgb;
use crate::views::input::ViewInput;
use crate::views::legend::Legend;
use crate::views::view::View;

/// Light and materials.
pub const VIEW: View =
    View { name: "Shaded", help: "Light and materials, as `sdfc render` draws them.", paint };

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    (input.map_pixels(|_, pixel| to_srgb(pixel)), Legend::None)
}

#[cfg(test)]
mod tests {
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{BALL, SIZE, view_of};

    #[test]
    fn the_shaded_view_is_the_picture_that_render_writes() {
        let scene = sdfc::Compiler::new().compile("a", BALL).unwrap();
        let options = sdfc::PictureOptions::new().size(SIZE).backend(sdfc::Backend::Cpu).samples(1);
        let expected = scene.render(&options, &mut sdfc::no_progress).unwrap().image.to_srgb8();
        let (colors, _) = view_of(BALL, ViewMode::Shaded, |_| {});
        for (color, expected) in colors.iter().flatten().zip(expected) {
            assert!(color.abs_diff(expected) <= 1, "{color} {expected}");
        }
    }
}
