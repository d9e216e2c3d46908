//! The whole scene: params, lets, settings and the shapes to draw.

use rustc_hash::FxHashSet;
use sdfc_diagnostics::{Code as ErrorCode, Diagnostic, Span};
use sdfc_graph::{FrameInput, Graph, MaterialRule, ParamKind, Range, Scene, ShapeId, Type};

use super::elaborator::{Elaborator, Env, Outcome, Poison};
use super::expr::node_type;
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
        let root = self.drawn();
        self.add_intersections();
        let has_materials = root.is_some_and(|root| has_material(&self.graph, root));
        let graph = std::mem::take(&mut self.graph);
        let params = std::mem::take(&mut self.params);
        Scene { graph, root, params, settings, has_materials }
    }

    /// The union of the shapes to draw; one shape is returned unchanged.
    fn drawn(&mut self) -> Option<ShapeId> {
        let program = self.program;
        let mut shapes = Vec::with_capacity(program.drawn.len());
        for expr in &program.drawn {
            match self.eval(&mut Env::new(program.locals), expr) {
                Ok(value) => shapes.push((value, expr.span)),
                Err(Poison) => self.missing = self.missing.or(Some(expr.span)),
            }
        }
        let (first, span) = shapes.first()?.clone();
        if let (Value::Shape(shape), [_]) = (&first, &shapes[..]) {
            return Some(*shape);
        }
        let parts = Value::List(shapes.into_iter().map(|(value, _)| value).collect());
        match self.instance(program.union?, vec![Some((parts, span))], span) {
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

    /// Adds a param. A param with an error is added too, so that indices do not change.
    fn param(&mut self, param: &'p hir::Param) {
        let ty = node_type(&param.ty).unwrap_or(Type::Scalar);
        let default = self.param_constant(&param.default, ty, &param.choices);
        let default = default.unwrap_or_default();
        let range = param.range.as_ref().and_then(|expr| self.param_range(expr));
        if let Some([lo, hi]) = range.filter(|[lo, hi]| !(*lo..=*hi).contains(&default[0])) {
            let message = format!(
                "the default of `{}` is {}, outside its range {}..{}",
                param.name,
                show_number(default[0]),
                show_number(lo),
                show_number(hi)
            );
            self.fail(ErrorCode::OUT_OF_RANGE, param.default.span, message);
        }
        if let (Some([lo, hi]), Type::Scalar) = (range, ty) {
            let input = FrameInput::Param(self.params.len() as u32);
            let node = self.graph.frame_input(input, ty);
            self.graph.assume_range(node, Range::new(lo, hi));
        }
        self.params.push(sdfc_graph::Param {
            name: param.name.clone(),
            kind: kind(&param.ty),
            ty,
            default,
            range,
            choices: param.choices.clone(),
            summary: param.docs.first().cloned().unwrap_or_default(),
        });
    }

    fn param_constant(
        &mut self,
        expr: &'p hir::Expr,
        ty: Type,
        choices: &[String],
    ) -> Option<[f64; 4]> {
        match self.eval(&mut Env::new(self.program.locals), expr).ok()? {
            Value::Text(text) => {
                let index = choices.iter().position(|choice| choice.as_str() == &*text);
                if index.is_none() {
                    let message = format!("\"{text}\" is not one of the choices");
                    let help = format!("the choices are {}", choices.join(", "));
                    let error = Diagnostic::error(ErrorCode::OUT_OF_RANGE, expr.span, message);
                    self.report(error.help(help));
                }
                Some([index? as f64, 0.0, 0.0, 0.0])
            }
            Value::Node(node) => {
                let node = self.graph.splat(ty, node);
                self.constant_lanes(node, expr.span, "the default of a param").ok()
            }
            other => {
                self.unexpected(expr.span, "a number, bool, color or string", &other);
                None
            }
        }
    }

    fn param_range(&mut self, expr: &'p hir::Expr) -> Option<[f64; 2]> {
        let Value::Range(lo, hi) = self.eval(&mut Env::new(self.program.locals), expr).ok()? else {
            return None;
        };
        let what = "the range of a param";
        let lo = self.constant_lanes(lo, expr.span, what).ok()?;
        let hi = self.constant_lanes(hi, expr.span, what).ok()?;
        Some([lo[0], hi[0]])
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

    /// The value of a param, a per-frame input.
    pub(super) fn param_value(&mut self, index: usize) -> Outcome<Value<'p>> {
        let param = self.params.get(index).ok_or(Poison)?;
        let (kind, ty) = (param.kind, param.ty);
        let node = self.graph.frame_input(FrameInput::Param(index as u32), ty);
        Ok(match kind {
            ParamKind::Choice => Value::Choice(node, index),
            ParamKind::Number
            | ParamKind::Int
            | ParamKind::Angle
            | ParamKind::Bool
            | ParamKind::Color => Value::Node(node),
        })
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

fn kind(ty: &hir::Type) -> ParamKind {
    match ty {
        hir::Type::Int => ParamKind::Int,
        hir::Type::Angle => ParamKind::Angle,
        hir::Type::Bool => ParamKind::Bool,
        hir::Type::Color => ParamKind::Color,
        hir::Type::Text => ParamKind::Choice,
        hir::Type::Number
        | hir::Type::Vec(_)
        | hir::Type::Range(_)
        | hir::Type::List(_)
        | hir::Type::Fn(..)
        | hir::Type::Shape(_)
        | hir::Type::Material
        | hir::Type::Shadow
        | hir::Type::Error => ParamKind::Number,
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
