//! Options, progress and errors.

use sdfc_graph::eval::TapeError;

/// Options of [`mesh`](crate::mesh()) and [`contour`](crate::contour()).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshOptions {
    /// Lowest and highest corner of a box around the surface, in scene units.
    pub bounds: [[f64; 3]; 2],
    /// The greatest distance between mesh and surface, or contour and section, in scene units.
    pub error: f64,
    /// The most cells that are examined.
    pub max_cells: u64,
    /// True if contours may have circular arcs; by default they are made of lines alone. Meshes
    /// ignore it.
    pub has_arcs: bool,
}

impl MeshOptions {
    /// The default of `max_cells`: some gigabytes of memory.
    pub const MAX_CELLS: u64 = 50_000_000;

    /// Returns options for a box and an error, in scene units.
    pub fn new(bounds: [[f64; 3]; 2], error: f64) -> Self {
        Self { bounds, error, max_cells: Self::MAX_CELLS, has_arcs: false }
    }

    /// Sets the most cells that are examined.
    #[must_use]
    pub fn max_cells(self, max_cells: u64) -> Self {
        Self { max_cells, ..self }
    }

    /// Sets whether contours may have circular arcs.
    #[must_use]
    pub fn has_arcs(self, has_arcs: bool) -> Self {
        Self { has_arcs, ..self }
    }
}

/// A step of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Cells are divided.
    Refining,
    /// Vertices are placed.
    Placing,
    /// The error is proven.
    Proving,
    /// Volumes are added up.
    Measuring,
}

/// How far the work is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The current step.
    pub phase: Phase,
    /// Units of work that are done in this step.
    pub done: u64,
    /// Units of work that are known so far in this step.
    pub total: u64,
}

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The scene draws nothing.
    #[error("the scene draws nothing: every solid that stands alone on a line is drawn")]
    NothingDrawn,
    /// Nothing is inside.
    #[error("the scene is empty: the solids that it draws have no inside")]
    Empty,
    /// No cell has an inside, but it is not proven that there is none.
    #[error(
        "no inside was found with the error {}: the scene may have parts that are smaller; state \
         a smaller error", shown(*error)
    )]
    NothingFound {
        /// The error that was asked for.
        error: f64,
    },
    /// The program is not flat.
    #[error("the program is not flat: {0}")]
    NotFlat(#[from] TapeError),
    /// The bounds are infinite.
    #[error(
        "the scene has no limit along {axis}; cut it with a box, as in `scene & box([10, 10, 10])`"
    )]
    Unbounded {
        /// The axis: `x`, `y` or `z`.
        axis: char,
    },
    /// The error is not a positive number.
    #[error("the error is {}, but it must be a positive number", shown(*_0))]
    Error(f64),
    /// The error is below what the numbers or the grid can resolve.
    #[error(
        "the error {} is too small for this scene; the smallest possible one is {}",
        shown(*error),
        shown_above(*least)
    )]
    TooFine {
        /// The error that was asked for.
        error: f64,
        /// The smallest possible error.
        least: f64,
    },
    /// The error is greater than the scene.
    #[error(
        "the error {} is greater than the scene, whose longest side is {}: state at most {1}, such \
         as {}",
        shown(*error),
        shown(*longest),
        shown(1e-3 * longest)
    )]
    TooCoarse {
        /// The error that was asked for.
        error: f64,
        /// The longest side of the scene's bounds.
        longest: f64,
    },
    /// The mesh needs more cells than the limit.
    #[error("the mesh needs more than {limit} cells (the limit `max_cells`); allow a larger error")]
    TooManyCells {
        /// The limit.
        limit: u64,
    },
    /// The mesh would have holes, because the field has no value at some points.
    #[error("the field has no value at some points of the surface, so no closed mesh was found")]
    Open,
    /// A grid has too few or too many samples.
    #[error(
        "a grid with {resolution} samples along its longest side is refused: it needs at least \
         {least} there, and at most {most} in total"
    )]
    Resolution {
        /// The number of samples along the longest side.
        resolution: usize,
        /// The least number along the longest side.
        least: usize,
        /// The greatest number in total.
        most: usize,
    },
    /// The machine has no memory for so many samples.
    #[error("out of memory for a grid of {0} samples; lower the resolution")]
    OutOfMemory(usize),
    /// The plane of a section meets no inside.
    #[error(
        "the plane at {} meets no inside of the scene, whose bounds reach from {} to {} along the \
         plane's normal{}",
        shown(*at),
        shown(*from),
        shown(*to),
        if *touches { "; it touches a face: move it a little" } else { "" }
    )]
    NoSection {
        /// Where the plane is along its normal.
        at: f64,
        /// The lowest coordinate of the scene's bounds along the normal.
        from: f64,
        /// The highest one.
        to: f64,
        /// True if it is not proven that the plane meets no surface.
        touches: bool,
    },
    /// The work was stopped by its progress function.
    #[error("the work was stopped")]
    Cancelled,
}

/// Returns a number with at most six significant digits: very large and very small ones with an
/// exponent.
pub(crate) fn shown(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-5..1e16).contains(&value.abs());
    // Parsing drops the zeros at the end.
    let short: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if is_plain || !value.is_finite() { short.to_string() } else { format!("{short:e}") }
}

/// As [`shown`], but no less than the number.
fn shown_above(value: f64) -> String {
    let short: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    shown(if short < value { value * (1.0 + 1e-5) } else { value })
}

impl MeshError {
    /// True if an option is the cause.
    pub fn is_call(&self) -> bool {
        match self {
            Self::Error(_)
            | Self::TooFine { .. }
            | Self::TooCoarse { .. }
            | Self::TooManyCells { .. }
            | Self::NothingFound { .. }
            | Self::Resolution { .. }
            | Self::NoSection { .. } => true,
            Self::NothingDrawn
            | Self::Empty
            | Self::NotFlat(_)
            | Self::Unbounded { .. }
            | Self::Open
            | Self::OutOfMemory(_)
            | Self::Cancelled => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_few_digits() {
        let values = [0.0, 2.0, 0.002, 1e15, 1e300, 5e-324, -1.25e-9];
        let expected = ["0", "2", "0.002", "1000000000000000", "1e300", "5e-324", "-1.25e-9"];
        for (value, expected) in values.into_iter().zip(expected) {
            assert_eq!(shown(value), expected);
        }
        assert_eq!(shown(8.000000000000001e-6), "8e-6");
        assert_eq!(shown(0.1 + 0.2), "0.3");
        for value in [8.123456789e-6, 8.000000000000001e-6, 0.001] {
            assert!(shown_above(value).parse::<f64>().is_ok_and(|shown| shown >= value));
        }
        let message = MeshError::TooCoarse { error: 1e300, longest: 2.0 }.to_string();
        assert!(message.len() < 120, "{message}");
    }
}
