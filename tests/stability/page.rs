//! The page `docs/stability.md`: the errors of each ray method in each case.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

use libtest_mimic::Failed;
use sdfc::FrameValues;
use sdfc_measure::chart::LEAST_ERROR;
use sdfc_measure::{Metrics, Truth};
use sdfc_render::{AdapterInfo, Gpu, View};
use sdfc_tests::repository;

use crate::case::Case;

const HEAD: &str = "\
# Where ray methods fail, and what `auto` does there

<!-- Written by `STABILITY_UPDATE=1 cargo test -p sdfc-tests --test stability`. To change it, change
     the comments of the scenes, or the test. -->

Every ray method has scenes on which it fails: it passes through a wall, or stops in front of it.
This page shows scenes that are made to break one method each, and what all methods do there. Look
here if a picture has holes or noise. [accuracy.md](accuracy.md#the-methods) explains the methods;
if you do not choose one, it is `auto`.

Each row is a scene of [tests/stability](../tests/stability) or
[examples/faults](../examples/faults). The comment in the scene says what fails and why. Every ray
method draws the scene at 160x120 with its default settings, at each frame that the scene's comment
names. Each picture is compared with the [oracle](accuracy.md#the-oracle), which proves where each
ray hits.

The values of M, F, C and N are percentages of all pixels, to two significant digits. Zeros are
omitted.

- **M**, missed: the ray passed through a surface.
- **F**, false: the ray ended where there is no surface.
- **C**, capped: the ray ran out of steps.
- **N**: the result is not a number.
- **D**: the depth error that 99 of 100 pixels do not exceed, in pixel widths. Values up to 0.05
  are omitted.
- *good*: none of these.

For several frames, the percentages cover all frames, and D is that of the worst frame.

";

const EXEMPTIONS: &str = "\
On all other scenes, the field is certified, and the test requires that `auto` is *good*. These
scenes are exceptions: their field is uncertified, or their details are finer than a pixel or than
32-bit numbers. `Bounds` lists the largest errors of `auto` that the test permits.

";

/// The errors of a method in a case: percentages of pixels, and errors in depth and normals.
#[derive(Clone, Debug, Default)]
pub struct Errors {
    pub missed: f64,
    pub false_hits: f64,
    pub capped: f64,
    pub nan: f64,
    pub undecided: f64,
    pub depth: f64,
    pub normal: f64,
    /// The evaluations per pixel, summed over all frames.
    pub evaluations: f64,
}

impl Errors {
    /// Combines the metrics of all frames.
    pub fn of(views: &[(View, FrameValues, Truth)], metrics: &[Metrics]) -> Self {
        let pixels: usize = views.iter().map(|(.., truth)| truth.verdicts.len()).sum();
        let percent = |count: u64| 100.0 * count as f64 / pixels.max(1) as f64;
        let sum = |of: fn(&Metrics) -> u64| percent(metrics.iter().map(of).sum());
        let worst = |of: fn(&Metrics) -> f64| metrics.iter().map(of).fold(0.0, f64::max);
        Self {
            missed: sum(|metrics| metrics.missed),
            false_hits: sum(|metrics| metrics.false_hits),
            capped: sum(|metrics| metrics.capped),
            nan: sum(|metrics| metrics.nan),
            undecided: percent(views.iter().map(|(.., truth)| truth.counts().undecided).sum()),
            depth: worst(|metrics| metrics.depth.pixels.p99),
            normal: worst(|metrics| metrics.normal.p99),
            evaluations: metrics.iter().map(|metrics| metrics.evaluations.mean).sum(),
        }
    }

    /// Returns true if it takes fewer evaluations and is more accurate: no more wrong pixels, no
    /// larger depth error, and better in one of them.
    pub fn outperforms(&self, other: &Self) -> bool {
        let summary = |errors: &Self| {
            let Self { missed, false_hits, capped, nan, depth, .. } = *errors;
            [missed + false_hits + capped + nan, depth.max(LEAST_ERROR)]
        };
        let (mine, others) = (summary(self), summary(other));
        let no_worse = mine.iter().zip(&others).all(|(a, b)| a <= b);
        self.evaluations < other.evaluations && no_worse && mine != others
    }

    fn cell(&self) -> String {
        let percentages =
            [("M", self.missed), ("F", self.false_hits), ("C", self.capped), ("N", self.nan)];
        let nonzero = percentages.iter().filter(|(_, value)| *value > 0.0);
        let mut parts: Vec<String> =
            nonzero.map(|(letter, value)| format!("{letter} {}", rounded(*value))).collect();
        if self.depth > 0.05 {
            parts.push(format!("D {}", rounded(self.depth)));
        }
        if parts.is_empty() { "*good*".to_owned() } else { parts.join(", ") }
    }
}

/// Formats a number with two significant digits.
fn rounded(value: f64) -> String {
    if !value.is_finite() || value == 0.0 {
        return value.to_string();
    }
    if value.abs() >= 1e5 {
        return format!("{value:.1e}");
    }
    let digits = 1 - value.abs().log10().floor() as i32;
    let scale = 10f64.powi(digits);
    let decimals = usize::try_from(digits).unwrap_or(0);
    format!("{:.decimals$}", (value * scale).round() / scale)
}

/// The current page.
#[derive(Debug)]
pub struct Page {
    text: String,
}

impl Page {
    fn path() -> PathBuf {
        repository().join("docs/stability.md")
    }

    pub fn read() -> Result<Self, Failed> {
        Ok(Self { text: std::fs::read_to_string(Self::path())? })
    }

    /// Fails if the page lacks this row. With another driver, fails if it lacks the case.
    pub fn check(&self, case: &Case, row: &[Errors], adapter: &AdapterInfo) -> Result<(), Failed> {
        let stale = |why: String| Err(format!("docs/stability.md is not up to date: {why}").into());
        let line = line(case, row);
        if self.text.contains(&driver(adapter)) && !self.text.contains(&line) {
            return stale(format!("it has no line\n{line}"));
        }
        if !self.text.contains(&start(case)) {
            return stale(format!("it lacks {}", case.name));
        }
        match &case.exempt {
            Some(why) if !self.text.contains(&exempt(case, why)) => {
                stale(format!("it does not explain why {} is exempt", case.name))
            }
            Some(_) | None => Ok(()),
        }
    }

    /// Writes the page. Cases that were not measured keep their rows.
    pub fn write(cases: &[Case], measured: &BTreeMap<String, Vec<Errors>>) -> Result<(), Failed> {
        let before = std::fs::read_to_string(Self::path()).unwrap_or_default();
        let mut text = HEAD.to_owned();
        let _ = writeln!(text, "{}\n", driver(Gpu::new()?.info()));
        let names: Vec<&str> = sdfc_march::METHODS.iter().map(|method| method.name).collect();
        let _ = writeln!(text, "| scene | | `{}` |", names.join("` | `"));
        let _ = writeln!(text, "|---|---|{}", "---|".repeat(names.len()));
        for case in cases {
            let old = || before.lines().find(|line| line.starts_with(&start(case)));
            let row = measured.get(&case.name).map(|row| line(case, row));
            if let Some(row) = row.or_else(|| old().map(ToOwned::to_owned)) {
                let _ = writeln!(text, "{row}");
            }
        }
        text += "\n## Scenes with bounds of their own\n\n";
        text += EXEMPTIONS;
        for case in cases {
            if let Some(why) = &case.exempt {
                let _ = writeln!(text, "{}", exempt(case, why));
            }
        }
        Ok(std::fs::write(Self::path(), text)?)
    }
}

fn driver(adapter: &AdapterInfo) -> String {
    format!("Measured on {}, {}.", adapter.name, adapter.driver)
}

fn start(case: &Case) -> String {
    format!("| [{}](../{}) | {} |", case.name, case.path, case.title)
}

fn line(case: &Case, row: &[Errors]) -> String {
    let cells: Vec<String> = row.iter().map(Errors::cell).collect();
    format!("{} {} |", start(case), cells.join(" | "))
}

fn exempt(case: &Case, why: &str) -> String {
    let bounds = case.text.lines().find_map(|line| line.strip_prefix("// Auto: "));
    format!("- `{}`: {why}.\n  Bounds: {}", case.name, bounds.unwrap_or_default())
}
