//! The thread that writes files, one after the other: the scene with other numbers, what is taken out of the window.

use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::thread::JoinHandle;

use crate::document::Document;

/// Something to be written.
#[derive(Debug)]
pub enum Errand {
    /// The scene's own file, unless it is not what it was.
    Rewrite {
        /// The file.
        path: PathBuf,
        /// What it held.
        before: String,
        /// What it is to hold.
        after: String,
    },
}

/// What came of an errand, in one line.
pub type Outcome = Result<String, String>;

/// The thread, as others see it.
#[derive(Debug)]
pub struct Clerk {
    errands: Option<Sender<Errand>>,
    thread: Option<JoinHandle<()>>,
}

impl Clerk {
    /// Starts it. `wake` is called after each outcome.
    pub fn new(
        outcomes: Sender<Outcome>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let (errands, waiting) = channel();
        let run = move || {
            for errand in waiting {
                // The receiver is gone only where the window is.
                let _ = outcomes.send(done(errand));
                wake();
            }
        };
        let thread = std::thread::Builder::new().name("clerk".into()).spawn(run)?;
        Ok(Self { errands: Some(errands), thread: Some(thread) })
    }

    /// Hands it an errand, to be done after those before it.
    pub fn send(&self, errand: Errand) {
        if let Some(errands) = &self.errands {
            let _ = errands.send(errand);
        }
    }
}

impl Drop for Clerk {
    /// Waits: what was to be written is written, although the window is closed.
    fn drop(&mut self) {
        drop(self.errands.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn done(errand: Errand) -> Outcome {
    match errand {
        Errand::Rewrite { path, before, after } => {
            let document = Document::read(&path).map_err(|error| error.to_string())?;
            if document.text != before {
                return Err("the file has changed; nothing is written".to_owned());
            }
            let written = sdfc_files::write(&path, after.as_bytes());
            written.map_err(|error| format!("cannot write {}: {error}", path.display()))?;
            Ok("written".to_owned())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_has_changed_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, "box(1)").unwrap();
        let rewrite = |before: &str| {
            let (before, after) = (before.to_owned(), "box(2)".to_owned());
            done(Errand::Rewrite { path: path.clone(), before, after })
        };
        assert!(rewrite("box(3)").is_err());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "box(1)");
        assert!(rewrite("box(1)").is_ok());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "box(2)");
    }
}
