//! The views of a picture. Each view has a file and turns a rendered image into screen colours,
//! some with the field evaluated at the points that the image shows.
//!
//! `docs/contributing/add-a-view.md` says how to add one.

mod colors;
mod depth;
mod distance_quality;
mod evaluations;
mod gradient_length;
mod grid;
pub mod input;
pub mod legend;
mod materials;
pub mod mode;
mod normals;
mod out_of_steps;
mod overshoot;
mod shaded;
mod shapes;
mod slice;
pub mod slice_plane;
#[cfg(test)]
mod test_images;
pub mod view;
