//! Small pictures for the tests of views, drawn on the CPU.

use sdfc::{FrameValues, Method};
use sdfc_render::{CpuScene, Image, RenderOptions, View, no_progress};

use crate::scene::field_probe::FieldProbe;
use crate::scene::shapes::ShapeIndex;
use crate::views::input::ViewInput;
use crate::views::legend::Legend;
use crate::views::mode::ViewMode;
use crate::views::slice_plane::SlicePlane;

/// Width and height of the pictures.
pub const SIZE: [u32; 2] = [32, 24];
/// A ball of radius 1, seen from a distance of 5 units.
pub const BALL: &str = "sphere(1)\ncamera(eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg)";
/// The pixel in the middle.
pub const MIDDLE: usize = 12 * 32 + 16;
/// An exact shape at [`LEFT`], and one whose field is divided by a constant at [`RIGHT`].
pub const TWO_SHAPES: &str = "sphere(0.8).translate(x: -1)\nbox(1).twist(40deg).translate(x: 1)\n\
    camera(eye: [0, 0, 6], target: [0, 0, 0], fov: 40deg)";
/// A pixel of the left shape.
pub const LEFT: usize = 12 * 32 + 9;
/// A pixel of the right shape.
pub const RIGHT: usize = 12 * 32 + 22;

/// The colours of a view of a scene, and their legend. `change` may alter the rendered image before
/// the view is applied.
pub fn view_of(
    source: &str,
    mode: ViewMode,
    change: impl Fn(&mut Image),
) -> (Vec<[u8; 3]>, Legend) {
    let scene = sdfc::Compiler::new().compile("a", source).unwrap();
    let frame = FrameValues::defaults(scene.params());
    let program = scene.program();
    let view = View::new(program, &frame, scene.bounds_at(&frame), SIZE).unwrap();
    let cpu = CpuScene::new(program).unwrap();
    let options = RenderOptions::default();
    let mut image =
        cpu.render(&view, &frame, Method::Auto, &options, &mut no_progress).unwrap().image;
    change(&mut image);
    let input = ViewInput {
        colors: &image,
        image: &image,
        view: &view,
        field: &FieldProbe::new(program),
        scene: &scene,
        shapes: &ShapeIndex::default(),
        frame: &frame,
        slice: SlicePlane::default(),
        origin: program.origin,
        stride: 1,
        interrupted: &|| false,
    };
    let (bytes, legend) = mode.paint(&input);
    (bytes.chunks_exact(4).map(|it| [it[0], it[1], it[2]]).collect(), legend)
}
