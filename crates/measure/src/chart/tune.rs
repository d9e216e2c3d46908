//! Finds the cheapest setting of a chart within an error limit.

use super::{Chart, Row};

impl Chart {
    /// Returns the cheapest row whose depth error (99th percentile, in widths of a pixel) is at
    /// most `error`, without wrong pixels and capped rays. Of equal rows the first, which is that
    /// of the default method.
    pub fn cheapest(&self, error: f64) -> Option<&Row> {
        let good = self.methods.iter().filter(|row| row.keeps(error));
        good.min_by(|a, b| a.ops_per_pixel.total_cmp(&b.ops_per_pixel))
    }
}

impl Row {
    /// Returns true if there are no wrong pixels and no capped rays, and the depth error is at most
    /// `error`.
    pub fn keeps(&self, error: f64) -> bool {
        self.wrong() == 0 && self.capped == 0 && self.depth_px.p99 <= error
    }

    /// Returns the setting as a scene writes it: `march(method: "relaxed", tolerance: 0.05)`.
    pub fn setting(&self) -> String {
        let settings = self.settings.iter().map(|(name, value)| format!(", {name}: {value}"));
        format!("march(method: \"{}\"{})", self.method, settings.collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use crate::chart::testing::{chart, row};

    #[test]
    fn the_cheapest_row_has_no_failures_and_stays_within_the_error() {
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
    fn a_setting_is_written_as_in_a_scene() {
        let text = row("relaxed", 1.0, 0.1).setting();
        assert_eq!(text, "march(method: \"relaxed\", tolerance: 0.05)");
    }
}
