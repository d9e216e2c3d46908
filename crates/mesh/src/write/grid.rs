//! Grid files, as bytes: NumPy and NRRD.

use std::path::Path;

use crate::bake::DistanceGrid;

/// A file format for grids of distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridFormat {
    /// NumPy: an array of 32-bit floats with the indices x, y, z.
    Npy,
    /// NRRD: the same values with their positions in space.
    Nrrd,
}

impl GridFormat {
    /// Returns the format for the extension of a path.
    ///
    /// # Errors
    ///
    /// The extension belongs to no format. The message names the formats.
    pub fn of(path: &Path) -> Result<Self, String> {
        let extension = path.extension().unwrap_or_default();
        let is = |known: &str| extension.eq_ignore_ascii_case(known);
        if is("npy") {
            Ok(Self::Npy)
        } else if is("nrrd") {
            Ok(Self::Nrrd)
        } else {
            Err(format!("{}: grids are written as .npy or .nrrd", path.display()))
        }
    }

    /// Encodes a grid.
    pub fn encode(self, grid: &DistanceGrid) -> Vec<u8> {
        let mut file = match self {
            Self::Npy => npy_header(grid),
            Self::Nrrd => nrrd_header(grid).into_bytes(),
        };
        file.reserve(4 * grid.values.len());
        grid.values.iter().for_each(|value| file.extend(value.to_le_bytes()));
        file
    }
}

/// The header of version 1.0:
/// <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>.
fn npy_header(grid: &DistanceGrid) -> Vec<u8> {
    let [x, y, z] = grid.shape;
    let mut text = format!("{{'descr': '<f4', 'fortran_order': True, 'shape': ({x}, {y}, {z}), }}");
    // The values begin at a multiple of 64 bytes.
    let padding = 63 - (10 + text.len()) % 64;
    text.extend(std::iter::repeat_n(' ', padding));
    text.push('\n');
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((text.len() as u16).to_le_bytes());
    file.extend(text.into_bytes());
    file
}

/// The header of version 5: <https://teem.sourceforge.net/nrrd/format.html>.
fn nrrd_header(grid: &DistanceGrid) -> String {
    let ([x, y, z], [a, b, c], step) = (grid.shape, grid.origin, grid.spacing);
    format!(
        "NRRD0005\ntype: float\ndimension: 3\nspace dimension: 3\nsizes: {x} {y} {z}\n\
         space directions: ({step},0,0) (0,{step},0) (0,0,{step})\nspace origin: ({a},{b},{c})\n\
         endian: little\nencoding: raw\ninterpolation error:={}\n\n",
        grid.interpolation_error
    )
}
