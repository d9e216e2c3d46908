//! The thread that turns the newest text into something that can be drawn.
//!
//! Only the newest order counts: what comes in while one is being worked on replaces what is waiting.
//! A text that does not compile gives findings and leaves the last model standing. Numbers of the scene are
//! elaborated as params, so that a changed number gives the same shader with other values: then the running
//! pipeline is taken over. Where many parts of a scene are loops, numbers stay what they are: they lie in lists, and the
//! running pipeline is given others.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Instant;

use sdfc::lang::Options;
use sdfc::{Compiled, Error, FrameValues, Scene};

use crate::document::{Document, Imports};
use crate::engine::{Engines, Prepared, on_cpu};
use crate::findings::Findings;
use crate::identity::Shapes;
use crate::mailbox::{Attendant, Mailbox};
use crate::model::{Model, Stages, reads_time};
use crate::probe::Probe;

/// A scene of at most so many nodes is written out, so that its numbers move, also where loops would cost less, see
/// `docs/scale.md`.
const MOST_INLINE: usize = 2000;
/// A text whose pipeline is not made because a newer one waits: so often in a row at most.
const MOST_SKIPPED: u32 = 3;

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
            move |build| shop.guarded(&build)
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

/// An order, and the texts that it met.
struct Met {
    build: Build,
    text: String,
    imports: Imports,
}

impl Met {
    /// Whether this order meets the same texts, and makes the same scene of them.
    fn reads(&self, build: &Build, document: &Document) -> bool {
        (&self.build.path, self.build.live) == (&build.path, build.live)
            && self.text == document.text
            && self.imports.are_as_read()
    }
}

/// What the thread keeps between orders.
struct Shop<T> {
    orders: Arc<Mailbox<Build>>,
    tell: T,
    /// The last order, and the texts that it met.
    last: Option<Met>,
    engines: Engines,
    serial: u64,
    content: u64,
    skipped: u32,
    /// Whether parts of the last scene became loops.
    rolls: bool,
}

impl<T: FnMut(News)> Shop<T> {
    fn new(orders: Arc<Mailbox<Build>>, tell: T) -> Self {
        Self {
            orders,
            tell,
            last: None,
            engines: Engines::default(),
            serial: 0,
            content: 0,
            skipped: 0,
            rolls: false,
        }
    }

    /// A fault of the compiler must not take the window's thread with it.
    fn guarded(&mut self, build: &Build) {
        let result = catch_unwind(AssertUnwindSafe(|| self.build(build)));
        if result.is_err() {
            self.last = None;
            let what = "the compiler failed on this text; please report it with the scene";
            (self.tell)(News::Failed(what.to_owned()));
        }
    }

    fn build(&mut self, build: &Build) {
        let begun = Instant::now();
        let document = match Document::read(&build.path) {
            Ok(document) => document,
            Err(error) => {
                self.last = None;
                return (self.tell)(News::Unreadable(error.to_string()));
            }
        };
        let reads_same = self.last.as_ref().is_some_and(|last| last.reads(build, &document));
        if reads_same && self.last.as_ref().is_some_and(|last| last.build == *build) {
            return;
        }
        self.content += u64::from(!reads_same);
        if self.last.as_ref().is_some_and(|last| last.build.renewed != build.renewed) {
            self.engines.forget_devices();
        }
        let imports = Imports::of(&build.path);
        let mut compiled = self.compiled(build, &document, &imports);
        let scene = compiled.scene.take();
        let shapes = scene.as_ref().map(|scene| Shapes::new(scene, &compiled.sources));
        let findings = self.findings(&document, &imports, compiled, scene.is_some());
        let folders = imports.folders();
        self.last = Some(Met { build: build.clone(), text: document.text.clone(), imports });
        match scene {
            None => (self.tell)(News::Compiled { findings, folders, draws: false }),
            Some(scene) if !scene.draws() => {
                (self.tell)(News::Compiled { findings, folders, draws: false });
                (self.tell)(News::Empty);
            }
            Some(scene) => {
                (self.tell)(News::Compiled { findings, folders, draws: true });
                self.ready(build, begun, document, scene, shapes.unwrap_or_default());
            }
        }
    }

    /// With numbers as params, unless the scene's parts become loops without: parts that differ in params are none that
    /// are alike.
    fn compiled(&mut self, build: &Build, document: &Document, imports: &Imports) -> Compiled {
        let compile =
            |slots| sdfc::compile_with(&document.name, &document.text, imports, Options { slots });
        if build.live && !self.rolls {
            let moving = compile(true);
            let may_roll = |scene: &Scene| scene.program().graph.len() > MOST_INLINE;
            if !moving.scene.as_ref().is_some_and(may_roll) {
                return moving;
            }
            let fixed = compile(false);
            self.rolls = fixed.scene.as_ref().is_some_and(is_rolled);
            return if self.rolls { fixed } else { moving };
        }
        let fixed = compile(false);
        // A text with errors says nothing of it.
        self.rolls &= fixed.scene.as_ref().is_none_or(is_rolled);
        if build.live && !self.rolls { compile(true) } else { fixed }
    }

    /// What the terminal says: of the text as it stands, not of one whose numbers are params.
    fn findings(
        &self,
        document: &Document,
        imports: &Imports,
        compiled: Compiled,
        compiles: bool,
    ) -> Findings {
        if !compiles || compiled.diagnostics.is_empty() {
            return Findings::of(&compiled);
        }
        Findings::of(&sdfc::compile_with_imports(&document.name, &document.text, imports))
    }

    fn ready(
        &mut self,
        build: &Build,
        begun: Instant,
        document: Document,
        scene: Scene,
        shapes: Shapes,
    ) {
        let times = scene.times();
        let mut stages = Stages { front: times.front, analyze: times.analyze, ..Stages::default() };
        // Derived when first asked for, which is not to be where input is heard.
        scene.bounds_at(&FrameValues::defaults(scene.params()));
        let had_devices = self.engines.has_devices();
        let mut made = self.engine(build, &scene, &mut stages);
        if had_devices && made.as_ref().is_err_and(Error::is_machine) {
            // A device that was lost while nothing was drawn on it.
            self.engines.forget_devices();
            made = self.engine(build, &scene, &mut stages);
        }
        match made {
            Ok(Some(Prepared { engine, method, enclosed, note })) => {
                self.skipped = 0;
                self.serial += 1;
                let (probe, moves) = (Probe::new(scene.drawn()), reads_time(&scene));
                let (text, pipelines) = (document.text, self.engines.pipelines);
                let (serial, content) = (self.serial, self.content);
                let parallel = rays(build, &scene);
                let model = Model {
                    scene,
                    text,
                    engine,
                    method,
                    parallel,
                    enclosed,
                    probe,
                    shapes,
                    moves,
                    begun,
                    stages,
                    pipelines,
                    serial,
                    content,
                    renewed: build.renewed,
                    note,
                };
                (self.tell)(News::Ready(Arc::new(model)));
            }
            Ok(None) => {
                // A newer order waits; whatever it finds, this text has not been shown.
                self.last = None;
                self.skipped += 1;
            }
            Err(error) => {
                self.last = None;
                self.engines.forget_devices();
                (self.tell)(News::Failed(error.to_string()));
            }
        }
    }

    /// What draws the scene; `None` where a newer order makes it pointless.
    fn engine(
        &mut self,
        build: &Build,
        scene: &Scene,
        stages: &mut Stages,
    ) -> Result<Option<Prepared>, Error> {
        let wanted = build.method.as_deref().unwrap_or(scene.method());
        if build.on_cpu {
            return on_cpu(scene, wanted, None).map(Some);
        }
        let Self { engines, orders, skipped, tell, .. } = self;
        let begins = || {
            let goes_on = !orders.calls() || *skipped >= MOST_SKIPPED;
            if goes_on {
                tell(News::Builds);
            }
            goes_on
        };
        engines.on_device(scene, wanted, rays(build, scene), stages, begins)
    }
}

/// Whether rays are parallel.
fn rays(build: &Build, scene: &Scene) -> bool {
    build.parallel.unwrap_or_else(|| scene.program().settings.is_parallel())
}

fn is_rolled(scene: &Scene) -> bool {
    !scene.report().rolled.is_empty()
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
