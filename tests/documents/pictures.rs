//! The pictures of the tutorial: each is what the block before it draws.
//!
//! They are drawn on the processor in single precision; since the mathematical functions of machines differ in
//! the last digits, they may differ a little. `DOCUMENTS_UPDATE=1` writes them anew.

use sdfc::{Backend, PictureOptions, compile, unwatched};

/// Width and height in pixels, and rays for each.
const SIZE: [u32; 2] = [320, 240];
const SAMPLES: u32 = 2;

/// A picture counts as the same if no more than this share of its channels, ...
const SHARE: f64 = 0.01;
/// ... differs by more than this, in steps of 1/255.
const DIFFER: u8 = 8;

/// Path of each picture, and the block before it.
pub fn shown(page: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut rest = page;
    while let Some((_, after)) = rest.split_once("```sdf\n") {
        let Some((block, after)) = after.split_once("```\n") else { break };
        let picture = after.trim_start().strip_prefix("![").and_then(|rest| {
            rest.split_once("](")?.1.split_once(')').map(|(path, _)| path.to_owned())
        });
        found.extend(picture.map(|path| (path, block.to_owned())));
        rest = after;
    }
    found
}

/// The block as a PNG.
pub fn drawn(block: &str) -> Vec<u8> {
    let options = PictureOptions {
        size: SIZE,
        backend: Backend::Cpu,
        samples: SAMPLES,
        ..Default::default()
    };
    let scene = compile("tutorial.sdf", block).scene.expect("it compiles");
    let picture = scene.render(&options, &mut unwatched).expect("it is drawn");
    picture.image.to_png().expect("a picture in memory")
}

/// Whether two files show the same picture, up to rounding.
pub fn same(a: &[u8], b: &[u8]) -> bool {
    let decode = |bytes| image::load_from_memory(bytes).map(image::DynamicImage::into_rgb8);
    let (Ok(a), Ok(b)) = (decode(a), decode(b)) else { return false };
    if a.dimensions() != b.dimensions() {
        return false;
    }
    let all = a.as_raw().len() as f64;
    let differ = a.as_raw().iter().zip(b.as_raw()).filter(|(a, b)| a.abs_diff(**b) > DIFFER);
    differ.count() as f64 <= SHARE * all
}
