//! The scene's time: playing, pausing, looping.

/// Frames per second of the `frame` that a scene may read, as in `sdfc render`.
const FRAME_RATE: f64 = 30.0;
/// The longest step in seconds: time that passes while the window is not drawn is skipped.
const MAX_STEP: f64 = 0.25;

/// The scene's time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// The current time in seconds.
    pub time: f64,
    /// True while time advances.
    pub playing: bool,
    /// Scene seconds per second; negative plays backwards.
    pub speed: f64,
    /// True to start again at the end instead of stopping.
    pub looping: bool,
    /// The end of the loop in seconds.
    pub end: f64,
}

impl Default for Clock {
    fn default() -> Self {
        Self { time: 0.0, playing: false, speed: 1.0, looping: true, end: 10.0 }
    }
}

impl Clock {
    /// Advances the time by `seconds` times the speed, if playing.
    pub fn advance(&mut self, seconds: f64) {
        if !self.playing {
            return;
        }
        let time = self.time + seconds.clamp(0.0, MAX_STEP) * self.speed;
        if self.looping && self.end > 0.0 {
            self.time = time.rem_euclid(self.end);
        } else {
            self.time = time.clamp(0.0, self.end.max(0.0));
            self.playing = self.time == time;
        }
    }

    /// Plays or pauses. If it stopped at the end, it plays from the start.
    pub fn toggle(&mut self) {
        self.playing = !self.playing;
        let target = if self.speed < 0.0 { 0.0 } else { self.end };
        if self.playing && self.time == target {
            self.time = self.end - target;
        }
    }

    /// The frame number.
    pub fn frame(&self) -> f64 {
        (self.time * FRAME_RATE).floor()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_looping_clock_advances_at_its_speed_and_wraps() {
        let mut clock = Clock { playing: true, speed: 2.0, end: 1.0, ..Clock::default() };
        clock.advance(0.25);
        assert_eq!((clock.time, clock.frame()), (0.5, 15.0));
        clock.advance(0.25);
        clock.advance(0.1);
        assert!((clock.time - 0.2).abs() < 1e-12);
        clock.playing = false;
        clock.advance(0.1);
        assert!((clock.time - 0.2).abs() < 1e-12);
        let mut backwards = Clock { speed: -1.0, playing: true, ..Clock::default() };
        backwards.advance(0.25);
        assert_eq!(backwards.time, 9.75);
    }

    #[test]
    fn without_looping_a_clock_stops_at_the_end_and_restarts() {
        for (speed, start, end) in [(1.0, 0.0, 0.5), (-1.0, 0.5, 0.0)] {
            let mut clock =
                Clock { speed, time: start, looping: false, end: 0.5, ..Clock::default() };
            clock.toggle();
            (0..4).for_each(|_| clock.advance(0.2));
            assert_eq!((clock.time, clock.playing), (end, false));
            clock.toggle();
            assert_eq!((clock.time, clock.playing), (start, true));
        }
    }
}
