//! The thread that turns the newest text into something that can be drawn.
//!
//! Only the newest order counts: what comes in while one is being worked on replaces what is waiting. What comes of an
//! order is in `shop`.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Sender;

use crate::findings::Findings;
use crate::mailbox::{Attendant, Mailbox};
use crate::model::Model;
use crate::shop::Shop;

/// How a scene is built.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Build {
    /// The file.
    pub path: PathBuf,
    /// The ray method; `None` takes the scene's.
    pub method: Option<String>,
    /// Whether numbers in the scene move without a recompile.
    pub live: bool,
    /// Whether rays are parallel; `None` as those of the scene's camera.
    pub parallel: Option<bool>,
    /// Whether the processor draws although there may be an adapter.
    pub on_cpu: bool,
    /// Counts how often all has been begun anew, after a device was lost.
    pub renewed: u32,
}

impl Build {
    /// Of a file, all else left to the scene and the machine.
    pub fn of(path: impl Into<PathBuf>) -> Self {
        let (path, method, parallel) = (path.into(), None, None);
        Self { path, method, live: true, parallel, on_cpu: false, renewed: 0 }
    }
}

/// What the worker tells.
#[derive(Debug)]
pub enum News {
    /// The file gives no text; why.
    Unreadable(String),
    /// A text was compiled.
    Compiled {
        /// What was found.
        findings: Findings,
        /// Where a change can change the scene.
        folders: BTreeSet<PathBuf>,
        /// Whether it can be drawn, so that more news follows.
        draws: bool,
    },
    /// A pipeline is made for it, which may take a while.
    Builds,
    /// The scene draws nothing.
    Empty,
    /// It can be drawn.
    Ready(Arc<Model>),
    /// The text compiles and yet cannot be drawn; why.
    Failed(String),
}

/// The thread, as others see it.
#[derive(Debug)]
pub struct Worker(Attendant<Build>);

impl Worker {
    /// Starts it. `wake` is called when there is news.
    ///
    /// # Errors
    ///
    /// Where the system gives no thread.
    pub fn new(news: Sender<News>, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let tell = move |letter| {
            // What follows at once is shown with it.
            let is_last = !matches!(letter, News::Compiled { draws: true, .. });
            // The receiver is gone only where the window is.
            let _ = news.send(letter);
            if is_last {
                wake();
            }
        };
        let begin = |orders| {
            let mut shop = Shop::new(orders, tell);
            move |build| shop.serve(&build)
        };
        Attendant::start("worker", begin).map(Self)
    }

    /// Orders a build; the texts are read when it begins, and nothing is done where neither they nor the
    /// order differ from the last.
    pub fn order(&self, build: Build) {
        self.0.mailbox().put(build);
    }

    /// The way in for those who only know that something may have changed.
    pub fn orders(&self) -> Arc<Mailbox<Build>> {
        Arc::clone(self.0.mailbox())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::path::Path;
    use std::sync::mpsc::{Receiver, channel};
    use std::time::Duration;

    use super::*;

    #[allow(clippy::wildcard_enum_match_arm, reason = "a test that meets anything else fails")]
    mod told {
        use super::*;

        pub fn ready(news: &Receiver<News>) -> Arc<Model> {
            match news.recv_timeout(PATIENCE).unwrap() {
                News::Ready(model) => model,
                other => panic!("{other:?}"),
            }
        }

        pub fn compiled(news: &Receiver<News>) -> (Findings, BTreeSet<PathBuf>) {
            match news.recv_timeout(PATIENCE).unwrap() {
                News::Compiled { findings, folders, .. } => (findings, folders),
                other => panic!("{other:?}"),
            }
        }
    }

    /// Long enough for a busy machine; reached only where a test fails.
    const PATIENCE: Duration = Duration::from_secs(300);

    /// A text as the worker makes a model of it, drawn on the CPU.
    pub(crate) fn model(text: &str) -> Arc<Model> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, text).unwrap();
        let (worker, news) = worker();
        worker.order(on_cpu(&path));
        ready(&news)
    }

    fn on_cpu(path: &Path) -> Build {
        Build { on_cpu: true, ..Build::of(path) }
    }

    fn worker() -> (Worker, Receiver<News>) {
        let (sender, news) = channel();
        (Worker::new(sender, || {}).unwrap(), news)
    }

    fn ready(news: &Receiver<News>) -> Arc<Model> {
        assert_eq!(findings(news).errors(), 0);
        told::ready(news)
    }

    fn findings(news: &Receiver<News>) -> Findings {
        told::compiled(news).0
    }

    #[test]
    fn broken_text_gives_findings_and_the_next_good_one_a_model() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        let (worker, news) = worker();
        worker.order(on_cpu(&path));
        assert!(matches!(news.recv_timeout(PATIENCE).unwrap(), News::Unreadable(_)));
        for round in 1..4 {
            std::fs::write(&path, format!("spere({round})")).unwrap();
            worker.order(on_cpu(&path));
            assert_eq!(findings(&news).errors(), 1);
            std::fs::write(&path, format!("\u{feff}sphere({round})\r\n")).unwrap();
            worker.order(on_cpu(&path));
            assert_eq!(ready(&news).serial, round);
        }
        // The same text again is no news; what draws nothing is told.
        worker.order(on_cpu(&path));
        std::fs::write(&path, "let a = 1\n").unwrap();
        worker.order(on_cpu(&path));
        assert_eq!(findings(&news).errors(), 0);
        assert!(matches!(news.recv_timeout(PATIENCE).unwrap(), News::Empty));
    }

    /// Text that is broken, that draws nothing, or that is gone.
    #[test]
    fn what_is_shown_is_drawn_otherwise_although_the_text_gives_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        let (worker, news) = worker();
        std::fs::write(&path, "sphere(1)\n").unwrap();
        worker.order(on_cpu(&path));
        let shown = ready(&news);
        assert!(!shown.parallel);
        let mut parallel = false;
        for text in [Some("spere(1)\n"), Some("let a = 1\n"), None] {
            match text {
                Some(text) => std::fs::write(&path, text).unwrap(),
                None => std::fs::remove_file(&path).unwrap(),
            }
            parallel = !parallel;
            worker.order(Build { parallel: Some(parallel), ..on_cpu(&path) });
            let told = news.recv_timeout(PATIENCE).unwrap();
            assert_eq!(matches!(told, News::Unreadable(_)), text.is_none(), "{told:?}");
            if text.is_some_and(|text| text.starts_with("let")) {
                assert!(matches!(news.recv_timeout(PATIENCE).unwrap(), News::Empty));
            }
            let model = told::ready(&news);
            assert_eq!((model.parallel, model.text.as_str()), (parallel, "sphere(1)\n"));
            assert_eq!(model.content, shown.content);
        }
        // Of another file nothing has been shown.
        worker.order(on_cpu(&folder.path().join("b.sdf")));
        assert!(matches!(news.recv_timeout(PATIENCE).unwrap(), News::Unreadable(_)));
        std::fs::write(&path, "sphere(2)\n").unwrap();
        worker.order(on_cpu(&path));
        assert_eq!(ready(&news).text, "sphere(2)\n");
    }

    #[test]
    fn an_edited_import_is_seen_and_its_folder_watched() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        let part = folder.path().join("parts").join("ball.sdf");
        std::fs::create_dir(part.parent().unwrap()).unwrap();
        std::fs::write(&path, "import ball from \"parts/ball.sdf\"\nball()\n").unwrap();
        let (worker, news) = worker();
        let at = [0.0, 0.0, 2.0];
        for radius in [1.0, 0.5] {
            std::fs::write(&part, format!("solid ball() = sphere({radius:?})(p)\n")).unwrap();
            worker.order(on_cpu(&path));
            let (findings, folders) = told::compiled(&news);
            assert_eq!(findings.errors(), 0, "{findings:?}");
            assert!(folders.iter().any(|folder| folder.ends_with("parts")), "{folders:?}");
            assert_eq!(told::ready(&news).scene.distance(at).unwrap(), 2.0 - radius);
        }
    }

    #[test]
    fn of_more_numbers_than_can_move_those_around_the_last_edit_do() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        let (worker, news) = worker();
        let terms: String =
            (0..400).map(|i| format!("\n    + 0.00{i} * sin(1.{i} * p.x)")).collect();
        let moving = |last: &str| {
            let text = format!("solid waves() = p.y{terms}\n    + {last} * cos(p.z)\nwaves()\n");
            std::fs::write(&path, &text).unwrap();
            worker.order(on_cpu(&path));
            let model = ready(&news);
            let lines: Vec<usize> = (model.literals())
                .map(|(slot, _)| text[..slot.span.start as usize].lines().count())
                .collect();
            assert_eq!(lines.len(), sdfc::lang::live_literals::MAX_LIVE_LITERALS);
            lines.into_iter().fold([usize::MAX, 0], |[lo, hi], at| [lo.min(at), hi.max(at)])
        };
        assert_eq!(moving("0.5")[0], 2);
        let after = moving("0.25");
        assert!(after[0] > 2 && after[1] == 402, "{after:?}");
        // One of them, in a text that has become longer.
        assert_eq!(moving("0.1255"), after);
    }

    #[test]
    fn another_method_draws_the_same_content() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, "sphere(1)\n").unwrap();
        let (worker, news) = worker();
        let mut models = Vec::new();
        for method in [None, Some("interval"), Some("sphere")] {
            let method = method.map(str::to_owned);
            worker.order(Build { method, ..on_cpu(&path) });
            models.push(ready(&news));
        }
        std::fs::write(&path, "sphere(2)\n").unwrap();
        worker.order(on_cpu(&path));
        models.push(ready(&news));
        let contents: Vec<u64> = models.iter().map(|model| model.content).collect();
        assert_eq!(contents, [1, 1, 1, 2]);
        let serials: Vec<u64> = models.iter().map(|model| model.serial).collect();
        assert_eq!(serials, [1, 2, 3, 4]);
    }

    #[test]
    fn warnings_are_those_of_the_text_as_it_stands() {
        let text = "let idle = 2\nsphere(1).twist(1)\n";
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, text).unwrap();
        let (worker, news) = worker();
        worker.order(on_cpu(&path));
        let expected = Findings::of(&sdfc::compile("a.sdf", text));
        assert_eq!(findings(&news), expected);
    }

    /// Hundreds of edits, half of them broken, faster than they can be followed: the last one counts.
    #[test]
    fn a_storm_of_edits_ends_with_the_last_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        let (worker, news) = worker();
        let broken =
            ["sphere(", "spere(1)", "sphere(1).", "\u{0}", "box(1) |", "sphere(1, 2, 3, 4)"];
        let rounds = std::env::var("SDFC_SOAK").ok().and_then(|it| it.parse().ok()).unwrap_or(400);
        for round in 0..rounds {
            let text = match round % 2 {
                0 => broken[round / 2 % broken.len()].to_owned(),
                _ => format!("sphere({}) | box(0.{})\n", round, round % 7 + 1),
            };
            std::fs::write(&path, text).unwrap();
            worker.order(on_cpu(&path));
        }
        std::fs::write(&path, "sphere(0.75)\n").unwrap();
        worker.order(on_cpu(&path));
        loop {
            match news.recv_timeout(PATIENCE).unwrap() {
                News::Ready(model) if model.text == "sphere(0.75)\n" => {
                    assert_eq!(model.scene.distance([0.0, 0.0, 2.0]).unwrap(), 1.25);
                    return;
                }
                News::Failed(why) => panic!("{why}"),
                News::Ready(_)
                | News::Compiled { .. }
                | News::Builds
                | News::Unreadable(_)
                | News::Empty => {}
            }
        }
    }
}
