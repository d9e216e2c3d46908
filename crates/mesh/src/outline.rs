//! The closed paths of a contour, from the cells of a flat grid.

use rustc_hash::FxHashMap;

use crate::build::Builder;
use crate::curve::Curve;
use crate::error::{MeshError, Phase};
use crate::grid::{Corner, Edge, Grid};
use crate::make::Surface;
use crate::patch::Placer;
use crate::polygon::{self, Point};
use crate::refine::{OnProgress, report};
use crate::simplify::{DIVIDED, simplified};
use crate::surface::Mesh;
use crate::vector::SurfacePoint;

/// Closed paths that do not cross, and walls on them.
pub(crate) struct Outline {
    pub(crate) paths: Vec<Curve>,
    /// Triangles that stand on the paths. The error of a contour is proven as theirs, for a field
    /// that is the same at all heights.
    walls: Mesh,
}

impl Surface for Outline {
    fn build(builder: &Builder<'_, '_>, progress: OnProgress<'_>) -> Result<Self, MeshError> {
        report(progress, Phase::Placing, 0, 2)?;
        let paths = linked(&builder.chords()).ok_or(MeshError::Open)?;
        report(progress, Phase::Placing, 1, 2)?;
        let paths = simplified(paths, builder.error, builder.has_arcs);
        report(progress, Phase::Placing, 2, 2)?;
        let walls = walls(&paths, builder.error);
        Ok(Self { paths, walls })
    }

    fn triangles(&self) -> &Mesh {
        &self.walls
    }

    fn margin(&self) -> f64 {
        let has_arcs = self.paths.iter().any(Curve::has_arcs);
        if has_arcs { DIVIDED } else { 0.0 }
    }
}

/// A part of a path within a cell.
struct Chord {
    ends: [Edge; 2],
    /// The crossing of the first edge, and the vertex within the cell if there is one.
    points: [Option<Point>; 2],
}

impl Builder<'_, '_> {
    /// Returns the chords of all leaves of a quadtree, with the inside on the left.
    fn chords(&self) -> Vec<Chord> {
        let sign = |at: Corner| self.signs.get(&at).copied().unwrap_or(false);
        let mut cells = self.tree.leaves.clone();
        cells.sort_unstable();
        let found = self.placed(&cells, |placer, cell| {
            let chords = self.tree.chords(cell.base(), sign).unwrap_or_default();
            let is_alone = chords.len() == 1;
            let chord = |ends: [Edge; 2]| {
                let [from, to] = ends.map(|edge| crossing(placer, self.grid, edge));
                // The vertices of two chords in one cell could make them cross.
                let within = is_alone.then(|| placer.in_face(cell.base(), [from, to])).flatten();
                Chord { ends, points: [Some(from), within].map(|it| it.map(flat)) }
            };
            chords.iter().map(chord).collect::<Vec<_>>()
        });
        found.into_iter().flatten().collect()
    }
}

fn crossing(placer: &mut Placer<'_, '_>, grid: &Grid, edge: Edge) -> SurfacePoint {
    placer.crossing(edge.ends().map(|end| grid.position(end)), edge.size)
}

fn flat(point: SurfacePoint) -> Point {
    let [x, y, _] = point.position;
    [x, y]
}

/// Links chords to closed paths; `None` if one has an end.
fn linked(chords: &[Chord]) -> Option<Vec<Vec<Point>>> {
    let starts: FxHashMap<Edge, usize> =
        chords.iter().enumerate().map(|(index, chord)| (chord.ends[0], index)).collect();
    let mut is_done = vec![false; chords.len()];
    let mut paths = Vec::new();
    for first in 0..chords.len() {
        let mut path = Vec::new();
        let mut at = first;
        while !std::mem::replace(&mut is_done[at], true) {
            path.extend(chords[at].points.into_iter().flatten());
            at = *starts.get(&chords[at].ends[1])?;
        }
        if at != first {
            return None;
        }
        if !path.is_empty() {
            paths.push(path);
        }
    }
    Some(paths)
}

/// Returns triangles that stand on paths, as high and deep as the error at least.
fn walls(paths: &[Curve], error: f64) -> Mesh {
    let mut walls = Mesh::default();
    let divided = paths.iter().map(|path| path.lines(DIVIDED * error));
    for [from, to] in divided.flat_map(|path| polygon::sides(&path).collect::<Vec<_>>()) {
        let first = walls.vertices.len() as u32;
        // Unequal heights keep the diagonal away from the middle of the side.
        for ([x, y], z) in [(from, -error), (to, -error), (to, 1.7 * error), (from, 1.7 * error)] {
            walls.vertices.push([x, y, z]);
        }
        walls.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|ids| ids.map(|id| first + id)));
    }
    walls
}
