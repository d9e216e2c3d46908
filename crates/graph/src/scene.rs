//! A scene: its graph, its root shape, its params and its settings.

use crate::graph::Graph;
use crate::node::{NodeId, ShapeId, Type};

/// A param of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// Its name.
    pub name: String,
    /// Kind of its value.
    pub kind: ParamKind,
    /// Type of its node.
    pub ty: Type,
    /// Its default, as lanes of its type; for a choice, the index.
    pub default: [f64; 4],
    /// The value that the scene was compiled with, if it is a constant of the graph because it
    /// decides what the scene consists of; `None` if the value can change from frame to frame.
    pub fixed: Option<[f64; 4]>,
    /// Lowest and highest value, if it has a range.
    pub range: Option<[f64; 2]>,
    /// Names of the choices.
    pub choices: Vec<String>,
    /// First line of its documentation.
    pub summary: String,
}

impl Param {
    /// True if the param can have a value: it is finite, within the range, and an integer, a truth
    /// value or an index of a choice where the kind needs that.
    pub fn accepts(&self, lanes: [f64; 4]) -> bool {
        let [number, ..] = lanes;
        let in_range = self.range.is_none_or(|[lo, hi]| (lo..=hi).contains(&number));
        let fits = match self.kind {
            ParamKind::Number | ParamKind::Angle => in_range,
            ParamKind::Int => in_range && number.fract() == 0.0,
            ParamKind::Bool => number == 0.0 || number == 1.0,
            ParamKind::Color => true,
            ParamKind::Choice => {
                number >= 0.0 && number.fract() == 0.0 && (number as usize) < self.choices.len()
            }
        };
        fits && lanes.iter().all(|lane| lane.is_finite())
    }
}

/// Kinds of params, as a user interface shows them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ParamKind {
    /// Any number.
    Number,
    /// Whole numbers.
    Int,
    /// Radians.
    Angle,
    /// 0 or 1.
    Bool,
    /// Linear red, green, blue, alpha.
    Color,
    /// Index of a choice.
    Choice,
}

/// Rendering settings. Nodes are of stage `Const` or `Frame`, except those of the environment;
/// colours are linear.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// The camera; `None`: fitted to the bounds.
    pub camera: Option<Camera>,
    /// The lights; if empty, a head light.
    pub lights: Vec<Light>,
    /// Ambient light: colour times strength.
    pub ambient: Option<NodeId>,
    /// Background colour.
    pub background: Option<NodeId>,
    /// Background colours by direction.
    pub sky: Option<Sky>,
    /// The light of a picture of the surroundings, in place of `background` and `sky`.
    pub environment: Option<Environment>,
    /// Fog.
    pub fog: Option<Fog>,
    /// Ambient occlusion.
    pub occlusion: Option<Occlusion>,
    /// Mirror reflections; `None`: surfaces show lights only.
    pub reflections: Option<Reflections>,
    /// How light becomes the colours of the picture; `None`: unchanged.
    pub exposure: Option<Exposure>,
    /// Distance between the isolines of a planar picture; `None`: it has none.
    pub isolines: Option<NodeId>,
    /// Camera rays per pixel.
    pub samples: Option<u32>,
    /// Settings of the ray marcher.
    pub march: March,
}

impl Settings {
    /// True if camera rays are parallel (an orthographic camera).
    pub fn is_parallel(&self) -> bool {
        matches!(self.camera.map(|camera| camera.lens), Some(Lens::Height(_)))
    }

    /// True if nothing lights the scene, so that a light at the camera does.
    pub fn has_headlight(&self) -> bool {
        self.lights.is_empty() && self.environment.is_none()
    }

    /// All nodes of stage `Const` or `Frame` that the settings use.
    pub fn nodes(&self) -> Vec<NodeId> {
        // Destructured so that a new setting does not compile until it is handled here.
        let Self {
            camera,
            lights,
            ambient,
            background,
            sky,
            environment: _, // functions of a direction
            fog,
            occlusion,
            reflections,
            exposure,
            isolines,
            samples: _,
            march: _,
        } = self;
        let mut nodes = Vec::new();
        if let Some(Camera { eye, target, up, lens: Lens::Fov(size) | Lens::Height(size) }) =
            *camera
        {
            nodes.extend([eye, target, up, size]);
        }
        for Light { source, color, shadow } in lights {
            match *source {
                LightSource::Sun { direction } => nodes.push(direction),
                LightSource::Point { position } => nodes.push(position),
                LightSource::Spot { position, target, angle } => {
                    nodes.extend([position, target, angle]);
                }
            }
            nodes.push(*color);
            match *shadow {
                Shadow::Soft(sharpness) => nodes.push(sharpness),
                Shadow::Off | Shadow::Hard => {}
            }
        }
        nodes.extend(ambient.iter().chain(background));
        if let Some(Sky { zenith, horizon, ground }) = *sky {
            nodes.extend([zenith, horizon].into_iter().chain(ground));
        }
        if let Some(Fog { density, color }) = *fog {
            nodes.extend(Some(density).into_iter().chain(color));
        }
        if let Some(Occlusion { radius, strength }) = *occlusion {
            nodes.extend(radius.into_iter().chain([strength]));
        }
        if let Some(Reflections { count: _, strength }) = *reflections {
            nodes.push(strength);
        }
        if let Some(Exposure { factor, tone: _ }) = *exposure {
            nodes.extend(factor);
        }
        nodes.extend(isolines);
        nodes
    }
}

/// A camera, right-handed, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position, 3-vector.
    pub eye: NodeId,
    /// Position in the middle of the picture, 3-vector.
    pub target: NodeId,
    /// Upward direction, 3-vector.
    pub up: NodeId,
    /// Projection.
    pub lens: Lens,
}

/// A camera's projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lens {
    /// Perspective; vertical field of view in radians.
    Fov(NodeId),
    /// Orthographic; height of the picture in scene units.
    Height(NodeId),
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Kind and position.
    pub source: LightSource,
    /// Linear colour times strength, 3-vector: for a sun anywhere, for other lights at distance 1.
    pub color: NodeId,
    /// Kind of its shadow.
    pub shadow: Shadow,
}

/// Kind and position of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightSource {
    /// A directional light, infinitely far away.
    Sun {
        /// Direction towards the light, 3-vector of any length.
        direction: NodeId,
    },
    /// A point light.
    Point {
        /// Position, 3-vector.
        position: NodeId,
    },
    /// A spot light.
    Spot {
        /// Position, 3-vector.
        position: NodeId,
        /// A point on the axis of the cone, 3-vector.
        target: NodeId,
        /// Angle from the axis of the cone to its edge, in radians.
        angle: NodeId,
    },
}

/// Background colours by direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sky {
    /// Colour straight up, 3-vector.
    pub zenith: NodeId,
    /// Colour at the horizon, 3-vector.
    pub horizon: NodeId,
    /// Colour straight down, 3-vector; `None`: that of the horizon.
    pub ground: Option<NodeId>,
}

/// The light of the surroundings, as functions that shaders call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Environment {
    /// The light that a mirror receives, 3-vector. The mirrored direction is
    /// `Point(0, Dim::Three)`; all components of `Point(1, Dim::Three)` are the mirror's roughness,
    /// 0 for the picture itself.
    pub radiance: NodeId,
    /// The light that a matt white surface reflects, 3-vector. Its normal is
    /// `Point(0, Dim::Three)`.
    pub irradiance: NodeId,
}

/// Fog, which fades distant surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fog {
    /// Density per unit of length: after a length of `1 / density`, `1 / e` of a surface's light is
    /// left.
    pub density: NodeId,
    /// Colour that surfaces fade to, 3-vector; `None`: what lies behind.
    pub color: Option<NodeId>,
}

/// Ambient occlusion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occlusion {
    /// Occluders farther away than this have no effect; `None`: a part of the height of the
    /// picture.
    pub radius: Option<NodeId>,
    /// From 0 (no occlusion) to 1 (full).
    pub strength: NodeId,
}

/// How light becomes the colours of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exposure {
    /// Factor of all light; `None`: 1.
    pub factor: Option<NodeId>,
    /// The curve that compresses light that is brighter than a picture can show.
    pub tone: Tone,
}

/// Curves from light to the colours of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Tone {
    /// Colours are kept; brighter ones become white.
    Clip,
    /// Colours are kept up to 0.8; brighter ones approach 1 and lose saturation.
    #[default]
    Neutral,
    /// As film: more contrast, less saturation.
    Film,
}

/// Mirror reflections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reflections {
    /// Maximum number of reflections of a camera ray.
    pub count: u32,
    /// Light seen after n reflections is multiplied by the n-th power of this number.
    pub strength: NodeId,
}

/// Kinds of shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shadow {
    /// No shadow.
    #[default]
    Off,
    /// A shadow without penumbra.
    Hard,
    /// A shadow with a penumbra; the node is its sharpness.
    Soft(NodeId),
}

/// Settings of the ray marcher, `march(...)` in a scene. `None` leaves the choice to the compiler.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct March {
    /// Maximum number of steps per ray.
    pub steps: Option<u32>,
    /// Distance below which a step is a hit (methods `fixed` and `sphere`).
    pub epsilon: Option<f64>,
    /// Distance below which a step is a hit, in pixel widths at the hit (all other methods).
    pub tolerance: Option<f64>,
    /// Length of a ray.
    pub distance: Option<f64>,
    /// Name of the method.
    pub method: Option<String>,
}

/// The result of elaborating a script.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The shapes and the math.
    pub graph: Graph,
    /// The union of everything that is drawn; `None` if the file draws nothing. It is a solid, or a
    /// region if the scene is planar.
    pub root: Option<ShapeId>,
    /// The regions that a planar scene draws, from the lowest to the topmost. Empty for solids.
    pub layers: Vec<ShapeId>,
    /// The params in order of declaration; `FrameInput::Param` is an index into them.
    pub params: Vec<Param>,
    /// Camera, lights and ray marcher.
    pub settings: Settings,
    /// True if any shape has a material; otherwise no material code is emitted.
    pub has_materials: bool,
}
