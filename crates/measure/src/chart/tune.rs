//! The setting of a chart that does what is asked at the least cost.

use super::{Chart, Row};

impl Chart {
    /// The row with the fewest operations among those that keep an error in depth, 99 of 100 pixels, in widths of a
    /// pixel, with no pixel wrong and no ray out of steps. Of equal ones the first, so that the default method goes before.
    pub fn cheapest(&self, error: f64) -> Option<&Row> {
        let good = self.methods.iter().filter(|row| row.keeps(error));
        good.min_by(|a, b| a.ops_per_pixel.total_cmp(&b.ops_per_pixel))
    }
}

impl Row {
    /// Whether no pixel is wrong, no ray out of steps, and depths are as near as that.
    pub fn keeps(&self, error: f64) -> bool {
        self.wrong() == 0 && self.capped == 0 && self.depth_px.p99 <= error
    }

    /// What a scene says to be drawn like this: `march(method: "relaxed", tolerance: 0.05)`.
    pub fn setting(&self) -> String {
        let settings = self.settings.iter().map(|(name, value)| format!(", {name}: {value}"));
        format!("march(method: \"{}\"{})", self.method, settings.collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use crate::chart::testing::{chart, row};

    #[test]
    fn the_cheapest_row_misses_nothing_and_keeps_the_error() {
        let mut capped = row("capped", 2.0, 0.01);
        capped.capped = 1;
        let mut missing = row("missing", 1.0, 0.01);
        missing.missed = 1;
        let rows = vec![
            missing,
            capped,
            row("coarse", 3.0, 0.2),
            row("fine", 9.0, 0.001),
            row("good", 5.0, 0.02),
        ];
        let chart = chart(rows);
        let name = |error| chart.cheapest(error).map(|row| row.method.as_str());
        assert_eq!(name(0.5), Some("coarse"));
        assert_eq!(name(0.05), Some("good"));
        assert_eq!(name(0.01), Some("fine"));
        assert_eq!(name(1e-4), None);
    }

    #[test]
    fn a_row_says_what_to_write() {
        let text = row("relaxed", 1.0, 0.1).setting();
        assert_eq!(text, "march(method: \"relaxed\", tolerance: 0.05)");
    }
}
