//! The promises and constants of shapes, and the conservative field that rays march.

pub(crate) mod affine;
pub(crate) mod box_norms;
pub(crate) mod box_rules;
pub(crate) mod branches;
pub(crate) mod components;
pub(crate) mod conservative;
pub(crate) mod corner;
pub(crate) mod descent;
pub(crate) mod faithful;
pub(crate) mod inexact;
pub(crate) mod lipschitz;
pub(crate) mod local_slope;
pub(crate) mod maps;
pub(crate) mod norms;
pub(crate) mod per_frame;
pub(crate) mod piecewise;
pub(crate) mod promise;
pub(crate) mod quality;
pub(crate) mod reason;
