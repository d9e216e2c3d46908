//! Arguments of `sdfc compile`.

use std::path::PathBuf;

use sdfc::{Emit, MAX_BINDING, Method, Stage, Target};

use super::values::{Assignment, LiveLiterals, assignment, methods, named};

/// Arguments of `compile`.
#[derive(clap::Args, Debug)]
pub struct Compile {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Output file of the shader; `-` is stdout
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: PathBuf,
    /// Shader language
    #[arg(long, default_value = Target::Wgsl.name(),
          value_parser = named::<Target>(Target::ALL.map(|it| [it.name(), it.summary()])))]
    pub target: Target,
    /// Which part of the shader to write [default: field; render for shadertoy]
    #[arg(long, value_parser = named::<Emit>(Emit::ALL.map(|it| [it.name(), it.summary()])))]
    pub emit: Option<Emit>,
    /// Shader stage of `--emit render` [default: compute; fragment for glsl-es]
    #[arg(long, value_parser = named::<Stage>(Stage::ALL.map(|it| [it.name(), it.summary()])))]
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
