//! What the analyses find, told at the scene's own text.

use std::collections::BTreeMap;

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_analyze::{
    Clause, CopiesObstacle, CopiesViolation, ParamValues, Report, Violation, copies_obstacle,
    refute, refute_lipschitz,
};
use sdfc_diagnostics::{Code, Diagnostic, Sources, Span};
use sdfc_graph::{Graph, ShapeId};
use sdfc_lang::{Claimed, Declared, Elaborated, Site};

/// Instances of one declaration whose clauses are sampled.
const SAMPLED: usize = 8;

/// Parts without a constant (W0602), and operators that want a distance and have a bound (W0601).
pub(crate) fn warnings(
    elaborated: &Elaborated,
    report: &Report,
    sources: &Sources,
) -> Vec<Diagnostic> {
    let places = Places::new(elaborated);
    let mut seen = FxHashSet::default();
    let mut found = Vec::new();
    for part in &report.uncertified {
        let Some(site) = places.of(part.shape) else { continue };
        if seen.insert((Code::UNCERTIFIED, site.span)) {
            let message = format!("`{}` is uncertified: {}", site.name, part.reason);
            let warning = Diagnostic::warning(Code::UNCERTIFIED, site.span, message);
            let help = "steps may lead through it, so `auto` proves stretches of rays where it can, which takes \
                        longer; state what holds with `lipschitz` and `bounds`";
            found.push(warning.help(help));
        }
    }
    for part in &report.inexact_operators {
        let Some(site) = places.own(part.shape) else { continue };
        if seen.insert((Code::NOT_EXACT, site.span)) {
            let message = format!(
                "`{}` of a field that is only a bound: its distance from the surface will be uneven",
                site.name
            );
            let mut warning = Diagnostic::warning(Code::NOT_EXACT, site.span, message);
            if let Some(cause) = places.of(part.cause) {
                warning = warning.note_at(cause.span, since("a bound", cause, sources));
            }
            found.push(warning);
        }
    }
    found.extend(soft_shadows(elaborated, report, &places, sources));
    found.extend(elaborated.declared.iter().filter_map(|shape| idle(elaborated, shape)));
    found
}

/// A clause `copies` that is of no use to any instance (W0606).
fn idle(elaborated: &Elaborated, declared: &Declared) -> Option<Diagnostic> {
    let span = declared.copies?;
    let mut graph = elaborated.scene.graph.clone();
    let instances: Vec<ShapeId> = instances(&graph, declared).collect();
    let mut reason = None;
    for shape in instances {
        reason = Some(copies_obstacle(&mut graph, shape)?);
    }
    let reason = match reason? {
        CopiesObstacle::NotASample => {
            "something in its formula's minimum is neither one sample nor a value without samples"
        }
        CopiesObstacle::NotRigid => "a sample is not at a rigid map of p between jumps",
        CopiesObstacle::NoSample => "its formula's minimum has no sample",
        CopiesObstacle::NoLimit => {
            "no value in its formula's minimum says how near others than its samples are"
        }
    };
    let message = format!("`copies` does nothing here: {reason}");
    let help = "the formula is `min(sample, ..., value)`; it is marched as without the clause";
    Some(Diagnostic::warning(Code::IDLE_CLAUSE, span, message).help(help))
}

/// The scene's instances of a declaration.
fn instances<'g>(graph: &'g Graph, declared: &'g Declared) -> impl Iterator<Item = ShapeId> + 'g {
    graph.shape_ids().filter(|&id| graph.shape(id).definition == declared.definition)
}

/// Soft shadows of a field that is not the distance outside (W0605).
fn soft_shadows(
    elaborated: &Elaborated,
    report: &Report,
    places: &Places<'_>,
    sources: &Sources,
) -> Vec<Diagnostic> {
    let Some(cause) = report.inexact_outside else { return Vec::new() };
    let message = "soft shadows are made of distances, which this scene's field is not everywhere";
    let warning = |&span| {
        let warning = Diagnostic::warning(Code::SOFT_SHADOW, span, message);
        match places.of(cause) {
            Some(cause) => warning.note_at(cause.span, since("not the distance", cause, sources)),
            None => warning,
        }
    };
    elaborated.soft_shadows.iter().map(warning).collect()
}

/// `a bound since `smooth` at line 3`.
fn since(what: &str, cause: &Site, sources: &Sources) -> String {
    let line = sources.line_column(cause.span.file, cause.span.start).line;
    format!("{what} since `{}` at line {line}", cause.name)
}

/// Clauses of the scene's own shapes that sampling refutes (E0502), at most one for each declaration.
pub(crate) fn refutations(elaborated: &Elaborated) -> Vec<Diagnostic> {
    let places = Places::new(elaborated);
    let graph = &elaborated.scene.graph;
    let mut found = Vec::new();
    for declared in &elaborated.declared {
        let instances: Vec<ShapeId> = instances(graph, declared).take(SAMPLED).collect();
        if let Some(refuted) = refute(&elaborated.scene, &instances).first()
            && let Some(mut error) = refutation(declared, refuted)
        {
            error = with_params(error, refuted.params);
            if let Some(site) = places.of(refuted.shape) {
                error = error.note_at(site.span, format!("in this `{}`", site.name));
            }
            found.push(error);
        }
    }
    found.extend(claims(elaborated));
    found
}

/// What functions state that sampling refutes, at most once for each function.
fn claims(elaborated: &Elaborated) -> Vec<Diagnostic> {
    let mut calls: BTreeMap<Span, Vec<&Claimed>> = BTreeMap::new();
    for claimed in &elaborated.claims {
        calls.entry(claimed.span).or_default().push(claimed);
    }
    let refuted = calls.into_iter().filter_map(|(span, calls)| {
        let fault = calls.into_iter().take(SAMPLED).find_map(|Claimed { value, claim, .. }| {
            refute_lipschitz(&elaborated.scene, *value, claim)
        })?;
        let message = format!(
            "this states `lipschitz {}`, but between p = {} and {} the result changes {} times as much as any \
             argument",
            number(fault.constant),
            point(&fault.from),
            point(&fault.to),
            number(fault.slope)
        );
        let help = "state the most that the result changes where each argument changes by at most 1, or drop the \
                    clause";
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
            // On a side on which both stand, `exact` is the one that says more.
            let stated = declared.promises.iter().find(|promise| {
                promise.exact >= *exact && (if *outside { promise.outside } else { promise.inside })
            })?;
            let word = if stated.exact { "exact" } else { "bound" };
            let distance = if *outside { *distance } else { -distance };
            let message = format!(
                "this states `{word}`, but at p = {at} the field is {field} and the distance {}",
                number(distance)
            );
            let help = if refuted.field.abs() < distance.abs() {
                "`bound`, if the field nowhere exceeds the distance; or drop the clause"
            } else {
                "drop the clause, or state how steep the field is with `lipschitz`"
            };
            Some(error(stated.span, message).help(help))
        }
        Clause::Lipschitz { constant, slope, to } => {
            let message = format!(
                "this states `lipschitz {}`, but between p = {at} and {} the field changes {} times as \
                 much as p",
                number(*constant),
                point(to),
                number(*slope)
            );
            let help = "state the largest slope within the bounds, or drop the clause";
            Some(error(declared.lipschitz?, message).help(help))
        }
        Clause::Intersect(fault) => {
            let [origin, direction] = fault.ray.map(|vector| point(&vector));
            let said = match fault.inside {
                Some(true) => "be inside",
                Some(false) => "be outside",
                None => "enter or leave",
            };
            let message = format!(
                "this states `intersect` by which the ray o = {origin}, d = {direction} should {said} at {at}, but the \
                 field there is {field}"
            );
            let help = "the intervals hold all of the ray that is inside, and begin and end where the field is 0";
            Some(error(declared.intersect?, message).help(help))
        }
        Clause::Copies(CopiesViolation { from, reach, to, .. }) => {
            let [middle, there] = [from, to].map(|place| point(place));
            let message = if from == to {
                format!(
                    "this states `copies`, but at p = {there} the field is {field}, and none of its samples is \
                     below 0 there"
                )
            } else {
                format!(
                    "this states `copies`, by which within {} of p = {middle} there is nothing but what is sampled \
                     there, but at {there}, which is nearer, the field is {field}",
                    number(*reach)
                )
            };
            let help = "what has no samples in the minimum ends before the nearest copy that is not sampled, and \
                        is not a part of the shape itself";
            Some(error(declared.copies?, message).help(help))
        }
        Clause::Bounds => {
            let message = format!(
                "this states bounds, but at p = {at}, which lies outside them, the field is {field}"
            );
            let help =
                "bounds hold all of the inside; leave out what you do not know: `inf` is allowed";
            Some(error(declared.bounds?, message).help(help))
        }
    }
}

/// Where the scene's text made which shape.
struct Places<'e> {
    own: FxHashMap<ShapeId, &'e Site>,
    parents: FxHashMap<ShapeId, Vec<ShapeId>>,
}

impl<'e> Places<'e> {
    fn new(elaborated: &'e Elaborated) -> Self {
        let mut own = FxHashMap::default();
        for site in &elaborated.sites {
            own.entry(site.shape).or_insert(site);
        }
        let mut parents: FxHashMap<ShapeId, Vec<ShapeId>> = FxHashMap::default();
        let graph = &elaborated.scene.graph;
        for shape in graph.shape_ids() {
            for &child in &graph.shape(shape).children {
                parents.entry(child).or_default().push(shape);
            }
        }
        Self { own, parents }
    }

    /// The first call that made the shape itself.
    fn own(&self, shape: ShapeId) -> Option<&'e Site> {
        self.own.get(&shape).copied()
    }

    /// That call, or of what the library built for itself, the call of the scene's that stands nearest above.
    fn of(&self, shape: ShapeId) -> Option<&'e Site> {
        let mut seen = FxHashSet::default();
        let mut pending = std::collections::VecDeque::from([shape]);
        while let Some(shape) = pending.pop_front() {
            if let Some(site) = self.own(shape) {
                return Some(site);
            }
            let above = self.parents.get(&shape).into_iter().flatten();
            pending.extend(above.copied().filter(|&parent| seen.insert(parent)));
        }
        None
    }
}

fn point(lanes: &[f64]) -> String {
    let lanes: Vec<String> = lanes.iter().map(|&lane| number(lane)).collect();
    format!("[{}]", lanes.join(", "))
}

/// A number with four digits, as scenes write it.
fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 12);
    let unit = 10f64.powi(digits);
    format!("{}", (value * unit).round() / unit + 0.0)
}
