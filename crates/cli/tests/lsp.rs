//! `sdfc lsp` over pipes, as an editor runs it.
#![allow(missing_docs, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde_json::{Value, json};

/// An editor that talks to the server.
struct Editor {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    requests: u64,
    diagnostics: Vec<Value>,
}

impl Editor {
    fn start(folder: &Path, encodings: Value) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_sdfc"))
            .arg("lsp")
            .env("XDG_CACHE_HOME", folder.join(".cache"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let to = child.stdin.take().unwrap();
        let from = BufReader::new(child.stdout.take().unwrap());
        let mut editor = Self { child, to, from, requests: 0, diagnostics: Vec::new() };
        let completion = json!({ "completionItem": { "snippetSupport": true } });
        let capabilities = json!({
            "general": { "positionEncodings": encodings },
            "textDocument": { "completion": completion },
        });
        let started = editor.ask(
            "initialize",
            json!({
                "capabilities": capabilities,
                "rootUri": format!("file://{}", folder.display()),
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

    fn notify(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    fn receive(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            self.from.read_line(&mut line).unwrap();
            if line.trim().is_empty() {
                break;
            }
            if let Some(number) = line.strip_prefix("Content-Length: ") {
                length = number.trim().parse().unwrap();
            }
        }
        let mut bytes = vec![0; length];
        self.from.read_exact(&mut bytes).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    /// Sends a request and returns the whole answer.
    fn answer(&mut self, method: &str, params: Value) -> Value {
        self.requests += 1;
        let id = self.requests;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        loop {
            let message = self.receive();
            if message["id"] == json!(id) {
                return message;
            }
            self.diagnostics.push(message["params"].clone());
        }
    }

    fn ask(&mut self, method: &str, params: Value) -> Value {
        let answer = self.answer(method, params);
        assert!(answer["error"].is_null(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// Waits for the next diagnostics of a file.
    fn diagnostics(&mut self, uri: &str) -> Value {
        loop {
            if let Some(at) = self.diagnostics.iter().position(|it| it["uri"] == uri) {
                return self.diagnostics.remove(at)["diagnostics"].clone();
            }
            let message = self.receive();
            self.diagnostics.push(message["params"].clone());
        }
    }

    fn open(&mut self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "sdf", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    fn at(uri: &str, line: u32, character: u32) -> Value {
        json!({
            "textDocument": { "uri": uri },
            "position": { "line": line, "character": character },
        })
    }

    fn end(mut self) {
        self.ask("shutdown", Value::Null);
        self.notify("exit", Value::Null);
        assert!(self.child.wait().unwrap().success());
    }
}

#[test]
fn an_editor_is_served_from_start_to_end() {
    let folder = common::folder(&[("part.sdf", "solid part(r: length = 1) = length(p) - r\n")]);
    let mut editor = Editor::start(folder.path(), json!(["utf-16"]));
    let uri = format!("file://{}/main.sdf", folder.path().display());
    editor.open(&uri, "import part from \"part.sdf\"\n// 😀\nspere(1) | part()\n");
    let found = editor.diagnostics(&uri);
    assert_eq!(found[0]["code"], "E0201");
    assert_eq!(found[0]["range"]["end"], json!({ "line": 2, "character": 5 }));
    let range = found[0]["range"].clone();
    let document = json!({ "uri": uri });
    let params = json!({ "textDocument": document, "range": range, "context": {} });
    let actions = editor.ask("textDocument/codeAction", params);
    assert_eq!(actions[0]["edit"]["changes"][&uri][0]["newText"], "sphere");
    let change = json!([{ "range": range, "text": "sphere" }]);
    editor.notify(
        "textDocument/didChange",
        json!({ "textDocument": { "uri": uri, "version": 2 }, "contentChanges": change }),
    );
    assert_eq!(editor.diagnostics(&uri), json!([]));
    let list = editor.ask("textDocument/completion", Editor::at(&uri, 2, 13));
    assert!(list.as_array().unwrap().iter().any(|it| it["label"] == "part"), "{list}");
    let hover = editor.ask("textDocument/hover", Editor::at(&uri, 2, 2));
    assert!(hover["contents"]["value"].as_str().unwrap().contains("solid sphere("), "{hover}");
    assert!(hover["contents"]["value"].as_str().unwrap().contains("Here: exact;"), "{hover}");
    let document = json!({ "textDocument": { "uri": uri } });
    let lenses = editor.ask("textDocument/codeLens", document);
    let title = lenses[0]["command"]["title"].as_str().unwrap();
    assert!(title.ends_with("operations, 100 % of the scene"), "{title}");
    let found = editor.ask("workspace/symbol", json!({ "query": "PAR" }));
    assert_eq!(
        (&found[0]["name"], found.as_array().unwrap().len()),
        (&"part".into(), 1),
        "{found}"
    );
    let declared = editor.ask("textDocument/definition", Editor::at(&uri, 2, 2));
    let library = declared["uri"].as_str().unwrap().strip_prefix("file://").unwrap();
    assert!(std::fs::read_to_string(library).unwrap().contains("solid sphere("));
    let mut rename = Editor::at(&uri, 2, 13);
    rename["newName"] = json!("knob");
    let edit = editor.ask("textDocument/rename", rename.clone());
    assert_eq!(edit["changes"].as_object().unwrap().len(), 2, "{edit}");
    rename["newName"] = json!("solid");
    let refused = editor.answer("textDocument/rename", rename);
    assert!(refused["error"]["message"].as_str().unwrap().contains("reserved"));
    for method in ["documentSymbol", "foldingRange", "documentColor", "semanticTokens/full"] {
        let params = json!({ "textDocument": { "uri": uri } });
        let answer = editor.ask(&format!("textDocument/{method}"), params);
        assert!(answer.is_array() || answer["data"].is_array(), "{method}: {answer}");
    }
    // A file that is open counts with its text, and when it is closed the file on disk does.
    let part = format!("file://{}/part.sdf", folder.path().display());
    editor.open(&part, "let unused = 1\n");
    assert_eq!(editor.diagnostics(&uri)[0]["code"], "E0209");
    assert_ne!(editor.diagnostics(&part), json!([]));
    editor.notify("textDocument/didClose", json!({ "textDocument": { "uri": part } }));
    assert_eq!(editor.diagnostics(&uri), json!([]));
    assert_eq!(editor.diagnostics(&part), json!([]));
    let unknown = editor.answer("textDocument/unknown", Editor::at(&uri, 0, 0));
    assert_eq!(unknown["error"]["code"], -32601);
    editor.end();
}

#[test]
fn columns_are_bytes_for_an_editor_that_prefers_them() {
    let folder = common::folder(&[]);
    let mut editor = Editor::start(folder.path(), json!(["utf-8", "utf-16"]));
    let uri = format!("file://{}/main.sdf", folder.path().display());
    editor.open(&uri, "/// é 😀\nlet a = [\"é\", b]\nsphere(1)\n");
    let found = editor.diagnostics(&uri);
    let unknown = found.as_array().unwrap().iter().find(|it| it["code"] == "E0201").unwrap();
    assert_eq!(unknown["range"]["start"], json!({ "line": 1, "character": 15 }));
    editor.end();
}
