//! Mesh files, as bytes: STL, OBJ, PLY, glTF (GLB) and 3MF. Contour files: SVG
//! and DXF. Grid files: NumPy and NRRD.

mod contour;
mod glb;
mod grid;
mod package;
mod plain;

use std::path::Path;

use crate::surface::Mesh;

pub use self::contour::ContourFormat;
pub use self::grid::GridFormat;

/// A file format for meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Binary STL: triangles with 32-bit floats.
    Stl,
    /// Wavefront OBJ: text.
    Obj,
    /// Binary PLY, with colours.
    Ply,
    /// Binary glTF 2.0, with colours and normals.
    Glb,
    /// 3MF for printing, with colours. One scene unit is a millimetre.
    ThreeMf,
}

/// The reason why a format cannot hold a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// The format loses digits that the error needs.
    #[error(
        "STL stores 32-bit floats, which are too coarse for an error of {error} this far from the \
         origin; write .obj, .ply or .3mf, or move the scene to the origin"
    )]
    TooCoarse {
        /// The error of the mesh.
        error: f64,
    },
    /// The format stores sizes in 32 bits.
    #[error(
        "the mesh has {triangles} triangles, but {format} files are limited to 4 GiB; write .stl, \
         .obj or .ply, or allow a larger error"
    )]
    TooLarge {
        /// The name of the format.
        format: &'static str,
        /// The number of triangles.
        triangles: usize,
    },
}

impl MeshFormat {
    /// Returns the format for the extension of a path.
    ///
    /// # Errors
    ///
    /// The extension belongs to no format. The message names the formats.
    pub fn of(path: &Path) -> Result<Self, String> {
        let formats = [
            ("stl", Self::Stl),
            ("obj", Self::Obj),
            ("ply", Self::Ply),
            ("glb", Self::Glb),
            ("3mf", Self::ThreeMf),
        ];
        let extension = path.extension().unwrap_or_default();
        let format = formats.iter().find(|(known, _)| extension.eq_ignore_ascii_case(known));
        format.map(|(_, format)| *format).ok_or_else(|| {
            let path = path.display();
            format!("{path}: meshes are written as .stl, .obj, .ply, .glb or .3mf")
        })
    }

    /// Encodes a mesh.
    ///
    /// # Errors
    ///
    /// [`EncodeError`].
    pub fn encode(self, mesh: &Mesh) -> Result<Vec<u8>, EncodeError> {
        let too_large = |format| EncodeError::TooLarge { format, triangles: mesh.triangles.len() };
        match self {
            Self::Stl if !mesh.is_single_precision => {
                Err(EncodeError::TooCoarse { error: mesh.certificate.error })
            }
            Self::Stl => Ok(plain::stl(mesh)),
            Self::Obj => Ok(plain::obj(mesh)),
            Self::Ply => Ok(plain::ply(mesh)),
            Self::Glb => glb::glb(mesh).ok_or_else(|| too_large("GLB")),
            Self::ThreeMf => package::three_mf(mesh).ok_or_else(|| too_large("3MF")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_determines_the_format() {
        let of = |path: &str| MeshFormat::of(Path::new(path)).ok();
        assert_eq!(of("a.STL"), Some(MeshFormat::Stl));
        assert_eq!(of("b/c.3mf"), Some(MeshFormat::ThreeMf));
        assert_eq!((of("a.png"), of("a"), of("-")), (None, None, None));
    }

    #[test]
    fn a_format_with_32_bit_floats_refuses_a_mesh_that_needs_more_digits() {
        let mesh = Mesh::default();
        assert!(MeshFormat::Stl.encode(&mesh).is_err());
        let mesh = Mesh { is_single_precision: true, ..mesh };
        assert_eq!(MeshFormat::Stl.encode(&mesh).map(|bytes| bytes.len()), Ok(84));
    }
}
