//! Work that is shared between machines: shares of frames, regions of pictures, and files that say
//! how they were drawn.

pub mod options;
pub mod progress;
pub mod provenance;
pub mod region;
pub mod resume;
pub mod share;
