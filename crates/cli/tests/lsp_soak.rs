//! An editor that types into six scenes for a long time, and asks what editors ask. The server
//! draws previews to the end, and its memory, threads and open files have not grown.
//!
//! ```text
//! SDFC_SOAK_MINUTES=60 cargo test -p sdfc-cli --test lsp_soak -- --nocapture
//! ```
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test fails by panicking, and people read the samples"
)]

mod common;
#[path = "common/editor.rs"]
mod editor;

use std::path::Path;
use std::time::{Duration, Instant};

use sdfc_test_support::{Resources, example_sources};
use serde_json::{Value, json};

use editor::Editor;

/// The number of rounds if `SDFC_SOAK_MINUTES` is not set.
const DEFAULT_ROUNDS: u64 = 24;
/// Rounds between two measurements.
const BATCH: u64 = 4;
/// A scene and its import, which are edited and written.
const OWN: [(&str, &str); 2] = [
    ("main.sdf", "import knob from \"parts/knob.sdf\"\nknob(1) | sphere(0.5)\n"),
    ("parts/knob.sdf", KNOB),
];
const KNOB: &str = "/// A knob.\nsolid knob(r: length = 1) = length(p) - r\n";
/// The examples that are edited.
const EXAMPLES: [&str; 4] =
    ["params.sdf", "course/blend.sdf", "bench/thirty.sdf", "gallery/harbour.sdf"];
/// Lines that are typed. Some have errors when they are complete, all have some before.
const LINES: [&str; 6] = [
    "sphere(0.2).translate(x: 2)\n",
    "let added = box([1, 2, 3]).round(0.1)\n",
    "union(for i in 0..9: sphere(0.1).translate([i, 0, 0]))\n",
    "spere(1) | box(\n",
    "solid own(r: length = 1) = length(p) - r\n",
    "torus(1, 0.2).color(#f80).repeat(spacing: 4) & box(9)\n",
];
/// Questions about a whole file.
const OF_FILE: [&str; 6] = [
    "documentSymbol",
    "foldingRange",
    "documentColor",
    "semanticTokens/full",
    "codeLens",
    "formatting",
];
/// Questions about a position.
const OF_POSITION: [&str; 6] =
    ["hover", "definition", "references", "signatureHelp", "documentHighlight", "completion"];

#[test]
fn an_hour_of_typing_leaks_no_memory_threads_or_files() {
    let minutes: Option<f64> =
        std::env::var("SDFC_SOAK_MINUTES").ok().and_then(|minutes| minutes.parse().ok());
    let folder = common::folder(&OWN);
    let mut desk = Desk::new(folder.path());
    let start = Instant::now();
    let is_over = |round| match minutes {
        Some(minutes) => start.elapsed() > Duration::from_secs_f64(60.0 * minutes),
        None => round == DEFAULT_ROUNDS,
    };
    let process = desk.editor.process().to_string();
    let (mut samples, mut shown) = (Vec::new(), None);
    println!("| minutes | edits | answers | memory in MiB | threads | open files |");
    println!("|---|---|---|---|---|---|");
    for round in (0..).take_while(|round| !is_over(*round)) {
        desk.round(round);
        if round % BATCH == BATCH - 1 {
            desk.settle();
            let sample = Resources::of(&process);
            samples.push(sample);
            let minute = start.elapsed().as_secs() / 60;
            if shown.replace(minute) != Some(minute) {
                let (edits, answers) = (desk.edits, desk.answers);
                let Resources { memory, threads, files } = sample;
                println!("| {minute} | {edits} | {answers} | {memory} | {threads} | {files} |");
            }
        }
    }
    Resources::have_not_grown(&samples).unwrap();
    desk.editor.end();
}

/// An open file.
struct Opened {
    uri: String,
    text: String,
    version: u64,
}

/// An editor with open files.
struct Desk<'f> {
    editor: Editor,
    folder: &'f Path,
    files: Vec<Opened>,
    edits: u64,
    answers: u64,
}

impl<'f> Desk<'f> {
    fn new(folder: &'f Path) -> Self {
        let examples = example_sources().unwrap();
        let copied = EXAMPLES.map(|name| {
            let (_, text) = examples.iter().find(|(example, _)| example == name).unwrap();
            (name.replace('/', "-"), text.clone())
        });
        let own = OWN.map(|(name, text)| (name.to_owned(), text.to_owned()));
        let mut editor = Editor::start(folder, json!(["utf-16"]));
        let mut files = Vec::new();
        for (name, text) in own.into_iter().chain(copied) {
            let path = folder.join(name);
            let uri = format!("file://{}", path.display());
            editor.open(&uri, &text);
            files.push(Opened { uri, text, version: 1 });
        }
        Self { editor, folder, files, edits: 0, answers: 0 }
    }

    /// Types a line into a file and deletes it again, with questions in between.
    fn round(&mut self, round: u64) {
        let file = pick(round, self.files.len());
        let line = LINES[pick(round / 2, LINES.len())];
        let count = self.files[file].text.lines().count();
        let at = (pick(round / 3, count + 1)) as u32;
        for (column, letter) in line.chars().enumerate() {
            self.replace(file, (at, column as u32), (at, column as u32), &letter.to_string());
            self.ask(file, "completion", (at, column as u32 + 1));
        }
        for (question, method) in OF_FILE.iter().enumerate() {
            self.ask(file, method, (0, 0));
            let place = (pick(round + question as u64, count + 1) as u32, 3);
            self.ask(file, OF_POSITION[question], place);
        }
        if round % 5 == 1 {
            self.preview(file, round);
        }
        self.replace(file, (at, 0), (at + 1, 0), "");
        match round % 7 {
            2 => self.save_import(round),
            4 => self.reopen(file),
            5 => self.rename(),
            _ => {}
        }
        self.editor.forget_diagnostics();
    }

    /// Replaces a part of a file. The columns are those of ASCII.
    fn replace(&mut self, file: usize, from: (u32, u32), to: (u32, u32), text: &str) {
        let file = &mut self.files[file];
        file.version += 1;
        let position = |(line, character)| json!({ "line": line, "character": character });
        let range = json!({ "start": position(from), "end": position(to) });
        let params = json!({
            "textDocument": { "uri": file.uri, "version": file.version },
            "contentChanges": [{ "range": range, "text": text }],
        });
        self.editor.notify("textDocument/didChange", params);
        self.edits += 1;
    }

    /// Asks a question. An answer may be an error, such as for a name that cannot be renamed.
    fn ask(&mut self, file: usize, method: &str, (line, character): (u32, u32)) -> Value {
        let mut params = Editor::at(&self.files[file].uri, line, character);
        params["context"] = json!({ "includeDeclaration": true });
        params["options"] = json!({ "tabSize": 2, "insertSpaces": true });
        params["newName"] = json!("renamed");
        self.answers += 1;
        self.editor.answer(&format!("textDocument/{method}"), params)
    }

    /// Asks for a picture. Every second one is cancelled.
    fn preview(&mut self, file: usize, round: u64) {
        let document = json!({ "uri": self.files[file].uri });
        let params = json!({ "textDocument": document, "size": [32, 18] });
        let id = self.editor.request("sdfc/preview", params);
        if round.is_multiple_of(2) {
            self.editor.notify("$/cancelRequest", json!({ "id": id }));
        }
        self.editor.answer_to(id);
        self.answers += 1;
    }

    /// Closes the imported file, changes it on disk, and opens it again.
    fn save_import(&mut self, round: u64) {
        let uri = self.files[1].uri.clone();
        self.editor.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
        let text = format!("{KNOB}// {round}\n");
        std::fs::write(self.folder.join("parts/knob.sdf"), &text).unwrap();
        let changes = json!({ "changes": [{ "uri": uri, "type": 2 }] });
        self.editor.notify("workspace/didChangeWatchedFiles", changes);
        self.ask(0, "hover", (1, 2));
        self.editor.open(&uri, &text);
        self.files[1].text = text;
    }

    fn reopen(&mut self, file: usize) {
        let Opened { uri, text, .. } = &self.files[file];
        self.editor.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
        self.editor.open(uri, text);
    }

    fn rename(&mut self) {
        let answer = self.ask(0, "rename", (1, 2));
        assert_eq!(
            answer["result"]["changes"].as_object().map(serde_json::Map::len),
            Some(2),
            "{answer}"
        );
    }

    /// Waits until the server has nothing to do.
    fn settle(&mut self) {
        let uri = &self.files[0].uri;
        let params = json!({ "textDocument": { "uri": uri }, "size": [4, 4] });
        let answer = self.editor.answer("sdfc/preview", params);
        assert!(answer["result"]["png"].is_string(), "{answer}");
        self.answers += 1;
    }
}

/// A number below a count; the same for the same seed.
fn pick(seed: u64, count: usize) -> usize {
    let mixed = (seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mixed >> 33) as usize % count
}
