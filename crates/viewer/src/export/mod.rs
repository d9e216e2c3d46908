//! Writing files: the scene, pictures, animations, shaders, screenshots.

pub mod exporter;
pub mod worker;
