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
}

impl MeshOptions {
    /// The default of `max_cells`: some gigabytes of memory.
    pub const MAX_CELLS: u64 = 50_000_000;

    /// Returns options for a box and an error, in scene units.
    pub fn new(bounds: [[f64; 3]; 2], error: f64) -> Self {
        Self { bounds, error, max_cells: Self::MAX_CELLS }
    }

    /// Sets the most cells that are examined.
    #[must_use]
    pub fn max_cells(self, max_cells: u64) -> Self {
        Self { max_cells, ..self }
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
    /// The bounds contain nothing.
    #[error("the scene is empty: the solids that it draws have no inside")]
    Empty,
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
    #[error("the error is {0}, but it must be a positive number")]
    Error(f64),
    /// The error is below what the numbers or the grid can resolve.
    #[error("the error {error} is too small for this scene; the smallest possible one is {least}")]
    TooFine {
        /// The error that was asked for.
        error: f64,
        /// The smallest possible error.
        least: f64,
    },
    /// The error is greater than the scene.
    #[error(
        "the error {error} is greater than the scene, whose longest side is {longest}: state at \
         most {longest}, such as {}", 1e-3 * longest
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
        "the plane at {at} meets no inside of the scene, whose bounds reach from {from} to {to} \
         along the plane's normal{}", if *touches { "; it touches a face: move it a little" } else { "" }
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

impl MeshError {
    /// True if an option is the cause.
    pub fn is_call(&self) -> bool {
        match self {
            Self::Error(_)
            | Self::TooFine { .. }
            | Self::TooCoarse { .. }
            | Self::TooManyCells { .. }
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
