//! The scenes of the gallery: each file `docs/gallery/NAME.sdf` is shown on the page by the picture
//! `NAME.jpg` beside it. `DOCUMENTS_UPDATE=1` draws the pictures that are out of date.

use std::fs::File;
use std::path::PathBuf;

use image::codecs::jpeg::JpegEncoder;
use image::{Rgb, RgbImage};
use sdfc::{Backend, Compiler, PictureOptions, no_progress};
use sdfc_render::linear_to_srgb8;
use sdfc_tests::repository;

/// Width and height of a picture on the page, in pixels.
const SIZE: [u32; 2] = [960, 540];
/// The number of rays per pixel of a picture on the page.
const SAMPLES: u32 = 4;
/// The quality of a picture on the page, of 100. A file has 30 to 120 KB.
const JPEG_QUALITY: u8 = 80;
/// Width and height of the picture that a test draws.
const SMALL_SIZE: [u32; 2] = [160, 90];
/// The number of rays per pixel of that picture.
const SMALL_SAMPLES: u32 = 1;
/// The number of blocks along the width and the height, whose mean colours are compared.
const BLOCKS: [u32; 2] = [16, 9];
/// The largest mean difference of the colours of blocks, of 255. Few rays leave noise at edges.
const MEAN_TOLERANCE: f64 = 6.0;
/// The largest difference of the colours of one block, of 255.
const MAX_TOLERANCE: f64 = 40.0;

/// A scene of the gallery.
pub struct Entry {
    /// The name of the file, without `.sdf`.
    pub name: String,
    pub text: String,
}

impl Entry {
    /// The path of the picture in the repository.
    fn picture(&self) -> PathBuf {
        folder().join(&self.name).with_extension("jpg")
    }

    /// Returns the picture of the scene.
    fn drawn(&self, size: [u32; 2], options: PictureOptions) -> RgbImage {
        let scene = Compiler::new().compile(&self.name, &self.text);
        let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
        let drawn = scene.render(&options.size(size), &mut no_progress).expect("it is drawn");
        let [width, height] = size;
        RgbImage::from_raw(width, height, drawn.image.to_srgb8()).expect("three bytes per pixel")
    }

    /// Returns how far the picture on the page is from the scene; infinitely far if there is no
    /// picture of the right size.
    pub fn difference(&self) -> Difference {
        let page = image::open(self.picture()).map(image::DynamicImage::into_rgb8);
        let Some(page) = page.ok().filter(|page| page.dimensions() == SIZE.into()) else {
            return Difference { mean: f64::INFINITY, worst: f64::INFINITY };
        };
        let options = PictureOptions::new().backend(Backend::Cpu).samples(Some(SMALL_SAMPLES));
        Difference::of(&page, &self.drawn(SMALL_SIZE, options))
    }

    /// Draws the picture on the page.
    pub fn draw(&self) {
        let picture = self.drawn(SIZE, PictureOptions::new().samples(Some(SAMPLES)));
        let mut file = File::create(self.picture()).expect("the folder is there");
        let encoder = JpegEncoder::new_with_quality(&mut file, JPEG_QUALITY);
        picture.write_with_encoder(encoder).expect("the file can be written");
    }
}

/// The difference of two pictures, by the mean colours of their blocks, of 255.
#[derive(Clone, Copy)]
pub struct Difference {
    /// The mean over all blocks.
    mean: f64,
    /// The mean over the components of the block that differs most.
    worst: f64,
}

impl Difference {
    fn of(a: &RgbImage, b: &RgbImage) -> Self {
        let (a, b) = (blocks(a), blocks(b));
        let differences: Vec<f64> = a.pixels().zip(b.pixels()).map(|(a, b)| apart(a, b)).collect();
        let mean = differences.iter().sum::<f64>() / differences.len() as f64;
        Self { mean, worst: differences.iter().copied().fold(0.0, f64::max) }
    }

    /// Returns true if the pictures show the same scene.
    pub fn is_small(self) -> bool {
        self.mean <= MEAN_TOLERANCE && self.worst <= MAX_TOLERANCE
    }
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { mean, worst } = self;
        let limits = format!("at most {MEAN_TOLERANCE} and {MAX_TOLERANCE}");
        write!(f, "the mean difference is {mean:.2}, that of the worst block {worst:.2}; {limits}")
    }
}

/// Returns the mean difference of the components of two colours.
fn apart(a: &Rgb<u8>, b: &Rgb<u8>) -> f64 {
    a.0.iter().zip(&b.0).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / 3.0
}

fn folder() -> PathBuf {
    repository().join("docs/gallery")
}

/// Returns the scenes of the gallery in the order of their names.
pub fn entries() -> Vec<Entry> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder()).expect("the folder is there") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "sdf") {
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            let text = std::fs::read_to_string(&path).expect("a text").replace("\r\n", "\n");
            found.push(Entry { name, text });
        }
    }
    found.sort_by(|a, b| a.name.cmp(&b.name));
    found
}

/// Returns the mean light of each block of pixels, as a picture.
fn blocks(picture: &RgbImage) -> RgbImage {
    let [width, height] = BLOCKS;
    let (wide, high) = (picture.width() / width, picture.height() / height);
    RgbImage::from_fn(width, height, |x, y| {
        let mut light = [0.0; 3];
        for (i, j) in (0..high).flat_map(|j| (0..wide).map(move |i| (i, j))) {
            let pixel = picture.get_pixel(x * wide + i, y * high + j);
            for (sum, &value) in light.iter_mut().zip(&pixel.0) {
                *sum += linear(value);
            }
        }
        Rgb(light.map(|sum| linear_to_srgb8((sum / f64::from(wide * high)) as f32)))
    })
}

/// Linear light of an sRGB component.
fn linear(value: u8) -> f64 {
    let value = f64::from(value) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}
