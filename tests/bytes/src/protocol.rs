//! Messages of an editor to the language server.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use lsp_server::{Message, Notification, Request, RequestId};
use sdfc_lsp::{Compile, Compiled, Connection, Disk, Draw, Questions, Resolver, serve};
use serde_json::{Value, json};

use crate::parts;

const URI: &str = "file:///scene.sdf";
/// The largest number of messages after the text is opened.
const MAX_MESSAGES: usize = 16;
/// The methods that an editor calls.
const METHODS: &[&str] = &[
    "textDocument/hover",
    "textDocument/completion",
    "textDocument/definition",
    "textDocument/references",
    "textDocument/documentSymbol",
    "textDocument/formatting",
    "textDocument/rename",
    "textDocument/prepareRename",
    "textDocument/codeAction",
    "textDocument/signatureHelp",
    "textDocument/inlayHint",
    "textDocument/foldingRange",
    "textDocument/selectionRange",
    "textDocument/semanticTokens/full",
    "textDocument/documentColor",
    "textDocument/colorPresentation",
    "textDocument/codeLens",
    "textDocument/documentHighlight",
    "textDocument/unknown",
    "workspace/symbol",
    "sdfc/preview",
    "sdfc/params",
];

/// Opens a text and sends messages. The first part is the text, and each other part is a message,
/// see [`message`]. Every request must get one response.
pub fn lsp(bytes: &[u8]) {
    let mut parts = parts(bytes);
    let text = String::from_utf8_lossy(parts.next().unwrap_or_default());
    let mut messages = vec![
        request(0, "initialize", json!({"capabilities": {}, "rootUri": "file:///"})),
        notification("initialized", json!({})),
        notification(
            "textDocument/didOpen",
            json!({"textDocument": {"uri": URI, "languageId": "sdf", "version": 1, "text": text}}),
        ),
    ];
    messages.extend((1..).zip(parts.take(MAX_MESSAGES)).map(|(id, part)| message(id, part)));
    messages.push(request(i32::MAX, "shutdown", Value::Null));
    messages.push(notification("exit", Value::Null));
    let requests: BTreeSet<RequestId> = messages.iter().filter_map(request_id).collect();
    let (server, editor) = Connection::memory();
    for message in messages {
        editor.sender.send(message).expect("the server listens");
    }
    serve(&server, &Nothing, &Nothing, &Nothing).expect("the messages keep to the protocol");
    let responses: Vec<RequestId> = editor.receiver.try_iter().filter_map(response_id).collect();
    assert_eq!(responses.len(), requests.len(), "{responses:?}");
    assert_eq!(responses.into_iter().collect::<BTreeSet<_>>(), requests);
}

fn request(id: i32, method: &str, params: Value) -> Message {
    Request::new(RequestId::from(id), method.to_owned(), params).into()
}

fn notification(method: &str, params: Value) -> Message {
    Notification::new(method.to_owned(), params).into()
}

fn request_id(message: &Message) -> Option<RequestId> {
    match message {
        Message::Request(request) => Some(request.id.clone()),
        Message::Response(_) | Message::Notification(_) => None,
    }
}

fn response_id(message: Message) -> Option<RequestId> {
    match message {
        Message::Response(response) => Some(response.id),
        Message::Request(_) | Message::Notification(_) => None,
    }
}

/// Returns the message of a part. The first byte selects a change of the text, a request at a
/// place, or a method whose parameters are the other bytes, as JSON.
fn message(id: i32, part: &[u8]) -> Message {
    match part {
        [0, line, column, text @ ..] => change(id, *line, *column, text),
        [1, method, line, column, ..] => request(id, named(*method), at(*line, *column)),
        [method, params @ ..] => {
            request(id, named(*method), serde_json::from_slice(params).unwrap_or_default())
        }
        [] => request(id, METHODS[0], Value::Null),
    }
}

fn named(method: u8) -> &'static str {
    METHODS[usize::from(method) % METHODS.len()]
}

/// A text in place of the characters from a column to one that is the first byte of the text.
fn change(id: i32, line: u8, column: u8, text: &[u8]) -> Message {
    let end = text.first().copied().unwrap_or(column);
    let range = json!({
        "start": {"line": line, "character": column},
        "end": {"line": line, "character": end},
    });
    let text = String::from_utf8_lossy(text);
    let params = json!({
        "textDocument": {"uri": URI, "version": id + 1},
        "contentChanges": [{"range": range, "text": text}],
    });
    notification("textDocument/didChange", params)
}

/// The parameters of all methods, at a place.
fn at(line: u8, column: u8) -> Value {
    let position = json!({"line": line, "character": column});
    json!({
        "textDocument": {"uri": URI},
        "position": position,
        "positions": [position],
        "range": {"start": position, "end": position},
        "context": {"includeDeclaration": true, "diagnostics": []},
        "newName": "a",
        "query": "a",
        "options": {"tabSize": 4, "insertSpaces": true},
        "color": {"red": 1, "green": 0.5, "blue": 0, "alpha": 1},
        "size": [8, 8],
    })
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
