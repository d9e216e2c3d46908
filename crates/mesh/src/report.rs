//! Reports about meshes and contours, which programs write as JSON.

use serde::Serialize;

use crate::contour::Contour;
use crate::plane::Plane;
use crate::shell::Shell;
use crate::surface::{Mesh, MeshCertificate};

/// A report about a mesh. [`Mesh::report`] makes it. Lengths are in scene units.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MeshReport<'a> {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of edges that do not belong to exactly two triangles; see [`Mesh::open_edges`].
    pub open_edges: usize,
    /// The volume that the mesh encloses.
    pub volume: f64,
    /// The area of all triangles.
    pub area: f64,
    /// The lowest and the highest corner; `None` without vertices.
    pub bounds: Option<[[f64; 3]; 2]>,
    /// The connected parts; see [`Mesh::shells`].
    pub shells: Vec<Shell>,
    /// The proven properties.
    pub certificate: &'a MeshCertificate,
}

/// A contour with a report about it. [`Contour::report`] makes it. Lengths are in scene units.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ContourReport<'a> {
    /// The position in space of the origin of the plane's coordinates.
    pub origin: [f64; 3],
    /// The directions in space of the plane's coordinates.
    pub axes: [[f64; 3]; 2],
    /// The area of the section.
    pub area: f64,
    /// The length of all paths.
    pub length: f64,
    /// The lowest and the highest corner in the plane; `None` without paths.
    pub bounds: Option<[[f64; 2]; 2]>,
    /// The paths and the proven properties.
    #[serde(flatten)]
    pub contour: &'a Contour,
}

impl Mesh {
    /// Returns a report about the mesh, to write as JSON.
    pub fn report(&self) -> MeshReport<'_> {
        MeshReport {
            vertices: self.vertices.len(),
            triangles: self.triangles.len(),
            open_edges: self.open_edges(),
            volume: self.volume(),
            area: self.area(),
            bounds: self.bounds(),
            shells: self.shells(),
            certificate: &self.certificate,
        }
    }
}

impl Contour {
    /// Returns the contour in a plane with a report about it, to write as JSON.
    pub fn report(&self, plane: &Plane) -> ContourReport<'_> {
        ContourReport {
            origin: plane.at([0.0; 2]),
            axes: plane.axes(),
            area: self.area(),
            length: self.length(),
            bounds: self.bounds(),
            contour: self,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_has_the_size_0_and_not_minus_0() {
        let (mesh, contour) = (Mesh::default(), Contour::default());
        let sizes = [mesh.volume(), mesh.area(), contour.area(), contour.length()];
        assert_eq!(sizes.map(f64::to_bits), [0; 4]);
    }
}
