//! Proves how far mesh and surface are from each other, independent of how the mesh was made.

use rayon::prelude::*;
use rustc_hash::FxHashSet;

use crate::error::{MeshError, Phase};
use crate::field::{Frame, LocalField, Prism, Prober, ROUNDING};
use crate::grid::Grid;
use crate::nearness::{Clipped, clip, crosses_once, distance, is_in_box, line_in_box};
use crate::refine::{OnProgress, report};
use crate::surface::{Mesh, MeshCertificate};
use crate::vector::{Vec3, add, between, length, scale, sub, total, unit};
use crate::wedge::is_wedge;

/// Boxes that are divided between two reports of progress.
const CHUNK: usize = 1024;
/// A box with more triangles about it is divided without a try.
const MANY: usize = 48;
/// A box is not divided below this fraction of the error.
const FINEST: f64 = 0.125;
/// The fraction doubles whenever this many boxes more have stayed undecided. So the number of boxes
/// grows with the logarithm of the area where nothing can be decided, as where parts share a face.
const FLOOD: usize = 20_000;
/// It doubles at most this often.
const MAX_DOUBLINGS: usize = 8;
/// A box is decided by single points if its center is this near to its corners, in errors.
const SMALL: f64 = 0.7;
/// The field is 0 in a box of a flat grid if all values are at most this fraction of the error.
const ZERO: f64 = 2e-6;
/// Faces may touch in a box that is at most this large, in errors.
const TOUCHING: f64 = 4.0;
/// Faces touch in a box if the field crosses 0 by at most this part of its bounds there.
const TOUCHING_PART: f64 = 0.01;
/// Boxes of this size, in errors, are tried for being wrong. Larger ones are divided, because cells
/// of the mesh about wrong boxes are divided as well.
const WRONG: f64 = 2.0;
/// Part of the error that proofs use. The rest covers their rounding.
const USED: f64 = 1.0 - 1e-6;

/// Steps of a search for a side, as parts of its reach.
const SEARCH: [f64; 8] = [0.5, 0.4, 0.32, 0.26, 0.2, 0.16, 0.13, 0.1];

/// Points of a box through which lines are tried, from its middle to its corners.
const LINES: [Vec3; 5] = [
    [0.0103, 0.0071, 0.0029],
    [-0.313, 0.217, 0.109],
    [0.271, -0.419, 0.341],
    [-0.57, -0.61, -0.53],
    [0.63, 0.59, -0.71],
];

/// A box to be proven, and the triangles that may be within the error of it.
struct Part {
    bounds: [Vec3; 2],
    triangles: Vec<u32>,
    /// The changes that may be within the error of it, if there is an earlier proof.
    changes: Option<Vec<u32>>,
}

/// A box to be divided, and the field around it.
struct Task<'f> {
    part: Part,
    field: LocalField<'f>,
}

/// The result of examining a box.
enum Outcome<'f> {
    Kept,
    Empty,
    Sheet,
    Small,
    Touching,
    Undecided([Vec3; 2]),
    Divided(Task<'f>),
}

/// A mesh and the field that it is compared with.
pub(crate) struct Prover<'a, 'f> {
    pub(crate) field: &'a LocalField<'f>,
    pub(crate) mesh: &'a Mesh,
    pub(crate) grid: &'a Grid,
    pub(crate) error: f64,
    /// Boxes around all that differs from an earlier proof: changed triangles, undecided boxes.
    pub(crate) changes: Option<Vec<[Vec3; 2]>>,
}

/// Returns boxes around the triangles that only one of two meshes has.
pub(crate) fn changes(before: &Mesh, after: &Mesh) -> Vec<[Vec3; 2]> {
    let key = |corners: [Vec3; 3]| {
        let mut bits = corners.map(|corner| corner.map(f64::to_bits));
        bits.sort_unstable();
        bits
    };
    let keys = |mesh: &Mesh| -> FxHashSet<_> {
        mesh.triangles.iter().map(|triangle| key(mesh.corners(*triangle))).collect()
    };
    let mut found = Vec::new();
    for (mesh, others) in [(before, keys(after)), (after, keys(before))] {
        let corners = mesh.triangles.iter().map(|triangle| mesh.corners(*triangle));
        let changed = corners.filter(|corners| !others.contains(&key(*corners)));
        found.extend(changed.map(|[a, b, c]| {
            let lo = std::array::from_fn(|axis| a[axis].min(b[axis]).min(c[axis]));
            [lo, std::array::from_fn(|axis| a[axis].max(b[axis]).max(c[axis]))]
        }));
    }
    found
}

/// A certificate and all its undecided boxes.
pub(crate) struct Proof {
    pub(crate) certificate: MeshCertificate,
    pub(crate) undecided: Vec<[Vec3; 2]>,
}

impl<'f> Prover<'_, 'f> {
    /// Divides the whole grid until everything in it is proven or tiny. Boxes that are far from all
    /// changes keep their earlier proof.
    pub(crate) fn prove(
        &self,
        max_boxes: u64,
        progress: OnProgress<'_>,
    ) -> Result<Proof, MeshError> {
        let triangles = (0..self.mesh.triangles.len() as u32).collect();
        let count = |changes: &Vec<[Vec3; 2]>| (0..changes.len() as u32).collect();
        let changes = self.changes.as_ref().map(count);
        let bounds = self.grid.proof_bounds(self.error);
        let part = Part { bounds, triangles, changes };
        let mut waiting = vec![Task { part, field: self.field.clone() }];
        let mut certificate = MeshCertificate { error: self.error, ..MeshCertificate::default() };
        let mut undecided = Vec::new();
        let mut done = 0;
        while !waiting.is_empty() {
            let chunk = waiting.split_off(waiting.len().saturating_sub(CHUNK));
            done += chunk.len();
            let doublings = (undecided.len() / FLOOD).min(MAX_DOUBLINGS);
            let finest = FINEST * 2f64.powi(doublings as i32);
            let outcomes: Vec<Vec<Outcome<'f>>> =
                chunk.into_par_iter().map(|task| self.divide(task, finest)).collect();
            for outcome in outcomes.into_iter().flatten() {
                match outcome {
                    Outcome::Kept => {}
                    Outcome::Empty => certificate.empty_boxes += 1,
                    Outcome::Sheet => certificate.sheet_boxes += 1,
                    Outcome::Small => certificate.small_boxes += 1,
                    Outcome::Touching => certificate.touching_boxes += 1,
                    Outcome::Undecided(bounds) => undecided.push(bounds),
                    Outcome::Divided(task) => waiting.push(task),
                }
            }
            if (8 * done) as u64 > max_boxes {
                undecided.extend(waiting.drain(..).map(|task| task.part.bounds));
            }
            report(progress, Phase::Proving, done, done + waiting.len())?;
        }
        certificate.is_proven = undecided.is_empty();
        certificate.undecided = undecided.len() as u64;
        certificate.undecided_volume = total(undecided.iter().map(volume));
        certificate.undecided_boxes =
            undecided.iter().copied().take(MeshCertificate::MAX_BOXES).collect();
        Ok(Proof { certificate, undecided })
    }

    fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.mesh.triangles[triangle as usize].map(|id| self.mesh.vertices[id as usize])
    }

    /// Specialises the field to what proofs about a box evaluate, and examines its parts.
    fn divide(&self, Task { part, field }: Task<'f>, finest: f64) -> Vec<Outcome<'f>> {
        let Part { bounds, triangles, changes } = part;
        let side = bounds[1][0] - bounds[0][0];
        let field = field.around(bounds, self.error + 0.5 * side);
        let mut prober = field.prober();
        let is_crowded = triangles.len() > 8 * MANY;
        let examine = |bounds: [Vec3; 2]| {
            let is_near = |t: &u32| match is_crowded {
                true => overlaps(self.corners(*t), bounds, self.error),
                false => meets(self.corners(*t), bounds, self.error),
            };
            let is_changed = |index: &u32| {
                let changes = self.changes.as_deref().unwrap_or_default();
                let [lo, hi] = changes[*index as usize];
                overlaps([lo, hi, hi], bounds, self.error)
            };
            let changes = changes.as_ref();
            let changes = changes.map(|list| list.iter().copied().filter(is_changed).collect());
            let triangles = triangles.iter().copied().filter(is_near).collect();
            self.examine(&mut prober, &field, Part { bounds, triangles, changes }, finest)
        };
        parts(bounds, self.grid.is_flat).map(examine).collect()
    }

    fn examine(
        &self,
        prober: &mut Prober<'_>,
        field: &LocalField<'f>,
        part: Part,
        finest: f64,
    ) -> Outcome<'f> {
        let Part { bounds, triangles, changes } = &part;
        let bounds = *bounds;
        if changes.as_ref().is_some_and(Vec::is_empty) {
            return Outcome::Kept;
        }
        let prism = Prism::aligned(bounds);
        // A plane may lie in a face. Then the field is 0 all over, and nothing is known.
        let is_flat = self.grid.is_flat;
        let rounding = if is_flat { 0.0 } else { ROUNDING };
        let is_absent = prober.nearly_side_over(&prism, rounding).is_some();
        let is_free = !triangles.iter().any(|t| meets(self.corners(*t), bounds, 0.0));
        if is_absent && is_free {
            return Outcome::Empty;
        }
        let side = bounds[1][0] - bounds[0][0];
        let may_touch = !is_flat && is_free && side <= TOUCHING * self.error;
        if may_touch && field.nearly_side_over(&prism, TOUCHING_PART).is_some() {
            return Outcome::Touching;
        }
        let few = !triangles.is_empty() && triangles.len() <= MANY;
        if few && self.is_sheet(prober, bounds, triangles) == Some(true) {
            return Outcome::Sheet;
        }
        if few && !is_flat && self.is_wedge(prober, bounds, triangles) {
            return Outcome::Sheet;
        }
        if self.is_small(prober, bounds, triangles, [is_absent, is_free]) {
            return Outcome::Small;
        }
        // Where a plane lies in a face of the scene, no box is small enough.
        let is_zero =
            self.grid.is_flat && prober.is_within(&Prism::aligned(bounds), ZERO * self.error);
        let is_smallest = side <= finest * self.error;
        let may_be_wrong = side <= WRONG * self.error;
        if is_zero
            || is_smallest
            || may_be_wrong && self.is_wrong(prober, bounds, triangles, is_free)
        {
            return Outcome::Undecided(bounds);
        }
        Outcome::Divided(Task { part, field: field.clone() })
    }

    /// True if the mesh about the box is nearly flat, and the field has different signs at the
    /// error's distance above and below it.
    ///
    /// Let the mesh lie between two heights over a plane, in the box extended by the error to both
    /// sides. If the field is positive from the error above the lower height and negative from the
    /// error below the upper one, then each point of the mesh has both signs within the error, and
    /// each point of the surface has points on both sides of the mesh within the error. One line
    /// that crosses the mesh an odd number of times shows that these are different sides. The line
    /// starts in the box and ends at most the error beyond it, where all triangles are known.
    fn is_sheet(
        &self,
        prober: &mut Prober<'_>,
        bounds: [Vec3; 2],
        triangles: &[u32],
    ) -> Option<bool> {
        let error = USED * self.error;
        let middle = between(bounds[0], bounds[1], 0.5);
        let (value, gradient) = prober.sample(middle);
        let step = scale(gradient, -value / crate::vector::dot(gradient, gradient));
        let foot = if length(step) < length(sub(bounds[1], bounds[0])) { step } else { [0.0; 3] };
        let (_, gradient) = prober.sample(add(middle, foot));
        let frame = Frame::around(bounds, unit(gradient)?);
        let end = frame.half[0] + error;
        let limits = [end, frame.half[1], frame.half[2]];
        let mut clipped = Clipped::default();
        for triangle in triangles {
            let corners = self.corners(*triangle).map(|corner| frame.coordinates(corner));
            clip(corners, limits, &mut clipped);
        }
        let [lo, hi] = clipped.heights?;
        if hi - lo >= 2.0 * error || !prober.is_between(&frame, error, hi - error, lo + error) {
            return Some(false);
        }
        // Beyond an end, the field has one sign in the whole box.
        let is_crossed = LINES.iter().any(|part| {
            let half = sub(bounds[1], middle);
            let offset = std::array::from_fn(|axis| part[axis] * half[axis]);
            let [height, u, v] = frame.coordinates(add(middle, offset));
            line_in_box(offset, frame.normal, half).is_some_and(|[before, behind]| {
                let ends = [height + before - error, height + behind + error];
                ends[0] < lo && hi < ends[1] && crosses_once(&clipped.triangles, [u, v], ends)
            })
        });
        Some(hi >= end || lo <= -end || is_crossed)
    }

    /// True if the mesh about the box is nearly two planes with an edge, as the field is.
    fn is_wedge(&self, prober: &mut Prober<'_>, bounds: [Vec3; 2], triangles: &[u32]) -> bool {
        let triangles: Vec<_> = triangles.iter().map(|t| self.corners(*t)).collect();
        is_wedge(prober, bounds, &triangles, USED * self.error)
    }

    /// True if it is proven that a part of the mesh in the box is farther from the surface than the
    /// error, or that there is surface in the box and no triangle within the error. No division of
    /// such a box helps.
    fn is_wrong(
        &self,
        prober: &mut Prober<'_>,
        bounds: [Vec3; 2],
        triangles: &[u32],
        is_free: bool,
    ) -> bool {
        if !is_free {
            let [lo, hi] = bounds;
            let grown = [lo.map(|x| x - self.error), hi.map(|x| x + self.error)];
            return prober.side_over(&Prism::aligned(grown)).is_some();
        }
        if !triangles.is_empty() {
            return false;
        }
        let middle = between(bounds[0], bounds[1], 0.5);
        let (_, gradient) = prober.sample(middle);
        let Some(normal) = unit(gradient) else { return false };
        let reach = 0.5 * (bounds[1][0] - bounds[0][0]);
        let sides = [-reach, reach].map(|t| prober.proven_side(add(middle, scale(normal, t))));
        matches!(sides, [Some(below), Some(above)] if below != above)
    }

    /// True if the box is so small that one point of the mesh and both signs near its center serve
    /// for all its points.
    fn is_small(
        &self,
        prober: &mut Prober<'_>,
        bounds: [Vec3; 2],
        triangles: &[u32],
        [is_absent, is_free]: [bool; 2],
    ) -> bool {
        let middle = between(bounds[0], bounds[1], 0.5);
        let radius = length(sub(bounds[1], middle)) * (1.0 + 1e-12);
        if radius > SMALL * self.error {
            return false;
        }
        let rest = USED * self.error - radius;
        let is_near = |t: &u32| distance(middle, self.corners(*t)) <= rest;
        if !is_absent && !triangles.iter().any(is_near) {
            return false;
        }
        is_free || changes_sign(prober, middle, 0.999 * rest)
    }
}

/// True if the field is proven to have both signs within a distance.
fn changes_sign(prober: &mut Prober<'_>, middle: Vec3, reach: f64) -> bool {
    let (_, gradient) = prober.sample(middle);
    let axis = |axis: usize| {
        let mut direction = [0.0; 3];
        direction[axis] = 1.0;
        direction
    };
    let directions = [unit(gradient), Some(axis(0)), Some(axis(1)), Some(axis(2))];
    let mut found = [false; 2];
    for direction in directions.into_iter().flatten() {
        for part in [-1.0, 1.0, -0.5, 0.5] {
            let point = add(middle, scale(direction, part * reach));
            if let Some(side) = prober.proven_side(point) {
                found[usize::from(side)] = true;
            }
            if found == [true; 2] {
                return true;
            }
        }
    }
    [false, true]
        .into_iter()
        .all(|side| found[usize::from(side)] || reaches(prober, middle, reach, side))
}

/// True if a search along the gradient proves a side within a distance. At a sharp edge, the
/// gradients of its faces take turns, so the search goes between the faces.
fn reaches(prober: &mut Prober<'_>, middle: Vec3, reach: f64, side: bool) -> bool {
    let mut offset = [0.0; 3];
    for step in SEARCH {
        let (_, gradient) = prober.sample(add(middle, offset));
        let Some(outward) = unit(gradient) else { return false };
        let step = if side { -step } else { step };
        offset = add(offset, scale(outward, step * reach));
        let far = length(offset) / reach;
        if far > 1.0 {
            offset = scale(offset, 1.0 / far);
        }
        if prober.proven_side(add(middle, offset)) == Some(side) {
            return true;
        }
    }
    false
}

fn volume([lo, hi]: &[Vec3; 2]) -> f64 {
    (0..3).map(|axis| hi[axis] - lo[axis]).product()
}

/// True if the box around a triangle meets a box that is grown by a margin.
fn overlaps(corners: [Vec3; 3], [lo, hi]: [Vec3; 2], margin: f64) -> bool {
    (0..3).all(|axis| {
        let values = corners.map(|corner| corner[axis]);
        let least = values[0].min(values[1]).min(values[2]);
        let most = values[0].max(values[1]).max(values[2]);
        most >= lo[axis] - margin && least <= hi[axis] + margin
    })
}

/// True if a triangle meets a box that is grown by a margin.
fn meets(corners: [Vec3; 3], bounds: [Vec3; 2], margin: f64) -> bool {
    let middle = between(bounds[0], bounds[1], 0.5);
    let half = sub(bounds[1], middle).map(|half| (half + margin) * (1.0 + 1e-12));
    is_in_box(corners.map(|corner| sub(corner, middle)), half)
}

/// Returns the eighths of a box; of a flat one the quarters.
pub(crate) fn parts([lo, hi]: [Vec3; 2], is_flat: bool) -> impl Iterator<Item = [Vec3; 2]> {
    let mut middle = between(lo, hi, 0.5);
    let count = if is_flat { 4 } else { 8 };
    if is_flat {
        middle[2] = hi[2];
    }
    (0..count).map(move |i: usize| {
        let is_upper = |axis: usize| i >> axis & 1 == 1;
        let from = std::array::from_fn(|a| if is_upper(a) { middle[a] } else { lo[a] });
        let to = std::array::from_fn(|a| if is_upper(a) { hi[a] } else { middle[a] });
        [from, to]
    })
}
