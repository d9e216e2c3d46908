//! Lowers flat math of the graph to naga functions.

pub(crate) mod active_lists;
pub(crate) mod body;
mod guards;
mod hash;
pub(crate) mod inputs;
mod iteration;
mod loops;
mod lowering;
mod operation;
pub(crate) mod tables;
pub(crate) mod types;
mod uses;

pub(crate) use lowering::{
    POINT, function_of, function_of_iteration, store_function, struct_function,
};
