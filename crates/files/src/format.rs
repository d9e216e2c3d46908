//! File formats of pictures.

use std::path::Path;

use sdfc::render::{Animation, Image, RenderError};

/// How a picture is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8 bits of sRGB a channel.
    Png,
    /// 32 bits of linear light a channel.
    Exr,
    /// 256 colours; frames that move.
    Gif,
}

impl Format {
    /// By the ending of a path; without one, and on stdout, a PNG.
    ///
    /// # Errors
    ///
    /// The ending is that of another format; which there are.
    pub fn of(path: &Path) -> Result<Self, String> {
        let Some(ending) = path.extension() else { return Ok(Self::Png) };
        let formats = [("png", Self::Png), ("exr", Self::Exr), ("gif", Self::Gif)];
        let found = formats.iter().find(|(known, _)| ending.eq_ignore_ascii_case(known));
        found.map(|(_, format)| *format).ok_or_else(|| {
            let path = path.display();
            format!("{path}: pictures are written as .png, .exr or .gif")
        })
    }

    /// A picture as a file.
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
    fn endings_decide() {
        let of = |path: &str| Format::of(Path::new(path)).ok();
        assert_eq!([of("-"), of("a"), of("a.PNG")], [Some(Format::Png); 3]);
        assert_eq!((of("a.gif"), of("a.exr")), (Some(Format::Gif), Some(Format::Exr)));
        assert_eq!(of("a.jpg"), None);
    }
}
