//! A grid of samples of the field, with the error of interpolation.

use std::ops::ControlFlow;

use rayon::prelude::*;
use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;
use serde::Serialize;

use crate::error::{MeshError, Phase, Progress};
use crate::field::{Field, LocalField, Prism, Prober};
use crate::mesh::check_bounds;
use crate::refine::report;
use crate::vector::longest_side;

/// Samples of a scene's field at the points of a regular grid.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DistanceGrid {
    /// Number of samples along x, y and z.
    pub shape: [usize; 3],
    /// Position of the first sample, in scene units.
    pub origin: [f64; 3],
    /// Distance between samples, the same along all axes.
    pub spacing: f64,
    /// How far trilinear interpolation of the samples is at most from the field, anywhere in the
    /// grid. Infinite if nothing is proven.
    pub interpolation_error: f64,
    /// The same for the cells of the grid that the surface may cross.
    pub surface_error: f64,
    /// The values in scene units, negative inside. x changes fastest, and then y.
    #[serde(skip)]
    pub values: Vec<f32>,
}

/// Options of [`bake`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BakeOptions {
    /// Lowest and highest corner of a box around the solid, in scene units. The grid reaches one
    /// cell farther.
    pub bounds: [[f64; 3]; 2],
    /// Number of samples along the longest side.
    pub resolution: usize,
    /// A proven Lipschitz constant of the field, if there is one.
    pub lipschitz: Option<f64>,
}

impl BakeOptions {
    /// The default of `resolution`.
    pub const RESOLUTION: usize = 64;
    /// The most samples of a grid: a gigabyte.
    pub const MAX_SAMPLES: usize = 1 << 28;

    /// Returns options for a box, in scene units.
    pub fn new(bounds: [[f64; 3]; 2]) -> Self {
        Self { bounds, resolution: Self::RESOLUTION, lipschitz: None }
    }

    /// Sets the number of samples along the longest side.
    #[must_use]
    pub fn resolution(self, resolution: usize) -> Self {
        Self { resolution, ..self }
    }

    /// Sets a proven Lipschitz constant of the field.
    #[must_use]
    pub fn lipschitz(self, lipschitz: Option<f64>) -> Self {
        Self { lipschitz, ..self }
    }
}

/// The greatest number of spacings between a point of a cell and the corners, weighted as trilinear
/// interpolation weights them: `sqrt(3) / 2`, rounded up.
const FARTHEST: f64 = 0.866_026;
/// Relative rounding error of a 32-bit float.
const SINGLE: f64 = 6.0e-8;

/// Samples a program's field, and bounds the error of interpolation.
///
/// Interpolation of a linear function is exact. Affine arithmetic bounds how far the field is from
/// one in each cell; twice that bounds the error. A Lipschitz constant bounds it too, by the
/// distances from the corners, and the smaller bound counts. Both include the rounding of the
/// values to 32 bits. The work runs on all threads of the current rayon pool. It stops if
/// `progress` breaks.
///
/// # Errors
///
/// [`MeshError`]; [`MeshError::Resolution`] for a grid without cells or with too many samples.
pub fn bake(
    program: &Program,
    frame: &FrameValues,
    options: &BakeOptions,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<DistanceGrid, MeshError> {
    let field = Field::new(program)?.ok_or(MeshError::NothingDrawn)?;
    let mut grid = layout(options)?;
    let local = LocalField::new(field.distance(), frame);
    let prober = local.prober();
    let [width, height, depth] = grid.shape;
    let count = width * height * depth;
    grid.values.try_reserve_exact(count).map_err(|_| MeshError::OutOfMemory(count))?;
    grid.values.resize(count, 0.0);
    for (z, layer) in grid.values.chunks_exact_mut(width * height).enumerate() {
        let position = |x: usize, y: usize| position(grid.origin, grid.spacing, [x, y, z]);
        layer.par_chunks_exact_mut(width).enumerate().for_each_init(
            || prober.clone(),
            |prober, (y, row)| {
                for (x, value) in row.iter_mut().enumerate() {
                    *value = prober.value(position(x, y)) as f32;
                }
            },
        );
        report(progress, Phase::Placing, z + 1, depth)?;
    }
    for z in 0..depth - 1 {
        let rows = (0..height - 1).into_par_iter().map_init(
            || prober.clone(),
            |prober, y| {
                let errors = (0..width - 1).map(|x| grid.error(prober, [x, y, z], options));
                errors.fold([0.0; 2], worst)
            },
        );
        let [all, surface] = rows.reduce(|| [0.0; 2], worst);
        grid.interpolation_error = grid.interpolation_error.max(all);
        grid.surface_error = grid.surface_error.max(surface);
        report(progress, Phase::Proving, z + 1, depth - 1)?;
    }
    Ok(grid)
}

fn worst(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].max(b[1])]
}

fn position(origin: [f64; 3], spacing: f64, at: [usize; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| origin[axis] + at[axis] as f64 * spacing)
}

/// Returns the grid without values.
fn layout(options: &BakeOptions) -> Result<DistanceGrid, MeshError> {
    let BakeOptions { bounds: [lo, hi], resolution, .. } = *options;
    check_bounds([lo, hi])?;
    let refused = |resolution| {
        Err(MeshError::Resolution { resolution, least: 4, most: BakeOptions::MAX_SAMPLES })
    };
    if resolution < 4 {
        return refused(resolution);
    }
    let longest = longest_side([lo, hi]);
    // One cell more on each side.
    let spacing = longest / (resolution - 3) as f64;
    let sides = [0, 1, 2].map(|axis| ((hi[axis] - lo[axis]) / spacing - 1e-9).ceil() + 3.0);
    // In floats, because the product of whole numbers may not fit. NaN for a box without sides.
    let samples: f64 = sides.iter().product();
    if samples.is_nan() || samples > BakeOptions::MAX_SAMPLES as f64 {
        return refused(resolution);
    }
    let shape = sides.map(|side| side as usize);
    let origin = [0, 1, 2]
        .map(|axis| 0.5 * (lo[axis] + hi[axis]) - 0.5 * spacing * (shape[axis] - 1) as f64);
    Ok(DistanceGrid { shape, origin, spacing, ..DistanceGrid::default() })
}

impl DistanceGrid {
    /// Returns the error of interpolation in a cell, and again if the surface may cross it.
    fn error(&self, prober: &mut Prober<'_>, at: [usize; 3], options: &BakeOptions) -> [f64; 2] {
        let next = at.map(|index| index + 1);
        let prism = Prism::aligned([at, next].map(|at| position(self.origin, self.spacing, at)));
        let form = prober.affine_over(&prism);
        let (_, _, error) = form.terms();
        let steady = options.lipschitz.map(|constant| constant * FARTHEST * self.spacing);
        let range = form.range();
        let rounding = SINGLE * range.lo().abs().max(range.hi().abs());
        let error = (2.0 * error).min(steady.unwrap_or(f64::INFINITY)) + rounding;
        let error = if error.is_nan() { f64::INFINITY } else { error };
        [error, if range.contains(0.0) { error } else { 0.0 }]
    }
}
