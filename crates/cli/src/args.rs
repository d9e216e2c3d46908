//! The arguments, as clap reads them.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Parser, Subcommand, ValueEnum};
use sdfc::lang::settings::RAY_METHODS;
use sdfc::march::METHODS;
use sdfc::render::{MAX_PIXELS, MAX_SAMPLES, MAX_SIDE};

use crate::sequence::{self, Frames};

/// Compiles scenes of signed distance functions to shaders and pictures.
#[derive(Debug, Parser)]
#[command(name = "sdfc", version, propagate_version = true, max_term_width = 100)]
#[command(
    after_help = "Exit status: 0 done, 1 the scene is wrong, 2 the call is wrong, 3 the machine cannot, \
                  130 stopped by ctrl-C."
)]
pub struct Args {
    /// Options that every command takes.
    #[command(flatten)]
    pub global: Global,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The greatest bind group or binding that can be asked for.
const MAX_BINDING: i64 = 65_535;

/// Options that every command takes.
#[derive(clap::Args, Debug)]
pub struct Global {
    /// Colour in messages
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN")]
    pub color: ColorChoice,
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say more about what is done
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

/// When messages are coloured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ColorChoice {
    /// On a terminal, unless NO_COLOR is set
    #[default]
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Show all that is wrong with scenes, and nothing else
    Check(Check),
    /// Write scenes in the one layout
    #[command(name = "fmt")]
    Format(Format),
    /// Write the shader of a scene
    Compile(Compile),
    /// Draw a scene
    Render(Render),
    /// Show a scene in a window that follows its text
    View(View),
    /// Say what was modelled and why
    Explain(Explain),
    /// Time the specialised shader against shaders that interpret the scene
    Bench(Bench),
    /// Say what a scene can name: shapes, operators, functions, settings, types
    Doc(Doc),
    /// Compare every ray method with where rays really meet the scene
    Chart(Chart),
    /// Find the cheapest ray method and setting that keep an error
    Tune(Tune),
}

/// Arguments of `check`.
#[derive(clap::Args, Debug)]
pub struct Check {
    /// Scenes; `-` is stdin
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Write the diagnostics to stdout as JSON
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `fmt`.
#[derive(clap::Args, Debug)]
pub struct Format {
    /// Scenes, formatted in place; `-` is stdin, formatted to stdout
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Change nothing; fail if anything would change
    #[arg(long)]
    pub check: bool,
}

/// Arguments of `compile`.
#[derive(clap::Args, Debug)]
pub struct Compile {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Where the shader goes; `-`, the default, is stdout
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: PathBuf,
    /// The language to write
    #[arg(long, value_enum, default_value_t)]
    pub target: Target,
    /// Which part to write [default: field; render for shadertoy]
    #[arg(long, value_enum)]
    pub emit: Option<Emit>,
    /// The stage of `--emit render` [default: compute; fragment for glsl-es]
    #[arg(long, value_enum)]
    pub stage: Option<Stage>,
    /// The ray method of `--emit march` and `render`; the scene's `march(...)` or auto if not given
    #[arg(long, value_name = "METHOD", value_parser = methods())]
    pub march: Option<String>,
    /// Start of every name [default: sdf_]
    #[arg(long, value_name = "NAME")]
    pub prefix: Option<String>,
    /// Bind group of the buffers [default: 0]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=MAX_BINDING))]
    pub group: Option<u32>,
    /// Binding of the first of them; the others have the next ones [default: 0]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=MAX_BINDING))]
    pub binding: Option<u32>,
    /// Where names, layouts and what is known of the field go, as JSON; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub reflect: Option<PathBuf>,
    /// Make params of the numbers in the scene, called at_LINE_COLUMN, so that they move without a
    /// recompile
    #[arg(long)]
    pub slots: bool,
}

/// Languages that shaders are written in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// WebGPU's
    #[default]
    Wgsl,
    /// GLSL 4.50
    Glsl,
    /// GLSL ES 3.00, that of WebGL 2
    GlslEs,
    /// DirectX, shader model 5.1
    Hlsl,
    /// Metal 2.1
    Msl,
    /// SPIR-V 1.3 for Vulkan
    Spirv,
    /// A whole shader to be pasted on shadertoy.com
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

/// Parts of the shader, and what it is made from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Emit {
    /// The functions for distance, gradient and material
    #[default]
    Field,
    /// The same, and where a ray meets the surface
    March,
    /// The whole shader that draws pictures
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

/// Stages of the shader that draws pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Stage {
    /// Pixels into a buffer
    Compute,
    /// The colour of a pixel, and a vertex stage for a triangle over the target
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

/// Arguments of `render`.
#[derive(clap::Args, Debug)]
pub struct Render {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Where the picture goes: a PNG, or an EXR or GIF by its ending; `-` is stdout, as a PNG [default: the
    /// scene's name with .png, here]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "640x400", value_parser = size)]
    pub size: [u32; 2],
    /// The ray method; the scene's `march(...)` or auto if not given
    #[arg(long, value_name = "METHOD", value_parser = methods())]
    pub march: Option<String>,
    /// What draws
    #[arg(long, value_enum, default_value_t)]
    pub backend: Backend,
    /// How the field of many parts is written
    #[arg(long, value_enum, default_value_t)]
    pub writing: Writing,
    /// Give a param a value, written as in a scene: 0.5, 90deg, true, #d94f30, or a choice's name
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<Assignment>,
    /// Make params of the numbers in the scene, called at_LINE_COLUMN, so that they move without a
    /// recompile
    #[arg(long)]
    pub slots: bool,
    /// The time, in seconds
    #[arg(long, value_name = "S", default_value_t = 0.0, allow_negative_numbers = true,
          value_parser = finite, conflicts_with = "frames")]
    pub time: f64,
    /// Draw the frames from A to before B, as OUT.0007.png and so on, or as one GIF; the time of frame n
    /// is n / fps
    #[arg(long, value_name = "A..B", value_parser = sequence::frames)]
    pub frames: Option<Frames>,
    /// Frames a second
    #[arg(long, value_name = "N", default_value_t = 30.0, value_parser = sequence::rate)]
    pub fps: f64,
    /// Rays from the eye for each pixel, averaged; the scene's `antialias(...)` or 1 if not given
    #[arg(long, value_name = "N",
          value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    pub samples: Option<u32>,
    /// Where depths go, as an EXR: channel Z, the distance along each pixel's ray in scene units, infinite
    /// where nothing is met
    #[arg(long, value_name = "OUT.exr")]
    pub depth: Option<PathBuf>,
    /// Where figures about the picture go, as JSON; `-` is stdout. The frame is drawn five times
    #[arg(long, value_name = "OUT.json", conflicts_with = "frames")]
    pub stats: Option<PathBuf>,
}

/// A param and the text of its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// The param.
    pub name: String,
    /// The value, as written.
    pub value: String,
}

/// What draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// The graphics adapter if there is one, else the processor
    #[default]
    Auto,
    /// The graphics adapter
    Gpu,
    /// The processor
    Cpu,
}

/// How the field of many parts is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Writing {
    /// As costs less
    #[default]
    Auto,
    /// All that there is, one operation after the other
    Inline,
    /// Parts that are equal up to constants as loops over lists
    Rolled,
}

impl From<Writing> for sdfc::LoopStrategy {
    fn from(writing: Writing) -> Self {
        match writing {
            Writing::Auto => Self::Auto,
            Writing::Inline => Self::Unrolled,
            Writing::Rolled => Self::Looped,
        }
    }
}

/// Arguments of `view`.
#[derive(clap::Args, Debug)]
pub struct View {
    /// The scene
    pub file: PathBuf,
}

/// Arguments of `explain`.
#[derive(clap::Args, Debug)]
pub struct Explain {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Write it to stdout as JSON
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `bench`.
#[derive(clap::Args, Debug)]
pub struct Bench {
    /// The scene; `-` is stdin
    #[arg(required_unless_present_any = ["suite", "large", "faults"])]
    pub file: Option<PathBuf>,
    /// Also measure the suite: scenes of the course, a chain of 30 leaves, and generated ones of 3 to 300
    #[arg(long)]
    pub suite: bool,
    /// Also measure generated scenes of 300 to 20,000 leaves, without the interpreters
    #[arg(long)]
    pub large: bool,
    /// Of these only scenes in whose names this occurs
    #[arg(long, value_name = "PART")]
    pub only: Option<String>,
    /// Count wrong pixels instead: scenes at which a classroom practical's march fails
    #[arg(long, conflicts_with_all = ["file", "suite", "large"])]
    pub faults: bool,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = size)]
    pub size: [u32; 2],
    /// Where the figures go, as JSON; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub json: Option<PathBuf>,
    /// Where a plot of what a pixel of the scattered scenes costs goes, over their leaves
    #[arg(long, value_name = "OUT.svg", requires = "large")]
    pub plot: Option<PathBuf>,
}

/// Arguments of `doc`.
#[derive(clap::Args, Debug)]
pub struct Doc {
    /// A name, a topic, a code such as E0104, or a word that descriptions mention; everything if not given
    pub name: Option<String>,
    /// Write it to stdout as JSON
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `chart`.
#[derive(clap::Args, Debug)]
pub struct Chart {
    /// Scenes; `-` is stdin
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Where the chart goes, as a picture; `-` is stdout, as SVG. A folder takes both pictures and the figures of each scene,
    /// and a page that lists them
    #[arg(short, long, value_name = "OUT.svg|OUT.png|FOLDER")]
    pub output: Option<PathBuf>,
    /// Where a table goes, as Markdown: a line for each scene, with what `auto` does there; `-` is stdout
    #[arg(long, value_name = "OUT.md", conflicts_with_all = ["output", "json"])]
    pub table: Option<PathBuf>,
    /// A dark ground for PNG; an SVG has that of the reader's page
    #[arg(long)]
    pub dark: bool,
    /// Where the figures go, as JSON; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub json: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = size)]
    pub size: [u32; 2],
    /// Ray methods, separated by commas; all unless given
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = methods())]
    pub march: Vec<String>,
    /// What the picture tells of its making, such as a date and a commit
    #[arg(long, value_name = "TEXT")]
    pub note: Option<String>,
    /// Where truths are kept.
    #[command(flatten)]
    pub cache: Cache,
}

/// Where what the oracle says is kept between runs.
#[derive(clap::Args, Debug)]
pub struct Cache {
    /// Keep what the oracle finds in this folder; in the user's one for caches unless given
    #[arg(long, value_name = "FOLDER")]
    pub cache: Option<PathBuf>,
    /// Ask the oracle anew and keep nothing
    #[arg(long, conflicts_with = "cache")]
    pub no_cache: bool,
}

/// Arguments of `tune`.
#[derive(clap::Args, Debug)]
pub struct Tune {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Error in depth that 99 of 100 pixels may have, in widths of a pixel
    #[arg(long, value_name = "PX", value_parser = positive)]
    pub max_error: f64,
    /// Where all figures go, as JSON, as those of `chart`; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub json: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = size)]
    pub size: [u32; 2],
    /// Ray methods to choose from, separated by commas; all unless given
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = PossibleValuesParser::new(RAY_METHODS))]
    pub march: Vec<String>,
    /// Where truths are kept.
    #[command(flatten)]
    pub cache: Cache,
}

fn methods() -> PossibleValuesParser {
    PossibleValuesParser::new(METHODS.iter().map(|method| method.name))
}

/// `NAME=VALUE`
fn assignment(text: &str) -> Result<Assignment, String> {
    let (name, value) =
        text.split_once('=').ok_or("write NAME=VALUE, such as wall=0.1 or tilt=90deg")?;
    Ok(Assignment { name: name.trim().to_owned(), value: value.trim().to_owned() })
}

/// A number that is not infinite.
fn finite(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "write a number of seconds, such as 1.5".to_owned())
}

/// A number above 0.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "write a part of a pixel's width, such as 0.05".to_owned())
}

/// `640x400` as `[640, 400]`.
fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').map(|(w, h)| (w.parse::<u32>(), h.parse::<u32>()));
    let Some((Ok(width), Ok(height))) = sides else {
        return Err("write width and height with an `x` between, such as 640x400".to_owned());
    };
    if width == 0 || height == 0 {
        return Err("a picture has at least one pixel on each side".to_owned());
    }
    if width.max(height) > MAX_SIDE || u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!(
            "a picture has at most {MAX_SIDE} pixels on a side and {MAX_PIXELS} in all"
        ));
    }
    Ok([width, height])
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_contradict_nowhere() {
        Args::command().debug_assert();
    }

    #[test]
    fn sizes() {
        assert_eq!(size("640x400"), Ok([640, 400]));
        assert_eq!(size("1x1"), Ok([1, 1]));
        for wrong in ["", "640", "640x", "0x4", "4x0", "-1x4", "4x4x4", "99999x1", "32768x32768"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }
}
