//! Settings, such as camera, background and ray method. Lights are in [`super::lights`].

use sdfc_diagnostics::{Code as ErrorCode, Diagnostic};
use sdfc_graph::{
    Camera, Environment, Expander, Exposure, Fog, Lens, March, NodeId, Occlusion, Reflections,
    Settings, Sky, Tone, Type, Unary,
};

use super::elaborator::{Elaborator, Env, Outcome, Poison};
use super::report::show_number;
use super::value::Value;
use crate::environment::functions::functions;
use crate::hir::{Expr, Setting, SettingKind};
use crate::settings::{RAY_METHODS, TONES};

/// Default field of view: 40 degrees.
const DEFAULT_FOV: f64 = 40.0 * std::f64::consts::PI / 180.0;
/// Default strength of `ambient()`.
const DEFAULT_AMBIENT: f64 = 0.2;
/// Default linear colours of `sky()`: #4477bb and #dde8f0.
const DEFAULT_ZENITH: [f64; 3] = [0.0578, 0.1845, 0.4969];
const DEFAULT_HORIZON: [f64; 3] = [0.7230, 0.8070, 0.8714];
/// The indices of `image`, `turn` and `strength` among the parameters of `sky`.
const SKY_IMAGE: usize = 3;
const SKY_TURN: usize = 4;
const SKY_STRENGTH: usize = 5;
/// Default density of `fog()`, per scene unit.
const DEFAULT_DENSITY: f64 = 0.05;
/// Default number of reflections of `reflections()`.
const DEFAULT_MIRRORS: u32 = 1;
/// Default factor of each reflection of `reflections()`.
const DEFAULT_REFLECTION: f64 = 1.0;
/// The largest number of reflections, which is also that of `march`: each one repeats all work.
const MAX_MIRRORS: f64 = 8.0;
/// Default number of rays per pixel of `antialias()`.
const DEFAULT_SAMPLES: u32 = 4;
/// The largest number of rays per pixel, which is also that of the renderer.
const MAX_SAMPLES: f64 = 1024.0;
/// The largest number of steps of a ray: some drivers silently end a loop after 65,535 iterations.
const MAX_MARCH_STEPS: f64 = 65_535.0;
/// The range of numbers that must be above 0.
pub(super) const POSITIVE: [f64; 2] = [f32::MIN_POSITIVE as f64, f32::MAX as f64];
/// The range of fractions.
const FRACTION: [f64; 2] = [0.0, 1.0];

impl<'p> Elaborator<'p> {
    /// Elaborates all settings of the scene.
    pub(super) fn settings(&mut self) -> Settings {
        let mut settings = Settings::default();
        for setting in &self.program.settings {
            if self.setting(setting, &mut settings).is_err() {
                self.missing = self.missing.or(Some(setting.span));
            }
        }
        // What a scene states as its ambient light is in place of the picture's.
        if let (Some(environment), Some(ambient)) = (&mut settings.environment, settings.ambient) {
            environment.irradiance = ambient;
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
                out.background = Some(self.setting_color(setting, 0)?.ok_or(Poison)?);
            }
            SettingKind::Sky => match self.argument(setting, SKY_IMAGE) {
                Some(image) => out.environment = Some(self.environment(setting, image)?),
                None => out.sky = Some(self.sky(setting)?),
            },
            SettingKind::Fog => out.fog = Some(self.fog(setting)?),
            SettingKind::AmbientOcclusion => out.occlusion = Some(self.occlusion(setting)?),
            SettingKind::Reflections => out.reflections = Some(self.reflections(setting)?),
            SettingKind::Exposure => out.exposure = Some(self.exposure(setting)?),
            SettingKind::Antialias => {
                let samples = self.known_within(setting, 0, "`samples`", [1.0, MAX_SAMPLES])?;
                out.samples = Some(samples.map_or(DEFAULT_SAMPLES, |samples| samples as u32));
            }
            SettingKind::Isolines => {
                let spacing = self.setting_within(setting, 0, "`spacing`", POSITIVE)?;
                out.isolines = Some(spacing.ok_or(Poison)?);
            }
            SettingKind::March => out.march = self.march(setting)?,
            SettingKind::Sun => {
                let source = self.sun(setting)?;
                self.light(setting, source, 1, out)?;
            }
            SettingKind::PointLight => {
                let source = self.point_light(setting)?;
                self.light(setting, source, 1, out)?;
            }
            SettingKind::SpotLight => {
                let source = self.spot_light(setting)?;
                self.light(setting, source, 3, out)?;
            }
        }
        Ok(())
    }

    /// The argument with an index, if it was given.
    pub(super) fn argument(&self, setting: &'p Setting, index: usize) -> Option<&'p Expr> {
        setting.args.get(index).and_then(Option::as_ref)
    }

    pub(super) fn setting_number(
        &mut self,
        setting: &'p Setting,
        index: usize,
    ) -> Outcome<Option<NodeId>> {
        let mut env = Env::new(self.program.locals);
        let Some(expr) = self.argument(setting, index) else { return Ok(None) };
        let node = self.number(&mut env, expr)?;
        self.setting_value(expr, node).map(Some)
    }

    /// The value of a setting's argument, with the distances that it samples expanded. A constant
    /// must be finite.
    fn setting_value(&mut self, expr: &'p Expr, node: NodeId) -> Outcome<NodeId> {
        let expanded = Expander::new().node(&mut self.graph, node, &[]);
        let node = expanded.map_err(|error| {
            self.fail(ErrorCode::TOO_MANY_NODES, expr.span, format!("this value: {error}"))
        })?;
        let node = self.settled(node);
        self.refuse_surface_vectors(&[node], expr.span)?;
        let constant = self.graph.as_const(node);
        if constant.is_none_or(|value| value.lanes().iter().all(|lane| lane.is_finite())) {
            return Ok(node);
        }
        Err(self.fail(ErrorCode::NOT_FINITE, expr.span, "this value is not a finite number"))
    }

    /// The components of a constant vector; `None` if it is known only when a frame is drawn.
    pub(super) fn constant_vector(&self, node: NodeId) -> Option<[f64; 3]> {
        let [x, y, z, _] = self.graph.as_const(node)?.lanes();
        Some([x, y, z])
    }

    /// Reports a vector of a setting that makes no picture.
    pub(super) fn refuse_vector(
        &mut self,
        setting: &'p Setting,
        index: usize,
        message: &str,
        help: &str,
    ) -> Poison {
        let span = self.argument(setting, index).map_or(setting.span, |expr| expr.span);
        self.report(Diagnostic::error(ErrorCode::OUT_OF_RANGE, span, message).help(help))
    }

    /// A colour without its alpha.
    fn setting_color(&mut self, setting: &'p Setting, index: usize) -> Outcome<Option<NodeId>> {
        let color = self.setting_number(setting, index)?;
        Ok(color.map(|color| self.graph.swizzle(color, &[0, 1, 2])))
    }

    /// A number that must be within a range. A per-frame number is checked when its frame is drawn.
    pub(super) fn setting_within(
        &mut self,
        setting: &'p Setting,
        index: usize,
        what: &str,
        range: [f64; 2],
    ) -> Outcome<Option<NodeId>> {
        let node = self.setting_number(setting, index)?;
        if node.is_some_and(|node| self.graph.as_number(node).is_some()) {
            self.known_within(setting, index, what, range)?;
        }
        Ok(node)
    }

    /// A number that must be known at compile time and within a range.
    fn known_within(
        &mut self,
        setting: &'p Setting,
        index: usize,
        what: &str,
        range: [f64; 2],
    ) -> Outcome<Option<f64>> {
        let expr = self.argument(setting, index);
        expr.map(|expr| self.number_within(expr, what, range)).transpose()
    }

    fn camera(&mut self, setting: &'p Setting) -> Outcome<Camera> {
        let eye = self.setting_number(setting, 0)?.ok_or(Poison)?;
        let [target, up, fov] = [1, 2, 3].map(|index| self.setting_number(setting, index));
        let height = self.setting_within(setting, 4, "`height`", POSITIVE);
        let target = target?.unwrap_or_else(|| self.graph.constant(Type::Vec3, &[0.0; 3]));
        let [from, to] = [eye, target].map(|node| self.constant_vector(node));
        if from.is_some() && from == to {
            let message = "the camera's eye and target are one point";
            return Err(self.refuse_vector(setting, 0, message, "move one of them"));
        }
        if let (true, Some(from), Some(to)) = (self.program.is_planar(), from, to)
            && (from[..2] != to[..2] || from[2] < to[2])
        {
            let message = "this camera is not straight in front of its target, as a planar picture \
                           needs";
            let [x, y, z] = [to[0], to[1], to[2] + 1.0].map(show_number);
            let help = format!("write eye: [{x}, {y}, {z}], or draw solids: .extrude(0.2)");
            return Err(self.refuse_vector(setting, 0, message, &help));
        }
        Ok(Camera {
            eye,
            target,
            up: up?.unwrap_or_else(|| self.graph.constant(Type::Vec3, &[0.0, 1.0, 0.0])),
            lens: match (height?, fov?) {
                (Some(height), _) => Lens::Height(height),
                (None, Some(fov)) => Lens::Fov(fov),
                (None, None) => Lens::Fov(self.graph.number(DEFAULT_FOV)),
            },
        })
    }

    fn sky(&mut self, setting: &'p Setting) -> Outcome<Sky> {
        let [zenith, horizon, ground] = [0, 1, 2].map(|index| self.setting_color(setting, index));
        let mut or = |color: Option<NodeId>, default: [f64; 3]| {
            color.unwrap_or_else(|| self.graph.constant(Type::Vec3, &default))
        };
        let [zenith, horizon] = [or(zenith?, DEFAULT_ZENITH), or(horizon?, DEFAULT_HORIZON)];
        Ok(Sky { zenith, horizon, ground: ground? })
    }

    /// The light of a picture of the surroundings.
    fn environment(&mut self, setting: &'p Setting, image: &'p Expr) -> Outcome<Environment> {
        let path = self.text(&mut Env::new(self.program.locals), image, "the picture of a sky")?;
        let turn = self.setting_number(setting, SKY_TURN);
        let range = [0.0, POSITIVE[1]];
        let strength = self.setting_within(setting, SKY_STRENGTH, "`strength`", range);
        let turn = turn?.unwrap_or_else(|| self.graph.number(0.0));
        let strength = strength?.unwrap_or_else(|| self.graph.number(1.0));
        let surroundings = self.assets.pictures.surroundings(&path).map_err(|why| {
            let help =
                "name a Radiance picture (.hdr) of all directions in the folder of the scene";
            let else_ = "where a program cannot read files, as the playground, write a gradient: \
                         sky(zenith: #4477bb, horizon: #dde8f0)";
            let error = Diagnostic::error(ErrorCode::IMAGE, image.span, why);
            self.report(error.help(help).help(else_))
        })?;
        Ok(functions(&mut self.graph, &surroundings, turn, strength))
    }

    fn fog(&mut self, setting: &'p Setting) -> Outcome<Fog> {
        let density = self.setting_within(setting, 0, "`density`", [0.0, POSITIVE[1]]);
        let color = self.setting_color(setting, 1)?;
        let density = density?.unwrap_or_else(|| self.graph.number(DEFAULT_DENSITY));
        Ok(Fog { density, color })
    }

    fn occlusion(&mut self, setting: &'p Setting) -> Outcome<Occlusion> {
        let radius = self.setting_within(setting, 0, "`radius`", POSITIVE);
        let strength = self.setting_within(setting, 1, "`strength`", FRACTION);
        Ok(Occlusion {
            radius: radius?,
            strength: strength?.unwrap_or_else(|| self.graph.number(1.0)),
        })
    }

    fn reflections(&mut self, setting: &'p Setting) -> Outcome<Reflections> {
        let count = self.known_within(setting, 0, "`count`", [0.0, MAX_MIRRORS]);
        let strength = self.setting_within(setting, 1, "`strength`", FRACTION);
        Ok(Reflections {
            count: count?.map_or(DEFAULT_MIRRORS, |count| count as u32),
            strength: strength?.unwrap_or_else(|| self.graph.number(DEFAULT_REFLECTION)),
        })
    }

    fn exposure(&mut self, setting: &'p Setting) -> Outcome<Exposure> {
        let stops = self.setting_number(setting, 0);
        let tone = self.argument(setting, 1).map(|expr| self.tone(expr)).transpose();
        let factor = stops?.map(|stops| self.graph.unary(Unary::Exp2, stops));
        Ok(Exposure { factor, tone: tone?.unwrap_or_default() })
    }

    fn march(&mut self, setting: &'p Setting) -> Outcome<March> {
        let steps = self.known_within(setting, 0, "`steps`", [1.0, MAX_MARCH_STEPS]);
        let epsilon = self.known_within(setting, 1, "`epsilon`", POSITIVE);
        let distance = self.known_within(setting, 2, "`distance`", POSITIVE);
        let method = self.argument(setting, 3).map(|expr| self.method(expr)).transpose();
        let tolerance = self.known_within(setting, 4, "`tolerance`", POSITIVE);
        Ok(March {
            steps: steps?.map(|steps| steps as u32),
            epsilon: epsilon?,
            tolerance: tolerance?,
            distance: distance?,
            method: method?,
        })
    }

    fn method(&mut self, expr: &'p Expr) -> Outcome<String> {
        Ok(RAY_METHODS[self.choice(expr, "ray method", &RAY_METHODS)?].to_owned())
    }

    fn tone(&mut self, expr: &'p Expr) -> Outcome<Tone> {
        let names = TONES.map(|(name, _)| name);
        Ok(TONES[self.choice(expr, "tone curve", &names)?].1)
    }

    /// The index of the name that a string states.
    fn choice(&mut self, expr: &'p Expr, what: &str, names: &[&str]) -> Outcome<usize> {
        let value = self.eval(&mut Env::new(self.program.locals), expr)?;
        let Value::Text(text) = &value else {
            if let Value::Choice(node, _) = value {
                return Err(self.not_constant(expr.span, &format!("the {what}"), node));
            }
            return Err(self.unexpected(expr.span, "a string", &value));
        };
        if let Some(index) = names.iter().position(|name| *name == &**text) {
            return Ok(index);
        }
        let message = format!("there is no {what} \"{text}\"");
        let help = format!("the {what}s are {}", names.join(", "));
        let error = Diagnostic::error(ErrorCode::NOT_YET, expr.span, message);
        Err(self.report(error.help(help)))
    }
}
