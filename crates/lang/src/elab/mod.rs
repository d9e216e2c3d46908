//! Elaboration: from the typed scene to the graph.
//!
//! Functions are inlined at each call, comprehensions and constant conditions disappear, closures
//! are values. What remains are shape instances and the math that they are made of. Whether a
//! value is known at compile time, per frame or per point is never decided here: the graph knows
//! it of every node.
//!
//! # Limits
//!
//! [`MAX_NODES`], [`MAX_STEPS`], [`MAX_RECURSION`], [`MAX_DEPTH`], [`MAX_ROUNDS`] and [`MAX_NESTED_ROUNDS`]. The first
//! four end elaboration, since what follows would only repeat the message.

// A value of any other type than the one that is wanted is refused alike.
#![allow(clippy::wildcard_enum_match_arm)]

mod call;
mod color;
mod expr;
mod intersect;
mod iterate;
mod kernel;
mod lights;
mod literals;
mod probe;
mod report;
mod scene;
mod sequence;
mod settings;
mod shape;
mod special;
mod text;
mod value;

use std::collections::BTreeMap;

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_diagnostics::{Diagnostic, Span};
use sdfc_graph::{Bounds, Graph, LipschitzClaim, NodeId, Scene, ShapeId};

use crate::font::Fonts;
use crate::hir;
use literals::LiteralUses;
use report::Frame;
use value::{ClosureKey, Value};

/// Graph nodes of one scene.
pub const MAX_NODES: usize = 1_000_000;
/// Expressions that elaboration evaluates, repetitions counted.
pub const MAX_STEPS: u64 = 10_000_000;
/// Active calls of one function.
pub const MAX_RECURSION: u32 = 64;
/// Longest chain of shapes within shapes.
pub const MAX_DEPTH: u32 = 1024;
/// Rounds of one `iterate` over a count or a range; over a list there is one per element.
pub const MAX_ROUNDS: usize = 4096;
/// Rounds of loops within loops, multiplied.
pub const MAX_NESTED_ROUNDS: usize = 65_536;

/// A scene's graph with the way back to its text.
#[derive(Clone, Debug, Default)]
pub struct Elaborated {
    /// Shapes, math, params and settings.
    pub scene: Scene,
    /// Which calls built which shapes, in order of elaboration. Equal shapes share an instance,
    /// so one instance may have several sites.
    pub sites: Vec<Site>,
    /// Literals that are params: none unless [`crate::Options::live_literals`] is set.
    pub live_literals: Vec<LiveLiteral>,
    /// The shapes that the scene and what it imports declare, with the places of their clauses.
    pub declared: Vec<Declared>,
    /// What functions of the scene's own state of their results, by call.
    pub claims: Vec<Claimed>,
    /// Where the scene asks for soft shadows.
    pub soft_shadows: Vec<Span>,
}

/// The result of a call of a function that states a constant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claimed {
    /// Where the constant is stated.
    pub span: Span,
    /// The result.
    pub value: NodeId,
    /// What is stated of it.
    pub claim: LipschitzClaim,
}

/// A declared shape and where its clauses stand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Declared {
    /// The name that its instances carry as their definition.
    pub definition: String,
    /// The promises that it states.
    pub promises: Vec<DeclaredPromise>,
    /// Where it states its Lipschitz constant.
    pub lipschitz: Option<Span>,
    /// Where it states its bounds.
    pub bounds: Option<Span>,
    /// Where it states where rays are inside.
    pub intersect: Option<Span>,
    /// Where it states that what it does not sample is no nearer than it says.
    pub copies: Option<Span>,
}

/// `exact` or `bound`, and where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeclaredPromise {
    /// Whether it is `exact`.
    pub exact: bool,
    /// Whether it speaks of the outside.
    pub outside: bool,
    /// Whether it speaks of the inside.
    pub inside: bool,
    /// Its place.
    pub span: Span,
}

/// A literal of the scene that became a param, see [`crate::live_literals`].
#[derive(Clone, Debug, PartialEq)]
pub struct LiveLiteral {
    /// Where it is written.
    pub span: Span,
    /// Its value there.
    pub value: f64,
    /// The index of its param.
    pub param: usize,
}

/// A place in the scene's own files that built a shape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Site {
    /// The instance.
    pub shape: ShapeId,
    /// The call; for a shape that the library builds, the scene's call of that entry.
    pub span: Span,
    /// Name of the definition.
    pub name: String,
}

/// Elaborates a checked scene. Without a scene there is at least one error; with one there may
/// still be warnings.
pub fn elaborate(
    program: &hir::Program,
    fonts: &Fonts<'_>,
) -> (Option<Elaborated>, Vec<Diagnostic>) {
    let (elaborated, diagnostics, _) = elaborate_with(program, fonts, program.params.len());
    (elaborated, diagnostics)
}

/// As [`elaborate`], for a scene whose params from a position on stand for literals, with what was found
/// out about these.
pub(crate) fn elaborate_with(
    program: &hir::Program,
    fonts: &Fonts<'_>,
    first_literal: usize,
) -> (Option<Elaborated>, Vec<Diagnostic>, LiteralUses) {
    let mut elaborator = Elaborator::new(program, fonts, first_literal);
    let scene = elaborator.scene();
    elaborator.explain_silence();
    let failed = sdfc_diagnostics::has_errors(&elaborator.diagnostics);
    let declared = shape::declared(program, &elaborator.definitions);
    let Elaborator { soft_shadows, sites, claims, diagnostics, literals, .. } = elaborator;
    let elaborated =
        Elaborated { scene, sites, live_literals: Vec::new(), declared, claims, soft_shadows };
    ((!failed).then_some(elaborated), diagnostics, literals)
}

/// An error was reported; what depends on the value stays silent.
#[derive(Clone, Copy, Debug)]
struct Poison;

type Outcome<T> = Result<T, Poison>;

/// The variables of the body at hand.
#[derive(Clone, Debug, Default)]
struct Env<'p> {
    locals: Vec<Option<Value<'p>>>,
}

impl<'p> Env<'p> {
    fn new(locals: u32) -> Self {
        Self { locals: vec![None; locals as usize] }
    }

    fn set(&mut self, local: usize, value: Value<'p>) {
        self.put(local, Some(value));
    }

    /// Gives a variable its value, or none where that is poisoned.
    fn put(&mut self, local: usize, value: Option<Value<'p>>) {
        if local >= self.locals.len() {
            self.locals.resize(local + 1, None);
        }
        self.locals[local] = value;
    }

    fn get(&self, local: hir::LocalId) -> Outcome<Value<'p>> {
        self.locals.get(local.0 as usize).cloned().flatten().ok_or(Poison)
    }
}

struct Elaborator<'p> {
    program: &'p hir::Program,
    fonts: &'p Fonts<'p>,
    graph: Graph,
    params: Vec<sdfc_graph::Param>,
    globals: Vec<Option<Value<'p>>>,
    /// Names of definitions in the graph: unique where files declare the same name.
    definitions: Vec<String>,
    /// Whether any shape states a material. Without one nobody asks how materials mix.
    paints: bool,
    closures: FxHashMap<ClosureKey, u32>,
    /// Made when the first bounds are asked for.
    bounds: Option<Bounds>,
    sites: Vec<Site>,
    claims: Vec<Claimed>,
    /// Where the scene asks for soft shadows.
    soft_shadows: Vec<Span>,
    seen_sites: FxHashSet<(ShapeId, Span)>,
    /// Calls from the outermost inwards.
    frames: Vec<Frame<'p>>,
    /// Active calls of each function.
    active: Vec<u32>,
    diagnostics: Vec<Diagnostic>,
    reported: FxHashSet<Span>,
    steps: u64,
    /// A limit was reached.
    stopped: bool,
    /// The first place whose value is missing from the scene.
    missing: Option<Span>,
    /// Within a clause, where infinite values mean "not known".
    in_clause: bool,
    /// `bounds(a)` was asked for since this was last set to false.
    asked_bounds: bool,
    /// Shapes that rays may meet in closed form, by definition.
    waiting: BTreeMap<hir::ShapeDefId, intersect::Waiting<'p>>,
    /// What is known of the params that stand for literals.
    literals: LiteralUses,
    /// How many loops the body at hand lies in.
    loop_depth: u8,
    /// How often their rounds run it.
    loop_rounds: usize,
}

impl<'p> Elaborator<'p> {
    fn new(program: &'p hir::Program, fonts: &'p Fonts<'p>, first_literal: usize) -> Self {
        Self {
            program,
            fonts,
            graph: Graph::new(),
            params: Vec::new(),
            globals: vec![None; program.globals.len()],
            definitions: shape::definition_names(program),
            paints: shape::paints(program),
            closures: FxHashMap::default(),
            bounds: None,
            sites: Vec::new(),
            claims: Vec::new(),
            soft_shadows: Vec::new(),
            seen_sites: FxHashSet::default(),
            frames: Vec::new(),
            active: vec![0; program.functions.len()],
            diagnostics: Vec::new(),
            reported: FxHashSet::default(),
            steps: 0,
            stopped: false,
            missing: None,
            in_clause: false,
            asked_bounds: false,
            waiting: BTreeMap::new(),
            literals: LiteralUses::new(first_literal),
            loop_depth: 0,
            loop_rounds: 1,
        }
    }
}
