//! The decision about a cell: its verdict.

use crate::field::{Frame, Prism, Prober};
use crate::grid::{Cell, Corner, Edge, Face, Grid};
use crate::loops::{LoopStep, loops};
use crate::patch::{Filling, LoopVertex, Placer};
use crate::tree::Tree;
use crate::vector::{SurfacePoint, Vec3, add, between, scale, unit};

/// The verdict about a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It is proven that the surface does not meet the cell.
    Empty,
    /// The surface in the cell is represented well enough.
    Leaf,
    /// The cell is divided.
    Split,
}

/// The sizes between which cells are chosen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sizes {
    /// Larger cells are split if the surface in them is not proven to be one sheet.
    pub(crate) unproven: u32,
    /// Larger cells without a change of sign are split unless the surface is proven to be near a
    /// plane.
    pub(crate) uncrossed: u32,
}

/// The estimated distance of triangles from the surface is at most this fraction of the error.
const ESTIMATE: f64 = 0.5;

/// A cell has one sheet if the surface is within this fraction of its size from a plane.
const THICK: f64 = 0.3;

/// Decides whether a cell is empty, is small enough, or is split.
pub(crate) fn examine(placer: &mut Placer<'_, '_>, cell: Cell, sizes: Sizes) -> Verdict {
    let bounds = placer.grid.bounds(cell);
    if placer.prober.side_over(&Prism::aligned(bounds)).is_some() {
        return Verdict::Empty;
    }
    if cell.size == 1 {
        return Verdict::Leaf;
    }
    let signs: Vec<(Corner, bool)> =
        placer.grid.corners(cell).map(|at| (at, placer.is_inside(at))).collect();
    let sign = |at: Corner| signs.iter().any(|(corner, sign)| *corner == at && *sign);
    if signs.iter().all(|(_, sign)| *sign == signs[0].1) {
        let is_small = cell.size <= sizes.uncrossed;
        let is_leaf = is_small || is_sheet(placer.prober, bounds, 0.5 * placer.error);
        return if is_leaf { Verdict::Leaf } else { Verdict::Split };
    }
    let is_near = match placer.grid.is_flat {
        true => is_chord_near(placer, cell, sign),
        false => {
            loops(&Tree::default(), cell, sign).is_ok_and(|found| is_near(placer, cell, &found))
        }
    };
    if !is_near {
        return Verdict::Split;
    }
    let is_leaf = cell.size <= sizes.unproven && hides_nothing(placer, cell, sign)
        || is_sheet(placer.prober, bounds, placer.error.max(THICK * placer.grid.length(cell.size)));
    if is_leaf { Verdict::Leaf } else { Verdict::Split }
}

/// True if it is proven that the surface in a box is within a distance of a plane, with the inside
/// on one side of it.
fn is_sheet(prober: &mut Prober<'_>, bounds: [Vec3; 2], distance: f64) -> bool {
    let center = between(bounds[0], bounds[1], 0.5);
    let (value, gradient) = prober.sample(center);
    let slope = crate::vector::length(gradient);
    let Some(normal) = unit(gradient) else { return false };
    let frame = Frame::around(bounds, normal);
    let height = -value / slope;
    prober.is_between(&frame, 0.0, height - distance, height + distance)
}

/// True if the middles of edges and faces have the sign of their corners, where these agree.
fn hides_nothing(placer: &mut Placer<'_, '_>, cell: Cell, sign: impl Fn(Corner) -> bool) -> bool {
    let half = cell.size / 2;
    let is_flat = placer.grid.is_flat;
    let mut agrees = |corners: &[Corner], middle: Corner| {
        let first = sign(corners[0]);
        corners.iter().any(|corner| sign(*corner) != first) || placer.is_inside(middle) == first
    };
    let mut face_agrees = |face: Face| {
        let ends = face.sides().map(|(edge, _)| edge);
        let corners = [ends[0].ends(), ends[2].ends()].concat();
        let mut middle = face.at;
        face.plane().into_iter().for_each(|axis| middle[axis] += half);
        agrees(&corners, middle)
            && ends.into_iter().all(|edge| agrees(&edge.ends(), edge.halves()[1].at))
    };
    if is_flat {
        return face_agrees(cell.base());
    }
    (0..3).all(|axis| {
        [false, true].into_iter().all(|is_upper| face_agrees(cell.side(axis, is_upper)))
    })
}

/// True if the segments that the cell of a flat grid would have are near the surface, as far as
/// samples tell.
fn is_chord_near(placer: &mut Placer<'_, '_>, cell: Cell, sign: impl Fn(Corner) -> bool) -> bool {
    let Ok(chords) = Tree::new(true).chords(cell.base(), sign) else { return false };
    if chords.len() != 1 {
        return false;
    }
    chords.iter().all(|ends| {
        let [from, to] = ends.map(|edge| {
            placer.crossing(edge.ends().map(|end| placer.grid.position(end)), edge.size)
        });
        let within = placer.in_face(cell.base(), [from, to]);
        let points: Vec<Vec3> =
            [Some(from), within, Some(to)].into_iter().flatten().map(|it| it.position).collect();
        points.windows(2).all(|pair| {
            [0.25, 0.5, 0.75].into_iter().all(|t| {
                let point = between(pair[0], pair[1], t);
                placer.prober.distance(point) <= ESTIMATE * placer.error
            })
        })
    })
}

/// True if the triangles that the cell would have are near the surface, as far as samples tell.
pub(crate) fn is_near(placer: &mut Placer<'_, '_>, cell: Cell, loops: &[Vec<LoopStep>]) -> bool {
    let mut crossings: Vec<(Edge, SurfacePoint)> = Vec::new();
    let mut found = Vec::new();
    for steps in loops {
        for step in steps {
            let ends = step.edge.ends().map(|end| placer.grid.position(end));
            crossings.push((step.edge, placer.crossing(ends, step.edge.size)));
        }
        let at = |edge: Edge| crossings.iter().find(|(known, _)| *known == edge).map(|it| it.1);
        let mut vertices = Vec::new();
        for (index, step) in steps.iter().enumerate() {
            let next = steps[(index + 1) % steps.len()].edge;
            let (Some(from), Some(to)) = (at(step.edge), at(next)) else { return false };
            let vertex = |point, sides| LoopVertex { id: 0, point, sides };
            vertices.push(vertex(from, step.edge.sides_in(cell)));
            if let Some(point) = placer.in_face(step.face, [from, to]) {
                vertices.push(vertex(point, cell.sides(step.face.at) & 3 << (2 * step.face.axis)));
            }
        }
        found.push(vertices);
    }
    let fillings = placer.fillings(cell, &found);
    let limit = ESTIMATE * placer.error;
    found.iter().zip(fillings).all(|(vertices, filling)| {
        positions(vertices, filling).all(|[a, b, c]| {
            let third = scale(add(add(a, b), c), 1.0 / 3.0);
            let half = |a: Vec3, b: Vec3| scale(add(a, b), 0.5);
            [third, half(a, b), half(b, c), half(c, a)]
                .into_iter()
                .all(|point| placer.prober.distance(point) <= limit)
        })
    })
}

/// Returns the corners of the triangles that fill a loop.
fn positions(vertices: &[LoopVertex], filling: Filling) -> impl Iterator<Item = [Vec3; 3]> + '_ {
    let count = vertices.len();
    let at = move |index: usize| vertices[index % count].point.position;
    let (first, steps) = match filling {
        Filling::Fan(start) => (at(start), start + 1..start + count - 1),
        Filling::Cone(apex) => (apex, 0..count),
    };
    steps.map(move |step| [first, at(step), at(step + 1)])
}

impl Sizes {
    /// Returns the sizes for a grid.
    pub(crate) fn of(grid: &Grid) -> Self {
        Self { unproven: (grid.size / 16).max(4), uncrossed: 8 }
    }

    /// The sizes where a mesh was not proven: everything unproven is divided.
    pub(crate) const STRICT: Self = Self { unproven: 1, uncrossed: 1 };
}
