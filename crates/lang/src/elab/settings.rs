//! Settings: camera, lights, background, method.

use sdfc_diagnostics::{Code as ErrorCode, Diagnostic, Span};
use sdfc_graph::{Camera, Light, March, NodeId, Reflections, Settings, Shadow, Type};

use super::value::Value;
use super::{Elaborator, Env, Outcome, Poison};
use crate::hir::{Expr, Setting, SettingKind};

/// Field of view without `fov`: 40 degrees.
const DEFAULT_FOV: f64 = 40.0 * std::f64::consts::PI / 180.0;
/// Strength of `ambient()` without one.
const DEFAULT_AMBIENT: f64 = 0.2;
/// Towards a `sun()` without direction.
const DEFAULT_SUN: [f64; 3] = [1.0, 2.0, 1.0];
/// How often `reflections()` mirrors.
const DEFAULT_MIRRORS: u32 = 1;
/// What the first mirror of `reflections()` counts.
const DEFAULT_REFLECTION: f64 = 0.3;
/// As `march` has it: each mirror repeats the whole of the work.
const MAX_MIRRORS: f64 = 8.0;
/// Ray methods of this version.
const METHODS: [&str; 3] = ["auto", "fixed", "sphere"];
/// Most steps of a ray: some drivers end a loop silently at 65,535 rounds.
const MAX_MARCH_STEPS: f64 = 65_535.0;

impl<'p> Elaborator<'p> {
    /// All settings of the scene.
    pub(super) fn settings(&mut self) -> Settings {
        let mut settings = Settings::default();
        for setting in &self.program.settings {
            if self.setting(setting, &mut settings).is_err() {
                self.missing = self.missing.or(Some(setting.span));
            }
        }
        settings
    }

    fn setting(&mut self, setting: &'p Setting, out: &mut Settings) -> Outcome<()> {
        match setting.kind {
            SettingKind::Camera => out.camera = Some(self.camera(setting)?),
            SettingKind::Ambient => {
                out.ambient = Some(self.light_color(setting, [0, 1], DEFAULT_AMBIENT)?);
            }
            SettingKind::Background => {
                let color = self.setting_number(setting, 0)?.ok_or(Poison)?;
                out.background = Some(self.graph.swizzle(color, &[0, 1, 2]));
            }
            SettingKind::March => out.march = self.march(setting)?,
            SettingKind::Sun => out.lights.push(self.sun(setting)?),
            SettingKind::Sky => return Err(self.setting_not_yet(setting.span, "sky")),
            SettingKind::Fog => return Err(self.setting_not_yet(setting.span, "fog")),
            SettingKind::AmbientOcclusion => {
                return Err(self.setting_not_yet(setting.span, "ambient_occlusion"));
            }
            SettingKind::Reflections => out.reflections = Some(self.reflections(setting)?),
            SettingKind::Antialias => {
                return Err(self.setting_not_yet(setting.span, "antialias"));
            }
            SettingKind::PointLight => {
                return Err(self.setting_not_yet(setting.span, "point_light"));
            }
            SettingKind::SpotLight => {
                return Err(self.setting_not_yet(setting.span, "spot_light"));
            }
        }
        Ok(())
    }

    fn setting_not_yet(&mut self, span: Span, name: &str) -> Poison {
        let message = format!("`{name}` is not in this version");
        let help = "remove the line; the picture is drawn without it";
        self.report(Diagnostic::error(ErrorCode::NOT_YET, span, message).help(help))
    }

    /// The argument at a place of the setting's row, if it was written.
    fn argument(&self, setting: &'p Setting, place: usize) -> Option<&'p Expr> {
        setting.args.get(place).and_then(Option::as_ref)
    }

    fn setting_number(&mut self, setting: &'p Setting, place: usize) -> Outcome<Option<NodeId>> {
        let mut env = Env::new(self.program.locals);
        self.argument(setting, place).map(|expr| self.number(&mut env, expr)).transpose()
    }

    fn camera(&mut self, setting: &'p Setting) -> Outcome<Camera> {
        if let Some(height) = self.argument(setting, 4) {
            let message = "a camera of parallel rays (`height`) is not in this version";
            let error = Diagnostic::error(ErrorCode::NOT_YET, height.span, message);
            return Err(self.report(error.help("give `fov`, for example `fov: 35deg`")));
        }
        let eye = self.setting_number(setting, 0)?.ok_or(Poison)?;
        let [target, up, fov] = [1, 2, 3].map(|place| self.setting_number(setting, place));
        Ok(Camera {
            eye,
            target: target?.unwrap_or_else(|| self.graph.constant(Type::Vec3, &[0.0; 3])),
            up: up?.unwrap_or_else(|| self.graph.constant(Type::Vec3, &[0.0, 1.0, 0.0])),
            fov: fov?.unwrap_or_else(|| self.graph.number(DEFAULT_FOV)),
        })
    }

    fn sun(&mut self, setting: &'p Setting) -> Outcome<Light> {
        let direction = self.setting_number(setting, 0)?;
        let color = self.light_color(setting, [1, 2], 1.0)?;
        let shadow = match self.argument(setting, 3) {
            None => Shadow::Off,
            Some(expr) => match self.eval(&mut Env::new(self.program.locals), expr)? {
                Value::Shadow(shadow @ (Shadow::Off | Shadow::Hard)) => shadow,
                Value::Shadow(Shadow::Soft(_)) => {
                    let message = "soft shadows are not in this version";
                    let error = Diagnostic::error(ErrorCode::NOT_YET, expr.span, message);
                    return Err(self.report(error.help("write `shadow: hard`")));
                }
                other => return Err(self.unexpected(expr.span, "a shadow", &other)),
            },
        };
        let direction = direction.unwrap_or_else(|| self.graph.constant(Type::Vec3, &DEFAULT_SUN));
        Ok(Light { direction, color, shadow })
    }

    /// Linear colour times strength, from the places of both.
    fn light_color(
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

    fn reflections(&mut self, setting: &'p Setting) -> Outcome<Reflections> {
        let count = self.argument(setting, 0);
        let count = count.map(|expr| self.number_within(expr, "`count`", [0.0, MAX_MIRRORS]));
        let strength = self.argument(setting, 1).map(|expr| {
            let node = self.number(&mut Env::new(self.program.locals), expr)?;
            // What moves is looked at when its frame is drawn.
            match self.graph.as_number(node) {
                Some(_) => self.number_within(expr, "`strength`", [0.0, 1.0]).map(|_| node),
                None => Ok(node),
            }
        });
        Ok(Reflections {
            count: count.transpose()?.map_or(DEFAULT_MIRRORS, |count| count as u32),
            strength: match strength.transpose()? {
                Some(strength) => strength,
                None => self.graph.number(DEFAULT_REFLECTION),
            },
        })
    }

    fn march(&mut self, setting: &'p Setting) -> Outcome<March> {
        let mut within = |place, what, range| {
            let expr = self.argument(setting, place);
            expr.map(|expr| self.number_within(expr, what, range)).transpose()
        };
        let tiny = f64::from(f32::MIN_POSITIVE);
        let huge = f64::from(f32::MAX);
        let steps = within(0, "`steps`", [1.0, MAX_MARCH_STEPS]);
        let epsilon = within(1, "`epsilon`", [tiny, huge]);
        let distance = within(2, "`distance`", [tiny, huge]);
        let method = self.argument(setting, 3).map(|expr| self.method(expr)).transpose();
        Ok(March {
            steps: steps?.map(|steps| steps as u32),
            epsilon: epsilon?,
            distance: distance?,
            method: method?,
        })
    }

    fn method(&mut self, expr: &'p Expr) -> Outcome<String> {
        let value = self.eval(&mut Env::new(self.program.locals), expr)?;
        let Value::Text(text) = &value else {
            if let Value::Choice(node, _) = value {
                return Err(self.not_constant(expr.span, "the ray method", node));
            }
            return Err(self.unexpected(expr.span, "a text", &value));
        };
        if METHODS.contains(&&**text) {
            return Ok(text.to_string());
        }
        let message = format!("there is no ray method \"{text}\" in this version");
        let help = format!("the methods are {}", METHODS.join(", "));
        let error = Diagnostic::error(ErrorCode::NOT_YET, expr.span, message);
        Err(self.report(error.help(help)))
    }
}
