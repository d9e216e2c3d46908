//! Accuracy checks of the shown picture: the last job and its result.

use std::sync::mpsc::{Receiver, channel};

use crate::accuracy::comparison::{ComparisonJob, ComparisonResult};
use crate::accuracy::worker::{AccuracyEvent, AccuracyWorker};

/// The accuracy worker and its last result.
#[derive(Debug)]
pub struct AccuracyChecks {
    worker: AccuracyWorker,
    events: Receiver<AccuracyEvent>,
    /// The last result.
    pub result: Option<Box<ComparisonResult>>,
    /// Why the last comparison failed.
    pub error: Option<String>,
    /// True if every picture is compared once it is finished.
    pub automatic: bool,
    last_job: Option<ComparisonJob>,
}

impl AccuracyChecks {
    /// Starts the accuracy worker. `wake` is called when there is something to
    /// [`poll`](Self::poll).
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Self> {
        let (sender, events) = channel();
        let worker = AccuracyWorker::new(sender, wake)?;
        Ok(Self { worker, events, result: None, error: None, automatic: false, last_job: None })
    }

    /// Handles the worker's events. Returns true if there were any.
    pub fn poll(&mut self) -> bool {
        let mut changed = false;
        while let Ok(event) = self.events.try_recv() {
            match event {
                AccuracyEvent::Result(result) => {
                    (self.result, self.error) = (Some(result), None);
                }
                AccuracyEvent::Failed(why) => self.error = Some(why),
                AccuracyEvent::Cancelled => {}
            }
            changed = true;
        }
        changed
    }

    /// Compares a picture, or all methods.
    pub fn start(&mut self, job: ComparisonJob) {
        self.error = None;
        self.last_job = Some(job.clone());
        self.worker.send(job);
    }

    /// Compares a picture unless it is the one that was compared last.
    pub fn start_if_new(&mut self, job: ComparisonJob) {
        if !self.last_job.as_ref().is_some_and(|it| it.has_same_picture(&job)) {
            self.start(job);
        }
    }

    /// Cancels the comparison and turns automatic checks off.
    pub fn cancel(&mut self) {
        self.worker.cancel();
        (self.automatic, self.last_job) = (false, None);
    }

    /// Cancels the comparison and drops the last result.
    pub fn reset(&mut self) {
        self.cancel();
        (self.result, self.error) = (None, None);
    }

    /// The fraction of the current step that is done, 0 to 1, and the step's name; `None` if
    /// nothing is being compared.
    pub fn progress(&self) -> Option<(f32, &'static str)> {
        self.worker.progress()
    }
}
