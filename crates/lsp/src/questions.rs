//! Questions that take long: they wait for a thread of their own, so that typing does not.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;

use lsp_server::{Connection, ErrorCode, Message, RequestId, Response};
use sdfc_ide::Resolver;

use crate::documents::{Disk, resolver};
use crate::preview::{Answer, Ask};

/// The part of the program that draws pictures and lists params, on a thread of its own.
pub trait Draw: Sync {
    /// Answers questions until there are no more.
    fn answer_all(&self, questions: &Questions<'_>);
}

/// The questions that wait for an answer.
pub struct Questions<'d> {
    waiting: Receiver<Question<'d>>,
}

impl<'d> Questions<'d> {
    pub(crate) fn new(waiting: Receiver<Question<'d>>) -> Self {
        Self { waiting }
    }

    /// Waits for the next question that is not cancelled. `None` if the editor ends.
    pub fn next(&self) -> Option<Question<'d>> {
        self.waiting.iter().find(|question| !question.is_cancelled())
    }
}

/// The sender of the answer to a question. Its first user answers, so that a question which is
/// cancelled while it is answered gets one answer.
#[derive(Clone)]
pub(crate) struct Reply {
    id: RequestId,
    answered: Arc<AtomicBool>,
}

impl Reply {
    pub fn new(id: RequestId) -> Self {
        Self { id, answered: Arc::default() }
    }

    pub fn is_to(&self, id: &RequestId) -> bool {
        self.id == *id
    }

    pub fn is_answered(&self) -> bool {
        self.answered.load(Ordering::Relaxed)
    }

    /// The response to send; `None` if there was one already.
    pub fn response(&self, answer: Result<Answer, String>) -> Option<Response> {
        let id = self.first()?;
        Some(match answer {
            Ok(answer) => Response::new_ok(id, answer.to_json()),
            Err(why) => Response::new_err(id, ErrorCode::RequestFailed as i32, why),
        })
    }

    /// The response that the question was cancelled; `None` if there was one already.
    pub fn cancelled(&self) -> Option<Response> {
        let code = ErrorCode::RequestCanceled as i32;
        Some(Response::new_err(self.first()?, code, "cancelled".to_owned()))
    }

    fn first(&self) -> Option<RequestId> {
        (!self.answered.swap(true, Ordering::Relaxed)).then(|| self.id.clone())
    }
}

/// A question about a scene, with the texts as they were when it was asked.
pub struct Question<'d> {
    /// The request.
    pub ask: Ask,
    /// The name of the scene's file.
    pub name: String,
    /// The text of the scene.
    pub text: String,
    /// A number that changes with every change of any file. Two questions with the same name and
    /// revision are about the same scene.
    pub revision: u64,
    pub(crate) open: BTreeMap<PathBuf, String>,
    /// The folder that the imports of the scene stay in.
    pub(crate) root: PathBuf,
    pub(crate) disk: &'d dyn Disk,
    pub(crate) connection: &'d Connection,
    pub(crate) reply: Reply,
}

impl Question<'_> {
    /// True if the answer is not needed any more.
    pub fn is_cancelled(&self) -> bool {
        self.reply.is_answered()
    }

    /// Runs a function with the resolver for the imports of the scene.
    pub fn with_resolver<T>(&self, run: impl FnOnce(&dyn Resolver) -> T) -> T {
        run(&resolver(&self.root, self.name.as_ref(), &self.open, self.disk))
    }

    /// Sends the answer, unless the question was cancelled.
    pub fn answer(&self, answer: Result<Answer, String>) {
        if let Some(response) = self.reply.response(answer) {
            // This fails only if the editor has gone.
            let _gone = self.connection.sender.send(Message::Response(response));
        }
    }
}
