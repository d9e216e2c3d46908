//! The field on a plane.

use glam::DVec3;
use sdfc_graph::eval::Dual;
use sdfc_march::PixelBlock;
use sdfc_render::HIT;

use crate::scene::number_text::display_text;
use crate::views::colors::{INSIDE, NOT_FINITE, OUTSIDE, to_srgb};
use crate::views::input::ViewInput;
use crate::views::legend::{Legend, mix};
use crate::views::slice_plane::SlicePlane;
use crate::views::view::View;

/// The field on a plane.
pub const VIEW: View = View {
    name: "Slice",
    help: "The field on a plane: orange inside, blue outside, with lines of equal distance. The \
           panel “Controls” moves the plane.",
    paint,
};

fn paint(input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
    let SlicePlane { axis, offset, spacing, on_top } = input.slice;
    let axis = axis.min(2);
    let point = |(index, pixel): (usize, &PixelBlock)| {
        let [start, direction] = input.ray(index);
        let t = (offset - input.origin[axis] - start[axis]) / direction[axis];
        let hidden = !on_top && pixel.status == HIT && f64::from(pixel.depth) < t;
        (t.is_finite() && t > 0.0 && t < input.view.t_max && !hidden)
            .then(|| ((start + direction * t).to_array(), t))
    };
    let hits: Vec<_> = input.image.pixels().iter().enumerate().map(point).collect();
    let points: Vec<_> = hits.iter().map(|hit| hit.map(|(point, _)| point)).collect();
    let fields = input.field.at_all(input.frame, &points, input.interrupted);
    let color = |index: usize, shaded: &PixelBlock| match (fields[index], hits[index]) {
        (Some(field), Some((_, t))) => {
            let width = f64::from(input.image.pixel_width(t as f32));
            mix(to_srgb(shaded), isolines(field, spacing, width), 0.85)
        }
        _ => to_srgb(shaded),
    };
    let keys = vec![
        (INSIDE, "inside".to_owned()),
        (OUTSIDE, "outside".to_owned()),
        ([235, 235, 235], format!("a line every {} units", display_text(spacing))),
    ];
    (input.map_pixels(color), Legend::Keys(keys))
}

/// The colour of a field value: orange inside, blue outside, darker away from the surface, with a
/// line at each multiple of `spacing` and a bright one at 0, each about a pixel wide. `pixel` is
/// the width of a pixel in scene units.
fn isolines(field: Dual, spacing: f64, pixel: f64) -> [u8; 3] {
    let value = field.value;
    if !value.is_finite() {
        return NOT_FINITE;
    }
    let side = if value < 0.0 { INSIDE } else { OUTSIDE };
    let base = mix(side, [18, 20, 24], (value.abs() / (spacing * 12.0)).min(0.75));
    let per_pixel = DVec3::from(field.partials).length().max(1e-9) * pixel;
    let to_line = (value / spacing - (value / spacing).round()).abs() * spacing / per_pixel;
    let is_surface = value.abs() < spacing / 2.0;
    let (line, strength, half) =
        if is_surface { ([255, 255, 255], 1.0, 1.2) } else { ([235, 235, 235], 0.45, 0.5) };
    // Lines that are closer than their width fade out instead of merging into grey.
    let room = (spacing / per_pixel / 4.0).min(1.0);
    mix(base, line, strength * room * (half + 0.5 - to_line).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use crate::views::mode::ViewMode;
    use crate::views::test_images::{BALL, MIDDLE, view_of};

    #[test]
    fn the_slice_is_orange_inside_and_blue_outside() {
        // The front half of the ball hides the plane through its middle, so the hits are removed.
        let (colors, _) = view_of(BALL, ViewMode::Slice, |image| {
            image.pixels_mut().iter_mut().for_each(|pixel| pixel.status = 0);
        });
        let [red, _, blue] = colors[MIDDLE];
        assert!(red > blue, "{:?}", colors[MIDDLE]);
        let [red, _, blue] = colors[0];
        assert!(blue > red, "{:?}", colors[0]);
    }
}
