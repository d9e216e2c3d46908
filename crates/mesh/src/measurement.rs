//! Measurements of a solid.

use std::ops::ControlFlow;

use sdfc_graph::Program;
use sdfc_graph::eval::{FrameValues, Interval, Number};
use serde::Serialize;

use crate::error::{MeshError, Progress};
use crate::extent::reach;
use crate::field::{Field, LocalField};
use crate::mesh::check_relative;
use crate::moments::{Integrals, Integrator, PAIRS};
use crate::vector::longest_side;

/// A number that is proven to lie between two others, both included.
pub type Proven = [f64; 2];

/// Measurements of a solid, in scene units. Each [`Proven`] interval holds the true value, in spite
/// of all rounding, if the bounds contain the solid.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Measurements {
    /// The volume.
    pub volume: Proven,
    /// The center of mass, for a density that is the same everywhere. Empty if it is not proven
    /// that there is an inside.
    pub center_of_mass: Option<[Proven; 3]>,
    /// The inertia about the center of mass, for the density 1: xx, yy, zz, xy, xz, yz. Products
    /// of different axes have the sign of the tensor: the integral of `-x * y`.
    pub inertia: Option<[Proven; 6]>,
    /// The lowest coordinate of the solid along each axis. Empty if it is not proven that there is
    /// an inside.
    pub lowest: Option<[Proven; 3]>,
    /// The highest coordinate of the solid along each axis.
    pub highest: Option<[Proven; 3]>,
    /// The area of the surface. This is an estimate, and nothing is proven about it: planes take
    /// the place of the surface in each box that it crosses.
    pub area_estimate: f64,
    /// Number of boxes that were examined.
    pub cells: u64,
    /// True if the limit of boxes was reached before the volume was known well enough. The
    /// intervals are true nevertheless.
    pub is_limited: bool,
}

/// Options of [`measure`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeasureOptions {
    /// Lowest and highest corner of a box that contains the solid, in scene units. If the solid
    /// reaches beyond it, it is open how much of the rest counts; if it fills the box and more, the
    /// box alone is measured.
    pub bounds: [[f64; 3]; 2],
    /// The volume is measured to this fraction of itself; the center of mass, the extent, the
    /// clearance and the thinnest wall to this fraction of the longest side of the bounds.
    pub relative: f64,
    /// The most boxes that are examined.
    pub max_cells: u64,
}

impl MeasureOptions {
    /// The default of `relative`: a thousandth.
    pub const RELATIVE: f64 = 1e-3;
    /// The default of `max_cells`: about a gigabyte of memory.
    pub const MAX_CELLS: u64 = 4_000_000;

    /// Returns options for a box, in scene units.
    pub fn new(bounds: [[f64; 3]; 2]) -> Self {
        Self { bounds, relative: Self::RELATIVE, max_cells: Self::MAX_CELLS }
    }

    /// Sets how exact the measurements are.
    #[must_use]
    pub fn relative(self, relative: f64) -> Self {
        Self { relative, ..self }
    }

    /// Sets the most boxes that are examined.
    #[must_use]
    pub fn max_cells(self, max_cells: u64) -> Self {
        Self { max_cells, ..self }
    }
}

/// Measures a program's solid.
///
/// A box is divided until it is proven to be inside or outside, or its share of the volume is known
/// well enough: the field differs from a linear function by a proven error, so the inside of a box
/// lies between two half-spaces. The work runs on all threads of the current rayon pool. It stops
/// if `progress` breaks.
///
/// # Errors
///
/// [`MeshError`].
pub fn measure(
    program: &Program,
    frame: &FrameValues,
    options: &MeasureOptions,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Measurements, MeshError> {
    let field = Field::new(program)?.ok_or(MeshError::NothingDrawn)?;
    let MeasureOptions { bounds, relative, max_cells } = *options;
    check_relative(bounds, relative)?;
    let local = LocalField::new(field.distance(), frame);
    let integrator = Integrator { field: &local, bounds, relative, max_cells };
    let integrals = integrator.integrate(progress)?;
    let longest = longest_side(bounds);
    let mut prober = local.prober();
    let mut ends = |is_up: bool| {
        let inner = integrals.inner?;
        let tolerance = relative * longest;
        Some([0, 1, 2].map(|axis| {
            let [reached, limit] = reach(&mut prober, bounds, inner, axis, is_up, tolerance);
            [reached.min(limit), reached.max(limit)]
        }))
    };
    let (lowest, highest) = (ends(false), ends(true));
    Ok(Measurements {
        volume: ends_of(integrals.moments.volume),
        center_of_mass: center(&integrals).map(|center| center.map(ends_of)),
        inertia: inertia(&integrals),
        lowest,
        highest,
        area_estimate: integrals.area,
        cells: integrals.cells,
        is_limited: integrals.is_limited,
    })
}

fn ends_of(interval: Interval) -> Proven {
    [interval.lo(), interval.hi()]
}

/// Returns the center of mass, if there is a volume.
fn center(integrals: &Integrals) -> Option<[Interval; 3]> {
    let Integrals { moments, about, .. } = integrals;
    let has_volume = moments.volume.lo() > 0.0;
    has_volume.then(|| {
        [0, 1, 2].map(|i| Interval::constant(about[i]).add(moments.first[i].div(moments.volume)))
    })
}

/// Returns the inertia about the center of mass, if there is a volume.
fn inertia(integrals: &Integrals) -> Option<[Proven; 6]> {
    let moments = &integrals.moments;
    if moments.volume.lo() <= 0.0 {
        return None;
    }
    // The center of mass relative to the point that the moments are relative to.
    let offset = moments.first.map(|first| first.div(moments.volume));
    let about_center: [Interval; 6] = std::array::from_fn(|index| {
        let [i, j] = PAIRS[index];
        let product = if i == j { offset[i].square() } else { offset[i].mul(offset[j]) };
        moments.second[index].sub(product.mul(moments.volume))
    });
    let [xx, yy, zz, xy, xz, yz] = about_center;
    let tensor = [yy.add(zz), xx.add(zz), xx.add(yy), xy.neg(), xz.neg(), yz.neg()];
    Some(tensor.map(ends_of))
}

#[cfg(test)]
mod tests {
    use sdfc_graph::{Dim, Graph};

    use super::*;

    fn ball(radius: f64) -> Program {
        let mut graph = Graph::new();
        let p = graph.point(0, Dim::Three);
        let (length, radius) = (graph.length(p), graph.number(radius));
        let ball = graph.sub(length, radius);
        Program { graph, distance: Some(ball), ..Program::default() }
    }

    fn measured(radius: f64, bounds: [[f64; 3]; 2]) -> Measurements {
        let (program, options) = (ball(radius), MeasureOptions::new(bounds));
        let frame = FrameValues::default();
        measure(&program, &frame, &options, &mut |_| ControlFlow::Continue(())).unwrap()
    }

    fn holds([lo, hi]: Proven, truth: f64) {
        assert!(lo <= truth && truth <= hi && hi - lo < 0.01, "{truth}: {lo} .. {hi}");
    }

    #[test]
    fn a_solid_that_fills_the_bounds_is_measured_within_them() {
        let found = measured(20.0, [[1.0, 2.0, 3.0], [2.0, 4.0, 6.0]]);
        holds(found.volume, 6.0);
        let (center, inertia) = (found.center_of_mass.unwrap(), found.inertia.unwrap());
        let (lowest, highest) = (found.lowest.unwrap(), found.highest.unwrap());
        for axis in 0..3 {
            holds(center[axis], [1.5, 3.0, 4.5][axis]);
            holds(lowest[axis], [1.0, 2.0, 3.0][axis]);
            holds(highest[axis], [2.0, 4.0, 6.0][axis]);
        }
        for (product, truth) in inertia.into_iter().zip([6.5, 5.0, 2.5, 0.0, 0.0, 0.0]) {
            holds(product, truth);
        }
        assert_eq!((found.area_estimate, found.is_limited), (0.0, false));
    }

    #[test]
    fn bounds_beside_a_solid_hold_no_volume() {
        let found = measured(0.5, [[1.0; 3], [2.0; 3]]);
        holds(found.volume, 0.0);
        assert_eq!((found.center_of_mass, found.lowest), (None, None));
    }
}
