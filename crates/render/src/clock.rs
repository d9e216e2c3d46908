//! Times of frames, and what measured them.

use std::time::Instant;

use serde::Serialize;

/// The clock that measured a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Clock {
    /// Timestamps written by the GPU.
    Gpu,
    /// The wall clock, waiting included.
    Wall,
}

/// Times of repeated frames, in milliseconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrameTimes {
    /// The median; for an even number of frames, the mean of the middle two.
    pub median: f64,
    /// The shortest.
    pub min: f64,
    /// The longest.
    pub max: f64,
    /// The number of frames.
    pub n: usize,
    /// The clock that measured them.
    pub clock: Clock,
}

/// The time since `start` by the wall clock, in milliseconds.
pub fn milliseconds_since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

impl FrameTimes {
    /// Summarises one time or more; `None` for none.
    pub fn of(times: &[f64], clock: Clock) -> Option<Self> {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        let n = sorted.len();
        let median = (sorted.get((n - 1) / 2)? + sorted.get(n / 2)?) / 2.0;
        Some(Self { median, min, max, n, clock })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_odd_and_even_numbers_of_frames() {
        let times = FrameTimes::of(&[3.0, 1.0, 8.0], Clock::Wall).unwrap();
        assert_eq!((times.median, times.min, times.max, times.n), (3.0, 1.0, 8.0, 3));
        let times = FrameTimes::of(&[4.0, 1.0, 2.0, 8.0], Clock::Gpu).unwrap();
        assert_eq!(times.median, 3.0);
        assert!(FrameTimes::of(&[], Clock::Gpu).is_none());
    }
}
