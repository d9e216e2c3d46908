//! Clauses of shapes and functions, tested by samples, and films found by samples.

pub(crate) mod claims;
pub(crate) mod clauses;
pub(crate) mod copies;
pub(crate) mod films;
pub(crate) mod frames;
pub(crate) mod probe;
pub(crate) mod rays;
pub(crate) mod sampling;
pub(crate) mod suggest;
