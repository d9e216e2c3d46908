//! Turns joined WGSL files into a module whose stubs a scene can replace.

pub(crate) mod template;
