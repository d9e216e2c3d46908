//! Helpers for unit tests: a compile worker that prepares scenes for the CPU.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use crate::compile::diagnostics::SceneDiagnostics;
use crate::compile::request::{BuildRequest, CompileEvent, CompileReport};
use crate::compile::worker::CompileWorker;
use crate::scene::model::Model;

/// Long enough for a busy machine; reached only if a test fails.
pub const TIMEOUT: Duration = Duration::from_secs(300);

/// A model of a source, as the compile worker makes it for the CPU.
pub fn model(source: &str) -> Arc<Model> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sdf");
    std::fs::write(&path, source).unwrap();
    let (worker, events) = start_worker();
    worker.send(on_cpu(&path));
    ready_model(&events)
}

/// A request to draw a file on the CPU.
pub fn on_cpu(path: &Path) -> BuildRequest {
    BuildRequest { on_cpu: true, ..BuildRequest::new(path) }
}

/// A compile worker and its reports.
pub fn start_worker() -> (CompileWorker, Receiver<CompileReport>) {
    let (sender, events) = channel();
    (CompileWorker::new(sender, || {}).unwrap(), events)
}

/// The next event.
pub fn next_event(events: &Receiver<CompileReport>) -> CompileEvent {
    events.recv_timeout(TIMEOUT).unwrap().event
}

/// The model of a source without errors.
pub fn ready_model(events: &Receiver<CompileReport>) -> Arc<Model> {
    assert_eq!(expect_compiled(events).0.errors(), 0);
    expect_model(events)
}

/// The model in the next event.
#[allow(clippy::wildcard_enum_match_arm, reason = "a test that meets anything else fails")]
pub fn expect_model(events: &Receiver<CompileReport>) -> Arc<Model> {
    match next_event(events) {
        CompileEvent::Ready(model) => model,
        other => panic!("{other:?}"),
    }
}

/// The diagnostics and folders in the next event.
#[allow(clippy::wildcard_enum_match_arm, reason = "a test that meets anything else fails")]
pub fn expect_compiled(events: &Receiver<CompileReport>) -> (SceneDiagnostics, BTreeSet<PathBuf>) {
    match next_event(events) {
        CompileEvent::Compiled { diagnostics, folders, .. } => (diagnostics, folders),
        other => panic!("{other:?}"),
    }
}
