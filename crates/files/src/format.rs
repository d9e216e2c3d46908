//! The file formats of pictures.

use std::io::{Error, ErrorKind, Read as _};
use std::path::Path;

use sdfc::{Animation, Image, RasterKind, RenderError};

/// The largest file of a picture that is read, in bytes: more than three f32 channels of the most
/// pixels that a picture has.
const MAX_PICTURE_BYTES: u64 = 1 << 30;

/// Reads the file of a picture.
///
/// # Errors
///
/// The file is missing, unreadable or larger than 1 GiB.
pub fn read_picture(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(MAX_PICTURE_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_PICTURE_BYTES {
        let most = MAX_PICTURE_BYTES >> 20;
        return Err(Error::new(ErrorKind::FileTooLarge, format!("it is larger than {most} MiB")));
    }
    Ok(bytes)
}

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// PNG: 8 bits of sRGB per channel.
    Png,
    /// OpenEXR: 32 bits of linear light per channel.
    Exr,
    /// GIF: 256 colours, and animations.
    Gif,
}

impl Format {
    /// Returns the format for the extension of a path: PNG if there is none, as for stdout.
    ///
    /// # Errors
    ///
    /// The extension belongs to no format. The message names the formats.
    pub fn of(path: &Path) -> Result<Self, String> {
        let Some(extension) = path.extension() else { return Ok(Self::Png) };
        let formats = [("png", Self::Png), ("exr", Self::Exr), ("gif", Self::Gif)];
        let format = formats.iter().find(|(known, _)| extension.eq_ignore_ascii_case(known));
        format.map(|(_, format)| *format).ok_or_else(|| {
            let path = path.display();
            format!("{path}: pictures are written as .png, .exr or .gif")
        })
    }

    /// Returns true if files of this format hold pixels of this kind.
    pub fn holds(self, kind: RasterKind) -> bool {
        match kind {
            RasterKind::Srgb => self == Self::Png,
            RasterKind::Linear | RasterKind::Depth => self == Self::Exr,
        }
    }

    /// Encodes a picture.
    ///
    /// # Errors
    ///
    /// [`RenderError::OutOfMemory`].
    pub fn encode(self, image: &Image) -> Result<Vec<u8>, RenderError> {
        match self {
            Self::Png => image.to_png(),
            Self::Exr => image.to_exr(),
            Self::Gif => {
                let mut file = Vec::new();
                Animation::new(&mut file)?.push(image, 0)?;
                Ok(file)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_determines_the_format() {
        let of = |path: &str| Format::of(Path::new(path)).ok();
        assert_eq!([of("-"), of("a"), of("a.PNG")], [Some(Format::Png); 3]);
        assert_eq!((of("a.gif"), of("a.exr")), (Some(Format::Gif), Some(Format::Exr)));
        assert_eq!(of("a.jpg"), None);
    }
}
