//! The thinnest wall of a solid.

use std::collections::BinaryHeap;
use std::ops::ControlFlow;

use rayon::prelude::*;
use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;
use serde::Serialize;

use crate::certify::parts;
use crate::error::{MeshError, Phase, Progress};
use crate::field::{Field, LocalField};
use crate::measurement::{MeasureOptions, Proven};
use crate::mesh::check_relative;
use crate::refine::report;
use crate::surroundings::{Found, Surroundings};
use crate::vector::{Vec3, between, longest_side};
use crate::witness::{Finder, Witness};

/// The thinnest wall of a solid.
///
/// The wall at a point of the surface is the segment from there along the inward normal to where
/// the solid ends. It is a wall only if the normals at both ends enclose an angle of at least
/// 140 degrees, so that the faces at an edge are no wall, unless it is sharper than 40 degrees.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Wall {
    /// The least thickness of a wall, in scene units. The lower end holds for walls that begin
    /// outside of the undecided boxes. Empty if no wall was found.
    pub thickness: Option<Proven>,
    /// Both ends of a wall whose thickness is the upper end of `thickness`.
    pub at: Option<[[f64; 3]; 2]>,
    /// True if it is proven that no wall begins outside of the undecided boxes.
    pub is_absent: bool,
    /// Number of the smallest boxes in which thinner walls may begin.
    pub undecided: u64,
    /// Lowest and highest corner of undecided boxes; at most [`Wall::MAX_BOXES`].
    pub undecided_boxes: Vec<[[f64; 3]; 2]>,
    /// Number of boxes that were examined.
    pub cells: u64,
    /// True if the limit of boxes was reached before the thickness was known well enough. The
    /// interval is true nevertheless.
    pub is_limited: bool,
}

impl Wall {
    /// The most undecided boxes that are listed.
    pub const MAX_BOXES: usize = 10;
}

/// Boxes that are divided at once.
const CHUNK: usize = 256;
/// Points along each axis from which walls are looked for at first.
const STARTS: usize = 9;
/// Boxes are not divided below this part of the tolerance.
const FINEST: f64 = 0.125;

/// Bounds the thickness of the thinnest wall.
///
/// Boxes are divided until it is proven that no wall that begins in them is thinner than the
/// thinnest one that was found, less a tolerance. The tolerance is a fraction of the longest side
/// of the bounds. The work runs on all threads of the current rayon pool. It stops if `progress`
/// breaks.
///
/// # Errors
///
/// [`MeshError`].
pub fn thinnest_wall(
    program: &Program,
    frame: &FrameValues,
    options: &MeasureOptions,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Wall, MeshError> {
    let field = Field::new(program)?.ok_or(MeshError::NothingDrawn)?;
    let MeasureOptions { bounds, relative, max_cells } = *options;
    check_relative(bounds, relative)?;
    let local = LocalField::new(field.distance(), frame);
    let [lo, hi] = bounds;
    let longest = longest_side(bounds);
    let about = between(lo, hi, 0.5);
    // A cube a little larger than the bounds, so that round numbers of the scene are not on the
    // sides of boxes.
    let cube = [about.map(|x| x - 0.5087 * longest), about.map(|x| x + 0.5113 * longest)];
    let mut search = Search {
        field: local.clone(),
        longest,
        tolerance: relative * longest,
        best: None,
        open: BinaryHeap::from([Open { least: 0.0, bounds: cube, field: local }]),
        undecided: Vec::new(),
        cells: 0,
    };
    search.start(bounds);
    let is_limited = search.run(max_cells, progress)?;
    Ok(search.result(is_limited))
}

/// A box in which walls may begin, a lower bound of their thickness, and the field around it.
struct Open<'f> {
    least: f64,
    bounds: [Vec3; 2],
    field: LocalField<'f>,
}

impl PartialEq for Open<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open<'_> {}

impl PartialOrd for Open<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open<'_> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        other.least.total_cmp(&self.least)
    }
}

/// What came of dividing a box.
struct Division<'f> {
    open: Vec<Open<'f>>,
    wall: Option<Witness>,
    cells: u64,
}

/// The state of the search.
struct Search<'f> {
    /// The field everywhere.
    field: LocalField<'f>,
    longest: f64,
    tolerance: f64,
    best: Option<Witness>,
    open: BinaryHeap<Open<'f>>,
    undecided: Vec<[Vec3; 2]>,
    cells: u64,
}

impl<'f> Search<'f> {
    fn upper(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |wall| wall.thickness)
    }

    /// Returns the thickness that is to be proven. No wall is longer than the diagonal of a cube.
    fn target(&self) -> f64 {
        (self.upper() - self.tolerance).min(2.0 * self.longest)
    }

    /// Looks for walls from points of a grid.
    fn start(&mut self, [lo, hi]: [Vec3; 2]) {
        let field = self.field.clone();
        let mut prober = field.prober();
        let mut finder = Finder { prober: &mut prober, longest: self.longest };
        let reach = self.longest / STARTS as f64;
        for index in 0..STARTS.pow(3) {
            let steps = [index % STARTS, index / STARTS % STARTS, index / STARTS.pow(2)];
            let point = std::array::from_fn(|axis| {
                // Off the planes of symmetry.
                let part = (steps[axis] as f64 + 0.47) / STARTS as f64;
                lo[axis] + part * (hi[axis] - lo[axis])
            });
            let limit = self.best.map_or(2.0 * self.longest, |wall| wall.thickness);
            if let Some(found) = finder.wall(point, reach, limit) {
                self.best = Some(finder.improve(found, 0.5 * reach));
            }
        }
    }

    /// Divides boxes until enough is proven. Returns true if the limit of boxes was reached.
    fn run(
        &mut self,
        max_cells: u64,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<bool, MeshError> {
        loop {
            let chunk = self.worst();
            if chunk.is_empty() {
                return Ok(false);
            }
            if self.cells > max_cells {
                self.open.extend(chunk);
                return Ok(true);
            }
            let divided: Vec<Division<'f>> =
                chunk.into_par_iter().map(|open| self.divide(open)).collect();
            for Division { open, wall, cells } in divided {
                self.cells += cells;
                self.open.extend(open);
                if let Some(wall) = wall.filter(|wall| wall.thickness < self.upper()) {
                    self.best = Some(wall);
                }
            }
            report(progress, Phase::Measuring, self.cells as usize, max_cells as usize)?;
        }
    }

    /// Takes the boxes about which least is known. Boxes that are too small are undecided.
    fn worst(&mut self) -> Vec<Open<'f>> {
        let target = self.target();
        let mut found = Vec::new();
        while found.len() < CHUNK && self.open.peek().is_some_and(|open| open.least < target) {
            let Some(open) = self.open.pop() else { break };
            if open.bounds[1][0] - open.bounds[0][0] < FINEST * self.tolerance {
                self.undecided.push(open.bounds);
            } else {
                found.push(open);
            }
        }
        found
    }

    fn divide(&self, open: Open<'f>) -> Division<'f> {
        let Open { least, bounds, field } = open;
        let target = self.target();
        let side = bounds[1][0] - bounds[0][0];
        let field = match self.best {
            // Farther than any piece of a fan.
            Some(_) => field.around(bounds, 1.2 * side + 2.0 * target),
            None => field,
        };
        let mut surroundings = Surroundings::new(&field, self.tolerance);
        let mut division = Division { open: Vec::new(), wall: None, cells: 0 };
        for bounds in parts(bounds, false) {
            let found = surroundings.examine(bounds, target);
            let Found::Thickness(found) = found else { continue };
            if found >= target {
                continue;
            }
            let open = Open { least: found.max(least), bounds, field: field.clone() };
            division.open.push(open);
        }
        if let Some(open) = division.open.first() {
            // The field around the box is not true where the search may lead.
            let mut prober = self.field.prober();
            let mut finder = Finder { prober: &mut prober, longest: self.longest };
            let middle = between(open.bounds[0], open.bounds[1], 0.5);
            let limit = self.upper().min(2.0 * self.longest);
            let wall = finder.wall(middle, side, limit);
            division.wall = wall.map(|wall| finder.improve(wall, 0.25 * side));
        }
        division.cells = surroundings.cells;
        division
    }

    fn result(self, is_limited: bool) -> Wall {
        let target = self.target();
        let least = self.open.peek().map_or(target, |open| open.least.min(target)).max(0.0);
        let mut undecided_boxes = self.undecided;
        let undecided = undecided_boxes.len() as u64;
        undecided_boxes.truncate(Wall::MAX_BOXES);
        Wall {
            thickness: self.best.map(|wall| [least, wall.thickness]),
            at: self.best.map(|wall| wall.ends),
            is_absent: self.best.is_none() && !is_limited,
            undecided,
            undecided_boxes,
            cells: self.cells,
            is_limited,
        }
    }
}
