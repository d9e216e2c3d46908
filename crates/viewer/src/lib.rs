//! A window that shows a scene and follows its file as it is edited.
//!
//! # How it is built
//!
//! ```text
//!         file watcher ─▶ compile worker ─▶ Model (scene, pipeline) ─┐
//!                                                                   ▼
//! window ─▶ Session ────────────────────────────────────▶ render worker ─▶ Picture ─▶ window
//!  input    open scene, text, camera, param values, time   draws            CPU image
//! ```
//!
//! The window ([`app`]) only shows a [`session`] and passes input to it. Nothing else depends on
//! windows, so everything else is tested without one. The [compile](compile::worker),
//! [render](render::worker), [language](language::worker) and [accuracy](accuracy::worker) workers
//! are threads that handle the latest message only ([`latest_channel`]); the
//! [export](export::worker) worker handles every job in order. The window's thread does nothing
//! slow: it does not read files, compile, call a driver's shader compiler or draw the picture.
//!
//! The render worker has its own device and reads each picture back. So the window never waits for
//! a slow shader, a lost device is reopened while the window stays, and the CPU renderer replaces a
//! device that does not come back. The picture is data on the CPU: pixel info, heat maps and the
//! other [`views`] are functions of it and need no second renderer. `docs/viewer.md` gives the
//! cost.

pub mod accuracy;
pub mod app;
pub mod compile;
pub mod examples;
pub mod export;
mod json_file;
pub mod language;
pub mod latest_channel;
pub mod render;
pub mod scene;
pub mod session;
pub mod settings;
pub mod small_pictures;
#[cfg(test)]
mod test_support;
pub mod text_search;
pub mod unsaved_texts;
pub mod views;
pub mod worker_thread;
