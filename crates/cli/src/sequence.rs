//! Sequences of frames: numbers, times and file names.

use std::path::{Path, PathBuf};

/// At most this many frames are drawn at once.
const MAX_FRAMES: u32 = 1_000_000;
/// Greatest frame rate, in frames per second.
const MAX_RATE: f64 = 1000.0;

/// A half-open range of frame numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frames {
    /// First frame.
    pub first: u32,
    /// Frame after the last.
    pub end: u32,
}

impl Frames {
    /// Number of frames.
    pub fn count(&self) -> u32 {
        self.end - self.first
    }

    /// The frame numbers.
    pub fn numbers(&self) -> std::ops::Range<u32> {
        self.first..self.end
    }
}

/// Parses a range. `0..60` is half-open, so that adjacent ranges share no frame. `0-59` includes
/// its end, and `7` is one frame: so render farms write ranges.
pub fn frames(text: &str) -> Result<Frames, String> {
    let expected = "expected FIRST..END, such as 0..60 for frames 0 to 59, or FIRST-LAST";
    let number = |text: &str| text.parse::<u32>().map_err(|_| expected.to_owned());
    let after = |last: u32| last.checked_add(1).ok_or_else(|| expected.to_owned());
    let (first, end) = match (text.split_once(".."), text.split_once('-')) {
        (Some((first, end)), _) => (number(first)?, number(end)?),
        (None, Some((first, last))) => (number(first)?, after(number(last)?)?),
        (None, None) => (number(text)?, after(number(text)?)?),
    };
    if first >= end {
        return Err(format!("{text} contains no frame; the END of FIRST..END itself is not drawn"));
    }
    if end - first > MAX_FRAMES {
        return Err(format!("a sequence has at most {MAX_FRAMES} frames"));
    }
    Ok(Frames { first, end })
}

/// Parses a frame rate.
pub fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse::<f64>().ok().filter(|rate| *rate > 0.0 && *rate <= MAX_RATE);
    rate.ok_or_else(|| format!("expected a number above 0 and at most {MAX_RATE}"))
}

/// Returns the time of a frame in seconds.
pub fn time(number: u32, rate: f64) -> f64 {
    f64::from(number) / rate
}

/// Returns the number of the frame that a single picture shows.
pub fn frame(time: f64, rate: f64) -> f64 {
    (time * rate).round()
}

/// Returns how long a frame is shown, in hundredths of a second. Rounding errors of a sequence do
/// not add up.
pub fn hundredths(number: u32, rate: f64) -> u32 {
    let start = |number: f64| (100.0 * number / rate).round();
    (start(f64::from(number) + 1.0) - start(f64::from(number))) as u32
}

/// Returns the file name of a frame: `ball.0007.png` for `ball.png` and 7.
pub fn numbered(path: &Path, number: u32) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!(".{number:04}"));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_half_open_with_dots_and_closed_with_a_dash() {
        let range = frames("5..8").unwrap();
        assert_eq!((range.count(), range.numbers()), (3, 5..8));
        assert_eq!(frames("5-7"), Ok(range));
        assert_eq!(frames("5").unwrap().numbers(), 5..6);
        for wrong in [
            "",
            "-5",
            "5-",
            "8-5",
            "1-2,4",
            "4294967295",
            "5..",
            "..5",
            "8..5",
            "5..5",
            "-1..5",
            "0..5..9",
            "0..99999999",
        ] {
            assert!(frames(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn rates_must_be_positive() {
        assert_eq!((rate("29.97"), time(60, 30.0)), (Ok(29.97), 2.0));
        for wrong in ["0", "-3", "nan", "inf", "1e9", "thirty"] {
            assert!(rate(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_second_of_frames_lasts_a_second() {
        for rate in [7.0, 24.0, 30.0, 50.0] {
            let all: u32 = (0..rate as u32).map(|number| hundredths(number, rate)).sum();
            assert_eq!(all, 100, "{rate}");
        }
    }

    #[test]
    fn files_are_numbered_before_their_extension() {
        let name = |path: &str, number| numbered(Path::new(path), number);
        assert_eq!(name("a/b.c/ball.png", 7), Path::new("a/b.c/ball.0007.png"));
        assert_eq!(name("ball", 12345), Path::new("ball.12345"));
    }
}
