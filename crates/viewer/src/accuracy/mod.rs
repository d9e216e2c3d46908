//! Comparing the picture with the oracle.

pub mod checks;
pub mod comparison;
pub mod worker;
