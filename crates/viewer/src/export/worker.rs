//! The thread that writes files. Unlike the other workers it handles every job, in order.

use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

use crate::export::exporter::{ExportJob, ExportOutcome, ExportState, Exporter, lock};

/// Stack size in bytes; exporting a shader runs the compiler.
const STACK_BYTES: usize = 16 << 20;

/// A handle to the export worker.
#[derive(Debug)]
pub struct ExportWorker {
    jobs: Option<Sender<ExportJob>>,
    state: Arc<Mutex<ExportState>>,
    thread: Option<JoinHandle<()>>,
}

impl ExportWorker {
    /// Starts the thread. It sends an outcome per job and calls `wake` after each, and when
    /// progress changes.
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn new(
        outcomes: Sender<ExportOutcome>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let (jobs, received) = channel();
        let state = Arc::new(Mutex::new(ExportState::default()));
        let exporter = Exporter { state: Arc::clone(&state), wake: Box::new(wake) };
        let run = move || {
            for job in received {
                *lock(&exporter.state) = ExportState::default();
                let outcome = exporter.run(job);
                lock(&exporter.state).progress = None;
                // Sending fails only after the session is dropped.
                let _ = outcomes.send(outcome);
                (exporter.wake)();
            }
        };
        let thread = std::thread::Builder::new().name("export".into()).stack_size(STACK_BYTES);
        Ok(Self { jobs: Some(jobs), state, thread: Some(thread.spawn(run)?) })
    }

    /// Adds a job behind those that wait.
    pub fn send(&self, job: ExportJob) {
        if let Some(jobs) = &self.jobs {
            let _ = jobs.send(job);
        }
    }

    /// A function that adds a job from another thread.
    pub fn sender(&self) -> impl Fn(ExportJob) + Send + 'static {
        let jobs = self.jobs.clone();
        move |job| {
            if let Some(jobs) = &jobs {
                let _ = jobs.send(job);
            }
        }
    }

    /// The fraction that is drawn, 0 to 1; `None` if nothing is being drawn.
    pub fn progress(&self) -> Option<f32> {
        lock(&self.state).progress
    }

    /// Cancels the picture that is being drawn; its file is not written.
    pub fn cancel(&self) {
        lock(&self.state).cancelled = true;
    }
}

impl Drop for ExportWorker {
    /// Cancels drawing, and waits until files that are being written are complete.
    fn drop(&mut self) {
        drop(self.jobs.take());
        self.cancel();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
