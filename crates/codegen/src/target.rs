//! The languages that shaders are written in.

use std::str::FromStr;

use crate::by_name::{UnknownName, by_name};
use crate::options::{Lists, Stage};

/// A language that shaders are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// WebGPU's language.
    Wgsl,
    /// GLSL 4.50, one stage per source.
    Glsl,
    /// GLSL ES 3.00, the language of WebGL 2, one stage per source; it has no compute stage.
    GlslEs,
    /// HLSL, shader model 5.1.
    Hlsl,
    /// Metal's language, version 2.1.
    Msl,
    /// SPIR-V 1.3 for Vulkan, with names.
    Spirv,
    /// The source of a shader on shadertoy.com, in GLSL ES 3.00: a whole picture, see
    /// [`crate::shadertoy_module`].
    Shadertoy,
}

impl Target {
    /// All targets.
    pub const ALL: [Self; 7] =
        [Self::Wgsl, Self::Glsl, Self::GlslEs, Self::Hlsl, Self::Msl, Self::Spirv, Self::Shadertoy];

    /// The target's name on the command line.
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

    /// One sentence about the target.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Wgsl => "WGSL, for WebGPU",
            Self::Glsl => "GLSL 4.50",
            Self::GlslEs => "GLSL ES 3.00, for WebGL 2",
            Self::Hlsl => "HLSL for DirectX, shader model 5.1",
            Self::Msl => "Metal Shading Language 2.1",
            Self::Spirv => "SPIR-V 1.3 for Vulkan",
            Self::Shadertoy => "A complete shader to paste on shadertoy.com",
        }
    }

    /// Returns true if buffers belong to bind groups.
    pub fn has_groups(self) -> bool {
        match self {
            Self::Wgsl | Self::Hlsl | Self::Spirv => true,
            Self::Glsl | Self::GlslEs | Self::Msl | Self::Shadertoy => false,
        }
    }

    /// Returns true if buffers are bound by numbers, not by names.
    pub fn has_bindings(self) -> bool {
        match self {
            Self::Wgsl | Self::Glsl | Self::Hlsl | Self::Msl | Self::Spirv => true,
            Self::GlslEs | Self::Shadertoy => false,
        }
    }

    /// The storage of long lists.
    pub fn lists(self) -> Lists {
        match self {
            Self::Wgsl | Self::Glsl | Self::Hlsl | Self::Msl | Self::Spirv => Lists::Buffer,
            Self::GlslEs | Self::Shadertoy => Lists::Constants,
        }
    }

    /// Returns true if the language has a stage.
    pub fn has_stage(self, stage: Stage) -> bool {
        match self {
            Self::Wgsl | Self::Glsl | Self::Hlsl | Self::Msl | Self::Spirv => true,
            Self::GlslEs | Self::Shadertoy => stage == Stage::Fragment,
        }
    }

    /// The stage of a picture's shader, unless another one is asked for.
    pub fn default_stage(self) -> Stage {
        if self.has_stage(Stage::Compute) { Stage::Compute } else { Stage::Fragment }
    }

    /// Returns true if the first row that a fragment stage draws is the lowest.
    pub fn counts_rows_upwards(self) -> bool {
        match self {
            Self::Glsl | Self::GlslEs | Self::Shadertoy => true,
            Self::Wgsl | Self::Hlsl | Self::Msl | Self::Spirv => false,
        }
    }
}

impl FromStr for Target {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        by_name("target", name, &Self::ALL, Self::name)
    }
}

/// A shader in a target's language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Code {
    /// The source.
    Text(String),
    /// The words of SPIR-V.
    Words(Vec<u32>),
}

impl Code {
    /// The contents of a file: UTF-8, or words of four bytes, least significant byte first.
    pub fn into_bytes(self) -> Vec<u8> {
        match self {
            Self::Text(text) => text.into_bytes(),
            Self::Words(words) => words.iter().flat_map(|word| word.to_le_bytes()).collect(),
        }
    }
}
