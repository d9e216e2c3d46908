//! What several formats contain.

use crate::surface::Mesh;

/// One line about the certificate, for the comments of a file.
pub(super) fn summary(mesh: &Mesh) -> String {
    let certificate = &mesh.certificate;
    let error = certificate.error;
    if certificate.is_proven {
        return format!("mesh and surface are proven to be within {error} of each other");
    }
    let count = certificate.undecided;
    format!("mesh and surface are within {error} of each other, except in {count} undecided boxes")
}

/// A linear channel as sRGB with 8 bits.
pub(super) fn srgb(linear: f32) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let curve = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (curve * 255.0).round() as u8
}
