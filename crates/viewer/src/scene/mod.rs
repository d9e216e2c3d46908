//! The compiled scene: its files, params, shapes, materials and field.

pub mod distance_quality;
pub mod document;
pub mod field_probe;
pub mod handle_values;
pub mod line_endings;
pub mod materials;
pub mod model;
pub mod number_text;
pub mod param_source;
pub mod param_values;
pub mod rebase;
pub mod shapes;
pub mod source_numbers;
