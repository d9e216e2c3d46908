//! Assembles shaders: a template of WGSL files, and a scene's functions bound to its stubs.

mod bindings;
mod culling;
pub(crate) mod field;
mod linker;
pub(crate) mod picture;
pub(crate) mod shadertoy;
mod template;
