//! Tests that draw. They are one program, because they share one app.

mod assets;
#[path = "../../examples/headless/mod.rs"]
mod headless;
mod pictures;
mod support;
