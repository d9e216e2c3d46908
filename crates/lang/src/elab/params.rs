//! Params: constants of the scene or per-frame inputs, see [`ParamInputs`].
//!
//! [`ParamInputs`]: super::param_inputs::ParamInputs

use sdfc_diagnostics::{Code, Diagnostic};
use sdfc_graph::{FrameInput, NodeId, Param, ParamKind, Range, Type};

use super::elaborator::{Elaborator, Env, Outcome, Poison};
use super::report::show_number;
use super::value::{Value, node_type};
use crate::hir;

impl<'p> Elaborator<'p> {
    /// Adds a param. A param with an error is added too, so that indices do not change.
    pub(super) fn param(&mut self, param: &'p hir::Param) {
        let ty = node_type(&param.ty).unwrap_or(Type::Scalar);
        let default = self.param_constant(&param.default, ty, &param.choices);
        let default = default.unwrap_or_default();
        let kind = kind(&param.ty);
        let declared = param.range.as_ref().and_then(|expr| self.param_range(expr));
        let range = self.range_of_param(param, kind, default[0], declared);
        self.assume_param_range(ty, range);
        let mut param = Param {
            name: param.name.clone(),
            kind,
            ty,
            default,
            fixed: None,
            range,
            choices: param.choices.clone(),
            summary: param.docs.first().cloned().unwrap_or_default(),
        };
        param.fixed = self.inputs.fixed_value(self.params.len(), &param);
        self.params.push(param);
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
                    let error = Diagnostic::error(Code::OUT_OF_RANGE, expr.span, message);
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

    /// The value of a param: a constant if it is fixed, otherwise a per-frame input.
    pub(super) fn param_value(&mut self, index: usize) -> Outcome<Value<'p>> {
        let param = self.params.get(index).ok_or(Poison)?;
        let (kind, ty) = (param.kind, param.ty);
        if let Some(lanes) = param.fixed {
            let choice = param.choices.get(lanes[0] as usize);
            return Ok(match (kind, choice) {
                (ParamKind::Choice, Some(choice)) => Value::Text(choice.as_str().into()),
                _ => Value::Node(self.graph.constant(ty, &lanes[..ty.width()])),
            });
        }
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

    /// Records that the params in a value decide what the scene consists of.
    pub(super) fn decides_structure(&mut self, node: NodeId) {
        if self.params.is_empty() {
            return;
        }
        let params = self.inputs(node).into_iter().filter_map(|input| match input {
            FrameInput::Param(index) => Some(index as usize),
            FrameInput::Time | FrameInput::Frame => None,
        });
        self.structural.extend(params);
    }

    /// The range of a param: the declared one, or one that fits its default.
    fn range_of_param(
        &mut self,
        param: &hir::Param,
        kind: ParamKind,
        default: f64,
        declared: Option<[f64; 2]>,
    ) -> Option<[f64; 2]> {
        let is_literal = self.params.len() >= self.inputs.first_literal;
        let Some([lo, hi]) = declared else {
            return if is_literal { None } else { usual_range(kind, default) };
        };
        if !(lo..=hi).contains(&default) {
            let message = format!(
                "the default of `{}` is {}, outside its range {}..{}",
                param.name,
                show_number(default),
                show_number(lo),
                show_number(hi)
            );
            self.fail(Code::OUT_OF_RANGE, param.default.span, message);
        }
        Some([lo, hi])
    }

    /// Tells the graph the range of a param that is a per-frame input.
    fn assume_param_range(&mut self, ty: Type, range: Option<[f64; 2]>) {
        if let (Some([lo, hi]), Type::Scalar) = (range, ty) {
            let input = FrameInput::Param(self.params.len() as u32);
            let node = self.graph.frame_input(input, ty);
            self.graph.assume_range(node, Range::new(lo, hi));
        }
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
        | hir::Type::Record(_)
        | hir::Type::Fn(..)
        | hir::Type::Shape(_)
        | hir::Type::Material
        | hir::Type::Shadow
        | hir::Type::Error => ParamKind::Number,
    }
}

/// The range of a param that states none: from 0 to twice its default. A positive integer starts
/// at 1, since most integers are counts. A default of 0 is in the middle.
fn usual_range(kind: ParamKind, default: f64) -> Option<[f64; 2]> {
    let around_zero = match kind {
        ParamKind::Number => 1.0,
        ParamKind::Int => 10.0,
        ParamKind::Angle => std::f64::consts::PI,
        ParamKind::Bool | ParamKind::Color | ParamKind::Choice => return None,
    };
    if default == 0.0 {
        return Some([-around_zero, around_zero]);
    }
    let low = if kind == ParamKind::Int && default > 0.0 { 1.0 } else { 0.0 };
    Some([f64::min(low, 2.0 * default), f64::max(low, 2.0 * default)])
}
