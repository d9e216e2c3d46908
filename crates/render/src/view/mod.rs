//! The camera, the lights and the limits of one frame as numbers: what rays need to know.
//!
//! Right-handed, y up, z towards the viewer. Lengths are in scene units, angles in radians,
//! colours linear.

mod pose;

use std::fmt;

use glam::DVec3;
use sdfc_graph::{
    Light, March, NodeId, Program, Settings, Shadow,
    eval::{FrameValues, evaluate_frame},
};
use sdfc_march::{LightBlock, MAX_LIGHTS, MAX_REFLECTIONS, SHADOW_HARD, SHADOW_OFF, ViewBlock};

use crate::tiles::Tile;
use pose::Pose;

/// Steps of a ray where the scene states none.
const DEFAULT_STEPS: u32 = 256;
/// Tolerance of a hit in parts of the distance from eye to target, where the scene states none:
/// about 100 times the rounding of f32 there.
const DEFAULT_EPSILON: f64 = 5e-5;
/// Length of a ray in distances from eye to target, where neither scene nor bounds limit it.
const DEFAULT_DISTANCE: f64 = 200.0;
/// A ray that is limited by the bounds goes past them by so much, for the rounding of the bounds.
const DISTANCE_MARGIN: f64 = 1.01;

/// Lowest and highest corner of a box, in scene units; infinite where it is not limited.
pub type Bounds = [[f64; 3]; 2];

/// A directional light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewLight {
    /// Unit vector towards the light.
    pub direction: DVec3,
    /// Linear colour times strength.
    pub color: DVec3,
    /// Whether it throws a shadow.
    pub shadow: bool,
}

/// One frame's camera, lights and limits, in f64.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// Where rays start.
    pub eye: DVec3,
    /// Half the width of the picture at distance 1.
    pub right: DVec3,
    /// Half the height of the picture at distance 1.
    pub up: DVec3,
    /// Through the middle of the picture, at distance 1 from the eye along the camera's axis: a unit
    /// vector unless [`Self::shifted`].
    pub forward: DVec3,
    /// Rays end here.
    pub t_max: f64,
    /// A hit is nearer than this (`fixed`, `sphere`).
    pub epsilon: f64,
    /// At most so many steps a ray.
    pub steps: u32,
    /// The lights, at most [`MAX_LIGHTS`].
    pub lights: Vec<ViewLight>,
    /// Linear colour of light from everywhere.
    pub ambient: DVec3,
    /// Linear colour behind everything.
    pub background: DVec3,
    /// A ray from the eye is mirrored at most so often, at most [`MAX_REFLECTIONS`] times.
    pub reflections: u32,
    /// What is seen in a mirror counts by this factor, 0..1, once more for each mirror.
    pub reflection_strength: f64,
}

/// A setting whose values make no picture. The values are those of this frame.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewError {
    /// The camera's eye and target are one point.
    EyeIsTarget([f64; 3]),
    /// The field of view, in radians, is not between 0 and half a turn.
    Fov(f64),
    /// A value is not a finite number; which.
    NotFinite(&'static str),
    /// A number that must be above 0 is not; which, and its value.
    NotPositive(&'static str, f64),
    /// The strength of reflections is not within 0..1.
    ReflectionStrength(f64),
    /// The direction of a light has no length.
    LightDirection,
    /// More lights than [`MAX_LIGHTS`].
    TooManyLights(usize),
    /// A feature of the language that this renderer does not have; which.
    NotYet(&'static str),
}

impl fmt::Display for ViewError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EyeIsTarget(eye) => {
                write!(f, "the camera's eye and target are one point, {eye:?}: move one of them")
            }
            Self::Fov(fov) => write!(
                f,
                "the camera's field of view is {} degrees; it must lie between 0 and 180",
                fov.to_degrees()
            ),
            Self::NotFinite(what) => write!(f, "{what} is not a finite number"),
            Self::NotPositive(what, value) => write!(f, "{what} is {value}; it must be above 0"),
            Self::ReflectionStrength(value) => {
                write!(f, "the strength of reflections is {value}; it must lie between 0 and 1")
            }
            Self::LightDirection => f.write_str("a light's direction is [0, 0, 0]"),
            Self::TooManyLights(count) => {
                write!(f, "the scene has {count} lights; at most {MAX_LIGHTS} are drawn")
            }
            Self::NotYet(what) => write!(f, "{what} are not drawn by this version"),
        }
    }
}

impl std::error::Error for ViewError {}

impl View {
    /// The view of one frame of a program. `bounds` of what is drawn limit the rays, and place the
    /// camera where the scene has none: it sees the box from the right, above and in front, an
    /// unlimited side taken as long as the longest limited one.
    ///
    /// # Errors
    ///
    /// [`ViewError`] where a setting's values make no picture.
    pub fn new(
        program: &Program,
        frame: &FrameValues,
        bounds: Option<Bounds>,
        size: [u32; 2],
    ) -> Result<Self, ViewError> {
        let settings = &program.settings;
        let nodes = settings.nodes();
        let values = evaluate_frame(&program.graph, &nodes, frame);
        let value = |id: NodeId| {
            let found = nodes.iter().position(|node| *node == id);
            found.and_then(|index| values.get(index)).copied().unwrap_or([f64::NAN; 4])
        };
        Self::of_settings(settings, &value, bounds, size)
    }

    /// `value` gives the lanes of the settings' nodes.
    fn of_settings(
        settings: &Settings,
        value: &dyn Fn(NodeId) -> [f64; 4],
        bounds: Option<Bounds>,
        size: [u32; 2],
    ) -> Result<Self, ViewError> {
        let aspect = f64::from(size[0].max(1)) / f64::from(size[1].max(1));
        let pose = match &settings.camera {
            Some(camera) => Pose::of_camera(camera, value)?,
            None => Pose::fitted(bounds, aspect),
        };
        let [right, up, forward] = pose.basis();
        let half_height = (pose.fov / 2.0).tan();
        let limits = Limits::new(&settings.march, &pose, bounds)?;
        let (reflections, reflection_strength) = match &settings.reflections {
            Some(mirrors) => {
                (mirrors.count.min(MAX_REFLECTIONS), strength(value(mirrors.strength))?)
            }
            None => (0, 0.0),
        };
        let color = |node: Option<NodeId>, what| {
            node.map_or(Ok(DVec3::ZERO), |node| finite(value(node), what))
        };
        Ok(Self {
            size,
            eye: pose.eye,
            right: right * half_height * aspect,
            up: up * half_height,
            forward,
            t_max: limits.t_max,
            epsilon: limits.epsilon,
            steps: limits.steps,
            lights: lights(&settings.lights, forward, value)?,
            ambient: color(settings.ambient, "the ambient light")?,
            background: color(settings.background, "the background colour")?,
            reflections,
            reflection_strength,
        })
    }

    /// The view whose rays pass so many pixels to the right of the centres of pixels and below them.
    pub fn shifted(&self, [x, y]: [f64; 2]) -> Self {
        let [columns, rows] = self.size.map(|side| f64::from(side.max(1)));
        let forward = self.forward + self.right * (2.0 * x / columns) - self.up * (2.0 * y / rows);
        Self { forward, ..self.clone() }
    }

    /// Unit direction of the ray through the centre of a pixel; rows count downwards.
    pub fn ray_direction(&self, x: u32, y: u32) -> DVec3 {
        let place = |index: u32, side: u32| 2.0 * (f64::from(index) + 0.5) / f64::from(side) - 1.0;
        let [width, height] = self.size;
        (self.forward + self.right * place(x, width) - self.up * place(y, height)).normalize()
    }

    /// Half the width of a pixel at distance 1.
    pub fn pixel_radius(&self) -> f64 {
        self.right.length() / f64::from(self.size[0].max(1))
    }

    /// The view as the shader reads it, for one tile.
    pub fn block(&self, tile: Tile) -> ViewBlock {
        let mut lights = [LightBlock::default(); MAX_LIGHTS];
        for (block, light) in lights.iter_mut().zip(&self.lights) {
            *block = LightBlock {
                direction: light.direction.as_vec3().to_array(),
                shadow: if light.shadow { SHADOW_HARD } else { SHADOW_OFF },
                color: light.color.as_vec3().to_array(),
                pad: 0.0,
            };
        }
        ViewBlock {
            eye: self.eye.as_vec3().to_array(),
            pixel_radius: self.pixel_radius() as f32,
            right: self.right.as_vec3().to_array(),
            t_max: self.t_max as f32,
            up: self.up.as_vec3().to_array(),
            epsilon: self.epsilon as f32,
            forward: self.forward.as_vec3().to_array(),
            steps: self.steps,
            size: self.size,
            tile_origin: tile.origin,
            tile_size: tile.size,
            light_count: self.lights.len().min(MAX_LIGHTS) as u32,
            pad: 0.0,
            ambient: self.ambient.as_vec3().to_array(),
            reflections: self.reflections,
            background: self.background.as_vec3().to_array(),
            reflection_strength: self.reflection_strength as f32,
            lights,
        }
    }
}

/// How far and how finely rays go.
struct Limits {
    t_max: f64,
    epsilon: f64,
    steps: u32,
}

impl Limits {
    fn new(march: &March, pose: &Pose, bounds: Option<Bounds>) -> Result<Self, ViewError> {
        let reach = (pose.target - pose.eye).length();
        let steps = march.steps.unwrap_or(DEFAULT_STEPS);
        if steps == 0 {
            return Err(ViewError::NotPositive("march's steps", 0.0));
        }
        Ok(Self {
            t_max: stated(march.distance, "march's distance")?
                .unwrap_or_else(|| derived_distance(pose.eye, reach, bounds)),
            epsilon: stated(march.epsilon, "march's epsilon")?.unwrap_or(DEFAULT_EPSILON * reach),
            steps,
        })
    }
}

/// As far as the bounds' farthest corner, and from end to end of them for rays to a lamp, if they
/// are finite and not empty.
fn derived_distance(eye: DVec3, reach: f64, bounds: Option<Bounds>) -> f64 {
    let farthest = bounds.map(|[lo, hi]| {
        let (lo, hi) = (DVec3::from(lo), DVec3::from(hi));
        let farthest = (lo - eye).abs().max((hi - eye).abs()).length();
        if lo.cmple(hi).all() { farthest.max((hi - lo).length()) } else { f64::NAN }
    });
    match farthest {
        Some(distance) if distance.is_finite() && distance > 0.0 => distance * DISTANCE_MARGIN,
        _ => reach * DEFAULT_DISTANCE,
    }
}

fn stated(value: Option<f64>, what: &'static str) -> Result<Option<f64>, ViewError> {
    match value {
        Some(value) if !value.is_finite() => Err(ViewError::NotFinite(what)),
        Some(value) if value <= 0.0 => Err(ViewError::NotPositive(what, value)),
        value => Ok(value),
    }
}

/// The scene's lights, or a white one at the camera if it has none.
fn lights(
    lights: &[Light],
    forward: DVec3,
    value: &dyn Fn(NodeId) -> [f64; 4],
) -> Result<Vec<ViewLight>, ViewError> {
    if lights.len() > MAX_LIGHTS {
        return Err(ViewError::TooManyLights(lights.len()));
    }
    if lights.is_empty() {
        return Ok(vec![ViewLight { direction: -forward, color: DVec3::ONE, shadow: false }]);
    }
    lights.iter().map(|light| view_light(light, value)).collect()
}

fn view_light(light: &Light, value: &dyn Fn(NodeId) -> [f64; 4]) -> Result<ViewLight, ViewError> {
    let direction = finite(value(light.direction), "a light's direction")?;
    Ok(ViewLight {
        direction: direction.try_normalize().ok_or(ViewError::LightDirection)?,
        color: finite(value(light.color), "a light's colour")?,
        shadow: match light.shadow {
            Shadow::Off => false,
            Shadow::Hard => true,
            Shadow::Soft(_) => return Err(ViewError::NotYet("soft shadows")),
        },
    })
}

/// Of reflections.
fn strength([strength, ..]: [f64; 4]) -> Result<f64, ViewError> {
    let within = (0.0..=1.0).contains(&strength);
    if within { Ok(strength) } else { Err(ViewError::ReflectionStrength(strength)) }
}

fn finite([x, y, z, _]: [f64; 4], what: &'static str) -> Result<DVec3, ViewError> {
    let vector = DVec3::new(x, y, z);
    if vector.is_finite() { Ok(vector) } else { Err(ViewError::NotFinite(what)) }
}

#[cfg(test)]
mod tests {
    use sdfc_graph::{Camera, Reflections};

    use super::*;

    /// A program that has only settings.
    #[derive(Default)]
    struct Fixture(Program);

    impl Fixture {
        fn new() -> Self {
            Self::default()
        }

        fn vec3(&mut self, v: [f64; 3]) -> NodeId {
            self.0.graph.constant(sdfc_graph::Type::Vec3, &v)
        }

        fn with_camera(eye: [f64; 3], target: [f64; 3], up: [f64; 3], degrees: f64) -> Self {
            let mut fixture = Self::new();
            let camera = Camera {
                eye: fixture.vec3(eye),
                target: fixture.vec3(target),
                up: fixture.vec3(up),
                fov: fixture.0.graph.number(degrees.to_radians()),
            };
            fixture.0.settings.camera = Some(camera);
            fixture
        }

        fn light(&mut self, direction: [f64; 3], shadow: Shadow) {
            let light = Light {
                direction: self.vec3(direction),
                color: self.vec3([1.0, 0.5, 0.25]),
                shadow,
            };
            self.0.settings.lights.push(light);
        }

        fn view(&self, bounds: Option<Bounds>, size: [u32; 2]) -> Result<View, ViewError> {
            View::new(&self.0, &FrameValues::default(), bounds, size)
        }
    }

    const UNIT: Bounds = [[-1.0; 3], [1.0; 3]];

    fn close(a: DVec3, b: [f64; 3]) {
        assert!((a - DVec3::from(b)).length() < 1e-12, "{a} is not {b:?}");
    }

    #[test]
    fn a_camera_on_z_sees_x_to_the_right_and_y_up() {
        let fixture = Fixture::with_camera([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], 90.0);
        let view = fixture.view(None, [200, 100]).unwrap();
        close(view.forward, [0.0, 0.0, -1.0]);
        close(view.right, [2.0, 0.0, 0.0]);
        close(view.up, [0.0, 1.0, 0.0]);
        assert!((view.pixel_radius() - 0.01).abs() < 1e-12);
        // The centre of the topmost left pixel is 0.99 of the way to the corner.
        let expected = DVec3::new(-1.99, 0.99, -1.0).normalize();
        close(view.ray_direction(0, 0), expected.to_array());
    }

    #[test]
    fn a_view_shifted_by_a_pixel_sees_what_the_next_pixel_saw() {
        let fixture = Fixture::with_camera([1.0, 2.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], 50.0);
        let view = fixture.view(None, [20, 10]).unwrap();
        close(view.shifted([1.0, 0.0]).ray_direction(4, 7), view.ray_direction(5, 7).to_array());
        close(view.shifted([-2.0, 3.0]).ray_direction(4, 6), view.ray_direction(2, 9).to_array());
        assert_eq!(view.shifted([0.0, 0.0]), view);
    }

    #[test]
    fn looking_along_up_keeps_a_right_handed_basis() {
        for eye in [[0.0, 5.0, 0.0], [0.0, -5.0, 0.0]] {
            let fixture = Fixture::with_camera(eye, [0.0; 3], [0.0, 1.0, 0.0], 60.0);
            let view = fixture.view(None, [10, 10]).unwrap();
            let [right, up] = [view.right.normalize(), view.up.normalize()];
            close(right.cross(up), (-view.forward).to_array());
            close(right, [1.0, 0.0, 0.0]);
        }
        let above = Fixture::with_camera([0.0, 5.0, 0.0], [0.0; 3], [0.0, 1.0, 0.0], 60.0);
        close(above.view(None, [10, 10]).unwrap().up.normalize(), [0.0, 0.0, -1.0]);
        let zero = Fixture::with_camera([0.0, 0.0, 5.0], [0.0; 3], [0.0; 3], 60.0);
        close(zero.view(None, [10, 10]).unwrap().up.normalize(), [0.0, 1.0, 0.0]);
    }

    #[test]
    fn a_fitted_camera_has_the_whole_box_in_the_picture() {
        for (bounds, size) in [
            (UNIT, [100, 100]),
            (UNIT, [30, 200]),
            ([[2.0, -7.0, 0.0], [9.0, -6.0, 0.5]], [320, 200]),
            ([[3.0; 3], [3.0; 3]], [10, 10]),
        ] {
            let view = Fixture::new().view(Some(bounds), size).unwrap();
            for corner in 0..8 {
                let pick = |axis: usize| bounds[(corner >> axis) & 1][axis];
                let offset = DVec3::new(pick(0), pick(1), pick(2)) - view.eye;
                let depth = offset.dot(view.forward);
                assert!(depth > 0.0 && offset.length() <= view.t_max, "{bounds:?}");
                for half in [view.right, view.up] {
                    let place = offset.dot(half) / half.length_squared() / depth;
                    assert!(place.abs() < 1.0, "{bounds:?}: {place}");
                }
            }
        }
    }

    #[test]
    fn limits_are_the_scenes_or_follow_from_bounds_and_camera() {
        let camera = || Fixture::with_camera([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], 60.0);
        let derived = camera().view(Some(UNIT), [10, 10]).unwrap();
        let corner = DVec3::new(1.0, 1.0, 6.0).length();
        assert!((derived.t_max - corner * 1.01).abs() < 1e-12);
        assert!((derived.epsilon - 2.5e-4).abs() < 1e-12);
        assert_eq!(camera().view(None, [10, 10]).unwrap().t_max, 1000.0);

        let mut stated = camera();
        stated.0.settings.march =
            March { steps: Some(50), epsilon: Some(0.01), distance: Some(20.0), method: None };
        let stated = stated.view(Some(UNIT), [10, 10]).unwrap();
        assert_eq!((stated.steps, stated.epsilon, stated.t_max), (50, 0.01, 20.0));
    }

    #[test]
    fn settings_that_make_no_picture_are_errors() {
        let error = |fixture: &Fixture| fixture.view(None, [10, 10]).unwrap_err();
        let camera = |eye, fov| Fixture::with_camera(eye, [0.0; 3], [0.0, 1.0, 0.0], fov);
        assert_eq!(error(&camera([0.0; 3], 60.0)), ViewError::EyeIsTarget([0.0; 3]));
        assert!(matches!(error(&camera([1.0; 3], 180.0)), ViewError::Fov(_)));
        assert!(matches!(error(&camera([1.0; 3], -1.0)), ViewError::Fov(_)));
        assert!(matches!(error(&camera([1.0; 3], f64::NAN)), ViewError::Fov(_)));
        assert!(matches!(error(&camera([f64::INFINITY; 3], 60.0)), ViewError::NotFinite(_)));

        let mut fixture = Fixture::new();
        fixture.light([0.0; 3], Shadow::Off);
        assert_eq!(error(&fixture), ViewError::LightDirection);
        let mut fixture = Fixture::new();
        (0..=MAX_LIGHTS).for_each(|_| fixture.light([0.0, 1.0, 0.0], Shadow::Off));
        assert_eq!(error(&fixture), ViewError::TooManyLights(MAX_LIGHTS + 1));

        let mut fixture = Fixture::new();
        let strength = fixture.0.graph.number(1.5);
        fixture.0.settings.reflections = Some(Reflections { count: 1, strength });
        assert_eq!(error(&fixture), ViewError::ReflectionStrength(1.5));

        let mut fixture = Fixture::new();
        fixture.0.settings.march.distance = Some(-3.0);
        assert_eq!(error(&fixture), ViewError::NotPositive("march's distance", -3.0));
        fixture.0.settings.march = March { steps: Some(0), ..March::default() };
        assert_eq!(error(&fixture), ViewError::NotPositive("march's steps", 0.0));
    }

    #[test]
    fn without_lights_there_is_one_at_the_camera() {
        let mut fixture = Fixture::with_camera([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], 60.0);
        let view = fixture.view(None, [10, 10]).unwrap();
        assert_eq!(view.lights.len(), 1);
        close(view.lights[0].direction, [0.0, 0.0, 1.0]);

        fixture.light([0.0, 3.0, 0.0], Shadow::Hard);
        let tile = Tile { origin: [4, 2], size: [3, 1] };
        let block = fixture.view(None, [10, 10]).unwrap().block(tile);
        assert_eq!(block.light_count, 1);
        assert_eq!(block.lights[0].direction, [0.0, 1.0, 0.0]);
        assert_eq!(block.lights[0].color, [1.0, 0.5, 0.25]);
        assert_eq!(block.lights[0].shadow, SHADOW_HARD);
        assert_eq!((block.tile_origin, block.tile_size), ([4, 2], [3, 1]));
    }
}
