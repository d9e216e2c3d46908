//! Places the vertices on edges, on faces and in cells, and makes the triangles.

use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::error::{MeshError, Phase};
use crate::field::Prober;
use crate::grid::{Cell, Corner, Edge, Face, Grid};
use crate::loops::{LoopStep, loops};
use crate::patch::{Filling, LoopVertex, Placer};
use crate::refine::{OnProgress, Signs, report};
use crate::surface::Mesh;
use crate::tree::{Tangled, Tree};
use crate::vector::{SurfacePoint, Vec3};

/// The octree, the signs at its corners, and the field that they come from.
pub(crate) struct Builder<'a, 'f> {
    pub(crate) prober: &'a Prober<'f>,
    pub(crate) grid: &'a Grid,
    pub(crate) tree: &'a Tree,
    pub(crate) signs: &'a Signs,
    pub(crate) error: f64,
    /// True if paths may have circular arcs.
    pub(crate) has_arcs: bool,
}

/// A cell with the loops on its boundary.
struct Crossed {
    cell: Cell,
    loops: Vec<Vec<LoopStep>>,
}

/// Vertices by the edge or face that they lie on.
struct Vertices {
    points: Vec<SurfacePoint>,
    on_edges: FxHashMap<Edge, u32>,
    in_faces: FxHashMap<Face, u32>,
}

impl Builder<'_, '_> {
    /// Returns the mesh, without a certificate.
    pub(crate) fn mesh(&self, progress: OnProgress<'_>) -> Result<Mesh, MeshError> {
        let crossed = self.crossed();
        report(progress, Phase::Placing, 0, 3)?;
        let mut vertices = self.on_edges(&crossed);
        report(progress, Phase::Placing, 1, 3)?;
        self.in_faces(&crossed, &mut vertices);
        report(progress, Phase::Placing, 2, 3)?;
        let mesh = self.fill(&crossed, vertices);
        report(progress, Phase::Placing, 3, 3)?;
        Ok(mesh)
    }

    fn crossed(&self) -> Vec<Crossed> {
        let sign = |at: Corner| self.signs.get(&at).copied().unwrap_or(false);
        let mut cells = self.tree.leaves.clone();
        cells.par_sort_unstable();
        cells
            .into_par_iter()
            .filter_map(|cell| match loops(self.tree, cell, sign) {
                Ok(loops) if !loops.is_empty() => Some(Crossed { cell, loops }),
                Ok(_) | Err(Tangled) => None,
            })
            .collect()
    }

    fn on_edges(&self, crossed: &[Crossed]) -> Vertices {
        let steps = crossed.iter().flat_map(|it| it.loops.iter().flatten());
        let mut edges: Vec<Edge> = steps.map(|step| step.edge).collect();
        edges.par_sort_unstable();
        edges.dedup();
        let place = |placer: &mut Placer<'_, '_>, edge: &Edge| {
            placer.crossing(edge.ends().map(|end| self.grid.position(end)), edge.size)
        };
        let points = self.placed(&edges, place);
        let on_edges = edges.into_iter().zip(0..).collect();
        Vertices { points, on_edges, in_faces: FxHashMap::default() }
    }

    /// Adds the vertices within faces. The faces of cells with several loops have none, so that
    /// the loops do not meet.
    fn in_faces(&self, crossed: &[Crossed], vertices: &mut Vertices) {
        let faces = |it: &Crossed| it.loops.iter().flatten().map(|step| step.face).collect();
        let shared = crossed.iter().filter(|it| it.loops.len() > 1);
        let plain: FxHashSet<Face> = shared.flat_map(|it| -> Vec<Face> { faces(it) }).collect();
        let mut chords: Vec<(Face, [u32; 2])> = Vec::new();
        for steps in crossed.iter().flat_map(|it| &it.loops) {
            for (index, step) in steps.iter().enumerate() {
                let next = steps[(index + 1) % steps.len()].edge;
                let ends = [step.edge, next].map(|edge| vertices.on_edges.get(&edge));
                if let [Some(a), Some(b)] = ends
                    && !plain.contains(&step.face)
                {
                    chords.push((step.face, [*a.min(b), *a.max(b)]));
                }
            }
        }
        chords.par_sort_unstable();
        chords.dedup();
        let place = |placer: &mut Placer<'_, '_>, (face, ends): &(Face, [u32; 2])| {
            placer.in_face(*face, ends.map(|id| vertices.points[id as usize]))
        };
        let found = self.placed(&chords, place);
        for ((face, _), point) in chords.into_iter().zip(found) {
            if let Some(point) = point {
                vertices.in_faces.insert(face, vertices.points.len() as u32);
                vertices.points.push(point);
            }
        }
    }

    pub(crate) fn placed<T: Sync, R: Send>(
        &self,
        items: &[T],
        place: impl Fn(&mut Placer<'_, '_>, &T) -> R + Sync,
    ) -> Vec<R> {
        let place = |prober: &mut Prober<'_>, item: &T| {
            place(&mut Placer { prober, grid: self.grid, error: self.error }, item)
        };
        items.par_iter().map_init(|| self.prober.clone(), place).collect()
    }

    fn fill(&self, crossed: &[Crossed], vertices: Vertices) -> Mesh {
        let fill = |placer: &mut Placer<'_, '_>, it: &Crossed| {
            let loops: Vec<Vec<LoopVertex>> =
                it.loops.iter().map(|steps| vertices.of_loop(it.cell, steps)).collect();
            let fillings = placer.fillings(it.cell, &loops);
            (loops, fillings)
        };
        let filled = self.placed(crossed, fill);
        let mut positions: Vec<Vec3> = vertices.points.iter().map(|it| it.position).collect();
        let mut triangles = Vec::new();
        for (loops, fillings) in filled {
            for (vertices, filling) in loops.iter().zip(fillings) {
                let count = vertices.len();
                let id = |index: usize| vertices[index % count].id;
                let (first, steps) = match filling {
                    Filling::Fan(start) => (id(start), start + 1..start + count - 1),
                    Filling::Cone(apex) => {
                        positions.push(apex);
                        (positions.len() as u32 - 1, 0..count)
                    }
                };
                triangles.extend(steps.map(|step| [first, id(step), id(step + 1)]));
            }
        }
        let known = vertices.points.len();
        let rest = self.placed(&positions[known..], |placer, point| placer.normal(*point));
        let normals = vertices.points.iter().map(|it| it.normal).chain(rest).collect();
        let is_single_precision = self.grid.is_single;
        Mesh { vertices: positions, normals, triangles, is_single_precision, ..Mesh::default() }
    }
}

impl Vertices {
    fn of_loop(&self, cell: Cell, steps: &[LoopStep]) -> Vec<LoopVertex> {
        let mut found = Vec::with_capacity(2 * steps.len());
        for LoopStep { edge, face } in steps {
            let on_edge = self.on_edges.get(edge).map(|id| (*id, edge.sides_in(cell)));
            let side = cell.sides(face.at) & 3 << (2 * face.axis);
            let in_face = self.in_faces.get(face).map(|id| (*id, side));
            for (id, sides) in [on_edge, in_face].into_iter().flatten() {
                found.push(LoopVertex { id, point: self.points[id as usize], sides });
            }
        }
        found
    }
}
