//! The compiled scene and what the window asks of it: files, params, shapes, materials, the field.

pub mod distance_quality;
pub mod document;
pub mod field_probe;
pub mod materials;
pub mod model;
pub mod number_text;
pub mod param_values;
pub mod shapes;
