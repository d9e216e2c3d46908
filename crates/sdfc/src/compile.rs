//! From text to a scene ready for code generation.

use std::sync::{Arc, OnceLock};

use sdfc_analyze::{LoopStrategy, Report, prepare, prepare_with};
use sdfc_codegen::Stopwatch;
use sdfc_diagnostics::{
    Code, Diagnostic, FileId, Located, Sources, Span, has_errors, locate, render,
};
use sdfc_graph::eval::TapeError;
use sdfc_graph::{Param, Program};
use sdfc_lang::live_literals::LiveLiteral;
use sdfc_lang::{Elaborated, NoFiles, Options, Resolver, Site};

use crate::field::Tapes;
use crate::scene::DerivedBounds;
use crate::shader::Origin;
use crate::{Error, findings};

/// What compiling a source gave: findings, and the scene if none of them is an error.
#[derive(Debug)]
pub struct Compiled {
    /// Texts of the scene and the library.
    pub sources: Arc<Sources>,
    /// Findings in order of place.
    pub diagnostics: Vec<Diagnostic>,
    /// The scene, if there were no errors.
    pub scene: Option<Scene>,
}

impl Compiled {
    /// The findings as text for people.
    pub fn diagnostics_text(&self, color: bool) -> String {
        render(&self.sources, &self.diagnostics, color)
    }

    /// The scene, or all that is wrong with the source.
    ///
    /// # Errors
    ///
    /// [`SourceErrors`].
    pub fn into_scene(self) -> Result<Scene, SourceErrors> {
        let (text, found) = (self.diagnostics_text(false), self.located());
        self.scene.ok_or(SourceErrors { found, text })
    }

    /// The findings with lines and columns.
    pub fn located(&self) -> Vec<Located> {
        self.diagnostics.iter().map(|found| locate(&self.sources, found)).collect()
    }
}

/// Why a source gave no scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceErrors {
    /// Each finding with its code, its place and ways to mend it, warnings included.
    pub found: Vec<Located>,
    text: String,
}

impl std::fmt::Display for SourceErrors {
    /// All findings as text for people, each with the lines of the source.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.text.trim_end())
    }
}

impl std::error::Error for SourceErrors {}

/// Time spent in the front stages, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrontTimes {
    /// Parsing, checking, elaborating.
    pub front: f64,
    /// Analyses and passes.
    pub analyze: f64,
}

/// A compiled scene: all that is known of it before a target is chosen.
#[derive(Debug)]
pub struct Scene {
    pub(crate) sources: Arc<Sources>,
    pub(crate) elaborated: Elaborated,
    pub(crate) program: Program,
    pub(crate) report: Report,
    pub(crate) writing: LoopStrategy,
    /// The program about another place, if pictures are drawn by such; made when the first is.
    pub(crate) rebased: OnceLock<Option<Program>>,
    /// Derived when first asked for; a shader needs none.
    pub(crate) bounds: OnceLock<Option<DerivedBounds>>,
    /// Whether `interval` ends on the field; found when first asked for.
    pub(crate) intervals_end: OnceLock<bool>,
    /// What the field is computed by; made when it is first asked for.
    pub(crate) tapes: OnceLock<Result<Option<Tapes>, TapeError>>,
    pub(crate) times: FrontTimes,
    pub(crate) origin: Origin,
}

impl Scene {
    /// A scene without imports; `name` is what messages call it. Warnings, options and imports are for [`compile`] and
    /// its kin.
    ///
    /// ```
    /// use sdfc::{Scene, SourceErrors};
    ///
    /// let scene = Scene::from_source("ball.sdf", "sphere(0.5) | plane(y: -0.5)")?;
    /// assert_eq!(scene.distance([0.0, 2.0, 0.0]).expect("something is drawn"), 1.5);
    ///
    /// let errors = Scene::from_source("ball.sdf", "spere(0.5)").expect_err("no such shape");
    /// let [found] = &errors.found[..] else { panic!("one error") };
    /// assert_eq!((found.code, found.start.line, found.start.column), ("E0201", 1, 1));
    /// assert!(errors.to_string().contains("did you mean `sphere`?"));
    /// # Ok::<(), SourceErrors>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`SourceErrors`]: all that is wrong with the source.
    pub fn from_source(name: &str, text: &str) -> Result<Self, SourceErrors> {
        let compiled = compile(name, text);
        compiled.into_scene()
    }

    /// The flat program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The graph with its shapes, as elaborated.
    pub fn graph(&self) -> &sdfc_graph::Scene {
        &self.elaborated.scene
    }

    /// Which calls made which shapes.
    pub fn sites(&self) -> &[Site] {
        &self.elaborated.sites
    }

    /// What was modelled and why.
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// The params, in order of declaration.
    pub fn params(&self) -> &[Param] {
        &self.program.params
    }

    /// Numbers of the scene that have become params; none unless compiled so.
    pub fn slots(&self) -> &[LiveLiteral] {
        &self.elaborated.live_literals
    }

    /// Whether the scene draws anything.
    pub fn draws(&self) -> bool {
        self.program.distance.is_some()
    }

    /// The same scene with its field written another way.
    ///
    /// # Errors
    ///
    /// [`Error::Expand`].
    pub fn written(self, writing: LoopStrategy) -> Result<Self, Error> {
        let start = Stopwatch::start();
        let prepared = prepare_with(&self.elaborated.scene, [0.0; 3], writing)?;
        let (program, report) = (prepared.program, prepared.report);
        let (rebased, tapes) = Default::default();
        let times = FrontTimes { analyze: start.milliseconds(), ..self.times };
        Ok(Self { program, report, rebased, tapes, writing, times, ..self })
    }

    /// Time spent so far.
    pub fn times(&self) -> FrontTimes {
        self.times
    }
}

/// Compiles a scene; `name` is what messages call it.
///
/// ```
/// let compiled = sdfc::compile("ball.sdf", "sphere(0.5) | plane(y: -0.5)");
/// let scene = compiled.scene.expect("no errors");
/// assert_eq!(scene.distance([0.0, 2.0, 0.0]).expect("something is drawn"), 1.5);
///
/// let wrong = sdfc::compile("ball.sdf", "spere(0.5)");
/// assert!(wrong.scene.is_none());
/// assert!(wrong.diagnostics_text(false).contains("did you mean `sphere`?"));
/// ```
pub fn compile(name: &str, text: &str) -> Compiled {
    compile_with_imports(name, text, &NoFiles)
}

/// As [`compile`], for scenes that import files: the resolver gives their texts.
pub fn compile_with_imports(name: &str, text: &str, resolver: &dyn Resolver) -> Compiled {
    compile_with(name, text, resolver, Options::default())
}

/// As [`compile_with_imports`], with options.
///
/// ```
/// use sdfc::lang::{NoFiles, Options};
///
/// let options = Options { live_literals: true, ..Options::default() };
/// let compiled = sdfc::compile_with("ball.sdf", "sphere(0.5)", &NoFiles, options);
/// let scene = compiled.scene.expect("no errors");
/// let [slot] = scene.slots() else { panic!("one number is written") };
/// assert_eq!((slot.value, compiled.sources.slice(slot.span)), (0.5, "0.5"));
///
/// // The number is a param now, and moves as one.
/// let mut frame = sdfc::FrameValues::defaults(scene.params());
/// scene.set_param(&mut frame, &scene.params()[slot.param].name, "0.25").expect("in range");
/// ```
pub fn compile_with(name: &str, text: &str, resolver: &dyn Resolver, options: Options) -> Compiled {
    let start = Stopwatch::start();
    let mut sources = Sources::new();
    let file = sources.add(name, text);
    let (elaborated, mut diagnostics) =
        sdfc_lang::front_with(&mut sources, file, resolver, options);
    let front = start.milliseconds();
    let origin = Origin::new(&sources, file);
    let sources = Arc::new(sources);
    let scene = elaborated
        .and_then(|elaborated| finish(elaborated, &sources, origin, front, file, &mut diagnostics));
    if let Some(scene) = &scene {
        diagnostics.extend(findings::warnings(&scene.elaborated, &scene.report, &sources));
    }
    Compiled { sources, diagnostics, scene }
}

/// As [`compile_with_imports`], and holds the clauses of the scene's own shapes against samples: one that is
/// refuted is an error. That takes as long as some ten thousand evaluations of each such shape.
///
/// ```
/// use sdfc::lang::NoFiles;
///
/// let text = "solid egg() exact = length(p * [1, 0.7, 1]) - 1\negg()";
/// let checked = sdfc::check("egg.sdf", text, &NoFiles);
/// assert!(checked.scene.is_none());
/// assert!(checked.diagnostics_text(false).contains("this states `exact`, but at p = ["));
/// ```
pub fn check(name: &str, text: &str, resolver: &dyn Resolver) -> Compiled {
    let mut compiled = compile_with_imports(name, text, resolver);
    if let Some(scene) = &compiled.scene {
        compiled.diagnostics.extend(findings::refutations(&scene.elaborated));
        if has_errors(&compiled.diagnostics) {
            compiled.scene = None;
        }
    }
    compiled
}

/// The text of a scene in the one layout; formatting that again changes nothing.
///
/// # Errors
///
/// A scene that does not parse is not formatted: gives what is wrong, as text for people.
///
/// ```
/// assert_eq!(sdfc::format("a.sdf", "sphere( 1 )", false).as_deref(), Ok("sphere(1)\n"));
/// ```
pub fn format(name: &str, text: &str, color: bool) -> Result<String, String> {
    let mut sources = Sources::new();
    let file = sources.add(name, text);
    sdfc_syntax::format(&sources, file).map_err(|found| render(&sources, &found, color))
}

fn finish(
    elaborated: Elaborated,
    sources: &Arc<Sources>,
    origin: Origin,
    front: f64,
    file: FileId,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Scene> {
    let start = Stopwatch::start();
    match prepare(&elaborated.scene) {
        Ok(prepared) => {
            let times = FrontTimes { front, analyze: start.milliseconds() };
            let (program, report) = (prepared.program, prepared.report);
            let (rebased, bounds, intervals_end, tapes) = Default::default();
            Some(Scene {
                sources: Arc::clone(sources),
                elaborated,
                program,
                report,
                writing: LoopStrategy::Auto,
                rebased,
                bounds,
                intervals_end,
                tapes,
                times,
                origin,
            })
        }
        Err(error) => {
            let span = Span::new(file, 0, 0);
            let found = Diagnostic::error(Code::TOO_MANY_NODES, span, error.to_string());
            diagnostics.push(found.help("use repetition for copies, or draw less"));
            None
        }
    }
}
