//! The conversation with the editor: start, notifications, requests, end.

use std::collections::{BTreeSet, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use sdfc_ide::{Resolver, diagnostics, late_diagnostics};
use serde_json::{Value, json};

use crate::answers::answer;
use crate::client::Client;
use crate::convert::{ACTION_KINDS, TOKEN_MODIFIERS, TOKEN_TYPES, diagnostic};
use crate::documents::{Compile, Disk, Documents};
use crate::lines::{Encoding, Lines};
use crate::preview::{Ask, asked};
use crate::questions::{Draw, Question, Questions, Reply};
use crate::uri::{path, uri};

/// If late diagnostics of a file take longer than this, they wait for a pause.
const LATE: Duration = Duration::from_millis(20);
/// After this long without a message, late diagnostics are looked for.
const PAUSE: Duration = Duration::from_millis(250);
/// The most requests for previews and params that may wait: each has a copy of all open texts.
const MAX_QUESTIONS: usize = 64;

/// Answers an editor until it asks to end.
///
/// # Errors
///
/// The connection fails, or the editor does not keep to the protocol.
pub fn serve(
    connection: &Connection,
    disk: &dyn Disk,
    compiler: &dyn Compile,
    draw: &dyn Draw,
) -> Result<(), String> {
    let (id, params) = connection.initialize_start().map_err(|e| e.to_string())?;
    let client = Client::new(&params);
    let result = json!({
        "capabilities": capabilities(client),
        "serverInfo": { "name": "sdfc", "version": env!("CARGO_PKG_VERSION") },
    });
    connection.initialize_finish(id, result).map_err(|e| e.to_string())?;
    if client.registers_watchers {
        connection.sender.send(watch_scenes()).map_err(|e| e.to_string())?;
    }
    let (questions, waiting) = channel();
    std::thread::scope(|scope| {
        scope.spawn(|| draw.answer_all(&Questions::new(waiting)));
        let mut server = Server {
            connection,
            client,
            documents: Documents::new(folders(&params), disk, compiler),
            disk,
            changed: BTreeSet::new(),
            unfinished: BTreeSet::new(),
            slow: BTreeSet::new(),
            waiting: VecDeque::new(),
            questions,
            replies: Vec::new(),
            revision: 0,
            is_shut_down: false,
        };
        let served = server.run();
        // Whoever draws stops, and then finds no more questions.
        server.cancel(|_| true)?;
        served
    })
}

/// The request for reports of scenes that other programs change.
fn watch_scenes() -> Message {
    let options = json!({ "watchers": [{ "globPattern": "**/*.sdf" }] });
    let method = "workspace/didChangeWatchedFiles";
    let registration = json!({ "id": "scenes", "method": method, "registerOptions": options });
    let params = json!({ "registrations": [registration] });
    let id = RequestId::from("watch scenes".to_owned());
    Message::Request(Request { id, method: "client/registerCapability".to_owned(), params })
}

/// The folders that the editor has open.
fn folders(params: &Value) -> Vec<PathBuf> {
    let listed = params["workspaceFolders"].as_array().into_iter().flatten();
    let mut uris: Vec<&str> = listed.filter_map(|folder| folder["uri"].as_str()).collect();
    if uris.is_empty() {
        uris.extend(params["rootUri"].as_str());
    }
    uris.into_iter().map(path).collect()
}

fn capabilities(client: Client) -> Value {
    json!({
        "positionEncoding": match client.encoding {
            Encoding::Utf8 => "utf-8",
            Encoding::Utf16 => "utf-16",
        },
        "textDocumentSync": { "openClose": true, "change": 2, "save": true },
        "completionProvider": { "triggerCharacters": [".", "\"", ":"] },
        "hoverProvider": true,
        "signatureHelpProvider": { "triggerCharacters": ["(", ","] },
        "definitionProvider": true,
        "referencesProvider": true,
        "documentHighlightProvider": true,
        "documentSymbolProvider": true,
        "workspaceSymbolProvider": true,
        "codeLensProvider": {},
        "codeActionProvider": { "codeActionKinds": ACTION_KINDS },
        "documentFormattingProvider": true,
        "renameProvider": { "prepareProvider": true },
        "foldingRangeProvider": true,
        "selectionRangeProvider": true,
        "colorProvider": true,
        "inlayHintProvider": true,
        "semanticTokensProvider": {
            "legend": { "tokenTypes": TOKEN_TYPES, "tokenModifiers": TOKEN_MODIFIERS },
            "full": true,
        },
        "experimental": { "sdfc/params": true, "sdfc/preview": true },
    })
}

struct Server<'c, 'd> {
    connection: &'c Connection,
    client: Client,
    documents: Documents<'d>,
    disk: &'d dyn Disk,
    /// The files whose diagnostics have to be sent again.
    changed: BTreeSet<PathBuf>,
    /// The files whose late diagnostics were not sent yet.
    unfinished: BTreeSet<PathBuf>,
    /// The files whose late diagnostics took long when they were last looked for.
    slow: BTreeSet<PathBuf>,
    /// Messages that have arrived, in order.
    waiting: VecDeque<Message>,
    /// The questions for another thread.
    questions: Sender<Question<'c>>,
    /// The questions that may have no answer yet.
    replies: Vec<Reply>,
    /// The number of notifications that may have changed a text.
    revision: u64,
    /// True after the request `shutdown`.
    is_shut_down: bool,
}

impl<'c> Server<'c, 'c> {
    /// Handles messages until the end. Diagnostics are sent when no message waits, so that fast
    /// typing does not queue them up.
    fn run(&mut self) -> Result<(), String> {
        loop {
            self.waiting.extend(self.connection.receiver.try_iter());
            if self.waiting.is_empty() {
                self.publish()?;
                let pause = if self.unfinished.is_empty() { Duration::MAX } else { PAUSE };
                match self.connection.receiver.recv_timeout(pause) {
                    Ok(message) => self.waiting.push_back(message),
                    Err(error) if error.is_timeout() => self.finish()?,
                    Err(_disconnected) => return Ok(()),
                }
                continue;
            }
            let Some(message) = self.waiting.pop_front() else { continue };
            match message {
                Message::Request(request) => self.request(request)?,
                Message::Notification(it) if it.method == "exit" => return Ok(()),
                Message::Notification(_) if self.is_shut_down => {}
                Message::Notification(notification) => self.notification(&notification)?,
                Message::Response(_) => {}
            }
        }
    }

    /// Ends the work. The editor sends `exit` next, which may wait in the queue already.
    fn shut_down(&mut self) {
        self.is_shut_down = true;
        self.changed.clear();
        self.unfinished.clear();
    }

    fn request(&mut self, request: Request) -> Result<(), String> {
        let id = json!(request.id);
        let cancels = |message: &Message| match message {
            Message::Notification(it) => it.method == "$/cancelRequest" && it.params["id"] == id,
            Message::Request(_) | Message::Response(_) => false,
        };
        let response = if self.waiting.iter().any(cancels) {
            let code = ErrorCode::RequestCanceled as i32;
            Response::new_err(request.id, code, "cancelled".to_owned())
        } else if self.is_shut_down {
            let message = "the server was asked to shut down".to_owned();
            Response::new_err(request.id, ErrorCode::InvalidRequest as i32, message)
        } else if request.method == "shutdown" {
            self.shut_down();
            Response::new_ok(request.id, Value::Null)
        } else if let Some(ask) = asked(&request.method, &request.params) {
            match ask.and_then(|ask| self.question(&request, ask)) {
                Ok(()) => return Ok(()),
                Err(why) => Response::new_err(request.id, ErrorCode::RequestFailed as i32, why),
            }
        } else {
            match answer(&mut self.documents, self.client, &request.method, &request.params) {
                None => {
                    let message = format!("there is no method `{}`", request.method);
                    Response::new_err(request.id, ErrorCode::MethodNotFound as i32, message)
                }
                Some(Ok(value)) => Response::new_ok(request.id, value),
                Some(Err(why)) => {
                    Response::new_err(request.id, ErrorCode::RequestFailed as i32, why)
                }
            }
        };
        self.send(Message::Response(response))
    }

    /// Passes a question to the thread that draws.
    fn question(&mut self, request: &Request, ask: Ask) -> Result<(), String> {
        let file = path(request.params["textDocument"]["uri"].as_str().unwrap_or_default());
        let text = self.documents.text(&file);
        let text = text.ok_or_else(|| format!("{} cannot be read", file.display()))?;
        let reply = Reply::new(request.id.clone());
        self.replies.retain(|reply| !reply.is_answered());
        if self.replies.len() >= MAX_QUESTIONS {
            return Err(format!("{MAX_QUESTIONS} requests for previews and params wait already"));
        }
        self.replies.push(reply.clone());
        let question = Question {
            ask,
            name: file.display().to_string(),
            text,
            revision: self.revision,
            open: self.documents.open().clone(),
            root: self.documents.root(&file),
            disk: self.disk,
            connection: self.connection,
            reply,
        };
        self.questions.send(question).map_err(|_gone| "the thread that draws has ended".to_owned())
    }

    /// Answers the questions that `which` is true of, if they have no answer yet.
    fn cancel(&self, which: impl Fn(&Reply) -> bool) -> Result<(), String> {
        for reply in self.replies.iter().filter(|reply| which(reply)) {
            if let Some(response) = reply.cancelled() {
                self.send(Message::Response(response))?;
            }
        }
        Ok(())
    }

    fn notification(&mut self, it: &Notification) -> Result<(), String> {
        if it.method == "$/cancelRequest" {
            let id = serde_json::from_value::<RequestId>(it.params["id"].clone());
            return id.map_or(Ok(()), |id| self.cancel(|reply| reply.is_to(&id)));
        }
        self.revision += 1;
        let document = &it.params["textDocument"];
        let file = path(document["uri"].as_str().unwrap_or_default());
        match it.method.as_str() {
            "textDocument/didOpen" => {
                let text = document["text"].as_str().unwrap_or_default().to_owned();
                self.documents.set(&file, text);
                self.touch();
            }
            "textDocument/didChange" => {
                let changes = &it.params["contentChanges"];
                self.documents.change(&file, changes, self.client.encoding);
                self.touch();
            }
            "textDocument/didClose" => {
                self.documents.close(&file);
                self.changed.insert(file);
                self.touch();
            }
            "workspace/didChangeWatchedFiles" | "textDocument/didSave" => {
                self.documents.forget_all();
                self.touch();
            }
            _ => {}
        }
        Ok(())
    }

    /// Marks all open files: each may import the one that changed.
    fn touch(&mut self) {
        self.changed.extend(self.documents.paths());
    }

    /// Sends the diagnostics of the files that changed. For a file whose late diagnostics take
    /// long, it sends the others only.
    fn publish(&mut self) -> Result<(), String> {
        for file in std::mem::take(&mut self.changed) {
            let is_slow = self.slow.contains(&file);
            self.publish_file(&file, !is_slow)?;
            if is_slow {
                self.unfinished.insert(file);
            }
        }
        Ok(())
    }

    /// Sends the diagnostics that wait for a pause.
    fn finish(&mut self) -> Result<(), String> {
        for file in std::mem::take(&mut self.unfinished) {
            self.publish_file(&file, true)?;
        }
        Ok(())
    }

    fn publish_file(&mut self, file: &Path, with_late: bool) -> Result<(), String> {
        let found = self.diagnostics(file, with_late);
        let params = json!({ "uri": uri(file), "diagnostics": found });
        let method = "textDocument/publishDiagnostics".to_owned();
        self.send(Message::Notification(Notification { method, params }))
    }

    fn diagnostics(&mut self, file: &Path, with_late: bool) -> Value {
        if !self.documents.is_open(file) {
            return json!([]);
        }
        let Some(scene) = self.documents.analysis(file) else { return json!([]) };
        let encoding = self.client.encoding;
        let lines = Lines::new(scene.text(), encoding);
        let mut found = diagnostics(&scene, self.documents.is_imported(file));
        if with_late {
            let start = Instant::now();
            let late = |resolver: &dyn Resolver| late_diagnostics(&scene, resolver);
            found.extend(self.documents.with_resolver(file, late));
            match start.elapsed() > LATE {
                true => self.slow.insert(file.to_owned()),
                false => self.slow.remove(file),
            };
        }
        let shown =
            found.iter().map(|it| diagnostic(&self.documents, &scene, &lines, it, encoding));
        shown.collect()
    }

    fn send(&self, message: Message) -> Result<(), String> {
        self.connection.sender.send(message).map_err(|e| e.to_string())
    }
}
