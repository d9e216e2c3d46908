//! Many similar operands as loops over lists of their constants.

pub(crate) mod active_range;
mod blended;
pub(crate) mod chain;
pub(crate) mod cullable;
pub(crate) mod kinds;
mod linear;
mod loops;
pub(crate) mod marched_bounds;
pub(crate) mod materials;
mod nested;
pub(crate) mod rewrite;
mod selection;
mod shape_keys;
pub(crate) mod strategy;
pub(crate) mod template;
