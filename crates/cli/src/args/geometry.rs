//! Arguments of commands that make or measure geometry.

use std::path::PathBuf;

use sdfc::Plane;

use super::values::{Values, length, plane};

/// Arguments of `mesh`.
#[derive(clap::Args, Debug)]
pub struct Mesh {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Output file; its extension .stl, .obj, .ply, .glb or .3mf gives the format [default: the
    /// scene's name with .stl, in the current folder]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// The error limit.
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
    /// Write lines alone, without circular arcs
    #[arg(long)]
    pub lines: bool,
    /// The error limit.
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
    /// Measure the volume to this fraction of itself; the center of mass, the extent, the clearance
    /// and the thinnest wall to this fraction of the longest side of the scene's bounds
    #[arg(long, value_name = "FRACTION", default_value_t = 0.001, value_parser = length,
          allow_negative_numbers = true)]
    pub error_relative: f64,
    /// Measure the smallest distance between two solids instead, by their names in the scene
    #[arg(long, value_name = "NAME", num_args = 2)]
    pub between: Vec<String>,
    /// Measure the thinnest wall instead: the least distance from the surface along the inward
    /// normal to where the solid ends
    #[arg(long, conflicts_with = "between")]
    pub thinnest_wall: bool,
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

/// The error limit of a mesh or a contour.
#[derive(clap::Args, Debug)]
pub struct Exactness {
    /// Greatest distance between the surface and the mesh or contour, in scene units, in both
    /// directions
    #[arg(long, value_name = "LENGTH", value_parser = length, allow_negative_numbers = true,
          conflicts_with = "error_relative")]
    pub error: Option<f64>,
    /// The same, as a fraction of the longest side of the scene's bounds [default: 0.001]
    #[arg(long, value_name = "FRACTION", value_parser = length, allow_negative_numbers = true)]
    pub error_relative: Option<f64>,
    /// Most cells that are examined
    #[arg(long, value_name = "N")]
    pub max_cells: Option<u64>,
}
