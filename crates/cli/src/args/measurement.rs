//! Arguments of commands that measure pictures.

use std::path::PathBuf;

use sdfc::Method;

use super::values::{methods, pixel_widths, scene_methods, size};

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
    #[arg(long, value_name = "PX", value_parser = pixel_widths, allow_negative_numbers = true)]
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
