//! An editor that talks to `sdfc lsp` over pipes.

#![allow(dead_code, reason = "not every test needs all of it")]

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// How long an editor waits for a message. A server that does not answer fails the test.
const DEADLINE: Duration = Duration::from_secs(120);

/// An editor that talks to the server.
pub struct Editor {
    child: Child,
    to: ChildStdin,
    from: Receiver<Value>,
    requests: u64,
    diagnostics: Vec<Value>,
    /// The methods that the server has registered for.
    pub registered: Vec<String>,
}

impl Editor {
    /// Starts the server for a folder. Its shared modules are in `.modules`. Hovers have pictures.
    pub fn start(folder: &Path, encodings: Value) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_sdfc"))
            .args(["lsp", "--stdio"])
            .env("XDG_CACHE_HOME", folder.join(".cache"))
            .env("SDFC_PATH", folder.join(".modules"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let to = child.stdin.take().unwrap();
        let from = messages(BufReader::new(child.stdout.take().unwrap()));
        let (requests, diagnostics, registered) = Default::default();
        let mut editor = Self { child, to, from, requests, diagnostics, registered };
        let completion = json!({ "completionItem": { "snippetSupport": true } });
        let capabilities = json!({
            "general": { "positionEncodings": encodings },
            "textDocument": { "completion": completion },
            "workspace": { "didChangeWatchedFiles": { "dynamicRegistration": true } },
        });
        let started = editor.ask(
            "initialize",
            json!({
                "capabilities": capabilities,
                "rootUri": format!("file://{}", folder.display()),
                "initializationOptions": { "hoverPictures": true },
            }),
        );
        assert_eq!(started["serverInfo"]["name"], "sdfc");
        editor.notify("initialized", json!({}));
        editor
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        write!(self.to, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        self.to.flush().unwrap();
    }

    /// Sends a notification.
    pub fn notify(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// Waits for the next message. Requests of the server are answered.
    fn receive(&mut self) -> Value {
        loop {
            let message = self.from.recv_timeout(DEADLINE).unwrap_or_else(|why| {
                // Dropping the process would leave it running.
                let _ended = self.child.kill();
                panic!("no message from the server: {why}")
            });
            if message["method"] != "client/registerCapability" {
                return message;
            }
            let registrations = message["params"]["registrations"].as_array().unwrap();
            let methods = registrations.iter().map(|it| it["method"].as_str().unwrap().to_owned());
            self.registered.extend(methods);
            self.send(&json!({ "jsonrpc": "2.0", "id": message["id"], "result": null }));
        }
    }

    /// Sends a request and returns the whole answer.
    pub fn answer(&mut self, method: &str, params: Value) -> Value {
        let id = self.request(method, params);
        self.answer_to(id)
    }

    /// Sends a request and returns its number, without waiting for the answer.
    pub fn request(&mut self, method: &str, params: Value) -> u64 {
        self.requests += 1;
        let id = self.requests;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        id
    }

    /// Waits for the answer to a request. Those to others are dropped.
    pub fn answer_to(&mut self, id: u64) -> Value {
        loop {
            let message = self.receive();
            if message["id"] == json!(id) {
                return message;
            }
            self.diagnostics.push(message["params"].clone());
        }
    }

    /// Waits for the next answer to any request.
    pub fn next_answer(&mut self) -> Value {
        loop {
            let message = self.receive();
            if !message["id"].is_null() {
                return message;
            }
        }
    }

    /// Sends a request and returns the result of its answer.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let answer = self.answer(method, params);
        assert!(answer["error"].is_null(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// Waits for the next diagnostics of a file.
    pub fn diagnostics(&mut self, uri: &str) -> Value {
        loop {
            if let Some(at) = self.diagnostics.iter().position(|it| it["uri"] == uri) {
                return self.diagnostics.remove(at)["diagnostics"].clone();
            }
            let message = self.receive();
            self.diagnostics.push(message["params"].clone());
        }
    }

    /// Opens a file with a text.
    pub fn open(&mut self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "sdf", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// The params of a request about a position.
    pub fn at(uri: &str, line: u32, character: u32) -> Value {
        json!({
            "textDocument": { "uri": uri },
            "position": { "line": line, "character": character },
        })
    }

    /// The number of the server's process.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Forgets the diagnostics that nobody has waited for.
    pub fn forget_diagnostics(&mut self) {
        self.diagnostics.clear();
    }

    /// Ends the server, as an editor does.
    pub fn end(mut self) {
        self.ask("shutdown", Value::Null);
        self.notify("exit", Value::Null);
        let end = Instant::now() + DEADLINE;
        while self.child.try_wait().unwrap().is_none() {
            if Instant::now() > end {
                self.child.kill().unwrap();
                panic!("the server does not end");
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        assert!(self.child.wait().unwrap().success());
    }
}

/// Reads messages on a thread, so that waiting for one can end.
fn messages(mut from: BufReader<ChildStdout>) -> Receiver<Value> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        while let Some(message) = message(&mut from) {
            if sender.send(message).is_err() {
                return;
            }
        }
    });
    receiver
}

/// The next message; `None` at the end of the stream.
fn message(from: &mut impl BufRead) -> Option<Value> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if from.read_line(&mut line).ok()? == 0 {
            return None;
        }
        if line.trim().is_empty() {
            break;
        }
        if let Some(number) = line.strip_prefix("Content-Length: ") {
            length = number.trim().parse().unwrap();
        }
    }
    let mut bytes = vec![0; length];
    from.read_exact(&mut bytes).ok()?;
    serde_json::from_slice(&bytes).ok()
}
