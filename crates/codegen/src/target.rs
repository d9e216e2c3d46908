//! The languages that shaders are written in.

use crate::options::{Lists, Stage};

/// A language that shaders are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// WebGPU's.
    Wgsl,
    /// GLSL 4.50, one stage in a text.
    Glsl,
    /// GLSL ES 3.00, WebGL 2's, one stage in a text; it has no compute stage.
    GlslEs,
    /// Shader model 5.1.
    Hlsl,
    /// Metal 2.1.
    Msl,
    /// SPIR-V 1.3 for Vulkan, with names.
    Spirv,
    /// The one text of a shader on shadertoy.com, GLSL ES 3.00: a whole picture, see
    /// [`crate::shadertoy_module`].
    Shadertoy,
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Wgsl, Self::Glsl, Self::GlslEs, Self::Hlsl, Self::Msl, Self::Spirv, Self::Shadertoy];

    /// What the command line calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl => "glsl",
            Self::GlslEs => "glsl-es",
            Self::Hlsl => "hlsl",
            Self::Msl => "msl",
            Self::Spirv => "spirv",
            Self::Shadertoy => "shadertoy",
        }
    }

    /// Whether buffers are in groups.
    pub fn has_groups(self) -> bool {
        match self {
            Self::Wgsl | Self::Hlsl | Self::Spirv => true,
            Self::Glsl | Self::GlslEs | Self::Msl | Self::Shadertoy => false,
        }
    }

    /// Whether buffers are bound by numbers, not by names.
    pub fn has_bindings(self) -> bool {
        match self {
            Self::Wgsl | Self::Glsl | Self::Hlsl | Self::Msl | Self::Spirv => true,
            Self::GlslEs | Self::Shadertoy => false,
        }
    }

    /// Where long lists are.
    pub fn lists(self) -> Lists {
        match self {
            Self::Wgsl | Self::Glsl | Self::Hlsl | Self::Msl | Self::Spirv => Lists::Buffer,
            Self::GlslEs | Self::Shadertoy => Lists::Constants,
        }
    }

    /// Whether there is a stage.
    pub fn has_stage(self, stage: Stage) -> bool {
        match self {
            Self::Wgsl | Self::Glsl | Self::Hlsl | Self::Msl | Self::Spirv => true,
            Self::GlslEs | Self::Shadertoy => stage == Stage::Fragment,
        }
    }

    /// Whether the first row of what a fragment stage draws is the lowest.
    pub fn counts_rows_upwards(self) -> bool {
        match self {
            Self::Glsl | Self::GlslEs | Self::Shadertoy => true,
            Self::Wgsl | Self::Hlsl | Self::Msl | Self::Spirv => false,
        }
    }
}

/// A shader in a target's language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Code {
    /// The text.
    Text(String),
    /// The words of SPIR-V.
    Words(Vec<u32>),
}

impl Code {
    /// As a file holds it: UTF-8, or words of four bytes, the lowest first.
    pub fn into_bytes(self) -> Vec<u8> {
        match self {
            Self::Text(text) => text.into_bytes(),
            Self::Words(words) => words.iter().flat_map(|word| word.to_le_bytes()).collect(),
        }
    }
}
