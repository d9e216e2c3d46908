//! Arguments of `sdfc compile`.

use std::path::PathBuf;

use clap::ValueEnum;
use sdfc::{MAX_BINDING, Method};

use super::values::{Assignment, LiveLiterals, assignment, methods};

/// Arguments of `compile`.
#[derive(clap::Args, Debug)]
pub struct Compile {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Output file of the shader; `-` is stdout
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: PathBuf,
    /// Shader language
    #[arg(long, value_enum, default_value_t)]
    pub target: Target,
    /// Which part of the shader to write [default: field; render for shadertoy]
    #[arg(long, value_enum)]
    pub emit: Option<Emit>,
    /// Shader stage of `--emit render` [default: compute; fragment for glsl-es]
    #[arg(long, value_enum)]
    pub stage: Option<Stage>,
    /// Ray method of `--emit march` and `render` [default: that of the scene, or auto]
    #[arg(long, value_name = "METHOD", value_parser = methods())]
    pub march: Option<Method>,
    /// Prefix of all names [default: sdf_]
    #[arg(long, value_name = "NAME")]
    pub prefix: Option<String>,
    /// Bind group of the buffers [default: 0]
    #[arg(long, value_name = "N",
          value_parser = clap::value_parser!(u32).range(..=i64::from(MAX_BINDING)))]
    pub group: Option<u32>,
    /// Binding of the first buffer; the others follow [default: 0]
    #[arg(long, value_name = "N",
          value_parser = clap::value_parser!(u32).range(..=i64::from(MAX_BINDING)))]
    pub binding: Option<u32>,
    /// Output file for names, layouts and properties of the field, as JSON; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub reflect: Option<PathBuf>,
    /// Set a param: its value, if it is a constant of the shader, otherwise its default. The value
    /// is written as in a scene: 0.5, 90deg, true, #d94f30, or the name of a choice
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<Assignment>,
    /// Numbers of the scene as params.
    #[command(flatten)]
    pub live: LiveLiterals,
}

/// Shader languages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// WGSL, for WebGPU
    #[default]
    Wgsl,
    /// GLSL 4.50
    Glsl,
    /// GLSL ES 3.00, for WebGL 2
    GlslEs,
    /// HLSL for DirectX, shader model 5.1
    Hlsl,
    /// Metal Shading Language 2.1
    Msl,
    /// SPIR-V 1.3 for Vulkan
    Spirv,
    /// A complete shader to paste on shadertoy.com
    Shadertoy,
}

impl From<Target> for sdfc::Target {
    fn from(target: Target) -> Self {
        match target {
            Target::Wgsl => Self::Wgsl,
            Target::Glsl => Self::Glsl,
            Target::GlslEs => Self::GlslEs,
            Target::Hlsl => Self::Hlsl,
            Target::Msl => Self::Msl,
            Target::Spirv => Self::Spirv,
            Target::Shadertoy => Self::Shadertoy,
        }
    }
}

/// Parts of a shader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Emit {
    /// Functions for distance, gradient and material
    #[default]
    Field,
    /// The same, and a ray method
    March,
    /// A complete shader that draws pictures
    Render,
}

impl From<Emit> for sdfc::Emit {
    fn from(emit: Emit) -> Self {
        match emit {
            Emit::Field => Self::Field,
            Emit::March => Self::March,
            Emit::Render => Self::Render,
        }
    }
}

/// Stages of a shader that draws pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Stage {
    /// A compute stage that writes pixels into a buffer
    Compute,
    /// A fragment stage, with a vertex stage for a triangle over the target
    Fragment,
}

impl From<Stage> for sdfc::Stage {
    fn from(stage: Stage) -> Self {
        match stage {
            Stage::Compute => Self::Compute,
            Stage::Fragment => Self::Fragment,
        }
    }
}
