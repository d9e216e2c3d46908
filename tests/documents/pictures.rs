//! The pictures of tutorial, gallery and cookbook: each shows the scene of the block before it.
//! `DOCUMENTS_UPDATE=1` rewrites them.

use sdfc::{Backend, Compiler, PictureOptions, no_progress};

/// Width and height in pixels.
const SIZE: [u32; 2] = [320, 240];
/// The number of rays per pixel.
const SAMPLES: u32 = 2;

/// Returns the path of each picture and the block before it.
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

/// Draws a block and returns the PNG file.
pub fn drawn(block: &str) -> Vec<u8> {
    let options = PictureOptions::new().size(SIZE).backend(Backend::Cpu).samples(Some(SAMPLES));
    let scene = Compiler::new().compile("tutorial.sdf", block).expect("it compiles");
    let picture = scene.render(&options, &mut no_progress).expect("it is drawn");
    picture.image.to_png().expect("a picture in memory")
}
