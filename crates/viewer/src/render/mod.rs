//! The thread that draws the picture, and information about single pixels.

pub mod handles;
pub mod images;
pub mod pacing;
pub mod picture;
pub mod pixel_info;
pub mod shape_mask;
pub mod surface_points;
pub mod view_painter;
pub mod window_device;
pub mod worker;
