//! Ray intersections that are computed without marching.

pub(crate) mod boxes;
pub(crate) mod copies;
pub(crate) mod intervals;
pub(crate) mod operands;
pub(crate) mod queries;
pub(crate) mod repetition;
pub(crate) mod split;
