//! What the worker does with an order: reads the text, compiles it, makes a model of it.
//!
//! A text that does not compile gives findings and leaves the last model standing; what is ordered of how it is drawn is
//! done with what was read before. Numbers of the scene are
//! elaborated as params, so that a changed number gives the same shader with other values: then the running
//! pipeline is taken over. Where many parts of a scene are loops, numbers stay what they are: they lie in lists, and the
//! running pipeline is given others.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Instant;

use sdfc::lang::Options;
use sdfc::lang::live_literals::LiveLiteral;
use sdfc::{Compiled, Error, FrameValues, Scene};

use crate::document::{Document, Imports};
use crate::edit::Edit;
use crate::engine::{Engines, Prepared, on_cpu};
use crate::findings::Findings;
use crate::identity::Shapes;
use crate::mailbox::Mailbox;
use crate::model::{Model, Stages, reads_time};
use crate::probe::Probe;
use crate::worker::{Build, News};

/// A scene of at most so many nodes is written out, so that its numbers move, also where loops would cost less, see
/// `docs/scale.md`.
const MOST_INLINE: usize = 2000;
/// A text whose pipeline is not made because a newer one waits: so often in a row at most.
const MOST_SKIPPED: u32 = 3;

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

/// What a text says, however it is drawn.
#[derive(Clone)]
struct Content {
    scene: Arc<Scene>,
    text: String,
    /// Around which byte of the text numbers move, of a scene that has more than can.
    near: Option<u32>,
    shapes: Arc<Shapes>,
    probe: Arc<Probe>,
    moves: bool,
    begun: Instant,
    number: u64,
}

/// What the thread keeps between orders.
pub struct Shop<T> {
    orders: Arc<Mailbox<Build>>,
    tell: T,
    /// The last order, and the texts that it met.
    last: Option<Met>,
    /// What is shown, and by which order.
    shown: Option<(Build, Content)>,
    engines: Engines,
    /// How often devices had been opened anew when these were.
    renewed: u32,
    serial: u64,
    contents: u64,
    skipped: u32,
    /// Whether parts of the last scene became loops.
    rolls: bool,
    /// Of the last scene of which that was found not to be so: its nodes and its numbers.
    inlined: Option<[usize; 2]>,
}

impl<T: FnMut(News)> Shop<T> {
    /// With nothing done yet. `orders` is where the next one lies.
    pub fn new(orders: Arc<Mailbox<Build>>, tell: T) -> Self {
        Self {
            orders,
            tell,
            last: None,
            shown: None,
            engines: Engines::default(),
            renewed: 0,
            serial: 0,
            contents: 0,
            skipped: 0,
            rolls: false,
            inlined: None,
        }
    }

    /// Does what is ordered. A fault of the compiler must not take the window's thread with it.
    pub fn serve(&mut self, build: &Build) {
        let result = catch_unwind(AssertUnwindSafe(|| self.build(build)));
        if result.is_err() {
            self.last = None;
            let what = "the compiler failed on this text; please report it with the scene";
            (self.tell)(News::Failed(what.to_owned()));
        }
    }

    fn build(&mut self, build: &Build) {
        if self.renewed != build.renewed {
            self.renewed = build.renewed;
            self.engines.forget_devices();
        }
        if !self.reads(build) {
            self.redraw(build);
        }
    }

    /// Draws the text as it stands. Gives whether that is settled: not where nothing comes of it.
    fn reads(&mut self, build: &Build) -> bool {
        let begun = Instant::now();
        let document = match Document::read(&build.path) {
            Ok(document) => document,
            Err(error) => {
                self.last = None;
                (self.tell)(News::Unreadable(error.to_string()));
                return false;
            }
        };
        let reads_same = self.last.as_ref().is_some_and(|last| last.reads(build, &document));
        if reads_same && self.last.as_ref().is_some_and(|last| last.build == *build) {
            return true;
        }
        self.contents += u64::from(!reads_same);
        let imports = Imports::of(&build.path);
        let near = self.near(build, &document.text);
        let mut compiled = self.compiled(build, &document, &imports, near);
        let scene = compiled.scene.take();
        let shapes = scene.as_ref().map(|scene| Shapes::new(scene, &compiled.sources));
        let findings = self.findings(&document, &imports, compiled, scene.is_some());
        let folders = imports.folders();
        self.last = Some(Met { build: build.clone(), text: document.text.clone(), imports });
        let draws = scene.as_ref().is_some_and(Scene::draws);
        (self.tell)(News::Compiled { findings, folders, draws });
        match scene {
            None => false,
            Some(_) if !draws => {
                (self.tell)(News::Empty);
                false
            }
            Some(scene) => {
                // Derived when first asked for, which is not to be where input is heard.
                scene.bounds_at(&FrameValues::defaults(scene.params()));
                let content = Content {
                    text: document.text,
                    near,
                    shapes: Arc::new(shapes.unwrap_or_default()),
                    probe: Arc::new(Probe::new(scene.drawn())),
                    moves: reads_time(&scene),
                    scene: Arc::new(scene),
                    begun,
                    number: self.contents,
                };
                self.shows(build, content)
            }
        }
    }

    /// What is shown, drawn as is ordered now: the text as it stands gives nothing newer.
    fn redraw(&mut self, build: &Build) {
        let other = |(by, _): &&(Build, Content)| by.path == build.path && by != build;
        if let Some((_, content)) = self.shown.as_ref().filter(other) {
            let content = content.clone();
            self.shows(build, content);
        }
    }

    /// Around which byte of a text numbers are to move: where they do in what is shown, as long as what was edited is one of them,
    /// else around the edit. So the first edit of a number beyond those that move takes a new shader, and the next ones do not.
    fn near(&self, build: &Build, text: &str) -> Option<u32> {
        let (_, shown) = self.shown.as_ref().filter(|(by, _)| by.path == build.path)?;
        let edit = Edit::between(&shown.text, text);
        let moves =
            |slot: &LiveLiteral| slot.span.start <= edit.old_end && edit.start <= slot.span.end;
        if edit.is_empty() || shown.scene.slots().iter().any(moves) {
            return shown.near.map(|near| edit.moved(near));
        }
        Some(edit.start)
    }

    /// With numbers as params, unless the scene's parts become loops without: parts that differ in params are none that
    /// are alike. That costs a second compilation, which is spared where nodes and numbers are as many as when it found none:
    /// other numbers hardly make parts alike.
    fn compiled(
        &mut self,
        build: &Build,
        document: &Document,
        imports: &Imports,
        near: Option<u32>,
    ) -> Compiled {
        let compile = |slots| {
            let options = Options { live_literals: slots, focus: near };
            sdfc::compile_with(&document.name, &document.text, imports, options)
        };
        if build.live && !self.rolls {
            let moving = compile(true);
            let extent = |scene: &Scene| [scene.program().graph.len(), scene.slots().len()];
            let extent = moving.scene.as_ref().map(extent);
            if extent.is_none_or(|[nodes, _]| nodes <= MOST_INLINE) || extent == self.inlined {
                return moving;
            }
            let fixed = compile(false);
            self.rolls = fixed.scene.as_ref().is_some_and(is_rolled);
            self.inlined = extent.filter(|_| !self.rolls);
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

    /// Makes a model of it. Gives whether that is settled, as it is too where a newer order waits.
    fn shows(&mut self, build: &Build, content: Content) -> bool {
        let scene = &content.scene;
        let times = scene.times();
        let mut stages = Stages { front: times.front, analyze: times.analyze, ..Stages::default() };
        let had_devices = self.engines.has_devices();
        let mut made = self.engine(build, scene, &mut stages);
        if had_devices && made.as_ref().is_err_and(Error::is_machine) {
            // A device that was lost while nothing was drawn on it.
            self.engines.forget_devices();
            made = self.engine(build, scene, &mut stages);
        }
        match made {
            Ok(Some(prepared)) => {
                self.skipped = 0;
                self.serial += 1;
                let model = Arc::new(self.model(build, &content, prepared, stages));
                self.shown = Some((build.clone(), content));
                (self.tell)(News::Ready(model));
                true
            }
            Ok(None) => {
                // Whatever the newer one finds, this text has not been shown.
                self.last = None;
                self.skipped += 1;
                true
            }
            Err(error) => {
                self.last = None;
                self.engines.forget_devices();
                (self.tell)(News::Failed(error.to_string()));
                false
            }
        }
    }

    fn model(&self, build: &Build, content: &Content, prepared: Prepared, stages: Stages) -> Model {
        let Content { scene, text, shapes, probe, moves, begun, number, .. } = content.clone();
        let Prepared { engine, method, enclosed, note } = prepared;
        Model {
            parallel: rays(build, &scene),
            scene,
            text,
            engine,
            method,
            enclosed,
            probe,
            shapes,
            moves,
            begun,
            stages,
            pipelines: self.engines.pipelines,
            serial: self.serial,
            content: number,
            renewed: build.renewed,
            note,
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
    !scene.report().loops.is_empty()
}
