//! The time of the scene: plays, pauses, is dragged, starts again.

/// Frames a second of the `frame` that a scene may read, as `sdfc render` counts them.
const FRAME_RATE: f64 = 30.0;
/// A pause of the window is not made up for.
const LONGEST_STEP: f64 = 0.25;

/// The time of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Seconds.
    pub time: f64,
    /// Whether it runs.
    pub playing: bool,
    /// Seconds of the scene a second.
    pub speed: f64,
    /// Whether it starts again at the end, instead of stopping there.
    pub looping: bool,
    /// The end, in seconds.
    pub end: f64,
}

impl Default for Clock {
    fn default() -> Self {
        Self { time: 0.0, playing: false, speed: 1.0, looping: true, end: 10.0 }
    }
}

impl Clock {
    /// Lets so many seconds pass.
    pub fn advance(&mut self, seconds: f64) {
        if !self.playing {
            return;
        }
        let time = self.time + seconds.clamp(0.0, LONGEST_STEP) * self.speed;
        if self.looping && self.end > 0.0 {
            self.time = time.rem_euclid(self.end);
        } else {
            self.time = time.clamp(0.0, self.end.max(0.0));
            self.playing = self.time == time;
        }
    }

    /// Plays or pauses; from where it stopped at an end it plays all of it again.
    pub fn toggle(&mut self) {
        self.playing = !self.playing;
        let ahead = if self.speed < 0.0 { 0.0 } else { self.end };
        if self.playing && self.time == ahead {
            self.time = self.end - ahead;
        }
    }

    /// The number of the frame.
    pub fn frame(&self) -> f64 {
        (self.time * FRAME_RATE).floor()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_runs_at_its_speed_and_starts_again() {
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
    fn without_a_loop_it_stops_at_its_end_and_plays_again() {
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
