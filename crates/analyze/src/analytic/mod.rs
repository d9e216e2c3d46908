//! Ray intersections that are computed without marching.

mod blends;
pub(crate) mod boxes;
pub(crate) mod copies;
mod formula;
pub(crate) mod intervals;
pub(crate) mod operands;
pub(crate) mod queries;
pub(crate) mod repetition;
pub(crate) mod split;
