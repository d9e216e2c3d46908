//! Warnings about what the analyses could not prove, at the calls in the scene.

use rustc_hash::FxHashSet;
use sdfc_analyze::{CopiesObstacle, Film, Report, copies_obstacle, films};
use sdfc_diagnostics::{Code, Diagnostic, Sources};
use sdfc_graph::{Dim, ShapeId};
use sdfc_lang::{Declared, Elaborated, Site};

use super::origins::Origins;
use super::refutations::point;
use super::uncertified;

/// About how many scalar operations the search for films may take: some milliseconds.
const FILM_OPERATIONS: u64 = 1 << 22;

/// Returns the warnings W0601 (operators that need a distance and get a bound), W0602 (shapes
/// without a Lipschitz constant), W0606 (useless clauses) and W0609 (films).
pub(crate) fn warnings(
    elaborated: &Elaborated,
    report: &Report,
    sources: &Sources,
) -> Vec<Diagnostic> {
    let origins = Origins::new(elaborated);
    let mut seen = FxHashSet::default();
    let mut warnings = Vec::new();
    // No ray steps through regions.
    let stepped = report.uncertified.iter().filter(|_| !is_planar(elaborated));
    for part in stepped {
        let Some(site) = origins.nearest_call(part.shape) else { continue };
        if seen.insert((Code::UNCERTIFIED, site.span)) {
            let message = format!("`{}` is uncertified: {}", site.name, part.reason);
            let warning = Diagnostic::warning(Code::UNCERTIFIED, site.span, message);
            warnings.push(warning.help(uncertified::help(elaborated, report, part)));
        }
    }
    for part in &report.inexact_operators {
        let Some(site) = origins.call(part.shape) else { continue };
        if seen.insert((Code::NOT_EXACT, site.span)) {
            let message = format!(
                "`{}` is applied to a field that is only a bound: the distance between the \
                 surfaces will vary",
                site.name
            );
            let mut warning = Diagnostic::warning(Code::NOT_EXACT, site.span, message);
            if let Some(cause) = origins.nearest_call(part.cause) {
                warning = warning.note_at(cause.span, since("only a bound", cause, sources));
            }
            warnings.push(warning);
        }
    }
    warnings.extend(elaborated.declared.iter().filter_map(|shape| idle(elaborated, shape)));
    let is_own =
        |name: &str| elaborated.declared.iter().any(|declared| declared.definition == name);
    for film in films(&elaborated.scene, &is_own, FILM_OPERATIONS) {
        let Some(site) = origins.nearest_call(film.shape) else { continue };
        if seen.insert((Code::FILM, site.span)) {
            warnings.push(about_film(elaborated, site, &film));
        }
    }
    warnings
}

fn about_film(elaborated: &Elaborated, site: &Site, film: &Film) -> Diagnostic {
    let (name, at) = (&site.name, point(&film.at));
    let is_formula = elaborated.scene.graph.shape(film.shape).children.is_empty();
    let (message, help) = if is_formula {
        (
            format!(
                "`{name}` is a surface without an inside, for example at {at}: it is 0 there \
                     and negative nowhere near"
            ),
            "give it a thickness: subtract a length from the formula, such as 0.01",
        )
    } else {
        (
            format!(
                "`{name}` leaves a film without thickness, for example at {at}: two surfaces \
                     coincide there"
            ),
            "let the shape that cuts reach beyond the face, or let shapes that touch overlap",
        )
    };
    Diagnostic::warning(Code::FILM, site.span, message).help(help)
}

fn is_planar(elaborated: &Elaborated) -> bool {
    let graph = &elaborated.scene.graph;
    elaborated.scene.root.is_some_and(|root| graph.shape(root).dim == Dim::Two)
}

/// Warns about a clause `copies` that helps no instance of its declaration (W0606).
fn idle(elaborated: &Elaborated, declared: &Declared) -> Option<Diagnostic> {
    let span = declared.copies?;
    let graph = &elaborated.scene.graph;
    let is_instance = |&id: &ShapeId| graph.shape(id).definition == declared.definition;
    let mut reason = None;
    for shape in graph.shape_ids().filter(is_instance) {
        reason = Some(copies_obstacle(graph, shape)?);
    }
    let reason = match reason? {
        CopiesObstacle::NotASample => {
            "the `min(...)` has a term that is neither one sample nor a value without samples"
        }
        CopiesObstacle::NotRigid => "a sample is not at a rigid transform of p between jumps",
        CopiesObstacle::NoSample => "the `min(...)` has no sample",
        CopiesObstacle::NoLimit => {
            "the `min(...)` has no term that bounds the distance to the other copies"
        }
    };
    let message = format!("`copies` has no effect here: {reason}");
    let help = "write the formula as `min(sample, ..., limit)`; without that the shape is marched \
                as if the clause were absent";
    Some(Diagnostic::warning(Code::IDLE_CLAUSE, span, message).help(help))
}

/// Returns, for example, "only a bound because of `smooth` at line 3".
fn since(what: &str, cause: &Site, sources: &Sources) -> String {
    let line = sources.line_column(cause.span.file, cause.span.start).line;
    format!("{what} because of `{}` at line {line}", cause.name)
}
