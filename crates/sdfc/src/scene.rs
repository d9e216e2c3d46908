//! A compiled scene.

use std::sync::OnceLock;

use sdfc_analyze::{LoopStrategy, Prepared, Report};
use sdfc_diagnostics::Sources;
use sdfc_graph::eval::{FrameValues, TapeError};
use sdfc_graph::{Param, Program};
use sdfc_lang::live_literals::LiveLiteral;
use sdfc_lang::{Elaborated, Site};
use sdfc_render::{Pose, View};

use crate::derived_bounds::{DerivedBounds, focus_at_one_frame};
use crate::diagnostics::Diagnostics;
use crate::error::Error;
use crate::source_id::SourceId;
use crate::tapes::Tapes;

/// Time spent before code generation, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FrontTimes {
    /// Parsing, checking, elaborating.
    pub front: f64,
    /// Analyses and passes.
    pub analyze: f64,
}

/// A compiled scene, before a target is chosen.
///
/// It can be evaluated on the CPU ([`Self::field`]), written as a shader ([`Self::write_shader`]),
/// explained ([`Self::explain`]) and, with the feature `render`, drawn (`render`).
#[derive(Debug)]
pub struct Scene {
    pub(crate) diagnostics: Diagnostics,
    pub(crate) elaborated: Elaborated,
    pub(crate) program: Program,
    pub(crate) report: Report,
    pub(crate) loops: LoopStrategy,
    /// The program with its origin at what the camera looks at, if pictures need that. Built when
    /// the first picture is drawn.
    pub(crate) rebased: OnceLock<Option<Program>>,
    /// Derived on first use; a shader needs no bounds.
    pub(crate) bounds: OnceLock<Option<DerivedBounds>>,
    /// True if `interval` proves most rays within its steps. Determined on first use.
    pub(crate) intervals_prove: OnceLock<bool>,
    /// The tapes that evaluate the field. Built on first use.
    pub(crate) tapes: OnceLock<Result<Option<Tapes>, TapeError>>,
    /// The operations of all shapes by themselves. Counted on first use.
    pub(crate) operations: OnceLock<Option<usize>>,
    pub(crate) times: FrontTimes,
    pub(crate) id: SourceId,
}

impl Scene {
    pub(crate) fn new(
        diagnostics: Diagnostics,
        elaborated: Elaborated,
        prepared: Prepared,
        loops: LoopStrategy,
        times: FrontTimes,
        id: SourceId,
    ) -> Self {
        let Prepared { program, report } = prepared;
        let (rebased, bounds, intervals_prove, tapes, operations) = Default::default();
        Self {
            diagnostics,
            elaborated,
            program,
            report,
            loops,
            rebased,
            bounds,
            intervals_prove,
            tapes,
            operations,
            times,
            id,
        }
    }

    /// The warnings of the compilation.
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// The sources that the scene was compiled from: its own, the library and all imports.
    pub fn sources(&self) -> &Sources {
        self.diagnostics.sources()
    }

    /// The params, in order of declaration.
    pub fn params(&self) -> &[Param] {
        &self.program.params
    }

    /// The params' defaults, at time 0 and frame 0.
    pub fn defaults(&self) -> FrameValues {
        FrameValues::defaults(self.params())
    }

    /// The numbers of the scene that are params. Empty unless compiled with
    /// [`Compiler::live_literals`](crate::Compiler::live_literals).
    pub fn live_literals(&self) -> &[LiveLiteral] {
        &self.elaborated.live_literals
    }

    /// True if the scene draws anything.
    pub fn draws(&self) -> bool {
        self.program.distance.is_some()
    }

    /// True if the scene draws regions: its picture is planar, and its field is a function of x and
    /// y.
    pub fn is_planar(&self) -> bool {
        self.program.is_planar()
    }

    /// True if the field is proven never to exceed the distance to the surface.
    pub fn is_certified(&self) -> bool {
        self.report.uncertified.is_empty()
    }

    /// Lowest and highest corner of the scene at a frame, infinite where the scene has no limit.
    /// `None` if nothing is drawn.
    pub fn bounds_at(&self, frame: &FrameValues) -> Option<[[f64; 3]; 2]> {
        let derive = || DerivedBounds::of(&self.elaborated.scene);
        self.bounds.get_or_init(derive).as_ref()?.at(frame)
    }

    /// Lowest and highest corner of what a camera looks at in a scene that states none, at one
    /// frame: of all shapes, but without unbounded ones, such as a floor, if there are others.
    pub fn focus_at(&self, frame: &FrameValues) -> Option<[[f64; 3]; 2]> {
        let Elaborated { scene, live_literals, as_written, .. } = &self.elaborated;
        // A clause that reads the bounds of a shape has their values for all values of the live
        // literals, which are wider than those for constants.
        let is_written =
            |it: &LiveLiteral| frame.params.get(it.param).is_some_and(|value| value[0] == it.value);
        let as_written = as_written.as_deref().filter(|_| live_literals.iter().all(is_written));
        focus_at_one_frame(as_written.unwrap_or(scene), frame)
    }

    /// The camera of a frame, for a picture whose width is `aspect` times its height: the scene's,
    /// or one that sees the whole scene. With live literals that have the values in the source, it
    /// is the same as without.
    ///
    /// # Errors
    ///
    /// [`Error::View`].
    pub fn pose(&self, frame: &FrameValues, aspect: f64) -> Result<Pose, Error> {
        // Bounds for all values of the params would be wider, and so would be the picture.
        let bounds = match self.program.settings.camera {
            Some(_) => None,
            None => self.focus_at(frame),
        };
        Ok(Pose::new(self.drawn(), frame, bounds, aspect)?)
    }

    /// The view of a picture of `size` pixels at a frame.
    ///
    /// # Errors
    ///
    /// [`Error::View`].
    pub fn view(&self, frame: &FrameValues, size: [u32; 2]) -> Result<View, Error> {
        let pose = self.pose(frame, f64::from(size[0]) / f64::from(size[1].max(1)))?;
        Ok(View::from_pose(self.drawn(), frame, self.bounds_at(frame), size, &pose)?)
    }

    /// Time spent so far.
    pub fn times(&self) -> FrontTimes {
        self.times
    }

    /// A hash of everything that the scene was compiled from, including the library and imports:
    /// 16 hexadecimal digits (FNV-1a).
    pub fn source_hash(&self) -> String {
        format!("{:016x}", self.id.hash)
    }
}

/// Internal representations, for the other crates of this workspace.
impl Scene {
    /// Returns an error that names `what` if the scene draws regions.
    ///
    /// # Errors
    ///
    /// [`Error::Planar`].
    pub fn needs_solids(&self, what: &'static str) -> Result<(), Error> {
        if self.is_planar() { Err(Error::Planar(what)) } else { Ok(()) }
    }

    /// The flat program, with its origin at the origin of the scene.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The graph with its shapes, as elaborated.
    pub fn graph(&self) -> &sdfc_graph::Scene {
        &self.elaborated.scene
    }

    /// The calls that made the shapes.
    pub fn sites(&self) -> &[Site] {
        &self.elaborated.sites
    }

    /// The results of the analyses.
    pub fn report(&self) -> &Report {
        &self.report
    }
}
