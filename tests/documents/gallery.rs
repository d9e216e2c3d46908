//! The scenes of the gallery: each file `docs/gallery/NAME.sdf` is shown on the page by the picture
//! `NAME.jpg` beside it. `DOCUMENTS_UPDATE=1` draws the pictures that are out of date.

use std::fs::File;
use std::path::PathBuf;

use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use sdfc::{Backend, Compiler, PictureOptions, Scene, no_progress};
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
pub const MEAN_TOLERANCE: f64 = 6.0;

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

    fn compiled(&self) -> Scene {
        let scene = Compiler::new().compile(&self.name, &self.text);
        scene.unwrap_or_else(|errors| panic!("{errors}"))
    }

    /// Returns how far the picture on the page is from the scene, as the mean difference of the
    /// colours of blocks, of 255; infinite if there is no picture of the right size.
    pub fn difference(&self) -> f64 {
        let page = image::open(self.picture()).map(image::DynamicImage::into_rgb8);
        let Some(page) = page.ok().filter(|page| page.dimensions() == SIZE.into()) else {
            return f64::INFINITY;
        };
        let options = PictureOptions::new()
            .size(SMALL_SIZE)
            .backend(Backend::Cpu)
            .samples(Some(SMALL_SAMPLES));
        let small = self.compiled().render(&options, &mut no_progress).expect("it is drawn");
        let small = image::load_from_memory(&small.image.to_png().expect("a picture in memory"));
        mean_difference(&page, &small.expect("a picture").into_rgb8())
    }

    /// Draws the picture on the page.
    pub fn draw(&self) {
        let options = PictureOptions::new().size(SIZE).samples(Some(SAMPLES));
        let drawn = self.compiled().render(&options, &mut no_progress).expect("it is drawn");
        let png = drawn.image.to_png().expect("a picture in memory");
        let picture = image::load_from_memory(&png).expect("a picture").into_rgb8();
        let mut file = File::create(self.picture()).expect("the folder is there");
        let encoder = JpegEncoder::new_with_quality(&mut file, JPEG_QUALITY);
        picture.write_with_encoder(encoder).expect("the file can be written");
    }
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
        image::Rgb(light.map(|sum| encoded(sum / f64::from(wide * high))))
    })
}

/// Returns the mean difference of the blocks of two pictures.
fn mean_difference(a: &RgbImage, b: &RgbImage) -> f64 {
    let (a, b) = (blocks(a).into_raw(), blocks(b).into_raw());
    let differences = a.iter().zip(&b).map(|(a, b)| f64::from(a.abs_diff(*b)));
    differences.sum::<f64>() / a.len() as f64
}

/// Linear light of an sRGB component.
fn linear(value: u8) -> f64 {
    let value = f64::from(value) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB component of linear light.
fn encoded(light: f64) -> u8 {
    let value =
        if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    (255.0 * value).round() as u8
}
