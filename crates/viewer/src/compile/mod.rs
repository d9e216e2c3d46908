//! From files to a model that can be drawn: watching, reading, compiling, making pipelines.

pub mod builder;
pub mod diagnostics;
pub mod engines;
pub mod file_watcher;
pub mod request;
pub mod text_diff;
pub mod worker;
