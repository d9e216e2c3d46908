//! The thread that asks the language service about the latest text.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::Sender;

use sdfc_ide::{Analysis, Completion, Resolver, TokenSpan, complete, tokens};

use crate::scene::document::{EditedFolder, TextsByPath};
use crate::worker_thread::WorkerThread;

/// A question about a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LanguageRequest {
    /// The scene's file.
    pub path: PathBuf,
    /// The path of the file that has the text, relative to the folder of the scene.
    pub file: String,
    /// The text.
    pub text: Arc<str>,
    /// The edited texts of imported files.
    pub drafts: TextsByPath,
    /// The texts of the imported files that were compiled last. An import that changes on disk
    /// makes it another question.
    pub imports: TextsByPath,
    /// The byte offset of the cursor, if completions are wanted.
    pub cursor: Option<usize>,
}

impl LanguageRequest {
    /// A question about a scene without edited imports, without completions.
    pub fn new(path: &Path, text: &str) -> Self {
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (drafts, imports) = (TextsByPath::new(), TextsByPath::new());
        Self { path: path.to_owned(), file, text: text.into(), drafts, imports, cursor: None }
    }
}

/// The answer to a question.
#[derive(Clone)]
pub struct LanguageAnswer {
    /// The question.
    pub request: LanguageRequest,
    /// The text, parsed and checked.
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
    let (name, text) = (&request.file, &request.text);
    let folder = EditedFolder::new(&request.path, request.drafts.clone());
    let folder = ImportedFile { folder, path: name };
    let completions = match request.cursor {
        Some(cursor) => complete(name, text, cursor, &folder, &[]),
        None => Vec::new(),
    };
    let is_same = |last: &LanguageAnswer| {
        let last = &last.request;
        (&last.path, &last.file, &last.text) == (&request.path, name, text)
            && (&last.drafts, &last.imports) == (&request.drafts, &request.imports)
    };
    if let Some(last) = last.filter(is_same) {
        return LanguageAnswer { request, completions, ..last };
    }
    let analysis = Arc::new(Analysis::new(name, text, &folder));
    let tokens = tokens(&analysis).into();
    LanguageAnswer { request, analysis, tokens, completions }
}

/// The folder of the scene, for the imports of a file in it or below it.
struct ImportedFile<'a> {
    folder: EditedFolder,
    path: &'a str,
}

impl Resolver for ImportedFile<'_> {
    fn read(&self, path: &str) -> Result<String, String> {
        self.folder.read(path)
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        self.folder.read_bytes(path)
    }

    fn scene_path(&self) -> &str {
        self.path
    }
}

#[cfg(test)]
mod tests {
    use sdfc_ide::definition;

    use super::*;

    #[test]
    fn an_import_that_changes_on_disk_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let (path, part) = (folder.path().join("a.sdf"), folder.path().join("b.sdf"));
        let text = "import ball from \"b.sdf\"\nball()\n";
        let ask = |ball: &str, last: Option<LanguageAnswer>| {
            std::fs::write(&part, ball).unwrap();
            let imports = [("b.sdf".to_owned(), Arc::from(ball))].into();
            answer(LanguageRequest { imports, ..LanguageRequest::new(&path, text) }, last)
        };
        let start = |answer: &LanguageAnswer| {
            definition(&answer.analysis, text.len() - 4).map(|found| found.start)
        };
        let ball = "solid ball() = sphere(1)(p)\n";
        let first = ask(ball, None);
        let second = ask(&format!("// ball\n{ball}"), Some(first.clone()));
        assert_eq!(start(&second), start(&first).map(|start| start + 8));
        assert!(start(&first).is_some());
    }

    #[test]
    fn an_imported_file_knows_what_it_imports_from_above() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("parts")).unwrap();
        std::fs::write(folder.path().join("common.sdf"), "let size = 0.5\n").unwrap();
        let text = "import size from \"../common.sdf\"\nsolid wheel() = length(p) - size\n";
        let scene = folder.path().join("scene.sdf");
        let request = LanguageRequest {
            file: "parts/wheel.sdf".to_owned(),
            ..LanguageRequest::new(&scene, text)
        };
        let found = definition(&answer(request, None).analysis, text.len() - 2).unwrap();
        assert_eq!((found.file.as_str(), found.start), ("common.sdf", 4));
    }
}
