//! A scene: the graph, what is drawn, and how.

use crate::{Graph, NodeId, ShapeId, Type};

/// A param of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// Its name.
    pub name: String,
    /// What kind of value it takes.
    pub kind: ParamKind,
    /// Type of its node.
    pub ty: Type,
    /// Its default, as lanes of its type; a choice by its index.
    pub default: [f64; 4],
    /// Lowest and highest value where it has a range.
    pub range: Option<[f64; 2]>,
    /// Names of the choices.
    pub choices: Vec<String>,
    /// First line of its documentation.
    pub summary: String,
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

/// How the scene is drawn. Nodes are of stage `Const` or `Frame`, colours linear.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// None: fitted to the bounds.
    pub camera: Option<Camera>,
    /// None at all: a head light.
    pub lights: Vec<Light>,
    /// Colour of light from everywhere (strength applied).
    pub ambient: Option<NodeId>,
    /// Colour behind everything.
    pub background: Option<NodeId>,
    /// Colours behind everything, by direction.
    pub sky: Option<Sky>,
    /// What is far away fades.
    pub fog: Option<Fog>,
    /// Light from everywhere does not reach everything.
    pub occlusion: Option<Occlusion>,
    /// Mirror reflections; none: surfaces show lamps alone.
    pub reflections: Option<Reflections>,
    /// Rays from the eye for each pixel.
    pub samples: Option<u32>,
    /// How rays are marched.
    pub march: March,
}

impl Settings {
    /// Whether rays from the eye are parallel.
    pub fn is_parallel(&self) -> bool {
        matches!(self.camera.map(|camera| camera.lens), Some(Lens::Height(_)))
    }

    /// All nodes that the settings are made of.
    pub fn nodes(&self) -> Vec<NodeId> {
        // Taken apart so that a new setting does not compile until it is thought of here.
        let Self {
            camera,
            lights,
            ambient,
            background,
            sky,
            fog,
            occlusion,
            reflections,
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
        if let Some(Sky { zenith, horizon }) = *sky {
            nodes.extend([zenith, horizon]);
        }
        if let Some(Fog { density, color }) = *fog {
            nodes.extend(Some(density).into_iter().chain(color));
        }
        if let Some(Occlusion { radius, strength }) = *occlusion {
            nodes.extend([radius, strength]);
        }
        if let Some(Reflections { count: _, strength }) = *reflections {
            nodes.push(strength);
        }
        nodes
    }
}

/// A camera, right-handed, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position, 3-vector.
    pub eye: NodeId,
    /// What is in the middle of the picture, 3-vector.
    pub target: NodeId,
    /// Upward direction, 3-vector.
    pub up: NodeId,
    /// How its rays spread.
    pub lens: Lens,
}

/// How a camera's rays spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lens {
    /// From one point; vertical field of view, radians.
    Fov(NodeId),
    /// Not at all; height of the picture.
    Height(NodeId),
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where its light comes from.
    pub source: LightSource,
    /// Linear colour times strength, 3-vector: of a sun anywhere, of others at distance 1.
    pub color: NodeId,
    /// Its shadow.
    pub shadow: Shadow,
}

/// Where a light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightSource {
    /// From infinitely far away.
    Sun {
        /// Towards the light, 3-vector, of any length.
        direction: NodeId,
    },
    /// From a point, in all directions.
    Point {
        /// 3-vector.
        position: NodeId,
    },
    /// From a point, in a cone.
    Spot {
        /// 3-vector.
        position: NodeId,
        /// A point on the middle of the cone, 3-vector.
        target: NodeId,
        /// From the middle of the cone to its edge, radians.
        angle: NodeId,
    },
}

/// What is seen where nothing is met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sky {
    /// Colour straight up, 3-vector.
    pub zenith: NodeId,
    /// Colour at the horizon and below it, 3-vector.
    pub horizon: NodeId,
}

/// What is far away fades.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fog {
    /// Per length: after a length of 1 / density, 1 / e of a surface's light is left.
    pub density: NodeId,
    /// Colour that it fades to, 3-vector; none: what lies behind.
    pub color: Option<NodeId>,
}

/// How much of the light from everywhere reaches a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occlusion {
    /// What is farther away takes no light.
    pub radius: NodeId,
    /// 0 for none to 1 for all of it.
    pub strength: NodeId,
}

/// What surfaces mirror of each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reflections {
    /// A ray from the eye is mirrored at most so often.
    pub count: u32,
    /// What is seen after n mirrors counts by the n-th power of this number.
    pub strength: NodeId,
}

/// How a light's shadow is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shadow {
    /// None.
    #[default]
    Off,
    /// Without penumbra.
    Hard,
    /// Penumbra; the node is its sharpness.
    Soft(NodeId),
}

/// `march(...)`: `None` leaves the choice to the compiler.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct March {
    /// At most so many steps a ray.
    pub steps: Option<u32>,
    /// A hit is nearer than this (`fixed`, `sphere`).
    pub epsilon: Option<f64>,
    /// A hit is nearer than this, in widths of a pixel there (all other methods).
    pub tolerance: Option<f64>,
    /// Rays end here.
    pub distance: Option<f64>,
    /// Name of the method.
    pub method: Option<String>,
}

/// What elaboration yields.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Shapes and math.
    pub graph: Graph,
    /// All that is drawn, as one solid; `None` if the file draws nothing.
    pub root: Option<ShapeId>,
    /// In order of declaration; `FrameInput::Param` counts in it.
    pub params: Vec<Param>,
    /// Camera, lights, method.
    pub settings: Settings,
    /// Whether anything states a material: without, no material code is emitted.
    pub painted: bool,
}
