//! The pixels of a picture file, with a note: what files hold, and what is read back from them.

use std::borrow::Cow;
use std::io::Cursor;

use exr::error::UnitResult;
use exr::meta::attribute::{AttributeValue, IntegerBounds, Text};
use exr::meta::header::{ImageAttributes, LayerAttributes};
use exr::prelude::traits::*;
use exr::prelude::{FlatSamples, MetaData, SpecificChannels, Vec2};

use super::{HIT, Image, check_size};
use crate::error::RenderError;
use crate::tiles::Tile;

/// The keyword of the note in PNG files, and its attribute in EXR files.
const NOTE: &str = "sdfc";

/// The most channels of an EXR file that is read: those of colours, and one for depths or alpha.
const MAX_CHANNELS: usize = 4;

/// The pixels of a picture file: a picture, or a region of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Width and height in pixels.
    size: [u32; 2],
    /// The values of all pixels, row by row from the top.
    samples: Samples,
}

/// What the pixels of a file hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RasterKind {
    /// Colours in sRGB, for PNG.
    Srgb,
    /// Colours in linear light, for EXR.
    Linear,
    /// Distances along rays, for EXR.
    Depth,
}

impl std::fmt::Display for RasterKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Srgb => "colours as PNG",
            Self::Linear => "colours as EXR",
            Self::Depth => "depths as EXR",
        })
    }
}

/// The values of pixels, channel by channel within a pixel.
#[derive(Clone, Debug, PartialEq)]
enum Samples {
    /// Red, green, blue in sRGB, for PNG.
    Srgb(Vec<u8>),
    /// Red, green, blue in linear light, for EXR.
    Linear(Vec<f32>),
    /// Distances along rays, for EXR.
    Depth(Vec<f32>),
}

impl Image {
    /// The colours in sRGB, 8 bits per channel, as PNG files hold them.
    pub fn srgb_raster(&self) -> Raster {
        Raster { size: self.size, samples: Samples::Srgb(self.to_srgb8()) }
    }

    /// The colours in linear light, as EXR files hold them.
    pub fn linear_raster(&self) -> Raster {
        let colors = self.pixels.iter().flat_map(|pixel| {
            let [red, green, blue, _] = pixel.color;
            [red, green, blue]
        });
        Raster { size: self.size, samples: Samples::Linear(colors.collect()) }
    }

    /// The distances from the eye to the surface along each pixel's ray, in scene units; infinite
    /// for a ray that hit nothing.
    pub fn depth_raster(&self) -> Raster {
        let depths = self
            .pixels
            .iter()
            .map(|pixel| if pixel.status == HIT { pixel.depth } else { f32::INFINITY });
        Raster { size: self.size, samples: Samples::Depth(depths.collect()) }
    }
}

impl Raster {
    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// What the pixels hold.
    pub fn kind(&self) -> RasterKind {
        match self.samples {
            Samples::Srgb(_) => RasterKind::Srgb,
            Samples::Linear(_) => RasterKind::Linear,
            Samples::Depth(_) => RasterKind::Depth,
        }
    }

    /// The values as bytes, floats with the lowest byte first: the same for equal pixels on every
    /// machine.
    pub fn bytes(&self) -> Cow<'_, [u8]> {
        match &self.samples {
            Samples::Srgb(bytes) => Cow::Borrowed(bytes),
            Samples::Linear(values) | Samples::Depth(values) => {
                Cow::Owned(values.iter().flat_map(|value| value.to_le_bytes()).collect())
            }
        }
    }

    /// A picture of the same kind, all of its values 0.
    ///
    /// # Errors
    ///
    /// [`RenderError::Size`].
    pub fn blank(&self, size: [u32; 2]) -> Result<Self, RenderError> {
        check_size(size)?;
        let count = size[0] as usize * size[1] as usize;
        let samples = match self.samples {
            Samples::Srgb(_) => Samples::Srgb(vec![0; 3 * count]),
            Samples::Linear(_) => Samples::Linear(vec![0.0; 3 * count]),
            Samples::Depth(_) => Samples::Depth(vec![0.0; count]),
        };
        Ok(Self { size, samples })
    }

    /// Copies the pixels of a part into this picture. Returns false, and copies nothing, if the
    /// part reaches beyond it or holds something else.
    pub fn put(&mut self, origin: [u32; 2], part: &Self) -> bool {
        let region = Tile { origin, size: part.size };
        if !region.is_within(self.size) {
            return false;
        }
        let columns = [self.size[0], part.size[0]].map(|side| side as usize);
        let origin = origin.map(|first| first as usize);
        match (&mut self.samples, &part.samples) {
            (Samples::Srgb(into), Samples::Srgb(from)) => rows(into, from, 3, columns, origin),
            (Samples::Linear(into), Samples::Linear(from)) => rows(into, from, 3, columns, origin),
            (Samples::Depth(into), Samples::Depth(from)) => rows(into, from, 1, columns, origin),
            (Samples::Srgb(_) | Samples::Linear(_) | Samples::Depth(_), _) => return false,
        }
        true
    }

    /// Encodes the pixels: colours in sRGB as PNG, everything else as OpenEXR with f32 channels
    /// (`R`, `G`, `B`, or `Z` for depths).
    ///
    /// `note` is ASCII text that goes into the file, as the text `sdfc` of a PNG or the attribute
    /// `sdfc` of an EXR. The pixels begin at `origin` of the picture; EXR files state that as their
    /// data window and `picture` as their display window.
    ///
    /// # Errors
    ///
    /// [`RenderError::OutOfMemory`] if the encoder fails, which it does for no other reason.
    pub fn to_file(
        &self,
        origin: [u32; 2],
        picture: [u32; 2],
        note: Option<&str>,
    ) -> Result<Vec<u8>, RenderError> {
        match &self.samples {
            Samples::Srgb(bytes) => png_file(self.size, bytes, note)
                .map_err(|error| RenderError::OutOfMemory(format!("the PNG file: {error}"))),
            Samples::Linear(values) => {
                let width = self.size[0] as usize;
                let color = |Vec2(x, y): Vec2<usize>| match values[3 * (y * width + x)..] {
                    [red, green, blue, ..] => (red, green, blue),
                    _ => (0.0, 0.0, 0.0),
                };
                let channels = SpecificChannels::rgb(color);
                let mut image = exr::image::Image::from_channels(self.sides(), channels);
                let layer = &mut image.layer_data.attributes;
                describe(&mut image.attributes, layer, origin, picture, note);
                exr_file(|file| image.write().non_parallel().to_buffered(file))
            }
            Samples::Depth(values) => {
                let width = self.size[0] as usize;
                let depth = |Vec2(x, y): Vec2<usize>| (values[y * width + x],);
                let channels =
                    SpecificChannels::build().with_channel::<f32>("Z").with_pixel_fn(depth);
                let mut image = exr::image::Image::from_channels(self.sides(), channels);
                let layer = &mut image.layer_data.attributes;
                describe(&mut image.attributes, layer, origin, picture, note);
                exr_file(|file| image.write().non_parallel().to_buffered(file))
            }
        }
    }

    fn sides(&self) -> (usize, usize) {
        (self.size[0] as usize, self.size[1] as usize)
    }

    /// Reads a file that [`Self::to_file`] wrote, and its note.
    ///
    /// # Errors
    ///
    /// Returns the reason in one line: the file is damaged, is none of these files, or is larger
    /// than a picture can be.
    pub fn from_file(bytes: &[u8]) -> Result<(Self, Option<String>), String> {
        if bytes.starts_with(b"\x89PNG") { from_png(bytes) } else { from_exr(bytes) }
    }
}

/// States where the pixels are in the picture, and adds the note.
fn describe(
    image: &mut ImageAttributes,
    layer: &mut LayerAttributes,
    origin: [u32; 2],
    picture: [u32; 2],
    note: Option<&str>,
) {
    // Sides have at most 16,384 pixels.
    layer.layer_position = Vec2(origin[0] as i32, origin[1] as i32);
    let [width, height] = picture.map(|side| side as usize);
    image.display_window = IntegerBounds::from_dimensions((width, height));
    if let Some(note) = note.and_then(Text::new_or_none) {
        layer.other.insert(Text::from(NOTE), AttributeValue::Text(note));
    }
}

fn exr_file(
    write: impl FnOnce(&mut Cursor<Vec<u8>>) -> UnitResult,
) -> Result<Vec<u8>, RenderError> {
    let mut file = Cursor::new(Vec::new());
    let refused = |error| RenderError::OutOfMemory(format!("the EXR file: {error}"));
    write(&mut file).map_err(refused)?;
    Ok(file.into_inner())
}

/// Copies the rows of a part; `columns` are those of both.
fn rows<T: Copy>(
    into: &mut [T],
    from: &[T],
    channels: usize,
    columns: [usize; 2],
    [left, top]: [usize; 2],
) {
    let [into_row, from_row] = columns.map(|count| count * channels);
    let targets = into.chunks_exact_mut(into_row).skip(top);
    for (target, row) in targets.zip(from.chunks_exact(from_row)) {
        if let Some(target) = target.get_mut(left * channels..left * channels + from_row) {
            target.copy_from_slice(row);
        }
    }
}

fn png_file(
    [width, height]: [u32; 2],
    bytes: &[u8],
    note: Option<&str>,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_filter(png::Filter::Adaptive);
    if let Some(note) = note {
        encoder.add_text_chunk(NOTE.to_owned(), note.to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()?;
    Ok(file)
}

fn from_png(file: &[u8]) -> Result<(Raster, Option<String>), String> {
    let damaged = |error: png::DecodingError| format!("the PNG file is damaged: {error}");
    let mut reader = png::Decoder::new(Cursor::new(file)).read_info().map_err(damaged)?;
    let info = reader.info();
    let size = [info.width, info.height];
    check_size(size).map_err(|error| error.to_string())?;
    if (info.color_type, info.bit_depth) != (png::ColorType::Rgb, png::BitDepth::Eight) {
        return Err("the PNG file has other channels than red, green and blue with 8 bits".into());
    }
    let mut bytes = vec![0; 3 * size[0] as usize * size[1] as usize];
    reader.next_frame(&mut bytes).map_err(damaged)?;
    reader.finish().map_err(damaged)?;
    let texts = &reader.info().uncompressed_latin1_text;
    let note = texts.iter().find(|text| text.keyword == NOTE).map(|text| text.text.clone());
    Ok((Raster { size, samples: Samples::Srgb(bytes) }, note))
}

fn from_exr(file: &[u8]) -> Result<(Raster, Option<String>), String> {
    let damaged =
        |error: exr::error::Error| format!("the file is no PNG or EXR, or damaged: {error}");
    // The sizes are checked before memory is reserved.
    let meta = MetaData::read_from_buffered(file, false).map_err(damaged)?;
    for header in &meta.headers {
        let Vec2(width, height) = header.layer_size;
        let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
        check_size([side(width), side(height)]).map_err(|error| error.to_string())?;
        if header.channels.list.len() > MAX_CHANNELS {
            return Err(format!("the EXR file has more than {MAX_CHANNELS} channels"));
        }
    }
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(file))
        .map_err(damaged)?;
    let layer = image.layer_data;
    let size = [layer.size.width() as u32, layer.size.height() as u32];
    let values = |name: &str| {
        let channels = layer.channel_data.list.iter();
        let found = channels.into_iter().find(|channel| channel.name == *name);
        match found.map(|channel| &channel.sample_data) {
            Some(FlatSamples::F32(values)) => Some(values),
            Some(FlatSamples::F16(_) | FlatSamples::U32(_)) | None => None,
        }
    };
    let samples = match (values("R"), values("G"), values("B"), values("Z")) {
        (Some(red), Some(green), Some(blue), None) => {
            let colors = red.iter().zip(green).zip(blue);
            Samples::Linear(colors.flat_map(|((r, g), b)| [*r, *g, *b]).collect())
        }
        (None, None, None, Some(depths)) => Samples::Depth(depths.clone()),
        _ => return Err("the EXR file has other channels than R, G, B or Z in f32".into()),
    };
    let note = match layer.attributes.other.get(&Text::from(NOTE)) {
        Some(AttributeValue::Text(note)) => Some(note.to_string()),
        _ => None,
    };
    Ok((Raster { size, samples }, note))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::footprint::Footprint;

    /// A picture in which no two pixels are equal, and some are not finite.
    fn image(size: [u32; 2]) -> Image {
        let mut image = Image::new(size, Footprint::default()).unwrap();
        for (index, pixel) in image.pixels_mut().iter_mut().enumerate() {
            pixel.color = [index as f32 / 50.0, 1.5 - index as f32, 1e-40, 1.0];
            pixel.depth = index as f32;
            pixel.status = (index % 3) as u16;
        }
        image.pixels_mut()[1].color[2] = f32::from_bits(0x7fc0_1234);
        image
    }

    fn rasters(image: &Image) -> [Raster; 3] {
        [image.srgb_raster(), image.linear_raster(), image.depth_raster()]
    }

    #[test]
    fn files_read_back_with_their_notes() {
        for raster in rasters(&image([7, 5])) {
            for note in [None, Some("{\"size\":[7,5]}")] {
                let file = raster.to_file([3, 4], [20, 10], note).unwrap();
                let (back, said) = Raster::from_file(&file).unwrap();
                assert_eq!(back.bytes(), raster.bytes(), "{}", raster.kind());
                assert_eq!((back.kind(), back.size()), (raster.kind(), raster.size()));
                assert_eq!(said.as_deref(), note);
                let cut = Raster::from_file(&file[..file.len() - 9]);
                assert!(cut.is_err(), "{} without its end", raster.kind());
            }
        }
        assert!(Raster::from_file(b"").is_err());
        assert!(Raster::from_file(b"GIF89a").is_err());
    }

    #[test]
    fn an_exr_file_says_where_its_pixels_are() {
        let file = image([7, 5]).linear_raster().to_file([3, 4], [20, 10], None).unwrap();
        let meta = MetaData::read_from_buffered(&file[..], false).unwrap();
        let header = &meta.headers[0];
        assert_eq!(header.own_attributes.layer_position, Vec2(3, 4));
        assert_eq!(header.shared_attributes.display_window.size, Vec2(20, 10));
    }

    #[test]
    fn parts_make_the_whole() {
        for whole in rasters(&image([7, 5])) {
            let mut joined = whole.blank([7, 5]).unwrap();
            for (origin, size) in [([0, 0], [3, 5]), ([3, 0], [4, 2]), ([3, 2], [4, 3])] {
                let mut part = whole.blank(size).unwrap();
                for y in 0..size[1] {
                    for x in 0..size[0] {
                        let one = pixel(&whole, origin[0] + x, origin[1] + y);
                        assert!(part.put([x, y], &one));
                    }
                }
                assert!(joined.put(origin, &part));
                assert!(!joined.put([origin[0] + 5, 0], &part), "beyond the border");
            }
            assert_eq!(joined.bytes(), whole.bytes(), "{}", whole.kind());
        }
        let [png, exr, _] = rasters(&image([2, 2]));
        assert!(!png.clone().put([0, 0], &exr), "another kind");
    }

    fn pixel(whole: &Raster, x: u32, y: u32) -> Raster {
        let at = (y * whole.size[0] + x) as usize;
        let samples = match &whole.samples {
            Samples::Srgb(bytes) => Samples::Srgb(bytes[3 * at..3 * at + 3].to_vec()),
            Samples::Linear(values) => Samples::Linear(values[3 * at..3 * at + 3].to_vec()),
            Samples::Depth(values) => Samples::Depth(vec![values[at]]),
        };
        Raster { size: [1, 1], samples }
    }
}
