//! The whole scene: params, lets, settings and the shapes to draw.

use rustc_hash::FxHashSet;
use sdfc_diagnostics::{Code as ErrorCode, Span};
use sdfc_graph::{Graph, MaterialRule, Scene, ShapeId};

use super::elaborator::{Elaborator, Env, Outcome, Poison};
use super::report::{show_lanes, show_number};
use super::value::Value;
use crate::hir;

impl<'p> Elaborator<'p> {
    /// Elaborates the scene. Errors of independent parts are all reported.
    pub(super) fn scene(&mut self) -> Scene {
        let program = self.program;
        for param in &program.params {
            self.param(param);
        }
        for (index, global) in program.globals.iter().enumerate() {
            let value = self.eval(&mut Env::new(global.locals), &global.value).ok();
            if let Some(Value::Shape(shape)) = &value {
                self.graph.name_shape(*shape, &global.name);
            }
            self.globals[index] = value;
        }
        let settings = self.settings();
        let (root, layers) = self.drawn();
        self.add_intersections();
        let has_materials = root.is_some_and(|root| has_material(&self.graph, root));
        let graph = std::mem::take(&mut self.graph);
        let params = std::mem::take(&mut self.params);
        Scene { graph, root, layers, params, settings, has_materials }
    }

    /// The union of the shapes to draw, and the shapes themselves if they are regions. One shape is
    /// its own union.
    fn drawn(&mut self) -> (Option<ShapeId>, Vec<ShapeId>) {
        let shapes = self.shapes_to_draw();
        let layer = |(value, _): &(Value<'p>, Span)| match value {
            Value::Shape(shape) => Some(*shape),
            _ => None,
        };
        let is_planar = self.program.is_planar();
        let layers = shapes.iter().filter(|_| is_planar).filter_map(layer).collect();
        (self.united(shapes), layers)
    }

    fn shapes_to_draw(&mut self) -> Vec<(Value<'p>, Span)> {
        let program = self.program;
        let mut shapes = Vec::with_capacity(program.drawn.len());
        for expr in &program.drawn {
            match self.eval(&mut Env::new(program.locals), expr) {
                Ok(value) => shapes.push((value, expr.span)),
                Err(Poison) => self.missing = self.missing.or(Some(expr.span)),
            }
        }
        shapes
    }

    fn united(&mut self, shapes: Vec<(Value<'p>, Span)>) -> Option<ShapeId> {
        let (first, span) = shapes.first()?.clone();
        if let (Value::Shape(shape), [_]) = (&first, &shapes[..]) {
            return Some(*shape);
        }
        let parts = Value::List(shapes.into_iter().map(|(value, _)| value).collect());
        match self.instance(self.program.union?, vec![Some((parts, span))], span) {
            Ok(Value::Shape(shape)) => {
                // The scene's source does not contain this call.
                self.sites.retain(|site| (site.shape, site.span) != (shape, span));
                Some(shape)
            }
            Ok(_) | Err(Poison) => {
                self.missing = self.missing.or(Some(span));
                None
            }
        }
    }

    /// The components of a node that must be constant.
    pub(super) fn constant_lanes(
        &mut self,
        node: sdfc_graph::NodeId,
        span: Span,
        what: &str,
    ) -> Outcome<[f64; 4]> {
        match self.as_lanes(node) {
            Some((lanes, _)) => Ok(lanes),
            None => Err(self.not_constant(span, what, node)),
        }
    }

    /// Evaluates a number that must be constant and within a range.
    pub(super) fn number_within(
        &mut self,
        expr: &'p hir::Expr,
        what: &str,
        range: [f64; 2],
    ) -> Outcome<f64> {
        let node = self.number(&mut Env::new(self.program.locals), expr)?;
        let value = self.constant_lanes(node, expr.span, what)?[0];
        if range[0] <= value && value <= range[1] {
            return Ok(value);
        }
        let value = show_lanes(&[value]);
        let message = match range {
            [lo, hi] if hi < f64::from(f32::MAX) => {
                format!("{what} is {value}, outside {}..{}", show_number(lo), show_number(hi))
            }
            [0.0, _] => format!("{what} is {value}, but must be at least 0 and finite"),
            _ => format!("{what} is {value}, but must be above 0 and finite"),
        };
        Err(self.fail(ErrorCode::OUT_OF_RANGE, expr.span, message))
    }
}

/// True if a shape or any of its descendants has a material.
fn has_material(graph: &Graph, root: ShapeId) -> bool {
    let mut seen = FxHashSet::default();
    let mut stack = vec![root];
    while let Some(id) = stack.pop() {
        if !seen.insert(id) {
            continue;
        }
        let shape = graph.shape(id);
        if matches!(shape.material, MaterialRule::Explicit(_)) {
            return true;
        }
        stack.extend(&shape.children);
    }
    false
}
