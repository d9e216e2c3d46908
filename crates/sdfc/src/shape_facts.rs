//! Facts about the shapes that one call of a scene made.

use std::ops::Range;

use sdfc_analyze::{Promise, ShapeReport, cost_of_shapes};
use sdfc_graph::ShapeId;
use sdfc_lang::Site;

use crate::explanation::short;
use crate::scene::Scene;

/// Facts about the shapes that one call of a scene made, for the text of an editor.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShapeFacts {
    /// Number of different shapes: a call in a loop may make several.
    pub shapes: usize,
    /// The promises of the weakest of their fields, and the largest Lipschitz constant.
    pub quality: String,
    /// Arithmetic operations of one evaluation of these shapes by themselves.
    pub operations: usize,
    /// `operations` divided by those of the whole scene, without loops that stand for similar
    /// parts. The shares of shapes that have operations in common add up to more than 1.
    pub share: f64,
}

impl ShapeFacts {
    /// Returns the cost in a few words.
    pub fn cost(&self) -> String {
        let shapes =
            if self.shapes == 1 { String::new() } else { format!("{} shapes, ", self.shapes) };
        let percent = 100.0 * self.share;
        let share = if percent < 0.5 { "less than 1".to_owned() } else { format!("{percent:.0}") };
        let plural = if self.operations == 1 { "" } else { "s" };
        format!("{shapes}{} operation{plural}, {share} % of the scene", self.operations)
    }
}

impl Scene {
    /// Returns facts about the shapes that a call made, such as `sphere(1)` or `a | b`. The range
    /// is that of the whole call, in bytes of the scene's own file. `None` if there is no such
    /// call, or if it makes nothing that is drawn.
    ///
    /// ```
    /// let text = "sphere(1) | box(0.5)";
    /// let scene = sdfc::Compiler::new().compile("a.sdf", text)?;
    /// let facts = scene.shape_facts(0..9).ok_or("it is drawn")?;
    /// assert_eq!(facts.quality, "exact; Lipschitz constant 1");
    /// assert!(facts.share < 0.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn shape_facts(&self, call: Range<usize>) -> Option<ShapeFacts> {
        let own = sdfc_diagnostics::FileId(0);
        let is_made = |site: &&Site| {
            let range = site.span.start as usize..site.span.end as usize;
            site.span.file == own && range == call
        };
        let mut made: Vec<ShapeId> =
            self.sites().iter().filter(is_made).map(|it| it.shape).collect();
        made.sort_unstable();
        let is_known = |it: &&ShapeReport| made.binary_search(&it.shape).is_ok();
        let reports: Vec<&ShapeReport> = self.report.shapes.iter().filter(is_known).collect();
        let drawn: Vec<ShapeId> = reports.iter().map(|it| it.shape).collect();
        let graph = &self.graph().graph;
        let operations = cost_of_shapes(graph, &drawn)?.operations;
        Some(ShapeFacts {
            shapes: drawn.len(),
            quality: self.quality_of(&reports)?,
            operations,
            share: operations as f64 / self.operations_unrolled()?.max(1) as f64,
        })
    }

    /// Returns the calls that make a shape whose field is uncertified, each with the reason. The
    /// ranges are those of whole calls, in bytes of the scene's own file, in the order of the text.
    ///
    /// ```
    /// let text = "solid egg()\n  = length(p) - 1 - floor(p.x)\negg().translate(y: 1)";
    /// let scene = sdfc::Compiler::new().compile("a.sdf", text)?;
    /// let [(call, _reason)] = &scene.uncertified_calls()[..] else { panic!("it is one") };
    /// assert_eq!(&text[call.clone()], "egg()");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn uncertified_calls(&self) -> Vec<(Range<usize>, String)> {
        let own = sdfc_diagnostics::FileId(0);
        let reason = |site: &Site| {
            let found = self.report.uncertified.iter().find(|it| it.shape == site.shape)?;
            let range = site.span.start as usize..site.span.end as usize;
            Some((range, found.reason.to_string()))
        };
        let sites = self.sites().iter().filter(|site| site.span.file == own);
        let mut calls: Vec<_> = sites.filter_map(reason).collect();
        calls.sort_by_key(|(range, _)| (range.start, range.end));
        calls.dedup();
        calls
    }

    /// The operations of one evaluation of the scene, without loops that stand for similar parts.
    pub(crate) fn operations_unrolled(&self) -> Option<usize> {
        *self.operations.get_or_init(|| {
            let scene = self.graph();
            Some(cost_of_shapes(&scene.graph, scene.root.as_slice())?.operations)
        })
    }

    /// The promises of the weakest of some fields; `None` if there are none.
    fn quality_of(&self, reports: &[&ShapeReport]) -> Option<String> {
        let outside = reports.iter().map(|it| it.sides.outside).min()?;
        let inside = reports.iter().map(|it| it.sides.inside).min()?;
        let promise = match (outside, inside) {
            (Promise::Exact, Promise::Exact) => "exact".to_owned(),
            (Promise::Bound, Promise::Bound) => "a lower bound of the distance".to_owned(),
            (Promise::None, Promise::None) => "no promise about the distance".to_owned(),
            (outside, inside) => format!("outside {outside}, inside {inside}"),
        };
        let rows: Vec<_> = reports.iter().map(|it| self.quality_row(it, "")).collect();
        let uncertified = rows.iter().find(|row| !row.certified);
        let constants: Option<Vec<f64>> = rows.iter().map(|row| row.lipschitz).collect();
        let constant = match (uncertified, constants) {
            (Some(row), _) => {
                format!("uncertified: {}", row.why.as_deref().unwrap_or("no constant"))
            }
            (None, Some(all)) => {
                format!("Lipschitz constant {}", short(all.into_iter().fold(0.0, f64::max)))
            }
            (None, None) if rows.iter().any(|row| row.lipschitz_per_frame) => {
                "its Lipschitz constant depends on params".to_owned()
            }
            (None, None) => "no Lipschitz constant".to_owned(),
        };
        Some(format!("{promise}; {constant}"))
    }
}
