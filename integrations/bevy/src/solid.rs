//! Entities that show a scene.

use std::collections::BTreeMap;

use bevy::asset::Handle;
use bevy::camera::visibility::Visibility;
use bevy::color::{Color, LinearRgba};
use bevy::ecs::prelude::*;
use bevy::math::Vec3;
use bevy::transform::components::Transform;
use sdfc::Value;

use crate::scene::SdfcScene;

/// Shows a compiled scene at the entity's transform.
///
/// The plugin adds a mesh, which is the box of the scene's bounds, and a material that draws the
/// scene inside it. Change a field, and the picture follows; nothing is compiled again.
///
/// ```
/// use bevy::prelude::*;
/// use sdfc_bevy::SdfcSolid;
///
/// fn setup(mut commands: Commands, assets: Res<AssetServer>) {
///     let bowl = assets.load("bowl.sdf");
///     let solid = SdfcSolid::new(bowl).with("wall", 0.1);
///     commands.spawn((solid, Transform::from_xyz(0.0, 1.0, 0.0)));
/// }
///
/// fn widen(mut solids: Query<&mut SdfcSolid>, time: Res<Time>) {
///     for mut solid in &mut solids {
///         solid.set("wall", 0.1 + 0.05 * time.elapsed_secs().sin());
///     }
/// }
/// ```
#[derive(Component, Clone, Debug)]
#[require(Transform, Visibility, SdfcStatus)]
pub struct SdfcSolid {
    /// The scene.
    pub scene: Handle<SdfcScene>,
    /// Values of params by name. The others have their defaults.
    pub params: BTreeMap<String, ParamValue>,
    /// The colour of parts of the scene that have none.
    pub base_color: Color,
    /// Perceptual roughness of a scene without materials, from 0 to 1.
    pub perceptual_roughness: f32,
    /// 1 if a scene without materials is a metal, 0 if not.
    pub metallic: f32,
    /// Reflectance of parts that are no metals, as in `StandardMaterial`: 0.5 reflects 4 %.
    pub reflectance: f32,
    /// The box that is drawn, as its lowest and highest corner in the scene's coordinates. `None`
    /// takes the scene's bounds; a scene without a limit, such as a floor, needs a box.
    pub bounds: Option<[Vec3; 2]>,
}

/// Whether a solid is drawn.
#[derive(Component, Clone, Debug, Default, PartialEq, Eq)]
pub enum SdfcStatus {
    /// Its scene is not loaded yet.
    #[default]
    Waiting,
    /// It is drawn.
    Drawn,
    /// It is not drawn as it states. The message says why, and was logged too.
    Failed(String),
}

/// A value of a param.
#[derive(Clone, Debug, PartialEq)]
pub enum ParamValue {
    /// A number, an integer, or an angle in radians.
    Number(f64),
    /// A truth value.
    Bool(bool),
    /// A colour.
    Color(LinearRgba),
    /// The name of a choice.
    Choice(String),
}

impl SdfcSolid {
    /// A grey solid that shows a scene with the defaults of its params.
    pub fn new(scene: Handle<SdfcScene>) -> Self {
        Self {
            scene,
            params: BTreeMap::new(),
            base_color: Color::linear_rgb(0.8, 0.8, 0.8),
            perceptual_roughness: 0.5,
            metallic: 0.0,
            reflectance: 0.5,
            bounds: None,
        }
    }

    /// Sets a param by its name in the scene. In the next frame, [`SdfcStatus`] reports a wrong
    /// name or value.
    pub fn set(&mut self, name: &str, value: impl Into<ParamValue>) {
        self.params.insert(name.to_owned(), value.into());
    }

    /// The solid with a value for a param.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Into<ParamValue>) -> Self {
        self.set(name, value);
        self
    }
}

impl ParamValue {
    /// The value as sdfc takes it.
    pub(crate) fn as_value(&self) -> Value<'_> {
        match self {
            Self::Number(number) => Value::Number(*number),
            Self::Bool(truth) => Value::Bool(*truth),
            Self::Color(LinearRgba { red, green, blue, alpha }) => {
                Value::Color([*red, *green, *blue, *alpha].map(f64::from))
            }
            Self::Choice(name) => Value::Choice(name),
        }
    }
}

impl From<f64> for ParamValue {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<f32> for ParamValue {
    fn from(number: f32) -> Self {
        Self::Number(f64::from(number))
    }
}

impl From<i32> for ParamValue {
    fn from(number: i32) -> Self {
        Self::Number(f64::from(number))
    }
}

impl From<bool> for ParamValue {
    fn from(truth: bool) -> Self {
        Self::Bool(truth)
    }
}

impl From<Color> for ParamValue {
    fn from(color: Color) -> Self {
        Self::Color(color.to_linear())
    }
}

impl From<&str> for ParamValue {
    fn from(choice: &str) -> Self {
        Self::Choice(choice.to_owned())
    }
}
