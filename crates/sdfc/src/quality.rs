//! The properties of each shape of a scene, with the call that made it.

use sdfc_analyze::{Lipschitz, ShapeReport};
use sdfc_graph::eval::evaluate_frame;
use sdfc_graph::{Dim, NodeId, ShapeId};
use sdfc_lang::Site;

use crate::explanation::{Bounds, QualityRow};
use crate::scene::Scene;

impl Scene {
    /// Returns one row for each call in the scene whose shape is drawn.
    pub(crate) fn quality_rows(&self) -> Vec<QualityRow> {
        let report = |site: &Site| self.report.shapes.iter().find(|s| s.shape == site.shape);
        let sites: Vec<(&Site, &ShapeReport)> =
            self.sites().iter().filter_map(|site| Some((site, report(site)?))).collect();

        let graph = &self.graph().graph;
        let shapes: Vec<ShapeId> = sites.iter().map(|(site, _)| site.shape).collect();
        let mut extract = graph.extract(&[], &shapes);
        let mut derived = sdfc_graph::Bounds::new(self.params());
        let mut corners: Vec<NodeId> = Vec::new();
        let mut reaches = Vec::new();
        for shape in shapes {
            let Some(shape) = extract.shape(shape) else { continue };
            corners.extend(derived.of(&mut extract.graph, shape));
            reaches.push(derived.max_offset(&mut extract.graph, shape));
        }
        let corners = evaluate_frame(&extract.graph, &corners, &self.defaults());
        let (corners, _) = corners.as_chunks::<2>();

        let rows = sites.iter().zip(corners).zip(reaches);
        let mut rows: Vec<QualityRow> = rows
            .map(|(((site, shape), corners), reach)| {
                let start = self.sources().line_column(site.span.file, site.span.start);
                // A region has no third coordinate.
                let far = if graph.shape(site.shape).dim == Dim::Two { f64::INFINITY } else { 0.0 };
                let corner = |[x, y, z, _]: [f64; 4]| [x, y, z + far];
                QualityRow {
                    line: start.line,
                    column: start.column,
                    bounds: Bounds::of(corners.map(corner)),
                    blend_margin: reach,
                    ..self.quality_row(shape, &site.name)
                }
            })
            .collect();
        rows.sort_by_key(|row| (row.line, row.column));
        rows
    }

    /// Says which shape has the largest Lipschitz constant and what to do about it, if that makes
    /// steps shorter.
    #[cfg(feature = "render")]
    pub(crate) fn steepest_shape(&self) -> Option<String> {
        let constant = |shape: &&ShapeReport| match shape.lipschitz {
            Lipschitz::Number(constant) => constant,
            Lipschitz::PerFrame | Lipschitz::Unknown(_) => 0.0,
        };
        let divided = self.report.shapes.iter().filter(|shape| shape.divided);
        let steepest = divided.max_by(|a, b| constant(a).total_cmp(&constant(b)))?;
        let factor = (1e3 * constant(&steepest)).round() / 1e3;
        let name = &self.graph().graph.shape(steepest.shape).definition;
        (factor >= 2.0).then(|| {
            format!(
                "steps are {factor} times shorter because of the Lipschitz constant of \
                 `{name}`: make it less steep, or state a smaller `lipschitz` if one holds"
            )
        })
    }

    /// Returns the results of the analysis, without the location.
    pub(crate) fn quality_row(&self, shape: &ShapeReport, name: &str) -> QualityRow {
        let uncertified = self.report.uncertified.iter().find(|u| u.shape == shape.shape);
        let lipschitz = match shape.lipschitz {
            Lipschitz::Number(value) => Some(value),
            Lipschitz::PerFrame | Lipschitz::Unknown(_) => None,
        };
        let why = match (&shape.lipschitz, uncertified) {
            (_, Some(found)) => Some(found.reason.to_string()),
            (Lipschitz::Unknown(_), None) if shape.sides.is_bound() => {
                Some("a bound; it needs no constant".to_owned())
            }
            (Lipschitz::Unknown(reason), None) => Some(reason.to_string()),
            (_, None) if shape.from_interval_derivatives => {
                Some("constant from interval derivatives within its bounds".to_owned())
            }
            (_, None) if shape.divided => Some("divided by its constant".to_owned()),
            (_, None) => None,
        };
        QualityRow {
            name: name.to_owned(),
            line: 0,
            column: 0,
            outside: shape.sides.outside.to_string(),
            inside: shape.sides.inside.to_string(),
            lipschitz,
            lipschitz_per_frame: shape.lipschitz == Lipschitz::PerFrame,
            jump: shape.jump,
            blend_margin: None,
            bounds: Bounds::default(),
            certified: uncertified.is_none()
                && (shape.sides.is_bound() || !matches!(shape.lipschitz, Lipschitz::Unknown(_))),
            why,
        }
    }
}
