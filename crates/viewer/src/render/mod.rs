//! The thread that draws the picture, and information about single pixels.

pub mod picture;
pub mod pixel_info;
pub mod worker;
