//! Builds models: reads a scene's files, compiles them, and prepares the pipeline.
//!
//! A source with errors gives diagnostics and keeps the last good scene; a request that only
//! changes how that scene is drawn is still carried out. The scene's numbers are compiled as
//! params, so that a changed number gives the same shader with other uniforms and the running
//! pipeline is reused. If loop rerolling turns the scene's parts into loops, numbers stay
//! constants: they are in lists, and the running pipeline gets other lists.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use sdfc::{Compiler, Diagnostics, Error, FrameValues, Scene};
use sdfc_lang::live_literals::LiveLiteral;

use crate::compile::diagnostics::SceneDiagnostics;
use crate::compile::engines::{Engines, PreparedEngine, on_cpu};
use crate::compile::request::{BuildRequest, CompileEvent, CompileReport, FileTexts};
use crate::compile::text_diff::TextDiff;
use crate::latest_channel::LatestChannel;
use crate::scene::document::{Document, EditedFolder, Imports, TextsByPath};
use crate::scene::field_probe::FieldProbe;
use crate::scene::model::{BuildTimes, Model, is_animated};
use crate::scene::shapes::ShapeIndex;
use crate::scene::source_numbers::source_numbers;

/// A scene with at most this many nodes is never rerolled, so that its numbers stay live, even if
/// loops would draw faster. See `docs/scale.md`.
const MAX_UNROLLED_NODES: usize = 2000;
/// The most sources in a row that may be skipped because a newer request waits when their pipeline
/// would be made.
const MAX_SKIPPED: u32 = 3;

/// The last request that was handled, and the files it read.
struct LastRead {
    request: BuildRequest,
    source: String,
    imports: Imports,
}

impl LastRead {
    /// True if `request` reads the same files and compiles them to the same scene.
    fn gives_same_scene(&self, request: &BuildRequest, document: &Document) -> bool {
        (&self.request.path, self.request.live_literals) == (&request.path, request.live_literals)
            && self.request.values == request.values
            && self.request.imports == request.imports
            && self.source == document.source
            && self.imports.are_unchanged()
    }
}

/// A compiled scene, independent of how it is drawn.
#[derive(Clone)]
struct SceneContent {
    scene: Arc<Scene>,
    source: String,
    imports: Arc<TextsByPath>,
    /// The byte offset around which numbers are live if the scene has more than can be.
    focus: Option<u32>,
    shapes: Arc<ShapeIndex>,
    field: Arc<FieldProbe>,
    animated: bool,
    read_at: Instant,
    id: u64,
}

/// Reports the events of one build.
struct Reporter<R> {
    send: R,
    /// The scene's file.
    path: PathBuf,
    began: Instant,
}

impl<R: FnMut(CompileReport)> Reporter<R> {
    fn report(&mut self, event: CompileEvent) {
        (self.send)(CompileReport { path: self.path.clone(), began: self.began, event });
    }
}

/// Builds models for the compile worker, and keeps the results that the next build can reuse.
pub struct ModelBuilder<R> {
    requests: Arc<LatestChannel<BuildRequest>>,
    reporter: Reporter<R>,
    last_read: Option<LastRead>,
    /// The texts of the files in place of which drafts are compiled, when they were read last.
    last_files: FileTexts,
    /// The scene that is shown, and the request that it was built for.
    shown: Option<(BuildRequest, SceneContent)>,
    engines: Engines,
    device_generation: u32,
    last_serial: u64,
    last_content_id: u64,
    skipped: u32,
    /// True if loop rerolling found loops in the last scene.
    has_loops: bool,
    /// Nodes and live literals of the last scene in which it found none.
    without_loops: Option<[usize; 2]>,
}

impl<R: FnMut(CompileReport)> ModelBuilder<R> {
    /// A builder that has built nothing. `requests` tells whether a newer request waits.
    pub fn new(requests: Arc<LatestChannel<BuildRequest>>, send: R) -> Self {
        Self {
            requests,
            reporter: Reporter { send, path: PathBuf::new(), began: Instant::now() },
            last_read: None,
            last_files: FileTexts::default(),
            shown: None,
            engines: Engines::default(),
            device_generation: 0,
            last_serial: 0,
            last_content_id: 0,
            skipped: 0,
            has_loops: false,
            without_loops: None,
        }
    }

    /// Handles a request. A panic in the compiler is reported and does not end the thread.
    pub fn handle(&mut self, request: &BuildRequest) {
        (self.reporter.path, self.reporter.began) = (request.path.clone(), Instant::now());
        let result = catch_unwind(AssertUnwindSafe(|| self.build(request)));
        if result.is_err() {
            self.last_read = None;
            let what = "the compiler crashed on this scene; please report it with the scene";
            self.reporter.report(CompileEvent::Failed(what.to_owned()));
        }
    }

    fn build(&mut self, request: &BuildRequest) {
        if self.device_generation != request.device_generation {
            self.device_generation = request.device_generation;
            self.engines.drop_devices();
        }
        self.engines.set_window(request.window_device.as_ref());
        if !self.build_from_file(request) {
            self.rebuild_shown(request);
        }
    }

    /// Builds the file as it is now. Returns false if it gives no model.
    fn build_from_file(&mut self, request: &BuildRequest) -> bool {
        let read_at = Instant::now();
        let (document, file) = match (Document::read(&request.path), &request.draft) {
            (Ok(document), None) => {
                let file = Arc::from(document.source.as_str());
                (document, Some(file))
            }
            (read, Some(draft)) => {
                let file = read.ok().map(|document| Arc::from(document.source));
                (Document::draft(&request.path, draft), file)
            }
            (Err(error), None) => {
                self.last_read = None;
                self.reporter.report(CompileEvent::Unreadable(error.to_string()));
                return false;
            }
        };
        let folder = EditedFolder::new(&request.path, request.imports.clone());
        let on_disk = |path: &String| (path.clone(), folder.text_on_disk(path));
        let drafted = folder.drafts().keys().map(on_disk).collect();
        let files = FileTexts { scene: file, imports: drafted };
        let has_changed = std::mem::replace(&mut self.last_files, files.clone()) != files;
        let same_scene =
            self.last_read.as_ref().is_some_and(|last| last.gives_same_scene(request, &document));
        if same_scene && self.last_read.as_ref().is_some_and(|last| last.request == *request) {
            if has_changed {
                self.reporter.report(CompileEvent::FilesChanged(files));
            }
            return true;
        }
        self.last_content_id += u64::from(!same_scene);
        let imports = Imports::new(folder);
        let focus = self.focus(request, &document.source);
        let compiled = self.compile(request, &document, &imports, focus);
        let diagnostics = self.diagnostics(request, &document, &imports, &compiled);
        let scene = compiled.ok();
        let shapes = scene.as_ref().map(|scene| ShapeIndex::new(scene, scene.sources()));
        let folders = imports.folders();
        let texts = imports.texts();
        let files = FileTexts { imports: imports.files(), ..files };
        self.last_read =
            Some(LastRead { request: request.clone(), source: document.source.clone(), imports });
        let draws = scene.as_ref().is_some_and(Scene::draws);
        let text = document.source.as_str().into();
        let imports = texts.clone();
        self.reporter.report(CompileEvent::Compiled {
            text,
            imports,
            files,
            diagnostics,
            folders,
            draws,
        });
        match scene {
            None => false,
            Some(_) if !draws => {
                self.reporter.report(CompileEvent::Empty);
                false
            }
            Some(scene) => {
                // Bounds are computed on first use, which must not be on the window's thread.
                scene.bounds_at(&FrameValues::defaults(scene.params()));
                let content = SceneContent {
                    source: document.source,
                    imports: Arc::new(texts),
                    focus,
                    shapes: Arc::new(shapes.unwrap_or_default()),
                    field: Arc::new(FieldProbe::new(scene.drawn())),
                    animated: is_animated(&scene),
                    scene: Arc::new(scene),
                    read_at,
                    id: self.last_content_id,
                };
                self.build_model(request, content)
            }
        }
    }

    /// Rebuilds the shown scene for a request that changes how it is drawn.
    fn rebuild_shown(&mut self, request: &BuildRequest) {
        let other =
            |(by, _): &&(BuildRequest, SceneContent)| by.path == request.path && by != request;
        if let Some((_, content)) = self.shown.as_ref().filter(other) {
            let content = content.clone();
            self.build_model(request, content);
        }
    }

    /// The byte offset around which literals are live. The current focus is kept if the edit
    /// touches a live literal; otherwise the focus moves to the edit. So the first edit of another
    /// literal takes a new shader, and the edits after it do not.
    fn focus(&self, request: &BuildRequest, source: &str) -> Option<u32> {
        let (_, shown) = self.shown.as_ref().filter(|(by, _)| by.path == request.path)?;
        let diff = TextDiff::new(&shown.source, source);
        let touches = |literal: &LiveLiteral| {
            literal.span.start <= diff.old_end && diff.start <= literal.span.end
        };
        if diff.is_empty() || shown.scene.live_literals().iter().any(touches) {
            return shown.focus.map(|focus| diff.map_offset(focus));
        }
        Some(diff.start)
    }

    /// Compiles with live literals, unless that prevents rerolling: parts that differ in a param
    /// are not alike. Finding that out takes a second compilation. It is skipped if the scene has
    /// as many nodes and literals as the last one without loops, since a changed number rarely
    /// makes parts alike.
    fn compile(
        &mut self,
        request: &BuildRequest,
        document: &Document,
        imports: &Imports,
        focus: Option<u32>,
    ) -> Result<Scene, Diagnostics> {
        let compile = |live_literals| {
            let compiler = Compiler::new().resolver(imports).values(&request.values);
            let compiler = if live_literals { compiler.live_literals(focus) } else { compiler };
            compiler.compile(&document.name, &document.source)
        };
        if request.live_literals && !self.has_loops {
            let live = compile(true);
            let counts = |scene: &Scene| [scene.program().graph.len(), scene.live_literals().len()];
            let counts = live.as_ref().ok().map(counts);
            let is_small = counts.is_none_or(|[nodes, _]| nodes <= MAX_UNROLLED_NODES);
            if is_small || counts == self.without_loops {
                return live;
            }
            let constant = compile(false);
            self.has_loops = constant.as_ref().is_ok_and(has_loops);
            self.without_loops = counts.filter(|_| !self.has_loops);
            return if self.has_loops { constant } else { live };
        }
        let constant = compile(false);
        // A scene with errors does not say whether it has loops.
        self.has_loops &= constant.as_ref().map_or(true, has_loops);
        if request.live_literals && !self.has_loops { compile(true) } else { constant }
    }

    /// The diagnostics of the scene without live literals, as the command line reports them.
    fn diagnostics(
        &self,
        request: &BuildRequest,
        document: &Document,
        imports: &Imports,
        compiled: &Result<Scene, Diagnostics>,
    ) -> SceneDiagnostics {
        match compiled {
            Ok(scene) if scene.diagnostics().is_empty() => SceneDiagnostics::default(),
            Ok(_) => {
                let compiler = Compiler::new().resolver(imports).values(&request.values);
                SceneDiagnostics::new(&compiler.check(&document.name, &document.source))
            }
            Err(errors) => SceneDiagnostics::new(errors),
        }
    }

    /// Makes a model of a scene. Returns false if that fails; a build that is skipped because a
    /// newer request waits counts as done.
    fn build_model(&mut self, request: &BuildRequest, content: SceneContent) -> bool {
        let scene = &content.scene;
        let times = scene.times();
        let mut build_times =
            BuildTimes { front: times.front, analyze: times.analyze, ..BuildTimes::default() };
        let had_devices = self.engines.has_devices();
        let mut prepared = self.engine(request, scene, &mut build_times);
        if had_devices && prepared.as_ref().is_err_and(Error::is_machine) {
            // The device may have been lost while nothing was drawn on it.
            self.engines.drop_devices();
            prepared = self.engine(request, scene, &mut build_times);
        }
        match prepared {
            Ok(Some(prepared)) => {
                self.skipped = 0;
                self.last_serial += 1;
                let model = Arc::new(self.model(request, &content, prepared, build_times));
                self.shown = Some((request.clone(), content));
                self.reporter.report(CompileEvent::Ready(model));
                true
            }
            Ok(None) => {
                // This source has not been shown, so the next request must not be taken as equal.
                self.last_read = None;
                self.skipped += 1;
                true
            }
            Err(error) => {
                self.last_read = None;
                self.engines.drop_devices();
                self.reporter.report(CompileEvent::Failed(error.to_string()));
                false
            }
        }
    }

    fn model(
        &self,
        request: &BuildRequest,
        content: &SceneContent,
        prepared: PreparedEngine,
        build_times: BuildTimes,
    ) -> Model {
        let SceneContent { scene, source, imports, shapes, field, animated, read_at, id, .. } =
            content.clone();
        let PreparedEngine { engine, method, method_program, note } = prepared;
        let literals = scene.live_literals().iter();
        let literals = literals.filter_map(|it| Some((it, scene.params().get(it.param)?)));
        let numbers = source_numbers(&source, literals);
        Model {
            parallel: is_parallel(request, &scene),
            scene,
            source,
            imports,
            numbers,
            engine,
            method,
            method_program,
            field,
            shapes,
            animated,
            read_at,
            build_times,
            pipelines: self.engines.pipelines,
            on_window: self.engines.draw_on_window(),
            serial: self.last_serial,
            content_id: id,
            device_generation: request.device_generation,
            note,
        }
    }

    /// Prepares the scene for drawing; `None` if a newer request makes it pointless.
    fn engine(
        &mut self,
        request: &BuildRequest,
        scene: &Scene,
        build_times: &mut BuildTimes,
    ) -> Result<Option<PreparedEngine>, Error> {
        let method = request.method.unwrap_or(scene.method());
        if request.on_cpu {
            return on_cpu(scene, method, None).map(Some);
        }
        let Self { engines, requests, skipped, reporter, .. } = self;
        let proceed = || {
            let proceed = !requests.is_interrupted() || *skipped >= MAX_SKIPPED;
            if proceed {
                reporter.report(CompileEvent::BuildingPipeline);
            }
            proceed
        };
        engines.on_gpu(scene, method, is_parallel(request, scene), build_times, proceed)
    }
}

fn is_parallel(request: &BuildRequest, scene: &Scene) -> bool {
    let is_parallel = || scene.program().settings.is_parallel();
    scene.is_planar() || request.parallel.unwrap_or_else(is_parallel)
}

/// True if loop rerolling made loops of the scene's parts.
fn has_loops(scene: &Scene) -> bool {
    !scene.report().loops.is_empty()
}
