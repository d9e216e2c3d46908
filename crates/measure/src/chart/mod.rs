//! Charts of cost against error: all ray methods at several settings, on one scene.

mod draw;
mod growth;
mod make;
mod pixels;
mod theme;
mod tune;

use std::collections::BTreeMap;

use serde::Serialize;

use crate::metrics::{Metrics, Quantiles};
use crate::truth::Counts;

pub use draw::{DrawError, Font, svg};
pub use growth::{Growth, growth_svg};
pub use make::{ChartOptions, chart};
pub use pixels::png;
pub use theme::Theme;

/// Smaller errors are drawn on the axis: neither f32 nor the eye distinguishes them.
pub const LEAST_ERROR: f64 = 1e-5;

/// The results of a chart, as `chart --json` writes them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Chart {
    /// Name of the scene.
    pub scene: String,
    /// Leaves of the scene.
    pub leaves: usize,
    /// True if the field is proven never to exceed the distance.
    pub certified: bool,
    /// Name of the GPU.
    pub adapter: String,
    /// Name and version of its driver.
    pub driver: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// A note about date and commit, if given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub made: Option<String>,
    /// The oracle's counts.
    pub oracle: Counts,
    /// One row per method and setting, grouped by method, from coarse to fine.
    pub methods: Vec<Row>,
}

/// One method at one setting.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Name of the ray method.
    pub method: String,
    /// The settings by name.
    pub settings: BTreeMap<&'static str, f64>,
    /// True for the default setting of the method.
    pub default: bool,
    /// True if the row is on the Pareto front, see [`Chart::mark_front`].
    pub pareto: bool,
    /// Field evaluations for primary rays.
    pub evals_per_pixel: Evals,
    /// Scalar and vector operations of these evaluations.
    pub ops_per_pixel: f64,
    /// Time of a frame.
    pub frame_ms: FrameMs,
    /// Rays that passed through a surface.
    pub missed: u64,
    /// Rays that ended where there is no surface.
    pub false_hits: u64,
    /// Error in depth in widths of a pixel.
    pub depth_px: Quantiles,
    /// Error of the normal in degrees, on smooth surfaces.
    pub normal_deg: Quantiles,
    /// Pixels hit in the picture or by the oracle but not in both, as a fraction of those hit in
    /// either.
    pub silhouette: f64,
    /// Rays out of steps.
    pub capped: u64,
    /// Rays whose end is NaN.
    pub nan: u64,
}

/// Field evaluations per pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Evals {
    /// Mean over all pixels.
    pub mean: f64,
    /// 99th percentile.
    pub p99: u32,
}

/// Time of a frame without compilation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrameMs {
    /// Median of the repetitions, in milliseconds.
    pub median: f64,
    /// `gpu` or `wall`.
    pub clock: &'static str,
}

impl Row {
    /// Makes a row from measurements.
    pub fn new(
        method: &str,
        settings: BTreeMap<&'static str, f64>,
        default: bool,
        metrics: &Metrics,
        ops_per_pixel: f64,
        frame_ms: FrameMs,
    ) -> Self {
        let evaluations = metrics.evaluations;
        Self {
            method: method.to_owned(),
            settings,
            default,
            pareto: false,
            evals_per_pixel: Evals { mean: evaluations.mean, p99: evaluations.p99 },
            ops_per_pixel,
            frame_ms,
            missed: metrics.missed,
            false_hits: metrics.false_hits,
            depth_px: metrics.depth.pixels,
            normal_deg: metrics.normal,
            silhouette: metrics.silhouette,
            capped: metrics.capped,
            nan: metrics.nan,
        }
    }

    /// Number of wrong pixels.
    pub fn wrong(&self) -> u64 {
        self.missed + self.false_hits + self.nan
    }

    /// Number of wrong pixels and capped rays.
    pub fn failed(&self) -> u64 {
        self.wrong() + self.capped
    }

    /// Returns true if the row is at least as good in every respect, and better in one.
    fn beats(&self, other: &Self) -> bool {
        let costs = |row: &Self| [row.ops_per_pixel, row.failed() as f64, row.depth_px.p99];
        is_less(costs(self), costs(other))
    }

    /// Returns true if the row takes fewer operations and has smaller errors: no more failed pixels
    /// and no greater depth error, and less of one of these.
    fn outdoes(&self, other: &Self) -> bool {
        let errors = |row: &Self| [row.failed() as f64, row.depth_px.p99.max(LEAST_ERROR)];
        self.ops_per_pixel < other.ops_per_pixel && is_less(errors(self), errors(other))
    }
}

/// Returns true if no number is greater than in `others`, and one is less.
fn is_less<const N: usize>(numbers: [f64; N], others: [f64; N]) -> bool {
    numbers.iter().zip(&others).all(|(a, b)| a <= b) && numbers != others
}

impl Chart {
    /// Returns the rows of other methods that are cheaper and more accurate than a method at its
    /// default.
    pub fn outdoing(&self, method: &str) -> Vec<&Row> {
        let own = self.methods.iter().find(|row| row.default && row.method == method);
        let others = self.methods.iter().filter(|row| row.method != method);
        own.map_or_else(Vec::new, |own| others.filter(|row| row.outdoes(own)).collect())
    }

    /// Marks the Pareto front: rows that no other row beats in operations, failed pixels and depth
    /// error (99th percentile).
    pub fn mark_front(&mut self) {
        let beaten = |row: &Row| self.methods.iter().any(|other| other.beats(row));
        let front: Vec<bool> = self.methods.iter().map(|row| !beaten(row)).collect();
        for (row, pareto) in self.methods.iter_mut().zip(front) {
            row.pareto = pareto;
        }
    }

    /// Returns the front as a chart draws it: marked rows without failed pixels, by cost.
    pub fn front(&self) -> Vec<&Row> {
        let mut front: Vec<&Row> =
            self.methods.iter().filter(|row| row.pareto && row.failed() == 0).collect();
        front.sort_by(|a, b| a.ops_per_pixel.total_cmp(&b.ops_per_pixel));
        front
    }
}

#[cfg(test)]
pub(crate) mod testing {
    use super::*;

    /// The library's font.
    pub(crate) const FONT: Font = Font(include_bytes!("../../../lang/fonts/Roboto-Regular.ttf"));

    pub(crate) fn row(method: &str, ops: f64, p99: f64) -> Row {
        let frame_ms = FrameMs { median: 1.0, clock: "wall" };
        let settings = BTreeMap::from([("tolerance", 0.05)]);
        let mut row = Row::new(method, settings, false, &Metrics::default(), ops, frame_ms);
        row.depth_px.p99 = p99;
        row
    }

    pub(crate) fn chart(methods: Vec<Row>) -> Chart {
        let (scene, adapter, driver) = Default::default();
        let (leaves, size, oracle) = Default::default();
        let certified = true;
        Chart { scene, leaves, certified, adapter, driver, size, made: None, oracle, methods }
    }
}

#[cfg(test)]
mod tests {
    use super::testing::{chart, row};

    #[test]
    fn the_front_contains_the_rows_that_no_row_beats() {
        let mut fast = row("m", 5.0, 0.01);
        fast.missed = 3;
        let rows = [row("m", 10.0, 1.0), row("m", 20.0, 0.1), row("m", 21.0, 0.1), fast];
        let mut chart = chart(rows.to_vec());
        chart.mark_front();
        let front: Vec<bool> = chart.methods.iter().map(|row| row.pareto).collect();
        assert_eq!(front, [true, true, false, true]);
    }

    #[test]
    fn a_method_is_outdone_by_cheaper_and_more_accurate_rows() {
        let mut own = row("own", 10.0, 0.1);
        own.default = true;
        let mut wrong = row("wrong", 5.0, 0.01);
        wrong.missed = 1;
        let others = [row("near", 20.0, 0.01), row("cheap", 5.0, 0.2), row("both", 5.0, 0.05)];
        let chart = chart(vec![own, wrong].into_iter().chain(others).collect());
        let outdoing: Vec<&str> =
            chart.outdoing("own").iter().map(|row| row.method.as_str()).collect();
        assert_eq!(outdoing, ["both"]);
    }
}
