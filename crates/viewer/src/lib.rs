//! A window that shows a scene and follows its text as it is edited.
//!
//! # How it is built
//!
//! ```text
//!                 watch ──▶ worker ──▶ Model (scene, pipeline) ─┐
//!                  files    compiles                            ▼
//! window ──▶ session ──────────────────────────────────▶ painter ──▶ Picture ──▶ window
//!  input     what is open, camera, knobs, time            draws        an image on the CPU
//! ```
//!
//! The window ([`app`]) only shows a [`session`] and hands input to it; everything else knows nothing of
//! windows and is tested without one. The worker, the painter and the [`judge`] are threads with a [`mailbox`] that keeps
//! the newest order only. Nothing that can be slow runs where input is heard: not reading files, not
//! compiling, not a driver's shader compiler, not drawing.
//!
//! The painter has a device of its own and reads each picture back. So the window never waits for a slow
//! shader, a lost device is opened anew while the window stays, one that never comes back is replaced by the
//! CPU renderer, and a picture is data: hovering, heat maps and the other [`views`] are functions of it that
//! need no second renderer. What that costs is in `docs/viewer.md`.

pub mod app;
pub mod clerk;
pub mod clock;
pub mod comparing;
pub mod document;
pub mod edit;
pub mod engine;
pub mod examples;
pub mod findings;
pub mod identity;
pub mod judge;
pub mod knobs;
pub mod legend;
pub mod look;
pub mod mailbox;
pub mod material;
pub mod memory;
pub mod mode;
pub mod model;
pub mod orbit;
pub mod painter;
pub mod probe;
pub mod session;
mod shop;
pub mod views;
pub mod watch;
pub mod worker;
