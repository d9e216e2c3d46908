//! Pictures as files.

use std::io::Write;

use image::codecs::gif::{GifEncoder, Repeat};

use super::Image;
use crate::error::RenderError;

impl Image {
    /// Encodes the picture as a PNG file, sRGB, without alpha.
    ///
    /// # Errors
    ///
    /// [`RenderError::OutOfMemory`] if the encoder fails, which it does for no other reason.
    pub fn to_png(&self) -> Result<Vec<u8>, RenderError> {
        self.srgb_raster().to_file([0, 0], self.size, None)
    }

    /// Encodes the picture as an OpenEXR file: channels `R`, `G`, `B` in f32, linear light, not
    /// clamped.
    ///
    /// # Errors
    ///
    /// As [`Self::to_png`].
    pub fn to_exr(&self) -> Result<Vec<u8>, RenderError> {
        self.linear_raster().to_file([0, 0], self.size, None)
    }

    /// Encodes the depths as an OpenEXR file: one channel `Z` in f32, the distance from the eye to
    /// the surface along the pixel's ray (not along the camera's axis) in scene units; infinite for
    /// a ray that hit nothing.
    ///
    /// # Errors
    ///
    /// As [`Self::to_png`].
    pub fn depth_to_exr(&self) -> Result<Vec<u8>, RenderError> {
        self.depth_raster().to_file([0, 0], self.size, None)
    }
}

/// An animated GIF while its frames are added; it repeats without end. Each frame has its own 256
/// colours.
pub struct Animation<W: Write> {
    encoder: GifEncoder<W>,
}

impl<W: Write> Animation<W> {
    /// Starts an animation without frames. The file is complete when this value is dropped; `file`
    /// itself has to remember if its last bytes could not be written.
    ///
    /// # Errors
    ///
    /// [`RenderError::OutOfMemory`] if bytes cannot be written.
    pub fn new(file: W) -> Result<Self, RenderError> {
        let mut encoder = GifEncoder::new(file);
        encoder.set_repeat(Repeat::Infinite).map_err(refused)?;
        Ok(Self { encoder })
    }

    /// Adds a frame that is shown for a number of hundredths of a second; few viewers show one for
    /// less than 2. Its bytes are written at once.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn push(&mut self, image: &Image, hundredths: u32) -> Result<(), RenderError> {
        let [width, height] = image.size;
        let opaque = |rgb: &[u8]| [rgb[0], rgb[1], rgb[2], 255];
        let bytes = image.to_srgb8().chunks_exact(3).flat_map(opaque).collect();
        let pixels = image::RgbaImage::from_raw(width, height, bytes);
        let pixels = pixels.ok_or(RenderError::Size(image.size))?;
        let delay = image::Delay::from_numer_denom_ms(hundredths * 10, 1);
        self.encoder.encode_frame(image::Frame::from_parts(pixels, 0, 0, delay)).map_err(refused)
    }
}

fn refused(error: image::ImageError) -> RenderError {
    RenderError::OutOfMemory(format!("the GIF file: {error}"))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::image::HIT;
    use crate::view::footprint::Footprint;
    use exr::prelude::traits::*;
    use image::AnimationDecoder as _;

    #[test]
    fn a_png_reads_back() {
        let mut image = Image::new([3, 2], Footprint::default()).unwrap();
        image.pixels_mut()[4].color = [1.0, 0.5, 0.0, 1.0];
        let png = image.to_png().unwrap();
        let back = image::load_from_memory(&png).unwrap().to_rgb8();
        assert_eq!(back.dimensions(), (3, 2));
        assert_eq!(back.get_pixel(1, 1).0, [255, 188, 0]);
        assert_eq!(back.get_pixel(0, 0).0, [0, 0, 0]);
    }

    #[test]
    fn exr_files_read_back() {
        let mut image = Image::new([3, 2], Footprint::default()).unwrap();
        image.pixels_mut()[4].color = [3.5, 0.5, -1.0, 1.0];
        image.pixels_mut()[4].depth = 7.25;
        image.pixels_mut()[4].status = HIT;
        let channels = |file: Vec<u8>| {
            let image = exr::prelude::read()
                .no_deep_data()
                .largest_resolution_level()
                .all_channels()
                .first_valid_layer()
                .all_attributes()
                .from_buffered(Cursor::new(file))
                .unwrap();
            let samples = |channel: &exr::prelude::AnyChannel<exr::prelude::FlatSamples>| {
                (channel.name.to_string(), channel.sample_data.values_as_f32().collect::<Vec<_>>())
            };
            image.layer_data.channel_data.list.iter().map(samples).collect::<Vec<_>>()
        };
        let colors = channels(image.to_exr().unwrap());
        assert_eq!(colors[2], ("R".to_owned(), vec![0.0, 0.0, 0.0, 0.0, 3.5, 0.0]));
        assert_eq!(colors[0], ("B".to_owned(), vec![0.0, 0.0, 0.0, 0.0, -1.0, 0.0]));
        let none = f32::INFINITY;
        let depths = channels(image.depth_to_exr().unwrap());
        assert_eq!(depths, [("Z".to_owned(), vec![none, none, none, none, 7.25, none])]);
    }

    #[test]
    fn an_animation_reads_back() {
        let mut file = Vec::new();
        let mut animation = Animation::new(&mut file).unwrap();
        for level in [0.0, 1.0] {
            let mut image = Image::new([3, 2], Footprint::default()).unwrap();
            image.pixels_mut().iter_mut().for_each(|pixel| pixel.color = [level, 0.0, 0.0, 1.0]);
            animation.push(&image, 3).unwrap();
        }
        drop(animation);
        let decoder = image::codecs::gif::GifDecoder::new(Cursor::new(file)).unwrap();
        let frames = decoder.into_frames().collect_frames().unwrap();
        let red: Vec<u8> = frames.iter().map(|frame| frame.buffer().get_pixel(1, 1)[0]).collect();
        assert_eq!(red, [0, 255]);
        assert!(frames.iter().all(|frame| frame.delay().numer_denom_ms() == (30, 1)));
    }
}
