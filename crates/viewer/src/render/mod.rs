//! Drawing the picture on a thread, and what one of its pixels shows.

pub mod picture;
pub mod pixel_info;
pub mod worker;
