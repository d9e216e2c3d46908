//! The compiler: from the source of a scene to a [`Scene`].

use std::sync::Arc;

use sdfc_analyze::{LoopStrategy, prepare_with};
use sdfc_codegen::Stopwatch;
use sdfc_diagnostics::{Code, Diagnostic, Sources, Span, has_errors};
use sdfc_graph::Param;
use sdfc_lang::{CompileValues, NoFiles, Options, Resolver};

use crate::diagnostics::Diagnostics;
use crate::diagnostics::refutations::refutations;
use crate::diagnostics::warnings::warnings;
use crate::params::{ParamError, parse_values};
use crate::scene::{FrontTimes, Scene};
use crate::source_id::SourceId;

/// Why [`Compiler::compile_with`] gives no scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompileWithError {
    /// The scene has errors.
    #[error(transparent)]
    Scene(#[from] Diagnostics),
    /// A param does not take its value.
    #[error(transparent)]
    Param(#[from] ParamError),
}

/// Compiles scenes: a builder of options, and [`compile`](Self::compile).
///
/// ```
/// use sdfc::Compiler;
///
/// let scene = Compiler::new().compile("ball.sdf", "sphere(0.5) | plane(y: -0.5)")?;
/// assert_eq!(scene.distance([0.0, 2.0, 0.0])?, 1.5);
/// assert!(scene.diagnostics().is_empty());
///
/// let errors = Compiler::new().compile("ball.sdf", "spere(0.5)").expect_err("no such shape");
/// let [error] = &errors.located()[..] else { panic!("one error") };
/// assert_eq!((error.code, error.start.line, error.start.column), ("E0201", 1, 1));
/// assert!(errors.to_string().contains("did you mean `sphere`?"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy)]
#[must_use = "nothing is compiled before `compile` is called"]
pub struct Compiler<'r> {
    resolver: &'r dyn Resolver,
    verify: bool,
    options: Options<'r>,
    loops: LoopStrategy,
}

impl Compiler<'_> {
    /// A compiler with default options: no imports, no verification, no live literals.
    pub fn new() -> Self {
        Self {
            resolver: &NoFiles,
            verify: false,
            options: Options::default(),
            loops: LoopStrategy::Auto,
        }
    }
}

impl Default for Compiler<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl std::fmt::Debug for Compiler<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { resolver: _, verify, options, loops } = self;
        f.debug_struct("Compiler")
            .field("verify", verify)
            .field("options", options)
            .field("loops", loops)
            .finish_non_exhaustive()
    }
}

impl<'r> Compiler<'r> {
    /// Reads the files that a scene imports, and fonts, through `resolver`. Without one, a scene
    /// that imports a file is an error.
    pub fn resolver(self, resolver: &'r dyn Resolver) -> Self {
        Self { resolver, ..self }
    }

    /// Tests the clauses that the scene states about its own shapes and functions (`exact`,
    /// `lipschitz`, `bounds` and so on) against samples. A refuted clause is an error (E0502).
    ///
    /// This takes some ten thousand field evaluations for each such shape.
    ///
    /// ```
    /// use sdfc::Compiler;
    ///
    /// let text = "solid egg() exact = length(p * [1, 0.7, 1]) - 1\negg()";
    /// let errors = Compiler::new().verify(true).compile("egg.sdf", text).expect_err("refuted");
    /// assert!(errors.to_string().contains("this states `exact`, but at p = ["));
    /// ```
    pub fn verify(self, verify: bool) -> Self {
        Self { verify, ..self }
    }

    /// Turns the numbers in the scene into params, so that they change without recompiling: see
    /// [`Scene::live_literals`].
    ///
    /// If the scene has more than [`MAX_LIVE_LITERALS`](crate::MAX_LIVE_LITERALS) numbers, those
    /// nearest to the byte offset `focus` become params; `None` takes the first ones.
    ///
    /// ```
    /// use sdfc::Compiler;
    ///
    /// let scene = Compiler::new().live_literals(None).compile("ball.sdf", "sphere(0.5)")?;
    /// let [literal] = scene.live_literals() else { panic!("one number is written") };
    /// assert_eq!((literal.value, scene.sources().slice(literal.span)), (0.5, "0.5"));
    ///
    /// let mut frame = scene.defaults();
    /// scene.set(&mut frame, &scene.params()[literal.param].name, 0.25)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn live_literals(self, focus: Option<u32>) -> Self {
        Self { options: Options { live_literals: true, focus, ..self.options }, ..self }
    }

    /// Sets the values of the params that decide what a scene consists of: counts, lengths of
    /// lists, strings ([`Scene::is_fixed`]). They are constants of the compiled scene, by default
    /// with the defaults that the scene declares.
    ///
    /// Values of other params are ignored, as are values that a param does not take. Values for
    /// all params come from [`Scene::param_value`]; [`Compiler::compile_with`] does that.
    ///
    /// ```
    /// use sdfc::{Compiler, CompileValues};
    ///
    /// let text = "param n: int = 2 in 1..9\nunion([for i in 0..n: sphere(1).translate(x: 4 * i)])";
    /// let values = CompileValues::from([("n".to_owned(), [3.0, 0.0, 0.0, 0.0])]);
    /// let scene = Compiler::new().values(&values).compile("row.sdf", text)?;
    /// assert_eq!(scene.distance([8.0, 0.0, 0.0])?, -1.0);
    /// assert!(scene.is_fixed("n"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn values(self, values: &'r CompileValues) -> Self {
        Self { options: Options { values: Some(values), ..self.options }, ..self }
    }

    /// Makes constants of all params: their values come from [`Compiler::compile_with`], from
    /// [`Compiler::values`], or are the defaults. Formulas are shorter then, and more can be proven
    /// about them. Meshes, contours and measurements of one set of values gain most: a polygon
    /// whose corners depend on a param takes 60 times as long as one with constant corners.
    ///
    /// ```
    /// use sdfc::Compiler;
    ///
    /// let text = "param r = 1 in 0..2\nsphere(r)";
    /// let compiler = Compiler::new().constant_params(true);
    /// let scene = compiler.compile_with("ball.sdf", text, &[("r", "0.5")])?;
    /// assert_eq!(scene.distance([2.0, 0.0, 0.0])?, 1.5);
    /// assert!(scene.is_fixed("r"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn constant_params(self, constant_params: bool) -> Self {
        Self { options: Options { constant_params, ..self.options }, ..self }
    }

    /// Replaces the camera of the scene: the arguments of `camera(...)`, which can use the names of
    /// the scene.
    ///
    /// ```
    /// use sdfc::Compiler;
    ///
    /// let text = "let r = 2\nsphere(r)\ncamera(eye: [0, 0, 9])";
    /// assert!(Compiler::new().camera("eye: [0, 3 * r, 9]").check("ball.sdf", text).is_empty());
    /// let found = Compiler::new().camera("eye: 3, zoom: 2").check("ball.sdf", text);
    /// assert!(found.to_string().contains("`camera` has no parameter `zoom`"));
    /// ```
    pub fn camera(self, arguments: impl Into<Option<&'r str>>) -> Self {
        Self { options: Options { camera: arguments.into(), ..self.options }, ..self }
    }

    /// Chooses between loops over similar parts of the scene and unrolled code. The default picks
    /// the cheaper one.
    pub fn loops(self, loops: LoopStrategy) -> Self {
        Self { loops, ..self }
    }

    /// Compiles the source of a scene. Diagnostics call the scene `name`.
    ///
    /// Warnings are in [`Scene::diagnostics`].
    ///
    /// # Errors
    ///
    /// All errors and warnings, if there is at least one error.
    pub fn compile(&self, name: &str, text: &str) -> Result<Scene, Diagnostics> {
        let start = Stopwatch::start();
        let mut sources = Sources::new();
        let file = sources.add(name, text);
        let (elaborated, mut found) =
            sdfc_lang::front_with(&mut sources, file, self.resolver, self.options);
        let front = start.milliseconds();
        let id = SourceId::new(&sources, file);
        let sources = Arc::new(sources);
        let Some(elaborated) = elaborated else { return Err(Diagnostics::new(sources, found)) };
        let start = Stopwatch::start();
        let prepared = match prepare_with(&elaborated.scene, [0.0; 3], self.loops) {
            Ok(prepared) => prepared,
            Err(error) => {
                let span = Span::new(file, 0, 0);
                let error = Diagnostic::error(Code::TOO_MANY_NODES, span, error.to_string());
                found.push(error.help("use `repeat` for copies, or draw fewer shapes"));
                return Err(Diagnostics::new(sources, found));
            }
        };
        let times = FrontTimes { front, analyze: start.milliseconds() };
        found.extend(warnings(&elaborated, &prepared.report, &sources));
        if self.verify {
            found.extend(refutations(&elaborated));
            if has_errors(&found) {
                return Err(Diagnostics::new(sources, found));
            }
        }
        let diagnostics = Diagnostics::new(sources, found);
        Ok(Scene::new(diagnostics, elaborated, prepared, self.loops, times, id))
    }

    /// Compiles the source of a scene with values for some params, written as in a scene (see
    /// [`Scene::set_param`]). They are the defaults of the compiled scene.
    ///
    /// ```
    /// use sdfc::Compiler;
    ///
    /// let text = "param n: int = 2 in 1..9\nparam r = 1 in 0..2\n\
    ///             union([for i in 0..n: sphere(r).translate(x: 4 * i)])";
    /// let scene = Compiler::new().compile_with("row.sdf", text, &[("n", "3"), ("r", "0.5")])?;
    /// assert_eq!(scene.distance([8.0, 0.0, 0.0])?, -0.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`CompileWithError`]: the scene has errors, also with these values only, or a param does not
    /// take its value.
    pub fn compile_with(
        &self,
        name: &str,
        text: &str,
        set: &[(&str, &str)],
    ) -> Result<Scene, CompileWithError> {
        let (mut scene, values) = match self.compile(name, text) {
            Ok(scene) => {
                let values = parse_values(scene.params(), set)?;
                (scene, values)
            }
            // Another try would read the imports again.
            Err(errors) if set.is_empty() => return Err(errors.into()),
            Err(errors) => {
                // The values may fix what the defaults break.
                let values = parse_values(&self.declared_params(name, text), set);
                let values = values.map_err(|_| errors)?;
                (self.values(&values).compile(name, text)?, values)
            }
        };
        if scene.needs_compile(&values) {
            scene = self.values(&values).compile(name, text)?;
        }
        let declared = &mut scene.elaborated.scene.params;
        for param in scene.program.params.iter_mut().chain(declared) {
            param.default = values.get(&param.name).copied().unwrap_or(param.default);
        }
        Ok(scene)
    }

    /// The params of a scene, also if it does not compile with their defaults.
    fn declared_params(&self, name: &str, text: &str) -> Vec<Param> {
        let mut sources = Sources::new();
        let file = sources.add(name, text);
        sdfc_lang::declared_params(&mut sources, file, self.resolver)
    }

    /// Compiles the source of a scene and returns all errors and warnings.
    pub fn check(&self, name: &str, text: &str) -> Diagnostics {
        match self.compile(name, text) {
            Ok(scene) => scene.diagnostics().clone(),
            Err(diagnostics) => diagnostics,
        }
    }
}

/// Returns the source of a scene in the standard layout. Formatting the result again changes
/// nothing.
///
/// ```
/// assert_eq!(sdfc::format("a.sdf", "sphere( 1 )")?, "sphere(1)\n");
/// # Ok::<(), sdfc::Diagnostics>(())
/// ```
///
/// # Errors
///
/// The syntax errors of a source that does not parse.
pub fn format(name: &str, text: &str) -> Result<String, Diagnostics> {
    let mut sources = Sources::new();
    let file = sources.add(name, text);
    let formatted = sdfc_syntax::format(&sources, file);
    formatted.map_err(|found| Diagnostics::new(Arc::new(sources), found))
}
