//! Chooses the resolution of first passes, so that a moving picture keeps up with the hand.

/// The longest time of a pass while the camera moves, in milliseconds.
pub const PASS_BUDGET_MS: f64 = 30.0;
/// The coarsest pass divides width and height by this.
const MAX_DIVISOR: u32 = 8;
/// The divisor of a scene's first pass, when its cost is not known yet.
const FIRST_DIVISOR: u32 = 4;
/// The resolution rises only if a pass would take less than this fraction of the budget. Otherwise
/// a scene near the limit would change its resolution from pass to pass.
const RISE_BELOW: f64 = 0.5;
/// The weight of the last pass in the mean cost.
const LAST_WEIGHT: f64 = 0.5;

/// The measured cost of a scene, and the resolution that follows from it.
#[derive(Debug, Default)]
pub struct Pacing {
    /// The serial of the measured model and its milliseconds per pixel, a running mean.
    cost: Option<(u64, f64)>,
    /// The divisor of the last first pass of that model.
    divisor: u32,
}

impl Pacing {
    /// The divisor at which a first pass of so many pixels should stay within the budget.
    pub fn first_divisor(&mut self, serial: u64, pixels: f64) -> u32 {
        let Some((_, cost)) = self.cost.filter(|(measured, _)| *measured == serial) else {
            self.divisor = FIRST_DIVISOR;
            return FIRST_DIVISOR;
        };
        let time = |divisor: u32| cost * pixels / f64::from(divisor * divisor);
        let mut divisor = self.divisor.clamp(1, MAX_DIVISOR);
        while divisor < MAX_DIVISOR && time(divisor) > PASS_BUDGET_MS {
            divisor *= 2;
        }
        while divisor > 1 && time(divisor / 2) < RISE_BELOW * PASS_BUDGET_MS {
            divisor /= 2;
        }
        self.divisor = divisor;
        divisor
    }

    /// Records the duration of a pass, or of a part of one.
    pub fn record(&mut self, serial: u64, milliseconds: f64, pixels: f64) {
        let last = milliseconds / pixels.max(1.0);
        let before = self.cost.filter(|(measured, _)| *measured == serial);
        let mean = before.map_or(last, |(_, mean)| mean + LAST_WEIGHT * (last - mean));
        self.cost = Some((serial, mean));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIXELS: f64 = 640_000.0;

    /// The divisors of passes whose full pictures would take these times in milliseconds.
    fn divisors(full_times: &[f64]) -> Vec<u32> {
        let mut pacing = Pacing::default();
        let pass = |full: &f64| {
            let divisor = pacing.first_divisor(1, PIXELS);
            let pixels = PIXELS / f64::from(divisor * divisor);
            pacing.record(1, full * pixels / PIXELS, pixels);
            divisor
        };
        full_times.iter().map(pass).collect()
    }

    #[test]
    fn a_scene_at_the_limit_keeps_its_resolution() {
        // At 1/4 a pass takes 24 to 36 ms, around the budget of 30.
        let times: Vec<f64> = (0..20).map(|pass| [390.0, 570.0][pass % 2]).collect();
        let divisors = divisors(&times);
        let changes = divisors.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(changes <= 1, "{divisors:?}");
    }

    #[test]
    fn a_fast_scene_is_drawn_at_full_resolution_and_a_slow_one_is_not() {
        assert_eq!(divisors(&[8.0; 3]), [4, 1, 1]);
        assert_eq!(divisors(&[5000.0; 3]), [4, 8, 8]);
        let mut pacing = Pacing::default();
        pacing.record(1, 1.0, PIXELS);
        assert_eq!(pacing.first_divisor(2, PIXELS), FIRST_DIVISOR);
    }
}
