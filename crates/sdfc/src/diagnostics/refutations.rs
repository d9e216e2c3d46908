//! Errors for clauses of the scene that samples refute (E0502).

use std::collections::BTreeMap;

use sdfc_analyze::{Clause, CopiesViolation, ParamValues, Violation, refute, refute_lipschitz};
use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::ShapeId;
use sdfc_lang::{Claimed, Declared, Elaborated};

use super::origins::Origins;

/// At most this many instances of a declaration are sampled.
const MAX_SAMPLED: usize = 8;
/// About how many scalar operations the tests of all declarations may take together: some seconds.
/// Formulas that take more are sampled at fewer points.
const MAX_OPERATIONS: u64 = 1 << 31;

/// Returns at most one error for each declaration of the scene.
pub(crate) fn refutations(elaborated: &Elaborated) -> Vec<Diagnostic> {
    let origins = Origins::new(elaborated);
    let graph = &elaborated.scene.graph;
    let mut errors = Vec::new();
    let share = MAX_OPERATIONS / (elaborated.declared.len() as u64).max(1);
    for declared in &elaborated.declared {
        let instances = graph.shape_ids();
        let instances = instances.filter(|&id| graph.shape(id).definition == declared.definition);
        let instances: Vec<ShapeId> = instances.take(MAX_SAMPLED).collect();
        if let Some(refuted) = refute(&elaborated.scene, &instances, share).first()
            && let Some(mut error) = refutation(declared, refuted)
        {
            error = with_params(error, refuted.params);
            if let Some(site) = origins.nearest_call(refuted.shape) {
                error = error.note_at(site.span, format!("in this `{}`", site.name));
            }
            errors.push(error);
        }
    }
    errors.extend(functions(elaborated));
    errors
}

/// Returns at most one error for each function whose clause `lipschitz` is refuted.
fn functions(elaborated: &Elaborated) -> Vec<Diagnostic> {
    let mut calls: BTreeMap<Span, Vec<&Claimed>> = BTreeMap::new();
    for claimed in &elaborated.claims {
        calls.entry(claimed.span).or_default().push(claimed);
    }
    let share = MAX_OPERATIONS / (MAX_SAMPLED * calls.len()).max(1) as u64;
    let refuted = calls.into_iter().filter_map(|(span, calls)| {
        let mut sampled = calls.into_iter().take(MAX_SAMPLED);
        let fault = sampled.find_map(|Claimed { value, claim, .. }| {
            refute_lipschitz(&elaborated.scene, *value, claim, share)
        })?;
        let message = format!(
            "this states `lipschitz {}`, but between p = {} and {} the result changes {} times as \
             much as any argument",
            number(fault.constant),
            point(&fault.from),
            point(&fault.to),
            number(fault.slope)
        );
        let help = "state the greatest change of the result when no argument changes by more than \
                    1, or remove the clause";
        let error = Diagnostic::error(Code::PROMISE_BROKEN, span, message).help(help);
        Some(with_params(error, fault.params))
    });
    refuted.collect()
}

fn with_params(error: Diagnostic, params: ParamValues) -> Diagnostic {
    match params {
        ParamValues::Default => error,
        ParamValues::Low => error.note("with all params at the low ends of their ranges"),
        ParamValues::High => error.note("with all params at the high ends of their ranges"),
    }
}

fn refutation(declared: &Declared, refuted: &Violation) -> Option<Diagnostic> {
    let at = point(&refuted.at);
    let field = number(refuted.field);
    let error = |span, message| Diagnostic::error(Code::PROMISE_BROKEN, span, message);
    match &refuted.clause {
        Clause::Distance { exact, outside, distance } => {
            // On a side where both are stated, `exact` is the stronger clause.
            let stated = declared.promises.iter().find(|promise| {
                promise.exact >= *exact && (if *outside { promise.outside } else { promise.inside })
            })?;
            let word = if stated.exact { "exact" } else { "bound" };
            let distance = if *outside { *distance } else { -distance };
            let message = format!(
                "this states `{word}`, but at p = {at} the field is {field} and the distance is {}",
                number(distance)
            );
            let help = if refuted.field.abs() < distance.abs() {
                "state `bound` if the field never exceeds the distance, or remove the clause"
            } else {
                "remove the clause, or state the slope of the field with `lipschitz`"
            };
            Some(error(stated.span, message).help(help))
        }
        Clause::Lipschitz { constant, slope, to } => {
            let message = format!(
                "this states `lipschitz {}`, but between p = {at} and {} the field changes {} \
                 times as much as p",
                number(*constant),
                point(to),
                number(*slope)
            );
            let help = "state the greatest slope within the bounds, or remove the clause";
            Some(error(declared.lipschitz?, message).help(help))
        }
        Clause::Intersect(fault) => {
            let [origin, direction] = fault.ray.map(|vector| point(&vector));
            let stated = match fault.inside {
                Some(true) => "is inside",
                Some(false) => "is outside",
                None => "enters or leaves",
            };
            let message = format!(
                "`intersect` is violated: it states that the ray o = {origin}, d = {direction} {stated} \
                 at {at}, but the field there is {field}"
            );
            let help = "the intervals must cover every part of the ray that is inside, and must \
                        begin and end where the field is 0";
            Some(error(declared.intersect?, message).help(help))
        }
        Clause::Copies(CopiesViolation { from, reach, to, .. }) => {
            let [center, there] = [from, to].map(|position| point(position));
            let message = if from == to {
                format!(
                    "`copies` is violated: at p = {there} the field is {field}, but no sample is \
                     below 0 there"
                )
            } else {
                format!(
                    "`copies` is violated: only sampled copies may lie within {} of p = {center}, \
                     but the field at {there} is {field}",
                    number(*reach)
                )
            };
            let help = "terms of the minimum without samples must reach 0 before the nearest copy \
                        that is not sampled, and must not be part of the shape";
            Some(error(declared.copies?, message).help(help))
        }
        Clause::Bounds => {
            let message = format!(
                "this states bounds, but at p = {at}, which lies outside them, the field is {field}"
            );
            let help = "the bounds must contain the whole inside; leave out limits that you do \
                        not know: `inf` is allowed";
            Some(error(declared.bounds?, message).help(help))
        }
    }
}

/// Returns a point as scenes write it, with four significant digits.
pub(super) fn point(lanes: &[f64]) -> String {
    let lanes: Vec<String> = lanes.iter().map(|&lane| number(lane)).collect();
    format!("[{}]", lanes.join(", "))
}

/// Returns a number with four significant digits, as scenes write it.
fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 12);
    let unit = 10f64.powi(digits);
    format!("{}", (value * unit).round() / unit + 0.0)
}
