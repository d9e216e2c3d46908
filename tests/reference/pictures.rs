//! The pictures: a rendered example of each solid, and the field of each region in the plane.

use sdfc::{Backend, Compiler, PictureOptions, Scene, no_progress};
use sdfc_graph::eval::{FrameValues, Tape};
use sdfc_graph::{Dim, Expander, ShapeId, bounds};
use sdfc_lang::library::Entry;

use super::Files;

/// Width and height in pixels.
pub const SIZE: [u32; 2] = [160, 120];

/// The number of rays per pixel of a solid, and of points along each side of a region's pixel.
const SAMPLES: u32 = 4;
const POINTS: u32 = 3;

/// The colour of solids that state none. The tone curve deepens it to that of regions.
const COLOR: &str = "#eba27c";
/// The sRGB colours of a region's field: inside, outside, and the outline.
const INSIDE: [f64; 3] = [217.0, 120.0, 80.0];
const OUTSIDE: [f64; 3] = [232.0, 236.0, 242.0];
const OUTLINE: [f64; 3] = [60.0, 40.0, 40.0];
/// Every other band of this width, as a fraction of the picture's height, is darker.
const BAND: f64 = 0.08;
const DARKER: f64 = 0.94;
/// The thickness of the outline, as a fraction of the picture's height.
const LINE: f64 = 0.012;

/// Returns the path of an entry's picture below the folder, if it has one.
pub fn name(entry: &Entry) -> Option<String> {
    entry.location?;
    Some(format!("pictures/{}-{}.png", entry.name, entry.kind))
}

/// Returns the pictures as files.
pub fn files(entries: &[Entry]) -> Files {
    let pictures = entries.iter().filter_map(|entry| Some((name(entry)?, png(entry))));
    pictures.collect()
}

fn png(entry: &Entry) -> Vec<u8> {
    let pixels = if entry.kind == "region" { region(entry) } else { solid(entry) };
    let [width, height] = SIZE;
    let picture = image::RgbImage::from_raw(width, height, pixels).expect("three bytes a pixel");
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new_with_quality(
        &mut bytes,
        image::codecs::png::CompressionType::Best,
        image::codecs::png::FilterType::Adaptive,
    );
    picture.write_with_encoder(encoder).expect("a picture in memory");
    bytes
}

fn scene(entry: &Entry) -> Scene {
    compiled(entry, &entry.example)
}

fn compiled(entry: &Entry, text: &str) -> Scene {
    let compiled = Compiler::new().compile(&entry.name, text);
    compiled.unwrap_or_else(|errors| panic!("{errors}"))
}

fn solid(entry: &Entry) -> Vec<u8> {
    let options = PictureOptions::new().size(SIZE).backend(Backend::Cpu).samples(Some(SAMPLES));
    let mut scene = scene(entry);
    if !scene.graph().has_materials {
        scene = compiled(entry, &format!("({}).color({COLOR})", entry.example));
    }
    let picture = scene.render(&options, &mut no_progress);
    picture.unwrap_or_else(|e| panic!("{}: {e}", entry.name)).image.to_srgb8()
}

/// Draws the region of this name in the example, with bands along its distance.
fn region(entry: &Entry) -> Vec<u8> {
    let scene = scene(entry);
    let mut graph = scene.graph().graph.clone();
    let of_entry = |id: &ShapeId| {
        let shape = graph.shape(*id);
        shape.definition == entry.name && shape.dim == Dim::Two && shape.level == 0
    };
    let shape = graph.shape_ids().find(of_entry).unwrap_or_else(|| panic!("{}", entry.name));
    let frame = FrameValues::defaults(scene.params());
    let corners = bounds(&mut graph, shape, scene.params());
    let corners = sdfc_graph::eval::evaluate_frame(&graph, &corners, &frame);
    let point = graph.point(0, Dim::Three);
    let point = graph.swizzle(point, &[0, 1]);
    let distance = Expander::new().field(&mut graph, shape, point).expect("it expands");
    let tape = Tape::new(&graph, &[distance]).expect("it is flat");
    let mut field = tape.prepare::<f64>(&frame);

    let window = Window::around(corners[0], corners[1]);
    let [width, height] = SIZE;
    let mut pixels = Vec::new();
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let mut sum = [0.0; 3];
        for (j, i) in (0..POINTS).flat_map(|j| (0..POINTS).map(move |i| (j, i))) {
            let offset = |at, of| f64::from(at) + (f64::from(of) + 0.5) / f64::from(POINTS);
            let color = window.color(field.scalar(window.point(offset(x, i), offset(y, j))));
            sum = [0, 1, 2].map(|channel| sum[channel] + color[channel]);
        }
        pixels.extend(sum.map(|sum| (sum / f64::from(POINTS * POINTS)).round() as u8));
    }
    pixels
}

/// The part of the plane that a picture shows.
struct Window {
    middle: [f64; 2],
    /// The height of the whole picture, in scene units.
    height: f64,
}

impl Window {
    fn around(lo: [f64; 4], hi: [f64; 4]) -> Self {
        let finite = |end: f64, default: f64| if end.is_finite() { end } else { default };
        let [x, y] = [0, 1].map(|axis| [finite(lo[axis], -1.0), finite(hi[axis], 1.0)]);
        let [width, height] = SIZE.map(f64::from);
        let needed = (y[1] - y[0]).max((x[1] - x[0]) * height / width);
        Self { middle: [x, y].map(|ends| (ends[0] + ends[1]) / 2.0), height: needed * 1.5 }
    }

    fn point(&self, x: f64, y: f64) -> [f64; 3] {
        let [width, height] = SIZE.map(f64::from);
        let unit = self.height / height;
        [self.middle[0] + (x - width / 2.0) * unit, self.middle[1] - (y - height / 2.0) * unit, 0.0]
    }

    fn color(&self, f: f64) -> [f64; 3] {
        if f.abs() < LINE * self.height / 2.0 {
            return OUTLINE;
        }
        let base = if f < 0.0 { INSIDE } else { OUTSIDE };
        let dark = (f.abs() / (BAND * self.height)).floor() as i64 % 2 == 1;
        if dark { base.map(|channel| channel * DARKER) } else { base }
    }
}
