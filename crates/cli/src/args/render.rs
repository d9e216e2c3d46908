//! Arguments of `sdfc render` and `sdfc join`.

use std::path::PathBuf;

use clap::ValueEnum;
use clap::builder::UnknownArgumentValueParser;
use sdfc::{Backend, Method};
use sdfc_render::MAX_SAMPLES;

use super::values::{LiveLiterals, Params, finite, methods, named, size};
use crate::farm::options::Farm;
use crate::sequence::{self, Frames};

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
    /// Other tools have this option; the message names ours.
    #[arg(long, hide = true, value_parser = UnknownArgumentValueParser::suggest_arg("--size"))]
    pub width: Option<String>,
    /// Ray method [default: that of the scene, or auto]
    #[arg(long, value_name = "METHOD", value_parser = methods())]
    pub march: Option<Method>,
    /// Device that draws
    #[arg(long, default_value = Backend::Auto.name(),
          value_parser = named::<Backend>(Backend::ALL.map(|it| [it.name(), it.summary()])))]
    pub backend: Backend,
    /// When to turn similar parts of the scene into loops
    #[arg(long, value_enum, default_value_t, value_name = "WHEN")]
    pub loops: Loops,
    /// Another camera than that of the scene, written as the arguments of `camera(...)`, such as
    /// 'eye: [4, 3, 5], target: [0, 1, 0], fov: 35deg'
    #[arg(long, value_name = "ARGUMENTS")]
    pub camera: Option<String>,
    /// Values of params.
    #[command(flatten)]
    pub params: Params,
    /// Numbers of the scene as params.
    #[command(flatten)]
    pub live: LiveLiterals,
    /// Time in seconds
    #[arg(long, value_name = "S", default_value_t = 0.0, allow_negative_numbers = true,
          value_parser = finite, conflicts_with = "frames")]
    pub time: f64,
    /// Draw frames A to B - 1 as OUT.0007.png and so on, or as one GIF; the time of frame n is
    /// n / fps. A-B includes B, and A alone is one frame. To make a film of them: ffmpeg
    /// -framerate 30 -i OUT.%04d.png -pix_fmt yuv420p OUT.mp4
    #[arg(long, value_name = "A..B", value_parser = sequence::frames)]
    pub frames: Option<Frames>,
    /// Frames per second
    #[arg(long, value_name = "N", default_value_t = 30.0, value_parser = sequence::rate)]
    pub fps: f64,
    /// Rays per pixel, averaged [default: `antialias(...)` of the scene, or 1]
    #[arg(long, value_name = "N",
          value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    pub samples: Option<u32>,
    /// Distance between the isolines of a picture of regions, in scene units [default: that of the
    /// scene]
    #[arg(long, value_name = "SPACING")]
    pub isolines: Option<f64>,
    /// Output file for depths, as EXR: channel Z is the distance along each ray in scene units,
    /// infinite if the ray hits nothing
    #[arg(long, value_name = "OUT.exr")]
    pub depth: Option<PathBuf>,
    /// Output file for times and counts, as JSON; `-` is stdout. Draws the frame five times
    #[arg(long, value_name = "OUT.json", conflicts_with = "frames")]
    pub stats: Option<PathBuf>,
    /// Draw the picture again whenever the scene or a file that it imports changes, until Ctrl-C
    #[arg(long, conflicts_with_all = ["frames", "stats", "region", "chunk", "resume"])]
    pub watch: bool,
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
