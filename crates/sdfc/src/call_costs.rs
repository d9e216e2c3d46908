//! Which calls of a scene its field spends its operations on.

use std::collections::BTreeMap;

use sdfc_analyze::cost_of_shapes;
use sdfc_diagnostics::Span;
use sdfc_graph::ShapeId;
use sdfc_lang::Site;

use crate::explanation::CallCost;
use crate::scene::Scene;

/// Largest number of calls that are looked at. Each is expanded by itself.
const MAX_CALLS: usize = 500;
/// Smallest number of operations of a scene whose calls are reported.
const LARGE: usize = 200;
/// Number of calls that are reported.
const REPORTED: usize = 5;
/// Smallest share of the scene's operations that is reported.
const SMALLEST: f64 = 0.05;
/// A call is left out if one call in its parentheses has this share of its operations.
const PASSED_ON: f64 = 0.9;

impl Scene {
    /// Returns the calls that make the most expensive shapes, the most expensive first. Empty if
    /// the scene has few operations or too many calls.
    pub(crate) fn call_costs(&self) -> Vec<CallCost> {
        let whole = self.operations_unrolled().unwrap_or(0);
        if whole < LARGE {
            return Vec::new();
        }
        let costs = self.costs_by_span().unwrap_or_default();
        let is_inside = |inner: &Span, outer: &Span| {
            inner.file == outer.file && outer.start <= inner.start && inner.end <= outer.end
        };
        let is_passed_on = |(outer, cost): &(&Site, usize)| {
            costs.iter().any(|(inner, part)| {
                let shorter = inner.span.end - inner.span.start < outer.span.end - outer.span.start;
                let most = *part as f64 >= PASSED_ON * *cost as f64;
                shorter && is_inside(&inner.span, &outer.span) && most
            })
        };
        let own = costs.iter().filter(|cost| !is_passed_on(cost));
        let mut reported: Vec<CallCost> = own
            .map(|&(site, operations)| {
                let start = self.sources().line_column(site.span.file, site.span.start);
                CallCost {
                    name: site.name.clone(),
                    line: start.line,
                    column: start.column,
                    operations,
                    share: operations as f64 / whole as f64,
                }
            })
            .filter(|call| call.share >= SMALLEST)
            .collect();
        reported.sort_by_key(|call| (std::cmp::Reverse(call.operations), call.line, call.column));
        reported.truncate(REPORTED);
        reported
    }

    /// The operations of the shapes of each call, by themselves; `None` if there are too many.
    fn costs_by_span(&self) -> Option<Vec<(&Site, usize)>> {
        let mut calls: BTreeMap<_, (&Site, Vec<ShapeId>)> = BTreeMap::new();
        let mut drawn: Vec<ShapeId> = self.report.shapes.iter().map(|it| it.shape).collect();
        drawn.sort_unstable();
        for site in self.sites() {
            if drawn.binary_search(&site.shape).is_ok() {
                let span = (site.span.file.0, site.span.start, site.span.end);
                calls.entry(span).or_insert((site, Vec::new())).1.push(site.shape);
            }
        }
        if calls.len() > MAX_CALLS {
            return None;
        }
        let graph = &self.graph().graph;
        let cost = |(site, shapes): (_, Vec<ShapeId>)| {
            Some((site, cost_of_shapes(graph, &shapes)?.operations))
        };
        Some(calls.into_values().filter_map(cost).collect())
    }
}
