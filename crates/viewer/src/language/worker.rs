//! The thread that asks the language service about the latest text.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Sender;

use sdfc_files::Folder;
use sdfc_ide::{Analysis, Completion, TokenSpan, complete, tokens};

use crate::worker_thread::WorkerThread;

/// A question about a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LanguageRequest {
    /// The scene's file, beside which imports are looked for.
    pub path: PathBuf,
    /// The text.
    pub text: Arc<str>,
    /// The byte offset of the cursor, if completions are wanted.
    pub cursor: Option<usize>,
}

/// The answer to a question.
#[derive(Clone)]
pub struct LanguageAnswer {
    /// The question.
    pub request: LanguageRequest,
    /// What is known of the text.
    pub analysis: Arc<Analysis>,
    /// The roles of its words.
    pub tokens: Arc<[TokenSpan]>,
    /// What can be written at the cursor.
    pub completions: Vec<Completion>,
}

impl std::fmt::Debug for LanguageAnswer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LanguageAnswer").field("request", &self.request).finish_non_exhaustive()
    }
}

/// A handle to the language worker; dropping it ends the thread.
#[derive(Debug)]
pub struct LanguageWorker(WorkerThread<LanguageRequest>);

impl LanguageWorker {
    /// Starts the thread. It sends `answers` and calls `wake` after each.
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn new(
        answers: Sender<LanguageAnswer>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let mut last: Option<LanguageAnswer> = None;
        let handle = move |request: LanguageRequest| {
            let answer = answer(request, last.take());
            last = Some(answer.clone());
            // Sending fails only after the session is dropped.
            let _ = answers.send(answer);
            wake();
        };
        WorkerThread::start("language", |_| handle).map(Self)
    }

    /// Asks a question in place of any earlier one.
    pub fn send(&self, request: LanguageRequest) {
        self.0.channel().send(request);
    }
}

/// Answers a question. The analysis of the last answer serves again if the text is the same.
fn answer(request: LanguageRequest, last: Option<LanguageAnswer>) -> LanguageAnswer {
    let name = request.path.file_name().unwrap_or_default().to_string_lossy();
    let folder = Folder::of(&request.path);
    let completions = match request.cursor {
        Some(cursor) => complete(&name, &request.text, cursor, &folder, &[]),
        None => Vec::new(),
    };
    let is_same = |last: &LanguageAnswer| {
        (&last.request.path, &last.request.text) == (&request.path, &request.text)
    };
    if let Some(last) = last.filter(is_same) {
        return LanguageAnswer { request, completions, ..last };
    }
    let analysis = Arc::new(Analysis::new(&name, &request.text, &folder));
    let tokens = tokens(&analysis).into();
    LanguageAnswer { request, analysis, tokens, completions }
}
