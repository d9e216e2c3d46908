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

/// How the scene is drawn. Nodes are of stage `Const` or `Frame`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// None: fitted to the bounds.
    pub camera: Option<Camera>,
    /// None at all: a head light.
    pub lights: Vec<Light>,
    /// Linear colour of light from everywhere (strength applied).
    pub ambient: Option<NodeId>,
    /// Linear colour behind everything.
    pub background: Option<NodeId>,
    /// Mirror reflections; none: surfaces show lamps alone.
    pub reflections: Option<Reflections>,
    /// How rays are marched.
    pub march: March,
}

impl Settings {
    /// All nodes that the settings are made of.
    pub fn nodes(&self) -> Vec<NodeId> {
        // Taken apart so that a new setting does not compile until it is thought of here.
        let Self { camera, lights, ambient, background, reflections, march: _ } = self;
        let camera = camera.iter().flat_map(|camera| {
            let Camera { eye, target, up, fov } = *camera;
            [eye, target, up, fov]
        });
        let lights = lights.iter().flat_map(|light| {
            let Light { direction, color, shadow } = *light;
            let sharpness = match shadow {
                Shadow::Soft(sharpness) => Some(sharpness),
                Shadow::Off | Shadow::Hard => None,
            };
            [Some(direction), Some(color), sharpness].into_iter().flatten()
        });
        let strength = reflections.as_ref().map(|Reflections { count: _, strength }| *strength);
        camera.chain(lights).chain(*ambient).chain(*background).chain(strength).collect()
    }
}

/// A perspective camera, right-handed, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position, 3-vector.
    pub eye: NodeId,
    /// What is in the middle of the picture, 3-vector.
    pub target: NodeId,
    /// Upward direction, 3-vector.
    pub up: NodeId,
    /// Vertical field of view, radians.
    pub fov: NodeId,
}

/// A directional light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Towards the light, 3-vector, of any length.
    pub direction: NodeId,
    /// Linear colour times strength, 3-vector.
    pub color: NodeId,
    /// Its shadow.
    pub shadow: Shadow,
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
    /// At most so many steps (`fixed`, `sphere`).
    pub steps: Option<u32>,
    /// A hit is nearer than this (`fixed`, `sphere`).
    pub epsilon: Option<f64>,
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
