//! Regions of a picture, and the names of their files.

use std::path::{Path, PathBuf};

use sdfc::Tile;

use super::share::{Share, share};

/// Rows of a band are a multiple of this, except at the lower border: renderers draw blocks of
/// this side, so no block is drawn twice.
const BAND_STEP: u32 = 8;

/// Stands in file names between the name of a picture and the region of a part.
const PART: &str = ".part-";

/// A region of a picture, as the command line states it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// Columns and rows.
    Pixels(Tile),
    /// A share of the rows.
    Band(Share),
}

impl Region {
    /// The pixels that it has in a picture; `None` for a band without rows.
    ///
    /// # Errors
    ///
    /// It reaches beyond the picture.
    pub fn of(self, size: [u32; 2]) -> Result<Option<Tile>, String> {
        match self {
            Self::Pixels(region) if region.is_within(size) => Ok(Some(region)),
            Self::Pixels(region) => {
                let [width, height] = size;
                let name = name(region);
                Err(format!("the region {name} is not within the picture of {width}x{height}"))
            }
            Self::Band(share) => Ok(share.of_rows(size[1], BAND_STEP).map(|rows| Tile {
                origin: [0, rows.start],
                size: [size[0], rows.end - rows.start],
            })),
        }
    }
}

/// Parses `X,Y,WxH`, or a share of the rows such as `3/8`.
pub fn region(text: &str) -> Result<Region, String> {
    if text.contains('/') {
        return share(text).map(Region::Band);
    }
    let pixels = || {
        let mut parts = text.split(',');
        let (x, y, size) = (parts.next()?, parts.next()?, parts.next()?);
        let (width, height) = size.split_once('x')?;
        let number = |text: &str| text.parse::<u32>().ok();
        let region =
            Tile { origin: [number(x)?, number(y)?], size: [number(width)?, number(height)?] };
        parts.next().is_none().then_some(region)
    };
    let expected = "expected X,Y,WxH, such as 0,512,3840x256, or K/N, such as 3/8 for the third of \
                    eight bands of rows";
    let region = pixels().ok_or(expected)?;
    match region.size {
        [0, _] | [_, 0] => Err("width and height must be at least 1".to_owned()),
        _ => Ok(Region::Pixels(region)),
    }
}

/// A region as the command line takes it: `0,512,3840x256`.
pub fn name(Tile { origin: [x, y], size: [width, height] }: Tile) -> String {
    format!("{x},{y},{width}x{height}")
}

/// Returns the files beside a picture that are named like its parts, by name.
///
/// # Errors
///
/// The folder cannot be read.
pub fn parts_of(path: &Path) -> std::io::Result<Vec<PathBuf>> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned() + PART;
    let mut parts = Vec::new();
    for entry in std::fs::read_dir(folder.unwrap_or(Path::new(".")))? {
        let entry = entry?;
        let is_part = entry.file_name().to_string_lossy().starts_with(&stem);
        let file = Path::new(&entry.file_name()).to_owned();
        if is_part && file.extension() == path.extension() {
            parts.push(path.with_file_name(file));
        }
    }
    parts.sort();
    Ok(parts)
}

/// Returns the file name of a part: `ball.part-0-512-3840x256.png` for `ball.png`.
pub fn part_path(path: &Path, region: Tile) -> PathBuf {
    let mut file = path.file_stem().unwrap_or_default().to_owned();
    file.push(format!("{PART}{}", name(region).replace(',', "-")));
    if let Some(extension) = path.extension() {
        file.push(".");
        file.push(extension);
    }
    path.with_file_name(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_parsed_or_refused() {
        let tile = Tile { origin: [0, 512], size: [3840, 256] };
        assert_eq!(region("0,512,3840x256"), Ok(Region::Pixels(tile)));
        assert_eq!(Region::Pixels(tile).of([3840, 768]), Ok(Some(tile)));
        assert!(Region::Pixels(tile).of([3840, 767]).is_err());
        for wrong in ["", "1,2", "1,2,3", "1,2,3x", "1,2,0x4", "1,2,3x4,5", "-1,2,3x4", "9/8"] {
            assert!(region(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn parts_are_named_before_their_extension() {
        let tile = Tile { origin: [0, 512], size: [3840, 256] };
        let path = part_path(Path::new("a/ball.0007.png"), tile);
        assert_eq!(path, Path::new("a/ball.0007.part-0-512-3840x256.png"));
    }
}
