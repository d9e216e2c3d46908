//! The camera, the lights and the limits of one frame, as the numbers that rays need.
//!
//! Right-handed, y up, z towards the viewer. Lengths are in scene units, angles in radians, colours
//! linear.

mod background;
mod error;
mod exposure;
pub(crate) mod footprint;
mod light;
mod limits;
mod pose;
mod values;

use glam::DVec3;
use sdfc_graph::{
    NodeId, Program, Settings,
    eval::{FrameValues, evaluate_frame},
};
use sdfc_march::{LightBlock, MAX_LIGHTS, MAX_REFLECTIONS, MethodParameter, ViewBlock};

use crate::tiles::Tile;
use background::{background, view_fog, view_occlusion};
use exposure::view_exposure;
use footprint::Footprint;
use light::lights;
use limits::Limits;
use values::{aspect, finite, fraction, value_of};

pub use background::{Background, ViewFog, ViewOcclusion};
pub use error::ViewError;
pub use exposure::ViewExposure;
pub use light::{ViewLight, ViewShadow, ViewSource};
pub use pose::Pose;
pub use values::Bounds;

/// One frame's camera, lights and limits, in f64.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// Origin of the camera rays, or the middle of the origins of parallel ones. Like all positions
    /// here, it is relative to the program's origin.
    pub eye: DVec3,
    /// True if the camera rays are parallel.
    pub parallel: bool,
    /// Half the width of the picture: at distance 1, or at any distance if rays are parallel.
    pub right: DVec3,
    /// Half the height of the picture: at distance 1, or at any distance if rays are parallel.
    pub up: DVec3,
    /// The vector from the eye through the middle of the picture, at distance 1 along the camera's
    /// axis: a unit vector unless [`Self::shifted`].
    pub forward: DVec3,
    /// Length of the rays.
    pub t_max: f64,
    /// Absolute distance below which a point is a hit (`fixed`, `sphere`).
    pub epsilon: f64,
    /// Distance below which a point is a hit, as a multiple of the pixel's width there (all other
    /// methods).
    pub tolerance: f64,
    /// The step budget of a ray.
    pub steps: u32,
    /// The lights, at most [`MAX_LIGHTS`].
    pub lights: Vec<ViewLight>,
    /// Linear colour of the ambient light.
    pub ambient: DVec3,
    /// The background.
    pub background: Background,
    /// The fog.
    pub fog: Option<ViewFog>,
    /// The ambient occlusion.
    pub occlusion: Option<ViewOcclusion>,
    /// The exposure.
    pub exposure: Option<ViewExposure>,
    /// The number of reflections of a camera ray, at most [`MAX_REFLECTIONS`].
    pub reflections: u32,
    /// Factor of the light from each reflection, 0..1.
    pub reflection_strength: f64,
    /// A box around all surfaces of loops with active lists, if one is known.
    pub within: Option<[DVec3; 2]>,
}

impl View {
    /// The view of one frame of a program. `bounds` of the visible shapes limit the rays, and place
    /// the camera if the scene has none: it sees the box from the right, above and in front, where
    /// an unlimited side counts as long as the longest limited one.
    ///
    /// # Errors
    ///
    /// [`ViewError`] if a setting's values make no picture.
    pub fn new(
        program: &Program,
        frame: &FrameValues,
        bounds: Option<Bounds>,
        size: [u32; 2],
    ) -> Result<Self, ViewError> {
        let pose = Pose::new(program, frame, bounds, aspect(size))?;
        Self::from_pose(program, frame, bounds, size, &pose)
    }

    /// As [`Self::new`], seen from `pose` whatever the scene's camera is. A planar picture is seen
    /// from the front, with the middle and the height that the pose has at its target.
    ///
    /// # Errors
    ///
    /// [`ViewError`] if another setting's values make no picture.
    pub fn from_pose(
        program: &Program,
        frame: &FrameValues,
        bounds: Option<Bounds>,
        size: [u32; 2],
        pose: &Pose,
    ) -> Result<Self, ViewError> {
        let settings = &program.settings;
        let nodes = settings.nodes();
        let values = evaluate_frame(&program.graph, &nodes, frame);
        let value = |id| value_of(&nodes, &values, id);
        let pose = if program.is_planar() { pose.facing_the_plane() } else { *pose };
        let view = Self::of_settings(settings, &value, bounds, size, &pose)?;
        let bounds = bounds.map(|corners| corners.map(DVec3::from));
        let within = within(program, frame).or(bounds).filter(|[lo, hi]| (*hi - *lo).is_finite());
        Ok(Self { within, ..view }.about(DVec3::from(program.origin)))
    }

    /// The view with positions relative to `origin`.
    fn about(mut self, origin: DVec3) -> Self {
        self.eye -= origin;
        self.within = self.within.map(|corners| corners.map(|corner| corner - origin));
        for light in &mut self.lights {
            match &mut light.source {
                ViewSource::Sun(_) => {}
                ViewSource::Point(position) | ViewSource::Spot { position, .. } => {
                    *position -= origin
                }
            }
        }
        self
    }

    /// `value` returns the lanes of the settings' nodes.
    fn of_settings(
        settings: &Settings,
        value: &dyn Fn(NodeId) -> [f64; 4],
        bounds: Option<Bounds>,
        size: [u32; 2],
        pose: &Pose,
    ) -> Result<Self, ViewError> {
        let [right, up, forward] = pose.basis();
        let limits = Limits::new(&settings.march, pose, bounds)?;
        let (reflections, reflection_strength) = match &settings.reflections {
            Some(mirrors) => {
                let strength = fraction(value(mirrors.strength), "the strength of reflections")?;
                (mirrors.count.min(MAX_REFLECTIONS), strength)
            }
            None => (0, 0.0),
        };
        let occlusion = settings.occlusion;
        let occlusion =
            occlusion.map(|found| view_occlusion(found, pose.height_at_target(), value));
        let ambient = settings.ambient.map(|node| finite(value(node), "the ambient light"));
        Ok(Self {
            size,
            eye: pose.eye,
            parallel: pose.parallel,
            right: right * pose.half_height * aspect(size),
            up: up * pose.half_height,
            forward,
            t_max: limits.t_max,
            epsilon: limits.epsilon,
            tolerance: limits.tolerance,
            steps: limits.steps,
            lights: lights(settings, forward, value)?,
            ambient: ambient.transpose()?.unwrap_or_default(),
            background: background(settings, value)?,
            fog: settings.fog.map(|fog| view_fog(fog, value)).transpose()?,
            occlusion: occlusion.transpose()?,
            exposure: settings.exposure.map(|found| view_exposure(found, value)).transpose()?,
            reflections,
            reflection_strength,
            within: None,
        })
    }

    /// The value of a method parameter.
    pub fn parameter(&self, parameter: MethodParameter) -> f64 {
        match parameter {
            MethodParameter::Steps => f64::from(self.steps),
            MethodParameter::Epsilon => self.epsilon,
            MethodParameter::Tolerance => self.tolerance,
        }
    }

    /// The view with another value of a method parameter; steps are rounded, and at least 1.
    pub fn with_parameter(&self, parameter: MethodParameter, value: f64) -> Self {
        let mut view = self.clone();
        match parameter {
            MethodParameter::Steps => view.steps = value.round().max(1.0) as u32,
            MethodParameter::Epsilon => view.epsilon = value,
            MethodParameter::Tolerance => view.tolerance = value,
        }
        view
    }

    /// The view with the method parameter, if there is one, multiplied by a factor.
    pub fn with_scaled_parameter(&self, parameter: Option<MethodParameter>, factor: f64) -> Self {
        match parameter {
            Some(own) => self.with_parameter(own, factor * self.parameter(own)),
            None => self.clone(),
        }
    }

    /// The view whose rays pass `x` pixels to the right of the pixels' centres and `y` pixels below
    /// them.
    pub fn shifted(&self, [x, y]: [f64; 2]) -> Self {
        let [columns, rows] = self.size.map(|side| f64::from(side.max(1)));
        let aside = self.right * (2.0 * x / columns) - self.up * (2.0 * y / rows);
        if self.parallel {
            Self { eye: self.eye + aside, ..self.clone() }
        } else {
            Self { forward: self.forward + aside, ..self.clone() }
        }
    }

    /// Origin and unit direction of the ray through the centre of a pixel; rows count downwards.
    pub fn ray(&self, x: u32, y: u32) -> [DVec3; 2] {
        let place = |index: u32, side: u32| 2.0 * (f64::from(index) + 0.5) / f64::from(side) - 1.0;
        let [width, height] = self.size;
        let aside = self.right * place(x, width) - self.up * place(y, height);
        if self.parallel {
            [self.eye + aside, self.forward]
        } else {
            [self.eye, (self.forward + aside).normalize()]
        }
    }

    /// Half the width of a pixel.
    pub fn footprint(&self) -> Footprint {
        let half = self.right.length() / f64::from(self.size[0].max(1));
        if self.parallel {
            Footprint { radius: half, spread: 0.0 }
        } else {
            Footprint { radius: 0.0, spread: half }
        }
    }

    /// The view as the shader reads it, for one tile.
    pub fn block(&self, tile: Tile) -> ViewBlock {
        let mut lights = [LightBlock::default(); MAX_LIGHTS];
        for (block, light) in lights.iter_mut().zip(&self.lights) {
            *block = light.block();
        }
        let single = |vector: DVec3| vector.as_vec3().to_array();
        let Footprint { radius, spread } = self.footprint();
        let [background, zenith, horizon] = match self.background {
            Background::Plain(color) => [color, DVec3::ZERO, DVec3::ZERO],
            Background::Environment => [DVec3::ZERO; 3],
            Background::Sky { zenith, horizon, ground } => [ground, zenith, horizon],
        };
        let fog = self.fog.unwrap_or(ViewFog { density: 0.0, color: None });
        let occlusion = self.occlusion.unwrap_or(ViewOcclusion { radius: 0.0, strength: 0.0 });
        ViewBlock {
            eye: single(self.eye),
            pixel_radius: (radius + spread) as f32,
            right: single(self.right),
            t_max: self.t_max as f32,
            up: single(self.up),
            epsilon: self.epsilon as f32,
            forward: single(self.forward),
            steps: self.steps,
            size: self.size,
            tile_origin: tile.origin,
            tile_size: tile.size,
            light_count: self.lights.len().min(MAX_LIGHTS) as u32,
            tolerance: self.tolerance as f32,
            ambient: single(self.ambient),
            reflections: self.reflections,
            background: single(background),
            reflection_strength: self.reflection_strength as f32,
            zenith: single(zenith),
            fog_density: fog.density as f32,
            horizon: single(horizon),
            occlusion_radius: occlusion.radius as f32,
            fog_color: single(fog.color.unwrap_or_default()),
            occlusion_strength: occlusion.strength as f32,
            lights,
        }
    }
}

/// The box of [`View::within`] at a frame.
fn within(program: &Program, frame: &FrameValues) -> Option<[DVec3; 2]> {
    let corners = evaluate_frame(&program.graph, &program.loop_bounds?, frame);
    let corner = |place: usize| {
        let &[x, y, z, _] = corners.get(place)?;
        Some(DVec3::new(x, y, z))
    };
    Some([corner(0)?, corner(1)?])
}

#[cfg(test)]
mod tests;
