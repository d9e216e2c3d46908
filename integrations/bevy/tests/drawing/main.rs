//! Tests that draw. They are one program, because they share one app.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "Clippy takes the helpers of tests for code of the program"
)]

mod assets;
#[path = "../../examples/headless/mod.rs"]
mod headless;
mod pictures;
mod support;
