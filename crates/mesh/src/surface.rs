//! The mesh and its certificate.

use rustc_hash::FxHashMap;
use serde::Serialize;

use crate::error::shown;
use crate::vector::{cross, dot, length, sub, total};

/// A closed mesh of triangles.
///
/// Every edge belongs to two triangles with opposite directions. Triangles are counter-clockwise
/// as seen from outside, and meet only in common vertices and edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions, in scene units.
    pub vertices: Vec<[f64; 3]>,
    /// The field's gradient at each vertex, with length 1; on a sharp edge that of one side.
    pub normals: Vec<[f64; 3]>,
    /// Indices of vertices.
    pub triangles: Vec<[u32; 3]>,
    /// Linear red, green and blue at each vertex; empty if the scene has no materials.
    pub colors: Vec<[f32; 3]>,
    /// True if all positions are 32-bit floats, so that formats with such floats lose nothing.
    pub is_single_precision: bool,
    /// The proven properties.
    pub certificate: MeshCertificate,
}

/// The proven properties of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MeshCertificate {
    /// The distance that was asked for, in scene units.
    pub error: f64,
    /// True if every point of the mesh is proven to be within `error` of the surface, and every
    /// point of the surface within `error` of the mesh. If false, this holds outside the
    /// undecided boxes.
    pub is_proven: bool,
    /// Number of boxes without a proof.
    pub undecided: u64,
    /// Volume of the boxes without a proof.
    pub undecided_volume: f64,
    /// Lowest and highest corner of boxes without a proof; at most [`MeshCertificate::MAX_BOXES`].
    pub undecided_boxes: Vec<[[f64; 3]; 2]>,
    /// Number of boxes in which the surface is proven to be absent.
    pub empty_boxes: u64,
    /// Number of boxes in which the field is proven to change its sign across the mesh.
    pub sheet_boxes: u64,
    /// Number of boxes, smaller than the error, that contain both signs and part of the mesh.
    pub small_boxes: u64,
    /// Number of boxes, at most four times as large as the error, in which faces touch: they hold
    /// no triangle, and the field crosses 0 by at most a hundredth of its variation in the box.
    /// They count as free of surface, so slits and skins that are thinner than about a tenth of
    /// the error may be missing.
    pub touching_boxes: u64,
    /// True if mesh and surface are proven to have the same topology.
    pub is_topology_proven: bool,
}

impl MeshCertificate {
    /// The most undecided boxes that are listed.
    pub const MAX_BOXES: usize = 1000;

    /// Adds the numbers of boxes that an earlier pass proved.
    pub(crate) fn add_proofs(&mut self, earlier: &Self) {
        self.empty_boxes += earlier.empty_boxes;
        self.sheet_boxes += earlier.sheet_boxes;
        self.small_boxes += earlier.small_boxes;
        self.touching_boxes += earlier.touching_boxes;
    }
}

/// One line that says what is proven.
impl std::fmt::Display for MeshCertificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { error, is_proven, undecided, undecided_volume, .. } = self;
        let error = shown(*error);
        if *is_proven {
            return write!(f, "mesh and surface are proven to be within {error} of each other");
        }
        write!(
            f,
            "mesh and surface are within {error} of each other, except in {undecided} undecided \
             boxes with a volume of {undecided_volume:.3e}"
        )
    }
}

impl Mesh {
    /// Returns the corners of a triangle.
    pub fn corners(&self, triangle: [u32; 3]) -> [[f64; 3]; 3] {
        triangle.map(|id| self.vertices[id as usize])
    }

    /// Returns the volume that the mesh encloses.
    pub fn volume(&self) -> f64 {
        // About a point near the mesh, because far from it digits cancel.
        let near = self.vertices.first().copied().unwrap_or_default();
        total(self.triangles.iter().map(|triangle| self.volume_from(near, *triangle)))
    }

    /// Returns the volume between a point and a triangle, negative on the outer side of it.
    pub(crate) fn volume_from(&self, near: [f64; 3], triangle: [u32; 3]) -> f64 {
        let [a, b, c] = self.corners(triangle).map(|corner| sub(corner, near));
        dot(a, cross(b, c)) / 6.0
    }

    /// Returns the area of all triangles.
    pub fn area(&self) -> f64 {
        let part = |triangle: &[u32; 3]| {
            let [a, b, c] = self.corners(*triangle);
            0.5 * length(cross(sub(b, a), sub(c, a)))
        };
        total(self.triangles.iter().map(part))
    }

    /// Returns the lowest and the highest corner of a box around the mesh; `None` without vertices.
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let first = *self.vertices.first()?;
        Some(self.vertices.iter().fold([first; 2], |[lo, hi], point| {
            let lo = std::array::from_fn(|axis| lo[axis].min(point[axis]));
            [lo, std::array::from_fn(|axis| hi[axis].max(point[axis]))]
        }))
    }

    /// Counts the edges that do not belong to exactly two triangles with opposite directions: 0 for
    /// a closed, consistently oriented mesh.
    pub fn open_edges(&self) -> usize {
        let mut counts: FxHashMap<[u32; 2], u32> = FxHashMap::default();
        let edges = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
        for edge in self.triangles.iter().flat_map(|triangle| edges(*triangle)) {
            *counts.entry(edge).or_default() += 1;
        }
        let is_closed =
            |edge: &[u32; 2], count: u32| count == 1 && counts.get(&[edge[1], edge[0]]) == Some(&1);
        counts.iter().filter(|(edge, count)| !is_closed(edge, **count)).count()
    }
}
