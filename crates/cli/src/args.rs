//! The command line arguments, parsed with clap.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand, ValueEnum};
use sdfc::{Method, Plane};
use sdfc_lang::settings::RAY_METHODS;
use sdfc_render::{MAX_PIXELS, MAX_SAMPLES, MAX_SIDE};

use crate::farm::options::Farm;
use crate::sequence::{self, Frames};

/// Compiles scenes of signed distance functions to shaders and pictures.
#[derive(Debug, Parser)]
#[command(name = "sdfc", version, propagate_version = true, max_term_width = 100)]
#[command(
    after_help = "Exit codes: 0, success; 1, error in the scene; 2, invalid command line; 3, the \
                  machine cannot do it (no GPU, or a file that cannot be read or written); 130, \
                  stopped by Ctrl-C."
)]
pub struct Args {
    /// Options of all commands.
    #[command(flatten)]
    pub global: Global,
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

/// The greatest bind group or binding.
const MAX_BINDING: i64 = 65_535;

/// Options of all commands.
#[derive(clap::Args, Debug)]
pub struct Global {
    /// When to use colour in messages
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN")]
    pub color: ColorChoice,
    /// Print only errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Print more about what is done
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
    /// Print all errors and warnings of scenes
    Check(Check),
    /// Format scenes in the standard layout
    #[command(name = "fmt")]
    Format(Format),
    /// Write the shader of a scene
    Compile(Compile),
    /// Draw a picture of a scene
    Render(Render),
    /// Join the regions of a picture that were drawn separately
    Join(Join),
    /// Write a closed mesh of a scene, with a proven error
    Mesh(Mesh),
    /// Write the outlines of a section of a scene, with a proven error
    Contour(Contour),
    /// Measure volume, center of mass, inertia and extent, as proven intervals
    Measure(Measure),
    /// Write a grid of distances, with a proven error of interpolation
    Bake(Bake),
    /// Show a scene in a window that updates when its file changes
    View(View),
    /// Explain how a scene is compiled: cost, ray method, bounds, Lipschitz constants
    Explain(Explain),
    /// Compare the speed of the specialised shader with shaders that interpret the scene
    Bench(Bench),
    /// Look up shapes, operators, functions, settings, types and error codes
    Doc(Doc),
    /// Print the script with which a shell completes commands and options
    Completions(Completions),
    /// Write the manual pages of all commands into a folder
    Manual(Manual),
    /// Serve an editor: the Language Server Protocol over stdin and stdout
    Lsp(Lsp),
    /// Compare the cost and the error of all ray methods on a scene
    Chart(Chart),
    /// Find the cheapest ray method and setting within an error limit
    Tune(Tune),
}

/// Arguments of `completions`.
#[derive(clap::Args, Debug)]
pub struct Completions {
    /// The shell
    pub shell: clap_complete::Shell,
}

/// Arguments of `manual`.
#[derive(clap::Args, Debug)]
pub struct Manual {
    /// An existing folder
    pub folder: PathBuf,
}

/// Arguments of `lsp`.
#[derive(clap::Args, Debug)]
pub struct Lsp {
    /// Has no effect: some editors add it to say what is the default
    #[arg(long, hide = true)]
    pub stdio: bool,
}

/// Arguments of `check`.
#[derive(clap::Args, Debug)]
pub struct Check {
    /// Scenes; `-` is stdin
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Print the diagnostics to stdout as JSON
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `fmt`.
#[derive(clap::Args, Debug)]
pub struct Format {
    /// Scenes, formatted in place; `-` formats stdin to stdout
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Change nothing, and fail if a file is not formatted
    #[arg(long)]
    pub check: bool,
}

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
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=MAX_BINDING))]
    pub group: Option<u32>,
    /// Binding of the first buffer; the others follow [default: 0]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=MAX_BINDING))]
    pub binding: Option<u32>,
    /// Output file for names, layouts and properties of the field, as JSON; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub reflect: Option<PathBuf>,
    /// Set a param: its value, if it is a constant of the shader, otherwise its default. The value
    /// is written as in a scene: 0.5, 90deg, true, #d94f30, or the name of a choice
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<Assignment>,
    /// Turn the numbers in the scene into params, named at_LINE_COLUMN, that change without
    /// recompiling
    #[arg(long)]
    pub live_literals: bool,
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

/// Arguments of `render`.
#[derive(clap::Args, Debug)]
pub struct Render {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Output file; its extension .png, .exr or .gif gives the format, and `-` writes a PNG to
    /// stdout [default: the scene's name with .png, in the current folder]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "640x400", value_parser = size)]
    pub size: [u32; 2],
    /// Ray method [default: that of the scene, or auto]
    #[arg(long, value_name = "METHOD", value_parser = methods())]
    pub march: Option<Method>,
    /// Device that draws
    #[arg(long, value_enum, default_value_t)]
    pub backend: Backend,
    /// When to turn similar parts of the scene into loops
    #[arg(long, value_enum, default_value_t, value_name = "WHEN")]
    pub loops: Loops,
    /// Set a param, with the value written as in a scene: 0.5, 90deg, true, #d94f30, or the name
    /// of a choice
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<Assignment>,
    /// Turn the numbers in the scene into params, named at_LINE_COLUMN, that change without
    /// recompiling
    #[arg(long)]
    pub live_literals: bool,
    /// Time in seconds
    #[arg(long, value_name = "S", default_value_t = 0.0, allow_negative_numbers = true,
          value_parser = finite, conflicts_with = "frames")]
    pub time: f64,
    /// Draw frames A to B - 1 as OUT.0007.png and so on, or as one GIF; the time of frame n is
    /// n / fps. A-B includes B, and A alone is one frame
    #[arg(long, value_name = "A..B", value_parser = sequence::frames)]
    pub frames: Option<Frames>,
    /// Frames per second
    #[arg(long, value_name = "N", default_value_t = 30.0, value_parser = sequence::rate)]
    pub fps: f64,
    /// Rays per pixel, averaged [default: `antialias(...)` of the scene, or 1]
    #[arg(long, value_name = "N",
          value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    pub samples: Option<u32>,
    /// Draw isolines this far apart, in scene units, in a picture of regions; default the scene's
    #[arg(long, value_name = "SPACING")]
    pub isolines: Option<f64>,
    /// Output file for depths, as EXR: channel Z is the distance along each ray in scene units,
    /// infinite if the ray hits nothing
    #[arg(long, value_name = "OUT.exr")]
    pub depth: Option<PathBuf>,
    /// Output file for times and counts, as JSON; `-` is stdout. Draws the frame five times
    #[arg(long, value_name = "OUT.json", conflicts_with = "frames")]
    pub stats: Option<PathBuf>,
    /// Fail, and write no picture, if a part of it is unproven: if a ray may have missed a surface
    #[arg(long)]
    pub strict: bool,
    /// Work that is shared between machines.
    #[command(flatten)]
    pub farm: Farm,
}

/// Arguments of `join`.
#[derive(clap::Args, Debug)]
pub struct Join {
    /// Files of `sdfc render --region`: all regions of one picture [default: the files beside OUT
    /// that are named like its parts, such as OUT.part-0-512-3840x256.png]
    #[arg(value_name = "PART")]
    pub parts: Vec<PathBuf>,
    /// Output file, with the extension of the parts; `-` is stdout
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Join parts that were drawn on different devices, although borders may be visible
    #[arg(long)]
    pub any_device: bool,
}

/// Arguments of `mesh`.
#[derive(clap::Args, Debug)]
pub struct Mesh {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Output file; its extension .stl, .obj, .ply, .glb or .3mf gives the format [default: the
    /// scene's name with .stl, in the current folder]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// How exact it is.
    #[command(flatten)]
    pub exactness: Exactness,
    /// Output file for the certificate, as JSON; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub json: Option<PathBuf>,
    /// Values of params and time.
    #[command(flatten)]
    pub values: Values,
}

/// Arguments of `contour`.
#[derive(clap::Args, Debug)]
pub struct Contour {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Output file; its extension .svg or .dxf gives the format [default: the scene's name with
    /// .svg, in the current folder]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Plane of the section: an axis or a normal, and the coordinate along it, such as z=0.5 or
    /// 1,1,0=2
    #[arg(long, value_name = "AXIS=LENGTH", default_value = "z=0", value_parser = plane)]
    pub plane: Plane,
    /// How exact it is.
    #[command(flatten)]
    pub exactness: Exactness,
    /// Output file for the certificate and the paths, as JSON; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub json: Option<PathBuf>,
    /// Values of params and time.
    #[command(flatten)]
    pub values: Values,
}

/// Arguments of `measure`.
#[derive(clap::Args, Debug)]
pub struct Measure {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Measure the volume to this fraction of itself; the center of mass and the extent to this
    /// fraction of the longest side of the scene's bounds
    #[arg(long, value_name = "FRACTION", default_value_t = 0.001, value_parser = above_0)]
    pub error_relative: f64,
    /// Measure the smallest distance between two solids instead, by their names in the scene
    #[arg(long, value_name = "NAME", num_args = 2)]
    pub between: Vec<String>,
    /// Print JSON to stdout
    #[arg(long)]
    pub json: bool,
    /// Values of params and time.
    #[command(flatten)]
    pub values: Values,
    /// Most boxes that are examined
    #[arg(long, value_name = "N")]
    pub max_cells: Option<u64>,
}

/// Arguments of `bake`.
#[derive(clap::Args, Debug)]
pub struct Bake {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Output file; its extension .npy or .nrrd gives the format [default: the scene's name with
    /// .npy, in the current folder]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Samples along the longest side of the scene's bounds
    #[arg(long, value_name = "N", default_value_t = 64)]
    pub resolution: usize,
    /// Output file for positions and errors, as JSON; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub json: Option<PathBuf>,
    /// Values of params and time.
    #[command(flatten)]
    pub values: Values,
}

/// How exact a mesh or a contour is.
#[derive(clap::Args, Debug)]
pub struct Exactness {
    /// Greatest distance from the surface, in scene units, of what is written, and of the surface
    /// from it
    #[arg(long, value_name = "LENGTH", value_parser = above_0, conflicts_with = "error_relative")]
    pub error: Option<f64>,
    /// The same, as a fraction of the longest side of the scene's bounds [default: 0.001]
    #[arg(long, value_name = "FRACTION", value_parser = above_0)]
    pub error_relative: Option<f64>,
    /// Most cells that are examined
    #[arg(long, value_name = "N")]
    pub max_cells: Option<u64>,
}

/// Values of params and time.
#[derive(clap::Args, Debug)]
pub struct Values {
    /// Set a param, with the value written as in a scene: 0.5, 90deg, true, #d94f30, or the name
    /// of a choice
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<Assignment>,
    /// Time in seconds
    #[arg(long, value_name = "S", default_value_t = 0.0, allow_negative_numbers = true,
          value_parser = finite)]
    pub time: f64,
}

/// A param and its value as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// The param.
    pub name: String,
    /// The value, as written.
    pub value: String,
}

/// The device that draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// The GPU if there is one, otherwise the CPU, which also draws long formulas for which a
    /// software driver would take longer
    #[default]
    Auto,
    /// The GPU
    Gpu,
    /// The CPU
    Cpu,
}

/// When similar parts of a scene become loops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Loops {
    /// Where that costs less
    #[default]
    Auto,
    /// Never: write out every operation
    Never,
    /// Wherever parts are equal up to constants
    Always,
}

impl From<Loops> for sdfc::LoopStrategy {
    fn from(loops: Loops) -> Self {
        match loops {
            Loops::Auto => Self::Auto,
            Loops::Never => Self::Unrolled,
            Loops::Always => Self::Looped,
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
    /// Set a param, with the value written as in a scene: 0.5, 90deg, true, #d94f30, or the name
    /// of a choice
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<Assignment>,
    /// Print JSON to stdout
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `bench`.
#[derive(clap::Args, Debug)]
pub struct Bench {
    /// The scene; `-` is stdin
    #[arg(required_unless_present_any = ["suite", "large", "faults"])]
    pub file: Option<PathBuf>,
    /// Also measure the suite: scenes of the course, a chain of 30 primitives, and generated scenes
    /// of 3 to 300
    #[arg(long)]
    pub suite: bool,
    /// Also measure generated scenes of 100 to 20,000 primitives, without the interpreters
    #[arg(long)]
    pub large: bool,
    /// Measure only scenes of the suites whose names contain this
    #[arg(long, value_name = "TEXT")]
    pub only: Option<String>,
    /// Count wrong pixels instead, on scenes where a naive ray marcher fails
    #[arg(long, conflicts_with_all = ["file", "suite", "large"])]
    pub faults: bool,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = size)]
    pub size: [u32; 2],
    /// Output file for the measurements, as JSON; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub json: Option<PathBuf>,
    /// Output file for a plot of cost per pixel over the size of the scattered scenes
    #[arg(long, value_name = "OUT.svg", requires = "large")]
    pub plot: Option<PathBuf>,
}

/// Arguments of `doc`.
#[derive(clap::Args, Debug)]
pub struct Doc {
    /// A name, a topic, a code such as E0104, or a word of a description [default: everything]
    pub name: Option<String>,
    /// Print JSON to stdout
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `chart`.
#[derive(clap::Args, Debug)]
pub struct Chart {
    /// Scenes; `-` is stdin
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Output file of the chart; `-` writes SVG to stdout. In a folder, writes SVG, PNG and JSON of
    /// each scene, and a page that lists them
    #[arg(short, long, value_name = "OUT.svg|OUT.png|FOLDER")]
    pub output: Option<PathBuf>,
    /// Output file for a Markdown table with one line per scene; `-` is stdout
    #[arg(long, value_name = "OUT.md", conflicts_with_all = ["output", "json"])]
    pub table: Option<PathBuf>,
    /// Use a dark background for PNG; an SVG follows the reader's theme
    #[arg(long)]
    pub dark: bool,
    /// Output file for the measurements, as JSON; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub json: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = size)]
    pub size: [u32; 2],
    /// Ray methods, separated by commas [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = methods())]
    pub march: Vec<Method>,
    /// Note in the picture, such as a date and a commit
    #[arg(long, value_name = "TEXT")]
    pub note: Option<String>,
    /// The cache of the oracle.
    #[command(flatten)]
    pub cache: Cache,
}

/// Where the oracle's results are stored between runs.
#[derive(clap::Args, Debug)]
pub struct Cache {
    /// Folder for the oracle's results [default: the user's cache folder]
    #[arg(long, value_name = "FOLDER")]
    pub cache: Option<PathBuf>,
    /// Compute the oracle's results again and store nothing
    #[arg(long, conflicts_with = "cache")]
    pub no_cache: bool,
}

/// Arguments of `tune`.
#[derive(clap::Args, Debug)]
pub struct Tune {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Greatest error in depth (99th percentile), in widths of a pixel
    #[arg(long, value_name = "PX", value_parser = positive)]
    pub max_error: f64,
    /// Output file for all measurements, as JSON like that of `chart`; `-` is stdout
    #[arg(long, value_name = "OUT.json")]
    pub json: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = size)]
    pub size: [u32; 2],
    /// Ray methods to choose from, separated by commas [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = scene_methods())]
    pub march: Vec<Method>,
    /// The cache of the oracle.
    #[command(flatten)]
    pub cache: Cache,
}

/// Parses the name of any ray method. The help lists those for users.
fn methods() -> impl TypedValueParser<Value = Method> {
    parser(Method::all())
}

/// Parses the name of a ray method that scenes can name.
fn scene_methods() -> impl TypedValueParser<Value = Method> {
    parser(Method::all().filter(|method| RAY_METHODS.contains(&method.name())))
}

fn parser(methods: impl Iterator<Item = Method>) -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(methods.map(described)).try_map(|name| name.parse::<Method>())
}

fn described(method: Method) -> PossibleValue {
    let is_for_users = Method::for_users().any(|other| other == method);
    PossibleValue::new(method.name()).help(method.summary()).hide(!is_for_users)
}

/// Parses `NAME=VALUE`.
fn assignment(text: &str) -> Result<Assignment, String> {
    let (name, value) =
        text.split_once('=').ok_or("expected NAME=VALUE, such as wall=0.1 or tilt=90deg")?;
    Ok(Assignment { name: name.trim().to_owned(), value: value.trim().to_owned() })
}

/// Parses a plane: `z=0.5`, or `1,1,0=2` with a normal.
fn plane(text: &str) -> Result<Plane, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let parsed = text.split_once('=').and_then(|(normal, offset)| {
        let normal = match normal.trim() {
            "x" => vec![1.0, 0.0, 0.0],
            "y" => vec![0.0, 1.0, 0.0],
            "z" => vec![0.0, 0.0, 1.0],
            other => other.split(',').map(number).collect::<Option<Vec<f64>>>()?,
        };
        Plane::new(normal.try_into().ok()?, number(offset)?)
    });
    let expected = "expected an axis or a normal and a length, such as z=0.5 or 1,1,0=2";
    parsed.ok_or_else(|| expected.to_owned())
}

/// Parses a finite number.
fn finite(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "expected a number of seconds, such as 1.5".to_owned())
}

/// Parses a number above 0.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a number of pixel widths above 0, such as 0.05".to_owned())
}

/// Parses a length or a fraction above 0.
fn above_0(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a number above 0, such as 0.01".to_owned())
}

/// Parses `640x400` as `[640, 400]`.
fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').map(|(w, h)| (w.parse::<u32>(), h.parse::<u32>()));
    let Some((Ok(width), Ok(height))) = sides else {
        return Err("expected WIDTHxHEIGHT, such as 640x400".to_owned());
    };
    if width == 0 || height == 0 {
        return Err("width and height must be at least 1".to_owned());
    }
    if width.max(height) > MAX_SIDE || u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!(
            "a picture has at most {MAX_SIDE} pixels per side and {MAX_PIXELS} in total"
        ));
    }
    Ok([width, height])
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn arguments_are_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn planes_are_parsed_or_refused() {
        assert_eq!(plane("z=0.5"), Ok(Plane::new([0.0, 0.0, 1.0], 0.5).unwrap()));
        assert_eq!(plane("1, 1,0 = -2"), Ok(Plane::new([1.0, 1.0, 0.0], -2.0).unwrap()));
        for wrong in ["", "z", "z=", "w=1", "1,2=3", "0,0,0=1", "1,2,3,4=5", "z=inf", "z=1=2"] {
            assert!(plane(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn sizes_are_parsed_or_refused() {
        assert_eq!(size("640x400"), Ok([640, 400]));
        assert_eq!(size("1x1"), Ok([1, 1]));
        for wrong in ["", "640", "640x", "0x4", "4x0", "-1x4", "4x4x4", "99999x1", "32768x32768"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }
}
