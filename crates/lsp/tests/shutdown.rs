//! The end of a conversation.
#![allow(missing_docs, clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use sdfc_lsp::{Compile, Compiled, Connection, Disk, Draw, Questions, Resolver, serve};
use serde_json::{Value, json};

fn request(id: i32, method: &str, params: Value) -> Message {
    Request::new(RequestId::from(id), method.to_owned(), params).into()
}

fn notification(method: &str) -> Message {
    Notification::new(method.to_owned(), json!({})).into()
}

/// Returns the responses to messages that are all sent before the first response.
fn responses(messages: Vec<Message>) -> Vec<Response> {
    let (server, editor) = Connection::memory();
    let initialize = request(0, "initialize", json!({ "capabilities": {} }));
    for message in [initialize, notification("initialized")].into_iter().chain(messages) {
        editor.sender.send(message).unwrap();
    }
    serve(&server, &Nothing, &Nothing, &Nothing).unwrap();
    let responses = editor.receiver.try_iter().filter_map(|message| match message {
        Message::Response(response) => Some(response),
        Message::Request(_) | Message::Notification(_) => None,
    });
    responses.skip(1).collect()
}

/// An editor that does not wait for the response to `shutdown` waits for nothing.
#[test]
fn an_exit_behind_a_shutdown_ends_the_server_at_once() {
    let start = Instant::now();
    let responses = responses(vec![request(1, "shutdown", Value::Null), notification("exit")]);
    assert_eq!(responses.len(), 1);
    assert!(responses[0].response_result.is_ok(), "{responses:?}");
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}

#[test]
fn after_a_shutdown_requests_are_refused() {
    let responses = responses(vec![
        request(1, "shutdown", Value::Null),
        request(2, "workspace/symbol", json!({ "query": "" })),
        notification("textDocument/didSave"),
        notification("exit"),
    ]);
    let code = |response: &Response| response.response_result.as_ref().err().map(|e| e.code);
    let codes: Vec<_> = responses.iter().map(code).collect();
    assert_eq!(codes, [None, Some(ErrorCode::InvalidRequest as i32)]);
}

/// No files, no compiler and no pictures.
struct Nothing;

impl Disk for Nothing {
    fn read(&self, _: &Path) -> Result<String, String> {
        Err("no files".to_owned())
    }

    fn read_bytes(&self, _: &Path) -> Result<Vec<u8>, String> {
        Err("no files".to_owned())
    }

    fn scenes(&self, _: &Path) -> Vec<PathBuf> {
        Vec::new()
    }

    fn scenes_in(&self, _: &Path) -> Vec<PathBuf> {
        Vec::new()
    }

    fn library(&self) -> Option<PathBuf> {
        None
    }
}

impl Compile for Nothing {
    fn compile(&self, _: &str, _: &str, _: &dyn Resolver) -> Option<Box<dyn Compiled>> {
        None
    }

    fn picture(&self, _: &str, _: &str) -> Option<Vec<u8>> {
        None
    }
}

impl Draw for Nothing {
    fn answer_all(&self, questions: &Questions<'_>) {
        while let Some(question) = questions.next() {
            question.answer(Err("no pictures".to_owned()));
        }
    }
}
