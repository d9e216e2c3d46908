//! The state of elaboration.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_diagnostics::{Diagnostic, Span};
use sdfc_graph::{Bounds, Graph, NodeId, ShapeId};

use super::definitions::{definition_names, has_materials};
use super::literal_uses::LiteralUses;
use super::output::{Claimed, Site};
use super::param_inputs::ParamInputs;
use super::value::{ClosureKey, Value};
use crate::assets::Assets;
use crate::hir;

/// A value is missing because an error was reported. Values that depend on it report nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Poison;

/// A value, or nothing after an error.
pub(super) type Outcome<T> = Result<T, Poison>;

/// The variables of the current body.
#[derive(Clone, Debug, Default)]
pub(super) struct Env<'p> {
    pub(super) locals: Vec<Option<Value<'p>>>,
}

impl<'p> Env<'p> {
    /// Space for a number of variables.
    pub(super) fn new(locals: u32) -> Self {
        Self { locals: vec![None; locals as usize] }
    }

    /// Sets a variable.
    pub(super) fn set(&mut self, local: usize, value: Value<'p>) {
        self.put(local, Some(value));
    }

    /// Sets a variable, to `None` after an error.
    pub(super) fn put(&mut self, local: usize, value: Option<Value<'p>>) {
        if local >= self.locals.len() {
            self.locals.resize(local + 1, None);
        }
        self.locals[local] = value;
    }

    /// The value of a variable.
    pub(super) fn get(&self, local: hir::LocalId) -> Outcome<Value<'p>> {
        self.locals.get(local.0 as usize).cloned().flatten().ok_or(Poison)
    }
}

/// A call that is being elaborated.
#[derive(Clone, Copy, Debug)]
pub(super) struct CallFrame<'p> {
    /// The name of the callee.
    pub name: &'p str,
    /// The span of the call.
    pub span: Span,
}

/// The instances of a definition whose clause `intersect` is evaluated at the end; `None` if there
/// are too many.
pub(super) type PendingIntersections<'p> = Option<Vec<PendingIntersection<'p>>>;

/// An instance with its clause `intersect`, the variables of the clause, and the active calls.
pub(super) struct PendingIntersection<'p> {
    pub shape: ShapeId,
    pub stated: &'p hir::Intersect,
    pub env: Env<'p>,
    pub frames: Vec<CallFrame<'p>>,
}

/// The parts of a declaration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Within {
    /// The formula, and all that is outside of declarations.
    Formula,
    /// A clause, where infinite values mean "unknown".
    Clause,
    /// The material. No constants are derived from it, so it may contain loops.
    Material,
}

/// The state of elaboration.
pub(super) struct Elaborator<'p> {
    pub(super) program: &'p hir::Program,
    pub(super) assets: &'p Assets<'p>,
    pub(super) graph: Graph,
    pub(super) params: Vec<sdfc_graph::Param>,
    pub(super) globals: Vec<Option<Value<'p>>>,
    /// The names of definitions in the graph. They are unique, also if files declare the same name.
    pub(super) definitions: Vec<String>,
    /// True if any shape states a material. Otherwise material rules are not needed.
    pub(super) has_materials: bool,
    pub(super) closures: FxHashMap<ClosureKey, u32>,
    /// Created when bounds are first needed.
    pub(super) bounds: Option<Bounds>,
    pub(super) sites: Vec<Site>,
    pub(super) claims: Vec<Claimed>,
    pub(super) seen_sites: FxHashSet<(ShapeId, Span)>,
    /// The active calls, outermost first.
    pub(super) frames: Vec<CallFrame<'p>>,
    /// The number of active calls of each function.
    pub(super) active: Vec<u32>,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) reported: FxHashSet<Span>,
    pub(super) steps: u64,
    /// True if a limit was exceeded.
    pub(super) stopped: bool,
    /// The first span whose value is missing from the scene.
    pub(super) missing: Option<Span>,
    /// The part of a declaration that is being evaluated.
    pub(super) within: Within,
    /// The last value of `bounds(a)` in the step that `with_bounds` runs.
    pub(super) last_bounds: Option<[NodeId; 2]>,
    /// Instances with the clause `intersect`, by definition.
    pub(super) intersections: BTreeMap<hir::ShapeDefId, PendingIntersections<'p>>,
    /// How params that stand for literals are used.
    pub(super) literals: LiteralUses,
    /// Which params are constants.
    pub(super) inputs: ParamInputs<'p>,
    /// Per-frame params that would have to be constants.
    pub(super) structural: BTreeSet<usize>,
    /// True if `normal` or `view` was evaluated.
    pub(super) has_surface_vectors: bool,
    /// The conditions of the branches that are being elaborated and that are not constant.
    pub(super) conditions: Vec<NodeId>,
    /// The number of loops around the current body.
    pub(super) loop_depth: u8,
    /// The number of iterations of these loops, multiplied.
    pub(super) loop_iterations: usize,
}

impl<'p> Elaborator<'p> {
    /// The state before elaboration.
    pub(super) fn new(
        program: &'p hir::Program,
        assets: &'p Assets<'p>,
        inputs: ParamInputs<'p>,
    ) -> Self {
        Self {
            program,
            assets,
            graph: Graph::new(),
            params: Vec::new(),
            globals: vec![None; program.globals.len()],
            definitions: definition_names(program),
            has_materials: has_materials(program),
            closures: FxHashMap::default(),
            bounds: None,
            sites: Vec::new(),
            claims: Vec::new(),
            seen_sites: FxHashSet::default(),
            frames: Vec::new(),
            active: vec![0; program.functions.len()],
            diagnostics: Vec::new(),
            reported: FxHashSet::default(),
            steps: 0,
            stopped: false,
            missing: None,
            within: Within::Formula,
            last_bounds: None,
            intersections: BTreeMap::new(),
            literals: LiteralUses::new(inputs.first_literal),
            inputs,
            structural: BTreeSet::new(),
            has_surface_vectors: false,
            conditions: Vec::new(),
            loop_depth: 0,
            loop_iterations: 1,
        }
    }
}
