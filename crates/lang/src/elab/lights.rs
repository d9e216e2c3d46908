//! Lights: their source, colour and shadow.

use sdfc_diagnostics::{Code as ErrorCode, Diagnostic};
use sdfc_graph::{Light, LightSource, NodeId, Settings, Shadow, Type};

use super::elaborator::{Elaborator, Env, Outcome, Poison};
use super::report::show_lanes;
use super::settings::POSITIVE;
use super::value::Value;
use crate::hir::{Expr, Setting};

/// The largest number of lights, which is also that of the shader.
const MAX_LIGHTS: usize = 8;
/// The default direction towards the sun.
const DEFAULT_SUN: [f64; 3] = [1.0, 2.0, 1.0];
/// The default angle from the axis of a `spot_light`'s cone to its edge: 30 degrees.
const DEFAULT_CONE: f64 = 30.0 * std::f64::consts::PI / 180.0;

impl<'p> Elaborator<'p> {
    pub(super) fn sun(&mut self, setting: &'p Setting) -> Outcome<LightSource> {
        let direction = self.setting_number(setting, 0)?;
        let direction = match direction {
            Some(direction) => direction,
            None => self.graph.constant(Type::Vec3, &DEFAULT_SUN),
        };
        if self.constant_vector(direction) == Some([0.0; 3]) {
            let message = "this direction is [0, 0, 0], which points nowhere";
            let help = "write a vector towards the light, of any length";
            return Err(self.refuse_vector(setting, 0, message, help));
        }
        Ok(LightSource::Sun { direction })
    }

    pub(super) fn point_light(&mut self, setting: &'p Setting) -> Outcome<LightSource> {
        let position = self.setting_number(setting, 0)?.ok_or(Poison)?;
        Ok(LightSource::Point { position })
    }

    pub(super) fn spot_light(&mut self, setting: &'p Setting) -> Outcome<LightSource> {
        let position = self.setting_number(setting, 0)?.ok_or(Poison)?;
        let target = self.setting_number(setting, 1);
        let angle = self.argument(setting, 2).map(|expr| self.cone(expr));
        let target = target?.unwrap_or_else(|| self.graph.constant(Type::Vec3, &[0.0; 3]));
        let [from, to] = [position, target].map(|node| self.constant_vector(node));
        if from.is_some() && from == to {
            let message = "this spot light stands at its target";
            return Err(self.refuse_vector(setting, 0, message, "move one of them"));
        }
        Ok(LightSource::Spot {
            position,
            target,
            angle: angle.transpose()?.unwrap_or_else(|| self.graph.number(DEFAULT_CONE)),
        })
    }

    /// Evaluates an angle that must be between 0 and 90 degrees.
    fn cone(&mut self, expr: &'p Expr) -> Outcome<NodeId> {
        let angle = self.number(&mut Env::new(self.program.locals), expr)?;
        let degrees = self.graph.as_number(angle).map(f64::to_degrees);
        match degrees {
            Some(degrees) if !(degrees > 0.0 && degrees < 90.0) => {
                let degrees = show_lanes(&[degrees]);
                let message =
                    format!("`angle` is {degrees}deg, but must be above 0deg and below 90deg");
                let error = Diagnostic::error(ErrorCode::OUT_OF_RANGE, expr.span, message);
                let help = "it is measured from the cone's axis; for light in all directions use point_light";
                Err(self.report(error.help(help)))
            }
            Some(_) | None => Ok(angle),
        }
    }

    /// Adds a light. Its colour, strength and shadow are the arguments from index `first` on.
    pub(super) fn light(
        &mut self,
        setting: &'p Setting,
        source: LightSource,
        first: usize,
        out: &mut Settings,
    ) -> Outcome<()> {
        let color = self.light_color(setting, [first, first + 1], 1.0)?;
        let shadow = self.argument(setting, first + 2).map(|expr| self.shadow(expr));
        let shadow = shadow.transpose()?.unwrap_or_default();
        if out.lights.len() == MAX_LIGHTS {
            let message = format!("a scene can have at most {MAX_LIGHTS} lights");
            let error = Diagnostic::error(ErrorCode::TOO_MANY_LIGHTS, setting.span, message);
            return Err(
                self.report(error.help("remove one, or replace the weakest ones by `ambient`"))
            );
        }
        out.lights.push(Light { source, color, shadow });
        Ok(())
    }

    fn shadow(&mut self, expr: &'p Expr) -> Outcome<Shadow> {
        let shadow = match self.eval(&mut Env::new(self.program.locals), expr)? {
            Value::Shadow(shadow) => shadow,
            other => return Err(self.unexpected(expr.span, "a shadow", &other)),
        };
        let sharpness = match shadow {
            Shadow::Soft(node) => self.graph.as_number(node),
            Shadow::Off | Shadow::Hard => None,
        };
        if sharpness.is_some_and(|value| !(POSITIVE[0]..=POSITIVE[1]).contains(&value)) {
            let message = "the sharpness of a soft shadow must be above 0";
            let error = Diagnostic::error(ErrorCode::OUT_OF_RANGE, expr.span, message);
            let help = "with soft(8), the penumbra is 1/8 of the distance to the occluder wide";
            return Err(self.report(error.help(help)));
        }
        Ok(shadow)
    }

    /// The linear colour times the strength, from the indices of both arguments.
    pub(super) fn light_color(
        &mut self,
        setting: &'p Setting,
        [color, strength]: [usize; 2],
        default_strength: f64,
    ) -> Outcome<NodeId> {
        let color = self.setting_number(setting, color);
        let strength = self.setting_number(setting, strength);
        let color = match color? {
            Some(color) => self.graph.swizzle(color, &[0, 1, 2]),
            None => self.graph.constant(Type::Vec3, &[1.0; 3]),
        };
        let strength = strength?.unwrap_or_else(|| self.graph.number(default_strength));
        Ok(self.graph.mul(color, strength))
    }
}
