//! Options of shaders for other engines.

use std::str::FromStr;

use sdfc_march::Method;

use crate::by_name::{UnknownName, by_name};

/// The stages of a picture's shader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Stage {
    /// A compute stage that writes pixels into a buffer.
    #[default]
    Compute,
    /// A full-screen triangle, and a fragment stage that returns a pixel's colour.
    Fragment,
}

impl Stage {
    /// Both stages, the default first.
    pub const ALL: [Self; 2] = [Self::Compute, Self::Fragment];

    /// The stage's name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Compute => "compute",
            Self::Fragment => "fragment",
        }
    }

    /// One sentence about the stage.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Compute => "A compute stage that writes pixels into a buffer",
            Self::Fragment => {
                "A fragment stage, with a vertex stage for a triangle over the target"
            }
        }
    }
}

impl FromStr for Stage {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        by_name("stage", name, &Self::ALL, Self::name)
    }
}

/// The largest number of elements of a list that is a constant in a shader for another engine.
pub const MAX_CONSTANT_LIST: usize = 64;

/// The storage of the lists of a shader for another engine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Lists {
    /// If one has more than [`MAX_CONSTANT_LIST`] elements all are in a storage buffer, one after
    /// the other; [`crate::Shader::lists`] returns its contents.
    #[default]
    Buffer,
    /// All are constants in the shader, for languages without storage buffers.
    Constants,
}

/// Options for the functions of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldOptions {
    /// Start of every name.
    pub prefix: String,
    /// True to write the gradient.
    pub gradient: bool,
    /// True to write the material, if the program has one.
    pub material: bool,
    /// Bind group of the uniform structure.
    pub group: u32,
    /// Its binding in the group; lists have the next one.
    pub binding: u32,
    /// The storage of long lists.
    pub lists: Lists,
}

impl Default for FieldOptions {
    fn default() -> Self {
        let prefix = "sdf_".to_owned();
        let lists = Lists::default();
        Self { prefix, gradient: true, material: true, group: 0, binding: 0, lists }
    }
}

/// The form and the names of a picture's shader for another engine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureOptions {
    /// The ray method.
    pub method: Method,
    /// The stages.
    pub stage: Stage,
    /// True if the first row of the target is the lowest, as in OpenGL. Used for
    /// [`Stage::Fragment`].
    pub rows_up: bool,
    /// Start of every name.
    pub prefix: String,
    /// Bind group of the buffers.
    pub group: u32,
    /// Binding of the view; params have the next one, then pixels, then lists.
    pub binding: u32,
    /// The storage of long lists.
    pub lists: Lists,
}
