//! Draws the two scenes into a PNG, `embed.png` unless another path is given.

use embed_wgpu::{Camera, Renderer, open};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "embed.png".to_owned());
    let (device, queue) = open()?;
    let mut renderer = Renderer::new(device, queue)?;
    // Changing a param recompiles nothing.
    renderer.scenes[0].set("wall", 0.12)?;
    renderer.scenes[1].frame_mut().time = 2.0;

    let size = [640, 480];
    let pixels = renderer.draw(size, &Camera::default())?;
    let image = image::RgbaImage::from_raw(size[0], size[1], pixels).ok_or("too few pixels")?;
    image.save(&path)?;
    Ok(())
}
