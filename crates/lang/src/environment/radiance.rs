//! Reads Radiance pictures (`.hdr`): a header of lines, then rows of pixels. A pixel has three
//! mantissas and one shared exponent, 8 bits each (RGBE).
//!
//! G. Ward, Real pixels, in Graphics Gems II (1991); the file format is described in
//! `filefmts.pdf` of Radiance. Rows are plain, or compressed in one of two ways: the old way
//! repeats whole pixels, the new way compresses each component of a row by itself. The line
//! `EXPOSURE` of a header has no effect, as in most programs.

/// The largest number of pixels: a picture of 8192 by 4096.
pub const MAX_PIXELS: usize = 1 << 25;
/// The largest number of bytes of a file. A picture of the most pixels has fewer.
pub const MAX_FILE_BYTES: usize = 1 << 28;
/// The longest line of a header.
const MAX_LINE: usize = 4096;
/// The greatest light of a pixel. The disc of the sun is darker, beside a sky of 1.
pub const MAX_LIGHT: f32 = 1e6;
/// The widths of rows that the new way can compress.
const COMPRESSED_WIDTHS: std::ops::Range<usize> = 8..0x8000;

/// A pixel: linear red, green and blue.
pub type Pixel = [f32; 3];

/// A picture whose rows are read one after the other, from the top.
pub struct Radiance<'b> {
    /// Columns and rows.
    pub size: [usize; 2],
    bytes: &'b [u8],
    row: Vec<[u8; 4]>,
}

impl<'b> Radiance<'b> {
    /// Reads the header.
    ///
    /// # Errors
    ///
    /// Returns the reason as the rest of a sentence about the picture.
    pub fn new(bytes: &'b [u8]) -> Result<Self, String> {
        if bytes.len() > MAX_FILE_BYTES {
            let (megabytes, most) = (bytes.len() >> 20, MAX_FILE_BYTES >> 20);
            return Err(format!("has {megabytes} MiB, but at most {most} MiB are read"));
        }
        let mut rest = bytes;
        if !line(&mut rest)?.starts_with("#?") {
            return Err("is not a Radiance picture: it does not begin with `#?`".to_owned());
        }
        loop {
            let line = line(&mut rest)?;
            match line.strip_prefix("FORMAT=") {
                _ if line.is_empty() => break,
                None | Some("32-bit_rle_rgbe") => {}
                Some(format) => {
                    return Err(format!("has the format `{format}`, not `32-bit_rle_rgbe`"));
                }
            }
        }
        let size = size(&line(&mut rest)?)?;
        Ok(Self { size, bytes: rest, row: Vec::new() })
    }

    /// Reads the next row. Light that is not a finite number cannot occur in the format.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn row(&mut self, pixels: &mut Vec<Pixel>) -> Result<(), String> {
        let width = self.size[0];
        self.row.clear();
        let first = self.bytes.get(..4).ok_or_else(truncated)?;
        let marked = usize::from(first[2]) << 8 | usize::from(first[3]);
        if COMPRESSED_WIDTHS.contains(&width) && first[..2] == [2, 2] && first[2] < 0x80 {
            if marked != width {
                return Err(format!("has a row of {marked} pixels, not {width}"));
            }
            self.bytes = &self.bytes[4..];
            self.compressed_row(width)?;
        } else {
            self.plain_row(width)?;
        }
        pixels.clear();
        pixels.extend(self.row.iter().map(|&pixel| light(pixel)));
        Ok(())
    }

    /// The new way: runs and plain bytes, for each of the four components by itself.
    fn compressed_row(&mut self, width: usize) -> Result<(), String> {
        self.row.resize(width, [0; 4]);
        for component in 0..4 {
            let mut column = 0;
            while column < width {
                let count = self.byte()?;
                let (count, value) = match count {
                    0 => return Err("has a run of 0 pixels".to_owned()),
                    129.. => (usize::from(count - 128), Some(self.byte()?)),
                    _ => (usize::from(count), None),
                };
                let end = column + count;
                let overrun = || "has a run beyond the end of its row".to_owned();
                for pixel in self.row.get_mut(column..end).ok_or_else(overrun)? {
                    pixel[component] = match value {
                        Some(value) => value,
                        None => {
                            let (&first, rest) = self.bytes.split_first().ok_or_else(truncated)?;
                            self.bytes = rest;
                            first
                        }
                    };
                }
                column = end;
            }
        }
        Ok(())
    }

    /// The old way: pixels of which the mantissas 1, 1, 1 repeat the one before, as often as the
    /// exponent says. Repetitions in a row count bytes of a number, the lowest first.
    fn plain_row(&mut self, width: usize) -> Result<(), String> {
        let mut shift = 0;
        while self.row.len() < width {
            let (pixel, rest) = self.bytes.split_first_chunk::<4>().ok_or_else(truncated)?;
            self.bytes = rest;
            let [1, 1, 1, count] = *pixel else {
                self.row.push(*pixel);
                shift = 0;
                continue;
            };
            let last = *self.row.last().ok_or("begins a row with a repetition")?;
            // Above 24 bits, only a count of 0 stays within a row.
            let count = usize::from(count).checked_shl(shift).unwrap_or(usize::MAX);
            if count > width - self.row.len() {
                return Err("has a run beyond the end of its row".to_owned());
            }
            self.row.resize(self.row.len() + count, last);
            shift = (shift + 8).min(32);
        }
        Ok(())
    }

    fn byte(&mut self) -> Result<u8, String> {
        let (&first, rest) = self.bytes.split_first().ok_or_else(truncated)?;
        self.bytes = rest;
        Ok(first)
    }
}

fn truncated() -> String {
    "ends in the middle of a row".to_owned()
}

/// Takes a line of the header.
fn line(rest: &mut &[u8]) -> Result<String, String> {
    let end = rest.iter().take(MAX_LINE).position(|&byte| byte == b'\n');
    let end = end.ok_or("has no complete header of a Radiance picture")?;
    let line = String::from_utf8_lossy(&rest[..end]).trim_end_matches('\r').to_owned();
    *rest = &rest[end + 1..];
    Ok(line)
}

/// The columns and rows that the last line of a header states: `-Y rows +X columns`.
fn size(line: &str) -> Result<[usize; 2], String> {
    let words: Vec<&str> = line.split_ascii_whitespace().collect();
    let ["-Y", rows, "+X", columns] = words[..] else {
        return Err(format!("states its size as `{line}`, not as `-Y 512 +X 1024`"));
    };
    let [Ok(columns), Ok(rows)] = [columns, rows].map(str::parse::<usize>) else {
        return Err(format!("states its size as `{line}`, not as `-Y 512 +X 1024`"));
    };
    if rows == 0 || rows.checked_mul(2) != Some(columns) {
        return Err(format!(
            "has {columns} by {rows} pixels, but a picture of all directions is twice as wide as \
             it is high"
        ));
    }
    if columns.saturating_mul(rows) > MAX_PIXELS {
        return Err(format!("has {columns} by {rows} pixels, but at most 8192 by 4096 are read"));
    }
    Ok([columns, rows])
}

/// The light of a pixel: mantissa / 256 * 2^(exponent - 128).
fn light([red, green, blue, exponent]: [u8; 4]) -> Pixel {
    if exponent == 0 {
        return [0.0; 3];
    }
    let unit = (f32::from(exponent) - 136.0).exp2();
    [red, green, blue].map(|mantissa| (f32::from(mantissa) * unit).min(MAX_LIGHT))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(size: &str, rows: &[u8]) -> Vec<u8> {
        let head = format!("#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n\n{size}\n");
        [head.as_bytes(), rows].concat()
    }

    fn rows(bytes: &[u8]) -> Result<Vec<Vec<Pixel>>, String> {
        let mut picture = Radiance::new(bytes)?;
        let mut rows = Vec::new();
        for _ in 0..picture.size[1] {
            let mut row = Vec::new();
            picture.row(&mut row)?;
            rows.push(row);
        }
        Ok(rows)
    }

    #[test]
    fn mantissas_share_an_exponent() {
        let plain = file("-Y 1 +X 2", &[128, 64, 0, 129, 255, 1, 2, 0]);
        assert_eq!(rows(&plain).unwrap(), [[[1.0, 0.5, 0.0], [0.0; 3]]]);
        let brightest = file("-Y 1 +X 2", &[255, 255, 255, 255, 128, 128, 128, 120]);
        let expected = [[MAX_LIGHT; 3], [1.0 / 512.0; 3]];
        assert_eq!(rows(&brightest).unwrap(), [expected]);
    }

    #[test]
    fn the_old_way_repeats_pixels() {
        let pixels = [128, 64, 0, 129, 1, 1, 1, 2, 0, 0, 128, 129, 2, 2, 128, 129];
        let row = rows(&file("-Y 2 +X 4", &[&pixels[..], &pixels[..12], &[0; 4]].concat()));
        let red = [1.0, 0.5, 0.0];
        assert_eq!(row.unwrap()[0], [red, red, red, [0.0, 0.0, 1.0]]);
        // Each pixel begins to count anew.
        let [a, b, again] = [[128, 0, 0, 129], [0, 128, 0, 129], [1, 1, 1, 1]];
        let row = rows(&file("-Y 2 +X 4", &[a, again, b, again].concat().repeat(2))).unwrap();
        let [red, green] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(row[1], [red, red, green, green]);
        // 4 + 256 repetitions.
        let long = [&[128, 128, 128, 129, 1, 1, 1, 4, 1, 1, 1, 1][..], &[0; 4 * 255]].concat();
        let both = file("-Y 258 +X 516", &long.repeat(258));
        let lit = |row: &Vec<Pixel>| row.iter().filter(|pixel| pixel[0] == 1.0).count();
        assert!(rows(&both).unwrap().iter().all(|row| lit(row) == 261));
    }

    #[test]
    fn the_new_way_compresses_components() {
        let red = [128 + 8, 128];
        let green = [3, 0, 64, 128, 128 + 5, 0];
        let blue = [8, 1, 2, 3, 4, 5, 6, 7, 8];
        let exponent = [128 + 7, 129, 1, 0];
        let row = [&[2, 2, 0, 8][..], &red, &green, &blue, &exponent].concat();
        let found = rows(&file("-Y 4 +X 8", &row.repeat(4))).unwrap();
        let blue = |value: f32| value / 128.0;
        assert_eq!(found[3][1], [1.0, 0.5, blue(2.0)]);
        assert_eq!((found[3][2], found[3][7]), ([1.0, 1.0, blue(3.0)], [0.0; 3]));
        // The most plain bytes, and the longest runs.
        let plain = [&[128][..], &[128; 128]].concat();
        let exponent = [128 + 127, 129, 1, 129];
        let row = [&[2, 2, 0, 128][..], &plain, &plain, &plain, &exponent].concat();
        let found = rows(&file("-Y 64 +X 128", &row.repeat(64))).unwrap();
        assert!(found[63].iter().all(|&pixel| pixel == [1.0; 3]));
    }

    #[test]
    fn damaged_files_are_errors() {
        let row = [&[2, 2, 0, 8, 136, 9, 136, 9, 136, 9, 136, 130][..]].concat();
        let whole = file("-Y 4 +X 8", &row.repeat(4));
        assert!(rows(&whole).is_ok());
        for length in 0..whole.len() {
            assert!(rows(&whole[..length]).is_err(), "{length}");
        }
        let why = |bytes: &[u8]| rows(bytes).err().unwrap_or_default();
        assert!(why(b"\x89PNG\r\n\x1a\n").contains("`#?`"));
        assert!(why(&[b'#'; 10_000]).contains("no complete header"));
        assert!(why(b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n").contains("xyze"));
        assert!(why(&file("+X 8 -Y 4", &row)).contains("-Y 512 +X 1024"));
        assert!(why(&file("-Y 4 +X 9", &row)).contains("twice as wide"));
        assert!(why(&file("-Y 0 +X 0", &row)).contains("twice as wide"));
        let huge = format!("-Y {} +X {}", usize::MAX, usize::MAX);
        assert!(why(&file(&huge, &row)).contains("twice as wide"));
        assert!(why(&file("-Y 8192 +X 16384", &row)).contains("at most 8192 by 4096"));
        for (damaged, expected) in [
            (&[2, 2, 0, 9, 0][..], "row of 9 pixels"),
            (&[2, 2, 0, 8, 0, 0], "run of 0"),
            (&[2, 2, 0, 8, 137, 5], "beyond the end"),
            (&[2, 2, 0, 8, 9, 0, 0, 0, 0, 0, 0, 0, 0, 0], "beyond the end"),
            (&[1, 1, 1, 2], "repetition"),
            (&[9, 9, 9, 9, 1, 1, 1, 8], "beyond the end"),
        ] {
            let why = why(&file("-Y 4 +X 8", damaged));
            assert!(why.contains(expected), "{why}");
        }
    }
}
