//! STL, OBJ and PLY.

use std::fmt::Write;

use sdfc_graph::linear_to_srgb8;

use crate::surface::Mesh;
use crate::vector::{cross, sub, unit};

/// Binary STL: <https://www.loc.gov/preservation/digital/formats/fdd/fdd000505.shtml>.
pub(super) fn stl(mesh: &Mesh) -> Vec<u8> {
    let mut file = format!("sdfc: {}", mesh.certificate).into_bytes();
    file.resize(80, b' ');
    file.extend((mesh.triangles.len() as u32).to_le_bytes());
    for triangle in &mesh.triangles {
        let [a, b, c] = mesh.corners(*triangle);
        let normal = unit(cross(sub(b, a), sub(c, a))).unwrap_or_default();
        for value in [normal, a, b, c].as_flattened() {
            file.extend((*value as f32).to_le_bytes());
        }
        file.extend([0; 2]);
    }
    file
}

pub(super) fn obj(mesh: &Mesh) -> Vec<u8> {
    let mut text = format!("# sdfc: {}\n", mesh.certificate);
    // Writing to a string does not fail.
    for [x, y, z] in &mesh.vertices {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|id| id + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text.into_bytes()
}

pub(super) fn ply(mesh: &Mesh) -> Vec<u8> {
    let number = if mesh.is_single_precision { "float" } else { "double" };
    let mut header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment sdfc: {}\nelement vertex {}\n\
         property {number} x\nproperty {number} y\nproperty {number} z\n\
         property float nx\nproperty float ny\nproperty float nz\n",
        mesh.certificate,
        mesh.vertices.len(),
    );
    if !mesh.colors.is_empty() {
        header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    }
    let _ = write!(
        header,
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.triangles.len()
    );
    let mut file = header.into_bytes();
    for (index, (point, normal)) in mesh.vertices.iter().zip(&mesh.normals).enumerate() {
        for value in point {
            match mesh.is_single_precision {
                true => file.extend((*value as f32).to_le_bytes()),
                false => file.extend(value.to_le_bytes()),
            }
        }
        normal.iter().for_each(|value| file.extend((*value as f32).to_le_bytes()));
        if let Some(color) = mesh.colors.get(index) {
            file.extend(color.map(linear_to_srgb8));
        }
    }
    for triangle in &mesh.triangles {
        file.push(3);
        triangle.iter().for_each(|id| file.extend(id.to_le_bytes()));
    }
    file
}
