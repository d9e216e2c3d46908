//! The library's files: everything that is a shape, a blend or a pattern is written in the language.
//!
//! A new shape is a new entry of one of them; nothing here or elsewhere in Rust names one.

/// Name, as messages show it, and text of each file.
pub const FILES: &[(&str, &str)] = &[
    ("std/combine.sdf", include_str!("../std/combine.sdf")),
    ("std/distance.sdf", include_str!("../std/distance.sdf")),
    ("std/domain.sdf", include_str!("../std/domain.sdf")),
    ("std/material.sdf", include_str!("../std/material.sdf")),
    ("std/regions.sdf", include_str!("../std/regions.sdf")),
    ("std/solids.sdf", include_str!("../std/solids.sdf")),
];
