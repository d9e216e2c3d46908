//! Errors for clauses of the scene that samples refute (E0502).

use std::collections::BTreeMap;

use sdfc_analyze::{Clause, CopiesViolation, Violation, refute, refute_lipschitz};
use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::eval::FrameValues;
use sdfc_graph::{Param, ParamKind, ShapeId};
use sdfc_lang::{Claimed, Declared, Elaborated};

use super::origins::Origins;
use crate::params::degrees;

/// At most this many values of params are shown.
const MAX_VALUES: usize = 6;
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
            error = with_values(error, elaborated, &refuted.frame);
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
            "this states `lipschitz {}`, but {} the result changes {} times as much as any argument",
            number(fault.constant),
            place(&fault.from, &fault.to),
            number(fault.slope)
        );
        let help = "state the greatest change of the result when no argument changes by more than \
                    1, or remove the clause";
        let error = Diagnostic::error(Code::PROMISE_BROKEN, span, message).help(help);
        Some(with_values(error, elaborated, &fault.frame))
    });
    refuted.collect()
}

/// The error with the values that are no defaults.
fn with_values(error: Diagnostic, elaborated: &Elaborated, frame: &FrameValues) -> Diagnostic {
    let params = &elaborated.scene.params;
    let defaults = FrameValues::defaults(params);
    let pairs = params.iter().zip(frame.params.iter().zip(&defaults.params));
    let moved = pairs.filter(|(_, (value, default))| value != default);
    let mut values: Vec<String> = moved
        .map(|(param, (value, _))| format!("{} = {}", param.name, shown(param, value[0])))
        .collect();
    if values.len() > MAX_VALUES {
        values.truncate(MAX_VALUES);
        values.push("...".to_owned());
    }
    if frame.time != 0.0 {
        values.push(format!("time = {}", number(frame.time)));
    }
    if values.is_empty() { error } else { error.note(format!("with {}", values.join(", "))) }
}

/// Where two points are: near one of them if they look the same.
fn place(from: &[f64], to: &[f64]) -> String {
    let [from, to] = [from, to].map(point);
    if from == to { format!("near p = {from}") } else { format!("between p = {from} and {to}") }
}

/// A param's value as a scene writes it.
fn shown(param: &Param, value: f64) -> String {
    match param.kind {
        ParamKind::Angle => format!("{}deg", number(degrees(value))),
        ParamKind::Number
        | ParamKind::Int
        | ParamKind::Bool
        | ParamKind::Color
        | ParamKind::Choice => number(value),
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
                "this states `lipschitz {}`, but {} the field changes {} times as much as p",
                number(*constant),
                place(&refuted.at, to),
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
