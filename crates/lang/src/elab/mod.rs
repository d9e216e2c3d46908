//! Elaboration: from the typed scene to the graph.
//!
//! Functions are inlined at each call, comprehensions and constant conditions are expanded, and
//! closures are values. The result consists of shape instances and their formulas. The elaborator
//! never decides the evaluation rate of a value (compile time, per frame or per point): the graph
//! knows it for every node.
//!
//! # Limits
//!
//! [`MAX_NODES`], [`MAX_STEPS`], [`MAX_RECURSION`], [`MAX_DEPTH`], [`MAX_ITERATIONS`],
//! [`MAX_NESTED_ITERATIONS`] and [`MAX_TEXT_BYTES`]. Exceeding one of the first four ends
//! elaboration, since further messages would only repeat the first one.

// A value of any type other than the expected one is reported in the same way.
#![allow(clippy::wildcard_enum_match_arm)]

mod call;
mod color;
mod definitions;
mod elaborator;
mod expr;
mod intersect;
mod iterate;
mod kernel;
mod lights;
mod limits;
mod literal_uses;
mod literals;
mod outlines;
mod output;
mod param_inputs;
mod params;
mod probe;
mod report;
mod scene;
mod sequence;
mod settings;
mod shape;
mod special;
mod surface_vectors;
mod text;
mod value;

use std::collections::BTreeSet;

use sdfc_diagnostics::Diagnostic;

use crate::assets::Assets;
use crate::hir;
use elaborator::Elaborator;
use literal_uses::LiteralUses;
pub(crate) use param_inputs::ParamInputs;

pub use limits::{
    MAX_DEPTH, MAX_ITERATIONS, MAX_NESTED_ITERATIONS, MAX_NODES, MAX_RECURSION, MAX_STEPS,
    MAX_TEXT_BYTES,
};
pub use output::{Claimed, Declared, DeclaredPromise, Elaborated, LiveLiteral, Site};
pub use param_inputs::CompileValues;

/// Elaborates a checked scene. If there is no scene, at least one diagnostic is an error; if there
/// is one, there may be warnings.
///
/// A param that decides what the scene consists of is a constant: its value among `values`, or its
/// default. All other params are per-frame inputs, unless they are to be `constant`.
pub fn elaborate(
    program: &hir::Program,
    assets: &Assets<'_>,
    values: &CompileValues,
    constant: bool,
) -> (Option<Elaborated>, Vec<Diagnostic>) {
    let mut params = ParamInputs::new(program.params.len(), values);
    if constant {
        params.fix_all();
    }
    loop {
        let result = elaborate_with(program, assets, params.clone());
        if result.elaborated.is_some() || !params.fix(&result.structural) {
            return (result.elaborated, result.diagnostics);
        }
    }
}

/// The params of a program.
pub(crate) fn declared_params(
    program: &hir::Program,
    assets: &Assets<'_>,
) -> Vec<sdfc_graph::Param> {
    let values = CompileValues::new();
    let inputs = ParamInputs::new(program.params.len(), &values);
    let mut elaborator = Elaborator::new(program, assets, inputs);
    program.params.iter().for_each(|param| elaborator.param(param));
    elaborator.params
}

/// The result of one elaboration.
pub(crate) struct Elaboration {
    /// The scene; `None` after an error.
    pub elaborated: Option<Elaborated>,
    pub diagnostics: Vec<Diagnostic>,
    /// How params that stand for literals are used.
    pub literals: LiteralUses,
    /// Per-frame params that would have to be constants.
    pub structural: BTreeSet<usize>,
}

/// Elaborates a scene once.
pub(crate) fn elaborate_with(
    program: &hir::Program,
    assets: &Assets<'_>,
    params: ParamInputs<'_>,
) -> Elaboration {
    let mut elaborator = Elaborator::new(program, assets, params);
    let scene = elaborator.scene();
    elaborator.explain_silence();
    let failed = sdfc_diagnostics::has_errors(&elaborator.diagnostics);
    let declared = definitions::declared(program, &elaborator.definitions);
    let Elaborator { sites, claims, diagnostics, literals, structural, .. } = elaborator;
    let (live_literals, as_written) = (Vec::new(), None);
    let elaborated = Elaborated { scene, sites, live_literals, as_written, declared, claims };
    let elaborated = (!failed).then_some(elaborated);
    Elaboration { elaborated, diagnostics, literals, structural }
}
