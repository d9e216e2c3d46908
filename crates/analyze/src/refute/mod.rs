//! Clauses of shapes and functions, tested by samples.

pub(crate) mod claims;
pub(crate) mod clauses;
pub(crate) mod copies;
pub(crate) mod frames;
pub(crate) mod probe;
pub(crate) mod rays;
