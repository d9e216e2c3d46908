//! Soft shadows of fields that fall behind the distance: each solid stands twice, and its second
//! form is a union of boxes or spheres, whose field is the distance.

use sdfc::{Backend, Compiler, PictureOptions, no_progress};
use sdfc_render::linear_to_srgb8;

const SIZE: [u32; 2] = [96, 72];
/// Largest difference of a colour channel that does not count, in steps of 1/255. A way along
/// gradients is longer than the distance beside an edge, so a penumbra may be narrower.
const COLOR: u8 = 40;
/// Largest number of pixels that differ by more.
const MOST_WRONG: usize = 20;

const ROOM: [&str; 2] = [
    "box([4, 3, 4]) - box([4, 3, 4]).translate([0.2, 0.2, 0.2])",
    "box([4, 0.2, 4]).translate(y: -1.4)
box([4, 3, 0.2]).translate(z: -1.9)
box([0.2, 3, 4]).translate(x: -1.9)",
];
const ROOM_VIEW: &str = "camera(eye: [10, 8.5, 10], target: [0, 0, 0], height: 5.5)
sun(direction: [-1, 2, 0.4], shadow: soft(8))
ambient(#bcd4f0, 0.35)";

const WINDOW: [&str; 2] = [
    "(box([4, 3, 0.2]).translate(y: 1.5) - box([1.5, 1.5, 0.4]).translate(y: 1.6)).translate(z: -1)",
    "box([1.25, 3, 0.2]).translate([-1.375, 1.5, -1])
box([1.25, 3, 0.2]).translate([1.375, 1.5, -1])
box([1.5, 0.85, 0.2]).translate([0, 0.425, -1])
box([1.5, 0.65, 0.2]).translate([0, 2.675, -1])",
];
const WINDOW_VIEW: &str = "plane()
sun(direction: [0.4, 1, -1], shadow: soft(8))
ambient(#9db7e0, 0.35)
camera(eye: [1.5, 3, 6], target: [0, 0.7, 0])";

const BALLS: [&str; 2] = [
    "sphere(0.5).limited_repeat(spacing: [1.2, 0, 1.2], count: [9, 1, 5])",
    "union(for i in 0..9: for k in 0..5: sphere(0.5).translate([1.2 * (i - 4), 0, 1.2 * (k - 2)]))",
];
const BALLS_VIEW: &str = "plane(y: -0.5)
sun(direction: [1, 1, 1], shadow: soft(2))
ambient(#bcd4f0, 0.35)
camera(eye: [0, 1, 4], target: [0, 0, 0], fov: 40deg)";

/// The colours of a scene on the CPU.
fn colors(source: &str) -> Result<Vec<[u8; 3]>, Box<dyn std::error::Error>> {
    let scene = Compiler::new().compile("shadow", source)?;
    let options = PictureOptions::new().size(SIZE).samples(1).backend(Backend::Cpu);
    let image = scene.render(&options, &mut no_progress)?.image;
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    let color = |(x, y)| {
        let [red, green, blue, _] = image.pixel(x, y).map_or([0.0; 4], |pixel| pixel.color);
        [red, green, blue].map(linear_to_srgb8)
    };
    Ok(pixels.map(color).collect())
}

fn agree(forms: [&str; 2], view: &str) -> Result<(), Box<dyn std::error::Error>> {
    let [one, other] = forms.map(|form| colors(&format!("{form}\n{view}")));
    let differs = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).any(|i| a[i].abs_diff(b[i]) > COLOR);
    let wrong = one?.iter().zip(&other?).filter(|&pair| differs(pair)).count();
    assert!(wrong <= MOST_WRONG, "{wrong} pixels differ");
    Ok(())
}

#[test]
fn a_room_that_is_a_difference_is_lit_as_three_boxes() -> Result<(), Box<dyn std::error::Error>> {
    agree(ROOM, ROOM_VIEW)
}

#[test]
fn light_falls_through_a_window_that_is_cut_out() -> Result<(), Box<dyn std::error::Error>> {
    agree(WINDOW, WINDOW_VIEW)
}

#[test]
fn copies_cast_no_shadows_of_their_limits() -> Result<(), Box<dyn std::error::Error>> {
    agree(BALLS, BALLS_VIEW)
}
