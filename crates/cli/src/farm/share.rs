//! Shares of equal size.

use crate::sequence::Frames;

/// At most this many shares.
const MAX_SHARES: u32 = 1_000_000;

/// The K-th of N shares of equal size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// Its number, from 1.
    number: u32,
    /// How many there are.
    count: u32,
}

impl Share {
    /// Its part of `length` units that stand in a row, as a half-open range; empty if there are
    /// more shares than units. The sizes of two shares differ by at most one unit.
    fn range(self, length: u32) -> std::ops::Range<u32> {
        let start = |number: u32| {
            (u64::from(length) * u64::from(number) / u64::from(self.count.max(1))) as u32
        };
        start(self.number - 1)..start(self.number)
    }

    /// Its part of a range of frames; `None` if there are more shares than frames.
    pub fn of_frames(self, frames: Frames) -> Option<Frames> {
        let range = self.range(frames.count());
        let share = Frames { first: frames.first + range.start, end: frames.first + range.end };
        (!range.is_empty()).then_some(share)
    }

    /// Its part of the rows of a picture, in steps of `step` rows. `None` if there are more shares
    /// than steps.
    pub fn of_rows(self, height: u32, step: u32) -> Option<std::ops::Range<u32>> {
        let range = self.range(height.div_ceil(step));
        let row = |unit: u32| unit.saturating_mul(step).min(height);
        (!range.is_empty()).then(|| row(range.start)..row(range.end))
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

/// Parses a share such as `2/5`.
pub fn share(text: &str) -> Result<Share, String> {
    let parts = text.split_once('/').map(|(k, n)| (k.parse::<u32>(), n.parse::<u32>()));
    let Some((Ok(number), Ok(count))) = parts else {
        return Err("expected K/N, such as 2/5 for the second of five shares".to_owned());
    };
    if count > MAX_SHARES {
        return Err(format!("there are at most {MAX_SHARES} shares"));
    }
    if number == 0 || number > count {
        return Err(format!(
            "shares are numbered from 1; choose one of 1/{count} to {count}/{count}"
        ));
    }
    Ok(Share { number, count })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_follow_each_other_and_differ_by_at_most_one() {
        let frames = Frames { first: 10, end: 34 };
        for count in [1, 2, 5, 7, 24, 25, 100] {
            let shares = (1..=count).filter_map(|k| Share { number: k, count }.of_frames(frames));
            let shares: Vec<Frames> = shares.collect();
            let all: Vec<u32> = shares.iter().flat_map(Frames::numbers).collect();
            assert_eq!(all, (10..34).collect::<Vec<_>>(), "{count}");
            let sizes = shares.iter().map(Frames::count);
            assert!(sizes.clone().max().unwrap() - sizes.min().unwrap() <= 1, "{count}");
        }
    }

    #[test]
    fn bands_begin_at_multiples_and_end_with_the_picture() {
        let band = |k, n, height| Share { number: k, count: n }.of_rows(height, 8);
        assert_eq!((band(1, 2, 101), band(2, 2, 101)), (Some(0..48), Some(48..101)));
        assert_eq!(band(8, 8, 2160), Some(1888..2160));
        assert_eq!((1..=5).filter_map(|k| band(k, 5, 16)).count(), 2);
    }

    #[test]
    fn shares_are_parsed_or_refused() {
        assert_eq!(share("2/5"), Ok(Share { number: 2, count: 5 }));
        for wrong in ["", "2", "0/5", "6/5", "1/0", "-1/5", "a/5", "1/2/3", "1/9999999"] {
            assert!(share(wrong).is_err(), "{wrong}");
        }
    }
}
